//! Nanoseconds for a skeleton of nine joints, from local transforms to skinning matrices, on one core:
//! ozz-animation-rs, and the same written with glam. The face is that of rig-core's bench `crowd`.
//!
//! `peer-ozz [FACES]`: 1,024 where no number is given. Prints a line for each, the least and the median of
//! rounds in turns.
use glam::{Affine3A, Mat4, Quat, Vec3};
use glam_of_ozz::{Mat4 as OzzMat4, Quat as OzzQuat, Vec3 as OzzVec3};
use ozz_animation_rs::{Archive, LocalToModelJobRef, Skeleton, SoaTransform};
use std::hint::black_box;
use std::time::Instant;

const JOINTS: usize = 9;
const ROUNDS: usize = 21;
/// Faces of one round, together: long enough for the clock.
const FACES_OF_ROUND: usize = 200_000;
/// Both are the same numbers up to the rounding of sums and products.
const TOLERANCE: f32 = 1e-4;

fn main() {
    let faces = std::env::args().nth(1).map_or(1024, |arg| arg.parse().expect("a number of faces"));
    let locals: Vec<[Local; JOINTS]> =
        (0..faces).map(|face| std::array::from_fn(|j| local(face, j))).collect();
    let rest: [Local; JOINTS] = std::array::from_fn(|j| Local { turn: bind(j).turn, at: bind(j).at });
    let mut worlds = [Affine3A::IDENTITY; JOINTS];
    models(&rest, &mut worlds);
    let joint_from_bind = worlds.map(|world| world.inverse());

    let mut by_glam = vec![Affine3A::IDENTITY; faces * JOINTS];
    let mut with_glam = || {
        for (face, out) in black_box(&locals).iter().zip(by_glam.chunks_exact_mut(JOINTS)) {
            let mut worlds = [Affine3A::IDENTITY; JOINTS];
            models(face, &mut worlds);
            for ((out, world), inverse) in out.iter_mut().zip(worlds).zip(&joint_from_bind) {
                *out = world * *inverse;
            }
        }
        black_box(&by_glam);
    };

    let skeleton = skeleton();
    let inputs: Vec<Vec<SoaTransform>> = locals.iter().map(|face| packed(face)).collect();
    let inverses =
        joint_from_bind.map(|inverse| OzzMat4::from_cols_array(&Mat4::from(inverse).to_cols_array()));
    let mut by_ozz = vec![OzzMat4::IDENTITY; faces * JOINTS];
    let mut worlds = vec![OzzMat4::IDENTITY; JOINTS];
    let mut with_ozz = || {
        for (face, out) in black_box(&inputs).iter().zip(by_ozz.chunks_exact_mut(JOINTS)) {
            let mut job = LocalToModelJobRef::default();
            job.set_skeleton(&skeleton);
            job.set_input(face.as_slice());
            job.set_output(worlds.as_mut_slice());
            job.run().expect("matrices");
            for ((out, world), inverse) in out.iter_mut().zip(&worlds).zip(&inverses) {
                *out = *world * *inverse;
            }
        }
        black_box(&by_ozz);
    };

    let repeats = FACES_OF_ROUND.div_ceil(faces.max(1));
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        times[0].push(nanos(&mut with_ozz, repeats, faces));
        times[1].push(nanos(&mut with_glam, repeats, faces));
    }
    let farthest = by_ozz.iter().zip(&by_glam).map(|(ozz, glam)| {
        let (ozz, glam) = (ozz.to_cols_array(), Mat4::from(*glam).to_cols_array());
        ozz.iter().zip(glam).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
    });
    let farthest = farthest.fold(0.0, f32::max);
    assert!(farthest < TOLERANCE, "ozz-animation-rs and glam differ by {farthest}");
    for (name, times) in ["ozz-animation-rs 0.11.0", "glam 0.34"].into_iter().zip(&mut times) {
        times.sort_by(f64::total_cmp);
        println!("{name}: {faces} faces, ns a face: least {:.1}, median {:.1}", times[0], times[ROUNDS / 2]);
    }
}

/// A turn and a place.
#[derive(Clone, Copy)]
struct Local {
    turn: Quat,
    at: Vec3,
}

/// Where a joint rests in its parent.
fn bind(joint: usize) -> Local {
    let angle = joint as f32 * 0.7;
    let axis = Vec3::new(angle.sin(), angle.cos(), 0.5).normalize();
    Local { turn: Quat::from_axis_angle(axis, angle), at: Vec3::new(0.1, 1.0, angle.sin()) }
}

fn local(face: usize, joint: usize) -> Local {
    let turn = Quat::from_rotation_x((face as f32 * 0.37).sin() * 0.4 * (1.0 + 0.1 * joint as f32));
    Local { turn: (bind(joint).turn * turn).normalize(), at: bind(joint).at }
}

/// Neck, head, and seven children of the head.
fn parent(joint: usize) -> Option<usize> {
    joint.checked_sub(1).map(|before| before.min(1))
}

fn models(locals: &[Local; JOINTS], worlds: &mut [Affine3A; JOINTS]) {
    for (joint, local) in locals.iter().enumerate() {
        let local = Affine3A::from_rotation_translation(local.turn, local.at);
        worlds[joint] = parent(joint).map_or(local, |parent| worlds[parent] * local);
    }
}

/// As ozz takes them: four joints in each.
fn packed(face: &[Local; JOINTS]) -> Vec<SoaTransform> {
    let mut packed = vec![SoaTransform::IDENTITY; JOINTS.div_ceil(4)];
    for (joint, local) in face.iter().enumerate() {
        let of_four = &mut packed[joint / 4];
        of_four.translation.set_vec3(joint % 4, OzzVec3::from_array(local.at.to_array()));
        of_four.rotation.set_quat(joint % 4, OzzQuat::from_array(local.turn.to_array()));
    }
    packed
}

/// Skeletons can only be read, so this writes one in the format that is read: byte order, tag, version,
/// number of joints, length of all names, names, parents, transforms at rest.
fn skeleton() -> Skeleton {
    let names: Vec<String> = (0..JOINTS).map(|joint| format!("{joint}\0")).collect();
    let mut file = vec![1u8];
    file.extend(b"ozz-skeleton\0");
    file.extend(Skeleton::version().to_le_bytes());
    file.extend((JOINTS as u32).to_le_bytes());
    file.extend((names.iter().map(String::len).sum::<usize>() as u32).to_le_bytes());
    names.iter().for_each(|name| file.extend(name.as_bytes()));
    for joint in 0..JOINTS {
        file.extend(parent(joint).map_or(-1i16, |parent| parent as i16).to_le_bytes());
    }
    // Nothing here starts from rest: three places, four parts of a turn and three sizes, of four joints each.
    let columns = [0.0f32, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    for number in (0..JOINTS.div_ceil(4)).flat_map(|_| columns).flat_map(|number| [number; 4]) {
        file.extend(number.to_le_bytes());
    }
    let mut archive = Archive::new(file.as_slice()).expect("the byte order");
    Skeleton::from_archive(&mut archive).expect("a skeleton")
}

fn nanos(work: &mut impl FnMut(), repeats: usize, faces: usize) -> f64 {
    let start = Instant::now();
    (0..repeats).for_each(|_| work());
    start.elapsed().as_secs_f64() * 1e9 / (repeats * faces) as f64
}
