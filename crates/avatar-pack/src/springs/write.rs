use super::Springs;
use joint_springs::{Collider, Law, Shape};
use placed_toml::string;
use std::fmt::{Arguments, Write};

impl Springs {
    /// Writes a `springs.toml`, which [`Springs::from_toml`] reads as the same for a rig with these names of
    /// joints. Each joint that swings is a chain of its own. Joints that turn with others have no place in
    /// the file.
    pub fn to_toml(&self, names: &[String]) -> String {
        let name = |joint: usize| string(names.get(joint).map_or("", String::as_str));
        let mut out = String::from("# What swings by itself.\n");
        for (place, Collider { joint, shape }) in self.colliders.iter().enumerate() {
            line(&mut out, format_args!("\n[[collider]]\nname = \"{place}\"\njoint = {}", name(*joint)));
            let form = match shape {
                Shape::Sphere { offset, radius, .. } => {
                    format!("sphere = {{ offset = {:?}, radius = {radius:?} }}", offset.to_array())
                }
                Shape::Capsule { offset, tail, radius, .. } => {
                    let [offset, tail] = [offset, tail].map(|point| point.to_array());
                    format!("capsule = {{ offset = {offset:?}, tail = {tail:?}, radius = {radius:?} }}")
                }
                Shape::Plane { offset, normal } => {
                    format!(
                        "plane = {{ offset = {:?}, normal = {:?} }}",
                        offset.to_array(),
                        normal.to_array()
                    )
                }
            };
            line(&mut out, format_args!("{form}"));
            if let Shape::Sphere { inside: true, .. } | Shape::Capsule { inside: true, .. } = shape {
                line(&mut out, format_args!("inside = true"));
            }
        }
        for spring in &self.springs {
            let tail = spring.tail.to_array();
            line(&mut out, format_args!("\n[[chain]]\njoints = [{}]\ntail = {tail:?}", name(spring.joint)));
            let gravity = match spring.law {
                Law::Oscillator { frequency_hz, damping_ratio, gravity } => {
                    line(&mut out, format_args!("frequency = {frequency_hz:?}\ndamping = {damping_ratio:?}"));
                    gravity
                }
                Law::Vrm { stiffness, drag, gravity } => {
                    line(&mut out, format_args!("stiffness = {stiffness:?}\ndrag = {drag:?}"));
                    gravity
                }
            };
            let [gravity, radius] = [format!("{:?}", gravity.to_array()), format!("{:?}", spring.hit_radius)];
            line(&mut out, format_args!("gravity = {gravity}\nradius = {radius}"));
            if !spring.colliders.is_empty() {
                let list: Vec<String> = spring.colliders.iter().map(|place| format!("\"{place}\"")).collect();
                line(&mut out, format_args!("colliders = [{}]", list.join(", ")));
            }
            if let Some(center) = spring.center {
                line(&mut out, format_args!("center = {}", name(center)));
            }
        }
        out
    }
}

fn line(out: &mut String, text: Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{text}");
}
