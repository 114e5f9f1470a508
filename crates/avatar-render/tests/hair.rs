//! Hair as the GPU grew it, read back from the buffers that are drawn: on the deformed skin, as the CPU's twin says.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]
#![allow(clippy::disallowed_methods, reason = "it reads the built-in avatar")]

mod common;

use avatar_groom::{DensityMap, Groom, SEGMENTS, Style, Triangle, grow};
use avatar_mesh::deform;
use avatar_pack::{FaceState, Pack, Source, SourceError, Texture, Textures};
use avatar_render::headless::{Gpu, render_image};
use avatar_render::{
    AvatarModel, AvatarState, Deformer, Grower, HairError, PartBones, PartDesc, PartTextures,
};
use common::{gpu, scene};
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
    Groom::new(&pack.parts[0].mesh, density, &eyes, style, strands, 7)
}

/// The skin alone, without hair.
fn bald(gpu: &Gpu, pack: &Pack) -> AvatarModel {
    let part = PartDesc {
        label: "skin",
        mesh: &pack.parts[0].mesh,
        kind: pack.parts[0].spec.kind,
        bones: PartBones::PerVertex,
        textures: PartTextures::default(),
    };
    AvatarModel::new(&gpu.device, &gpu.queue, &[part], pack.palette.len()).expect("a model")
}

#[test]
fn strands_stand_on_the_deformed_skin_and_are_those_of_the_cpu_in_every_pose() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    let skin = &pack.parts[0].mesh;
    let mut model = bald(gpu, &pack);
    let (deformer, grower) = (Deformer::new(&gpu.device), Grower::new(&gpu.device));
    let mut posed = skin.deformed();
    for (_, style) in Style::PRESETS {
        let groom = groom(&pack, &density, style, 3000.0);
        model.set_hair(&gpu.device, 0, skin, Some(&groom)).expect("hair");
        let mut state = AvatarState::new(&gpu.device, &model);
        let mut face = FaceState::new(&pack);
        for pose in pack.poses.iter() {
            let mut values = pack.controls.defaults();
            pose.values.iter().for_each(|&(control, value)| values[control] = value);
            face.pose(&pack, &values).expect("a pose");
            state.set(&gpu.queue, face.bones(), face.weights()).expect("lengths fit");
            deform(skin, face.bones(), face.weights(), &mut posed).expect("lengths fit");
            let strands = grower.run(&gpu.device, &gpu.queue, &deformer, &model, &state).expect("strands");
            assert_eq!(strands.len(), groom.roots.len());
            // The bone that moves the scalp.
            let head = &face.bones()[1];
            for (i, (root, points)) in groom.roots.iter().zip(&strands).enumerate() {
                let corner = |k: usize| root.corners[k] as usize;
                let positions = [0, 1, 2].map(|k| posed.positions[corner(k)]);
                let normals = [0, 1, 2].map(|k| posed.normals[corner(k)]);
                let on_skin: glam::Vec3 = (0..3).map(|k| positions[k] * root.barycentric[k]).sum();
                let off = on_skin.distance(points[0]) / groom.height;
                assert!(off <= 1e-4, "{}, strand {i}: {off} off the skin", pose.name);
                let normal: glam::Vec3 = (0..3).map(|k| normals[k] * root.barycentric[k]).sum();
                let leaves = (points[1] - points[0]).normalize_or_zero().dot(normal.normalize_or_zero());
                assert!(leaves > 1f32.to_radians().cos(), "{}, strand {i}: {leaves}", pose.name);
                let twin = grow(&groom, i, &Triangle { positions, normals }, head).expect("a strand");
                for k in 0..=SEGMENTS {
                    let off = twin[k].distance(points[k]) / groom.height;
                    assert!(off <= 1e-4, "{}, strand {i}, point {k}: {off}", pose.name);
                }
            }
        }
    }
}

#[test]
fn hair_is_seen_and_bald_heads_and_roots_of_other_meshes_are_told_apart() {
    let Some(gpu) = gpu() else { return };
    let (pack, density) = avatar();
    let skin = &pack.parts[0].mesh;
    let mut model = bald(gpu, &pack);
    let scene = scene(70.0);
    let draw = |model: &AvatarModel| {
        let state = AvatarState::new(&gpu.device, model);
        render_image(gpu, 96, 96, 4, &scene, &[(model, &state)]).expect("a picture")
    };
    let bare = draw(&model);
    let groom = groom(&pack, &density, Style::BOB, 8000.0);
    model.set_hair(&gpu.device, 0, skin, Some(&groom)).expect("hair");
    assert_eq!(model.strand_count(), groom.roots.len());
    let covered = draw(&model);
    let changed = bare.rgba.iter().zip(&covered.rgba).filter(|(a, b)| a.abs_diff(**b) > 10).count();
    assert!(changed > 2000, "{changed}");
    assert_eq!(draw(&model).rgba, covered.rgba, "the same bytes again");
    model.set_hair(&gpu.device, 0, skin, None).expect("none");
    assert_eq!(draw(&model).rgba, bare.rgba);

    let mut wrong = groom.clone();
    wrong.roots[3].corners[1] = u32::MAX;
    let refused = model.set_hair(&gpu.device, 0, skin, Some(&wrong));
    let vertices = skin.positions.len() as u32;
    assert_eq!(refused, Err(HairError::Corner { strand: 3, found: u32::MAX, vertices }));
    let refused = model.set_hair(&gpu.device, 9, skin, Some(&groom));
    assert_eq!(refused, Err(HairError::NoSuchPart { parts: 1, found: 9 }));
}
