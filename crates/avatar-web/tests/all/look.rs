//! Words of the look.

use avatar_groom::{Hair, Style};
use avatar_render::wgpu::{AdapterInfo, Backend, DeviceType};
use avatar_render::{Light, Quality};
use avatar_web::Look;

#[test]
fn every_word_that_is_offered_is_known_and_can_be_taken_back() {
    for option in Look::OPTIONS {
        for word in Look::words(option) {
            let mut look = Look::default();
            look.set(option, word).unwrap_or_else(|error| panic!("{option}={word}: {error}"));
            assert_eq!(look.said().collect::<Vec<_>>(), [(option, word)]);
            look.set(option, "auto").expect("taken back");
            assert_eq!(look, Look::default(), "{option}={word}");
        }
        let mut look = Look::default();
        assert!(look.set(option, "plaid").is_err(), "{option}");
        assert_eq!(look, Look::default(), "{option}");
    }
    let told = Look::default().set("hairs", "bob").expect_err("no option").to_string();
    assert!(told.contains("did you mean \"hair\""), "{told}");
}

#[test]
fn numbers_have_ranges() {
    let mut look = Look::default();
    for (option, word) in
        [("exposure", "11"), ("exposure", "NaN"), ("hair-density", "-1"), ("background", "#12")]
    {
        assert!(look.set(option, word).is_err(), "{option}={word}");
    }
    look.set("exposure", "1").expect("a stop");
    // One stop is twice the light.
    assert_eq!(look.light().exposure, 2.0 * Light::studio().exposure);
    look.set("background", "#0a141e").expect("a colour");
    assert_eq!(look.background(), [10, 20, 30, 255]);
}

#[test]
fn hair_is_the_packs_own_until_somebody_chooses() {
    let own = Hair { seed: 9, ..Hair::default() };
    let mut look = Look::default();
    assert_eq!(look.hair(Some(&own)), Some(own));
    assert_eq!(look.hair(None), None);
    look.set("hair", "bob").expect("a style");
    assert_eq!(look.hair(Some(&own)), Some(Hair { style: Style::BOB, ..own }));
    look.set("hair", "off").expect("none");
    assert_eq!(look.hair(Some(&own)), None);
}

#[test]
fn software_is_known_by_its_name() {
    let adapter = |name: &str, device_type| AdapterInfo {
        name: name.to_owned(),
        ..AdapterInfo::new(device_type, Backend::BrowserWebGpu)
    };
    let look = Look::default();
    assert_eq!(look.quality(&adapter("SwiftShader Device (LLVM 10)", DeviceType::Other)), Quality::Low);
    assert_eq!(look.quality(&adapter("", DeviceType::Cpu)), Quality::Low);
    assert_eq!(look.quality(&adapter("Apple M3", DeviceType::Other)), Quality::Medium);
}
