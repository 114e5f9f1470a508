//! Scenes of any content that GLB has a word for.

use avatar_exchange::{
    AlphaMode, Channel, ChannelTarget, Clip, Interpolation, Material, Node, RawScene, SceneImage, ScenePart,
    Skin, TextureRef, Transform, Trs, UvSet, Wrap,
};
use avatar_mesh::{Mesh, Shape, Skinning};
use glam::{Affine3A, Mat3A, Quat, Vec2, Vec3, Vec3A, Vec4};

/// SplitMix64 (Steele, Lea and Flood, 2014).
pub struct Random(pub u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, limit: usize) -> usize {
        (self.next() % limit as u64) as usize
    }

    fn chance(&mut self, of: usize) -> bool {
        self.below(of) == 0
    }

    /// From −1 to 1.
    pub fn float(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    /// From 0 to 1.
    fn share(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }

    fn vec3(&mut self) -> Vec3 {
        Vec3::new(self.float(), self.float(), self.float())
    }

    fn unit(&mut self) -> Vec3 {
        self.vec3().try_normalize().unwrap_or(Vec3::X)
    }

    fn quat(&mut self) -> Quat {
        let [x, y, z, w] = [self.float(), self.float(), self.float(), self.float() + 2.0];
        Quat::from_xyzw(x, y, z, w).normalize()
    }

    fn some(&mut self, length: usize) -> Option<usize> {
        if length == 0 || self.chance(3) { None } else { Some(self.below(length)) }
    }

    fn text(&mut self) -> String {
        let texts = ["", "a", "Ærlig \"Grün\"\\ 漢字", "\u{1}\n", "smile"];
        texts[self.below(texts.len())].to_owned()
    }
}

/// A scene that is the same after writing and reading.
pub fn scene(seed: u64) -> RawScene {
    let mut r = Random(seed);
    let mut scene = RawScene::default();
    for number in 0..r.below(12) {
        let local = if r.chance(5) { sheared(&mut r) } else { Transform::Trs(trs(&mut r)) };
        // Below the first node, so that the joints of skins share a root.
        let parent = (number > 0).then(|| r.below(number));
        let name = format!("{}{number}", r.text());
        scene.nodes.push(Node { name, parent, local, weights: Vec::new() });
    }
    let nodes = scene.nodes.len();
    if nodes == 0 {
        return scene;
    }
    for _ in 0..r.below(3) {
        let joints: Vec<usize> = (0..nodes).filter(|_| !r.chance(3)).collect();
        let joints = if joints.is_empty() { vec![0] } else { joints };
        let inverse_binds = joints.iter().map(|_| affine(&mut r)).collect();
        scene.skins.push(Skin { name: r.text(), joints, inverse_binds });
    }
    for number in 0..r.below(3) {
        let bytes = [
            b"\x89PNG\r\n\x1a\n".to_vec(),
            vec![0xff, 0xd8, 0xff, number as u8],
            b"RIFF\x04\0\0\0WEBP".to_vec(),
        ];
        let which = r.below(3);
        let mime = ["image/png", "image/jpeg", "image/webp"][which].to_owned();
        scene.images.push(SceneImage { name: r.text(), mime, bytes: bytes[which].clone() });
    }
    for _ in 0..r.below(4) {
        let material = material(&mut r, scene.images.len());
        scene.materials.push(material);
    }
    for node in 0..nodes {
        if r.chance(3) {
            continue;
        }
        let skin = r.some(scene.skins.len());
        let shapes: Vec<String> = (0..r.below(4)).map(|k| format!("{}.{k}", r.text())).collect();
        scene.nodes[node].weights = shapes.iter().map(|_| r.float()).collect();
        for primitive in 0..1 + r.below(2) {
            let mut mesh = mesh(&mut r, &shapes, skin.map(|skin| scene.skins[skin].joints.len()));
            if !r.chance(2) {
                mesh.tangents = mesh.positions.iter().map(|_| tangent(&mut r)).collect();
            }
            if !mesh.tangents.is_empty() && r.chance(2) {
                let moved = |r: &mut Random| mesh.positions.iter().map(|_| r.unit()).collect::<Vec<_>>();
                let moved: Vec<_> = mesh.shapes.iter().map(|_| moved(&mut r)).collect();
                mesh.shapes
                    .iter_mut()
                    .zip(moved)
                    .for_each(|(shape, moved)| shape.tangents = Some(moved.into()));
            }
            let material = r.some(scene.materials.len());
            let mut textures = material.into_iter().flat_map(|material| scene.materials[material].textures());
            if textures.any(|texture| texture.uvs == UvSet::Second) || r.chance(4) {
                mesh.uvs_1 = mesh.positions.iter().map(|_| Vec2::new(r.float(), r.float()) * 4.0).collect();
            }
            if r.chance(3) {
                let color = |r: &mut Random| Vec4::new(r.share(), r.share(), r.share(), r.share());
                mesh.colors = mesh.positions.iter().map(|_| color(&mut r)).collect();
            }
            let name = scene.nodes[node].name.clone();
            scene.parts.push(ScenePart { name, node, primitive, mesh, material, skin });
        }
    }
    for _ in 0..r.below(3) {
        let clip = clip(&mut r, &scene.nodes);
        if !clip.channels.is_empty() {
            scene.clips.push(clip);
        }
    }
    scene
}

