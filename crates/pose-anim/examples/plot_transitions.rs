//! Draws the figures of `docs/transitions.md` into `docs/images`.
//!
//! `cargo run -p pose-anim --example plot_transitions`

#![allow(clippy::disallowed_methods, reason = "a program may write files")]

use pose_anim::{ControlTable, Jet, Player, Pose};
use std::fmt::Write as _;
use std::path::Path;

const SECS: f64 = 1.0;
const TICKS: usize = 250;

/// A press of a target with a duration, at a time.
type Press = (f64, f64, f64);

/// One way to move, and how it is drawn.
struct Curve {
    name: &'static str,
    colour: &'static str,
    states: Vec<Jet>,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let there_and_back = [(0.0, 1.0, 0.4), (0.2, 0.0, 0.4)];
    let curves = vec![
        curve("linear crossfade", "#b8860b", linear(&there_and_back)),
        curve("exponential smoothing", "#2e8b57", exponential(&there_and_back)),
        curve("clamped inertialization", "#4169e1", inertialized(&there_and_back)),
        curve("this crate", "#c0392b", player(&there_and_back)?),
    ];
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/images");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("transitions-interruption.svg"), figure(&curves, &[0.2], [1.0, 8.0, 80.0]))?;

    let slower = [(0.0, 1.0, 0.4), (0.2, 0.9, 0.7)];
    let curves = vec![
        curve("direct quintic, leaves the range", "#888888", direct(&slower)),
        curve("this crate: fade", "#c0392b", player(&slower)?),
    ];
    std::fs::write(folder.join("transitions-range.svg"), figure(&curves, &[0.2], [1.3, 6.0, 60.0]))?;

    let hectic = [(0.0, 1.0, 0.4), (0.15, 0.0, 0.3), (0.25, 1.0, 0.5), (0.32, 0.8, 0.3), (0.42, 0.0, 0.5)];
    let curves = vec![curve("this crate", "#c0392b", player(&hectic)?)];
    let times: Vec<_> = hectic.iter().skip(1).map(|press| press.0).collect();
    std::fs::write(folder.join("transitions-hectic.svg"), figure(&curves, &times, [1.0, 10.0, 120.0]))?;
    Ok(())
}

fn curve(name: &'static str, colour: &'static str, states: Vec<Jet>) -> Curve {
    Curve { name, colour, states }
}

fn time(tick: usize) -> f64 {
    SECS * tick as f64 / TICKS as f64
}

/// States of a motion that restarts at every press from the state that it had.
fn restarted(presses: &[Press], motion: impl Fn(Jet, f64, f64, f64) -> Jet) -> Vec<Jet> {
    let (mut start, mut states) = (Jet::rest(0.0), Vec::new());
    for (index, (at, target, duration)) in presses.iter().enumerate() {
        let end = presses.get(index + 1).map_or(f64::INFINITY, |next| next.0);
        let here = |time: f64| motion(start, *target, *duration, time - at);
        let ticks = (0..=TICKS).map(time).filter(|time| (*at..end).contains(time));
        states.extend(ticks.map(here));
        start = here(end.min(SECS));
    }
    states
}

/// `x₀ + (T − x₀)·t/D`.
fn linear(presses: &[Press]) -> Vec<Jet> {
    restarted(presses, |start, target, duration, age| {
        if age >= duration {
            return Jet::rest(target);
        }
        let velocity = (target - start.value) / duration;
        Jet { value: start.value + velocity * age, velocity, acceleration: 0.0 }
    })
}

/// `x' = (T − x)/τ`, with τ a quarter of the duration.
fn exponential(presses: &[Press]) -> Vec<Jet> {
    restarted(presses, |start, target, duration, age| {
        let rate = 4.0 / duration;
        let left = (start.value - target) * (-rate * age).exp();
        Jet { value: target + left, velocity: -rate * left, acceleration: rate * rate * left }
    })
}

/// The quintic that starts in a state and ends at rest.
fn quintic(start: Jet, target: f64, duration: f64, age: f64) -> Jet {
    if age >= duration {
        return Jet::rest(target);
    }
    let (s, u) = (age / duration, 1.0 - age / duration);
    let (v, a) = (start.velocity * duration, start.acceleration * duration * duration);
    let c0 = start.value - target;
    let (c1, c2) = (v + 3.0 * c0, 0.5 * a + 3.0 * v + 6.0 * c0);
    let (g, dg) = (c0 + s * (c1 + s * c2), c1 + 2.0 * s * c2);
    Jet {
        value: target + u.powi(3) * g,
        velocity: u * u * (u * dg - 3.0 * g) / duration,
        acceleration: u * (u * (2.0 * u * c2 - 6.0 * dg) + 6.0 * g) / (duration * duration),
    }
}

