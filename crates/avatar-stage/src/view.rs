use avatar_pack::Pack;
use avatar_render::avatar_mesh::Bounds;
use avatar_render::glam::Vec3;
use avatar_render::{Camera, Light, Scene, linear_from_srgb8};

/// Samples per pixel, unless a program wants others.
pub const SAMPLES: u32 = 4;
/// Background in sRGB, opaque, unless a program wants another.
pub const BACKGROUND: [u8; 4] = [0x23, 0x27, 0x2e, 255];

/// Angle of view from top to bottom: a lens long enough not to distort a face.
const VERTICAL_FOV_DEGREES: f32 = 24.0;
/// At this share of the distance that shows a head its face fills the picture.
const FACE_DISTANCE: f32 = 0.7;
/// How much of the box's depth is taken into account where the distance is chosen.
const ROUNDNESS: f32 = 0.4;

/// Where the camera stands around the face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Around the vertical axis, in degrees; 90 stands at the character's left.
    pub yaw_degrees: f32,
    /// Above the horizon, in degrees.
    pub pitch_degrees: f32,
    /// Distance as a multiple of the one that shows all of what is framed.
    pub distance: f32,
    /// By how much the head is moved in the picture, to the right and up, in heights of the picture at
    /// `distance` 1.
    pub pan: [f32; 2],
    /// What fills the picture.
    pub framing: Framing,
    /// How high hair reaches ([`avatar_render::AvatarModel::hair_top`]): a portrait shows all of hair that
    /// stands.
    pub hair_top: Option<f32>,
}

/// What fills the picture, measured at bind pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Framing {
    /// All parts.
    Whole,
    /// Head and shoulders of a face with a bust ([`Pack::head`]), which leaves the picture at its lower edge
    /// as in a photograph; all parts of any other avatar.
    Portrait,
    /// The head of an avatar with a body ([`Pack::face`]); all parts of an avatar that is no more than a
    /// head.
    Head,
    /// The face alone, whatever else the avatar has.
    Face,
    /// One part, by its index in [`Pack::parts`]; an index out of range stands for all parts.
    Part(usize),
}

/// The views that have names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedView {
    /// Straight ahead.
    Front,
    /// Between the front and the character's left.
    ThreeQuarter,
    /// The character's left side.
    Left,
    /// The character's right side.
    Right,
    /// From behind.
    Back,
}

impl NamedView {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Front, Self::ThreeQuarter, Self::Left, Self::Right, Self::Back];

    /// The name, for people and command lines.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::ThreeQuarter => "three-quarter",
            Self::Left => "left",
            Self::Right => "right",
            Self::Back => "back",
        }
    }

    /// The view of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.name() == name)
    }

    /// Where the camera stands for it.
    pub const fn view(self) -> View {
        let yaw_degrees = match self {
            Self::Front => 0.0,
            Self::ThreeQuarter => 35.0,
            Self::Left => 90.0,
            Self::Right => -90.0,
            Self::Back => 180.0,
        };
        View { yaw_degrees, ..View::FRONT }
    }
}

impl View {
    /// The whole avatar from the front.
    pub const FRONT: Self = Self {
        yaw_degrees: 0.0,
        pitch_degrees: 0.0,
        distance: 1.0,
        pan: [0.0; 2],
        framing: Framing::Whole,
        hair_top: None,
    };

