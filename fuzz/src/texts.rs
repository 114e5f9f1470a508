//! The project's own files: rigs, everything in TOML, packs and their pictures.

use crate::exercise::{act, within_memory};
use crate::packed::{files, text_and_bytes};
use avatar_groom::Hair;
use avatar_look::Materials;
use avatar_pack::{Identity, MemorySource, Pack, Springs, Textures, raw_files};
use pose_anim::{ClipSet, ControlTable, PoseSet, Recording};
use pose_book::{ClipBook, PoseBook};
use rig_core::{RawRig, Rig};

/// `Transformations.xml`. What was read and written again is the same.
pub fn rig(data: &[u8]) {
    let without_places = |mut raw: RawRig| {
        raw.joints.iter_mut().for_each(|joint| joint.place = None);
        raw
    };
    match within_memory(data.len(), "the reader", || RawRig::from_xml(data)) {
        Ok(raw) => {
            let _ = Rig::from_raw(&raw).map_err(|error| error.to_string());
            let _ = Rig::from_raw_affine(&raw).map_err(|error| error.to_string());
            if let Ok(text) = raw.to_xml() {
                let again = RawRig::from_xml(text.as_bytes()).map(without_places);
                assert_eq!(again, Ok(without_places(raw)), "written as {text}");
            }
        }
        Err(error) => drop(error.to_string()),
    }
}

fn text(data: &[u8]) -> Option<&str> {
    std::str::from_utf8(data).ok()
}

