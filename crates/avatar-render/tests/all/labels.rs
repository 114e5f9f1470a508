//! Graphics debuggers and messages of the device name everything that this crate makes.
#![allow(clippy::expect_used, reason = "helpers of tests fail the test")]

use std::path::Path;

/// The fields of a struct expression up to its own closing brace, without those of what is nested in it.
fn own_fields(after_brace: &str) -> String {
    let mut depth = 0;
    let mut fields = String::new();
    for c in after_brace.chars() {
        match c {
            '{' | '(' | '[' => depth += 1,
            '}' | ')' | ']' if depth == 0 => break,
            '}' | ')' | ']' => depth -= 1,
            _ if depth == 0 => fields.push(c),
            _ => {}
        }
    }
    fields
}

/// What in a source has no label.
fn unlabelled(source: &str) -> Vec<String> {
    let line_of = |place: usize| source[..place].matches('\n').count() + 1;
    let mut found = Vec::new();
    for bad in ["label: None", "(&Default::default())", "Descriptor::default()"] {
        found.extend(source.match_indices(bad).map(|(place, _)| format!("{}: {bad}", line_of(place))));
    }
    for (place, opening) in source.match_indices("Descriptor {") {
        // That of the instance has none.
        let is_exempt = source[..place].ends_with("Instance");
        let fields = own_fields(&source[place + opening.len()..]);
        if !is_exempt && !fields.split(',').any(|field| field.trim().trim_start().starts_with("label")) {
            found.push(format!("{}: {opening}", line_of(place)));
        }
    }
    found
}

#[allow(clippy::disallowed_methods, reason = "it reads the crate's sources")]
fn sources(folder: &Path, all: &mut Vec<(String, String)>) {
    for entry in std::fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, all);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            all.push((path.display().to_string(), std::fs::read_to_string(&path).expect("a source")));
        }
    }
}

#[test]
fn every_pass_pipeline_buffer_texture_and_bind_group_has_a_label() {
    let mut all = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut all);
    let described: usize = all.iter().map(|(_, source)| source.matches("Descriptor {").count()).sum();
    assert!(described > 30, "{described}");
    let missing: Vec<String> = (all.iter())
        .flat_map(|(path, source)| unlabelled(source).into_iter().map(move |what| format!("{path}:{what}")))
        .collect();
    assert!(missing.is_empty(), "without a label:\n{}", missing.join("\n"));
}

#[test]
fn the_scan_sees_what_has_no_label() {
    assert!(unlabelled("a(&wgpu::BufferDescriptor { label: Some(x), size: f(1) });").is_empty());
    assert!(unlabelled("a(&wgpu::TextureViewDescriptor { label, ..Default::default() });").is_empty());
    assert_eq!(unlabelled("a(&wgpu::BufferDescriptor { size: 1, b: B { label: Some(x) } });").len(), 1);
    assert_eq!(unlabelled("\ntexture.create_view(&Default::default());"), ["2: (&Default::default())"]);
    assert_eq!(unlabelled("a(&BufferDescriptor { label: None, size: 1 });").len(), 1);
}
