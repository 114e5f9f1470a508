use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// What the panel remembers from run to run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PanelState {
    /// Whether the panel is folded away, except for the button that opens it.
    pub folded: bool,
    /// What the panel shows.
    pub tab: Tab,
    /// Width in points, before narrow windows narrow it.
    pub width: f32,
    /// Size of text and widgets, 1 for the system's. See [`Self::TEXT_SCALES`].
    pub text_scale: f32,
    /// Light or dark.
    pub theme: Theme,
    /// Whether statistics lie over the picture.
    pub show_stats: bool,
    /// Whether the timeline is folded.
    pub timeline_folded: bool,
    /// Whether the first hint has been dismissed.
    pub seen_hint: bool,
}

impl PanelState {
    /// Scales of text that can be chosen.
    pub const TEXT_SCALES: RangeInclusive<f32> = 0.75..=2.0;
    /// Widths of the panel in points.
    pub const WIDTHS: RangeInclusive<f32> = 240.0..=560.0;

    /// The same state within its ranges: a file may hold anything.
    #[must_use]
    pub fn sound(self) -> Self {
        let within = |value: f32, range: RangeInclusive<f32>, otherwise: f32| {
            if value.is_finite() { value.clamp(*range.start(), *range.end()) } else { otherwise }
        };
        let fresh = Self::default();
        Self {
            width: within(self.width, Self::WIDTHS, fresh.width),
            text_scale: within(self.text_scale, Self::TEXT_SCALES, fresh.text_scale),
            ..self
        }
    }
}

impl Default for PanelState {
    fn default() -> Self {
        Self {
            folded: false,
            tab: Tab::Face,
            width: 320.0,
            text_scale: 1.0,
            theme: Theme::Dark,
            show_stats: false,
            timeline_folded: false,
            seen_hint: false,
        }
    }
}

/// What the panel shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Tab {
    /// Sliders.
    #[default]
    Face,
    /// Poses.
    Poses,
    /// Clips; the timeline comes with them.
    Clips,
    /// What the face says.
    Speak,
    /// Who drives the face from outside.
    Live,
    /// Files, camera and display.
    View,
}

impl Tab {
    /// All of them, in their order, with what stands on them.
    pub const ALL: [(Self, &'static str); 6] = [
        (Self::Face, "Face"),
        (Self::Poses, "Poses"),
        (Self::Clips, "Clips"),
        (Self::Speak, "Speak"),
        (Self::Live, "Live"),
        (Self::View, "View"),
    ];
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theme {
    /// As the system wants it.
    System,
    /// Dark text on light ground.
    Light,
    /// Light text on dark ground.
    #[default]
    Dark,
}

impl Theme {
    /// All of them, with their names.
    pub const ALL: [(Self, &'static str); 3] =
        [(Self::System, "System"), (Self::Light, "Light"), (Self::Dark, "Dark")];
}
