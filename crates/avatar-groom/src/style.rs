use crate::{Region, SEGMENTS};
use glam::Vec2;

/// How hair looks and falls, region by region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// The head's own hair.
    pub scalp: RegionStyle,
    /// Above the eyes.
    pub brows: RegionStyle,
    /// At the edges of the lids.
    pub lashes: RegionStyle,
}

/// How the hair of one region looks and falls. Lengths are fractions of the height of the skin, colours are
/// linear.
///
/// A new value is also a line in `hair/text.rs`, which makes it a key of `hair.toml`, and one in the example
/// there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionStyle {
    /// A factor on the density texture: 0 is bald, 1 leaves the texture as it is. Brows and lashes need more
    /// than 1, because they are denser than the texture can express.
    pub density: f32,
    /// Length of a strand.
    pub length: f32,
    /// How much shorter strands may be, 0 (all alike) to 1.
    pub length_variation: f32,
    /// Half the width at the root.
    pub root_radius: f32,
    /// Half the width at the tip.
    pub tip_radius: f32,
    /// Colour at the root.
    pub root_color: [f32; 3],
    /// Colour at the tip.
    pub tip_color: [f32; 3],
    /// How much lighter or darker strands are than the colour says, 0 (all alike) to 1.
    pub color_variation: f32,
    /// How strongly a strand turns from segment to segment to where it is combed and pulled; 0: it stands.
    pub bend: f32,
    /// Pull downward in the world.
    pub gravity: f32,
    /// Pull of the comb at bind pose: away from the parting, which ends at the crown, up, forward.
    pub comb: [f32; 3],
    /// The same for the fine hair at the edge of the forehead and the temples, and more and more of it toward
    /// the front.
    pub edge: [f32; 3],
    /// Pull to the head, at the tip: hair that bends in below the ears, and lies on the neck.
    pub tuck: f32,
    /// How much the comb still pulls away from the skin, 0 (hair falls there) to 1 (it stands).
    pub hold: f32,
    /// How far the hair lifts off the head, as a layer.
    pub volume: f32,
    /// Height above the lowest point of the skin at which the hair is cut at bind pose.
    pub cut: f32,
    /// Where the parting is: to the character's left of the middle.
    pub parting: f32,
    /// Half the width of the strip in the middle that has hair at all; everything where it is 1 or more.
    pub strip: f32,
    /// Radius of curls at the tip.
    pub curl_radius: f32,
    /// Turns of a curl from root to tip.
    pub curl_turns: f32,
    /// How much the strands of a lock meet at its tip, 0 (each for itself) to 1.
    pub clump: f32,
    /// How much each strand goes its own way.
    pub noise: f32,
    /// How many times a second tips swing when the head has moved; 0: they do not.
    pub swing: f32,
}

impl Style {
    /// The presets by name.
    pub const PRESETS: [(&str, Self); 6] = [
        ("short", Self::SHORT),
        ("bob", Self::BOB),
        ("long", Self::LONG),
        ("curly", Self::CURLY),
        ("mohawk", Self::MOHAWK),
        ("bald", Self::BALD),
    ];

