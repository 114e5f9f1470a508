//! Hair as the GPU grew it, read back from the buffers that are drawn: on the deformed skin, as the CPU's
//! twin says.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]
#![allow(clippy::disallowed_methods, reason = "it reads the built-in avatar")]

use crate::common::head::weights_of_skin;
use crate::common::nearest::Nearest;
use crate::common::{gpu, scene};
use avatar_groom::{DensityMap, Groom, Root, SEGMENTS, Strand, Style, Triangle, grow, grow_guide};
use avatar_mesh::{Deformed, Mesh, deform};
use avatar_pack::{FaceState, Pack, Source, SourceError, Texture, Textures};
use avatar_render::headless::{Gpu, render_image};
use avatar_render::{
    AvatarModel, AvatarState, Deformer, Grower, HairDetail, HairError, PartBones, PartDesc, PartTextures,
};
use glam::Vec3;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

struct Folder(PathBuf);

impl Source for Folder {
    fn read(&self, name: &str) -> Result<Option<Cow<'_, [u8]>>, SourceError> {
        Ok(std::fs::read(self.0.join(name)).ok().map(Cow::Owned))
    }
}

fn avatar() -> (Pack, DensityMap) {
    let folder = Folder(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/marsienne"));
    let pack = Pack::load(&folder).expect("the built-in avatar");
    let textures = Textures::load(&folder);
    let map = textures.get(Texture::HairDensity).expect("a map of hair");
    let reds = map.as_raw().iter().copied().step_by(4).collect();
    (pack, DensityMap::new(map.width(), map.height(), reds).expect("a map"))
}

fn groom(pack: &Pack, density: &DensityMap, style: Style, strands: f32) -> Groom {
    let eyes: Vec<_> =
        ["right-eyeball", "left-eyeball"].iter().filter_map(|name| pack.part(name)?.mesh.bounds()).collect();
    Groom::on_head(&pack.parts()[0].mesh, pack.head(), density, &eyes, style, strands, 7)
}

/// The skin alone, without hair.
fn bald(gpu: &Gpu, pack: &Pack) -> AvatarModel {
    let part = PartDesc {
        label: "skin",
        mesh: &pack.parts()[0].mesh,
        first_weight: 0,
        kind: pack.parts()[0].kind,
        bones: PartBones::PerVertex,
        textures: PartTextures::default(),
    };
    AvatarModel::new(&gpu.device, &gpu.queue, &[part], pack.palette().len()).expect("a model")
}

/// A head with hair on the GPU, and what its face does.
struct Head<'a> {
    gpu: &'a Gpu,
    pack: &'a Pack,
    model: AvatarModel,
    state: AvatarState,
    deformer: Deformer,
    grower: Grower,
    face: FaceState,
    posed: Deformed,
}

impl<'a> Head<'a> {
    fn new(gpu: &'a Gpu, pack: &'a Pack, groom: &Groom) -> Self {
        let skin = &pack.parts()[0].mesh;
        let mut model = bald(gpu, pack);
        model.set_hair(&gpu.device, &gpu.queue, 0, Some(groom)).expect("hair");
        Self {
            gpu,
            pack,
            state: AvatarState::new(&gpu.device, &model),
            model,
            deformer: Deformer::new(&gpu.device),
            grower: Grower::new(&gpu.device),
            face: FaceState::new(pack),
            posed: skin.deformed(),
        }
    }

    /// The strands of a pose from the GPU; the skin from the CPU.
    fn strands(&mut self, values: &[f32]) -> Vec<Strand> {
        let (pack, gpu) = (self.pack, self.gpu);
        self.face.pose(pack, values).expect("a pose");
        let weights = weights_of_skin(pack, &self.face);
        self.state.set(&gpu.queue, self.face.bones(), weights).expect("lengths fit");
        let skin = &pack.parts()[0].mesh;
        deform(skin, self.face.bones(), weights, &mut self.posed).expect("lengths fit");
        let Self { deformer, grower, model, state, .. } = self;
        grower.run(&gpu.device, &gpu.queue, deformer, model, state).expect("strands")
    }

    /// The skin from the GPU.
    fn posed_by_gpu(&self) -> Deformed {
        let Self { gpu, deformer, model, state, .. } = self;
        deformer.run(&gpu.device, &gpu.queue, model, state, 0).expect("a skin")
    }

