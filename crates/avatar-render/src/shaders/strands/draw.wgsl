// Strands as ribbons that face the viewer, with light along them: J. Kajiya and T. Kay, "Rendering Fur with Three
// Dimensional Textures", 1989, with the two shifted highlights of T. Scheuermann, "Practical Real-Time Hair Rendering and
// Shading", 2004, after S. Marschner et al., 2003.

@group(2) @binding(0) var<uniform> hair: Hair;
@group(2) @binding(1) var<storage, read> roots: array<Root>;
@group(2) @binding(2) var<storage, read> points: array<vec4f>;

struct StrandOut {
    @builtin(position) position_clip: vec4f,
    // Light toward the viewer: the strand is thin, so that its points say it all.
    @location(0) light: vec3f,
    // Share of a pixel that the strand covers.
    @location(1) coverage: f32,
    @location(2) @interpolate(flat) random: f32,
}

// Brightness of a highlight that is shifted along the strand.
fn strand_highlight(tangent: vec3f, normal: vec3f, half_way: vec3f, shift: f32, sharpness: f32) -> f32 {
    let along = dot(normalize(tangent + normal * shift), half_way);
    let across = sqrt(max(1.0 - along * along, 0.0));
    return smoothstep(-1.0, 0.0, along) * pow(across, sharpness);
}

// `open` is the share of light that other hair lets through.
fn strand_light(position: vec3f, tangent: vec3f, skin_normal: vec3f, color: vec3f, open: f32) -> vec3f {
    let view = normalize(frame.eye_world - position);
    // The part of the skin's normal that is across the strand: which side of the head it is on.
    let normal = normalize(skin_normal - tangent * dot(skin_normal, tangent) * 0.7);
    var light = color * irradiance_at(normal) * open;
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let n_dot_l = dot(normal, lamp.direction_world);
        let along = dot(tangent, lamp.direction_world);
        let lifted = position + normal * hair.margin * 3.0;
        let seen = lamp_visibility(i, lifted, normal) * open;
        let diffuse = sqrt(max(1.0 - along * along, 0.0)) * saturate(mix(0.35, 1.0, n_dot_l));
        let half_way = normalize(lamp.direction_world + view);
        let side = saturate(n_dot_l * 1.5 + 0.5);
        let first = strand_highlight(tangent, normal, half_way, 0.06, 120.0) * 0.05;
        let second = strand_highlight(tangent, normal, half_way, -0.12, 24.0) * 0.9;
        light += lamp.radiance * seen * (color * (diffuse + second * side) + vec3f(first * side));
    }
    return light;
}

@vertex
fn strand_main(@builtin(vertex_index) corner: u32, @builtin(instance_index) strand: u32) -> StrandOut {
    let root = roots[strand];
    let style = hair.regions[root.region];
    let i = corner / 2u;
    let first = strand * (SEGMENTS + 2u);
    let here = points[first + i];
    let before = points[first + max(i, 1u) - 1u].xyz;
    let after = points[first + min(i + 1u, SEGMENTS)].xyz;
    let t = f32(i) / f32(SEGMENTS);
    let tangent = normalize(after - before + vec3f(1e-9, 0.0, 0.0));
    let to_eye = frame.eye_world - here.xyz;
    let distance = length(to_eye);
    let across = cross(tangent, to_eye / max(distance, 1e-6));
    let side = across / max(length(across), 1e-4);
    // Thinner than a pixel, a strand stays a pixel wide and covers less of it instead: it fades, and does not flicker.
    let radius = mix(style.root_radius, style.tip_radius, t) * hair.width_factor;
    let pixels = 2.0 * radius * frame.pixels_per_unit / max(distance, 1e-6);
    let widened = radius * max(1.0, 1.0 / max(pixels, 1e-4));
    let offset = side * widened * select(-1.0, 1.0, (corner & 1u) == 0u);
    let shade = 1.0 + style.color_variation * (root.random.y * 2.0 - 1.0);
    let color = mix(style.root_color, style.tip_color, t) * shade;
    let open = saturate(0.3 + 0.7 * t + 0.25 * here.w / (8.0 * hair.margin));
    var out: StrandOut;
    out.position_clip = frame.clip_from_world * vec4f(here.xyz + offset, 1.0);
    out.light = strand_light(here.xyz, tangent, points[first + SEGMENTS + 1u].xyz, color, open);
    out.coverage = min(pixels, 1.0);
    out.random = root.random.z;
    return out;
}

struct StrandPixel {
    @location(0) color: vec4f,
    @builtin(sample_mask) samples: u32,
}

@fragment
fn strand_fragment_main(in: StrandOut) -> StrandPixel {
    let color = target_color(in.light, 1.0).rgb;
    if !COVERAGE_MASK {
        return StrandPixel(vec4f(color * in.coverage, in.coverage), 1u);
    }
    // Which samples a strand covers is the strand's own choice: with one pattern for all, strands would lie under one
    // another without ever closing the hair. E. Enderton et al., "Stochastic Transparency", 2010.
    let count = u32(in.coverage * 4.0 + fract(in.random * 61.0));
    let turned = u32(in.random * 4.0) & 3u;
    let run = (1u << min(count, 4u)) - 1u;
    let mask = ((run << turned) | (run >> (4u - turned))) & 15u;
    return StrandPixel(vec4f(color, 1.0), mask);
}
