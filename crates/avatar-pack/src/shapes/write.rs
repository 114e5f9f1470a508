use super::{FurtherShapes, ShapeWeight, Side};
use avatar_mesh::FACE_PARTS;
use placed_toml::string;
use std::fmt::Write;

impl FurtherShapes {
    /// Writes a `shapes.toml`, which [`FurtherShapes::from_toml`] reads as the same.
    pub fn to_toml(&self) -> String {
        let mut out = String::from(
            "# Shapes beside the two of the raw format, in the order of shapes.raw, and mixtures of controls.\n",
        );
        for shape in &self.shapes {
            head(&mut out, "shape", &shape.name, shape.group.as_deref(), shape.side);
            if shape.parts != [FACE_PARTS[0].name] {
                line(&mut out, format_args!("parts = [{}]", list(&shape.parts)));
            }
            match &shape.weight {
                ShapeWeight::Control => {}
                ShapeWeight::Follows { input, at } => {
                    line(&mut out, format_args!("follows = {}\nat = {at:?}", string(input)));
                }
                ShapeWeight::Product(inputs) => line(&mut out, format_args!("product = [{}]", list(inputs))),
            }
        }
        for mixture in &self.mixtures {
            head(&mut out, "mixture", &mixture.name, mixture.group.as_deref(), mixture.side);
            let of: Vec<_> =
                mixture.of.iter().map(|(name, way)| format!("{} = {way:?}", string(name))).collect();
            line(&mut out, format_args!("of = {{ {} }}", of.join(", ")));
        }
        for place in &self.wrinkles {
            let of: Vec<_> =
                place.of.iter().map(|(name, gain)| format!("{} = {gain:?}", string(name))).collect();
            let (center, radius, of) = (place.center, place.radius, of.join(", "));
            line(
                &mut out,
                format_args!("\n[[wrinkle]]\ncenter = {center:?}\nradius = {radius:?}\nof = {{ {of} }}"),
            );
        }
        out
    }
}

fn head(out: &mut String, table: &str, name: &str, group: Option<&str>, side: Option<Side>) {
    line(out, format_args!("\n[[{table}]]\nname = {}", string(name)));
    if let Some(group) = group {
        line(out, format_args!("group = {}", string(group)));
    }
    if let Some(side) = side {
        line(out, format_args!("side = {}", string(side.name())));
    }
}

fn list(names: &[String]) -> String {
    names.iter().map(|name| string(name)).collect::<Vec<_>>().join(", ")
}

fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{text}");
}
