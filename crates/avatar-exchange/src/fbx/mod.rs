//! FBX, binary and text, from version 3.0 on.
//!
//! ```text
//!  bytes ──ufbx──▶ its scene, in metres and +Y up ──▶ nodes, parts, skins, shapes, clips, materials
//! ```
//!
//! The crate `ufbx` binds a C library that is compiled along, so this feature does not build for
//! `wasm32-unknown-unknown`; leave it out there and convert files beforehand.
//!
//! What the library evaluates and this module takes from it: pre- and post-rotations, pivots, orders of Euler
//! angles, ways of inheriting scale, geometric transforms, layers of animation, curves. Motion is sampled at
//! the file's own frames where straight lines between keys do not do, and each take begins at 0.

mod clips;
mod coordinates;
mod curves;
mod material;
mod mesh;
mod shapes;
mod skin;

use self::coordinates::Coordinates;
use crate::build::budget::Budget;
use crate::memory;
use crate::scene::{Finding, ImportError, Node, Note, RawScene, Resolve, Scene, Transform, Trs};
use glam::{Quat, Vec3};

/// Nesting of nodes that the library accepts.
const MAX_DEPTH: u32 = 1024;
/// The library never takes more memory than this, whatever the file's size.
const MAX_MEMORY_BYTES: usize = 2 << 30;
/// How often the library tells where it is: what errors name as their place.
const PROGRESS_BYTES: u64 = 1024;

