/// What a pose is called and how it is called up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseForm {
    /// Unique name.
    pub name: String,
    /// Name of the key that calls it.
    pub key: Option<String>,
    /// Seconds that a move to it takes; `None`: each control takes its own time.
    pub duration_secs: Option<f32>,
}
