// Blend shapes, then bones: the one place where vertices move. The deform pass calls `deform_vertex`;
// its twin on the CPU is avatar_mesh::deform.
//
//   v_blend = v + sum_k b_k d_k         v_out = sum_i w_i X_i v_blend
//   n_blend = n + sum_k b_k dn_k        n_out = normalize(sum_i w_i mat3(X_i) n_blend)

struct Deformed {
    position_world: vec3f,
    normal_world: vec3f,
}

fn blended_from_bind(block: u32, within: u32, bind: Deformed) -> Deformed {
    var blended = bind;
    let block_count = (part.vertex_count + SHAPE_BLOCK - 1u) / SHAPE_BLOCK;
    for (var i = 0u; i < active_shapes.count; i++) {
        let shape = active_shapes.shapes[i];
        if shape.index < part.first_weight {
            continue;
        }
        // Indices rise: all further shapes belong to other parts.
        let own = shape.index - part.first_weight;
        if own >= part.shape_count {
            break;
        }
        let stored = shape_blocks[own * block_count + block];
        if stored != RESTING_BLOCK {
            let offset = shape_offsets[stored * SHAPE_BLOCK + within];
            blended.position_world += shape.weight * vec3f(offset.position_x, offset.position_y, offset.position_z);
            blended.normal_world += shape.weight * vec3f(offset.normal_x, offset.normal_y, offset.normal_z);
        }
    }
    if length(blended.normal_world) < MIN_NORMAL_LENGTH {
        blended.normal_world = bind.normal_world;
    }
    return blended;
}

// The matrices are summed instead of the transformed points: one product each for the position and the
// normal.
fn vertex_posed_from_bind(vertex: u32) -> Bone {
    if part.has_vertex_bones == 0u {
        return posed_from_bind[part.rigid_bone];
    }
    let bones = vertex_bones[vertex];
    return bones.weights.x * posed_from_bind[bones.indices.x]
        + bones.weights.y * posed_from_bind[bones.indices.y]
        + bones.weights.z * posed_from_bind[bones.indices.z]
        + bones.weights.w * posed_from_bind[bones.indices.w];
}

// `block` must be the same in all of a workgroup, so that the loop over shapes branches uniformly.
fn deform_vertex(block: u32, within: u32) -> Deformed {
    let vertex = block * SHAPE_BLOCK + within;
    let bind = Deformed(vertices[vertex].position, vertices[vertex].normal);
    let blended = blended_from_bind(block, within, bind);
    let posed = vertex_posed_from_bind(vertex);
    let normal = vec4f(blended.normal_world, 0.0) * posed;
    let normal_length = length(normal);
    var out: Deformed;
    out.position_world = vec4f(blended.position_world, 1.0) * posed;
    out.normal_world = select(normal / normal_length, bind.normal_world, normal_length < MIN_NORMAL_LENGTH);
    return out;
}
