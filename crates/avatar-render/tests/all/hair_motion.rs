//! Hair lags behind a head that turns, settles, does so alike at every frame rate, and never enters the head.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use crate::common::gpu;
use crate::common::head::{Head, canvas, weights_of_skin};
use crate::common::nearest::Nearest;
use avatar_groom::{SEGMENTS, Strand, Style};
use avatar_mesh::deform;
use avatar_pack::FaceState;
use avatar_render::headless::{Canvas, Gpu};
use avatar_render::{
    AvatarModel, AvatarState, Camera, Deformer, Grower, Quality, Renderer, RendererConfig, Scene, Shading,
    Style as Manner, Targets,
};

const STRANDS: f32 = 4000.0;
/// The head turns by 30° in so many seconds, and stops.
const TURN_SECONDS: f64 = 0.5;

struct Stage<'a> {
    gpu: &'a Gpu,
    head: &'a Head,
    model: AvatarModel,
    state: AvatarState,
    deformer: Deformer,
    grower: Grower,
    face: FaceState,
}

impl<'a> Stage<'a> {
    fn new(gpu: &'a Gpu, head: &'a Head, style: Style) -> Self {
        let (model, state) = head.with_hair(gpu, style, STRANDS);
        Self {
            gpu,
            head,
            model,
            state,
            deformer: Deformer::new(&gpu.device),
            grower: Grower::new(&gpu.device),
            face: FaceState::new(&head.pack),
        }
    }

    fn turn(&mut self, degrees: f32) {
        let controls = self.head.pack.controls();
        let mut values = controls.defaults();
        values[controls.index("head.turn").expect("a head that turns")] = degrees;
        self.face.pose(&self.head.pack, &values).expect("a pose");
        let weights = weights_of_skin(&self.head.pack, &self.face);
        self.state.set(&self.gpu.queue, self.face.bones(), weights).expect("lengths fit");
    }

    fn strands(&mut self) -> Vec<Strand> {
        let Self { gpu, deformer, grower, model, state, .. } = self;
        grower.run(&gpu.device, &gpu.queue, deformer, model, state).expect("strands")
    }

    /// Strands at every sixth of a second, drawn `rate` times a second.
    fn play(&mut self, rate: u16, sixths: u16) -> Vec<Vec<Strand>> {
        let mut seen = Vec::new();
        for frame in 0..=sixths * rate / 6 {
            let seconds = f64::from(frame) / f64::from(rate);
            let share = (seconds / TURN_SECONDS).min(1.0);
            self.turn((30.0 * share * share * (3.0 - 2.0 * share)) as f32);
            self.state.advance_hair(&self.gpu.queue, 1.0 / f64::from(rate));
            let strands = self.strands();
            if frame % (rate / 6) == 0 {
                seen.push(strands);
            }
        }
        seen
    }
}

fn length(strand: &Strand) -> f32 {
    strand.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
}

/// Distances of tips, by the strands' lengths; those of the scalp that hang.
fn apart(a: &[Strand], b: &[Strand]) -> Vec<f32> {
    let long = a.iter().zip(b).filter(|(a, _)| length(a) > 2.0);
    long.map(|(a, b)| a[SEGMENTS].distance(b[SEGMENTS]) / length(a)).collect()
}

fn mean(values: &[f32]) -> f32 {
    values.iter().sum::<f32>() / values.len() as f32
}

fn most(values: &[f32]) -> f32 {
    values.iter().copied().fold(0.0, f32::max)
}

#[test]
fn tips_lag_settle_and_move_alike_at_every_frame_rate() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    for (name, style) in [("bob", Style::BOB), ("long", Style::LONG), ("curly", Style::CURLY)] {
        let mut stage = Stage::new(gpu, &head, style);
        let plays: Vec<_> = [30, 60, 144]
            .into_iter()
            .map(|rate| {
                stage.state.still_hair();
                stage.play(rate, 9)
            })
            .collect();
        stage.state.still_hair();
        let still = stage.strands();
        for seen in &plays {
            // The third sixth is where the head stops, the ninth a second later.
            let (stop, later) = (apart(&still, &seen[3]), apart(&still, &seen[9]));
            assert!(stop.len() > 500, "{name}: {}", stop.len());
            let (lag, left, farthest) = (mean(&stop), mean(&later), most(&later));
            println!("{name}: lag {lag:.4}, a second later {left:.4}, at most {farthest:.4}");
            assert!(lag > 0.03, "{name}: lag {lag}");
            assert!(left < 0.005 && farthest < 0.03, "{name}: {left} {farthest}");
        }
        for other in &plays[1..] {
            for (k, (a, b)) in plays[0].iter().zip(other).enumerate() {
                let off = apart(a, b);
                println!("{name}, {k}: mean {:.4}, most {:.4}", mean(&off), most(&off));
                assert!(most(&off) < 0.02, "{name}, sixth {k}: {}", most(&off));
            }
        }
    }
}

