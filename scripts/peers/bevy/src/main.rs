//! Milliseconds that Bevy takes for a frame of so many avatars of one GLB, without a window:
//!
//! `peer-bevy SCENE.glb COUNT lit|unlit FRAMES [ADAPTER]`
//!
//! `lit`: its physical material with one directional light and ambient light, no shadows; `unlit`: base
//! colours. The scene is that of avatar-render's bench `crowd`: 1280×720 at four samples; a grid of cells of
//! 28 × 32 units, as many columns as rows; a camera of 30° across the height of the picture, so far away that
//! the rows fill it. The GLB's first animation plays, 1/30 s a frame. A frame lasts from an update of the app
//! to the moment at which the device has nothing left to do; drawing does not overlap with the next update.
//!
//! Prints one line: the adapter, then the least and the median of all frames after as many to warm up as a
//! third of them.
use bevy::{
    app::PluginsState,
    camera::RenderTarget,
    core_pipeline::tonemapping::{DebandDither, Tonemapping},
    gltf::GltfAssetLabel,
    prelude::*,
    render::{
        RenderApp, RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        render_resource::{PipelineCache, PollType, TextureFormat},
        renderer::{RenderAdapterInfo, RenderDevice},
        settings::{RenderCreation, WgpuSettings},
        view::Msaa,
    },
    time::TimeUpdateStrategy,
    window::{ExitCondition, WindowPlugin},
};
use std::path::Path;
use std::time::{Duration, Instant};

const CELL: Vec2 = Vec2::new(28.0, 32.0);
/// The point of the model that stands in the middle of its cell.
const MIDDLE: Vec3 = Vec3::new(0.0, -2.0, -4.0);
const FOV: f32 = std::f32::consts::PI / 6.0;
const PATIENCE: Duration = Duration::from_secs(300);

#[derive(Resource)]
struct Motion {
    graph: Handle<AnimationGraph>,
    clip: AnimationNodeIndex,
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [scene, count, light, frames, rest @ ..] = args.as_slice() else {
        eprintln!("usage: peer-bevy SCENE.glb COUNT lit|unlit FRAMES [ADAPTER]");
        std::process::exit(2);
    };
    let count: usize = count.parse().expect("a number of avatars");
    let frames: usize = frames.parse().expect("a number of frames");
    let mut app = app(Path::new(scene), rest.first().cloned());
    fill(&mut app, scene, count);
    wait_until_ready(&mut app, count, light == "unlit");
    for _ in 0..frames.div_ceil(3) {
        frame(&mut app);
    }
    let mut times: Vec<f64> = (0..frames.max(1)).map(|_| frame(&mut app)).collect();
    times.sort_by(f64::total_cmp);
    let adapter = app.world().resource::<RenderAdapterInfo>();
    println!(
        "bevy 0.19.1 on {}: {count} {light}, ms a frame: least {:.2}, median {:.2}",
        adapter.name,
        times[0],
        times[times.len() / 2]
    );
}

/// Bevy without a window and without pipelined rendering, on the adapter of that name where one is given.
fn app(scene: &Path, adapter_name: Option<String>) -> App {
    let folder = std::path::absolute(scene).expect("a path");
    let folder = folder.parent().expect("a folder").to_string_lossy().into_owned();
    let settings = WgpuSettings { adapter_name, ..default() };
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .set(RenderPlugin {
                render_creation: RenderCreation::Automatic(Box::new(settings)),
                synchronous_pipeline_compilation: true,
                ..default()
            })
            .set(WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() })
            .set(AssetPlugin { file_path: folder, ..default() })
            .disable::<PipelinedRenderingPlugin>(),
    );
    app.insert_resource(ClearColor(Color::srgb(0.16, 0.17, 0.19)));
    app.insert_resource(GlobalAmbientLight { brightness: 500.0, ..default() });
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 30.0)));
    app.add_systems(Update, play);
    while app.plugins_state() == PluginsState::Adding {
        bevy::tasks::tick_global_task_pools_on_main_thread();
    }
    app.finish();
    app.cleanup();
    app
}

