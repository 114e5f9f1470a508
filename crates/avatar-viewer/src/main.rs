//! Shows a rigged face in a window, and does the same without one.
fn main() {}
