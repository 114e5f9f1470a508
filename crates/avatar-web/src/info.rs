//! What a page is told of the face, as JSON.

use crate::{Look, Stage};
use pose_anim::{Control, Drive, JointMotion};
use serde_json::{Map, Value, json};

impl Stage {
    /// What there is to press, set and choose, how things are now, and what was noted while reading.
    pub fn info(&self) -> Value {
        let pack = self.pack();
        let controls = pack.controls().controls().iter().zip(self.performer.targets());
        let controls: Vec<Value> = controls.map(|(control, target)| about(control, target)).collect();
        let poses = pack.poses().iter().map(|pose| json!({ "name": pose.name, "key": pose.key }));
        let clips = pack.clips().clips.iter();
        let clips = clips.map(|clip| json!({ "name": clip.name, "seconds": clip.duration_secs() }));
        let options: Map<String, Value> = (Look::OPTIONS.iter().chain(["life"].iter()))
            .map(|option| ((*option).to_owned(), json!(Look::words(option))))
            .collect();
        let chosen: Map<String, Value> =
            self.look.said().map(|(option, word)| (option.to_owned(), json!(word))).collect();
        let axes = pack.identity().or_else(|| self.avatar.pack.identity());
        let bones = pack.palette().iter().map(|bone| pack.rig().names().get(bone.joint.index()));
        let count = |of: fn(&avatar_pack::Part) -> usize| pack.parts().iter().map(of).sum::<usize>();
        json!({
            "name": self.avatar.name,
            "controls": controls,
            "poses": poses.collect::<Vec<_>>(),
            "clips": clips.collect::<Vec<_>>(),
            "identity": {
                "now": self.identity,
                "axes": axes.map(|identity| identity.names().collect::<Vec<_>>()).unwrap_or_default(),
            },
            "options": options,
            "look": chosen,
            "life": self.life(),
            "speaks": self.can_speak(),
            "names": {
                "bones": bones.collect::<Vec<_>>(),
                "shapes": pack.shapes(),
            },
            "parts": pack.parts().len(),
            "joints": pack.rig().names().len(),
            "shapes": pack.shapes().len(),
            "vertices": count(|part| part.mesh.positions.len()),
            "triangles": count(|part| part.mesh.triangles.len()),
            "notes": self.avatar.notes,
        })
    }
}

fn about(control: &Control, target: f32) -> Value {
    let unit = match control.drives {
        Drive::Joint { kind: JointMotion::Rotation, .. } => "degrees",
        Drive::Joint { kind: JointMotion::Translation, .. } => "units",
        Drive::Shape { .. } => "weight",
    };
    let group = control.group.as_deref();
    let group = group.or_else(|| control.name.split_once('.').map(|(group, _)| group));
    let word = |name: &str| name.chars().take_while(char::is_ascii_lowercase).collect::<String>();
    json!({
        "name": control.name,
        "group": group.map_or_else(|| word(&control.name), str::to_owned),
        "unit": unit,
        "min": control.min,
        "max": control.max,
        "default": control.default,
        "value": target,
    })
}
