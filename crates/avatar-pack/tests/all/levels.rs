//! Levels of detail: how far the simplified face is from the whole one.
#![allow(clippy::expect_used, reason = "a test: it may panic")]

use crate::common::marsienne;
use avatar_pack::{FaceState, Level, Pack};
use glam::Vec3;

fn posed(pack: &Pack, values: &[f32], part: usize) -> Vec<Vec3> {
    let mut state = FaceState::new(pack);
    state.pose(pack, values).expect("values fit");
    state.deform(pack, part).expect("a part").positions
}

/// Square of the distance from a point to a triangle, by looking at a fine raster of it and halving the step
/// around the best place: slow, and another way than the library's.
fn distance(point: Vec3, [a, b, c]: [Vec3; 3]) -> f32 {
    let at = |u: f32, v: f32| a + (b - a) * u + (c - a) * v;
    let (mut best, mut step) = ([1.0 / 3.0, 1.0 / 3.0], 1.0 / 3.0);
    for _ in 0..24 {
        let [u0, v0] = best;
        let near = |[u, v]: &[f32; 2]| point.distance_squared(at(*u, *v));
        let steps: [f32; 3] = [-1.0, 0.0, 1.0];
        let places = steps.iter().flat_map(|du| steps.map(|dv| [u0 + du * step, v0 + dv * step]));
        // Back into the triangle.
        let places = places.map(|[u, v]| {
            let (u, v) = (u.max(0.0), v.max(0.0));
            let sum = (u + v).max(1.0);
            [u / sum, v / sum]
        });
        best = places.min_by(|one, other| near(one).total_cmp(&near(other))).unwrap_or(best);
        step *= 0.75;
    }
    point.distance_squared(at(best[0], best[1]))
}

#[test]
fn levels_stay_within_a_quarter_of_a_pixel_of_the_face_in_every_pose() {
    let pack = marsienne();
    let height = pack.bounds().expect("a face").size().y;
    let levels = Level::all(&pack, false);
    let triangles = |pack: &Pack| pack.parts().iter().map(|part| part.mesh.triangles.len()).sum::<usize>();
    let mut before = triangles(&pack);
    for (level, pixels) in levels.iter().zip(Level::HEIGHTS) {
        let quarter_pixel = 0.25 * height / pixels;
        assert!(level.error <= quarter_pixel, "{} of {quarter_pixel}", level.error);
        assert!(triangles(&level.pack) * 5 < before * 4, "{} of {before}", triangles(&level.pack));
        before = triangles(&level.pack);
    }
    // The last level, against the nearest place of the whole surface in space.
    let last = levels.last().expect("levels");
    let skin = pack.parts().iter().position(|part| part.name == "skin").expect("a skin");
    for name in ["neutral", "smile", "surprise"] {
        let mut values = pack.controls().defaults();
        let pose = pack.poses().iter().find(|pose| pose.name == name).expect(name);
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        let (whole, few) = (posed(&pack, &values, skin), posed(&last.pack, &values, skin));
        let triangles = &last.pack.parts()[skin].mesh.triangles;
        let corners: Vec<[Vec3; 3]> =
            triangles.iter().map(|t| t.map(|vertex| few[vertex as usize])).collect();
        // With some slack for the raster of `distance`.
        let most = (last.error * 1.05).powi(2);
        for vertex in (0..whole.len()).step_by(61) {
            let is_near = |corners: &&[Vec3; 3]| {
                let reach = corners[0].distance(corners[1]).max(corners[0].distance(corners[2]));
                corners[0].distance(whole[vertex]) <= reach + last.error
            };
            let near = corners.iter().filter(is_near).map(|corners| distance(whole[vertex], *corners));
            let least = near.fold(f32::INFINITY, f32::min);
            assert!(least <= most, "{name}, vertex {vertex}: {} of {}", least.sqrt(), last.error);
        }
    }
}

#[test]
fn a_level_alone_is_the_same_as_among_all() {
    let pack = marsienne();
    let all = Level::all(&pack, true);
    let alone = Level::new(&pack, 2, true);
    assert_eq!(alone.error, all[1].error);
    for ((part, other), whole) in alone.pack.parts().iter().zip(all[1].pack.parts()).zip(pack.parts()) {
        assert_eq!(part.mesh, other.mesh);
        // Hair grows by the triangles of the skin.
        assert!((part.mesh.triangles == whole.mesh.triangles) == (part.name == "skin"), "{}", part.name);
    }
    assert_eq!(Level::new(&pack, 0, false).pack.parts()[0].mesh, pack.parts()[0].mesh);
}

#[test]
fn small_pictures_have_few_triangles() {
    let pack = marsienne();
    let height = pack.bounds().expect("a face").size().y;
    let of_height = |pixels: f32| Level::for_pixels(&pack, pixels / height);
    assert_eq!(
        [700.0, 361.0, 359.0, 181.0, 179.0, 91.0, 89.0, 44.0, 1.0].map(of_height),
        [0, 0, 1, 1, 2, 2, 3, 4, 4]
    );
    assert_eq!([f32::INFINITY, f32::NAN].map(of_height), [0, 0]);
}
