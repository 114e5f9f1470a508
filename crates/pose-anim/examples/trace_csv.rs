//! Prints the value, velocity and acceleration of the smile through an interruption, as CSV.
//!
//! `cargo run -p pose-anim --example trace_csv`

use pose_anim::{ControlTable, Player, PoseSet};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let controls = ControlTable::default_face();
    let poses = PoseSet::default_face(&controls);
    let smile = controls.index("smile").ok_or("no such control")?;
    let mut player = Player::new(&controls);
    player.press(poses.get("laugh").ok_or("no such pose")?);

    println!("t,smile,smile',smile''");
    for tick in 0..=60 {
        if tick == 20 {
            player.press(poses.get("neutral").ok_or("no such pose")?);
        }
        let state = player.state(smile).ok_or("no such control")?;
        println!("{},{},{},{}", f64::from(tick) / 100.0, state.value, state.velocity, state.acceleration);
        player.advance(0.01)?;
    }
    Ok(())
}
