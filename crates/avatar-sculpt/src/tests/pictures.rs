//! What the pictures show, painted small.

use std::sync::OnceLock;

use glam::{DVec2, DVec3};
use image::RgbImage;

use super::{sculpture, skin};
use crate::{
    pack,
    paint::{Complexion, Detail},
};

fn picture(name: &str) -> RgbImage {
    static PICTURES: OnceLock<pack::Pack> = OnceLock::new();
    let all =
        PICTURES.get_or_init(|| pack::pictures(sculpture(), Detail::Draft, &Complexion::default()).unwrap());
    let (_, bytes) = all.files.iter().find(|(n, _)| n == name).unwrap();
    image::load_from_memory(bytes).unwrap().into_rgb8()
}

/// Texture coordinates of the vertex of the left half nearest to a place.
fn uv_near(p: DVec3) -> DVec2 {
    let m = skin();
    let nearest = (0..m.p.len()).min_by(|&a, &b| m.p[a].distance(p).total_cmp(&m.p[b].distance(p))).unwrap();
    m.uv[nearest]
}

fn at(picture: &RgbImage, uv: DVec2) -> [f64; 3] {
    let p = (uv * f64::from(picture.width())).floor();
    let last = picture.width() - 1;
    picture.get_pixel((p.x as u32).min(last), (p.y as u32).min(last)).0.map(|c| f64::from(c) / 255.0)
}

fn forehead() -> DVec2 {
    uv_near(DVec3::new(0.8, 4.5, 3.9))
}

#[test]
fn hollows_are_in_the_shade() {
    let shade = picture("SkinTex_AO.png");
    let open = at(&shade, forehead())[0];
    assert!(open > 0.9, "forehead {open}");
    let places = [
        ("where throat and chin meet", DVec3::new(0.3, -10.2, -2.2), 0.90),
        ("bottom of the mouth", DVec3::new(0.3, -6.5, -1.0), 0.45),
        ("nostril", DVec3::new(0.45, -3.45, 4.7), 0.75),
        ("behind the eyeball", DVec3::new(3.4, 0.3, -0.3), 0.30),
        ("behind the ear", DVec3::new(6.9, -0.6, -6.4), 0.80),
    ];
    for (name, p, most) in places {
        let found = at(&shade, uv_near(p))[0];
        assert!(found < most, "{name}: {found}");
    }
}

#[test]
fn the_shade_has_no_specks() {
    let shade = picture("SkinTex_AO.png");
    let side = shade.width();
    let value = |x: u32, y: u32| f64::from(shade.get_pixel(x, y).0[0]) / 255.0;
    // The face's island; a speck is a pixel far off all of its neighbours on one side.
    for y in 1..side * 88 / 100 {
        for x in side / 4..side * 3 / 4 {
            let around: Vec<f64> =
                [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].iter().map(|&(i, j)| value(i, j)).collect();
            let (low, high) = around.iter().fold((1.0_f64, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
            let off = (low - value(x, y)).max(value(x, y) - high);
            assert!(off < 0.12, "speck of {off:.2} at {x}, {y}");
        }
    }
}

#[test]
fn thin_flesh_is_found_thin() {
    let thickness = picture("SkinTex_Thickness.png");
    let cheek = at(&thickness, uv_near(DVec3::new(4.0, -3.0, 3.0)))[0];
    let rim = at(&thickness, uv_near(DVec3::new(8.3, 1.2, -6.7)))[0];
    let wing = at(&thickness, uv_near(DVec3::new(1.25, -3.2, 4.4)))[0];
    assert!(cheek > 0.8 && rim < 0.3 && wing < 0.7, "cheek {cheek}, rim {rim}, wing {wing}");
}

#[test]
fn normals_of_the_relief_are_unit_vectors_outward() {
    let map = picture("SkinTex_Normal.png");
    let mut tilted = 0;
    for pixel in map.pixels() {
        let n = DVec3::from_array(pixel.0.map(|c| f64::from(c) / 127.5 - 1.0));
        assert!((n.length() - 1.0).abs() < 0.02 && n.z > 0.5, "{n}");
        tilted += usize::from(n.z < 0.995);
    }
    assert!(tilted > 2000, "{tilted} pixels of relief");
}

#[test]
fn hair_grows_on_scalp_and_brows_only() {
    let hair = picture("HairMap.png");
    assert!(at(&hair, uv_near(DVec3::new(2.0, 11.0, -5.0)))[0] > 0.9);
    assert!(at(&hair, uv_near(DVec3::new(3.2, 2.55, 4.0)))[0] > 0.1);
    for p in [DVec3::new(0.8, 4.5, 3.9), DVec3::new(3.0, -3.0, 3.5), DVec3::new(0.5, -8.5, 4.0)] {
        assert!(at(&hair, uv_near(p))[0] < 0.02, "{p}");
    }
}
