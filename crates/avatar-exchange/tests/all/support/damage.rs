//! Damaged input, and what a scene comes to.

use avatar_exchange::{ImportError, Scene};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// What reading a sample may take on a busy machine without optimisation of the C library.
const MAX_TIME: Duration = Duration::from_secs(20);

/// A reader without other files.
pub(crate) type Read = fn(&str, &[u8]) -> Result<Scene, ImportError>;

/// All files below a folder with one of these endings, in order.
pub(crate) fn files(folder: &Path, endings: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, endings));
        } else if path
            .extension()
            .is_some_and(|e| endings.contains(&e.to_string_lossy().to_lowercase().as_str()))
        {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Reads bytes of any kind: a scene that can be posed at rest and in its clips, or an error with its place,
/// in time.
pub(crate) fn read_any(
    read: impl Fn(&str, &[u8]) -> Result<Scene, ImportError>,
    name: &str,
    bytes: &[u8],
) -> Result<Scene, ImportError> {
    let start = Instant::now();
    // What a panic leaves behind is not looked at: the test ends.
    let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        let result = read(name, bytes);
        if let Ok(scene) = &result {
            let mut poses = vec![scene.rest()];
            poses.extend((0..scene.clips.len()).map(|clip| scene.at(clip, 0.5).unwrap()));
            for pose in poses {
                let bones = scene.bones(&pose);
                for (number, part) in scene.parts.iter().enumerate() {
                    let mut out = part.mesh.deformed();
                    let (bones, weights) = (scene.bones_of(number, &bones), scene.weights_of(number, &pose));
                    avatar_mesh::deform(&part.mesh, bones, weights, &mut out).unwrap();
                }
            }
        }
        result
    }));
    let took = start.elapsed();
    assert!(took < MAX_TIME, "{name} took {took:?}");
    let result = result.unwrap_or_else(|_| panic!("{name} panicked"));
    if let Err(error) = &result {
        assert!(
            !error.place.is_empty() && !error.expected.is_empty() && !error.found.is_empty(),
            "{error:?}"
        );
        assert_eq!(error.file, name);
    }
    result
}

/// Cuts and flips, most of which a reader must refuse, and none of which may harm it. Returns how many it
/// took.
pub(crate) fn damage(read: Read, name: &str, bytes: &[u8], flips: usize) -> usize {
    let mut loaded = 0;
    for end in (0..bytes.len()).step_by(64) {
        loaded += usize::from(read_any(read, name, &bytes[..end]).is_ok());
    }
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below as u64) as usize
    };
    for _ in 0..flips {
        let mut damaged = bytes.to_vec();
        for _ in 0..=random(4) {
            let at = random(damaged.len());
            damaged[at] ^= 1 << random(8);
        }
        loaded += usize::from(read_any(read, name, &damaged).is_ok());
    }
    loaded
}

/// The box around all parts at rest.
pub(crate) fn bounds(scene: &Scene) -> [[f32; 3]; 2] {
    let pose = scene.rest();
    let bones = scene.bones(&pose);
    let mut bounds = [[f32::MAX; 3], [f32::MIN; 3]];
    for (number, part) in scene.parts.iter().enumerate() {
        let mut out = part.mesh.deformed();
        avatar_mesh::deform(
            &part.mesh,
            scene.bones_of(number, &bones),
            scene.weights_of(number, &pose),
            &mut out,
        )
        .unwrap();
        for position in out.positions {
            for axis in 0..3 {
                bounds[0][axis] = bounds[0][axis].min(position[axis]);
                bounds[1][axis] = bounds[1][axis].max(position[axis]);
            }
        }
    }
    bounds
}

/// Triangles of all parts.
pub(crate) fn triangles(scene: &Scene) -> usize {
    scene.parts.iter().map(|part| part.mesh.triangles.len()).sum()
}
