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

    /// What the face says.
    pub speaking: Speaking<'a>,

    /// Who drives the face from outside; `None` where the program does not listen.
    pub live: Option<Live<'a>>,

    /// Whether the eyes follow the pointer; `None` where they cannot.
    pub gaze: Option<bool>,
    /// Whether the face lives by itself; `None` where it cannot.
    pub life: Option<bool>,
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
            speaking: Speaking::NOTHING,
            live: None,
            gaze: None,
            life: None,
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

/// What the face says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speaking<'a> {
    /// Name of the file that it speaks by, or the beginning of the text, if there is one.
    pub file: Option<&'a str>,
    /// Whether its sound can be played, or why not, as a sentence; `None` where it has no sound.
    pub sound: Option<Result<(), &'a str>>,
    /// Seconds from its beginning.
    pub time_secs: f64,
    /// How long it is.
    pub duration_secs: f64,
    /// Whether the face speaks by it now.
    pub is_speaking: bool,
    /// How much the mouth moves, 0 to 1.
    pub amount: f32,
    /// Whether it says what the microphone hears; or why it cannot hear at all, as a sentence.
    pub microphone: Result<bool, &'a str>,
    /// How loud that is, 0 to 1.
    pub heard: f32,
    /// Why this face cannot speak at all, as a sentence.
    pub cannot: Option<&'a str>,
}

impl Speaking<'_> {
    /// Nothing, in full, of a face that could speak.
    pub const NOTHING: Self = Self {
        file: None,
        sound: None,
        time_secs: 0.0,
        duration_secs: 0.0,
        is_speaking: false,
        amount: 1.0,
        microphone: Ok(false),
        heard: 0.0,
        cannot: None,
    };
}

/// Who drives the face from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Live<'a> {
    /// What can be listened to.
    pub inlets: &'a [Inlet<'a>],
    /// Whether other computers are heard, too.
    pub hears_others: bool,
    /// Pages in a browser that were turned away, since they are not of this computer.
    pub turned_away: &'a [String],
    /// Name of the recording that is played.
    pub recording: Option<&'a str>,
    /// Who has sent something.
    pub senders: &'a [LiveSender<'a>],
    /// Whether the sender that is followed was chosen; otherwise whoever sends a face is.
    pub is_choice: bool,
    /// Milliseconds from the time for which a frame is computed to when it is drawn.
    pub draw_ms: Option<f32>,
    /// Whether something else than zero counts as the person's neutral face.
    pub is_calibrated: bool,
    /// The file that keeps the person's neutral face.
    pub calibration_file: Option<&'a str>,
    /// Whether left and right are swapped.
    pub is_mirrored: bool,
    /// How much is smoothed, 0 to 1.
    pub smooth: f32,
    /// Whether the window stays above others.
    pub is_on_top: bool,
}

/// A format in which faces arrive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inlet<'a> {
    /// What people call it.
    pub name: &'a str,
    /// Where it is listened to, such as `127.0.0.1:11111`; `None` if it is not.
    pub place: Option<&'a str>,
}

/// Somebody who sends a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LiveSender<'a> {
    /// What it calls itself.
    pub name: &'a str,
    /// What it speaks.
    pub protocol: &'a str,
    /// Whether the face follows it.
    pub is_followed: bool,
    /// Whether it sends, and sees a face.
    pub is_live: bool,
    /// Frames a second, of late.
    pub rate_hz: f64,
    /// Frames that came.
    pub received: u64,
    /// Frames that did not come.
    pub lost: u64,
    /// Frames that came when their time was over.
    pub late: u64,
    /// Milliseconds from a fast packet's arrival to its frame in the face.
    pub delay_ms: f64,
}

impl LiveSender<'_> {
    /// Nobody.
    pub const NONE: Self = Self {
        name: "",
        protocol: "",
        is_followed: false,
        is_live: false,
        rate_hz: 0.0,
        received: 0,
        lost: 0,
        late: 0,
        delay_ms: 0.0,
    };
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
