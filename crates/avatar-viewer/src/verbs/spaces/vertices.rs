//! How far a way between spaces moves the vertices of a face, over a recording.

use crate::cli::PackArg;
use crate::reading;
use anyhow::{Result, anyhow, bail};
use avatar_pack::{FaceState, Pack};
use face_space::{Solver, Space, Standard, VertexError};
use pose_anim::{ControlTable, Recording};
use std::fmt::Write;
use std::path::Path;

/// Vertices that the recording moves by less than this, in millimetres, do not count in means: they are the
/// back of the head, the neck and the bust.
const MOVED_MM: f32 = 0.1;
/// Packs in the raw format are in centimetres, glTF and VRM in metres; of other files it is not known.
const RAW_MM: f32 = 10.0;
const METRE_MM: f32 = 1000.0;

type Places = Vec<[f32; 3]>;

pub(super) fn report(pack: &PackArg, path: &Path, from: Standard, to: Standard) -> Result<String> {
    let files = super::super::open(pack)?;
    let pack = files.load_pack()?;
    let (unit, scale) = match files.report() {
        None => ("mm", RAW_MM),
        Some(_) => ("mm (of a file in metres)", METRE_MM),
    };
    let mut face = Face::new(&pack, scale)?;
    let rest = face.places(&Standard::ArKit.space().rest())?;
    let mut lead = super::route(Standard::ArKit, from)?;
    let mut home = super::route(from, Standard::ArKit)?;
    let (mut there, mut back) = (super::route(from, to)?, super::route(to, from)?);
    let (mut first, mut second) = (from.space().rest(), to.space().rest());
    let mut arkit = Standard::ArKit.space().rest();
    let mut frames = Vec::new();
    for values in recorded(path)? {
        lead.apply(&values, &mut first);
        home.apply(&first, &mut arkit);
        frames.push((first.clone(), face.places(&arkit)?));
    }
    let is_moved =
        |at: usize| frames.iter().any(|(_, places)| distance(places.get(at), rest.get(at)) >= MOVED_MM);
    let moved: Vec<usize> = (0..rest.len()).filter(|at| is_moved(*at)).collect();
    let pick =
        |places: &Places| -> Places { moved.iter().filter_map(|at| places.get(*at).copied()).collect() };
    let rest = pick(&rest);
    let frames: Vec<_> = frames.iter().map(|(values, places)| (values, pick(places))).collect();

    // What each value of the other space does to the face, for the best that its words allow.
    let mut show = |said: &[f32], first: &mut [f32]| -> Result<Places> {
        back.apply(said, first);
        home.apply(first, &mut arkit);
        Ok(pick(&face.places(&arkit)?))
    };
    let fields = fields(to.space(), &rest, |said| show(said, &mut first))?;
    let slices: Vec<&[[f32; 3]]> = fields.iter().map(Vec::as_slice).collect();
    // In shares of what each field is made with.
    let ranges: Vec<_> =
        to.space().names().iter().map(|name| shares(name.min, name.max, name.rest)).collect();
    let mut solver = Solver::new(&slices, &ranges)?;

    let [mut moves, mut mapped, mut solved] = [VertexError::default(); 3];
    let mut best = to.space().rest();
    for (values, places) in &frames {
        moves.add(&rest, places);
        there.apply(values, &mut second);
        let by_map = show(&second, &mut first)?;
        mapped.add(&by_map, places);
        solver.solve(&difference(places, &rest), &mut best)?;
        for (value, name) in best.iter_mut().zip(to.space().names()) {
            *value = name.rest + *value * reach(name.min, name.max, name.rest);
        }
        // Joints turn on arcs, which sums of fields do not: where that matters more, the map is better.
        let by_fields = show(&best, &mut first)?;
        let is_better = squares(&by_fields, places) < squares(&by_map, places);
        solved.add(if is_better { &by_fields } else { &by_map }, places);
    }
    let mut out = String::new();
    let (count, vertices) = (frames.len(), moved.len());
    let _ = writeln!(out, "over {count} frames, {vertices} vertices that they move, in {unit}:");
    for (what, error) in [
        ("they are away from rest", moves),
        ("there and back, they are wrong", mapped),
        ("by least squares, if that is better", solved),
    ] {
        let _ = writeln!(out, "  {what:<36} mean {:.3}, largest {:.2}", error.mean(), error.max());
    }
    Ok(out)
}

