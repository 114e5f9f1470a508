use avatar_panel::{Action, Model, Panel, PanelState};
use avatar_render::headless::Gpu;
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use egui_winit::EventResponse;
use std::time::Duration;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::keyboard::{Key, NamedKey};
use winit::window::Window;

/// The panel in the window: events in, actions and triangles out.
pub(super) struct Overlay {
    pub(super) panel: Panel,
    pub(super) ctx: egui::Context,
    input: egui_winit::State,
    /// `None` until there is a GPU, and after one was lost.
    renderer: Option<egui_wgpu::Renderer>,
    /// Pictures that the GPU has yet to be told of: frames may be lost.
    textures: egui::TexturesDelta,
    /// Marks over the picture, painted under the panel, in pixels of the window.
    pub(super) marks: Vec<[f32; 2]>,
}

/// A frame of the panel, ready to be drawn.
pub(super) struct Painted {
    triangles: Vec<egui::ClippedPrimitive>,
    pixels_per_point: f32,
    /// The part of the window that the panel leaves to the face: left, top, right and bottom in pixels.
    pub(super) free: [f32; 4],
    /// When the panel wants to be drawn again.
    pub(super) again: Duration,
}

impl Overlay {
    pub(super) fn new<T: From<accesskit_winit::Event> + Send>(
        event_loop: &ActiveEventLoop,
        window: &Window,
        proxy: EventLoopProxy<T>,
        state: PanelState,
    ) -> Self {
        let ctx = egui::Context::default();
        // The keys of the camera are + and - without Ctrl; those with Ctrl scale the text, as in browsers.
        let scale = Some(window.scale_factor() as f32);
        let mut input =
            egui_winit::State::new(ctx.clone(), egui::ViewportId::ROOT, window, scale, window.theme(), None);
        input.init_accesskit(event_loop, window, proxy);
        Self {
            panel: Panel::new(state),
            ctx,
            input,
            renderer: None,
            textures: egui::TexturesDelta::default(),
            marks: Vec::new(),
        }
    }

    /// Forgets the device that it was drawn with: the next frame goes to another one, with the letters that
    /// egui believes to be there.
    pub(super) fn forget_device(&mut self) {
        self.renderer = None;
        self.textures.clear();
        let letters = self.ctx.fonts(|fonts| fonts.image());
        let letters = egui::epaint::ImageDelta::full(letters, egui::TextureOptions::LINEAR);
        self.textures.push(egui::TextureId::default(), letters);
    }

    pub(super) fn event(&mut self, window: &Window, event: &WindowEvent) -> EventResponse {
        self.input.on_window_event(window, event)
    }

    pub(super) fn accesskit(&mut self, event: accesskit_winit::WindowEvent) {
        if let accesskit_winit::WindowEvent::ActionRequested(request) = event {
            self.input.on_accesskit_action_request(request);
        }
    }

    /// Whether a key that is pressed now is the panel's.
    pub(super) fn takes(&self, key: &Key) -> bool {
        self.panel.takes_key(&self.ctx, egui_key(key))
    }

    /// Whether the pointer is over the panel, or holds something of it.
    pub(super) fn takes_pointer(&self) -> bool {
        self.ctx.egui_wants_pointer_input() || self.ctx.is_pointer_over_egui()
    }

    /// Lays the panel out.
    pub(super) fn run(&mut self, window: &Window, model: &Model<'_>, actions: &mut Vec<Action>) -> Painted {
        let input = self.input.take_egui_input(window);
        let panel = &mut self.panel;
        let mut free = egui::Rect::ZERO;
        let output = self.ctx.run_ui(input, |ui| {
            free = panel.show(ui, model, actions);
        });
        self.input.handle_platform_output(window, output.platform_output);
        let pixels_per_point = output.pixels_per_point;
        let again = output.viewport_output.get(&egui::ViewportId::ROOT);
        let again = again.map_or(Duration::MAX, |viewport| viewport.repaint_delay);
        let scaled = |rect: egui::Rect| {
            [rect.left(), rect.top(), rect.right(), rect.bottom()].map(|x| x * pixels_per_point)
        };
        self.textures.append(output.textures_delta);
        Painted {
            triangles: self.ctx.tessellate(output.shapes, pixels_per_point),
            pixels_per_point,
            free: scaled(free),
            again,
        }
    }

