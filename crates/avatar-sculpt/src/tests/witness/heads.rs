//! The two heads and what each shape does to them.

use std::{collections::BTreeMap, fs, path::Path};

use glam::{DMat3, DVec3};

use super::super::{Turn, eye, lids, mesh, sculpture, skin};
use crate::{
    anatomy::JAW,
    arkit::{self, Moved},
    bake::Bvh,
    mesh::normals,
    parts::teeth,
};

/// Kinds of surface that can be compared between the heads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Organ {
    Skin,
    LeftEye,
    RightEye,
    UpperTeeth,
    LowerTeeth,
    Tongue,
}

/// Points of a head's surfaces: places, normals, the area that each stands for, and the surface.
#[derive(Default)]
pub(super) struct Head {
    pub(super) p: Vec<DVec3>,
    pub(super) n: Vec<DVec3>,
    pub(super) area: Vec<f64>,
    pub(super) organ: Vec<Option<Organ>>,
}

impl Head {
    /// Adds a mesh whose vertices belong to organs; those without one do not take part.
    fn add(&mut self, p: &[DVec3], triangles: &[[usize; 3]], organ: impl Fn(usize) -> Option<Organ>) {
        let mut area = vec![0.0; p.len()];
        for t in triangles {
            let a = 0.5 * (p[t[1]] - p[t[0]]).cross(p[t[2]] - p[t[0]]).length();
            t.iter().for_each(|&i| area[i] += a / 3.0);
        }
        let n = normals(p, triangles);
        let sight = Sight::new(p, triangles);
        self.organ.extend((0..p.len()).map(|i| {
            // The insides of mouth and sockets are built in different ways, and nobody sees them.
            organ(i).filter(|organ| *organ != Organ::Skin || sight.sees(p[i], n[i]))
        }));
        self.n.extend(n);
        self.p.extend_from_slice(p);
        self.area.extend(area);
    }
}

/// Which points of a surface are seen from outside.
struct Sight {
    tree: Bvh,
    /// From the front, both sides, above and below; none runs along an axis, where boxes have no inverse.
    views: [DVec3; 5],
}

impl Sight {
    fn new(p: &[DVec3], triangles: &[[usize; 3]]) -> Self {
        let views = [(0.01, 0.01), (0.9, 0.01), (-0.9, 0.01), (0.01, 0.7), (0.01, -0.7)];
        let views = views.map(|(x, y)| DVec3::new(x, y, 1.0).normalize_or_zero());
        Self { tree: Bvh::new(triangles.iter().map(|t| t.map(|i| p[i])).collect()), views }
    }

    fn sees(&self, p: DVec3, n: DVec3) -> bool {
        let open =
            |view: &DVec3| n.dot(*view) > 0.05 && self.tree.nearest(p + n * 1e-3, *view, 1e3).is_none();
        self.views.iter().any(open)
    }
}

/// This head, and what all 52 shapes do to it: fields by shape, bones by the ends of their controls.
pub(super) struct Ours {
    pub(super) head: Head,
    moved: Vec<Moved>,
    starts: BTreeMap<&'static str, usize>,
}

impl Ours {
    pub(super) fn new() -> Self {
        let mut head = Head::default();
        let mut starts = BTreeMap::new();
        let m = skin();
        starts.insert("MarsienneSkin", 0);
        head.add(&m.p, &m.triangles, |_| Some(Organ::Skin));
        for (stem, organ) in [
            ("LtEyeBall_smtt", Organ::LeftEye),
            ("RtEyeBall_smtt", Organ::RightEye),
            ("UpperJaw", Organ::UpperTeeth),
            ("LowerJaw", Organ::LowerTeeth),
        ] {
            let m = mesh(stem);
            starts.insert(stem, head.p.len());
            head.add(&m.p, &m.triangles, |i| {
                Some(if organ == Organ::LowerTeeth && teeth::is_tongue(m.uv[i]) {
                    Organ::Tongue
                } else {
                    organ
                })
            });
        }
        Self { head, moved: arkit::moved(sculpture()), starts }
    }

    /// Displacement of every point at weight 1.
    pub(super) fn displacement(&self, name: &str) -> Vec<DVec3> {
        let mut d = vec![DVec3::ZERO; self.head.p.len()];
        if arkit::BY_BONES.contains(&name) {
            self.by_bones(name, &mut d);
            return d;
        }
        let mut known = false;
        // The target closes the lips of an open jaw: what ours does there comes with it.
        let with = if name == "mouthClose" { "jawOpen_mouthClose" } else { name };
        for moved in self.moved.iter().filter(|m| m.name == name || m.name == with) {
            let start = self.starts[moved.stem];
            d[start..].iter_mut().zip(&moved.offsets).for_each(|(d, more)| *d += *more);
            known = true;
        }
        assert!(known, "no shape {name}");
        d
    }

