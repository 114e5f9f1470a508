// Blend shapes, then bones: the one place where vertices move. The deform pass calls `deform_vertex`;
// its twin on the CPU is avatar_mesh::deform.
//
//   v_blend = v + sum_k b_k d_k         v_out = sum_i w_i X_i v_blend
//   n_blend = n + sum_k b_k dn_k        n_out = normalize(sum_i w_i mat3(X_i) n_blend)
//
// Where UNEVEN, n_out is turned by the inverse transpose of sum_i w_i mat3(X_i) instead.

struct Deformed {
    position_world: vec3f,
    normal_world: vec3f,
    // Whether the bones make a left hand of a right one; only told where UNEVEN.
    is_mirrored: bool,
}

// Where the table of a part tells what moves a block.
fn row_of(block: u32) -> u32 {
    return block * (1u + 2u * part.word_count);
}

// Both loops go from bit to bit that is set: what software adapters skip by a condition only, they compute
// and throw away.

// How strongly the skin is wrinkled at a place at bind pose, 0 to 1. The twin on the CPU is
// avatar_look::Wrinkle.
fn wrinkled(block: u32, position: vec3f) -> f32 {
    var sum = 0.0;
    var left = avatar_weights[first_weight + 1u];
    while left != 0u {
        let bit = firstTrailingBit(left);
        // The first one is computed wherever it is, also for parts that have no places and no table; of the
        // others those that reach the block.
        left &= (left - 1u) & block_shapes[row_of(block)];
        let place = part.wrinkles[bit];
        let near = saturate(1.5 * (1.0 - distance(position, place.xyz) * place.w));
        sum += bitcast<f32>(avatar_weights[first_weight + 2u + bit]) * near * near * (3.0 - 2.0 * near);
    }
    return min(sum, 1.0);
}

fn blended_from_bind(block: u32, within: u32, bind: Deformed) -> Deformed {
    var blended = bind;
    let end = min(part.first_word + part.word_count, avatar_weights[first_weight]);
    for (var word = part.first_word; word < end; word++) {
        let row = row_of(block) + 1u + 2u * (word - part.first_word);
        let weights = first_weight + HEAD_ROOM + WORD_ROOM * word;
        let moving = block_shapes[row];
        var left = moving & avatar_weights[weights];
        while left != 0u {
            let bit = firstTrailingBit(left);
            left &= left - 1u;
            let stored = block_shapes[row + 1u] + countOneBits(moving & ((1u << bit) - 1u));
            let weight = bitcast<f32>(avatar_weights[weights + 1u + bit]);
            let offset = shape_offsets[stored * SHAPE_BLOCK + within];
            blended.position_world += weight * vec3f(offset.position_x, offset.position_y, offset.position_z);
            blended.normal_world += weight * vec3f(offset.normal_x, offset.normal_y, offset.normal_z);
        }
    }
    if length(blended.normal_world) < MIN_NORMAL_LENGTH {
        blended.normal_world = bind.normal_world;
    }
    return blended;
}

// The matrices are summed instead of the transformed points: one product each for the position and the
// normal. Most vertices follow one or two bones, and a matrix takes longer to read than a vertex.
fn mean_of(bones: VertexBones) -> Bone {
    var mean = bones.weights.x * posed_from_bind[first_bone + bones.indices.x];
    if bones.weights.y != 0.0 {
        mean += bones.weights.y * posed_from_bind[first_bone + bones.indices.y];
    }
    if bones.weights.z != 0.0 {
        mean += bones.weights.z * posed_from_bind[first_bone + bones.indices.z];
    }
    if bones.weights.w != 0.0 {
        mean += bones.weights.w * posed_from_bind[first_bone + bones.indices.w];
    }
    return mean;
}

fn vertex_posed_from_bind(vertex: u32) -> Bone {
    if part.has_vertex_bones == 0u {
        return posed_from_bind[first_bone + part.rigid_bone];
    }
    let posed = mean_of(vertex_bones[vertex * BONE_SETS]);
    if BONE_SETS > 1u {
        return posed + mean_of(vertex_bones[vertex * BONE_SETS + 1u]);
    }
    return posed;
}

fn largest_of(v: vec3f) -> f32 {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// What a matrix makes of a normal if it is to stand on the surface: the cofactors, which are the inverse
// transpose times the determinant, and exist for flat matrices, too. Both steps divide by the largest number,
// so that small and large scales lose nothing; the length is between 1 and 2. `along` is the answer where
// there is no direction.
fn standing_normal(posed: Bone, normal: vec3f, along: vec3f) -> vec3f {
    let largest = max(max(largest_of(posed[0].xyz), largest_of(posed[1].xyz)), largest_of(posed[2].xyz));
    if !(largest > 0.0) {
        return along;
    }
    let x = posed[0].xyz / largest;
    let y = posed[1].xyz / largest;
    let z = posed[2].xyz / largest;
    let turned = vec3f(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
    let size = largest_of(turned);
    if !(size > 0.0) {
        return along;
    }
    return turned / select(size, -size, is_mirroring(posed));
}

fn is_mirroring(posed: Bone) -> bool {
    let largest = max(max(largest_of(posed[0].xyz), largest_of(posed[1].xyz)), largest_of(posed[2].xyz));
    return dot(posed[0].xyz / largest, cross(posed[1].xyz / largest, posed[2].xyz / largest)) < 0.0;
}

// `block` must be the same in all of a workgroup, so that the loops over shapes branch uniformly.
fn deform_vertex(block: u32, within: u32) -> Deformed {
    let vertex = block * SHAPE_BLOCK + within;
    let bind = Deformed(vertices[vertex].position, vertices[vertex].normal, false);
    let blended = blended_from_bind(block, within, bind);
    let posed = vertex_posed_from_bind(vertex);
    var normal = vec4f(blended.normal_world, 0.0) * posed;
    var out: Deformed;
    if UNEVEN {
        normal = standing_normal(posed, blended.normal_world, normal);
        out.is_mirrored = is_mirroring(posed);
    }
    let normal_length = length(normal);
    out.position_world = vec4f(blended.position_world, 1.0) * posed;
    out.normal_world = select(normal / normal_length, bind.normal_world, normal_length < MIN_NORMAL_LENGTH);
    return out;
}