#[test]
fn hair_that_swings_stays_outside_of_the_head() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let skin = &head.pack.parts()[0].mesh;
    let height = head.head().size().y;
    let mut posed = skin.deformed();
    for style in [Style::BOB, Style::LONG, Style::CURLY] {
        let mut stage = Stage::new(gpu, &head, style);
        // To and fro, as fast as heads are shaken.
        for frame in 0u8..30 {
            let phase = f32::from(frame) / 30.0 * std::f32::consts::TAU * 2.0;
            stage.turn(35.0 * phase.sin());
            stage.state.advance_hair(&gpu.queue, 1.0 / 30.0);
            let strands = stage.strands();
            let weights = weights_of_skin(&stage.head.pack, &stage.face);
            deform(skin, stage.face.bones(), weights, &mut posed).expect("lengths fit");
            let nearest = Nearest::new(&posed.positions, &skin.triangles);
            for (i, points) in strands.iter().enumerate() {
                for (k, point) in points.iter().enumerate() {
                    let depth = nearest.depth(*point) / height;
                    assert!(depth <= 0.005, "frame {frame}, strand {i}, point {k}: {depth} at {point}");
                }
            }
        }
    }
}

#[test]
fn hair_is_still_until_time_passes_and_after_it_is_told() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let mut stage = Stage::new(gpu, &head, Style::LONG);
    stage.turn(0.0);
    let still = stage.strands();
    // A first call begins with hair that hangs still; a frame without time changes nothing, and neither does
    // a second view.
    stage.state.advance_hair(&gpu.queue, 0.1);
    assert!(most(&apart(&still, &stage.strands())) < 1e-4);
    assert!(most(&apart(&still, &stage.strands())) < 1e-4);
    stage.turn(30.0);
    stage.state.advance_hair(&gpu.queue, 1.0 / 30.0);
    let moving = stage.strands();
    assert_eq!(moving, stage.strands(), "the same frame, seen again");
    stage.state.still_hair();
    let turned = stage.strands();
    assert!(mean(&apart(&turned, &moving)) > 0.05);
    // Elsewhere at once, or after a pause: still.
    for seconds in [f64::NAN, -1.0, 7.0] {
        stage.state.advance_hair(&gpu.queue, 1.0 / 30.0);
        stage.strands();
        stage.turn(-20.0);
        stage.state.advance_hair(&gpu.queue, seconds);
        let there = stage.strands();
        stage.state.still_hair();
        assert!(most(&apart(&stage.strands(), &there)) < 1e-4);
        stage.turn(30.0);
    }
}

#[test]
fn tips_that_stand_out_of_the_skin_are_seen_where_the_skin_is_not() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    // Twice as long as it comes: beyond all room that a box around skin has.
    let mut style = Style::MOHAWK;
    style.scalp.length *= 2.0;
    let mut stage = Stage::new(gpu, &head, style);
    let points = stage.strands().into_iter().flatten();
    let tip = points.max_by(|a, b| a.y.total_cmp(&b.y)).expect("a strand");
    let skin = head.head();
    assert!(tip.y > skin.max.y + 0.2 * skin.size().y, "{tip} above {skin:?}");
    let camera = Camera::orbit(tip, skin.size().y, 0.0, 0.0, 0.03, 1.0);
    let scene = Scene { camera, ..head.scene(0.0, 0.8) };
    // Without shadows, for whose sake it would be drawn as well.
    let canvas = Canvas::new(gpu, 64, 64, 4, Shading::Plain).expect("a canvas");
    let picture = canvas.render(gpu, &scene, &[(&stage.model, &stage.state)]).expect("a picture");
    let drawn = picture.rgba.chunks_exact(4).filter(|pixel| pixel[3] > 0).count();
    assert!(drawn > 20, "{drawn} pixels of hair");
}