/// The furthest that a value can be from rest.
fn reach(min: f32, max: f32, rest: f32) -> f32 {
    if max - rest >= rest - min { max - rest } else { min - rest }
}

fn shares(min: f32, max: f32, rest: f32) -> [f32; 2] {
    let reach = reach(min, max, rest);
    let ends = [(min - rest) / reach, (max - rest) / reach];
    [ends[0].min(ends[1]), ends[0].max(ends[1])]
}

fn fields(
    space: &Space,
    rest: &Places,
    mut show: impl FnMut(&[f32]) -> Result<Places>,
) -> Result<Vec<Places>> {
    let mut said = space.rest();
    let mut fields = Vec::new();
    for (at, name) in space.names().iter().enumerate() {
        said[at] = name.rest + reach(name.min, name.max, name.rest);
        fields.push(difference(&show(&said)?, rest));
        said[at] = name.rest;
    }
    Ok(fields)
}

fn difference(a: &Places, b: &Places) -> Places {
    a.iter().zip(b).map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]).collect()
}

/// The sum of the squares of all distances.
fn squares(a: &Places, b: &Places) -> f64 {
    difference(a, b).iter().flatten().map(|along| f64::from(*along).powi(2)).sum()
}

fn distance(a: Option<&[f32; 3]>, b: Option<&[f32; 3]>) -> f32 {
    let squares = |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>();
    a.zip(b).map(squares).unwrap_or(0.0).sqrt()
}

/// ARKit's values in each row of a recording.
fn recorded(path: &Path) -> Result<Vec<Vec<f32>>> {
    let Some(text) = reading::text(path)? else {
        bail!("{}: expected a recording of a face, found nothing of that name", path.display())
    };
    let space = Standard::ArKit.space();
    let one = |name: &face_space::Name| format!("[[control]]\nname = {0:?}\nshape = {0:?}\n", name.name);
    let table = ControlTable::from_toml(&space.names().iter().map(one).collect::<String>())?;
    let recording = Recording::from_csv("recording", &text, &table);
    let clip = recording.map_err(|error| anyhow!("{}: {error}", path.display()))?.clip;
    let times = clip.tracks().first().map(|track| track.keys().iter().map(|key| key.time_secs));
    let row = |time: f64| {
        let mut values = space.rest();
        clip.sample(time, &mut values);
        values
    };
    Ok(times.into_iter().flatten().map(row).collect())
}

/// A face that ARKit's names move.
struct Face<'a> {
    pack: &'a Pack,
    state: FaceState,
    /// For each of ARKit's names the control.
    controls: Vec<usize>,
    scale: f32,
}

impl<'a> Face<'a> {
    fn new(pack: &'a Pack, scale: f32) -> Result<Self> {
        let control = |name: &face_space::Name| {
            let found = pack.controls().index(&name.name);
            found.ok_or_else(|| {
                anyhow!("expected a face with all of ARKit's shapes, found none named {:?}", name.name)
            })
        };
        let controls = Standard::ArKit.space().names().iter().map(control).collect::<Result<_>>()?;
        Ok(Self { pack, state: FaceState::new(pack), controls, scale })
    }

    /// Where the vertices of all parts are.
    fn places(&mut self, values: &[f32]) -> Result<Places> {
        let mut all = self.pack.controls().defaults();
        for (control, value) in self.controls.iter().zip(values) {
            all[*control] = *value;
        }
        self.state.pose(self.pack, &all)?;
        let mut places = Vec::new();
        for part in 0..self.pack.parts().len() {
            let deformed = self.state.deform(self.pack, part)?;
            places.extend(deformed.positions.iter().map(|place| (*place * self.scale).to_array()));
        }
        Ok(places)
    }
}
