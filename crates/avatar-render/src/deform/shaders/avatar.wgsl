// Group 1: what avatars have for themselves, one after the other.

// The rows of a bone matrix X: posed = vec4(bind, 1) * rows.
alias Bone = mat3x4<f32>;

@group(1) @binding(0) var<storage, read> posed_from_bind: array<Bone>;
// Of each avatar HEAD_ROOM elements: how many words of shapes there are up to the last that is not at rest, a
// bit for each place that is wrinkled, and how strongly each is. Then the words, WORD_ROOM for every 32
// shapes: a bit for each whose weight is not 0, and the weights of all. So a shape at rest costs nothing.
@group(1) @binding(1) var<storage, read> avatar_weights: array<u32>;

// Where those of an avatar begin; only programs for many avatars write these.
var<private> first_bone: u32 = 0u;
var<private> first_weight: u32 = 0u;
