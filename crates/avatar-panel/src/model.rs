use pose_anim::{Clip, ControlTable, PoseSet};

/// Everything that is shown, borrowed for one frame.
#[derive(Clone, Copy, Debug)]
pub struct Model<'a> {
    /// The face's controls.
    pub controls: &'a ControlTable,
    /// One value per control: where the face is heading, so that a slider does not run away from the pointer
    /// that holds it.
    pub values: &'a [f32],
    /// Controls that move the part of the picture under the pointer.
    pub highlighted: &'a [usize],

    /// The poses.
    pub poses: &'a PoseSet,
    /// A picture of each pose; what is missing is shown as none yet. With no picture at all the poses are a
    /// list.
    pub thumbnails: &'a [Option<egui::TextureId>],
    /// The pose that the face has or heads for.
    pub active_pose: Option<usize>,
    /// Whether poses can be changed, or why not, as a sentence.
    pub can_save: Result<(), &'a str>,
    /// What an undo takes back, such as `delete smile`.
    pub can_undo: Option<&'a str>,
    /// What a redo does again.
    pub can_redo: Option<&'a str>,

    /// The clips.
    pub clips: &'a [Clip],
    /// Whether the clips differ from their file, and can be written to it.
    pub clips_changed: bool,
    /// What plays.
    pub playback: Playback,
    /// Clips of joints and shapes that the avatar's file brings along: they play, and cannot be edited.
    pub file_clips: &'a [FileClip<'a>],
    /// Which of them plays or is paused, by its index in [`Model::file_clips`].
    pub file_playback: Option<FilePlayback>,

    /// Whether the eyes follow the pointer; `None` where they cannot.
    pub gaze: Option<bool>,
    /// Name of the face's present hair; `None` if there is no hair to choose from.
    pub hair: Option<&'a str>,

    /// All keys of the program in the order of their groups, for the help.
    pub keys: &'a [KeyRow<'a>],
    /// What opens and closes the help: `F1` and `?` are heard by the panel itself where they are among these,
    /// others are the program's.
    pub help_keys: &'a [&'a str],
    /// Names of keys that no pose can have, because the program uses them.
    pub reserved_keys: &'a [&'a str],
    /// Errors, warnings and news, the most important first.
    pub messages: &'a [Message<'a>],
    /// What is being loaded.
    pub loading: Option<Loading<'a>>,
    /// What is measured.
    pub stats: Stats<'a>,
    /// Files that were open before, the last one first.
    pub recent: &'a [String],
    /// Names of the camera's places, such as `front`.
    pub cameras: &'a [&'a str],
    /// Names of the formats of films, such as `PNG frames`.
    pub film_formats: &'a [&'a str],
    /// The film that is being made.
    pub film: Option<FilmProgress>,
    /// Whether the window fills the screen.
    pub full_screen: bool,
}

impl<'a> Model<'a> {
    /// A face with its controls and poses, and nothing else: no values (each control shows its default), no
    /// clips, no keys.
    pub const fn new(controls: &'a ControlTable, poses: &'a PoseSet) -> Self {
        Self {
            controls,
            values: &[],
            highlighted: &[],
            poses,
            thumbnails: &[],
            active_pose: None,
            can_save: Ok(()),
            can_undo: None,
            can_redo: None,
            clips: &[],
            clips_changed: false,
            playback: Playback {
                clip: None,
                time_secs: 0.0,
                playing: false,
                recording_secs: None,
                frame_rate: 60.0,
            },
            file_clips: &[],
            file_playback: None,
            gaze: None,
            hair: None,
            keys: &[],
            help_keys: &["F1", "?"],
            reserved_keys: &[],
            messages: &[],
            loading: None,
            stats: Stats { adapter: "", triangles: 0, strands: 0, passes: &[], frame_ms: &[] },
            recent: &[],
            cameras: &[],
            film_formats: &[],
            film: None,
            full_screen: false,
        }
    }
}

/// What plays, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    /// The clip that plays or is paused.
    pub clip: Option<usize>,
    /// Seconds from its start.
    pub time_secs: f64,
    /// Whether time passes.
    pub playing: bool,
    /// Seconds that have been recorded, while a recording runs.
    pub recording_secs: Option<f64>,
    /// Frames per second, to which keys and the playhead snap.
    pub frame_rate: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self { clip: None, time_secs: 0.0, playing: false, recording_secs: None, frame_rate: 60.0 }
    }
}

/// A clip that the avatar's file brings along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileClip<'a> {
    /// Its name.
    pub name: &'a str,
    /// How long it is.
    pub duration_secs: f64,
}

/// Which clip of the file moves the face, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilePlayback {
    /// Its index in [`Model::file_clips`].
    pub clip: usize,
    /// Seconds from its start.
    pub time_secs: f64,
    /// Whether time passes.
    pub playing: bool,
}

/// A key of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyRow<'a> {
    /// What to press, such as `Shift+h`.
    pub key: &'a str,
    /// What it does.
    pub meaning: &'a str,
    /// Heading under which it stands.
    pub group: &'a str,
}

/// How grave a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Something failed.
    Error,
    /// Something is not as it should be.
    Warning,
    /// News.
    Info,
}

/// Something that the user has to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Message<'a> {
    /// How grave it is.
    pub severity: Severity,
    /// What happened, in one line.
    pub title: &'a str,
    /// The whole of it, with file, line and column; may be empty.
    pub text: &'a str,
    /// Whether it can be dismissed; otherwise it goes when its cause goes.
    pub dismissible: bool,
}

/// Something that is being loaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loading<'a> {
    /// What.
    pub what: &'a str,
    /// How much of it, 0 to 1, if that is known.
    pub fraction: Option<f32>,
}

/// A film that is being made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmProgress {
    /// Frames that are done.
    pub done: usize,
    /// Frames in all.
    pub of: usize,
    /// Whole seconds that are left, once that can be told.
    pub remaining_secs: Option<u64>,
}

/// What is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats<'a> {
    /// Name of the graphics adapter.
    pub adapter: &'a str,
    /// Triangles that are drawn.
    pub triangles: u64,
    /// Strands of hair that are drawn.
    pub strands: u64,
    /// Passes of a frame with the GPU's milliseconds; empty where the adapter cannot tell.
    pub passes: &'a [(&'a str, f32)],
    /// Milliseconds from frame to frame, the latest last.
    pub frame_ms: &'a [f32],
}
