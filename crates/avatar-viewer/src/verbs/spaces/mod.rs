//! Spaces of names, maps between them, and what they lose.

mod vertices;

use crate::cli::SpacesArgs;
use crate::standard;
use anyhow::{Result, anyhow};
use face_space::{Fate, Loss, Map, Route, Space, Standard};
use std::fmt::Write;

pub(super) fn run(args: &SpacesArgs) -> Result<()> {
    let mut out = String::new();
    match (args.way.from, args.way.to) {
        (Some(from), Some(to)) => {
            let mut there = route(from, to)?;
            if args.way.report {
                let mut back = route(to, from)?;
                report(&mut out, &Loss::of(&mut there, &mut back), from.space(), to.space());
                if let Some(path) = &args.way.over {
                    out += &vertices::report(&args.pack, path, from, to)?;
                }
            } else {
                there.maps().iter().for_each(|map| rules(&mut out, map));
            }
        }
        (Some(space), None) => names(&mut out, space.space()),
        _ => list(&mut out),
    }
    standard::print(&out)
}

fn route(from: Standard, to: Standard) -> Result<Route> {
    Route::between(from, to)
        .ok_or_else(|| anyhow!("expected a way from {} to {}, found none", from.key(), to.key()))
}

fn list(out: &mut String) {
    for space in Standard::ALL {
        let maps: Vec<_> =
            Standard::ALL.into_iter().filter(|to| space.map_to(*to).is_some()).map(Standard::key).collect();
        let (key, count, title) = (space.key(), space.space().len(), space.space().title());
        let _ = writeln!(out, "{key:<16} {count:>3} names  {title:<22} maps to {}", maps.join(", "));
    }
}

fn names(out: &mut String, space: &Space) {
    let _ = writeln!(out, "{}: {}", space.title(), space.source());
    let width = space.names().iter().map(|name| name.name.len()).max().unwrap_or(0);
    for name in space.names() {
        let range = format!("{}..{}", name.min, name.max);
        let side = name.side.map_or("", |side| side.word());
        let _ = write!(out, "{:<width$}  {range:<8} {side:<5}  {}", name.name, name.means);
        let _ = match name.aliases.as_slice() {
            [] => writeln!(out),
            aliases => writeln!(out, " Also: {}.", aliases.join(", ")),
        };
    }
}

/// The names at some places.
fn listed(space: &Space, places: &[usize]) -> String {
    match places {
        [] => "none".to_owned(),
        places => {
            let name = |place: &usize| space.names().get(*place).map(|name| name.name.as_str());
            places.iter().filter_map(name).collect::<Vec<_>>().join(", ")
        }
    }
}

fn rules(out: &mut String, map: &Map) {
    let _ = writeln!(out, "{} to {}", map.from().key(), map.to().key());
    for rule in map.rules() {
        let _ = writeln!(out, "  {}", map.describe(rule));
    }
    let _ = writeln!(out, "not said in {}: {}", map.to().key(), listed(map.from(), map.unused()));
    let _ = writeln!(out, "not set in {}: {}", map.to().key(), listed(map.to(), map.unset()));
}

fn report(out: &mut String, loss: &Loss, from: &Space, to: &Space) {
    let [kept, changed, with_others, lost] = loss.counts();
    let _ = writeln!(out, "{} to {} and back: of {} names", from.key(), to.key(), from.len());
    let _ = writeln!(out, "  {kept} come back as they were");
    let _ = writeln!(out, "  {changed} come back changed");
    let _ = writeln!(out, "  {with_others} count only together with others");
    let _ = writeln!(out, "  {lost} are lost");
    for (name, fate) in from.names().iter().zip(&loss.fates) {
        let fate = match fate {
            Fate::Kept => continue,
            Fate::Changed(moved) => {
                let one = |(place, value): &(usize, f32)| format!("{} {value:.2}", listed(from, &[*place]));
                format!("comes back as {}", moved.iter().map(one).collect::<Vec<_>>().join(", "))
            }
            Fate::WithOthers => "counts only together with others".to_owned(),
            _ => "is lost".to_owned(),
        };
        let _ = writeln!(out, "{} {fate}", name.name);
    }
    for group in &loss.merged {
        let _ = writeln!(out, "merged: {}", listed(from, group));
    }
    let _ = writeln!(out, "never set in {}: {}", to.key(), listed(to, &loss.unset));
}