/// Frames that leave out what did not change show what a new avatar shows.
#[test]
fn frames_without_change_and_after_it_are_those_of_a_new_avatar() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let mut stage = Stage::new(gpu, &head, Style::BOB);
    let canvas = canvas(gpu, 96, 1);
    let scenes = [head.scene(0.3, 0.3), head.scene(0.3, 0.8)];
    let picture = |stage: &Stage<'_>, scene: &Scene| {
        canvas.render(gpu, scene, &[(&stage.model, &stage.state)]).expect("a picture").rgba
    };
    let mut seen = Vec::new();
    // Far and near, since a near head grows more strands; each pose twice.
    for (degrees, scene) in [(0.0, 0), (0.0, 1), (25.0, 0), (25.0, 1), (0.0, 1), (0.0, 0)] {
        stage.turn(degrees);
        let last = picture(&stage, &scenes[scene]);
        stage.turn(degrees);
        assert!(picture(&stage, &scenes[scene]) == last, "{degrees}, {scene}: set again");
        let mut new = Stage::new(gpu, &head, Style::BOB);
        new.turn(degrees);
        assert!(picture(&new, &scenes[scene]) == last, "{degrees}, {scene}: a new avatar");
        assert!(!seen.contains(&last) || degrees == 0.0, "{degrees}, {scene}: something moved");
        seen.push(last);
    }
    // Hair that swings is elsewhere in each frame, and where it hangs still when it is told to.
    stage.state.advance_hair(&gpu.queue, 0.0);
    picture(&stage, &scenes[1]);
    stage.turn(25.0);
    let swinging = [(); 3].map(|()| {
        stage.state.advance_hair(&gpu.queue, 0.05);
        let first = picture(&stage, &scenes[1]);
        assert!(picture(&stage, &scenes[1]) == first, "no time passed");
        first
    });
    assert!(swinging[0] != swinging[1] && swinging[1] != swinging[2]);
    stage.state.redo();
    assert!(picture(&stage, &scenes[1]) != swinging[2], "the time of the last frame is spent again");
    stage.state.still_hair();
    assert!(picture(&stage, &scenes[1]) == seen[3], "still");
}

/// A frame that is recorded and thrown away takes its work for done, until it is told otherwise.
#[test]
fn what_a_lost_frame_left_out_is_done_again() {
    let Some(gpu) = gpu() else { return };
    let head = Head::new();
    let mut stage = Stage::new(gpu, &head, Style::BOB);
    let (canvas, scene) = (canvas(gpu, 96, 1), head.scene(0.3, 0.8));
    let shading = Quality::Low.shading(Manner::Natural);
    let config = RendererConfig { color_format: wgpu::TextureFormat::Rgba8UnormSrgb, samples: 1, shading };
    let renderer = Renderer::new(&gpu.device, &gpu.queue, config).expect("a renderer");
    let targets = Targets::new(&gpu.device, &renderer, 96, 96).expect("targets");
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 96, height: 96, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: config.color_format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let lost = |stage: &Stage<'_>| {
        let view = texture.create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let avatars = [(&stage.model, &stage.state)];
        renderer.draw(&mut encoder, &view, &targets, &gpu.queue, &scene, &avatars).expect("recorded");
    };
    let picture = |stage: &Stage<'_>| {
        canvas.render(gpu, &scene, &[(&stage.model, &stage.state)]).expect("a picture").rgba
    };
    let before = picture(&stage);
    let mut new = Stage::new(gpu, &head, Style::BOB);
    new.turn(25.0);
    let turned = picture(&new);
    stage.turn(25.0);
    lost(&stage);
    assert!(picture(&stage) != turned, "it is taken for done");
    stage.state.redo();
    assert!(picture(&stage) == turned && turned != before);
    // The first frame of hair that begins to swing: it would come from nowhere.
    for stage in [&mut stage, &mut new] {
        stage.state.advance_hair(&gpu.queue, 0.1);
    }
    lost(&stage);
    stage.state.redo();
    assert!(picture(&stage) == picture(&new), "it hangs still first");
    for stage in [&mut stage, &mut new] {
        stage.turn(0.0);
        stage.state.advance_hair(&gpu.queue, 0.1);
    }
    let swinging = picture(&stage);
    assert!(swinging == picture(&new) && swinging != before);
}
