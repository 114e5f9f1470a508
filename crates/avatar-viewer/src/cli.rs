use crate::face_args::FaceArgs;
use crate::hair_args::HairArgs;
use crate::look_args::LookArgs;
use crate::scene::{BACKGROUND, SAMPLES, View};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// Shows a rigged face in a window, and does the same without one.
///
/// PACK is a folder in the raw format: Transformations.xml, a vertex and an index buffer for each of the seven parts,
/// textures, and optionally controls.toml, poses.toml, materials.toml and hair.toml; or a file of an interchange format
/// (.glb, .gltf, .vrm, .obj, .fbx, .dae, .md5mesh, .bvh; docs/formats.md). Without PACK the built-in avatar is used.
/// Without a verb a window opens; a folder whose name is that of a verb is given as ./NAME.
///
/// Exit status: 0 on success, 2 on wrong usage, 1 on any other failure.
#[derive(Debug, Parser)]
#[command(name = "avatar-viewer", version, args_conflicts_with_subcommands = true)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) window: WindowArgs,
    #[command(subcommand)]
    pub(crate) verb: Option<Verb>,
}

#[derive(Debug, Args)]
pub(crate) struct WindowArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// Size of the window's picture in pixels
    #[arg(long, default_value = "1280x720", value_name = "WIDTHxHEIGHT")]
    pub(crate) size: Size,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Renders one picture without a window
    Render(RenderArgs),
    /// Renders all poses, labelled, from the front and three-quarter
    Sheet(SheetArgs),
    /// Prints joint matrices and blend weights as JSON
    Bones(BonesArgs),
    /// Writes a part's deformed positions and normals as OBJ
    Deform(DeformArgs),
    /// Writes the avatar in another format: .glb with rig, shapes and clips, .obj as it is posed, or a folder in the raw format
    Convert(ConvertArgs),
    /// Writes the strands of hair as the GPU grew them, as JSON
    Strands(StrandsArgs),
    /// Prints the motion of all controls while poses are pressed, as CSV
    Trace(TraceArgs),
    /// Prints what is in a pack
    Info(InfoArgs),
    /// Prints the table of keys
    Keys(KeysArgs),
}

#[derive(Debug, Args)]
pub(crate) struct PackArg {
    /// Folder or file of the avatar [default: the built-in one]
    pub(crate) pack: Option<PathBuf>,
    /// A file, or a folder of files, that belongs to PACK: MakeHuman targets of an OBJ file, frames of an OBJ sequence,
    /// animations of an MD5 mesh; may be repeated
    #[arg(long, value_name = "FILE", requires = "pack")]
    pub(crate) with: Vec<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// The picture, a PNG
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Size in pixels
    #[arg(long, default_value = "1280x720", value_name = "WIDTHxHEIGHT")]
    pub(crate) size: Size,
    /// Where the camera stands; `left` looks at the character's left side
    #[arg(long, value_enum, default_value = "front")]
    pub(crate) view: ViewName,
    /// Camera's angle around the vertical axis in degrees: 90 stands at the character's left [default: the view's]
    #[arg(long, allow_negative_numbers = true, value_parser = finite, value_name = "DEGREES")]
    pub(crate) yaw: Option<f32>,
    /// Camera's angle above the horizon in degrees [default: 0]
    #[arg(long, allow_negative_numbers = true, value_parser = finite, value_name = "DEGREES")]
    pub(crate) pitch: Option<f32>,
    /// Name of the part that fills the picture, where it is at rest [default: the whole head]
    #[arg(long, value_name = "PART")]
    pub(crate) frame: Option<String>,
    /// Samples per pixel, 1 or 4
    #[arg(long, default_value_t = SAMPLES, value_parser = samples)]
    pub(crate) samples: u32,
    /// `#RRGGBB` in sRGB, or `transparent`
    #[arg(long, default_value_t = Background(BACKGROUND), value_name = "COLOUR")]
    pub(crate) background: Background,
}

#[derive(Debug, Args)]
pub(crate) struct SheetArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// The picture, a PNG
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct BonesArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
}

#[derive(Debug, Args)]
pub(crate) struct DeformArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    /// The mesh, an OBJ
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Name of the part [default: skin, or the first part of an avatar without one]
    #[arg(long, value_name = "PART")]
    pub(crate) part: Option<String>,
    /// All parts, in world space, each as an object of its own
    #[arg(long, conflicts_with = "part")]
    pub(crate) world: bool,
    /// Compute on the GPU, with the function that draws
    #[arg(long)]
    pub(crate) gpu: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    /// The file to write, whose end says the format; a name without an end, or with a separator at its end, is that of a
    /// folder
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct StrandsArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    #[command(flatten)]
    pub(crate) hair: HairArgs,
    /// The strands, JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Only the first so many strands
    #[arg(long, value_name = "NUMBER")]
    pub(crate) limit: Option<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    /// Poses (or mixtures) and the seconds at which they are pressed: "0 smile; 0.3 frown; 0.9 smile:0.5 wink-left"
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) script: String,
    /// After all values, also each control's velocity (CONTROL') and acceleration (CONTROL''), per second
    #[arg(long)]
    pub(crate) derivatives: bool,
    /// Rows per second
    #[arg(long, default_value = "240", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) hz: f64,
    /// Seconds; the last row is at or just before this time
    #[arg(long, default_value = "3", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) duration: f64,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct KeysArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
}

/// A picture's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// The largest side that every WebGPU adapter can draw.
const MAX_SIDE: u32 = 8192;

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let side = |text: &str| text.parse().ok().filter(|side| (1..=MAX_SIDE).contains(side));
        let sides =
            text.split_once(['x', 'X']).and_then(|(width, height)| Some((side(width)?, side(height)?)));
        let (width, height) = sides
            .ok_or_else(|| format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}, as in 1280x720"))?;
        Ok(Self { width, height })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ViewName {
    Front,
    Left,
    Right,
    ThreeQuarter,
    Back,
}

impl ViewName {
    /// Where the camera stands.
    pub(crate) fn view(self) -> View {
        let around = |yaw_degrees| View { yaw_degrees, ..View::FRONT };
        match self {
            Self::Front => View::FRONT,
            Self::Left => around(90.0),
            Self::Right => around(-90.0),
            Self::ThreeQuarter => View::THREE_QUARTER,
            Self::Back => around(180.0),
        }
    }
}

/// A background in sRGB with straight alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Background(pub(crate) [u8; 4]);

impl FromStr for Background {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.eq_ignore_ascii_case("transparent") {
            return Ok(Self([0; 4]));
        }
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
        // Not from_str_radix alone: it takes a sign.
        let digits = digits.filter(|digits| digits.bytes().all(|digit| digit.is_ascii_hexdigit()));
        let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        let number = number.ok_or("expected #RRGGBB or transparent")?;
        let [_, red, green, blue] = number.to_be_bytes();
        Ok(Self([red, green, blue, 255]))
    }
}

impl fmt::Display for Background {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            [.., 0] => write!(f, "transparent"),
            [red, green, blue, _] => write!(f, "#{red:02x}{green:02x}{blue:02x}"),
        }
    }
}

fn samples(text: &str) -> Result<u32, String> {
    match text {
        "1" => Ok(1),
        "4" => Ok(4),
        _ => Err("expected 1 or 4".to_owned()),
    }
}

fn finite(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|x: &f32| x.is_finite()).ok_or_else(|| "expected a finite number".to_owned())
}

fn positive(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|x: &f64| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| "expected a finite number above 0".to_owned())
}
