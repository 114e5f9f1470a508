// Group 1: what avatars have for themselves, one after the other.

// The rows of a bone matrix X: posed = vec4(bind, 1) * rows.
alias Bone = mat3x4<f32>;

struct ActiveShape {
    index: u32,
    weight: f32,
}

@group(1) @binding(0) var<storage, read> posed_from_bind: array<Bone>;
// Of each avatar one element whose index is the number of shapes whose weight is not 0, and these shapes, by
// rising index. A shape at rest costs nothing. Behind them as many places of wrinkles as the weight of that
// first element says, by their index, with how strongly each is wrinkled.
@group(1) @binding(1) var<storage, read> active_shapes: array<ActiveShape>;

// Where those of an avatar begin; only programs for many avatars write these.
var<private> first_bone: u32 = 0u;
var<private> first_shape: u32 = 0u;
