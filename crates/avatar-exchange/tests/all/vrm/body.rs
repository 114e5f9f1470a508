//! What moves by itself: springs, constraints; and what the character sees of itself.

use super::{read, scene};
use avatar_exchange::vrm::{
    ColliderShape, ConstraintKind, FirstPersonView, NodeConstraint, SpringChain, SpringJoint, VrmModel,
};
use glam::Vec3;
use serde_json::{Value, json};

/// Nodes: hips, head, eyes, two faces, and a braid of three with a side branch.
fn with_braid(mut json: Value) -> Value {
    let nodes = json["nodes"].as_array_mut().expect("nodes");
    nodes[1]["children"] = json!([2, 3, 6]);
    nodes.extend([
        json!({ "name": "Braid", "children": [7, 9] }),
        json!({ "name": "Braid 2", "children": [8] }),
        json!({ "name": "Braid 3" }),
        json!({ "name": "Bow" }),
    ]);
    json
}

pub(super) fn v1() -> Value {
    let constraint = |constraint: Value| json!({ "VRMC_node_constraint": { "specVersion": "1.0", "constraint": constraint } });
    let mut json = with_braid(scene(json!({
        "VRMC_vrm": {
            "specVersion": "1.0",
            "meta": { "name": "Nina", "authors": ["A"], "licenseUrl": "https://vrm.dev/licenses/1.0/",
                      "commercialUsage": "personalNonProfit", "allowRedistribution": false,
                      "references": ["x", "y"], "thumbnailImage": 0 },
            "humanoid": { "humanBones": { "hips": { "node": 0 }, "head": { "node": 1 } } },
            "firstPerson": { "meshAnnotations": [
                { "node": 4, "type": "thirdPersonOnly" }, { "node": 5, "type": "both" }
            ] }
        },
        "VRMC_springBone": {
            "specVersion": "1.0",
            "colliders": [
                { "node": 1, "shape": { "sphere": { "offset": [0.0, 0.1, 0.0], "radius": 0.125 } } },
                { "node": 0, "shape": { "capsule": { "offset": [1.0, 0.0, 0.0], "radius": 0.5, "tail": [0.0, 2.0, 0.0] } } }
            ],
            "colliderGroups": [{ "name": "head", "colliders": [0] }, { "colliders": [1, 0] }],
            "springs": [{
                "name": "braid",
                "joints": [
                    { "node": 6, "hitRadius": 0.25, "stiffness": 0.5, "gravityPower": 1.5,
                      "gravityDir": [0.0, -1.0, 0.5], "dragForce": 0.75 },
                    { "node": 8 }
                ],
                "colliderGroups": [1],
                "center": 1
            }, { "joints": [{ "node": 9 }] }]
        }
    })));
    let nodes = &mut json["nodes"];
    nodes[7]["extensions"] = constraint(json!({ "roll": { "source": 1, "rollAxis": "Z", "weight": 0.5 } }));
    nodes[8]["extensions"] = constraint(json!({ "aim": { "source": 2, "aimAxis": "NegativeX" } }));
    nodes[9]["extensions"] = constraint(json!({ "rotation": { "source": 8, "weight": 0.25 } }));
    json
}

pub(super) fn v0() -> Value {
    with_braid(scene(json!({ "VRM": {
        "specVersion": "0.0",
        "meta": { "title": "Nina", "author": "A", "commercialUssageName": "Disallow", "contactInformation": "n@x" },
        "humanoid": { "humanBones": [{ "bone": "hips", "node": 0 }, { "bone": "head", "node": 1 }] },
        "firstPerson": {
            "firstPersonBone": 1,
            "firstPersonBoneOffset": { "x": 0.5, "y": 0.06, "z": 0.04 },
            "meshAnnotations": [{ "mesh": 0, "firstPersonFlag": "ThirdPersonOnly" }]
        },
        "secondaryAnimation": {
            "boneGroups": [{
                "comment": "braid",
                "stiffiness": 2.0, "gravityPower": 0.5, "gravityDir": { "x": 0.25, "y": -1.0, "z": 0.5 },
                "dragForce": 0.125, "center": -1, "hitRadius": 0.02,
                "bones": [6], "colliderGroups": [0]
            }, { "comment": "again", "bones": [7], "colliderGroups": [] }],
            "colliderGroups": [{ "node": 1, "colliders": [
                { "offset": { "x": 0.1, "y": 0.2, "z": 0.3 }, "radius": 0.5 }, { "radius": 0.25 }
            ] }]
        }
    } })))
}

