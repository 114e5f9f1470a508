// What growth reads: roots, guides, the deformed skin, the pose. Lists are storage textures: of others,
// software adapters look up the size of the mip level for every texel.

// The head's bone, and what the other bones add to a point of the head's bind pose to take it to theirs.
struct HairPose {
    head: Bone,
    others: array<Bone, OTHER_BONES>,
}

@group(0) @binding(0) var<uniform> hair: Hair;
@group(0) @binding(1) var roots: texture_storage_2d<rgba32uint, read>;
// The points of guides, the strands that others follow, as they have grown.
@group(0) @binding(4) var guides: texture_storage_2d<rgba32float, read>;
// Per vertex its position and its normal.
@group(2) @binding(0) var deformed: texture_storage_2d<rgba32float, read>;
@group(2) @binding(1) var<uniform> pose: HairPose;

const POINT_STRIDE: u32 = SEGMENTS + 2u;

fn normalize_or(v: vec3f, other: vec3f) -> vec3f {
    let length2 = dot(v, v);
    // Not inverseSqrt: some adapters only approximate it.
    return select(other, v * (1.0 / sqrt(max(length2, 1e-30))), length2 > 1e-20);
}

// Bones are rigid: rows of rotation and translation.
fn moved(bone: Bone, point: vec3f) -> vec3f {
    return vec4f(point, 1.0) * bone;
}

fn turned_back(bone: Bone, direction: vec3f) -> vec3f {
    return bone[0].xyz * direction.x + bone[1].xyz * direction.y + bone[2].xyz * direction.z;
}

fn vec4_of(list: texture_storage_2d<rgba32float, read>, index: u32) -> vec3f {
    return textureLoad(list, texel_of(index)).xyz;
}

fn root_of(strand: u32) -> Root {
    let a = textureLoad(roots, texel_of(4u * strand));
    let b = textureLoad(roots, texel_of(4u * strand + 1u));
    let c = textureLoad(roots, texel_of(4u * strand + 2u));
    let d = textureLoad(roots, texel_of(4u * strand + 3u));
    return Root(
        a.xyz, a.w & 255u, bitcast<vec3f>(b.xyz), b.w, bitcast<vec3f>(c.xyz), bitcast<f32>(c.w), bitcast<vec3f>(d.xyz),
        bitcast<f32>(d.w));
}

struct DeformedVertex {
    position: vec3f,
    normal: vec3f,
}

fn deformed_vertex(vertex: u32) -> DeformedVertex {
    return DeformedVertex(vec4_of(deformed, 2u * vertex), vec4_of(deformed, 2u * vertex + 1u));
}
