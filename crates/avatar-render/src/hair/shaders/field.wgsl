// How far a place is from the skin at bind pose, and which bones move the skin there. The twin on the CPU is
// avatar_groom::Field.

// A distance as a share of the largest in 16 bits and shares of the other bones in 8 bits each, then the
// direction in which the distance grows in 8 bits each. A storage texture, because software adapters read
// those several times faster than buffers.
@group(0) @binding(2) var field: texture_storage_3d<rg32uint, read>;

struct Near {
    // The direction in which the distance grows, of any length.
    outward: vec3f,
    distance: f32,
    shares: vec2f,
}

// A corner of the grid, times its weight; numbers as they are stored.
fn field_corner(place: vec3i, weight: f32) -> Near {
    let texel = textureLoad(field, place).xy;
    // Shifting up and back down extends the sign.
    let outward = vec3f(bitcast<vec3i>(texel.yyy << vec3u(24u, 16u, 8u)) >> vec3u(24u));
    let distance = f32(bitcast<i32>(texel.x << 16u) >> 16u);
    let shares = vec2f(vec2u(texel.x >> 16u, texel.x >> 24u) & vec2u(255u));
    return Near(outward * weight, distance * weight, shares * weight);
}

struct FieldGrid {
    origin: vec3f,
    // Edge of a cell, and cells per unit.
    cell: f32,
    last: vec3f,
    cells: f32,
    // Of a stored distance.
    unit: f32,
}

fn field_grid() -> FieldGrid {
    return FieldGrid(
        hair.field_origin, hair.field_cell, vec3f(hair.field_size) - 1.0, hair.field_cells, hair.field_range / 32767.0);
}

// Between the four corners of the tetrahedron that the place is in: half as many as a cell has.
fn field_at(grid: FieldGrid, place: vec3f) -> Near {
    let wanted = (place - grid.origin) * grid.cells;
    let inside = clamp(wanted, vec3f(0.0), grid.last);
    let low = min(floor(inside), grid.last - 1.0);
    let share = inside - low;
    let first = vec3i(low);
    // From the lowest corner along the axis of the largest share, then of the next, then of the least.
    let most = max(share.x, max(share.y, share.z));
    let least = min(share.x, min(share.y, share.z));
    let middle = share.x + share.y + share.z - most - least;
    let x_leads = share.x >= share.y && share.x >= share.z;
    let y_leads = !x_leads && share.y >= share.z;
    let z_ends = share.z <= share.x && share.z <= share.y;
    let y_ends = !z_ends && share.y <= share.x;
    let lead = vec3i(i32(x_leads), i32(y_leads), i32(!x_leads && !y_leads));
    let end = vec3i(i32(!z_ends && !y_ends), i32(y_ends), i32(z_ends));
    let a = field_corner(first, 1.0 - most);
    let b = field_corner(first + lead, most - middle);
    let c = field_corner(first + 1 - end, middle - least);
    let d = field_corner(first + 1, least);
    let beyond = length(wanted - inside) * grid.cell;
    return Near(
        a.outward + b.outward + c.outward + d.outward,
        (a.distance + b.distance + c.distance + d.distance) * grid.unit + beyond,
        (a.shares + b.shares + c.shares + d.shares) * (1.0 / 255.0));
}
