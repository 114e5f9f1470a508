//! What a page asks for, without a browser.

#![allow(
    clippy::expect_used,
    clippy::disallowed_methods,
    reason = "helpers of tests may fail, and tests may read files"
)]

mod face;
mod files;
mod look;
mod pictures;
mod speech;
