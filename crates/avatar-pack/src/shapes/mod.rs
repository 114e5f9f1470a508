//! Further shapes of a pack in the raw format: `shapes.toml` and `shapes.raw`.

mod controls;
mod text;
mod wrinkles;
mod write;

/// What `shapes.toml` says: blend shapes beside the two of the raw format, and mixtures of controls.
///
/// Each shape that nothing else moves, and each mixture, is a control of its name, with the range 0 to 1,
/// unless `controls.toml` has one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FurtherShapes {
    /// The shapes, in the order of `shapes.raw`.
    pub shapes: Vec<FurtherShape>,
    /// The mixtures.
    pub mixtures: Vec<Mixture>,
    /// Where shapes wrinkle the skin.
    pub wrinkles: Vec<WrinklePlace>,
}

/// A blend shape beside the two of the raw format.
#[derive(Clone, Debug, PartialEq)]
pub struct FurtherShape {
    /// Name, unlike those of all other shapes and mixtures.
    pub name: String,
    /// Heading under which it is listed, such as `brows`.
    pub group: Option<String>,
    /// The character's side that it moves, if it moves only one.
    pub side: Option<Side>,
    /// Names of the parts that it moves, in the order in which `shapes.raw` has them.
    pub parts: Vec<String>,
    /// Where its weight comes from.
    pub weight: ShapeWeight,
}

/// Where the weight of a shape comes from.
///
/// Inputs are shapes that have a control of their own, the raw format's two among them, or controls. A
/// control of a joint counts from 0 at its default to 1 at its greatest value.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ShapeWeight {
    /// It is the value of its own control.
    #[default]
    Control,
    /// It is 1 where the input is `at`, and fades to 0 where the next shape of this input stands alone, and
    /// at 0 ([`avatar_mesh::drivers::Rule::Follows`]). A shape with its own control stands alone at 1 of
    /// itself.
    Follows {
        /// The input.
        input: String,
        /// Where the shape stands alone; not 0.
        at: f32,
    },
    /// It is the product of these inputs.
    Product(Vec<String>),
}

/// A control that moves others: a sound of speech, or the name that other programs have for a movement. It
/// acts after the couplings ([`crate::Sliders::mix`]), so that it does so wherever its value comes from.
#[derive(Clone, Debug, PartialEq)]
pub struct Mixture {
    /// Name, unlike those of all shapes and other mixtures.
    pub name: String,
    /// Heading under which it is listed.
    pub group: Option<String>,
    /// The character's side that it moves, if it moves only one.
    pub side: Option<Side>,
    /// The controls, shapes and earlier mixtures that it moves, and how far each from its default at the
    /// mixture's value 1: in degrees, units of the rig or weights.
    pub of: Vec<(String, f32)>,
}

/// A place at which shapes wrinkle the skin; the picture `SkinTex_Wrinkles` says how the wrinkles run.
#[derive(Clone, Debug, PartialEq)]
pub struct WrinklePlace {
    /// Its middle, in the units of the rig at bind pose.
    pub center: [f32; 3],
    /// How far it reaches; above 0.
    pub radius: f32,
    /// Shapes, the raw format's two among them, and how strongly each wrinkles the place at weight 1.
    pub of: Vec<(String, f32)>,
}

/// A side of the character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The character's left, which is +X.
    Left,
    /// The character's right.
    Right,
}

impl Side {
    /// `left` or `right`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}