fn trs(r: &mut Random) -> Trs {
    let scale = if r.chance(2) { Vec3::ONE } else { r.vec3() };
    Trs { translation: r.vec3(), rotation: r.quat(), scale }
}

fn affine(r: &mut Random) -> Affine3A {
    let cols = [(); 4].map(|()| Vec3A::from(r.vec3()));
    Affine3A { matrix3: Mat3A::from_cols(cols[0], cols[1], cols[2]), translation: cols[3] }
}

/// Of no rotation and scale, whatever the numbers are.
fn sheared(r: &mut Random) -> Transform {
    let matrix3 = Mat3A::from_cols(Vec3A::X, Vec3A::new(0.5 + r.share(), 1.0, 0.0), Vec3A::Z);
    Transform::Matrix(Affine3A { matrix3, translation: r.vec3().into() })
}

fn tangent(r: &mut Random) -> Vec4 {
    let handedness = if r.chance(2) { 1.0 } else { -1.0 };
    r.unit().extend(handedness)
}

fn mesh(r: &mut Random, shapes: &[String], joints: Option<usize>) -> Mesh {
    let vertices = 1 + if r.chance(8) { r.below(600) } else { r.below(40) };
    let triangles = 1 + r.below(20);
    let offsets = |r: &mut Random| -> Vec<Vec3> {
        let rare = 1 + r.below(20);
        (0..vertices).map(|_| if r.chance(rare) { r.vec3() } else { Vec3::ZERO }).collect()
    };
    let shapes = shapes.iter().map(|name| {
        let shape = Shape::new(name.clone(), offsets(r));
        if r.chance(2) { shape } else { shape.with_normals(offsets(r)) }
    });
    let shapes = shapes.collect();
    Mesh {
        positions: (0..vertices).map(|_| r.vec3()).collect(),
        uvs: (0..vertices).map(|_| Vec2::new(r.float(), r.float()) * 4.0).collect(),
        normals: (0..vertices).map(|_| r.unit()).collect(),
        triangles: (0..triangles).map(|_| [(); 3].map(|()| r.below(vertices) as u32)).collect(),
        skinning: joints.map(|joints| skinning(r, vertices, joints)),
        shapes,
        ..Mesh::default()
    }
}

/// Quarters, so that every sum is 1 exactly; joints are there once.
fn skinning(r: &mut Random, vertices: usize, joints: usize) -> Skinning {
    let mut skinning = Skinning::default();
    for _ in 0..vertices {
        let (mut bones, mut weights) = ([0; 4], [0.0; 4]);
        let count = 1 + r.below(joints.min(3));
        let first = r.below(joints);
        for slot in 0..count {
            bones[slot] = ((first + slot) % joints) as u16;
            weights[slot] = if slot + 1 == count { 1.0 - 0.25 * slot as f32 } else { 0.25 };
        }
        skinning.bones.push(bones);
        skinning.weights.push(weights);
    }
    // Some meshes have more than four bones a vertex; there a reader puts the largest first.
    if joints >= 8 && r.chance(2) {
        for vertex in 0..vertices {
            let first = r.below(joints);
            let eight: [u16; 8] = std::array::from_fn(|slot| ((first + slot) % joints) as u16);
            let is_one = vertex > 0 && r.chance(2);
            let (bones, further) =
                if is_one { ([eight[0], 0, 0, 0], [0; 4]) } else { (of(&eight[..4]), of(&eight[4..])) };
            (skinning.bones[vertex], skinning.weights[vertex]) =
                (bones, if is_one { [1.0, 0.0, 0.0, 0.0] } else { [0.25, 0.25, 0.125, 0.125] });
            skinning.more_bones.push(further);
            skinning.more_weights.push(if is_one { [0.0; 4] } else { [0.125, 0.0625, 0.03125, 0.03125] });
        }
    }
    skinning
}

fn of(four: &[u16]) -> [u16; 4] {
    std::array::from_fn(|slot| four[slot])
}

