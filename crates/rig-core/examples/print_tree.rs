//! Prints the tree of joints of a `Transformations.xml`, with world bind positions:
//! `cargo run -p rig-core --example print_tree -- FILE.xml` (without an argument: of a small built-in rig).
#![allow(clippy::disallowed_methods, reason = "an example is a program: it reads its arguments and a file")]

use rig_core::Rig;
use std::error::Error;

const SMALL: &str = r#"<JointSet>
  <Joint name="NeckJoint">
    <Matrix> 1 0 0 0   0 1 0 -14   0 0 1 -2   0 0 0 1 </Matrix>
    <Children>
      <Joint name="HeadJoint">
        <Matrix> 1 0 0 0   0 1 0 4   0 0 1 0   0 0 0 1 </Matrix>
        <Children>
          <Joint name="JawJoint"><Matrix> 1 0 0 0   0 1 0 7   0 0 1 0   0 0 0 1 </Matrix></Joint>
          <Joint name="LtEyeJoint"><Matrix> 1 0 0 3   0 1 0 10   0 0 1 3   0 0 0 1 </Matrix></Joint>
        </Children>
      </Joint>
    </Children>
  </Joint>
</JointSet>"#;

fn main() -> Result<(), Box<dyn Error>> {
    let bytes = match std::env::args().nth(1) {
        Some(path) => std::fs::read(path)?,
        None => SMALL.into(),
    };
    let rig = Rig::from_xml(&bytes)?;
    let mut depths = vec![0; rig.len()];
    // Parents come first, so a parent's depth is known when its children need it.
    for joint in rig.joints() {
        let index = joint.index();
        depths[index] = rig.parents()[index].map_or(0, |parent| depths[parent.index()] + 1);
        let [x, y, z] = rig.world_from_bind()[index].translation.to_array();
        println!("{:indent$}{} at {x} {y} {z}", "", rig.names()[index], indent = 2 * depths[index]);
    }
    Ok(())
}
