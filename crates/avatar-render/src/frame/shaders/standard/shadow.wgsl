// What a lamp sees of surfaces with holes: depth only.

struct ShadowView {
    shadow_from_world: mat4x4f,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowView;

struct ShadowOut {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
    @location(1) opacity: f32,
}

struct ShadowIn {
    @location(0) bind_position_u: vec4f,
    @location(1) bind_normal_v: vec4f,
    @location(2) position_world: vec3f,
}

fn shadow_out(in: ShadowIn, uv_1: vec2f, opacity: f32) -> ShadowOut {
    let uv = vec2f(in.bind_position_u.w, in.bind_normal_v.w);
    let used = select(uv, uv_1, (material.second_uvs & COLOR_TEXTURE) != 0u);
    let position = shadow_view.shadow_from_world * vec4f(in.position_world, 1.0);
    return ShadowOut(position, used, opacity * material.opacity);
}

@vertex
fn cut_shadow_main(in: ShadowIn) -> ShadowOut {
    return shadow_out(in, vec2f(0.0), 1.0);
}

@vertex
fn cut_shadow_extra_main(
    in: ShadowIn, @location(8) uv_1: vec2f, @location(9) color: vec4f) -> ShadowOut {
    return shadow_out(in, uv_1, color.a);
}

@fragment
fn cut_caster_main(in: ShadowOut) {
    var opacity = in.opacity;
    if (material.textures & COLOR_TEXTURE) != 0u {
        opacity *= textureSample(color_texture, color_sampler, in.uv).a;
    }
    if opacity < material.shadow_cutoff {
        discard;
    }
}