    /// Panics where a strand does not start on the skin, along its normal.
    fn assert_stands(&self, groom: &Groom, strands: &[Strand], pose: &str) {
        assert_eq!(strands.len(), groom.strands().len());
        for (i, (root, points)) in groom.strands().iter().map(|strand| &strand.root).zip(strands).enumerate()
        {
            let Triangle { positions, normals } = triangle(&self.posed, root);
            let on_skin: Vec3 = (0..3).map(|k| positions[k] * root.barycentric[k]).sum();
            let off = on_skin.distance(points[0]) / groom.height();
            assert!(off <= 1e-4, "{pose}, strand {i}: {off} off the skin");
            let normal: Vec3 = (0..3).map(|k| normals[k] * root.barycentric[k]).sum();
            let leaves = (points[1] - points[0]).normalize_or_zero().dot(normal.normalize_or_zero());
            assert!(leaves > 1f32.to_radians().cos(), "{pose}, strand {i}: {leaves}");
        }
    }
}

fn triangle(posed: &Deformed, root: &Root) -> Triangle {
    let corner = |k: usize| root.corners[k] as usize;
    Triangle {
        positions: [0, 1, 2].map(|k| posed.positions[corner(k)]),
        normals: [0, 1, 2].map(|k| posed.normals[corner(k)]),
    }
}

/// All of a face's poses, whole.
fn poses(pack: &Pack) -> Vec<(String, Vec<f32>)> {
    let whole = pack.poses().iter().map(|pose| {
        let mut values = pack.controls().defaults();
        pose.values.iter().for_each(|&(control, value)| values[control] = value);
        (pose.name.clone(), values)
    });
    whole.collect()
}

#[test]
fn strands_stand_on_the_deformed_skin_and_are_those_of_the_cpu_in_every_pose() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    for (_, style) in Style::PRESETS {
        let groom = groom(&pack, &density, style, 3000.0);
        let mut head = Head::new(gpu, &pack, &groom);
        for (pose, values) in poses(&pack) {
            let strands = head.strands(&values);
            head.assert_stands(&groom, &strands, &pose);
            let bones = head.face.bones();
            // Of the very skin that the GPU grows on: what rounding does to hair that stands on end is not
            // growth's.
            let posed = head.posed_by_gpu();
            let of = |strand: usize| triangle(&posed, &groom.strands()[strand].root);
            for (i, points) in strands.iter().enumerate() {
                let guide = groom.guide(i).map(|g| grow_guide(&groom, g, &of(g), bones).expect("a guide"));
                let twin = grow(&groom, i, &of(i), bones, guide.as_ref()).expect("a strand");
                for k in 0..=SEGMENTS {
                    let off = twin[k].distance(points[k]) / groom.height();
                    assert!(off <= 1e-4, "{pose}, strand {i}, point {k}: {off}");
                }
            }
        }
    }
}

#[test]
fn strands_stand_on_the_skin_in_any_pose() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    let groom = groom(&pack, &density, Style::SHORT, 2000.0);
    let mut head = Head::new(gpu, &pack, &groom);
    let mut bits = 1u32;
    let mut unit = move || {
        // Numerical Recipes' generator; its upper bits.
        bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (bits >> 8) as f32 / (1u32 << 24) as f32
    };
    for pose in 0..200 {
        let values: Vec<f32> = (pack.controls().controls().iter())
            .map(|control| control.min + (control.max - control.min) * unit())
            .collect();
        let strands = head.strands(&values);
        head.assert_stands(&groom, &strands, &format!("pose {pose}"));
    }
}

#[test]
fn no_strand_is_under_the_skin_in_any_pose_of_the_pack() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    for (name, style) in Style::PRESETS {
        let groom = groom(&pack, &density, style, 3000.0);
        let mut head = Head::new(gpu, &pack, &groom);
        assert!(groom.strands().len() > 20, "{name}: {}", groom.strands().len());
        for (pose, values) in poses(&pack) {
            let strands = head.strands(&values);
            let nearest = Nearest::new(&head.posed.positions, &pack.parts()[0].mesh.triangles);
            for (i, points) in strands.iter().enumerate() {
                for (k, point) in points.iter().enumerate() {
                    let depth = nearest.depth(*point) / groom.height();
                    assert!(depth <= 0.005, "{name}, {pose}, strand {i}, point {k}: {depth} at {point}");
                }
            }
        }
    }
}

