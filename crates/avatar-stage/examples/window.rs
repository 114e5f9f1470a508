//! A face in a window, drawn with the program's own device. Digit keys press the poses that have them:
//! `cargo run -p avatar-stage --example window --features default-face`
#![allow(clippy::disallowed_methods, reason = "an example is a program: it has a clock")]
#![allow(deprecated, reason = "winit prefers an ApplicationHandler to a closure, which is shorter")]

use avatar_stage::avatar_pack::{Pack, Textures};
use avatar_stage::avatar_render::{AvatarState, Quality, Renderer, RendererConfig, Style, Targets};
use avatar_stage::wgpu::{self, CurrentSurfaceTexture as Acquired};
use avatar_stage::{DefaultFace, Performer, SAMPLES, portrait, upload};
use std::{error::Error, sync::Arc, time::Instant};
use winit::event::{Event, WindowEvent};
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::{keyboard::Key, window::Window};

type Done = Result<(), Box<dyn Error>>;

fn main() -> Done {
    let events = EventLoop::new()?;
    let window = Arc::new(events.create_window(Window::default_attributes().with_title("A face"))?);
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let mut surface = instance.create_surface(Arc::clone(&window))?;
    let options = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
    let adapter = pollster::block_on(instance.request_adapter(&options))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let mut config = surface.get_default_config(&adapter, 1, 1).ok_or("expected a surface to draw on")?;
    let shading = Quality::of_adapter(&adapter.get_info()).shading(Style::Natural);
    let drawn = RendererConfig { color_format: config.format, samples: SAMPLES, shading };
    let renderer = Renderer::new(&device, &queue, drawn)?;
    let mut targets: Option<Targets> = None; // until the surface is configured for the window's size
    let mut face = Performer::new(Pack::load(&DefaultFace)?);
    let model = upload(&device, &queue, face.pack(), &Textures::load(&DefaultFace))?;
    let mut avatar = AvatarState::new(&device, &model);
    let mut last = Instant::now();

    let mut handle = |event: WindowEvent, event_loop: &ActiveEventLoop| -> Done {
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(_) => targets = None,
            WindowEvent::KeyboardInput { event, .. } if event.state.is_pressed() && !event.repeat => {
                let pack = Arc::clone(face.pack());
                if let Key::Character(key) = &event.logical_key
                    && let Some(pose) = pack.poses().by_key(key)
                {
                    face.press_pose(pose);
                }
            }
            WindowEvent::RedrawRequested => {
                face.advance(last.elapsed().as_secs_f64().min(0.1))?;
                last = Instant::now();
                if targets.is_none() {
                    let (size, limit) = (window.inner_size(), device.limits().max_texture_dimension_2d);
                    (config.width, config.height) = (size.width.clamp(1, limit), size.height.clamp(1, limit));
                    surface.configure(&device, &config);
                    targets = Some(Targets::new(&device, &renderer, config.width, config.height)?);
                }
                let acquired = surface.get_current_texture();
                if matches!(acquired, Acquired::Lost) {
                    surface = instance.create_surface(Arc::clone(&window))?;
                }
                if matches!(acquired, Acquired::Lost | Acquired::Outdated) {
                    targets = None;
                }
                let (Acquired::Success(frame) | Acquired::Suboptimal(frame)) = acquired else {
                    return Ok(());
                };
                let Some(targets) = &targets else { return Ok(()) };
                avatar.set(&queue, face.bones(), face.weights())?;
                let scene = portrait(face.pack(), config.width as f32 / config.height as f32);
                let view = frame.texture.create_view(&Default::default());
                let mut encoder = device.create_command_encoder(&Default::default());
                renderer.draw(&mut encoder, &view, targets, &queue, &scene, &[(&model, &avatar)])?;
                queue.submit([encoder.finish()]);
                queue.present(frame);
            }
            _ => {}
        }
        Ok(())
    };

    let mut outcome = Ok(());
    events.run(|event, event_loop| {
        if let Event::WindowEvent { event, .. } = event
            && let Err(error) = handle(event, event_loop)
        {
            outcome = Err(error);
            event_loop.exit();
        }
        window.request_redraw();
    })?;
    outcome
}
