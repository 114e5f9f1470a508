//! What `JointPlayer` is for: rigs that are posed by whole joints rather than by controls, such as a body's
//! neck or a prop.
//!
//! A neck turns left, and is called back before it is there: its rotation, angular velocity and angular
//! acceleration go on without a jump. Prints the angle and its rate.
//!
//!     cargo run -p pose-anim --example joint_player

use glam::{Mat4, Quat, Vec3};
use pose_anim::{JointPlayer, JointTarget};
use rig_core::{RawJoint, RawRig, Rig};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let rig = Rig::from_raw(&RawRig { joints: vec![RawJoint::new("neck", None, Mat4::IDENTITY)] })?;
    let neck = rig.joint("neck").ok_or("no neck")?;
    let (mut locals, mut pose) = (rig.locals(), rig.pose());

    let turned = |degrees: f32| JointTarget {
        rotation: Quat::from_rotation_y(degrees.to_radians()),
        translation: Vec3::ZERO,
    };
    let mut player = JointPlayer::new(turned(0.0));
    player.press(turned(60.0), 0.8);
    println!("{:>5} {:>9} {:>9}", "s", "degrees", "per s");
    for step in 0..=30 {
        if step == 8 {
            player.press(turned(-20.0), 1.2);
        }
        player.apply(neck, &mut locals)?;
        rig.update(locals.as_slice(), &mut pose)?;
        let ahead = pose.posed_from_bind()[neck.index()].transform_vector3(Vec3::Z);
        let (rate, _) = player.angular_rates();
        let degrees = ahead.x.atan2(ahead.z).to_degrees();
        println!("{:5.2} {degrees:9.3} {:9.2}", 0.05 * f64::from(step), rate.y.to_degrees());
        player.advance(0.05)?;
    }
    Ok(())
}
