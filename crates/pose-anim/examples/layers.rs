//! What `Layers` is for: a face that breathes and blinks by itself, whatever the poses below do.
//!
//! Each layer is a player of its own with a mask and a weight. Breathing is added to the base, a blink takes
//! over the lids; the base never learns of either. Prints the head and a lid over three seconds.
//!
//!     cargo run -p pose-anim --example layers

use pose_anim::{Clip, ControlTable, Easing, Key, LayerMode, Layers, PoseSet, Track, Wrap, face};
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let controls = ControlTable::default_face();
    let poses = PoseSet::default_face(&controls);
    let index = |name: &str| controls.index(name).ok_or_else(|| format!("no control {name}"));
    let (bow, lid) = (index(face::HEAD_BOW)?, index(face::LID_LEFT_UPPER)?);

    let key = |time_secs, value| Key::new(time_secs, value, Easing::MinimumJerk);
    let breath = Clip::new("breath", vec![Track::new(bow, vec![key(0.0, 0.0), key(1.5, 2.0)])?])?;
    let shut = Track::new(lid, vec![key(0.0, 0.0), key(0.1, 45.0), key(0.25, 0.0), key(2.0, 0.0)])?;
    let blink = Clip::new("blink", vec![shut])?;

    let mut layers = Layers::new(&controls);
    let everywhere = vec![1.0; controls.len()];
    let mut lids_only = vec![0.0; controls.len()];
    lids_only[lid] = 1.0;
    for (clip, wrap, mode, mask) in [
        (breath, Wrap::PingPong, LayerMode::Additive, &everywhere),
        (blink, Wrap::Loop, LayerMode::Override, &lids_only),
    ] {
        let layer = layers.add(&controls, mode, mask);
        layers.layer(layer).ok_or("no such layer")?.play(&Arc::new(clip.wrapped(wrap)), None);
        layers.fade_to(layer, 1.0, 0.3);
    }

    layers.base().press(poses.get("smile").ok_or("no such pose")?);
    println!("{:>6} {:>9} {:>9}", "s", face::HEAD_BOW, face::LID_LEFT_UPPER);
    for step in 0..=30 {
        println!("{:6.1} {:9.3} {:9.3}", 0.1 * f64::from(step), layers.values()[bow], layers.values()[lid]);
        layers.advance(0.1)?;
    }
    Ok(())
}
