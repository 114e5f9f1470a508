use avatar_mesh::Bounds;
use glam::{Affine3A, Mat4, Quat, Vec2, Vec3, Vec4};

/// Where a picture is taken from. Its own axes: +X right, +Y up, looking along −Z.
///
/// Clip space is that of wgpu (y up, depth 0…1) with reversed, infinite depth: 1 at the near plane, 0 far
/// away. That spreads f32's precision evenly over distances, and there is no far plane to choose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// A rigid transformation.
    pub world_from_camera: Affine3A,
    /// Angle between the upper and lower edge of the picture.
    pub vertical_fov_rad: f32,
    /// Width of the picture divided by its height.
    pub aspect: f32,
    /// Distance of the near plane.
    pub near: f32,
    /// The point of the picture that shows what lies straight ahead, as a shifted lens does: −1 to 1, +x
    /// right, +y up; (0, 0) is the middle. If something covers a part of the picture, a shift keeps the face
    /// in the middle of the rest.
    pub shift: Vec2,
}

/// Distance of the near plane of a camera around a target, as a share of the distance of the target.
const NEAR_SHARE: f32 = 0.02;
/// Room around a box that fills a picture, as a factor on the distance.
const FRAME_MARGIN: f32 = 1.06;

impl Camera {
    /// A camera that looks at `target`. Yaw 0 stands in front of the face (at +Z), yaw +90° on the
    /// character's left side (at +X); a positive pitch lifts the camera. Any pitch is valid, ±90° too.
    pub fn orbit(
        target: Vec3,
        distance: f32,
        yaw_rad: f32,
        pitch_rad: f32,
        vertical_fov_rad: f32,
        aspect: f32,
    ) -> Self {
        let rotation = orbit_rotation(yaw_rad, pitch_rad);
        let eye = target + rotation * (distance * Vec3::Z);
        Self {
            world_from_camera: Affine3A::from_rotation_translation(rotation, eye),
            vertical_fov_rad,
            aspect,
            near: (distance.abs() * NEAR_SHARE).max(1e-4),
            shift: Vec2::ZERO,
        }
    }

    /// A camera around the middle of a box, just far enough away that the whole box is in the picture.
    pub fn frame(bounds: Bounds, yaw_rad: f32, pitch_rad: f32, vertical_fov_rad: f32, aspect: f32) -> Self {
        let camera_from_world = orbit_rotation(yaw_rad, pitch_rad).inverse();
        let half = bounds.size() * 0.5;
        let slope_y = half_fov_tan(vertical_fov_rad);
        let slope_x = slope_y * valid_aspect(aspect);
        let mut distance = 0.0f32;
        for corner in 0..8u8 {
            let sign = |bit: u8| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
            let p = camera_from_world * (half * Vec3::new(sign(0), sign(1), sign(2)));
            distance = distance.max(p.z + (p.x.abs() / slope_x).max(p.y.abs() / slope_y));
        }
        let distance = (distance * FRAME_MARGIN).max(1e-3);
        Self::orbit(bounds.center(), distance, yaw_rad, pitch_rad, vertical_fov_rad, aspect)
    }

    /// The camera for a larger picture of this width and height that shows, in the rectangle from `min` to
    /// `max`, what this camera shows in its whole picture. All in pixels, y down. Returns this camera
    /// unchanged if a side is below one pixel or not finite.
    #[must_use]
    pub fn within(self, size: Vec2, min: Vec2, max: Vec2) -> Self {
        let (free, middle) = (max - min, (min + max) / 2.0);
        if !(free.min_element() >= 1.0 && size.min_element() >= 1.0 && free.is_finite() && size.is_finite()) {
            return self;
        }
        let slope = half_fov_tan(self.vertical_fov_rad) * size.y / free.y;
        Self {
            vertical_fov_rad: 2.0 * slope.atan(),
            aspect: size.x / size.y,
            shift: (middle / size * 2.0 - 1.0) * Vec2::new(1.0, -1.0),
            ..self
        }
    }

    /// The camera of a smaller picture that shows what this camera shows, in its whole picture of this width
    /// and height, in the rectangle from `min` to `max`. All in pixels, y down. Returns this camera
    /// unchanged if a side is below one pixel or not finite.
    #[must_use]
    pub fn part(self, size: Vec2, min: Vec2, max: Vec2) -> Self {
        let (part, middle) = (max - min, (min + max) / 2.0);
        if !(part.min_element() >= 1.0 && size.min_element() >= 1.0 && part.is_finite() && size.is_finite()) {
            return self;
        }
        let slope = half_fov_tan(self.vertical_fov_rad) * part.y / size.y;
        let middle = (middle / size * 2.0 - 1.0) * Vec2::new(1.0, -1.0);
        Self {
            vertical_fov_rad: 2.0 * slope.atan(),
            aspect: valid_aspect(self.aspect) * (part.x / size.x) * (size.y / part.y),
            shift: (self.valid_shift() - middle) * size / part,
            ..self
        }
    }

