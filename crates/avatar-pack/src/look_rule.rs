use avatar_exchange::look_at::LookAt;
use rig_core::JointId;

/// What the controls of expressions are called: this, and the expression's name.
pub(crate) const EXPRESSION: &str = "expression.";

/// How a file says that eyes look at things.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LookRule {
    /// What moves, and how far.
    pub look_at: LookAt,
    /// The joint of the head, in whose space the place between the eyes is.
    pub head: JointId,
}