fn material(r: &mut Random, images: usize) -> Material {
    let texture = |r: &mut Random| {
        let uvs = if r.chance(3) { UvSet::Second } else { UvSet::First };
        let wrap = [(); 2].map(|()| [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror][r.below(3)]);
        r.some(images).map(|image| TextureRef { image, uvs, wrap })
    };
    let (normal_texture, occlusion_texture) = (texture(r), texture(r));
    Material {
        name: r.text(),
        base_color: [(); 4].map(|()| r.share()),
        base_color_texture: texture(r),
        metallic: r.share(),
        roughness: r.share(),
        metallic_roughness_texture: texture(r),
        normal_texture,
        // Both belong to their textures.
        normal_scale: if normal_texture.is_some() { r.float() } else { 1.0 },
        occlusion_texture,
        occlusion_strength: if occlusion_texture.is_some() { r.share() } else { 1.0 },
        emissive: [(); 3].map(|()| r.share()),
        emissive_texture: texture(r),
        alpha_mode: [AlphaMode::Opaque, AlphaMode::Mask, AlphaMode::Blend][r.below(3)],
        alpha_cutoff: if r.chance(2) { 0.5 } else { r.share() },
        double_sided: r.chance(2),
        is_unlit: r.chance(4),
        ..Material::default()
    }
}

fn clip(r: &mut Random, nodes: &[Node]) -> Clip {
    let mut channels = Vec::new();
    for (node, of_node) in nodes.iter().enumerate() {
        let mut targets = Vec::new();
        if matches!(of_node.local, Transform::Trs(_)) {
            targets = vec![ChannelTarget::Translation, ChannelTarget::Rotation, ChannelTarget::Scale];
        }
        if !of_node.weights.is_empty() {
            targets.push(ChannelTarget::Weights);
        }
        for target in targets {
            if r.chance(2) {
                channels.push(channel(r, node, target, of_node.weights.len()));
            }
        }
    }
    Clip { name: r.text(), channels }
}

fn channel(r: &mut Random, node: usize, target: ChannelTarget, weights: usize) -> Channel {
    let interpolation = [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline][r.below(3)];
    let keys = 2 + r.below(4);
    let mut time = 0.0;
    let times = (0..keys).map(|_| {
        time += 0.01 + r.share();
        f64::from(time)
    });
    let times = times.collect();
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let width = target.width(weights);
    let values = (0..keys * per_key).flat_map(|_| match target {
        ChannelTarget::Rotation => r.quat().to_array().to_vec(),
        _ => (0..width).map(|_| r.float()).collect(),
    });
    let values = values.collect();
    Channel { node, target, interpolation, times, values }
}

/// A valid scene with what glTF has no word for, or forbids. The first texture coordinate of a part tells
/// which one it is: parts that get nodes of their own come last.
pub fn awkward(seed: u64) -> RawScene {
    let mut r = Random(seed ^ 0x5eed);
    let mut scene = scene(seed);
    for node in &mut scene.nodes {
        if r.chance(4) {
            node.parent = None;
        }
        if let Transform::Trs(trs) = &mut node.local {
            trs.rotation *= 0.5 + r.share();
        }
    }
    for skin in &mut scene.skins {
        let twice = skin.joints[r.below(skin.joints.len())];
        skin.joints.push(twice);
        skin.inverse_binds.push(affine(&mut r));
    }
    for (number, part) in scene.parts.iter_mut().enumerate() {
        part.mesh.uvs[0].x = number as f32;
        part.mesh.normals.iter_mut().for_each(|normal| *normal *= 2.0 * r.share());
        part.mesh.tangents.iter_mut().for_each(|tangent| *tangent *= 2.0 * r.share());
        if r.chance(4) {
            part.mesh.triangles.clear();
        }
        if r.chance(3) {
            (part.skin, part.mesh.skinning) = (None, None);
        }
        for (bones, weights) in
            part.mesh.skinning.iter_mut().flat_map(|s| s.bones.iter_mut().zip(&mut s.weights))
        {
            if r.chance(2) {
                bones[3] = bones[0];
                (weights[0], weights[3]) = (weights[0] / 2.0, weights[3] + weights[0] / 2.0 + 4e-7);
            }
        }
        if r.chance(4) && !part.mesh.shapes.is_empty() {
            part.mesh.shapes[0].name = "another".to_owned();
        }
    }
    for channel in scene.clips.iter_mut().flat_map(|clip| &mut clip.channels) {
        // Later in the channel, the least step of time would be felt where keys are close.
        channel.times[1] = channel.times[0];
    }
    if let Some(channel) = scene.clips.first().and_then(|clip| clip.channels.first()).cloned() {
        scene.clips[0].channels.push(channel);
    }
    for material in &mut scene.materials {
        material.metallic = 3.0 * r.float();
        material.emissive[0] = -1.0;
        material.emissive[1] = 4.0;
    }
    scene.images.iter_mut().filter(|_| r.chance(3)).for_each(|image| image.bytes.clear());
    scene
}
