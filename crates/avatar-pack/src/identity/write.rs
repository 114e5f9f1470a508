use super::{Axis, EyeChange, Identity, LocalMap};
use placed_toml::string;
use std::fmt::Write;

impl Identity {
    /// Writes an `identity.toml`, which [`Identity::from_toml`] reads as the same.
    pub fn to_toml(&self) -> String {
        let mut out = String::from("# Axes that make other people of this face.\n");
        if let Some(eyes) = &self.eyes {
            let (full, apart, reach) = (eyes.full, eyes.apart, eyes.reach);
            line(&mut out, format_args!("\n[eyes]\nfull = {full:?}\napart = {apart:?}\nreach = {reach:?}"));
        }
        for axis in &self.axes {
            self.axis(&mut out, axis);
        }
        out
    }

    fn axis(&self, out: &mut String, axis: &Axis) {
        let [name, less, more] = [&axis.name, &axis.less, &axis.more].map(|text| string(text));
        line(out, format_args!("\n[[axis]]\nname = {name}\nless = {less}\nmore = {more}"));
        line(out, format_args!("spread = {:?}", axis.spread));
        for (key, shares) in [("with", &axis.with), ("of", &axis.of)] {
            let named = |(place, share): &(usize, f32)| {
                let name = self.axes.get(*place).map_or("", |axis| axis.name.as_str());
                format!("{} = {share:?}", string(name))
            };
            if !shares.is_empty() {
                let list: Vec<String> = shares.iter().map(named).collect();
                line(out, format_args!("{key} = {{ {} }}", list.join(", ")));
            }
        }
        if axis.eye != EyeChange::default() {
            let EyeChange { size, tilt, shift } = axis.eye;
            line(out, format_args!("eye = {{ size = {size:?}, tilt = {tilt:?}, move = {shift:?} }}"));
        }
        for LocalMap { center, radii, full, scale, turn, shift } in &axis.maps {
            line(
                out,
                format_args!("\n[[axis.map]]\ncenter = {center:?}\nradii = {radii:?}\nfull = {full:?}"),
            );
            line(out, format_args!("scale = {scale:?}\nturn = {turn:?}\nmove = {shift:?}"));
        }
    }
}

fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{text}");
}