fn direct(presses: &[Press]) -> Vec<Jet> {
    restarted(presses, quintic)
}

/// Bollo 2018: the difference to the target decays by a quintic that must not grow first: velocity away from
/// the target is dropped, the duration is cut so that it does not cross, and the acceleration is chosen, not
/// kept.
fn inertialized(presses: &[Press]) -> Vec<Jet> {
    restarted(presses, |start, target, duration, age| {
        let sign = if start.value < target { -1.0 } else { 1.0 };
        let x = sign * (start.value - target);
        let v = (sign * start.velocity).min(0.0);
        let duration = if v < 0.0 { duration.min(-5.0 * x / v) } else { duration };
        if duration <= 0.0 {
            return Jet::rest(target);
        }
        let a = ((-8.0 * v * duration - 20.0 * x) / (duration * duration)).max(0.0);
        let state = quintic(Jet { value: x, velocity: v, acceleration: a }, 0.0, duration, age);
        Jet {
            value: target + sign * state.value,
            velocity: sign * state.velocity,
            acceleration: sign * state.acceleration,
        }
    })
}

fn player(presses: &[Press]) -> Result<Vec<Jet>, Box<dyn std::error::Error>> {
    let controls = ControlTable::from_toml("control = [{ name = 'smile', shape = 'S' }]")?;
    let mut player = Player::new(&controls);
    let (mut now, mut presses, mut states) = (0.0, presses.iter().peekable(), Vec::new());
    for tick in 0..=TICKS {
        while let Some((at, target, duration)) = presses.next_if(|press| press.0 <= time(tick)) {
            player.advance(at - now)?;
            now = *at;
            player.press(&Pose::new("p", vec![(0, *target as f32)]).lasting(*duration));
        }
        player.advance(time(tick) - now)?;
        now = time(tick);
        states.extend(player.state(0));
    }
    Ok(states)
}

/// A tip that touches the edge of a panel.
fn arrow(x: f64, y: f64, up: bool) -> String {
    let back = if up { 8.0 } else { -8.0 };
    format!("M{x:.1} {y:.1}l-4 {back}h8z")
}

/// Where a curve is furthest beyond its panel, each time that it leaves it.
fn cut_off(states: &[Jet], part: fn(&Jet) -> f64, least: f64, most: f64) -> Vec<(usize, f64)> {
    let mut found: Vec<(usize, f64)> = Vec::new();
    let mut outside = false;
    for (tick, value) in states.iter().map(part).enumerate() {
        let beyond = !(1.001 * least - 1e-3..=1.001 * most).contains(&value);
        match found.last_mut() {
            Some(last) if beyond && outside && value.abs() > last.1.abs() => *last = (tick, value),
            Some(_) if beyond && outside => {}
            _ if beyond => found.push((tick, value)),
            _ => {}
        }
        outside = beyond;
    }
    found
}

/// Where the velocity changes within one tick by more than the accelerations at both sides explain: there the
/// acceleration is infinite, and which way it points. A move out of rest at a speed is one, too.
fn velocity_jumps(states: &[Jet]) -> Vec<(usize, bool)> {
    let dt = SECS / TICKS as f64;
    let start =
        states.first().filter(|state| state.velocity.abs() > 0.2).map(|state| (0, state.velocity > 0.0));
    let within = states.windows(2).enumerate().filter_map(|(tick, pair)| {
        let change = pair[1].velocity - pair[0].velocity;
        let explained = 2.0 * dt * pair[0].acceleration.abs().max(pair[1].acceleration.abs());
        (change.abs() > explained + 0.2).then_some((tick + 1, change > 0.0))
    });
    start.into_iter().chain(within).collect()
}

