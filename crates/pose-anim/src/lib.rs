//! Controls, poses and smooth transitions for rigged faces.
//!
//! ```text
//!  controls.toml ──▶ ControlTable ──bind(rig, shapes)──▶ Binding
//!  poses.toml ─────▶ PoseSet                               │
//!                      │ press                             │ couple, apply
//!                      ▼                                   ▼
//!                    Player ──advance(dt)──▶ values ──▶ Locals (L per joint), weights per shape
//! ```
//!
//! # Conventions
//!
//! - A **control** is one elementary rotation or translation of a joint, or the weight of one blend shape,
//!   with a range and a default. Its value is in **degrees** (rotations), units of the rig (translations) or
//!   weights; radians exist inside [`Binding::apply`] only. A positive angle turns right-handed about the
//!   control's axis, in the joint's own frame.
//! - Slices of values have one entry per control, in the order of the [`ControlTable`]. This is also the
//!   order of composition within a joint: `L = M₀ · M₁ · …`, so the last control acts on a point first. All
//!   other conventions are those of [`rig_core`].
//! - A **pose** is a named set of values. It may leave controls out.
//! - Times are seconds. The crate has no clock: the caller says how much time passes.
//! - Left and right are the character's own.
//!
//! # Example
//!
//! ```
//! use pose_anim::{ControlTable, Player, PoseSet};
//! use rig_core::Rig;
//!
//! let controls = ControlTable::from_toml(
//!     r#"
//!     [[control]]
//!     name = "head.turn"
//!     joint = "HeadJoint"
//!     axis = "+x"
//!     min = -70
//!     max = 70
//!
//!     [[control]]
//!     name = "smile"
//!     shape = "SSmile"
//!     "#,
//! )?;
//! let poses = PoseSet::from_toml(
//!     r#"
//!     [[pose]]
//!     name = "happy"
//!     key = "1"
//!     controls = { head.turn = 10, smile = 0.8 }
//!     "#,
//!     &controls,
//! )?;
//! let rig = Rig::from_xml(
//!     br#"<JointSet><Joint name="HeadJoint">
//!         <Matrix>1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1</Matrix>
//!     </Joint></JointSet>"#,
//! )?;
//! let binding = controls.bind(&rig, &["SSmile"])?;
//! let (mut locals, mut weights) = (rig.locals(), [0.0]);
//! let mut player = Player::new(&controls);
//! let mut effective = controls.defaults();
//!
//! player.press(poses.get("happy").ok_or("no such pose")?);
//! while !player.is_at_rest() {
//!     player.advance(1.0 / 60.0)?;
//!     binding.couple(player.values(), &mut effective);
//!     binding.apply(&effective, &mut locals, &mut weights)?;
//! }
//! assert_eq!(player.values(), [10.0, 0.8]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Beyond single poses
//!
//! - Poses add up: [`PoseSet::mix`] reads `smile:0.5 wink-left`, [`Pose::mixed`] is the same in code.
//! - A [`Clip`] is a set of keyframe tracks, to be edited, reduced and played through a [`Player`]
//!   ([`Player::play`]). A [`Recording`] is one that a face tracker wrote.
//! - [`Layers`] put further players over a base, with masks and weights: blinking, breathing, speech.
//! - A [`JointPlayer`] moves a whole joint, for rigs without controls.
//! - An [`Easing`] is a transition function: of a pose, or from key to key.
//!
//! ```
//! use pose_anim::{Clip, ControlTable, Easing, Key, LayerMode, Layers, PoseSet, Track, Wrap};
//! use std::sync::Arc;
//!
//! let controls = ControlTable::default_face();
//! let poses = PoseSet::default_face(&controls);
//! let bow = controls.index("head.bow").ok_or("no such control")?;
//!
//! // Breathing, for ever, on top of whatever the face does.
//! let keys = vec![Key::new(0.0, 0.0, Easing::MinimumJerk), Key::new(2.0, 1.5, Easing::MinimumJerk)];
//! let breath = Arc::new(Clip::new("breath", vec![Track::new(bow, keys)?])?.wrapped(Wrap::PingPong));
//! let mut layers = Layers::new(&controls);
//! let breathing = layers.add(&controls, LayerMode::Additive, &vec![1.0; controls.len()]);
//! layers.layer(breathing).ok_or("no such layer")?.play(&breath, None);
//! layers.fade_to(breathing, 1.0, 0.5);
//! layers.base().press(&poses.mix("smile:0.5", &controls)?);
//! layers.advance(3.0)?;
//! // Half of the smile's -2 degrees, and half way back from 1.5.
//! assert!((layers.values()[bow] - (-1.0 + 0.75)).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! How moves are made, and why so, is told in `docs/transitions.md`.
//!
//! This crate knows no files, no clock, no threads and no GPU, and allocates nothing once its objects are
//! made.

pub mod face;
mod error;
mod jet;
mod easing;
mod control;
mod bind;
mod pose;
mod mix;
mod quadratic;
mod range;
mod clip;
mod text;
mod recording;
mod quintic;
mod brake;
mod channel;
mod soft_limit;
mod player;
mod player_crowd;
mod bind_crowd;
mod layers;
mod joints;

pub use bind::Binding;
pub use clip::{Clip, ClipSet, Key, Reduction, Track, Transition, Wrap};
pub use control::{Control, ControlError, ControlTable, Coupling, Drive, JointMotion, Pace};
pub use easing::{Direction, Easing, Family};
pub use error::{AdvanceError, ApplyError, BindError, ClipError, JumpError, MixError, UnknownFace};
pub use jet::Jet;
pub use joints::{JointPlayer, JointTarget};
pub use layers::{LayerId, LayerMode, Layers};
pub use placed_toml::TomlError;
pub use player::Player;
pub use player_crowd::PlayerCrowd;
pub use pose::{Pose, PoseSet, Timing};
pub use recording::{Recording, RecordingError};
pub use soft_limit::soft_sum;
pub use text::{DEFAULT_CONTROLS_TOML, DEFAULT_POSES_TOML};
