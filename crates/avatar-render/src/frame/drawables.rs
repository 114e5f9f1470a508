//! What is drawn in the picture, as one list.

use crate::frame::programs::{NATURAL, OUTLINE, PLAIN, Programs, TOON};
use crate::gpu::program::Program;
use crate::model::effects::Effects;
use crate::view::shading::Shading;
use avatar_mesh::PartKind;

/// A kind of part in the picture, and the pipeline that draws it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawable {
    /// Which parts.
    pub(crate) kind: PartKind,
    /// Name of its group in graphics debuggers.
    pub(crate) label: &'static str,
    pub(crate) program: Program,
    /// What its program can show.
    pub(crate) effects: Effects,
    pub(crate) cull_mode: Option<wgpu::Face>,
    /// Whether it shows the back sides of what another one shows from the front: of skin that has some.
    pub(crate) is_back: bool,
    /// Whether it is blended over what is there, without writing depth.
    pub(crate) is_transparent: bool,
}

/// The order in which the picture is drawn, all avatars step by step. The skin comes first because it hides
/// most of the rest; its back sides after everything that hides them, by a program of their own: software
/// renderers shade hidden pixels when there are several samples, and one full program for both sides doubled
/// the cost of a frame there. What is transparent comes last, from far to near.
pub(crate) fn draw_order(shading: Shading) -> Vec<Drawable> {
    let programs: Programs = match shading {
        Shading::Plain => PLAIN,
        Shading::Natural(_) => NATURAL,
        Shading::Toon => TOON,
    };
    let part = |kind, label, program, cull_mode| Drawable {
        kind,
        label,
        program,
        effects: Effects::ALL,
        cull_mode,
        is_back: false,
        is_transparent: false,
    };
    let line = |kind, label| Drawable {
        effects: Effects::TONES,
        ..part(kind, label, OUTLINE, Some(wgpu::Face::Front))
    };
    let (fronts, backs) = (Some(wgpu::Face::Back), Some(wgpu::Face::Front));
    let cornea = part(PartKind::Cornea, "cornea", programs.cornea, fronts);
    let mut order = vec![
        part(PartKind::Skin, "skin", programs.skin, fronts),
        // Rows of teeth are often open sheets: they are drawn from both sides.
        part(PartKind::Surface, "teeth", programs.teeth, None),
        // Eyeballs are closed: their back sides are never seen.
        part(PartKind::Eyeball, "eyeball", programs.eyeball, fronts),
        Drawable {
            effects: Effects::COLORS,
            // A cartoon's outline lies behind it.
            is_back: shading != Shading::Toon,
            ..part(PartKind::Skin, "skin back", programs.skin_back, backs)
        },
    ];
    if shading == Shading::Toon {
        order.push(line(PartKind::Skin, "outline of skin"));
        order.push(line(PartKind::Eyeball, "outline of eyeball"));
    }
    order.push(Drawable { is_transparent: true, ..cornea });
    order
}