fn notes(model: &VrmModel) -> Vec<String> {
    model.scene.notes.iter().map(ToString::to_string).collect()
}

#[test]
fn springs_of_version_1_are_read() {
    let model = read(&v1()).expect("a VRM");
    let springs = &model.vrm.springs;
    let shapes: Vec<_> = springs.colliders.iter().map(|collider| (collider.node, collider.shape)).collect();
    let sphere = ColliderShape::Sphere { offset: Vec3::new(0.0, 0.1, 0.0), radius: 0.125, inside: false };
    let capsule = ColliderShape::Capsule { offset: Vec3::X, tail: Vec3::Y * 2.0, radius: 0.5, inside: false };
    assert_eq!(shapes, [(1, sphere), (0, capsule)]);
    let groups = springs.collider_groups.iter();
    let groups: Vec<_> = groups.map(|group| (group.name.as_str(), group.colliders.as_slice())).collect();
    assert_eq!(groups, [("head", &[0][..]), ("", &[1, 0])]);
    let joint = SpringJoint {
        node: 6,
        hit_radius: 0.25,
        stiffness: 0.5,
        gravity_power: 1.5,
        gravity_dir: Vec3::new(0.0, -1.0, 0.5),
        drag_force: 0.75,
    };
    // What a joint does not say is as in the standard.
    let end = SpringJoint {
        node: 8,
        hit_radius: 0.0,
        stiffness: 1.0,
        gravity_power: 0.0,
        gravity_dir: Vec3::NEG_Y,
        drag_force: 0.5,
    };
    let braid = SpringChain {
        name: "braid".to_owned(),
        joints: vec![joint, end],
        collider_groups: vec![1],
        center: Some(1),
        tail: None,
    };
    assert_eq!(springs.chains.len(), 2);
    assert_eq!(springs.chains[0], braid);
    assert_eq!(springs.chains[1].joints, [SpringJoint { node: 9, ..end }]);
    let notes = notes(&model);
    assert!(!notes.iter().any(|note| note.contains("VRMC_")), "{notes:?}");
}

#[test]
fn springs_of_version_0_become_chains_along_first_children() {
    let model = read(&v0()).expect("a VRM");
    let springs = &model.vrm.springs;
    // Forward is +z there and -z in the file's nodes.
    let sphere = |offset, radius| ColliderShape::Sphere { offset, radius, inside: false };
    assert_eq!(
        springs.colliders.iter().map(|collider| (collider.node, collider.shape)).collect::<Vec<_>>(),
        [(1, sphere(Vec3::new(0.1, 0.2, -0.3), 0.5)), (1, sphere(Vec3::ZERO, 0.25))]
    );
    assert_eq!(springs.collider_groups[0].colliders, [0, 1]);
    let nodes = |chain: &SpringChain| chain.joints.iter().map(|joint| joint.node).collect::<Vec<_>>();
    assert_eq!(springs.chains.iter().map(nodes).collect::<Vec<_>>(), [vec![6, 7, 8], vec![9]]);
    for chain in &springs.chains {
        assert_eq!((chain.name.as_str(), chain.tail, chain.center), ("braid", Some(0.07), None));
        assert_eq!(chain.collider_groups, [0]);
        for joint in &chain.joints {
            let SpringJoint { node: _, hit_radius, stiffness, gravity_power, gravity_dir, drag_force } =
                *joint;
            assert_eq!((hit_radius, stiffness, gravity_power, drag_force), (0.02, 2.0, 0.5, 0.125));
            // World space, in which the scene is turned around: the file's right is -x, its front +z.
            assert_eq!(gravity_dir, Vec3::new(-0.25, -1.0, 0.5));
        }
    }
    let notes = notes(&model);
    let again = "extensions.VRM.secondaryAnimation.boneGroups[1]: 1 of its bones are in another spring already, and left out";
    assert!(notes.iter().any(|note| note == again), "{notes:?}");
}