    /// Puts the marks under the panel.
    pub(super) fn mark(&self, painted: &mut Painted) {
        let shapes = mark_shapes(&self.ctx, &self.marks);
        let marks = self.ctx.tessellate(shapes, painted.pixels_per_point);
        painted.triangles.splice(0..0, marks);
    }

    /// Draws the panel over the picture, through a view of this format.
    pub(super) fn draw(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        format: wgpu::TextureFormat,
        painted: &Painted,
    ) {
        let renderer = self
            .renderer
            .get_or_insert_with(|| egui_wgpu::Renderer::new(&gpu.device, format, RendererOptions::default()));
        for (id, deltas) in self.textures.set.drain() {
            for delta in deltas {
                renderer.update_texture(&gpu.device, &gpu.queue, id, &delta);
            }
        }
        let screen = ScreenDescriptor {
            size_in_pixels: [texture.width(), texture.height()],
            pixels_per_point: painted.pixels_per_point,
        };
        // Only callbacks record commands of their own, and there are none.
        let _ = renderer.update_buffers(&gpu.device, &gpu.queue, encoder, &painted.triangles, &screen);
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            label: Some("panel"),
            format: Some(format),
            ..Default::default()
        });
        let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("panel"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
            })],
            ..Default::default()
        });
        renderer.render(&mut pass.forget_lifetime(), &painted.triangles, &screen);
        for id in self.textures.free.drain() {
            renderer.free_texture(&id);
        }
    }
}

impl Drop for Overlay {
    fn drop(&mut self) {
        // egui insists that what was not shown is thrown away on purpose.
        self.textures.clear();
    }
}

/// egui's name of a key; one that means nothing to a panel for all that type.
fn egui_key(key: &Key) -> egui::Key {
    match key {
        Key::Named(NamedKey::Tab) => egui::Key::Tab,
        Key::Named(NamedKey::Enter) => egui::Key::Enter,
        Key::Named(NamedKey::Space) => egui::Key::Space,
        Key::Named(NamedKey::Escape) => egui::Key::Escape,
        Key::Named(NamedKey::Delete) => egui::Key::Delete,
        Key::Named(NamedKey::Backspace) => egui::Key::Backspace,
        Key::Named(NamedKey::ArrowLeft) => egui::Key::ArrowLeft,
        Key::Named(NamedKey::ArrowRight) => egui::Key::ArrowRight,
        Key::Named(NamedKey::ArrowUp) => egui::Key::ArrowUp,
        Key::Named(NamedKey::ArrowDown) => egui::Key::ArrowDown,
        Key::Named(NamedKey::Home) => egui::Key::Home,
        Key::Named(NamedKey::End) => egui::Key::End,
        Key::Named(NamedKey::PageUp) => egui::Key::PageUp,
        Key::Named(NamedKey::PageDown) => egui::Key::PageDown,
        Key::Named(NamedKey::F1) => egui::Key::F1,
        Key::Character(typed) if typed == "?" => egui::Key::Questionmark,
        _ => egui::Key::A,
    }
}

/// Radius of a mark in points.
const MARK: f32 = 1.6;

/// Which part of the face is meant.
fn mark_shapes(ctx: &egui::Context, marks: &[[f32; 2]]) -> Vec<egui::epaint::ClippedShape> {
    let color = ctx.global_style().visuals.hyperlink_color.gamma_multiply(0.85);
    let scale = 1.0 / ctx.pixels_per_point();
    let clip_rect = ctx.content_rect();
    let mark = |[x, y]: &[f32; 2]| {
        let shape = egui::Shape::circle_filled(egui::pos2(x * scale, y * scale), MARK, color);
        egui::epaint::ClippedShape { clip_rect, shape, transform_after_tessellation: Default::default() }
    };
    marks.iter().map(mark).collect()
}