#[test]
fn there_may_be_far_more_strands_than_a_head_has() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    let groom = groom(&pack, &density, Style::SHORT, 400_000.0);
    assert!(groom.strands().len() > 150_000, "{}", groom.strands().len());
    let mut head = Head::new(gpu, &pack, &groom);
    let strands = head.strands(&pack.controls().defaults());
    head.assert_stands(&groom, &strands, "defaults");
    let scene = scene(70.0);
    for share in [0.0, 0.5, 1.0] {
        head.state.set_hair_detail(HairDetail { share, ..HairDetail::default() });
        render_image(gpu, 48, 48, 4, &scene, &[(&head.model, &head.state)]).expect("a picture");
    }
}

#[test]
fn hair_is_seen_and_bald_heads_and_roots_of_other_meshes_are_told_apart() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    let skin = &pack.parts()[0].mesh;
    let mut model = bald(gpu, &pack);
    let scene = scene(70.0);
    let draw = |model: &AvatarModel| {
        let state = AvatarState::new(&gpu.device, model);
        render_image(gpu, 96, 96, 4, &scene, &[(model, &state)]).expect("a picture")
    };
    let bare = draw(&model);
    let groom = groom(&pack, &density, Style::BOB, 8000.0);
    model.set_hair(&gpu.device, &gpu.queue, 0, Some(&groom)).expect("hair");
    assert_eq!(model.strand_count(), groom.strands().len());
    let covered = draw(&model);
    let changed = bare.rgba.iter().zip(&covered.rgba).filter(|(a, b)| a.abs_diff(**b) > 10).count();
    assert!(changed > 2000, "{changed}");
    assert_eq!(draw(&model).rgba, covered.rgba, "the same bytes again");
    model.set_hair(&gpu.device, &gpu.queue, 0, None).expect("none");
    assert_eq!(draw(&model).rgba, bare.rgba);

    // A state knows the hair that it was made for, even where other hair has as many strands.
    let before = AvatarState::new(&gpu.device, &model);
    model.set_hair(&gpu.device, &gpu.queue, 0, Some(&groom)).expect("hair");
    let stale = render_image(gpu, 8, 8, 4, &scene, &[(&model, &before)]);
    assert!(stale.is_err(), "the state of the bald head");
    let before = AvatarState::new(&gpu.device, &model);
    model.set_hair(&gpu.device, &gpu.queue, 0, Some(&groom)).expect("hair");
    assert!(
        render_image(gpu, 8, 8, 4, &scene, &[(&model, &before)]).is_err(),
        "the state of the hair before"
    );

    let mut refuse =
        |wrong: Groom| model.set_hair(&gpu.device, &gpu.queue, 0, Some(&wrong)).expect_err("refused");
    // All of the skin on a bone that the model does not have.
    let mut mesh = skin.clone();
    let skinning = mesh.skinning.as_mut().expect("a skin");
    skinning.bones.iter_mut().for_each(|bones| *bones = [77; 4]);
    let planted = |mesh: &Mesh| Groom::new(mesh, &density, &[], Style::BOB, 100.0, 7);
    assert_eq!(refuse(planted(&mesh)), HairError::Bone { found: 77, bones: pack.palette().len() as u32 });
    // A skin with twice the vertices, of which the triangles have the second half.
    let mut mesh = skin.clone();
    let vertices = skin.positions.len() as u32;
    mesh.positions.extend_from_within(..);
    mesh.normals.extend_from_within(..);
    mesh.uvs.extend_from_within(..);
    mesh.triangles.iter_mut().flatten().for_each(|corner| *corner += vertices);
    mesh.skinning = None;
    let other = planted(&mesh);
    let found = other.strands()[0].root.corners[0];
    let refused = model.set_hair(&gpu.device, &gpu.queue, 0, Some(&other));
    assert_eq!(refused, Err(HairError::Corner { strand: 0, found, vertices }));
    let refused = model.set_hair(&gpu.device, &gpu.queue, 9, Some(&groom));
    assert_eq!(refused, Err(HairError::NoSuchPart { parts: 1, found: 9 }));
}