/// A root above another one that came first: its chain ends where the other begins.
#[test]
fn no_node_of_version_0_is_in_two_chains() {
    let mut json = v0();
    let groups = "/extensions/VRM/secondaryAnimation/boneGroups";
    set(&mut json, &format!("{groups}/0/bones"), json!([7]));
    set(&mut json, &format!("{groups}/1/bones"), json!([6]));
    let model = read(&json).expect("a VRM");
    let nodes = |chain: &SpringChain| chain.joints.iter().map(|joint| joint.node).collect::<Vec<_>>();
    let chains: Vec<_> = model.vrm.springs.chains.iter().map(nodes).collect();
    assert_eq!(chains, [vec![7, 8], vec![6], vec![9]]);
    let place = "extensions.VRM.secondaryAnimation.boneGroups[1]";
    let again = format!("{place}: 1 of its bones are in another spring already, and left out");
    assert!(notes(&model).contains(&again), "{:?}", notes(&model));
}

/// A file may require what it uses: it is read here.
#[test]
fn extensions_of_the_format_may_be_required() {
    let mut json = v1();
    json["extensionsRequired"] = json!(["VRMC_vrm", "VRMC_springBone", "VRMC_node_constraint"]);
    assert_eq!(read(&json).expect("a VRM"), read(&v1()).expect("a VRM"));
    let mut json = v0();
    json["extensionsRequired"] = json!(["VRM"]);
    assert_eq!(read(&json).expect("a VRM"), read(&v0()).expect("a VRM"));
}

#[test]
fn constraints_are_read() {
    let model = read(&v1()).expect("a VRM");
    let constraint = |node, source, weight, kind| NodeConstraint { node, source, weight, kind };
    assert_eq!(
        model.vrm.constraints,
        [
            constraint(7, 1, 0.5, ConstraintKind::Roll { axis: Vec3::Z }),
            constraint(8, 2, 1.0, ConstraintKind::Aim { axis: Vec3::NEG_X }),
            constraint(9, 8, 0.25, ConstraintKind::Rotation),
        ]
    );
}

#[test]
fn constraints_in_a_circle_lose_one_of_it() {
    let mut json = v1();
    let source = |json: &mut Value, node: usize, kind: &str, source: usize| {
        json["nodes"][node]["extensions"]["VRMC_node_constraint"]["constraint"][kind]["source"] =
            json!(source);
    };
    source(&mut json, 7, "roll", 9);
    source(&mut json, 8, "aim", 7);
    let model = read(&json).expect("a VRM");
    // 7 follows 9, 9 follows 8, and 8 would follow 7.
    let nodes: Vec<usize> = model.vrm.constraints.iter().map(|constraint| constraint.node).collect();
    assert_eq!(nodes, [7, 9]);
    let text =
        "node 8, VRMC_node_constraint: follows itself, perhaps by way of others: the constraint is left out";
    assert!(notes(&model).iter().any(|note| note == text), "{:?}", notes(&model));
    source(&mut json, 8, "aim", 8);
    let model = read(&json).expect("a VRM");
    let nodes: Vec<usize> = model.vrm.constraints.iter().map(|constraint| constraint.node).collect();
    assert_eq!(nodes, [7, 9]);
}

