//! The spaces and maps that this crate has.

use crate::map::Map;
use crate::space::Space;
use std::sync::{Arc, OnceLock};

/// A space that this crate has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Standard {
    /// The 52 blend shapes of Apple's face tracker, in alphabetical order.
    ArKit,
    /// The 61 values of a Live Link Face packet: ARKit's, and angles of head and eyes in radians.
    LiveLink,
    /// The 52 categories of MediaPipe's face landmarker.
    MediaPipe,
    /// The preset expressions of VRM 1.0.
    Vrm1,
    /// The preset expressions of VRM 0.x.
    Vrm0,
    /// The 15 visemes of Oculus's audio SDK.
    Oculus,
    /// Action units of the Facial Action Coding System, with sides.
    Facs,
    /// The curves of MetaHuman's face.
    MetaHuman,
    /// The units of expressions that MakeHuman has as targets.
    MakeHuman,
    /// The units of faces that MakeHuman has as poses of bones.
    MakeHumanPoses,
    /// The controls of this project's own face.
    Controls,
}

/// A space and the text that it is read from. One that another takes names from stands before it.
const SPACES: [(Standard, &str, &str); 11] = [
    (Standard::ArKit, "arkit", include_str!("../assets/spaces/arkit.toml")),
    (Standard::LiveLink, "live-link", include_str!("../assets/spaces/live-link.toml")),
    (Standard::MediaPipe, "mediapipe", include_str!("../assets/spaces/mediapipe.toml")),
    (Standard::Vrm1, "vrm1", include_str!("../assets/spaces/vrm1.toml")),
    (Standard::Vrm0, "vrm0", include_str!("../assets/spaces/vrm0.toml")),
    (Standard::Oculus, "oculus", include_str!("../assets/spaces/oculus.toml")),
    (Standard::Facs, "facs", include_str!("../assets/spaces/facs.toml")),
    (Standard::MetaHuman, "metahuman", include_str!("../assets/spaces/metahuman.toml")),
    (Standard::MakeHuman, "makehuman", include_str!("../assets/spaces/makehuman.toml")),
    (Standard::MakeHumanPoses, "makehuman-poses", include_str!("../assets/spaces/makehuman-poses.toml")),
    (Standard::Controls, "controls", include_str!("../assets/spaces/controls.toml")),
];

const MAPS: [&str; 10] = [
    include_str!("../assets/maps/arkit-live-link.toml"),
    include_str!("../assets/maps/arkit-mediapipe.toml"),
    include_str!("../assets/maps/arkit-vrm1.toml"),
    include_str!("../assets/maps/arkit-oculus.toml"),
    include_str!("../assets/maps/arkit-facs.toml"),
    include_str!("../assets/maps/arkit-metahuman.toml"),
    include_str!("../assets/maps/arkit-makehuman.toml"),
    include_str!("../assets/maps/arkit-makehuman-poses.toml"),
    include_str!("../assets/maps/arkit-controls.toml"),
    include_str!("../assets/maps/vrm1-vrm0.toml"),
];
/// Beside those by which every space is reached: a shorter way.
const SHORT_CUTS: [&str; 1] = [include_str!("../assets/maps/oculus-vrm1.toml")];

fn spaces() -> &'static [Arc<Space>] {
    static SPACES_READ: OnceLock<Vec<Arc<Space>>> = OnceLock::new();
    SPACES_READ.get_or_init(|| {
        let mut spaces: Vec<Arc<Space>> = Vec::new();
        for (_, key, text) in SPACES {
            let others: Vec<&Space> = spaces.iter().map(Arc::as_ref).collect();
            // A text that is wrong fails a test.
            let space = Space::from_toml(key, text, &others).unwrap_or_else(|_| Space::empty(key));
            spaces.push(Arc::new(space));
        }
        spaces
    })
}

/// All maps, each there and back.
pub(crate) fn maps() -> &'static [Arc<Map>] {
    static MAPS_READ: OnceLock<Vec<Arc<Map>>> = OnceLock::new();
    MAPS_READ.get_or_init(|| {
        let texts = SHORT_CUTS.iter().chain(&MAPS);
        // A text that is wrong fails a test.
        texts.flat_map(|text| Map::from_toml(text, spaces())).flatten().map(Arc::new).collect()
    })
}

impl Standard {
    /// All of them.
    pub const ALL: [Self; 11] = {
        let mut all = [Self::ArKit; SPACES.len()];
        let mut at = 0;
        while at < all.len() {
            all[at] = SPACES[at].0;
            at += 1;
        }
        all
    };

    /// What maps and command lines call it.
    pub fn key(self) -> &'static str {
        SPACES.iter().find(|(standard, ..)| *standard == self).map_or("", |(_, key, _)| key)
    }

    /// The space of a key.
    pub fn of_key(key: &str) -> Option<Self> {
        SPACES.iter().find(|(_, other, _)| *other == key).map(|(standard, ..)| *standard)
    }

    /// Its names.
    pub fn space(self) -> &'static Arc<Space> {
        static NONE: OnceLock<Arc<Space>> = OnceLock::new();
        let found = spaces().iter().find(|space| space.key() == self.key());
        found.unwrap_or_else(|| NONE.get_or_init(|| Arc::new(Space::empty(""))))
    }

    /// The text of its space, for programs that show or change it.
    pub fn toml(self) -> &'static str {
        SPACES.iter().find(|(standard, ..)| *standard == self).map_or("", |(_, _, text)| text)
    }

    /// The texts of all maps.
    pub fn map_tomls() -> impl Iterator<Item = &'static str> {
        SHORT_CUTS.into_iter().chain(MAPS)
    }

    /// The map to another space, where one is written. [`crate::Route`] finds a way where none is.
    pub fn map_to(self, to: Self) -> Option<&'static Arc<Map>> {
        maps().iter().find(|map| map.from().key() == self.key() && map.to().key() == to.key())
    }
}
