//! The rigid parts: eyeballs, corneas, teeth with gums, tongue.

pub mod eyes;
pub mod teeth;