    /// The camera of a picture of this aspect (width by height).
    pub fn camera(&self, pack: &Pack, aspect: f32) -> Camera {
        let (framed, nearer) = match (self.framing, pack.face()) {
            (Framing::Whole, _) | (Framing::Head, None) => (None, 1.0),
            (Framing::Portrait, _) => (pack.head().map(|head| with_shoulders(head, self.hair_top)), 1.0),
            (Framing::Face, Some(head)) if pack.head().is_some() => (Some(head), FACE_DISTANCE),
            (Framing::Head | Framing::Face, Some(face)) => (Some(face), 1.0),
            (Framing::Face, None) => (None, FACE_DISTANCE),
            (Framing::Part(part), _) => (pack.parts().get(part).and_then(|part| part.bounds), 1.0),
        };
        let bounds =
            framed.or_else(|| pack.bounds()).unwrap_or(Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE });
        let fov = VERTICAL_FOV_DEGREES.to_radians();
        // The distance is that of the front view, so that the head does not grow and shrink as the camera
        // goes round.
        let across = bounds.size().x.max(bounds.size().z);
        // A head is round: the corners of its box that are nearest to the camera are empty. Other files hold
        // anything.
        let is_head = pack.motion().is_none()
            || framed.is_some() && (framed == pack.face() || self.framing == Framing::Portrait);
        let roundness = if is_head { ROUNDNESS } else { 1.0 };
        let half = Vec3::new(across, bounds.size().y, across * roundness) / 2.0;
        let round = Bounds { min: bounds.center() - half, max: bounds.center() + half };
        let whole = nearer * Camera::frame(round, 0.0, 0.0, fov, aspect).eye().distance(bounds.center());
        let (yaw, pitch) = (self.yaw_degrees.to_radians(), self.pitch_degrees.to_radians());
        let straight = Camera::orbit(bounds.center(), whole * self.distance, yaw, pitch, fov, aspect);
        // What lies at the head's distance moves by these shares of the picture.
        let height = 2.0 * whole * (fov / 2.0).tan();
        let [right, up] = self.pan.map(|share| share * height);
        let aside = straight.world_from_camera.transform_vector3(Vec3::new(right, up, 0.0));
        Camera::orbit(bounds.center() - aside, whole * self.distance, yaw, pitch, fov, aspect)
    }

    /// How many pixels a unit of the world has, where the avatar's box at bind pose is nearest, in a picture
    /// of this width and height: what [`avatar_pack::Level::for_pixels`] goes by. Infinity within the box.
    pub fn pixels_per_unit(&self, pack: &Pack, [width, height]: [u32; 2]) -> f32 {
        let camera = self.camera(pack, width as f32 / height.max(1) as f32);
        let bounds = pack.bounds().unwrap_or(Bounds { min: Vec3::NEG_ONE, max: Vec3::ONE });
        let eye = camera.eye();
        let distance = eye.distance(eye.max(bounds.min).min(bounds.max));
        height as f32 / (2.0 * distance * (camera.vertical_fov_rad / 2.0).tan())
    }

    /// The scene of a picture of this aspect (width by height). `background` is sRGB with straight alpha.
    pub fn scene(&self, pack: &Pack, aspect: f32, background: [u8; 4], light: Light) -> Scene {
        Scene { camera: self.camera(pack, aspect), background: linear_from_srgb8(background), light }
    }
}

impl Default for View {
    fn default() -> Self {
        Self::FRONT
    }
}

/// The box around a head, and below it what a portrait shows of neck and shoulders; above it a trace of room
/// for hair. Beside the box a picture has room for hair that lies on the head; only hair that stands makes it
/// higher.
fn with_shoulders(head: Bounds, hair_top: Option<f32>) -> Bounds {
    let height = head.size().y;
    // No hair that stands is longer than a head, whatever a file says.
    let rises = hair_top.map_or(0.0, |top| (top - head.max.y) / height - 0.06);
    let room = if rises > 0.04 { rises.min(1.0) } else { 0.04 };
    Bounds { min: head.min - Vec3::Y * 0.14 * height, max: head.max + Vec3::Y * room * height }
}

/// [`Framing::Portrait`] from the front, before [`BACKGROUND`], in the light of a studio, for a picture of
/// this aspect (width by height).
pub fn portrait(pack: &Pack, aspect: f32) -> Scene {
    let view = View { framing: Framing::Portrait, ..View::FRONT };
    view.scene(pack, aspect, BACKGROUND, Light::studio())
}
