// What a lamp sees: depth only.

@vertex
fn shadow_main(@location(0) position_world: vec3f) -> @builtin(position) vec4f {
    return shadow_view.shadow_from_world * vec4f(position_world, 1.0);
}

struct ShadowView {
    shadow_from_world: mat4x4f,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowView;