    fn by_bones(&self, name: &str, d: &mut [DVec3]) {
        let side = if name.ends_with("Left") { 1.0 } else { -1.0 };
        let (mut turns, mut rigid): (Vec<Turn>, Vec<(&str, DVec3, DMat3)>) = (vec![], vec![]);
        let eyeball = if side > 0.0 { "LtEyeBall_smtt" } else { "RtEyeBall_smtt" };
        let gaze = |up: f64, left: f64| {
            DMat3::from_rotation_y(left.to_radians()) * DMat3::from_rotation_x(-up.to_radians())
        };
        match name.trim_end_matches("Left").trim_end_matches("Right") {
            "eyeBlink" => turns.extend(lids(side, 45.0, 25.0)),
            // The upper lid follows by the coupling of controls.toml.
            "eyeLookDown" => {
                turns.extend(lids(side, 7.5, 0.0));
                rigid.push((eyeball, eye(side), gaze(-25.0, 0.0)));
            }
            "eyeLookUp" => {
                turns.extend(lids(side, -7.5, 0.0));
                rigid.push((eyeball, eye(side), gaze(25.0, 0.0)));
            }
            "eyeLookIn" => rigid.push((eyeball, eye(side), gaze(0.0, -30.0 * side))),
            "eyeLookOut" => rigid.push((eyeball, eye(side), gaze(0.0, 30.0 * side))),
            jaw => {
                let by = if jaw == "jawOpen" {
                    DMat3::from_rotation_x(20_f64.to_radians())
                } else {
                    DMat3::from_rotation_y((8.0 * side).to_radians())
                };
                turns.push(Turn { bone: 6.0, about: JAW, by });
                rigid.push(("LowerJaw", JAW, by));
            }
        }
        let moved = super::super::deformed(&turns, [0.0, 0.0]);
        for (i, p) in moved.iter().enumerate() {
            d[i] = *p - self.head.p[i];
        }
        for (stem, about, by) in rigid {
            let start = self.starts[stem];
            for (d, p) in d.iter_mut().zip(&self.head.p).skip(start).take(mesh(stem).p.len()) {
                *d = about + by * (*p - about) - *p;
            }
        }
    }
}

/// MakeHuman's base mesh.
pub(super) fn makehuman(data: &Path) -> Head {
    let text = fs::read_to_string(data.join("makehuman-cc0/base.obj")).unwrap();
    let (mut p, mut group) = (vec![], "");
    let mut faces: BTreeMap<&str, Vec<[usize; 3]>> = BTreeMap::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                p.push(DVec3::new(x[0], x[1], x[2]));
            }
            Some("g") => group = words.next().unwrap_or_default(),
            Some("f") => {
                let corners: Vec<usize> =
                    words.map(|w| w.split('/').next().unwrap().parse::<usize>().unwrap() - 1).collect();
                let fan = (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]);
                faces.entry(group).or_default().extend(fan);
            }
            _ => {}
        }
    }
    let organs = [
        ("body", Organ::Skin),
        ("helper-l-eye", Organ::LeftEye),
        ("helper-r-eye", Organ::RightEye),
        ("helper-upper-teeth", Organ::UpperTeeth),
        ("helper-lower-teeth", Organ::LowerTeeth),
        ("helper-tongue", Organ::Tongue),
    ];
    let mut of = vec![None; p.len()];
    let mut triangles = vec![];
    for (group, organ) in organs {
        let found = &faces[group];
        found.iter().flatten().for_each(|&i| of[i] = Some(organ));
        triangles.extend_from_slice(found);
    }
    let mut head = Head::default();
    head.add(&p, &triangles, |i| of[i]);
    head
}

/// The displacement of one of the targets.
pub(super) fn target(data: &Path, name: &str, vertices: usize) -> Vec<DVec3> {
    let path = data.join("talkinghead-arkit-targets").join(format!("{name}.target"));
    let mut d = vec![DVec3::ZERO; vertices];
    for line in fs::read_to_string(path).unwrap().lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let [i, x, y, z] = words[..] {
            let number = |w: &str| w.parse::<f64>().unwrap();
            d[i.parse::<usize>().unwrap()] = DVec3::new(number(x), number(y), number(z));
        }
    }
    d
}