#[test]
fn the_characters_own_view_and_terms_of_use_are_read() {
    let vrm = read(&v1()).expect("a VRM").vrm;
    let views = [4, 5, 2].map(|node| vrm.first_person.view(node));
    assert_eq!(views, [FirstPersonView::ThirdPersonOnly, FirstPersonView::Both, FirstPersonView::Auto]);
    assert_eq!((vrm.first_person.node, vrm.first_person.offset), (None, None));
    let terms: Vec<String> = vrm.meta.terms.iter().map(|(key, text)| format!("{key}={text}")).collect();
    assert_eq!(terms, ["commercialUsage=personalNonProfit", "allowRedistribution=false", "references=x, y"]);

    let vrm = read(&v0()).expect("a VRM").vrm;
    // Both nodes show the mesh.
    let hidden = FirstPersonView::ThirdPersonOnly;
    assert_eq!(vrm.first_person.views, [(4, hidden), (5, hidden)]);
    let offset = Vec3::new(0.5, 0.06, -0.04);
    assert_eq!((vrm.first_person.node, vrm.first_person.offset), (Some(1), Some(offset)));
    let terms: Vec<String> = vrm.meta.terms.iter().map(|(key, text)| format!("{key}={text}")).collect();
    assert_eq!(terms, ["commercialUssageName=Disallow", "contactInformation=n@x"]);
}

#[test]
fn springs_that_are_no_chains_are_left_out_and_odd_numbers_mended() {
    let springs = "/extensions/VRMC_springBone/springs";
    let place = "extensions.VRMC_springBone.springs";
    for (pointer, value, note, chains) in [
        (format!("{springs}/0/joints/1/node"), json!(9), format!("{place}[1]: node 9 is in another spring already: the spring is left out"), 1),
        (format!("{springs}/0/joints/1/node"), json!(0), format!("{place}[0]: node 0 is not below node 6: the spring is left out"), 1),
        (format!("{springs}/0/joints/1/node"), json!(6), format!("{place}[0]: node 6 is not below node 6: the spring is left out"), 1),
        (format!("{springs}/0/joints/0/dragForce"), json!(2), format!("{place}[0].joints[0].dragForce: 2 is out of range: 1 is taken"), 2),
        (format!("{springs}/0/joints/0/hitRadius"), json!(-1), format!("{place}[0].joints[0].hitRadius: -1 is out of range: 0 is taken"), 2),
        (
            "/extensions/VRMC_springBone/colliders/0/extensions".to_owned(),
            json!({ "VRMC_springBone_extended_collider": {} }),
            "extensions.VRMC_springBone.colliders[0]: expected a member 'specVersion', found none: its other form is taken".to_owned(),
            2,
        ),
    ] {
        let mut json = v1();
        set(&mut json, &pointer, value);
        let model = read(&json).expect("a VRM");
        assert_eq!(model.vrm.springs.chains.len(), chains, "{note}");
        assert!(notes(&model).contains(&note), "{note}: {:?}", notes(&model));
    }
}

