// Moves guides: each point hangs on a spring from where it would grow without motion. A point's way between
// two frames is straight; ticks are the same ones for every frame rate.

struct Swing {
    ticks: u32,
    // When the first tick ends, between the last frame (0) and this one (1), and the time from one tick to
    // the next.
    first: f32,
    step: f32,
    // Seconds from the last tick to the frame, and of a tick.
    rest: f32,
    tick: f32,
    is_still: u32,
    // Per point of a strand: the factors of offset and speed in the next offset (xy), and in the next speed
    // (zw).
    oscillators: array<vec4f, SEGMENTS + 1u>,
}

// A point of a guide.
struct Mote {
    position: vec3f,
    velocity: vec3f,
    // Where the spring held it at the last tick, and at the last frame.
    held: vec3f,
    held_at_frame: vec3f,
}

@group(0) @binding(0) var<uniform> swing: Swing;
// Per guide its points where they grow.
@group(0) @binding(1) var<storage, read> guides: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> motes: array<Mote>;
// How far each point of a guide is from where it grows.
@group(0) @binding(3) var<storage, read_write> offsets: array<vec4f>;

@compute @workgroup_size(GROW_WORKGROUP_SIZE)
fn swing_main(@builtin(global_invocation_id) id: vec3u) {
    let first = id.x * (SEGMENTS + 2u);
    if first >= arrayLength(&motes) {
        return;
    }
    var grown_before = guides[first].xyz;
    var before = grown_before;
    for (var i = 0u; i <= SEGMENTS; i++) {
        let grown = guides[first + i].xyz;
        var mote = motes[first + i];
        // A pose that was NaN must not spoil later frames.
        if swing.is_still != 0u || !(dot(mote.position, mote.position) < 1e30) {
            mote = Mote(grown, vec3f(0.0), grown, grown);
        }
        let spring = swing.oscillators[i];
        for (var k = 0u; k < swing.ticks; k++) {
            let now = mix(mote.held_at_frame, grown, saturate(swing.first + f32(k) * swing.step));
            let carried = (now - mote.held) / swing.tick;
            let y = mote.position - mote.held;
            let speed = mote.velocity - carried;
            mote.position = now + spring.x * y + spring.y * speed;
            mote.velocity = carried + spring.z * y + spring.w * speed;
            mote.held = now;
        }
        let carried = (grown - mote.held_at_frame) * (swing.step / swing.tick);
        mote.held_at_frame = grown;
        motes[first + i] = mote;
        // Extrapolated from the last tick; a strand does not get longer.
        let y = mote.position - mote.held + (mote.velocity - carried) * swing.rest;
        let way = grown + y - before;
        let moved = before + way * (distance(grown, grown_before) / max(length(way), 1e-9));
        offsets[first + i] = vec4f(select(moved - grown, vec3f(0.0), i < 2u), 0.0);
        before = grown + offsets[first + i].xyz;
        grown_before = grown;
    }
}
