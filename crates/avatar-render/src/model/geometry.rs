//! The geometry of one part on the GPU, shared by all avatars of a model.

use crate::gpu::bindings::{storage_entry, uniform_entry};
use crate::model::curvature::curvatures;
use crate::model::desc::{PartBones, PartDesc};
use crate::model::error::{PartProblem, fits};
use crate::model::extras::extras;
use crate::model::places::Places;
use crate::model::shape_blocks::{SHAPE_BLOCK, ShapeBlocks};
use crate::model::weights;
use avatar_look::Wrinkle;
use avatar_mesh::{Bounds, DeformBounds, Mesh, Offsets, Skinning, Winding};
use bytemuck::{Pod, Zeroable};
use glam::Vec3;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// WGSL `Part`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuPart {
    pub(crate) vertex_count: u32,
    pub(crate) first_word: u32,
    pub(crate) word_count: u32,
    pub(crate) rigid_bone: u32,
    pub(crate) has_vertex_bones: u32,
    pub(crate) pad: [u32; 3],
    /// Middle, and 1 / reach.
    pub(crate) wrinkles: [[f32; 4]; Wrinkle::MOST],
}

/// WGSL `Vertex`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuVertex {
    pub(crate) position: [f32; 3],
    pub(crate) u: f32,
    pub(crate) normal: [f32; 3],
    pub(crate) v: f32,
}

/// WGSL `VertexBones`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub(crate) struct GpuVertexBones {
    pub(crate) indices: [u32; 4],
    pub(crate) weights: [f32; 4],
}

/// What drawing and deforming a part need.
#[derive(Debug)]
pub(crate) struct Geometry {
    /// Vertices on the GPU: those of the mesh that are alike are one.
    pub(crate) vertex_count: u32,
    /// Which of them each vertex of the mesh is.
    pub(crate) places: Places,
    pub(crate) index_count: u32,
    pub(crate) indices: wgpu::Buffer,
    /// [`GpuVertex`] per vertex: vertices of the deform pass, and texture coordinates of the passes that
    /// draw.
    pub(crate) vertices: wgpu::Buffer,
    /// 1 / radius of the surface, one f32 per vertex.
    pub(crate) curvatures: wgpu::Buffer,
    /// [`GpuExtra`](crate::model::extras::GpuExtra) per vertex, where the mesh has second texture coordinates
    /// or colours.
    pub(crate) extras: Option<wgpu::Buffer>,
    /// For the deform pass.
    pub(crate) bind_group: wgpu::BindGroup,
    /// The bone that a rigid part follows; 0 for others.
    pub(crate) rigid_bone: u32,
    /// All bones that move anything of it.
    pub(crate) used_bones: Arc<[u32]>,
    /// Whether vertices have eight bones instead of four.
    pub(crate) has_further_bones: bool,
    /// Largest z at bind pose, and 1 / (largest - smallest).
    pub(crate) front_z: f32,
    pub(crate) per_depth: f32,
    /// Length at bind pose that the texture's width covers, on average over the part; 0 without texture
    /// coordinates.
    pub(crate) length_per_uv: f32,
    /// Boxes around all that bones move, with any shapes.
    pub(crate) bounds: DeformBounds,
    /// The weight that the first shape follows.
    pub(crate) first_weight: usize,
    /// Middle of the part at bind pose, and a bone that moves it: enough to sort transparent parts by
    /// distance.
    pub(crate) center: Vec3,
    pub(crate) center_bone: usize,
}

