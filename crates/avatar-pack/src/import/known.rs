use super::Role;
use avatar_exchange::look_at::LookAt;
use avatar_mesh::expressions::Expression;

/// What a file says about its scene, so that it need not be guessed.
#[derive(Debug, Default)]
pub(super) struct Known {
    /// What some nodes do.
    pub(super) roles: Vec<(Role, usize)>,
    /// How the eyes look at things, and the node of the head.
    pub(super) look: Option<(LookAt, usize)>,
    /// Expressions of the face.
    pub(super) expressions: Vec<NamedExpression>,
}

/// An expression, of which a control is made.
#[derive(Debug)]
pub(super) struct NamedExpression {
    pub(super) name: String,
    /// Its places are those of `binds`.
    pub(super) expression: Expression,
    /// Nodes and their shapes.
    pub(super) binds: Vec<(usize, usize)>,
}
