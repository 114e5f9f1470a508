use crate::{PoseForm, Theme};
use pose_anim::{Easing, Wrap};

/// What the user wants. The panel changes nothing by itself but its own [`crate::PanelState`]: whoever shows
/// it carries actions out, in their order, and shows what came of it in the next [`crate::Model`].
///
/// Indices are those of the model that was shown. Times are seconds, values those of the control: degrees,
/// units of the rig or weights.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Gives a control a value within its range.
    SetControl {
        /// Index of the control.
        control: usize,
        /// Its new value.
        value: f32,
        /// Whether more of the same change is to come: the pointer still holds the slider. A change by
        /// keyboard comes as a whole.
        dragging: bool,
    },
    /// Takes a control back to its default.
    ResetControl(usize),
    /// Takes all controls back to their defaults.
    ResetAll,
    /// The pointer or the keyboard is now on this control, or on none. Sent when it changes.
    Hover(Option<usize>),

    /// Goes to a pose.
    GoTo(usize),
    /// Changes poses or clips.
    Edit(Edit),

    /// Plays a clip: from where it was paused, or else from its start.
    Play(usize),
    /// Plays a clip of [`crate::Model::file_clips`]: from where it was paused, or else from its start.
    PlayFileClip(usize),
    /// Leaves the file's clip: the face goes back to the values of its controls.
    LeaveFileClip,
    /// Pauses what plays.
    Pause,
    /// Ends the clip and goes to its start.
    Stop,
    /// Shows the clip at a time, paused.
    Scrub {
        /// Index of the clip.
        clip: usize,
        /// Seconds from its start, at least 0.
        time_secs: f64,
    },
    /// Begins to record the face's motion into a new clip.
    StartRecording,

    /// Asks for a recording, or a file of sounds and their times, to speak by it.
    OpenSpeech,
    /// Has a text read aloud, and speaks it.
    Say {
        /// The text; not empty.
        text: String,
        /// The voice that reads it; `None` is the usual one.
        voice: Option<String>,
    },
    /// Speaks by the file or text, from its beginning.
    Speak,
    /// Stops speaking.
    StopSpeaking,
    /// Says what the microphone hears, or no longer.
    Microphone,
    /// Films the face while it speaks by the file or text: the index in [`crate::Model::film_formats`].
    FilmSpeech(usize),
    /// The mouth moves so much while it speaks, 0 to 1.
    SpeechAmount(f32),

    /// Changes who drives the face from outside.
    Live(Wish),

    /// Lets the eyes follow the pointer, or ends that.
    Gaze,
    /// Lets the face live by itself, or keeps it still.
    Life,
    /// Gives the face other hair.
    Hair {
        /// The one before, instead of the next.
        backward: bool,
    },

    /// Asks for a file and opens it.
    OpenFile,
    /// Opens a file again.
    OpenRecent(usize),
    /// Removes a message.
    Dismiss(usize),
    /// Saves the picture.
    Picture,
    /// Films the clip of the file that plays, or the clip that is chosen, or else the present face.
    Film {
        /// Index in [`crate::Model::film_formats`].
        format: usize,
        /// Index of the clip.
        clip: Option<usize>,
    },
    /// Ends the film that is being made, and discards it.
    StopFilm,
    /// Takes the camera to a place: the index in [`crate::Model::cameras`].
    Camera(usize),
    /// Enters or leaves full screen.
    FullScreen,
    /// The theme has changed. The panel has told egui already; this is for the window and its background.
    Theme(Theme),
    /// The scale of text has changed; the panel has told egui already.
    TextScale(f32),
    /// [`crate::Panel::state`] has changed: a good moment to store it.
    Remember,
    /// Ends the program.
    Quit,
}

/// A change of who drives the face from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    /// Begins to listen, or ends that.
    Listen {
        /// Index in [`crate::Live::inlets`].
        inlet: usize,
        /// Whether it is to be listened there.
        is_wanted: bool,
    },
    /// Hears other computers, too, or this one alone.
    HearOthers(bool),
    /// Lets the page of this index in [`crate::Live::turned_away`] in.
    LetIn(usize),
    /// Asks for a recording and plays it.
    Play,
    /// Follows the sender of this index in [`crate::Live::senders`]; `None` whoever sends a face.
    Follow(Option<usize>),
    /// Calls what the person's face is now neutral.
    Calibrate,
    /// Takes the person's face as it is sent again.
    ForgetCalibration,
    /// Swaps left and right, or does not.
    Mirror(bool),
    /// Smooths so much, 0 to 1.
    Smooth(f32),
    /// Keeps the window above others, or does not.
    OnTop(bool),
}

/// A change of poses or clips. Those that write a text or its file can be undone.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Makes a pose of the present face, after all others. The form has been checked.
    SavePose(PoseForm),
    /// Renames a pose or gives it another key or duration; its values stay. The form has been checked.
    EditPose {
        /// Index of the pose.
        index: usize,
        /// Its new name, key and duration.
        form: PoseForm,
    },
    /// Gives a pose the values of the present face.
    UpdatePose(usize),
    /// Moves a pose in the order.
    MovePose {
        /// Its index now.
        from: usize,
        /// Its index afterwards.
        to: usize,
    },
    /// Deletes a pose.
    DeletePose(usize),
    /// Takes back what [`crate::Model::can_undo`] names.
    Undo,
    /// Does again what [`crate::Model::can_redo`] names.
    Redo,

    /// Sets what happens after the end of a clip.
    SetWrap {
        /// Index of the clip.
        clip: usize,
        /// What happens after the end.
        wrap: Wrap,
    },
    /// Bakes the in-between at a time into a key; where the control has no track, the present value begins
    /// one.
    InsertKey {
        /// Index of the clip.
        clip: usize,
        /// Index of the control.
        control: usize,
        /// Seconds from the clip's start.
        time_secs: f64,
    },
    /// Moves a key in time, between its neighbours, and in value.
    MoveKey {
        /// Index of the clip.
        clip: usize,
        /// Index of the control whose track it is.
        control: usize,
        /// Index of the key in the track.
        key: usize,
        /// Its new time.
        time_secs: f64,
        /// Its new value.
        value: f64,
    },
    /// Deletes a key; with the last one goes the track.
    DeleteKey {
        /// Index of the clip.
        clip: usize,
        /// Index of the control whose track it is.
        control: usize,
        /// Index of the key in the track.
        key: usize,
    },
    /// Sets how a track goes on from a key.
    SetTransition {
        /// Index of the clip.
        clip: usize,
        /// Index of the control whose track it is.
        control: usize,
        /// Index of the key in the track.
        key: usize,
        /// The transition function of the span that begins there.
        easing: Easing,
    },
    /// Makes an empty clip.
    NewClip,
    /// Deletes a clip.
    DeleteClip(usize),
    /// Ends the recording, and makes a clip of it.
    StopRecording,
    /// Writes the clips to their file.
    SaveClips,
}