    /// Where the camera stands.
    pub fn eye(&self) -> Vec3 {
        self.world_from_camera.translation.into()
    }

    /// The direction from the eye toward a point of the picture; `at` is −1 to 1, +x right, +y up. Its length
    /// is such that it leads from the eye to depth 1 in front of the camera.
    pub fn toward(&self, at: Vec2) -> Vec3 {
        let aside = (at - self.valid_shift()) / self.zoom();
        let direction = Vec3::new(aside.x * valid_aspect(self.aspect), aside.y, -1.0);
        self.world_from_camera.transform_vector3(direction)
    }

    /// The matrix that takes points of the world to clip space. A field of view outside 0…180° and an aspect
    /// or a near plane that is not positive are replaced by the nearest usable number.
    pub fn clip_from_world(&self) -> Mat4 {
        let (zoom, near, shift) = (self.zoom(), self.valid_near(), self.valid_shift());
        let clip_from_camera = Mat4::from_cols(
            Vec4::new(zoom / valid_aspect(self.aspect), 0.0, 0.0, 0.0),
            Vec4::new(0.0, zoom, 0.0, 0.0),
            Vec4::new(-shift.x, -shift.y, 0.0, -1.0),
            Vec4::new(0.0, 0.0, near, 0.0),
        );
        clip_from_camera * Mat4::from(self.world_from_camera.inverse())
    }

    /// The inverse of [`Camera::clip_from_world`] in closed form: a numerical inverse would be inexact at far
    /// depths.
    pub(crate) fn world_from_clip(&self) -> Mat4 {
        let (zoom, near, shift) = (self.zoom(), self.valid_near(), self.valid_shift());
        let slope_x = valid_aspect(self.aspect) / zoom;
        let camera_from_clip = Mat4::from_cols(
            Vec4::new(slope_x, 0.0, 0.0, 0.0),
            Vec4::new(0.0, 1.0 / zoom, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, 1.0 / near),
            Vec4::new(-shift.x * slope_x, -shift.y / zoom, -1.0, 0.0),
        );
        Mat4::from(self.world_from_camera) * camera_from_clip
    }

    /// 1 / (half the height of what is seen at distance 1).
    pub(crate) fn zoom(&self) -> f32 {
        1.0 / half_fov_tan(self.vertical_fov_rad)
    }

    /// The distance of the near plane, a small one if `near` is not positive.
    pub(crate) fn valid_near(&self) -> f32 {
        if self.near > 0.0 { self.near } else { 1e-4 }
    }

    fn valid_shift(&self) -> Vec2 {
        if self.shift.is_finite() { self.shift } else { Vec2::ZERO }
    }
}

fn orbit_rotation(yaw_rad: f32, pitch_rad: f32) -> Quat {
    Quat::from_rotation_y(yaw_rad) * Quat::from_rotation_x(-pitch_rad)
}

fn half_fov_tan(vertical_fov_rad: f32) -> f32 {
    let half = if vertical_fov_rad.is_nan() { 0.0 } else { vertical_fov_rad * 0.5 };
    half.clamp(0.005, 1.56).tan()
}