impl Geometry {
    pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let compute = wgpu::ShaderStages::COMPUTE;
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("part geometry"),
            entries: &[
                uniform_entry(0, compute),
                storage_entry(1, compute, true),
                storage_entry(2, compute, true),
                storage_entry(3, compute, true),
                storage_entry(4, compute, true),
            ],
        })
    }

    pub(crate) fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        desc: &PartDesc<'_>,
        palette_len: usize,
    ) -> Result<Self, PartProblem> {
        let PartDesc { label, mesh, bones, first_weight, .. } = *desc;
        let limits = device.limits();
        check(mesh, bones, palette_len, &limits)?;
        let (welded, places) = Places::weld(mesh);
        let mesh = welded.as_ref().unwrap_or(mesh);
        if !mesh.shapes.is_empty() {
            let weights = first_weight.saturating_add(mesh.shapes.len());
            fits(
                "weights (with a bit for each)",
                weights::room(weights),
                size_of::<u32>(),
                binding(&limits),
            )?;
        }
        let wrinkles = desc.textures.wrinkles.map_or(&[][..], |wrinkles| wrinkles.places);
        let shapes = ShapeBlocks::new(mesh, first_weight, wrinkles, binding(&limits))?;
        let skinning = mesh.skinning.as_ref().filter(|_| bones == PartBones::PerVertex);
        let rigid_bone = match bones {
            PartBones::Rigid(bone) => bone,
            PartBones::PerVertex => 0,
        };
        let bounds = mesh.bounds();
        let depth = bounds.map_or(0.0, |bounds| bounds.size().z);
        let head = GpuPart {
            vertex_count: mesh.positions.len() as u32,
            first_word: shapes.first_word,
            word_count: shapes.word_count,
            rigid_bone: rigid_bone as u32,
            has_vertex_bones: skinning.is_some().into(),
            pad: [0; 3],
            wrinkles: places_of(wrinkles),
        };
        let part = buffer(device, &[head], label, "part", wgpu::BufferUsages::UNIFORM);
        let vertices = storage_and_vertices(device, &vertices(mesh), label, "vertices");
        let curvatures = storage_and_vertices(device, &curvatures(mesh), label, "curvatures");
        let has_further_bones = skinning.is_some_and(|skinning| !skinning.more_bones.is_empty());
        let vertex_bones = skinning.map_or_else(Vec::new, vertex_bones);
        let vertex_bones = storage(device, &vertex_bones, label, "vertex bones");
        let block_shapes = storage(device, &shapes.table, label, "shapes of blocks");
        let shape_offsets = storage(device, &shapes.offsets, label, "shape offsets");
        let center_bone = match skinning.and_then(|skinning| skinning.bones.first()) {
            Some(bones) => bones[0].into(),
            None => rigid_bone,
        };
        Ok(Self {
            vertex_count: head.vertex_count,
            places,
            index_count: (mesh.triangles.len() * 3) as u32,
            indices: buffer(
                device,
                &triangles(mesh),
                label,
                "indices",
                // Storage for the pass that reverses what bones mirror.
                wgpu::BufferUsages::INDEX | wgpu::BufferUsages::STORAGE,
            ),
            bind_group: device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some(&format!("{label}: geometry")),
                layout,
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: part.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: vertices.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 2, resource: vertex_bones.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 3, resource: block_shapes.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 4, resource: shape_offsets.as_entire_binding() },
                ],
            }),
            vertices,
            curvatures,
            extras: extras(mesh).map(|all| buffer(device, &all, label, "extras", wgpu::BufferUsages::VERTEX)),
            rigid_bone: head.rigid_bone,
            used_bones: match skinning {
                Some(skinning) => skinning.used_bones().into_iter().map(u32::from).collect(),
                None => Arc::new([head.rigid_bone]),
            },
            has_further_bones,
            front_z: bounds.map_or(0.0, |bounds| bounds.max.z),
            per_depth: if depth > 0.0 { depth.recip() } else { 0.0 },
            length_per_uv: length_per_uv(mesh),
            bounds: match bones {
                PartBones::PerVertex => DeformBounds::new(mesh),
                PartBones::Rigid(bone) => DeformBounds::rigid(mesh, bone),
            },
            first_weight,
            center: middle(mesh),
            center_bone,
        })
    }
}

/// A place of wrinkles that no vertex is near.
const NOWHERE: [f32; 4] = [1e18, 0.0, 0.0, 1.0];

/// Places of wrinkles as the shader reads them.
fn places_of(wrinkles: &[Wrinkle]) -> [[f32; 4]; Wrinkle::MOST] {
    let mut places = [NOWHERE; Wrinkle::MOST];
    for (place, wrinkle) in places.iter_mut().zip(wrinkles) {
        *place = wrinkle.center.extend(wrinkle.radius.max(f32::MIN_POSITIVE).recip()).to_array();
    }
    places
}

fn vertices(mesh: &Mesh) -> Vec<GpuVertex> {
    let all = mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs);
    all.map(|((position, normal), uv)| GpuVertex {
        position: position.to_array(),
        u: uv.x,
        normal: normal.to_array(),
        v: uv.y,
    })
    .collect()
}

/// For each vertex one set of four bones, or two.
fn vertex_bones(skinning: &Skinning) -> Vec<GpuVertexBones> {
    let set = |(bones, weights): (&[u16; 4], &[f32; 4])| GpuVertexBones {
        indices: bones.map(u32::from),
        weights: *weights,
    };
    let first = skinning.bones.iter().zip(&skinning.weights).map(set);
    if skinning.more_bones.is_empty() {
        return first.collect();
    }
    let further = skinning.more_bones.iter().zip(&skinning.more_weights).map(set);
    first.zip(further).flat_map(<[GpuVertexBones; 2]>::from).collect()
}

/// The middle of what is seen: parts of one node may share vertices that only some of them use.
fn middle(mesh: &Mesh) -> Vec3 {
    let corners = mesh.triangles.iter().flatten().filter_map(|corner| mesh.positions.get(*corner as usize));
    let boxes = corners.map(|at| Bounds { min: *at, max: *at });
    boxes.reduce(Bounds::union).map_or(Vec3::ZERO, |bounds| bounds.center())
}

