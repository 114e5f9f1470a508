//! Where cameras stand, by what is in their pictures.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod common;

use avatar_stage::avatar_render::{Camera, Light, linear_from_srgb8};
use avatar_stage::glam::Vec3;
use avatar_stage::{BACKGROUND, Framing, NamedView, View, portrait};
use common::pack;

#[test]
fn names_and_views_belong_together() {
    for view in NamedView::ALL {
        assert_eq!(NamedView::from_name(view.name()), Some(view));
    }
    assert_eq!(NamedView::from_name("Front"), None);
    let center = pack().bounds().unwrap().center();
    let toward = |view: NamedView| (view.view().camera(pack(), 1.0).eye() - center).normalize_or_zero();
    // The character's left is +X, and it looks along +Z.
    for (view, direction) in [
        (NamedView::Front, Vec3::Z),
        (NamedView::Left, Vec3::X),
        (NamedView::Right, Vec3::NEG_X),
        (NamedView::Back, Vec3::NEG_Z),
    ] {
        assert!((toward(view) - direction).length() < 1e-5, "{view:?}");
    }
    let three_quarter = toward(NamedView::ThreeQuarter);
    assert!(three_quarter.x > 0.3 && three_quarter.z > 0.3);
}

/// The corners of the head's front, in the picture: from -1 to 1.
fn extent(camera: &Camera) -> f32 {
    let bounds = pack().bounds().unwrap();
    let clip_from_world = camera.clip_from_world();
    let half = bounds.size() / 2.0;
    let sides = [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::NEG_Y].map(|side| bounds.center() + half * side);
    sides
        .into_iter()
        .map(|side| clip_from_world.project_point3(side))
        .fold(0.0, |most, at| f32::max(most, at.x.abs().max(at.y.abs())))
}

#[test]
fn the_whole_avatar_fills_the_picture() {
    for aspect in [0.4, 1.0, 1.3, 3.0] {
        let scene = View::default().scene(pack(), aspect, BACKGROUND, Light::studio());
        assert!((0.65..=1.0).contains(&extent(&scene.camera)), "{aspect}: {}", extent(&scene.camera));
        assert_eq!(scene.background, linear_from_srgb8(BACKGROUND));
    }
}

#[test]
fn a_portrait_of_a_bust_holds_its_head_and_leaves_out_its_lower_edge() {
    for aspect in [0.7, 1.0, 16.0 / 9.0] {
        let scene = portrait(pack(), aspect);
        let view = View { framing: Framing::Portrait, ..View::FRONT };
        assert_eq!(scene, view.scene(pack(), aspect, BACKGROUND, Light::studio()));
        let camera = scene.camera;
        let at = |p: Vec3| camera.clip_from_world().project_point3(p);
        let (head, all) = (pack().head().unwrap(), pack().bounds().unwrap());
        for corner in [head.min, head.max] {
            let seen = at(corner.with_z(head.center().z));
            assert!(seen.x.abs() < 1.0 && seen.y.abs() < 1.0, "{aspect}: {seen}");
        }
        let below = at(Vec3::new(0.0, all.min.y, head.center().z));
        assert!(below.y < -1.0, "{aspect}: the bust's edge is seen at {below}");
    }
}

#[test]
fn a_portrait_holds_hair_that_stands_and_is_the_same_with_hair_that_lies() {
    let head = pack().head().unwrap();
    let height = head.size().y;
    let camera = |rises: f32| {
        let hair_top = Some(head.max.y + rises * height);
        View { framing: Framing::Portrait, hair_top, ..View::FRONT }.camera(pack(), 1.0)
    };
    assert_eq!(camera(0.08), portrait(pack(), 1.0).camera);
    for rises in [0.3, 0.5] {
        let top = head.center().with_y(head.max.y + rises * height);
        let at = |camera: Camera| camera.clip_from_world().project_point3(top).y;
        assert!((0.8..1.0).contains(&at(camera(rises))), "{rises}: {}", at(camera(rises)));
        assert!(at(camera(0.0)) > 1.0, "{rises}: it is cut otherwise");
    }
    // Whatever a file says, a picture has a head.
    assert_eq!(camera(1e30), camera(2.0));
    assert_eq!(camera(f32::NAN), camera(0.0));
}

#[test]
fn nearer_framings_show_more_of_less() {
    let distance = |framing: Framing| {
        let view = View { framing, ..View::FRONT };
        let camera = view.camera(pack(), 1.0);
        camera.eye().z
    };
    let whole = distance(Framing::Whole);
    assert!(distance(Framing::Head) < whole, "this avatar has shoulders");
    assert!(distance(Framing::Face) < distance(Framing::Head));
    assert!(distance(Framing::Head) < distance(Framing::Portrait) && distance(Framing::Portrait) < whole);
    let eye = pack().parts().iter().position(|part| part.name == "left-eyeball").unwrap();
    assert!(distance(Framing::Part(eye)) < distance(Framing::Face));
    assert_eq!(distance(Framing::Part(999)), whole, "no such part");
    let moved = View { pan: [0.25, 0.0], ..View::FRONT }.camera(pack(), 1.0);
    let center = moved.clip_from_world().project_point3(pack().bounds().unwrap().center());
    assert!((center.x - 0.5).abs() < 1e-3, "a quarter of the height is half of what is from the middle up");
}

/// How far apart two points are in the picture that lie one unit apart, one above the other, where the box is
/// nearest to the eye: by the camera's own matrix.
#[test]
fn a_unit_has_as_many_pixels_as_the_camera_gives_it() {
    let bounds = pack().bounds().unwrap();
    for [width, height] in [[640, 360], [300, 300], [90, 160]] {
        let view = View::FRONT;
        let camera = view.camera(pack(), width as f32 / height as f32);
        let eye = camera.eye();
        let near = eye.max(bounds.min).min(bounds.max);
        let row = |point: Vec3| {
            let clip = camera.clip_from_world() * point.extend(1.0);
            (0.5 - 0.5 * clip.y / clip.w) * height as f32
        };
        let expected = row(near - 0.5 * Vec3::Y) - row(near + 0.5 * Vec3::Y);
        let found = view.pixels_per_unit(pack(), [width, height]);
        assert!((found / expected - 1.0).abs() < 1e-3, "{width} × {height}: {found} of {expected}");
    }
}