#[test]
fn mistakes_are_told_with_their_place() {
    let springs = "/extensions/VRMC_springBone";
    let constraint = "/nodes/7/extensions/VRMC_node_constraint/constraint";
    for (pointer, value, expected) in [
        (
            format!("{springs}/springs/0/joints/0/node"),
            json!(10),
            "extensions.VRMC_springBone.springs[0].joints[0].node: expected a node below 10, found 10",
        ),
        (
            format!("{springs}/springs/0/colliderGroups/0"),
            json!(2),
            "extensions.VRMC_springBone.springs[0].colliderGroups[0]: expected a group below 2, found 2",
        ),
        (
            format!("{springs}/springs/0/center"),
            json!(-1),
            "extensions.VRMC_springBone.springs[0].center: expected a node below 10, found -1",
        ),
        (
            format!("{springs}/colliderGroups/1/colliders/0"),
            json!(7),
            "extensions.VRMC_springBone.colliderGroups[1].colliders[0]: expected a collider below 2, found 7",
        ),
        (
            format!("{springs}/colliders/0/shape"),
            json!({}),
            "extensions.VRMC_springBone.colliders[0].shape: expected either a sphere or a capsule, found {}",
        ),
        (
            format!("{springs}/colliders/0/shape/sphere/radius"),
            json!("big"),
            "extensions.VRMC_springBone.colliders[0].shape.sphere.radius: expected a finite number, found \"big\"",
        ),
        (
            format!("{springs}/specVersion"),
            json!("2.0"),
            "extensions.VRMC_springBone.specVersion: expected version 1.0, found \"2.0\"",
        ),
        (
            format!("{constraint}/roll/rollAxis"),
            json!("W"),
            "node 7, VRMC_node_constraint.constraint.roll.rollAxis: expected X, Y or Z, found \"W\"",
        ),
        (
            format!("{constraint}/roll/source"),
            json!(99),
            "node 7, VRMC_node_constraint.constraint.roll.source: expected a node below 10, found 99",
        ),
        (
            format!("{constraint}/aim"),
            json!({}),
            "node 7, VRMC_node_constraint.constraint: expected one of roll, aim and rotation, found",
        ),
        (
            "/extensions/VRMC_vrm/firstPerson/meshAnnotations/0/type".to_owned(),
            json!("never"),
            "extensions.VRMC_vrm.firstPerson.meshAnnotations[0].type: expected auto, both, thirdPersonOnly or firstPersonOnly, found \"never\"",
        ),
    ] {
        let mut json = v1();
        set(&mut json, &pointer, value);
        let told = read(&json).expect_err(expected).to_string();
        assert!(told.starts_with(&format!("face.vrm: {expected}")), "{told}\n{expected}");
    }
}

/// Sets a member that may not be there yet.
fn set(json: &mut Value, pointer: &str, value: Value) {
    let (parent, key) = pointer.rsplit_once('/').expect("a place");
    let parent = json.pointer_mut(parent).expect("a place in the file");
    match key.parse::<usize>() {
        Ok(index) if parent.is_array() => parent[index] = value,
        _ => parent[key] = value,
    }
}

/// A line of many nodes, and for each a spring or constraint that has to be looked at along the whole line if
/// nothing is remembered: 16 times as many take 16 times as long, not 256 times.
#[test]
fn springs_and_constraints_take_time_in_proportion() {
    let seconds = |count: usize| {
        let mut json = v1();
        let first = 10;
        let nodes = json["nodes"].as_array_mut().expect("nodes");
        nodes[8]["children"] = json!([first]);
        for k in 0..count {
            let mut node = json!({ "extensions": { "VRMC_node_constraint": { "specVersion": "1.0",
                "constraint": { "rotation": { "source": first + k - 1 } } } } });
            if k + 1 < count {
                node["children"] = json!([first + k + 1]);
            }
            nodes.push(node);
        }
        let spring =
            |k: usize| json!({ "joints": [{ "node": first + k }, { "node": first + count / 2 + k }] });
        let springs: Vec<Value> = (0..count / 2).map(spring).collect();
        json["extensions"]["VRMC_springBone"]["springs"] = json!(springs);
        let bytes = crate::support::gltf::glb(&json.to_string(), &[]);
        let start = std::time::Instant::now();
        let model =
            avatar_exchange::vrm::read("line.vrm", &bytes, &mut |_| Err(String::new())).expect("a VRM");
        assert_eq!(model.vrm.springs.chains.len(), count / 2);
        assert_eq!(model.vrm.constraints.len(), count + 3);
        start.elapsed().as_secs_f64()
    };
    let (few, many) = (seconds(2_000), seconds(32_000));
    assert!(many < 64.0 * few + 0.5, "{few} s, {many} s");
}
