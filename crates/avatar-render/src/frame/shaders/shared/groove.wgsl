// Wrinkles that shapes bring in: grooves of a texture, where and as deep as the skin is wrinkled.

// Light that bounces in the deepest groove is reddened and lost.
const GROOVE_COLOR: vec3f = vec3f(0.76, 0.65, 0.61);
// The share of ambient light that it does not see.
const GROOVE_SHADE: f32 = 0.45;
// Steeper walls than this catch no more light.
const STEEPEST: f32 = 1.2;

struct Groove {
    normal: vec3f,
    // 1 at the bottom of the deepest, 0 where there is none.
    depth: f32,
}

// `relief` is the normal without grooves. Slopes come from heights and need no tangents: M. Mikkelsen, "Bump
// Mapping Unparametrized Surfaces on the GPU", 2010.
fn groove_at(position: vec3f, uv: vec2f, normal: vec3f, relief: vec3f, wrinkled: f32) -> Groove {
    var out = Groove(relief, 0.0);
    if !GROOVES || (material.textures & WRINKLE_TEXTURE) == 0u {
        return out;
    }
    let position_dx = dpdx(position);
    let position_dy = dpdy(position);
    let uv_dx = dpdx(uv);
    let uv_dy = dpdy(uv);
    // A loop of one round: what software adapters skip by a condition only, they compute and throw away.
    var left = wrinkled;
    while left > 0.0 {
        // To the next pixel, but a texel at least: between texels the slope does not change.
        let size = vec2f(textureDimensions(wrinkle_texture));
        let step = max(vec2f(1.0), 1.0 / max(vec2f(length(uv_dx * size), length(uv_dy * size)), vec2f(1e-4)));
        let here = textureSampleGrad(wrinkle_texture, normal_sampler, uv, uv_dx, uv_dy).r;
        let beside = textureSampleGrad(wrinkle_texture, normal_sampler, uv + uv_dx * step.x, uv_dx, uv_dy).r;
        let below = textureSampleGrad(wrinkle_texture, normal_sampler, uv + uv_dy * step.y, uv_dx, uv_dy).r;
        let rise = (vec2f(here) - vec2f(beside, below)) / step * (wrinkled * material.wrinkle_depth);
        let across = cross(position_dy, normal);
        let down = cross(normal, position_dx);
        let area = dot(position_dx, across);
        let slope = (rise.x * across + rise.y * down) / select(min(area, -1e-12), max(area, 1e-12), area > 0.0);
        out.normal = normalize(relief - slope * min(1.0, STEEPEST / max(length(slope), 1e-6)));
        out.depth = here * wrinkled;
        left = 0.0;
    }
    return out;
}