/// The square root of the part's area divided by the area of its texture coordinates.
fn length_per_uv(mesh: &Mesh) -> f32 {
    let (mut area, mut painted) = (0.0f64, 0.0f64);
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|i| (mesh.positions[i as usize], mesh.uvs[i as usize]));
        area += f64::from((b.0 - a.0).cross(c.0 - a.0).length());
        painted += f64::from((b.1 - a.1).perp_dot(c.1 - a.1).abs());
    }
    if painted > 0.0 { (area / painted).sqrt() as f32 } else { 0.0 }
}

/// The triangles, with their winding reversed if most contradict their normals, as in mirrored parts that
/// kept the indices of the original.
fn triangles(mesh: &Mesh) -> Vec<[u32; 3]> {
    match Winding::of(mesh).is_inside_out() {
        true => mesh.triangles.iter().map(|[a, b, c]| [*a, *c, *b]).collect(),
        false => mesh.triangles.clone(),
    }
}

/// A storage buffer. WebGPU cannot bind empty buffers: without values it gets one zero element that no shader
/// reads.
fn storage<T: Pod>(device: &wgpu::Device, values: &[T], label: &str, what: &str) -> wgpu::Buffer {
    filled(device, values, label, what, wgpu::BufferUsages::STORAGE)
}

/// The same, usable as a vertex buffer as well.
fn storage_and_vertices<T: Pod>(
    device: &wgpu::Device,
    values: &[T],
    label: &str,
    what: &str,
) -> wgpu::Buffer {
    filled(device, values, label, what, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX)
}

fn filled<T: Pod>(
    device: &wgpu::Device,
    values: &[T],
    label: &str,
    what: &str,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    match values {
        [] => buffer(device, &[T::zeroed()], label, what, usage),
        values => buffer(device, values, label, what, usage),
    }
}

fn buffer<T: Pod>(
    device: &wgpu::Device,
    values: &[T],
    label: &str,
    what: &str,
    usage: wgpu::BufferUsages,
) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(&format!("{label}: {what}")),
        contents: bytemuck::cast_slice(values),
        usage,
    })
}

fn check(
    mesh: &Mesh,
    bones: PartBones,
    palette_len: usize,
    limits: &wgpu::Limits,
) -> Result<(), PartProblem> {
    let expected = mesh.positions.len();
    let count = |what, found| match found == expected {
        true => Ok(()),
        false => Err(PartProblem::Count { what, expected, found }),
    };
    count("normals", mesh.normals.len())?;
    count("uvs", mesh.uvs.len())?;
    for (what, found) in [("second uvs", mesh.uvs_1.len()), ("colours", mesh.colors.len())] {
        if found > 0 {
            count(what, found)?;
        }
    }
    for shape in &mesh.shapes {
        count("position offsets of a shape", shape.positions.len())?;
        let normals = shape.normals.as_ref().map_or(expected, Offsets::len);
        count("normal offsets of a shape", normals)?;
    }
    match (bones, &mesh.skinning) {
        (PartBones::Rigid(found), _) if found >= palette_len => {
            return Err(PartProblem::RigidBone { found, palette_len });
        }
        (PartBones::Rigid(_), _) => {}
        (PartBones::PerVertex, None) => return Err(PartProblem::NoVertexBones),
        (PartBones::PerVertex, Some(skinning)) => {
            count("bone indices", skinning.bones.len())?;
            count("bone weights", skinning.weights.len())?;
            let mut sets = 1;
            if !(skinning.more_bones.is_empty() && skinning.more_weights.is_empty()) {
                count("further bone indices", skinning.more_bones.len())?;
                count("further bone weights", skinning.more_weights.len())?;
                sets = 2;
            }
            fits("bones of vertices", expected, sets * size_of::<GpuVertexBones>(), binding(limits))?;
            let beyond = |bones: &[u16; 4]| bones.iter().copied().find(|b| usize::from(*b) >= palette_len);
            let both = [&skinning.bones, &skinning.more_bones].map(|bones| bones.iter().enumerate());
            let mut vertices = both.into_iter().flatten();
            if let Some((vertex, found)) = vertices.find_map(|(vertex, bones)| Some((vertex, beyond(bones)?)))
            {
                return Err(PartProblem::VertexBone { vertex, found: found.into(), palette_len });
            }
        }
    }
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&found) = corners.iter().find(|corner| **corner as usize >= expected) {
            return Err(PartProblem::Index { triangle, found, vertices: expected });
        }
    }
    // One workgroup deforms one block of vertices, and all workgroups of a dispatch stand in one row.
    let dispatched = u64::from(limits.max_compute_workgroups_per_dimension) * u64::from(SHAPE_BLOCK);
    let deformed = dispatched.saturating_mul(size_of::<GpuVertex>() as u64);
    fits("vertices", expected, size_of::<GpuVertex>(), binding(limits).min(deformed))?;
    fits("triangles", mesh.triangles.len(), size_of::<[u32; 3]>(), binding(limits))
}

/// Bytes that a shader can read from one buffer.
fn binding(limits: &wgpu::Limits) -> u64 {
    limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
}
