//! A tracker's stream on the controls of a pack.

use crate::Pack;
use crate::import::{ShapeSet, known_shapes};
use face_space::{Control, Retarget, Standard, meaning};

/// The way from Live Link Face's 61 values to the controls of this avatar, whatever it has: ARKit's shapes in
/// the spelling of any exporter, joints, VRM's expressions, visemes, MakeHuman's units.
///
/// ```
/// use avatar_pack::{Pack, retarget};
///
/// fn play(pack: &Pack, frames: &[[f32; 61]]) {
///     let mut way = retarget(pack);
///     let mut values = pack.controls().defaults();
///     for frame in frames {
///         way.apply(frame, &mut values);
///     }
/// }
/// ```
pub fn retarget(pack: &Pack) -> Retarget {
    let controls = pack.controls().controls();
    let names: Vec<&str> = controls.iter().map(|control| control.name.as_str()).collect();
    let known = known_shapes(&names);
    let controls = controls.iter().zip(known).map(|(control, known)| Control {
        means: meaning(&control.name).or_else(|| place(known?)),
        min: control.min,
        max: control.max,
        rest: control.default,
    });
    Retarget::new(&controls.collect::<Vec<_>>())
}

/// The space and place of a name of a set.
fn place((set, name): (ShapeSet, &str)) -> Option<(Standard, usize)> {
    let space = match set {
        ShapeSet::ArKit => Standard::ArKit,
        ShapeSet::Visemes => Standard::Oculus,
        ShapeSet::MakeHuman => Standard::MakeHuman,
        ShapeSet::Own => Standard::Controls,
        // Shapes that an expression moves are not the expression.
        ShapeSet::Vrm => return None,
    };
    Some((space, space.space().find(name)?))
}
