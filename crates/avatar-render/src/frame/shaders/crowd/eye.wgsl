@vertex
fn crowd_eye_main(in: CrowdIn) -> EyeOut {
    let rows = crowd_bones[drawn[chunk.first_avatar + in.instance] * chunk.bone_count + chunk.rigid_bone];
    return eye_out(of_one(in), BoneIn(rows[0], rows[1], rows[2]));
}
