//! Writes a VRM of spheres with plaits, a ponytail and a skirt that swing: `swinging_vrm FILE`. Its clip
//! `shake` shakes the head.

mod body;

#[allow(clippy::disallowed_methods, reason = "a program reads its command line and writes a file")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("usage: swinging_vrm FILE")?;
    std::fs::write(file, body::swinging())?;
    Ok(())
}
