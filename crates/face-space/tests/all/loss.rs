use face_space::{Fate, Loss, Route, Standard, VertexError};

fn loss(from: Standard, to: Standard) -> Loss {
    Loss::of(&mut Route::between(from, to).unwrap(), &mut Route::between(to, from).unwrap())
}

fn fate<'a>(loss: &'a Loss, standard: Standard, name: &str) -> &'a Fate {
    &loss.fates[standard.space().index(name).unwrap()]
}

#[test]
fn the_way_to_the_same_space_loses_nothing() {
    for standard in Standard::ALL {
        let loss = loss(standard, standard);
        assert_eq!(loss.counts(), [standard.space().len(), 0, 0, 0]);
        assert_eq!((loss.merged.len(), loss.unset.len()), (0, 0));
    }
}

#[test]
fn each_fate_is_told() {
    use Standard::{ArKit, Facs, MediaPipe, Vrm1};
    let found = loss(ArKit, Vrm1);
    assert_eq!(fate(&found, ArKit, "eyeBlinkLeft"), &Fate::Kept);
    assert_eq!(fate(&found, ArKit, "tongueOut"), &Fate::Lost);
    assert_eq!(fate(&found, ArKit, "browInnerUp"), &Fate::WithOthers);
    // One eye that looks out is half a look of both.
    let Fate::Changed(moved) = fate(&found, ArKit, "eyeLookOutLeft") else { panic!("{found:?}") };
    let arkit = ArKit.space();
    assert_eq!(*moved, ["eyeLookInRight", "eyeLookOutLeft"].map(|name| (arkit.index(name).unwrap(), 0.5)));

    let found = loss(ArKit, MediaPipe);
    assert_eq!(found.counts(), [51, 0, 0, 1]);
    assert_eq!(found.unset, [0], "_neutral");

    let found = loss(ArKit, Facs);
    let named =
        |group: &Vec<usize>| group.iter().map(|at| arkit.names()[*at].name.clone()).collect::<Vec<_>>();
    let merged: Vec<_> = found.merged.iter().map(named).collect();
    assert_eq!(
        merged,
        [
            ["eyeLookDownLeft", "eyeLookDownRight"],
            ["eyeLookUpLeft", "eyeLookUpRight"],
            ["mouthShrugLower", "mouthShrugUpper"]
        ]
    );
    assert_eq!(fate(&found, ArKit, "mouthLeft"), &Fate::Lost);
    assert_eq!(fate(&found, ArKit, "eyeLookOutLeft"), &Fate::Kept, "each eye by the sum of two codes");
}

#[test]
fn what_no_map_on_the_way_sets_is_unset() {
    let unset = |from, to: Standard| {
        let names = loss(from, to).unset.into_iter().map(|at| to.space().names()[at].name.as_str());
        names.collect::<Vec<_>>()
    };
    assert_eq!(unset(Standard::ArKit, Standard::Vrm0), ["neutral", "blink", "fun"]);
    assert_eq!(unset(Standard::Vrm0, Standard::Vrm1), ["surprised"]);
}

#[test]
fn errors_of_vertices_are_distances() {
    let mut error = VertexError::default();
    assert_eq!((error.mean(), error.max(), error.root_mean_square()), (0.0, 0.0, 0.0));
    error.add(&[[0.0; 3], [1.0, 2.0, 2.0]], &[[3.0, 4.0, 0.0], [1.0, 2.0, 2.0], [9.0; 3]]);
    error.add(&[[f32::NAN; 3], [0.0, 0.0, 1.0]], &[[0.0; 3], [0.0; 3]]);
    assert_eq!((error.mean(), error.max()), (2.0, 5.0));
    assert_eq!(error.root_mean_square(), (26.0f64 / 3.0).sqrt());
}
