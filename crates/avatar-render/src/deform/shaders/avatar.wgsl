// Group 1: what one avatar has for itself.

// The rows of a bone matrix X: posed = vec4(bind, 1) * rows.
alias Bone = mat3x4<f32>;

struct ActiveShape {
    index: u32,
    weight: f32,
}

// Shapes whose weight is not 0, by rising index. A shape at rest costs nothing.
struct ActiveShapes {
    count: u32,
    shapes: array<ActiveShape>,
}

@group(1) @binding(0) var<storage, read> posed_from_bind: array<Bone>;
@group(1) @binding(1) var<storage, read> active_shapes: ActiveShapes;