/// `controls.toml`. Axes may change in their last digit, so what is written is only read.
pub fn controls(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match within_memory(data.len(), "the reader", || ControlTable::from_toml(text)) {
        Ok(table) => {
            let written = table.to_toml();
            let again = ControlTable::from_toml(&written);
            assert!(again.is_ok(), "{again:?}: {written}");
            let poses = PoseSet::default_face(&table);
            let again = PoseSet::from_toml(&poses.to_toml(&table), &table);
            assert!(again.is_ok(), "{again:?}: {written}");
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `poses.toml` for the default controls, and its edits.
pub fn poses(data: &[u8]) {
    let Some(text) = text(data) else { return };
    let controls = ControlTable::default_face();
    match within_memory(data.len(), "the reader", || PoseSet::from_toml(text, &controls)) {
        Ok(poses) => {
            let written = poses.to_toml(&controls);
            assert_eq!(PoseSet::from_toml(&written, &controls), Ok(poses.clone()), "written as {written}");
            let Ok(mut book) = PoseBook::read(text, &controls) else {
                panic!("a text is read as poses, but not for editing")
            };
            let count = poses.poses.len();
            let _ = book.rename(0, "a new name");
            let _ = book.set_values(count / 2, &[(0, 1.0), (9, -3.0)]);
            let _ = book.move_to(0, count.saturating_sub(1));
            let _ = book.remove(count / 2);
            while book.undo().is_some() {}
            assert_eq!(book.poses(), &poses);
            while book.redo().is_some() {}
            assert_eq!(PoseSet::from_toml(book.text(), &controls).as_ref(), Ok(book.poses()));
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `clips.toml` for the default controls, and its edits; and the text as a recording.
pub fn clips(data: &[u8]) {
    let Some(text) = text(data) else { return };
    let controls = ControlTable::default_face();
    match within_memory(data.len(), "the reader", || Recording::from_csv("recording", text, &controls)) {
        Ok(Recording { clip, .. }) => {
            let set = ClipSet { clips: vec![clip] };
            let written = set.to_toml(&controls);
            assert!(ClipSet::from_toml(&written, &controls).is_ok(), "written as {written}");
        }
        Err(error) => drop(error.to_string()),
    }
    match within_memory(data.len(), "the reader", || ClipSet::from_toml(text, &controls)) {
        Ok(clips) => {
            let written = clips.to_toml(&controls);
            assert_eq!(ClipSet::from_toml(&written, &controls), Ok(clips.clone()), "written as {written}");
            let mut values = controls.defaults();
            for clip in &clips.clips {
                for time in [-1.0, 0.0, 0.4 * clip.duration_secs(), 1e9, f64::NAN] {
                    clip.sample(time, &mut values);
                }
            }
            let Ok(mut book) = ClipBook::read(text, &controls) else {
                panic!("a text is read as clips, but not for editing")
            };
            if let Some(first) = clips.clips.first() {
                let mut first = first.clone();
                first.reverse();
                let _ = first.scale_time(0.5);
                let _ = book.set(0, &first, "turn around");
                let _ = book.remove(0);
            }
            while book.undo().is_some() {}
            assert_eq!(book.clips(), &clips);
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `materials.toml`.
pub fn materials(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match within_memory(data.len(), "the reader", || Materials::from_toml(text)) {
        Ok(materials) => {
            let written = materials.to_toml();
            assert_eq!(Materials::from_toml(&written), Ok(materials), "written as {written}");
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `hair.toml`.
pub fn hair(data: &[u8]) {
    let Some(text) = text(data) else { return };
    match within_memory(data.len(), "the reader", || Hair::from_toml(text)) {
        Ok(hair) => {
            let written = hair.to_toml();
            assert_eq!(Hair::from_toml(&written), Ok(hair), "written as {written}");
        }
        Err(error) => drop(error.to_string()),
    }
}

/// The files of the golden pack that an input does not say.
const GOLDEN: [(&str, &[u8]); 15] = [
    ("LowerJaw_IB.raw", include_bytes!("../../tests/golden/pack/LowerJaw_IB.raw")),
    ("LowerJaw_VB.raw", include_bytes!("../../tests/golden/pack/LowerJaw_VB.raw")),
    ("LtEyeBall_smtt_IB.raw", include_bytes!("../../tests/golden/pack/LtEyeBall_smtt_IB.raw")),
    ("LtEyeBall_smtt_VB.raw", include_bytes!("../../tests/golden/pack/LtEyeBall_smtt_VB.raw")),
    ("LtEyeTransp_smtt_IB.raw", include_bytes!("../../tests/golden/pack/LtEyeTransp_smtt_IB.raw")),
    ("LtEyeTransp_smtt_VB.raw", include_bytes!("../../tests/golden/pack/LtEyeTransp_smtt_VB.raw")),
    ("MarsienneSkin_IB.raw", include_bytes!("../../tests/golden/pack/MarsienneSkin_IB.raw")),
    ("MarsienneSkin_VB.raw", include_bytes!("../../tests/golden/pack/MarsienneSkin_VB.raw")),
    ("RtEyeBall_smtt_IB.raw", include_bytes!("../../tests/golden/pack/RtEyeBall_smtt_IB.raw")),
    ("RtEyeBall_smtt_VB.raw", include_bytes!("../../tests/golden/pack/RtEyeBall_smtt_VB.raw")),
    ("RtEyeTransp_smtt_IB.raw", include_bytes!("../../tests/golden/pack/RtEyeTransp_smtt_IB.raw")),
    ("RtEyeTransp_smtt_VB.raw", include_bytes!("../../tests/golden/pack/RtEyeTransp_smtt_VB.raw")),
    ("Transformations.xml", include_bytes!("../../tests/golden/pack/Transformations.xml")),
    ("UpperJaw_IB.raw", include_bytes!("../../tests/golden/pack/UpperJaw_IB.raw")),
    ("UpperJaw_VB.raw", include_bytes!("../../tests/golden/pack/UpperJaw_VB.raw")),
];

/// What an input of [`pack`] says, in this order; an empty file stands for one of the golden pack, or none.
const SAID: [&str; 8] = [
    "Transformations.xml",
    "controls.toml",
    "poses.toml",
    "clips.toml",
    "materials.toml",
    "hair.toml",
    "LowerJaw_IB.raw",
    "LowerJaw_VB.raw",
];

fn golden() -> MemorySource {
    MemorySource { files: GOLDEN.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).into() }
}

/// A whole pack: texts that belong together, and the buffers of one part. It is written back, too.
pub fn pack(data: &[u8]) {
    let mut source = golden();
    for (name, bytes) in SAID.into_iter().zip(files(data)).filter(|(_, bytes)| !bytes.is_empty()) {
        source.files.insert(name.to_owned(), bytes.to_vec());
    }
    match within_memory(data.len(), "the reader", || Pack::load(&source)) {
        Ok(pack) => {
            let textures = Textures::default();
            act(&pack, &textures);
            match raw_files(&pack, &textures) {
                Ok(_) => {}
                Err(error) => drop(error.to_string()),
            }
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `shapes.toml` and the bytes of `shapes.raw`, for the golden pack. It is written back and read again.
pub fn shapes(data: &[u8]) {
    let (toml, raw) = text_and_bytes(data);
    let mut source = golden();
    source.files.insert("shapes.toml".to_owned(), toml.to_vec());
    source.files.insert("shapes.raw".to_owned(), raw.to_vec());
    match within_memory(data.len(), "the reader", || Pack::load(&source)) {
        Ok(pack) => {
            let textures = Textures::default();
            act(&pack, &textures);
            let files = match raw_files(&pack, &textures) {
                Ok(files) => files.files,
                Err(error) => panic!("what was read cannot be written: {error}"),
            };
            let again = Pack::load(&MemorySource { files: files.into_iter().collect() });
            let list = again.as_ref().map(Pack::further_shapes).map_err(ToString::to_string);
            assert_eq!(list, Ok(pack.further_shapes()));
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `identity.toml`, for the golden pack. Other people are made of it; it is written back and read again.
pub fn identity(data: &[u8]) {
    let mut source = golden();
    source.files.insert("identity.toml".to_owned(), data.to_vec());
    match within_memory(data.len(), "the reader", || Pack::load(&source)) {
        Ok(pack) => {
            let Some(identity) = pack.identity() else { panic!("axes that were read are lost") };
            let written = identity.to_toml();
            assert_eq!(Identity::from_toml(&written).as_ref(), Ok(identity), "written as {written}");
            let textures = Textures::default();
            let ends = [-1.0, 1.0].map(|end| vec![end; identity.axes.len()]);
            for values in [identity.draw(data.len() as u64)].into_iter().chain(ends) {
                match pack.with_identity(&values) {
                    Ok(person) => act(&person, &textures),
                    Err(error) => drop(error.to_string()),
                }
            }
        }
        Err(error) => drop(error.to_string()),
    }
}

/// `springs.toml`, for the golden pack, whose joints swing then. It is written back and read again.
pub fn springs(data: &[u8]) {
    let mut source = golden();
    source.files.insert("springs.toml".to_owned(), data.to_vec());
    match within_memory(data.len(), "the reader", || Pack::load(&source)) {
        Ok(pack) => {
            let written = pack.springs().to_toml(pack.rig().names());
            let again = Springs::from_toml(&written, pack.rig());
            assert_eq!(again.as_ref(), Ok(pack.springs()), "written as {written}");
            act(&pack, &Textures::default());
        }
        Err(error) => drop(error.to_string()),
    }
}

/// A picture of a pack.
pub fn picture(data: &[u8]) {
    let mut source = MemorySource::default();
    source.files.insert("SkinTex_Decal.png".to_owned(), data.to_vec());
    let textures = within_memory(data.len(), "the decoder", || Textures::load(&source));
    let _ = textures.warnings.iter().map(ToString::to_string).collect::<String>();
}