/// Reads an FBX file. `file` is its name for messages; `resolve` brings textures that are not embedded. One
/// that it does not bring is an image without bytes, with a note.
///
/// The first node is the root that every FBX file has without saying so. Of a shape's in-betweens, each is a
/// shape of its own: that of full weight has the name of its channel, one at half "name@50"; see
/// [`RawScene::drivers`].
///
/// ```
/// let error = avatar_exchange::fbx::read("face.fbx", b"v 0 0 0", &mut |_| Err("no files".to_owned()));
/// assert_eq!(error.map_err(|error| error.file), Err("face.fbx".to_owned()));
/// ```
///
/// # Errors
/// Data that is not FBX, contents that a scene cannot hold, or a need of memory far beyond the file's size.
pub fn read(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<Scene, ImportError> {
    let raw = read_raw(file, bytes, resolve)?;
    Scene::from_raw(raw).map_err(|error| error.in_file(file))
}

/// As [`read()`], before the scene is checked as a whole.
///
/// # Errors
/// As [`read()`].
pub fn read_raw(file: &str, bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    read_all(bytes, resolve).map_err(|error| error.in_file(file))
}

fn read_all(bytes: &[u8], resolve: &mut Resolve<'_>) -> Result<RawScene, ImportError> {
    let fbx = load(bytes)?;
    let mut scene = RawScene::default();
    note_conversion(&fbx, &mut scene.notes);
    read_nodes(&fbx, &mut scene)?;
    let coordinates = Coordinates::of(&fbx);
    material::read(&fbx, &coordinates, resolve, &mut scene);
    let mut budget = Budget::of_vertices(bytes.len());
    let blends = mesh::read(&fbx, &coordinates, &mut scene, &mut budget)?;
    clips::read(&fbx, &blends, &mut scene, &mut budget)?;
    note_the_rest(&fbx, &mut scene.notes);
    Ok(scene)
}

/// What the library may take for what it has read of a file of so many bytes, and as much while it reads.
/// Arrays in files are compressed, by a factor of up to a thousand if they are hostile.
fn library_memory(bytes: usize) -> usize {
    let share = memory::share(memory::FBX_LIBRARY, bytes as u64);
    usize::try_from(share).unwrap_or(usize::MAX).min(MAX_MEMORY_BYTES)
}

fn allocator(memory_limit: usize) -> ufbx::AllocatorOpts {
    ufbx::AllocatorOpts { memory_limit, ..ufbx::AllocatorOpts::default() }
}

fn load(bytes: &[u8]) -> Result<ufbx::SceneRoot, ImportError> {
    if bytes.is_empty() {
        return Err(ImportError::new("byte 0", "an FBX file", "no bytes"));
    }
    let mut reached = 0;
    let mut progress = |progress: &ufbx::Progress| {
        reached = progress.bytes_read;
        ufbx::ProgressResult::Continue
    };
    let axes = ufbx::CoordinateAxes::right_handed_y_up();
    let limit = library_memory(bytes.len());
    let options = ufbx::LoadOpts {
        temp_allocator: allocator(limit),
        result_allocator: allocator(limit),
        file_format: ufbx::FileFormat::Fbx,
        node_depth_limit: MAX_DEPTH,
        progress_cb: ufbx::ProgressCb::Mut(&mut progress),
        progress_interval_hint: PROGRESS_BYTES,
        // Metres everywhere, rather than a scale on the root that every chain of joints would drag along.
        space_conversion: ufbx::SpaceConversion::ModifyGeometry,
        target_unit_meters: 1.0,
        target_axes: axes,
        target_camera_axes: axes,
        target_light_axes: axes,
        handedness_conversion_axis: ufbx::MirrorAxis::X,
        // Nodes here pass all of their transform on; where those of the file do not, nodes are added.
        geometry_transform_handling: ufbx::GeometryTransformHandling::ModifyGeometry,
        inherit_mode_handling: ufbx::InheritModeHandling::Compensate,
        geometry_transform_helper_name: ufbx::StringOpt::Ref("geometry transform"),
        scale_helper_name: ufbx::StringOpt::Ref("scale"),
        generate_missing_normals: true,
        normalize_normals: true,
        normalize_tangents: true,
        clean_skin_weights: true,
        ..ufbx::LoadOpts::default()
    };
    ufbx::load_memory(bytes, options).map_err(|error| {
        // Not `error.info()`: it panics where a name in it was cut within a character.
        let found = format!("{} ({:?})", &*error.description, error.type_);
        ImportError::new(format!("near byte {}", reached.min(bytes.len() as u64)), "an FBX file", found)
    })
}

fn note(notes: &mut Vec<Note>, place: impl Into<String>, finding: Finding) {
    notes.push(Note::new(place, finding));
}

fn note_conversion(fbx: &ufbx::Scene, notes: &mut Vec<Note>) {
    let settings = &fbx.settings;
    let unit = settings.original_unit_meters;
    if (unit - 1.0).abs() > 1e-9 && unit > 0.0 {
        let text = format!("units of {unit} m were converted to metres");
        note(notes, "settings", Finding::Converted(text));
    }
    if settings.original_axis_up != ufbx::CoordinateAxis::PositiveY
        && settings.original_axis_up != ufbx::CoordinateAxis::Unknown
    {
        let text = format!("the up axis {:?} was turned to +Y", settings.original_axis_up);
        note(notes, "settings", Finding::Converted(text));
    }
    for warning in &fbx.metadata.warnings {
        let text = format!("{} ({} times)", &*warning.description, warning.count);
        note(notes, "the file", Finding::Mended(text));
    }
}

/// In the library's order, so that its numbers of nodes are ours.
fn read_nodes(fbx: &ufbx::Scene, scene: &mut RawScene) -> Result<(), ImportError> {
    for (number, node) in fbx.nodes.iter().enumerate() {
        let parent = node.parent.as_ref().map(|parent| parent.element.typed_id as usize);
        if node.element.typed_id as usize != number {
            return Err(ImportError::new(place_of(node), "nodes in order", "others"));
        }
        let local = Transform::Trs(Trs {
            translation: vec3(node.local_transform.translation),
            rotation: quat(node.local_transform.rotation),
            scale: vec3(node.local_transform.scale),
        });
        scene.nodes.push(Node { name: node.element.name.to_string(), parent, local, weights: Vec::new() });
    }
    Ok(())
}

fn place_of(node: &ufbx::Node) -> String {
    format!("node {} '{}'", node.element.typed_id, &*node.element.name)
}

fn vec3(v: ufbx::Vec3) -> Vec3 {
    Vec3::new(v.x as f32, v.y as f32, v.z as f32)
}

fn quat(q: ufbx::Quat) -> Quat {
    Quat::from_xyzw(q.x as f32, q.y as f32, q.z as f32, q.w as f32)
}

fn note_the_rest(fbx: &ufbx::Scene, notes: &mut Vec<Note>) {
    let left_out = [
        ("lights", fbx.lights.len()),
        ("cameras", fbx.cameras.len()),
        ("line curves", fbx.line_curves.len()),
        ("NURBS curves", fbx.nurbs_curves.len()),
        ("NURBS surfaces", fbx.nurbs_surfaces.len()),
        ("point caches", fbx.cache_deformers.len()),
        ("constraints", fbx.constraints.len()),
    ];
    for (what, count) in left_out.into_iter().filter(|(_, count)| *count > 0) {
        note(notes, "the file", Finding::LeftOut(format!("{count} {what} are left out")));
    }
}