/// Avatars, light and camera.
fn fill(app: &mut App, scene: &str, count: usize) {
    let name = Path::new(scene).file_name().expect("a file").to_string_lossy().into_owned();
    let columns = (count as f32).sqrt().ceil() as usize;
    let rows = count.div_ceil(columns);
    let world = app.world_mut();
    let assets = world.resource::<AssetServer>().clone();
    let avatar = assets.load(GltfAssetLabel::Scene(0).from_asset(name.clone()));
    let (graph, clip) = AnimationGraph::from_clip(assets.load(GltfAssetLabel::Animation(0).from_asset(name)));
    let graph = world.resource_mut::<Assets<AnimationGraph>>().add(graph);
    world.insert_resource(Motion { graph, clip });
    for place in 0..count {
        let across = (place % columns) as f32 - (columns as f32 - 1.0) / 2.0;
        let up = (rows as f32 - 1.0) / 2.0 - (place / columns) as f32;
        let at = (CELL * Vec2::new(across, up)).extend(0.0) - MIDDLE;
        world.spawn((WorldAssetRoot(avatar.clone()), Transform::from_translation(at)));
    }
    world.spawn((
        DirectionalLight { illuminance: 6000.0, shadow_maps_enabled: false, ..default() },
        Transform::from_xyz(0.5, 0.7, 1.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let picture = Image::new_target_texture(1280, 720, TextureFormat::Rgba8UnormSrgb, None);
    let picture = world.resource_mut::<Assets<Image>>().add(picture);
    let distance = rows as f32 * CELL.y / 2.0 / (FOV / 2.0).tan();
    world.spawn((
        Camera3d::default(),
        RenderTarget::from(picture),
        Projection::Perspective(PerspectiveProjection { fov: FOV, near: 1.0, far: 4000.0, ..default() }),
        Transform::from_xyz(0.0, 0.0, distance),
        Msaa::Sample4,
        Tonemapping::AcesFitted,
        DebandDither::Disabled,
    ));
}

/// Starts the animation of every avatar that has appeared.
fn play(
    motion: Option<Res<Motion>>,
    mut appeared: Query<(Entity, &mut AnimationPlayer), Added<AnimationPlayer>>,
    mut commands: Commands,
) {
    let Some(motion) = motion else { return };
    for (avatar, mut player) in &mut appeared {
        player.play(motion.clip).repeat();
        commands.entity(avatar).insert(AnimationGraphHandle(motion.graph.clone()));
    }
}

/// Draws until all avatars move and no pipeline is waited for, in several frames running.
fn wait_until_ready(app: &mut App, count: usize, unlit: bool) {
    let start = Instant::now();
    let mut steady = 0;
    while steady < 5 {
        app.update();
        let world = app.world_mut();
        let moving = world.query::<&AnimationGraphHandle>().iter(world).count();
        if unlit && moving >= count && steady == 0 {
            let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
            let all: Vec<_> = materials.ids().collect();
            for id in all {
                if let Some(mut material) = materials.get_mut(id) {
                    material.unlit = true;
                }
            }
        }
        let pipelines = app.sub_app(RenderApp).world().resource::<PipelineCache>();
        let is_ready = moving >= count && pipelines.waiting_pipelines().next().is_none();
        steady = if is_ready { steady + 1 } else { 0 };
        assert!(start.elapsed() < PATIENCE, "{moving} of {count} avatars move after {PATIENCE:?}");
    }
}

/// Draws a frame and waits for it. Returns the milliseconds.
fn frame(app: &mut App) -> f64 {
    let start = Instant::now();
    app.update();
    let device = app.sub_app(RenderApp).world().resource::<RenderDevice>();
    device.poll(PollType::wait_indefinitely()).expect("a frame");
    start.elapsed().as_secs_f64() * 1e3
}