    const STRAND: RegionStyle = RegionStyle {
        density: 1.0,
        length: 0.08,
        length_variation: 0.35,
        root_radius: 0.00055,
        tip_radius: 0.00012,
        root_color: [0.035, 0.016, 0.009],
        tip_color: [0.11, 0.052, 0.026],
        color_variation: 0.35,
        bend: 0.5,
        gravity: 0.35,
        comb: [1.0, -0.4, -0.5],
        edge: [1.0, -0.4, -0.5],
        tuck: 0.0,
        parting: 0.0,
        strip: 1.0,
        hold: 1.0,
        volume: 0.01,
        cut: -10.0,
        curl_radius: 0.0,
        curl_turns: 0.0,
        clump: 0.25,
        noise: 0.15,
        swing: 0.0,
    };
    const BROW: RegionStyle = RegionStyle {
        density: 4.0,
        length: 0.018,
        length_variation: 0.5,
        root_radius: 0.0003,
        tip_radius: 0.0001,
        bend: 0.75,
        gravity: 0.0,
        comb: [1.0, 0.25, 0.0],
        clump: 0.1,
        ..Self::STRAND
    };
    const LASH: RegionStyle = RegionStyle {
        density: 16.0,
        length: 0.022,
        length_variation: 0.4,
        tip_radius: 0.00008,
        bend: 0.3,
        comb: [0.4, 0.5, 0.8],
        root_color: [0.008, 0.006, 0.005],
        tip_color: [0.012, 0.009, 0.008],
        ..Self::BROW
    };
    /// Above the ears, parted at the side.
    pub const SHORT: Self = Self {
        scalp: RegionStyle {
            length: 0.16,
            length_variation: 0.4,
            bend: 1.2,
            gravity: 0.35,
            comb: [0.7, 0.15, 0.15],
            edge: [0.7, 0.1, 0.1],
            tuck: 0.0,
            parting: 0.05,
            hold: 0.4,
            volume: 0.04,
            noise: 0.2,
            ..Self::STRAND
        },
        brows: Self::BROW,
        lashes: Self::LASH,
    };
    /// To the chin, parted at the side.
    pub const BOB: Self = Self {
        scalp: RegionStyle {
            length: 0.7,
            length_variation: 0.1,
            bend: 2.0,
            gravity: 0.8,
            comb: [1.0, 0.15, -0.15],
            edge: [0.4, 0.4, -0.9],
            tuck: 0.0,
            parting: 0.05,
            hold: 0.0,
            volume: 0.035,
            cut: 0.2,
            clump: 0.12,
            noise: 0.1,
            swing: 1.8,
            ..Self::STRAND
        },
        ..Self::SHORT
    };
    /// Over the shoulders, parted in the middle.
    pub const LONG: Self = Self {
        scalp: RegionStyle { length: 1.1, parting: 0.0, tuck: 0.0, cut: -0.1, ..Self::BOB.scalp },
        ..Self::SHORT
    };
    /// Curls around the head.
    pub const CURLY: Self = Self {
        scalp: RegionStyle {
            length: 0.45,
            bend: 1.0,
            gravity: 0.6,
            comb: [0.8, 0.2, -0.1],
            edge: [0.6, 0.3, -0.5],
            tuck: 0.0,
            curl_radius: 0.03,
            curl_turns: 4.0,
            clump: 0.9,
            noise: 0.15,
            swing: 2.2,
            volume: 0.02,
            ..Self::STRAND
        },
        ..Self::SHORT
    };
    /// A crest in the middle.
    pub const MOHAWK: Self = Self {
        scalp: RegionStyle {
            length: 0.22,
            length_variation: 0.15,
            bend: 0.15,
            gravity: 0.0,
            comb: [0.0, 0.6, -0.4],
            edge: [0.0, 0.6, -0.4],
            strip: 0.055,
            clump: 0.4,
            swing: 5.0,
            tip_color: [0.5, 0.03, 0.06],
            ..Self::STRAND
        },
        ..Self::SHORT
    };
    /// Brows and lashes only.
    pub const BALD: Self = Self { scalp: RegionStyle { density: 0.0, ..Self::STRAND }, ..Self::SHORT };

    /// Colours of hair by name, linear: [`Style::colored`].
    pub const COLORS: [(&str, [f32; 3]); 8] = [
        ("black", [0.012, 0.010, 0.009]),
        ("dark-brown", [0.055, 0.028, 0.016]),
        ("brown", [0.11, 0.052, 0.026]),
        ("light-brown", [0.22, 0.115, 0.055]),
        ("blond", [0.58, 0.345, 0.135]),
        ("red", [0.27, 0.075, 0.028]),
        ("gray", [0.30, 0.295, 0.29]),
        ("white", [0.72, 0.70, 0.66]),
    ];

    /// This style with hair of this colour: tips have it, roots are darker, and so are brows. Lashes stay.
    pub fn colored(self, color: [f32; 3]) -> Self {
        // Pale hair is less transparent for its own colour: its roots differ less.
        let light = color[0].max(color[1]).max(color[2]).min(1.0);
        let root = color.map(|channel| channel * (0.32 + 0.4 * light));
        let brow = color.map(|channel| channel * (0.75 - 0.35 * light));
        let over = |style: RegionStyle, root_color, tip_color| RegionStyle { root_color, tip_color, ..style };
        Self {
            scalp: over(self.scalp, root, color),
            brows: over(self.brows, root.map(|channel| channel * 0.8), brow),
            ..self
        }
    }

    /// The preset of this name.
    pub fn preset(name: &str) -> Option<Self> {
        Self::PRESETS.into_iter().find(|(other, _)| *other == name).map(|(_, style)| style)
    }

    /// Whether there is hair that swings after the head has moved.
    pub fn swings(&self) -> bool {
        self.scalp.density > 0.0 && self.scalp.strip > 0.0 && self.scalp.swing > 0.0
    }

    /// The style of a region.
    pub fn region(&self, region: Region) -> &RegionStyle {
        match region {
            Region::Scalp => &self.scalp,
            Region::Brows => &self.brows,
            Region::Lashes => &self.lashes,
        }
    }
}

impl RegionStyle {
    /// By how much a curl turns from one point of a strand to the next: cosine and sine.
    pub fn curl_turn(&self) -> Vec2 {
        let angle = std::f32::consts::TAU * self.curl_turns / (SEGMENTS - 1) as f32;
        Vec2::new(libm::cosf(angle), libm::sinf(angle))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bald_and_stiff_heads_do_not_swing() {
        let swinging = Style::PRESETS.into_iter().filter(|(_, style)| style.swings()).map(|(name, _)| name);
        assert_eq!(swinging.collect::<Vec<_>>(), ["bob", "long", "curly", "mohawk"]);
        let with = |change: fn(&mut RegionStyle)| {
            let mut style = Style::LONG;
            change(&mut style.scalp);
            style.swings()
        };
        assert!(with(|_| {}));
        assert!(!with(|scalp| scalp.swing = 0.0));
        assert!(!with(|scalp| scalp.density = 0.0));
        assert!(!with(|scalp| scalp.strip = 0.0));
    }
}
