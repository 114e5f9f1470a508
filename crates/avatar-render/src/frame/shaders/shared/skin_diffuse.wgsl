// How skin scatters light below its surface.

// Light that leaves skin which curves as much as this, per channel: E. Penner, "Pre-Integrated Skin Shading",
// 2011. Red light travels farthest, so that it sees the relief of the surface least.
fn pre_integrated(surface: Surface, direction: vec3f) -> vec3f {
    let smooth_n_dot_l = dot(surface.smooth_normal, direction);
    let n_dot_l = mix(vec3f(dot(surface.normal, direction)), vec3f(smooth_n_dot_l), vec3f(0.7, 0.4, 0.25));
    let x = n_dot_l * 0.5 + 0.5;
    let y = saturate(material.scatter * surface.curvature);
    return vec3f(
        textureSampleLevel(scatter_table, clamp_sampler, vec2f(x.r, y.r), 0.0).r,
        textureSampleLevel(scatter_table, clamp_sampler, vec2f(x.g, y.g), 0.0).r,
        textureSampleLevel(scatter_table, clamp_sampler, vec2f(x.b, y.b), 0.0).r);
}

// The edge of a shadow, bled into by light from beside it: red reaches farthest. Penner tabulates this over
// the width of the penumbra; a power per channel stands in for his table.
fn bled(visibility: f32) -> vec3f {
    return pow(vec3f(visibility), vec3f(0.55, 0.85, 1.0));
}

// Share of the light that gets through a slab of this thickness, per channel, over the mean free path.
fn transmittance(thickness: f32) -> vec3f {
    return exp(-vec3f(thickness) / max(material.scatter * PATH_PER_DISTANCE, vec3f(1e-6)));
}

// What thin parts let through from behind; the wrap is that of J. Jimenez et al., 2010. A slab of known
// thickness splits light into what it reflects and what it lets through, so that both together are no more
// than arrived. Without a texture only the shadow map tells how thick the part is, and only on its dark side:
// the lit side reflects all that its colour leaves, and what comes through is at most what that colour takes.
fn with_transmission(surface: Surface, lamp: u32, reflected: vec3f) -> vec3f {
    let has_map = (material.textures & THICKNESS_TEXTURE) != 0u;
    let has_shadow = SHADOW_REACH >= 0 && shadow_of(lamp) != NO_SHADOW;
    if !TRANSMISSION || material.transmission <= 0.0 || !(has_map || has_shadow) {
        return reflected;
    }
    let strength = 0.5 * min(material.transmission, 2.0);
    let n_dot_l = dot(surface.smooth_normal, frame.lamps[lamp].direction_world);
    var split = vec3f(0.0);
    if has_map {
        split = strength * transmittance(surface.thickness);
    }
    // Near the edge of light the map shows the surface itself: no wrap without a texture.
    let behind = wrapped_diffuse(-n_dot_l, vec3f(select(0.0, 0.3, has_map)));
    if behind.r <= 0.0 {
        return reflected * (1.0 - split);
    }
    let through = thickness_toward(lamp, surface.position, surface.smooth_normal);
    var share = strength * transmittance(max(surface.thickness, through));
    if !has_map {
        // The colour is multiplied in later, as for what is reflected: color + color * share <= 1.
        share = min(share, max(1.0 - surface.color, vec3f(0.0)) / max(surface.color, vec3f(1e-3)));
    }
    return reflected * (1.0 - split) + behind * share;
}

// Light that enters the skin before the edge of its own shade leaves behind the edge. A shadow map hides that
// edge sharply: near it, the lamp is tested from above the skin, as high as light travels below it.
fn shadow_point(surface: Surface, lamp: u32) -> vec3f {
    if SCATTERING != PRE_INTEGRATED {
        return surface.position;
    }
    let n_dot_l = dot(surface.smooth_normal, frame.lamps[lamp].direction_world);
    let lift = material.scatter.r * PATH_PER_DISTANCE * smoothstep(0.35, -0.1, n_dot_l);
    return surface.position + surface.smooth_normal * lift;
}

fn diffuse_of(surface: Surface, lamp: u32, seen: f32) -> vec3f {
    let direction = frame.lamps[lamp].direction_world;
    // Far beyond the edge the lamp is seen through openings of the mesh only: that light falls on the inside.
    let visibility = seen * smoothstep(-0.65, -0.3, dot(surface.smooth_normal, direction));
    var reflected = vec3f(0.0);
    if SCATTERING == WRAPPED {
        // Near the edge of light the surface shades itself, smoothly; the map would cut it into steps.
        let own = smoothstep(0.0, 0.25, dot(surface.smooth_normal, direction));
        reflected = mix(1.0, visibility, own) * wrapped_diffuse(dot(surface.normal, direction), material.wrap);
    } else if SCATTERING == PRE_INTEGRATED {
        reflected = bled(visibility) * pre_integrated(surface, direction);
    } else {
        // What arrives; later passes spread it over the skin.
        reflected = vec3f(visibility * max(dot(surface.normal, direction), 0.0));
    }
    return with_transmission(surface, lamp, reflected);
}
