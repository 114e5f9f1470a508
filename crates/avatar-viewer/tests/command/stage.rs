//! A program of one's own shows what the viewer shows, to the byte.
#![allow(clippy::expect_used, reason = "a test may panic")]

use crate::common::{finish, has_adapter, viewer};
use avatar_pack::{Pack, Textures};
use avatar_render::headless::{GpuOptions, open_blocking, render_image};
use avatar_render::{AvatarState, HairDetail, Light, Quality};
use avatar_stage::{BACKGROUND, DefaultFace, Framing, NamedView, Performer, SAMPLES, View, portrait, upload};

#[test]
fn a_picture_made_with_the_library_is_that_of_the_viewer() {
    if !has_adapter() {
        return;
    }
    let gpu = open_blocking(GpuOptions::default()).expect("an adapter");
    let mut face = Performer::new(Pack::load(&DefaultFace).expect("the built-in face"));
    let model =
        upload(&gpu.device, &gpu.queue, face.pack(), &Textures::load(&DefaultFace)).expect("uploaded");
    let mut avatar = AvatarState::new(&gpu.device, &model);
    avatar.set_hair_detail(HairDetail::of_quality(Quality::of_adapter(&gpu.info)));
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (pose, view) in [("smile", NamedView::Front), ("wink-left", NamedView::ThreeQuarter)] {
        face.press(pose).expect("a pose");
        face.advance(f64::INFINITY).expect("time passes");
        avatar.set(&gpu.queue, face.bones(), face.weights()).expect("they fit");
        let portrait_of = View { framing: Framing::Portrait, hair_top: model.hair_top(), ..view.view() };
        let scene = portrait_of.scene(face.pack(), 160.0 / 120.0, BACKGROUND, Light::studio());
        if view == NamedView::Front {
            assert_eq!(scene, portrait(face.pack(), 160.0 / 120.0));
        }
        let picture = render_image(&gpu, 160, 120, SAMPLES, &scene, &[(&model, &avatar)]).expect("drawn");
        let out = folder.path().join("viewer.png");
        let mut render = viewer();
        render
            .args(["render", "--size", "160x120", "--pose", pose, "--view", view.name(), "--out"])
            .arg(&out);
        finish(&mut render).ok();
        let expected = image::open(&out).expect("a picture").into_rgba8();
        assert!(*expected.as_raw() == picture.rgba, "{pose} from {}", view.name());
    }
}
