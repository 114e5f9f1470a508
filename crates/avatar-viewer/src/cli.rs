use crate::face_args::FaceArgs;
use crate::hair_args::HairArgs;
use crate::identity_args::IdentityArg;
use crate::life_args::LifeArgs;
use crate::live_args::LiveOptions;
use crate::lod_args::LodArgs;
use crate::look_args::LookArgs;
use crate::numbers::{count, positive};
use crate::output::STANDARD;
use crate::picture_args::{Background, PictureArgs};
use crate::spaces_args::{WayArgs, shapes};
use crate::speech_args::SpeechArgs;
use avatar_film::Rate;
use clap::{ArgGroup, Args, Parser, Subcommand};
use face_space::Standard;
use std::path::PathBuf;
use std::str::FromStr;

/// Shows a rigged face in a window, and does the same without one.
///
/// PACK is a folder in the raw format: Transformations.xml, a vertex and an index buffer for each of the
/// seven parts, textures, and optionally controls.toml, shapes.toml, poses.toml, clips.toml, materials.toml
/// and hair.toml; or a file of an interchange format (.glb, .gltf, .vrm, .obj, .fbx, .dae, .md5mesh, .bvh;
/// docs/formats.md). Without PACK the built-in avatar is used. Without a verb a window opens; a folder whose
/// name is that of a verb is given as ./NAME.
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
    /// Size of the window's picture in pixels [default: as it was left, at first 1280x720]
    #[arg(long, allow_hyphen_values = true, value_name = "WIDTHxHEIGHT")]
    pub(crate) size: Option<Size>,
    /// Show nothing but the face
    #[arg(long)]
    pub(crate) no_panel: bool,
    /// What is behind the face: `transparent` where the desktop can, or `#RRGGBB` in sRGB, as a key for
    /// streaming programs [default: the theme's]
    #[arg(long, value_name = "COLOUR")]
    pub(crate) background: Option<Background>,
    /// Keep the window above others
    #[arg(long)]
    pub(crate) on_top: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Renders one picture without a window
    Render(RenderArgs),
    /// Records a film of poses being pressed, or of a clip: frame k shows the face at k / fps seconds
    Record(RecordArgs),
    /// Films a face that speaks, by labels, a recording or a text
    Speak(SpeakArgs),
    /// Renders all poses, labelled, from the front and three-quarter
    Sheet(SheetArgs),
    /// Prints joint matrices and blend weights as JSON
    Bones(BonesArgs),
    /// Writes a part's deformed positions and normals as OBJ
    Deform(DeformArgs),
    /// Writes the avatar in another format: .glb with rig, shapes and clips, .obj as it is posed, or a folder
    /// in the raw format
    Convert(ConvertArgs),
    /// Writes the strands of hair as the GPU grew them, as JSON
    Strands(StrandsArgs),
    /// Prints the motion of all controls while poses are pressed, as CSV
    Trace(TraceArgs),
    /// Lets a phone, a webcam or a recording drive the face, in a window or without one
    Live(LiveArgs),
    /// Prints what is in a pack
    Info(InfoArgs),
    /// Prints the table of keys
    Keys(KeysArgs),
    /// Prints the names that trackers and avatars have for what a face does, maps between them, and what the
    /// maps lose
    Spaces(SpacesArgs),
}

#[derive(Debug, Args)]
pub(crate) struct PackArg {
    /// Folder or file of the avatar [default: the built-in one]
    pub(crate) pack: Option<PathBuf>,
    /// A file, or a folder of files, that belongs to PACK: MakeHuman targets of an OBJ file, frames of an OBJ
    /// sequence, animations of an MD5 mesh; may be repeated
    #[arg(long, value_name = "FILE", requires = "pack")]
    pub(crate) with: Vec<PathBuf>,
    /// Make another person of the avatar: this axis of its identity to a value from -1 to 1 (`info` lists the
    /// axes), or all axes and the colours of skin, irises and hair as a number draws them; may be repeated,
    /// the later one counts
    #[arg(long, value_name = "AXIS=VALUE|seed:NUMBER", allow_hyphen_values = true)]
    pub(crate) identity: Vec<IdentityArg>,
}

#[derive(Debug, Args)]
pub(crate) struct RenderArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    #[command(flatten)]
    pub(crate) lod: LodArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// The picture; its end says the format: .png, .jpg (or .jpeg) or .webp (without loss). `-` is standard
    /// output. What the face does is written into it
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Format of what goes to standard output: png, jpg or webp [default: png]
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// Size in pixels
    #[arg(long, default_value = "1280x720", allow_hyphen_values = true, value_name = "WIDTHxHEIGHT")]
    pub(crate) size: Size,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("motion").args(["script", "clip"])))]
#[command(group(ArgGroup::new("moving").required(true).multiple(true).args(["script", "clip", "life", "visemes", "audio", "say"])))]
pub(crate) struct RecordArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    /// Poses (or mixtures) and the seconds at which they are pressed: "0 smile; 0.3 frown; 0.9 smile:0.5
    /// wink-left"
    #[arg(long, allow_hyphen_values = true)]
    pub(crate) script: Option<String>,
    /// Clip of the avatar's file or clips.toml, as `info` lists them; or a face tracker's recording, FILE.csv
    #[arg(long, value_name = "NAME")]
    pub(crate) clip: Option<String>,
    #[command(flatten)]
    pub(crate) speech: SpeechArgs,
    #[command(flatten)]
    pub(crate) life: LifeArgs,
    #[command(flatten)]
    pub(crate) film: FilmArgs,
}

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("speaking").required(true).multiple(true).args(["visemes", "audio", "say"])))]
pub(crate) struct SpeakArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) speech: SpeechArgs,
    /// Pose that the face has while it speaks, or a mixture: "smile:0.3"
    #[arg(long, value_name = "NAME")]
    pub(crate) expression: Option<String>,
    #[command(flatten)]
    pub(crate) life: LifeArgs,
    #[command(flatten)]
    pub(crate) film: FilmArgs,
}

