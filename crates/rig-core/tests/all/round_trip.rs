//! Writing and reading back gives the same rig to the last bit.
#![allow(clippy::panic, clippy::unwrap_used, reason = "a test may panic")]

use crate::common::without_places;
use glam::Mat4;
use proptest::prelude::*;
use rig_core::{MAX_DEPTH, MAX_NAME_BYTES, MatrixLayout, RawJoint, RawRig, RigError};

/// Any finite f32 by its bits: subnormals, -0.0, the largest.
fn number() -> impl Strategy<Value = f32> {
    let special =
        [0.0, -0.0, f32::from_bits(1), -f32::MIN_POSITIVE, f32::MAX, f32::MIN, 1.0 / 3.0, 1e-7, 16_777_217.0];
    prop_oneof![any::<u32>().prop_map(f32::from_bits), prop::sample::select(special.to_vec())]
        .prop_filter("finite", |x| x.is_finite())
}

/// Names of what XML must escape, of white space and line ends, of other scripts.
fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[&<>\"'a \n\r\t;#]{1,12}", "\\PC{1,8}", "[a-z]{1,3}\u{85}\u{2028}?"]
        .prop_filter("no blank names", |name| !name.trim().is_empty())
}

prop_compose! {
    /// A forest: joint i hangs on an earlier one or on none; then the list is shuffled.
    fn rig()(
        names in prop::collection::hash_set(name(), 1..12),
        seeds in prop::collection::vec((any::<prop::sample::Index>(), prop::array::uniform16(number()), any::<[bool; 3]>()), 12),
        shuffle in any::<u64>(),
    ) -> RawRig {
        let names: Vec<String> = names.into_iter().collect();
        let mut joints: Vec<RawJoint> = (names.iter().zip(seeds).enumerate())
            .map(|(i, (name, (parent, numbers, [root, by_rows, omit])))| RawJoint {
                name: name.clone(),
                parent: (i > 0 && !root).then(|| names[parent.index(i)].clone()),
                parent_from_joint: Mat4::from_cols_array(&numbers),
                layout: if by_rows { MatrixLayout::RowByRow } else { MatrixLayout::Transposed },
                omit,
                place: None,
            })
            .collect();
        let mut random = crate::common::Random(shuffle);
        for i in (1..joints.len()).rev() {
            joints.swap(i, random.below(i + 1));
        }
        RawRig { joints }
    }
}

/// Name, parent, bits of the matrix, row by row, omit.
type Content = (String, Option<String>, [u32; 16], bool, bool);

/// All that must survive, with numbers as bits; sorted, since writing puts parents first.
fn content(raw: &RawRig) -> Vec<Content> {
    let mut content: Vec<_> = (raw.joints.iter())
        .map(|joint| {
            let bits = joint.parent_from_joint.to_cols_array().map(f32::to_bits);
            let by_rows = joint.layout == MatrixLayout::RowByRow;
            (joint.name.clone(), joint.parent.clone(), bits, by_rows, joint.omit)
        })
        .collect();
    content.sort();
    content
}

proptest! {
    #[test]
    fn every_rig_comes_back_to_the_last_bit(raw in rig()) {
        let text = raw.to_xml().unwrap();
        let again = RawRig::from_xml(text.as_bytes()).unwrap();
        prop_assert_eq!(content(&again), content(&raw));
        // Read back, parents come first and siblings keep their order; from then on nothing changes any more.
        prop_assert_eq!(again.to_xml().unwrap(), text.clone());
        let siblings = |raw: &RawRig, parent: &Option<String>| -> Vec<String> {
            raw.joints.iter().filter(|joint| joint.parent == *parent).map(|joint| joint.name.clone()).collect()
        };
        let parents = raw.joints.iter().map(|joint| Some(joint.name.clone())).chain([None]);
        for parent in parents {
            prop_assert_eq!(siblings(&again, &parent), siblings(&raw, &parent));
        }
        // The same through UTF-16.
        let utf16: Vec<u8> = "\u{FEFF}".encode_utf16().chain(text.encode_utf16()).flat_map(u16::to_be_bytes).collect();
        prop_assert_eq!(without_places(RawRig::from_xml(&utf16).unwrap()), without_places(again));
    }

    #[test]
    fn the_layout_changes_the_text_and_not_the_matrix(raw in rig()) {
        for layout in [MatrixLayout::RowByRow, MatrixLayout::Transposed] {
            let mut other = raw.clone();
            other.joints.iter_mut().for_each(|joint| joint.layout = layout);
            let again = RawRig::from_xml(other.to_xml().unwrap().as_bytes()).unwrap();
            prop_assert_eq!(content(&again), content(&other));
        }
    }
}

fn forest(joints: &[(&str, Option<&str>)]) -> RawRig {
    let joint = |&(name, parent): &(&str, Option<&str>)| RawJoint::new(name, parent, Mat4::IDENTITY);
    RawRig { joints: joints.iter().map(joint).collect() }
}

