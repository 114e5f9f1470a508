//! How the panel looks: calm, half transparent, one accent.

use crate::Theme;
use egui::{
    Color32, Context, CornerRadius, Frame, Margin, Shadow, Stroke, Style, ThemePreference, Ui, Visuals, vec2,
};

/// Colours that egui's visuals have no place for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Palette {
    /// What is chosen, changed or playing.
    pub(crate) accent: Color32,
    /// Ground of a row that belongs to what the pointer is on in the picture.
    pub(crate) glow: Color32,
    /// Lines between things.
    pub(crate) line: Color32,
    /// Ground of cards and tracks.
    pub(crate) ground: Color32,
    /// A recording that runs.
    pub(crate) record: Color32,
}

const DARK: Palette = Palette {
    accent: Color32::from_rgb(116, 172, 226),
    glow: Color32::from_rgb(43, 62, 84),
    line: Color32::from_rgb(62, 66, 74),
    ground: Color32::from_rgb(38, 41, 47),
    record: Color32::from_rgb(229, 92, 92),
};

const LIGHT: Palette = Palette {
    accent: Color32::from_rgb(28, 100, 168),
    glow: Color32::from_rgb(206, 225, 244),
    line: Color32::from_rgb(205, 208, 214),
    ground: Color32::from_rgb(226, 229, 234),
    record: Color32::from_rgb(196, 40, 40),
};

/// Share of the panel that hides the picture.
const OPACITY: f32 = 0.88;

pub(crate) fn palette(ui: &Ui) -> Palette {
    if ui.visuals().dark_mode { DARK } else { LIGHT }
}

/// Gives a context the panel's looks.
pub(crate) fn apply(ctx: &Context) {
    ctx.style_mut_of(egui::Theme::Dark, |style| shape(style, visuals(Visuals::dark(), DARK)));
    ctx.style_mut_of(egui::Theme::Light, |style| shape(style, visuals(Visuals::light(), LIGHT)));
}

pub(crate) fn set_theme(ctx: &Context, theme: Theme) {
    ctx.set_theme(match theme {
        Theme::System => ThemePreference::System,
        Theme::Light => ThemePreference::Light,
        Theme::Dark => ThemePreference::Dark,
    });
}

/// The ground of a panel at an edge of the window.
pub(crate) fn edge_frame(ui: &Ui) -> Frame {
    Frame::new().fill(ui.visuals().window_fill.gamma_multiply(OPACITY)).inner_margin(Margin::same(10))
}

/// The ground of something that lies over the picture.
pub(crate) fn float_frame(ui: &Ui) -> Frame {
    edge_frame(ui).corner_radius(8)
}

/// The ground of something within a panel.
pub(crate) fn card_frame(ui: &Ui) -> Frame {
    Frame::new().fill(palette(ui).ground).corner_radius(6).inner_margin(Margin::same(8))
}

fn shape(style: &mut Style, visuals: Visuals) {
    style.visuals = visuals;
    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(6.0, 6.0);
    spacing.button_padding = vec2(8.0, 3.0);
    spacing.interact_size = vec2(36.0, 22.0);
    spacing.slider_rail_height = 4.0;
    spacing.scroll = egui::style::ScrollStyle::thin();
}

fn visuals(base: Visuals, palette: Palette) -> Visuals {
    let dark = base.dark_mode;
    let (panel, text, strong, weak) = if dark {
        (gray(27, 29, 33), gray(205, 208, 212), gray(245, 246, 248), gray(158, 163, 171))
    } else {
        (gray(247, 248, 250), gray(52, 55, 61), gray(12, 14, 18), gray(92, 97, 106))
    };
    let mut visuals = Visuals {
        // Around the panel is the picture: nothing paints over it by default.
        panel_fill: Color32::TRANSPARENT,
        window_fill: panel,
        extreme_bg_color: if dark { gray(17, 19, 22) } else { gray(255, 255, 255) },
        faint_bg_color: palette.ground,
        weak_text_color: Some(weak),
        hyperlink_color: palette.accent,
        warn_fg_color: if dark { Color32::from_rgb(232, 178, 92) } else { Color32::from_rgb(148, 92, 8) },
        error_fg_color: if dark { Color32::from_rgb(240, 128, 120) } else { Color32::from_rgb(178, 34, 34) },
        window_stroke: Stroke::new(1.0, palette.line),
        window_shadow: Shadow { offset: [0, 4], blur: 16, spread: 0, color: Color32::from_black_alpha(80) },
        handle_shape: egui::style::HandleShape::Circle,
        ..base
    };
    visuals.selection.bg_fill = if dark { gray(54, 92, 130) } else { gray(158, 200, 240) };
    visuals.selection.stroke = Stroke::new(1.0, strong);
    let widgets = &mut visuals.widgets;
    let (rest, hover, press) = if dark {
        (gray(52, 56, 63), gray(66, 71, 80), gray(80, 87, 98))
    } else {
        (gray(211, 215, 222), gray(197, 203, 212), gray(181, 189, 200))
    };
    let looks = [
        (&mut widgets.noninteractive, palette.ground, text),
        (&mut widgets.inactive, rest, text),
        (&mut widgets.hovered, hover, strong),
        (&mut widgets.active, press, strong),
        (&mut widgets.open, hover, strong),
    ];
    for (look, fill, text) in looks {
        look.bg_fill = fill;
        look.weak_bg_fill = fill;
        look.fg_stroke = Stroke::new(1.0, text);
        look.bg_stroke = Stroke::NONE;
        look.corner_radius = CornerRadius::same(5);
        look.expansion = 0.0;
    }
    widgets.noninteractive.bg_stroke = Stroke::new(1.0, palette.line);
    // What has the keyboard has to be seen.
    widgets.hovered.bg_stroke = Stroke::new(1.0, palette.accent.gamma_multiply(0.6));
    widgets.active.bg_stroke = Stroke::new(1.5, palette.accent);
    visuals
}

const fn gray(r: u8, g: u8, b: u8) -> Color32 {
    Color32::from_rgb(r, g, b)
}