/// Value, velocity and acceleration below each other. `scales`: the largest magnitude of each. What is beyond
/// is cut off and marked with a tip and its size, and where the velocity jumps, the acceleration with a
/// dotted line and `∞`.
fn figure(curves: &[Curve], presses: &[f64], scales: [f64; 3]) -> String {
    const WIDTH: f64 = 640.0;
    const LEFT: f64 = 64.0;
    const HEIGHT: f64 = 130.0;
    let (mut svg, plot) = (String::new(), WIDTH - LEFT - 16.0);
    let legend = 20.0 * curves.len() as f64;
    let total = 3.0 * (HEIGHT + 24.0) + legend + 24.0;
    // Writing to a String cannot fail.
    let _ = writeln!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {total}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"{WIDTH}\" height=\"{total}\" fill=\"#ffffff\"/>"
    );
    type Part = (&'static str, fn(&Jet) -> f64);
    let parts: [Part; 3] = [
        ("value", |jet| jet.value),
        ("velocity, 1/s", |jet| jet.velocity),
        ("acceleration, 1/s²", |jet| jet.acceleration),
    ];
    for (panel, ((title, part), scale)) in parts.iter().zip(scales).enumerate() {
        let top = 16.0 + panel as f64 * (HEIGHT + 24.0);
        let least = if panel == 0 { 0.0 } else { -scale };
        let x = |secs: f64| LEFT + plot * secs / SECS;
        let y = |value: f64| top + HEIGHT * (1.0 - (value.clamp(least, scale) - least) / (scale - least));
        let _ = writeln!(
            svg,
            "<rect x=\"{LEFT}\" y=\"{top}\" width=\"{plot}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"#cccccc\"/>\n\
             <text x=\"{}\" y=\"{}\" fill=\"#333333\">{title}</text>",
            LEFT + 6.0,
            top + 14.0
        );
        for value in [least, 0.5 * (least + scale), scale] {
            let _ = writeln!(
                svg,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\" fill=\"#777777\">{value}</text>",
                LEFT - 6.0,
                y(value) + 4.0
            );
        }
        if panel == 0 && scale > 1.0 {
            let _ = writeln!(
                svg,
                "<path d=\"M{LEFT} {0:.1}h{plot}\" stroke=\"#333333\" stroke-dasharray=\"2 3\"/>",
                y(1.0)
            );
        }
        for press in presses {
            let _ = writeln!(
                svg,
                "<path d=\"M{:.1} {top}v{HEIGHT}\" stroke=\"#999999\" stroke-dasharray=\"4 4\"/>",
                x(*press)
            );
        }
        for curve in curves {
            let mut path = String::new();
            for (tick, state) in curve.states.iter().enumerate() {
                let _ = write!(
                    path,
                    "{}{:.1} {:.1}",
                    if tick == 0 { 'M' } else { 'L' },
                    x(time(tick)),
                    y(part(state))
                );
            }
            let _ = writeln!(
                svg,
                "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>",
                curve.colour
            );
            for (tick, value) in cut_off(&curve.states, *part, least, scale) {
                let _ = writeln!(
                    svg,
                    "<path d=\"{}\" fill=\"{1}\"/><text x=\"{2:.1}\" y=\"{3:.1}\" font-size=\"9\" fill=\"{1}\">{value:.0}</text>",
                    arrow(x(time(tick)), y(value), value > 0.0),
                    curve.colour,
                    x(time(tick)) + 6.0,
                    y(value) + if value > 0.0 { 9.0 } else { -3.0 }
                );
            }
            let jumps = if panel == 2 { velocity_jumps(&curve.states) } else { Vec::new() };
            for (tick, up) in jumps {
                let (at, end) =
                    (x(time(tick) - 0.5 * SECS / TICKS as f64), y(if up { scale } else { -scale }));
                let _ = writeln!(
                    svg,
                    "<path d=\"M{at:.1} {:.1}V{end:.1}\" stroke=\"{1}\" stroke-width=\"1.6\" stroke-dasharray=\"1 3\"/>\
                     <path d=\"{2}\" fill=\"{1}\"/><text x=\"{3:.1}\" y=\"{4:.1}\" fill=\"{1}\">∞</text>",
                    y(0.0),
                    curve.colour,
                    arrow(at, end, up),
                    at + 6.0,
                    end + if up { 11.0 } else { -3.0 }
                );
            }
        }
    }
    for (index, curve) in curves.iter().enumerate() {
        let y = 3.0 * (HEIGHT + 24.0) + 24.0 + 20.0 * index as f64;
        let _ = writeln!(
            svg,
            "<path d=\"M{LEFT} {y}h28\" stroke=\"{}\" stroke-width=\"3\"/><text x=\"{}\" y=\"{}\" fill=\"#333333\">{}</text>",
            curve.colour,
            LEFT + 36.0,
            y + 4.0,
            curve.name
        );
    }
    svg + "</svg>\n"
}