fn order(raw: &RawRig) -> Vec<(String, Option<String>)> {
    let again = RawRig::from_xml(raw.to_xml().unwrap().as_bytes()).unwrap();
    again.joints.into_iter().map(|joint| (joint.name, joint.parent)).collect()
}

fn pairs(expected: &[(&str, Option<&str>)]) -> Vec<(String, Option<String>)> {
    expected.iter().map(|(name, parent)| ((*name).to_owned(), parent.map(str::to_owned))).collect()
}

#[test]
fn edits_survive() {
    let mut raw = forest(&[
        ("eye", Some("head")),
        ("head", Some("neck")),
        ("neck", None),
        ("lamp", None),
        ("jaw", Some("head")),
    ]);
    let expected = [
        ("neck", None),
        ("head", Some("neck")),
        ("eye", Some("head")),
        ("jaw", Some("head")),
        ("lamp", None),
    ];
    assert_eq!(order(&raw), pairs(&expected));

    // Rename: the parent's new name is the children's affair, too.
    raw.joints[1].name = "skull".to_owned();
    let unknown = RigError::UnknownParent { joint: "eye".to_owned(), parent: "head".to_owned() };
    assert_eq!(raw.to_xml(), Err(unknown));
    raw.joints[0].parent = Some("skull".to_owned());
    raw.joints[4].parent = Some("skull".to_owned());
    // Move a joint to the other tree, remove a leaf, add one under a leaf.
    raw.joints[4].parent = Some("lamp".to_owned());
    raw.joints.remove(0);
    raw.joints.insert(0, RawJoint::new("lash", Some("jaw"), Mat4::IDENTITY));
    let expected = [
        ("neck", None),
        ("skull", Some("neck")),
        ("lamp", None),
        ("jaw", Some("lamp")),
        ("lash", Some("jaw")),
    ];
    assert_eq!(order(&raw), pairs(&expected));
}

#[test]
fn the_text_is_indented_and_short() {
    let mut raw = forest(&[("a", None), ("b", Some("a"))]);
    raw.joints[0].parent_from_joint = Mat4::from_translation(glam::Vec3::new(0.1, -0.0, 1e-10));
    raw.joints[1].layout = MatrixLayout::RowByRow;
    raw.joints[1].omit = true;
    let expected = r#"<JointSet>
  <Joint name="a">
    <Matrix transposed="true">
      1 0 0 0
      0 1 0 0
      0 0 1 0
      0.1 -0 0.0000000001 1
    </Matrix>
    <Children>
      <Joint name="b" omit="true">
        <Matrix>
          1 0 0 0
          0 1 0 0
          0 0 1 0
          0 0 0 1
        </Matrix>
      </Joint>
    </Children>
  </Joint>
</JointSet>
"#;
    assert_eq!(raw.to_xml().unwrap(), expected);
}

#[test]
fn what_could_not_be_read_back_is_not_written() {
    let a = || "a".to_owned();
    assert_eq!(forest(&[("a", None), ("a", None)]).to_xml(), Err(RigError::DuplicateJoint { joint: a() }));
    assert_eq!(forest(&[("a", Some("a"))]).to_xml(), Err(RigError::Cycle { joint: a() }));
    // x hangs below the cycle and is not on it.
    let cycle =
        forest(&[("r", None), ("x", Some("a")), ("a", Some("b")), ("b", Some("c")), ("c", Some("a"))]);
    let Err(RigError::Cycle { joint }) = cycle.to_xml() else { panic!("a cycle was written") };
    assert!(["a", "b", "c"].contains(&joint.as_str()), "{joint}");
    for bad in [f32::NAN, f32::INFINITY] {
        let mut raw = forest(&[("r", None), ("a", None)]);
        raw.joints[1].parent_from_joint.y_axis.z = bad;
        assert_eq!(raw.to_xml(), Err(RigError::NotFinite { joint: a() }));
    }
    let long = "n".repeat(MAX_NAME_BYTES + 1);
    for name in ["", " \n", "a\0", "\u{1}", "\u{FFFE}", &long] {
        let error = RigError::UnwritableName { joint: name.to_owned(), limit: MAX_NAME_BYTES };
        assert_eq!(forest(&[(name, None)]).to_xml(), Err(error));
    }
    assert_eq!(order(&forest(&[(&long[1..], None)])).len(), 1);

    let chain = |levels: usize| {
        let names: Vec<String> = (0..levels).map(|level| level.to_string()).collect();
        let joint =
            |i: usize| RawJoint::new(&*names[i], (i > 0).then(|| names[i - 1].as_str()), Mat4::IDENTITY);
        RawRig { joints: (0..levels).map(joint).collect() }
    };
    assert_eq!(order(&chain(MAX_DEPTH)).len(), MAX_DEPTH);
    let joint = MAX_DEPTH.to_string();
    assert_eq!(chain(MAX_DEPTH + 1).to_xml(), Err(RigError::TooDeep { joint, limit: MAX_DEPTH }));
    // Freezing has no such limit, and no stack to overflow.
    assert_eq!(rig_core::Rig::from_raw(&chain(200_000)).unwrap().len(), 200_000);
}
