// Strands as ribbons that face the viewer, with light along them: J. Kajiya and T. Kay, "Rendering Fur with
// Three Dimensional Textures", 1989, with the two shifted highlights of T. Scheuermann, "Practical Real-Time
// Hair Rendering and Shading", 2004, after S. Marschner et al., 2003.

// How much light hair in front of a strand blocks, as a factor on its cover. Less than 1: light that enters a
// strand leaves it forward, too.
const STRAND_BLOCKS: f32 = 0.3;

struct StrandOut {
    @builtin(position) position_clip: vec4f,
    // As the target stores it: a strand is so thin that light at its points is enough. Many strands lie in a
    // pixel, and tone mapping for each of them would cost more than all the rest.
    @location(0) color: vec3f,
    // Width of the strand, and distance from its middle, in pixels.
    @location(1) pixels: f32,
    @location(2) off: f32,
    @location(3) @interpolate(flat) random: f32,
}

// Brightness of a highlight that is shifted along the strand.
fn strand_highlight(tangent: vec3f, normal: vec3f, half_way: vec3f, shift: f32, sharpness: f32) -> f32 {
    let along = dot(normalize(tangent + normal * shift), half_way);
    let across = sqrt(max(1.0 - along * along, 0.0));
    return smoothstep(-1.0, 0.0, along) * pow(across, sharpness);
}

// Two tones and a band of light, as in the toon shading of parts.
fn toon_strand_light(point: StrandPoint, normal: vec3f, color: vec3f) -> vec3f {
    let key = frame.lamps[KEY_LAMP];
    let lifted = point.position + normal * hair.margin * 3.0;
    let seen = smoothstep(0.4, 0.6, strand_visibility(KEY_LAMP, lifted, normal));
    let open = smoothstep(0.35, 0.5, hair_visibility(point.position, frame.hair_shadow * STRAND_BLOCKS, 0));
    let light = seen * open * smoothstep(0.08, 0.16, dot(normal, key.direction_world));
    let half_way = normalize(key.direction_world + normalize(frame.eye_world - point.position));
    let band = smoothstep(0.6, 0.75, strand_highlight(point.tangent, normal, half_way, -0.12, 24.0));
    let ambient = irradiance_at(vec3f(0.0, 0.0, 1.0)) * 0.55 + vec3f(0.10, 0.08, 0.14);
    return color * (ambient + key.radiance * light * (0.85 + band));
}

// `open` is the share of light from all directions that other hair lets through.
fn strand_light(point: StrandPoint, color: vec3f, open: f32) -> vec3f {
    let position = point.position;
    let tangent = point.tangent;
    let view = normalize(frame.eye_world - position);
    // The part of the skin's normal that is across the strand: which side of the head it is on.
    let normal = normalize(point.normal - tangent * dot(point.normal, tangent) * 0.7);
    if TOON {
        return toon_strand_light(point, normal, color);
    }
    var light = color * irradiance_at(normal) * open;
    for (var i = 0u; i < LAMP_COUNT; i++) {
        let lamp = frame.lamps[i];
        let n_dot_l = dot(normal, lamp.direction_world);
        let along = dot(tangent, lamp.direction_world);
        let lifted = position + normal * hair.margin * 3.0;
        var seen = strand_visibility(i, lifted, normal);
        if i == KEY_LAMP && frame.hair_shadow > 0.0 {
            seen *= hair_visibility(position, STRAND_BLOCKS, 0);
        } else {
            seen *= open;
        }
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
    let kind = kind_of(strand);
    let random = random_of(strand);
    let style = hair.regions[kind & 255u];
    let point = strand_point(strand, corner, kind);
    let ribbon = ribbon_corner(point, corner);
    let shade = 1.0 + style.color_variation * (random.y * 2.0 - 1.0);
    let color = mix(style.root_color, style.tip_color, point.along) * shade;
    let open = saturate(0.3 + 0.7 * point.along + 0.25 * point.height / (8.0 * hair.margin));
    var out: StrandOut;
    out.position_clip = ribbon.position_clip;
    out.color = target_color(strand_light(point, color, open), 1.0).rgb;
    out.pixels = ribbon.pixels;
    out.off = ribbon.off;
    // By the golden ratio, and none of the root's numbers: those say where a strand lies, and strands that
    // lie side by side would choose the same samples.
    out.random = f32((strand * 2654435769u) >> 8u) * (1.0 / 16777216.0);
    return out;
}
