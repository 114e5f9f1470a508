//! Writes scenes of any content as GLB, for other programs to read: `random_glb FOLDER COUNT`.
#![allow(
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program: it has arguments and writes files"
)]

#[path = "../tests/all/support/random.rs"]
#[allow(dead_code, unreachable_pub, reason = "shared with tests")]
mod random;

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, count] = &arguments[..] else { return Err("expected FOLDER COUNT".into()) };
    for seed in 0..count.parse()? {
        for (name, scene) in [("random", random::scene(seed)), ("random-awkward", random::awkward(seed))] {
            let bytes = avatar_exchange::glb::write_raw(&scene)?;
            std::fs::write(Path::new(folder).join(format!("{name}-{seed}.glb")), bytes)?;
        }
    }
    Ok(())
}
