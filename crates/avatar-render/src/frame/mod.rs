//! One frame: its passes in their order, what they draw into, and the renderer that records them.

pub(crate) mod begin;
pub(crate) mod check_view;
pub(crate) mod crowd_programs;
pub(crate) mod crowds;
pub(crate) mod draw;
pub(crate) mod drawables;
pub(crate) mod far_to_near;
pub(crate) mod part_pipelines;
pub(crate) mod passes;
pub(crate) mod pipelines;
pub(crate) mod programs;
pub(crate) mod record;
pub(crate) mod renderer;
pub(crate) mod see_through;
pub(crate) mod sight;
pub(crate) mod standard;
pub(crate) mod strands;
pub(crate) mod targets;
pub(crate) mod timer;
pub(crate) mod vertices;
