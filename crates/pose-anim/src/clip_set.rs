use crate::{Clip, ControlTable, TomlError, clip_toml};

/// Clips in the order of their file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClipSet {
    /// The clips. Names and keys of a set that was read are unique.
    pub clips: Vec<Clip>,
}

impl ClipSet {
    /// Reads a `clips.toml`:
    ///
    /// ```
    /// # let controls = pose_anim::ControlTable::default_face();
    /// let clips = pose_anim::ClipSet::from_toml(
    ///     r#"
    ///     [[clip]]
    ///     name = "nod"
    ///     key = "n"       # may be absent
    ///     wrap = "once"   # or "loop" or "ping-pong"
    ///     [clip.tracks]
    ///     "head.bow" = [
    ///         { t = 0.0, v = 0, transition = "sine-in-out" },    # a name, or [x1, y1, x2, y2] as in CSS
    ///         { t = 0.3, v = 14, slopes = [0, 0] },              # cubic, with its slopes here and at the next key
    ///         { t = 0.8, v = 0 },                                # straight, if there were a next key
    ///         ## what a key baked into an eased span leaves on either side is a part of the whole:
    ///         ## { t = 0.9, v = 1, part = { of = "sine-in-out", from = 0.5, to = 1, rise = 14 } }
    ///     ]
    ///     "#,
    ///     &controls,
    /// )?;
    /// assert_eq!(clips.get("nod").map(|clip| clip.duration_secs()), Some(0.8));
    /// # Ok::<(), pose_anim::TomlError>(())
    /// ```
    ///
    /// # Errors
    /// The first thing in the text that is not as it has to be, with its place: also a control that the table does
    /// not have, a value out of its range, a time before its predecessor's, a name or key that occurs twice.
    pub fn from_toml(text: &str, controls: &ControlTable) -> Result<Self, TomlError> {
        Ok(clip_toml::read(text, controls)?)
    }

    /// The clip of this name.
    pub fn get(&self, name: &str) -> Option<&Clip> {
        self.clips.iter().find(|clip| clip.name == name)
    }

    /// The clip's name that is probably meant by a misspelt one.
    pub fn nearest(&self, name: &str) -> Option<&str> {
        placed_toml::nearest(name, self.clips.iter().map(|clip| clip.name.as_str()))
    }
}