fn valid_aspect(aspect: f32) -> f32 {
    if aspect > 0.0 && aspect.is_finite() { aspect } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};

    #[test]
    fn yaw_ninety_stands_at_the_characters_left() {
        let camera = Camera::orbit(Vec3::ZERO, 5.0, FRAC_PI_2, 0.0, 0.5, 1.0);
        assert!((camera.eye() - Vec3::new(5.0, 0.0, 0.0)).length() < 1e-5);
    }

    #[test]
    fn positive_pitch_lifts_the_camera() {
        assert!(Camera::orbit(Vec3::ZERO, 5.0, 0.0, FRAC_PI_4, 0.5, 1.0).eye().y > 3.0);
    }

    #[test]
    fn the_characters_left_is_on_the_right_of_the_picture_and_up_is_up() {
        let clip_from_world = Camera::orbit(Vec3::ZERO, 5.0, 0.0, 0.0, 0.5, 1.0).clip_from_world();
        let left = clip_from_world.project_point3(Vec3::X);
        let up = clip_from_world.project_point3(Vec3::Y);
        assert!(left.x > 0.1 && left.y.abs() < 1e-6);
        assert!(up.y > 0.1 && up.x.abs() < 1e-6);
    }

    #[test]
    fn depth_falls_from_one_to_zero() {
        let camera = Camera::orbit(Vec3::ZERO, 5.0, 0.0, 0.0, 0.5, 1.0);
        let depth = |z: f32| camera.clip_from_world().project_point3(Vec3::new(0.0, 0.0, z)).z;
        assert!((depth(5.0 - camera.near) - 1.0).abs() < 1e-5);
        assert!(depth(0.0) > depth(-5.0) && depth(-1e6) > 0.0);
    }

    #[test]
    fn a_framed_box_fits_from_everywhere_and_fills_the_picture() {
        let bounds = Bounds { min: Vec3::new(-3.0, -8.0, -4.0), max: Vec3::new(5.0, 9.0, 6.0) };
        for (yaw, pitch, aspect) in
            [(0.0, 0.0, 1.0), (0.7, 0.2, 1.8), (FRAC_PI_2, -0.5, 0.4), (2.5, FRAC_PI_2, 1.0)]
        {
            let clip_from_world = Camera::frame(bounds, yaw, pitch, 0.6, aspect).clip_from_world();
            let mut reach = 0.0f32;
            for corner in 0..8 {
                let pick = |bit: u32, min, max| if corner >> bit & 1 == 0 { min } else { max };
                let (min, max) = (bounds.min, bounds.max);
                let corner = Vec3::new(pick(0, min.x, max.x), pick(1, min.y, max.y), pick(2, min.z, max.z));
                let p = clip_from_world.project_point3(corner);
                reach = reach.max(p.x.abs()).max(p.y.abs());
            }
            assert!((0.8..=1.0).contains(&reach), "{reach}");
        }
    }

    #[test]
    fn clip_space_leads_back_to_the_world() {
        let straight = Camera::orbit(Vec3::new(1.0, 2.0, 3.0), 30.0, 0.4, -0.3, 0.5, 1.7);
        let camera = Camera { shift: Vec2::new(0.4, -0.3), ..straight };
        for point in [Vec3::ZERO, Vec3::new(3.0, -2.0, 5.0), Vec3::new(-4.0, 8.0, -20.0)] {
            let there = camera.clip_from_world().project_point3(point);
            assert!((camera.world_from_clip().project_point3(there) - point).length() < 1e-3);
            let toward = camera.toward(Vec2::new(there.x, there.y));
            let depth = -camera.world_from_camera.inverse().transform_point3(point).z;
            assert!((camera.eye() + toward * depth - point).length() < 1e-3);
        }
    }

    #[test]
    fn a_picture_in_a_larger_one_is_the_same_picture() {
        let camera = Camera::orbit(Vec3::new(1.0, 2.0, 3.0), 30.0, 0.4, -0.3, 0.5, 300.0 / 200.0);
        let (size, min, max) = (Vec2::new(640.0, 480.0), Vec2::new(320.0, 30.0), Vec2::new(620.0, 230.0));
        let within = camera.within(size, min, max);
        let pixel = |camera: Camera, point: Vec3, size: Vec2| {
            let clip = camera.clip_from_world().project_point3(point);
            (Vec2::new(clip.x, -clip.y) + 1.0) / 2.0 * size
        };
        for point in [Vec3::ZERO, Vec3::new(3.0, -2.0, 5.0), Vec3::new(-4.0, 8.0, -20.0)] {
            let alone = pixel(camera, point, Vec2::new(300.0, 200.0));
            assert!((pixel(within, point, size) - (alone + min)).length() < 1e-3, "{point}");
        }
        assert_eq!(camera.within(size, max, min), camera);
    }

    #[test]
    fn a_part_of_a_picture_is_the_same_picture() {
        let straight = Camera::orbit(Vec3::new(1.0, 2.0, 3.0), 30.0, 0.4, -0.3, 0.5, 640.0 / 480.0);
        let camera = Camera { shift: Vec2::new(0.4, -0.3), ..straight };
        let (size, min, max) = (Vec2::new(640.0, 480.0), Vec2::new(320.0, 30.0), Vec2::new(620.0, 230.0));
        let part = camera.part(size, min, max);
        let pixel = |camera: Camera, point: Vec3, size: Vec2| {
            let clip = camera.clip_from_world().project_point3(point);
            (Vec2::new(clip.x, -clip.y) + 1.0) / 2.0 * size
        };
        for point in [Vec3::ZERO, Vec3::new(3.0, -2.0, 5.0), Vec3::new(-4.0, 8.0, -20.0)] {
            let of_part = pixel(part, point, max - min) + min;
            assert!((pixel(camera, point, size) - of_part).length() < 2e-3, "{point}");
        }
        assert_eq!(camera.part(size, max, min), camera);
    }

    #[test]
    fn unusable_numbers_still_give_a_finite_matrix() {
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let camera = Camera {
                world_from_camera: Affine3A::IDENTITY,
                vertical_fov_rad: bad,
                aspect: bad,
                near: if bad.is_infinite() { 0.0 } else { bad },
                shift: Vec2::splat(bad),
            };
            assert!(camera.clip_from_world().is_finite(), "{bad}");
        }
    }
}
