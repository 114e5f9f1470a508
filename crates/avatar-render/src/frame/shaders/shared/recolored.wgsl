// Other colours than those of the textures.

// Skin in another tone: more or less melanin above, the same blood below. Where blood lies near or there is
// no skin above it, as on lips and in the mouth, the colour is redder than that of bare skin and changes less
// (N. Tsumura et al., "Image-based skin color and texture analysis/synthesis by extracting hemoglobin and
// melanin information in the skin", 2003). What is no redder than blue is no skin: cloth.
fn toned(color: vec3f) -> vec3f {
    if !RECOLORED {
        return color;
    }
    var out = color;
    // A loop of one round, as in groove.wgsl: where the iris alone has another colour.
    for (var is_left = any(material.tone != vec3f(1.0)); is_left; is_left = false) {
        let red = max(color.r, 1e-4);
        let bare = smoothstep(0.05, 0.65, color.g / (red * material.bare_green));
        let warm = smoothstep(0.05, 0.3, 1.0 - color.b / red);
        out = min(color * pow(material.tone, vec3f(bare * warm)), vec3f(1.0));
    }
    return out;
}

// Another colour of the iris: its fibres keep how bright they are, and a part of how they differ in colour.
fn iris_colored(color: vec3f, uv: vec2f) -> vec3f {
    if !RECOLORED {
        return color;
    }
    let iris = material.iris;
    var out = color;
    for (var is_left = iris.uv_radius > 0.0; is_left; is_left = false) {
        let detail = color / iris.painted_color;
        let bright = vec3f(dot(detail, vec3f(0.3, 0.5, 0.2)));
        let inside = 1.0 - smoothstep(0.95, 1.08, length(uv - iris.uv_center) / iris.uv_radius);
        out = mix(color, min(iris.color * mix(bright, detail, 0.35), vec3f(1.0)), inside);
    }
    return out;
}