/// What a film is made of, beside its motion.
#[derive(Debug, Args)]
pub(crate) struct FilmArgs {
    /// Frames per second, up to 240 (GIF: 50): 30, 12.5 or 30000/1001
    #[arg(long, default_value = "30", allow_hyphen_values = true, value_name = "RATE")]
    pub(crate) fps: Rate,
    /// Seconds [default: until the last motion has come to rest, or the clip's end; 10 of a life alone]
    #[arg(long, value_parser = positive, allow_hyphen_values = true, value_name = "SECONDS")]
    pub(crate) duration: Option<f64>,
    #[command(flatten)]
    pub(crate) lod: LodArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// The film; its end says the format: .gif, .png (animated) or .mp4. A name without one is a folder of
    /// pictures; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Format of what goes to standard output: gif, png or mp4 [default: gif]
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// Size in pixels
    #[arg(long, default_value = "640x360", allow_hyphen_values = true, value_name = "WIDTHxHEIGHT")]
    pub(crate) size: Size,
    #[command(flatten)]
    pub(crate) picture: PictureArgs,
}

#[derive(Debug, Args)]
pub(crate) struct SheetArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) lod: LodArgs,
    #[command(flatten)]
    pub(crate) look: LookArgs,
    /// The picture; its end says the format: .png, .jpg (or .jpeg) or .webp (without loss). `-` is standard
    /// output
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Format of what goes to standard output: png, jpg or webp [default: png]
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct BonesArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    /// The matrices, as .json; `-` is standard output
    #[arg(long, default_value = STANDARD, value_name = "FILE")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct DeformArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    /// The mesh, an .obj; `-` is standard output
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
    /// The file to write, as --out
    #[arg(value_name = "OUT", conflicts_with = "out")]
    pub(crate) target: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    /// The file to write, whose end says the format; a name without an end, or with a separator at its end,
    /// is that of a folder; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Format of what goes to standard output: glb or obj [default: glb]
    #[arg(long, value_name = "FORMAT")]
    pub(crate) format: Option<String>,
    /// The morph targets of a .glb: those of arkit, vrm, visemes or another space (`spaces` lists them),
    /// mixed from what the face has, in place of its own [default: its own shapes and mixtures]
    #[arg(long, value_name = "SPACE", value_parser = shapes)]
    pub(crate) shapes: Option<Standard>,
}

#[derive(Debug, Args)]
pub(crate) struct StrandsArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) face: FaceArgs,
    #[command(flatten)]
    pub(crate) hair: HairArgs,
    /// The strands, as .json; `-` is standard output
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Only the first so many strands
    #[arg(long, value_parser = count, allow_hyphen_values = true, value_name = "NUMBER")]
    pub(crate) limit: Option<usize>,
}

#[derive(Debug, Args)]
pub(crate) struct TraceArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    /// Poses (or mixtures) and the seconds at which they are pressed: "0 smile; 0.3 frown; 0.9 smile:0.5
    /// wink-left"
    #[arg(long, allow_hyphen_values = true, required_unless_present_any = ["life", "visemes", "audio", "say"])]
    pub(crate) script: Option<String>,
    #[command(flatten)]
    pub(crate) speech: SpeechArgs,
    #[command(flatten)]
    pub(crate) life: LifeArgs,
    /// After all values, also each control's velocity (CONTROL') and acceleration (CONTROL''), per second
    #[arg(long, conflicts_with_all = ["life", "visemes", "audio", "say"])]
    pub(crate) derivatives: bool,
    /// Rows per second
    #[arg(long, default_value = "240", value_parser = positive, allow_hyphen_values = true, value_name = "RATE")]
    pub(crate) hz: f64,
    /// Seconds; the last row is at or just before this time
    #[arg(long, default_value = "3", value_parser = positive, allow_hyphen_values = true, value_name = "SECONDS")]
    pub(crate) duration: f64,
    /// The motion, as .csv; `-` is standard output
    #[arg(long, default_value = STANDARD, value_name = "FILE")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct LiveArgs {
    #[command(flatten)]
    pub(crate) window: WindowArgs,
    #[command(flatten)]
    pub(crate) live: LiveOptions,
}

#[derive(Debug, Args)]
pub(crate) struct InfoArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    /// Print JSON instead of text
    #[arg(long)]
    pub(crate) json: bool,
    /// Make the levels of detail and list their triangles and errors; takes seconds
    #[arg(long)]
    pub(crate) levels: bool,
}

#[derive(Debug, Args)]
pub(crate) struct KeysArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
}

#[derive(Debug, Args)]
pub(crate) struct SpacesArgs {
    #[command(flatten)]
    pub(crate) pack: PackArg,
    #[command(flatten)]
    pub(crate) way: WayArgs,
}

/// A picture's size in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

impl Size {
    /// Width by height.
    pub(crate) fn aspect(self) -> f32 {
        self.width.max(1) as f32 / self.height.max(1) as f32
    }

    /// Width and height.
    pub(crate) fn sides(self) -> [u32; 2] {
        [self.width, self.height]
    }
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
