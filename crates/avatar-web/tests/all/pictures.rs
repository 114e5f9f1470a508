//! Pictures, on whatever adapter there is.

use crate::face::{pass, stage};
use avatar_render::headless::{GpuOptions, open_blocking};
use avatar_web::Show;
use std::io::Write;

#[test]
#[allow(clippy::disallowed_methods, reason = "a test may ask the environment how strict it is to be")]
fn looks_poses_and_people_are_seen() {
    let gpu = match open_blocking(GpuOptions::default()) {
        Ok(gpu) => gpu,
        Err(reason) => {
            let required = std::env::var("MIMIK_REQUIRE_GPU").is_ok_and(|value| value == "1");
            assert!(!required, "MIMIK_REQUIRE_GPU=1, but {reason}");
            let _ = writeln!(std::io::stderr(), "SKIPPED: {reason}");
            return;
        }
    };
    let mut stage = stage();
    stage.look.set("quality", "plain").expect("a quality");
    let mut show = Show::without_screen(gpu, &stage).expect("uploaded");
    let mut seen: Vec<Vec<u8>> = Vec::new();
    let mut see = |show: &mut Show, stage: &avatar_web::Stage| {
        let picture = show.picture(stage, (96, 96)).expect("begun");
        let picture = pollster::block_on(picture.develop()).expect("a picture");
        assert_eq!(picture.rgba.len(), 4 * 96 * 96);
        assert!(!seen.contains(&picture.rgba), "as before");
        seen.push(picture.rgba);
    };
    see(&mut show, &stage);
    stage.press("surprise").expect("a pose");
    pass(&mut stage, 3.0);
    see(&mut show, &stage);
    for (option, word) in [("skin", "dark"), ("hair", "mohawk"), ("light", "dramatic"), ("quality", "low")] {
        stage.look.set(option, word).expect("a word");
        show.relook(&stage).expect("shown");
        see(&mut show, &stage);
    }
    stage.become_person("seed:7").expect("somebody");
    show.upload(&stage).expect("uploaded");
    see(&mut show, &stage);
    stage.orbit(40.0, 0.0, 1.0);
    see(&mut show, &stage);
}
