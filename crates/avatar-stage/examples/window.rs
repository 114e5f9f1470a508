//! A face in a window, drawn with the program's own device. Digit keys press the poses that have them:
//! `cargo run -p avatar-stage --example window --features default-face`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it has a clock")]

use avatar_stage::avatar_pack::{Pack, Textures};
use avatar_stage::avatar_render::{AvatarModel, AvatarState, Renderer, Shading, Targets};
use avatar_stage::avatar_render::{Quality, RendererConfig, Style};
use avatar_stage::{DefaultFace, Performer, SAMPLES, portrait, upload, wgpu};
use std::{error::Error, sync::Arc, time::Instant};
use winit::application::ApplicationHandler;
use winit::event::{KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::keyboard::Key;
use winit::window::{Window, WindowId};

type Done<T = ()> = Result<T, Box<dyn Error>>;

/// What draws in the window.
struct Stage {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    device: wgpu::Device,
    queue: wgpu::Queue,
    renderer: Renderer,
    targets: Option<Targets>,
    model: AvatarModel,
    avatar: AvatarState,
}

impl Stage {
    fn open(window: Window, pack: &Pack) -> Done<Self> {
        let window = Arc::new(window);
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(Arc::clone(&window))?;
        let options =
            wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let config = surface.get_default_config(&adapter, 1, 1).ok_or("expected a surface to draw on")?;
        let shading: Shading = Quality::of_adapter(&adapter.get_info()).shading(Style::Natural);
        let drawn = RendererConfig { color_format: config.format, samples: SAMPLES, shading };
        let renderer = Renderer::new(&device, &queue, drawn)?;
        let model = upload(&device, &queue, pack, &Textures::load(&DefaultFace))?;
        let avatar = AvatarState::new(&device, &model);
        Ok(Self { window, surface, config, device, queue, renderer, targets: None, model, avatar })
    }

    fn resize(&mut self, width: u32, height: u32) -> Done {
        (self.config.width, self.config.height) = (width.max(1), height.max(1));
        self.surface.configure(&self.device, &self.config);
        self.targets = Some(Targets::new(&self.device, &self.renderer, width.max(1), height.max(1))?);
        Ok(())
    }

    fn draw(&mut self, face: &Performer) -> Done {
        use wgpu::CurrentSurfaceTexture::{Suboptimal, Success};
        let Some(targets) = &self.targets else { return Ok(()) };
        let (Success(frame) | Suboptimal(frame)) = self.surface.get_current_texture() else { return Ok(()) };
        self.avatar.set(&self.queue, face.bones(), face.weights())?;
        let scene = portrait(face.pack(), self.config.width as f32 / self.config.height as f32);
        let view = frame.texture.create_view(&Default::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let avatars = [(&self.model, &self.avatar)];
        self.renderer.draw(&mut encoder, &view, targets, &self.queue, &scene, &avatars)?;
        self.queue.submit([encoder.finish()]);
        self.queue.present(frame);
        Ok(())
    }
}

struct App {
    face: Performer,
    drawn: Instant,
    stage: Option<Stage>,
}

impl App {
    fn event(&mut self, event_loop: &ActiveEventLoop, event: WindowEvent) -> Done {
        let Some(stage) = &mut self.stage else { return Ok(()) };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => stage.resize(size.width, size.height)?,
            WindowEvent::KeyboardInput {
                event: KeyEvent { logical_key: Key::Character(key), .. }, ..
            } => {
                if let Some(pose) = Arc::clone(self.face.pack()).poses().by_key(&key) {
                    self.face.press_pose(pose);
                }
            }
            WindowEvent::RedrawRequested => {
                self.face.advance(self.drawn.elapsed().as_secs_f64().min(0.1))?;
                self.drawn = Instant::now();
                stage.draw(&self.face)?;
            }
            _ => return Ok(()),
        }
        stage.window.request_redraw();
        Ok(())
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        let window = event_loop.create_window(Window::default_attributes().with_title("A face"));
        let opened = window.map_err(Into::into).and_then(|window| Stage::open(window, self.face.pack()));
        self.stage = opened.inspect_err(|error| eprintln!("{error}")).ok();
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        if let Err(error) = self.event(event_loop, event) {
            eprintln!("{error}");
            event_loop.exit();
        }
    }
}

fn main() -> Done {
    let face = Performer::new(Pack::load(&DefaultFace)?);
    Ok(EventLoop::new()?.run_app(&mut App { face, drawn: Instant::now(), stage: None })?)
}
