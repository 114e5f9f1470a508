use super::skin;
use crate::{anatomy::MOUTH_HALF_WIDTH, mesh};

#[test]
fn shifted_normals_are_those_of_the_moved_surface() {
    let m = skin();
    // Vertices split at a fold have normals of their own: they are told apart by place and normal.
    let mut known = std::collections::BTreeMap::new();
    let key = |i: usize| (m.p[i].to_array().map(f64::to_bits), m.n[i].to_array().map(f64::to_bits));
    let welded: Vec<usize> = (0..m.p.len()).map(|i| *known.entry(key(i)).or_insert(i)).collect();
    let triangles: Vec<[usize; 3]> = m.triangles.iter().map(|t| t.map(|i| welded[i])).collect();
    let base = mesh::normals(&m.p, &triangles);
    for k in 0..2 {
        let moved: Vec<_> = m.p.iter().zip(&m.skin).map(|(p, s)| *p + s.shapes[k].0).collect();
        let turned = mesh::normals(&moved, &triangles);
        let mut largest = 0.0_f64;
        for i in 0..m.p.len() {
            let said = (m.n[i] + m.skin[i].shapes[k].1).normalize_or_zero();
            // The base normal may differ from the mesh's (it is the solid's); the shape must not add to that.
            let allowed = m.n[i].angle_between(base[welded[i]]) + 0.12;
            let off = said.angle_between(turned[welded[i]]);
            assert!(off < allowed, "shape {k}: {:.1} degrees off at {}", off.to_degrees(), m.p[i]);
            largest = largest.max(m.skin[i].shapes[k].1.length());
        }
        assert!(largest > 0.1, "shape {k} turns normals");
    }
}

#[test]
fn the_smile_lifts_and_the_frown_lowers_the_corners() {
    let m = skin();
    let corner = (0..m.p.len())
        .filter(|&i| m.p[i].z > 2.5)
        .min_by(|&a, &b| {
            let off = |i: usize| (m.p[i].x - MOUTH_HALF_WIDTH).abs() + (m.p[i].y + 5.63).abs();
            off(a).total_cmp(&off(b))
        })
        .unwrap();
    let [smile, frown] = m.skin[corner].shapes.map(|s| s.0);
    assert!(smile.x > 0.2 && smile.y > 0.3 && smile.z < 0.0, "{smile}");
    assert!(frown.y < -0.3, "{frown}");
    for (p, s) in m.p.iter().zip(&m.skin) {
        if p.y < -12.0 || p.z < -6.0 {
            assert!(s.shapes.iter().all(|(d, _)| d.length() < 1e-3), "{p} moves");
        }
    }
}
