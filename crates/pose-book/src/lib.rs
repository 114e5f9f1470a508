//! Poses and clips as people edit them: the text of a `poses.toml` or `clips.toml` and what it means, changed
//! together.
//!
//! A book holds a text that is always valid. Each edit touches the lines that it is about: comments, order
//! and spelling of everything else stay as they were. An edit that would make the text invalid is refused,
//! and nothing changes. All edits can be undone and done again.
//!
//! ```
//! use pose_anim::{ControlTable, Pose};
//! use pose_book::PoseBook;
//!
//! let text = r#"
//! ## Mine.
//! [[pose]]
//! name = "calm"   # as at home
//! controls = { smile = 0.2 }
//! "#;
//! let controls = ControlTable::default_face();
//! let mut book = PoseBook::read(text, &controls)?;
//! let frown = controls.index("frown").unwrap_or(0);
//! book.add(&Pose::new("cross", vec![(frown, 0.5)]))?;
//! book.rename(0, "serene")?;
//! assert!(book.text().contains("name = \"serene\"   # as at home"));
//! assert_eq!(book.undo(), Some("rename calm to serene".to_owned()));
//! assert_eq!(book.poses().poses.len(), 2);
//! # Ok::<(), pose_book::BookError>(())
//! ```
//!
//! The crate opens no files: the caller writes [`PoseBook::text`] after an edit, and calls
//! [`PoseBook::replace`] when another program has changed the file.

mod error;
mod history;
mod arrange;
mod scalar;
mod pose_table;
mod pose_book;
mod clip_table;
mod clip_book;

pub use clip_book::ClipBook;
pub use error::BookError;
pub use pose_book::PoseBook;
