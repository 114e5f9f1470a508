//! The documents stay true: names in diagrams exist, links lead somewhere, and the READMEs' programs run.
#![allow(clippy::expect_used, clippy::panic, reason = "helpers of tests")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().expect("the workspace")
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// All Rust source of a crate.
fn source_of(krate: &str) -> String {
    let mut folders = vec![root().join("crates").join(krate).join("src")];
    let mut source = String::new();
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of source") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                source += &fs::read_to_string(path).expect("source");
            }
        }
    }
    source
}

/// Whether a type, function, field or variant of this name is declared.
fn declares(source: &str, name: &str) -> bool {
    let starts = [format!("struct {name}"), format!("enum {name}"), format!("fn {name}")];
    let ends_word = |rest: &str| !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_');
    let item = starts
        .iter()
        .any(|start| source.match_indices(start).any(|(at, _)| ends_word(&source[at + start.len()..])));
    let field = source.lines().map(str::trim).any(|line| {
        let line = line.trim_start_matches("pub(crate) ").trim_start_matches("pub ");
        line.strip_prefix(name).is_some_and(|rest| rest.starts_with([':', ',', '(', ' ']))
    });
    item || field
}

#[test]
fn every_name_in_the_class_diagrams_exists() {
    let text = read("docs/uml.md");
    let mut names = 0;
    for section in text.split("\n## ").skip(1) {
        let krate = section.lines().next().expect("a heading").trim();
        let source = source_of(krate);
        let diagram =
            section.split("```mermaid").nth(1).and_then(|rest| rest.split("```").next()).expect("a diagram");
        let mut inside = false;
        for line in diagram.lines().map(str::trim) {
            let name = if let Some(class) = line.strip_prefix("class ") {
                inside = true;
                class.trim_end_matches('{').trim()
            } else if line == "}" {
                inside = false;
                continue;
            } else if inside && !line.starts_with("<<") {
                let member = line.trim_start_matches(['+', '-']);
                member.split(['(', ':', ' ']).next().expect("a member")
            } else {
                continue;
            };
            assert!(declares(&source, name), "docs/uml.md: {krate} has no {name:?}");
            names += 1;
        }
    }
    assert!(names > 60, "the diagrams were not read: {names} names");
}

#[test]
fn names_that_do_not_exist_are_noticed() {
    assert!(!declares("pub struct Rigging; fn update_all() {}", "Rig"));
    assert!(declares("pub struct Rig<'a>(u8);", "Rig"));
    assert!(declares("    pub names: Vec<String>,", "names"));
}

/// Where this test itself was built: `…/target/<profile>/deps/<test>`.
fn target_folder() -> PathBuf {
    let test = std::env::current_exe().expect("this test's file");
    test.ancestors().nth(3).expect("the target folder").to_owned()
}

/// The documents of the workspace, its crates' among them, as paths below its root.
fn documents() -> Vec<String> {
    let mut documents = vec!["README.md".to_owned(), "ARCHITECTURE.md".to_owned(), "CHANGELOG.md".to_owned()];
    for entry in fs::read_dir(root().join("docs")).expect("the documents") {
        let name = entry.expect("an entry").file_name().into_string().expect("a name");
        if name.ends_with(".md") {
            documents.push(format!("docs/{name}"));
        }
    }
    for krate in crates() {
        documents.push(format!("crates/{krate}/README.md"));
    }
    documents
}

/// The names of all crates.
fn crates() -> Vec<String> {
    let entries = fs::read_dir(root().join("crates")).expect("the crates");
    let mut names: Vec<_> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("a name")).collect();
    names.sort();
    names
}

/// Whether other people's programs use it: the programs have a clippy.toml that allows them files and clocks.
fn is_library(krate: &str) -> bool {
    let folder = root().join("crates").join(krate);
    folder.join("src/lib.rs").exists() && !folder.join("clippy.toml").exists()
}

#[test]
fn every_link_of_the_documents_leads_somewhere() {
    let mut links = 0;
    for document in documents() {
        let text = read(&document);
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let file = link.split('#').next().expect("a link");
            if file.is_empty() || file.contains("://") {
                continue;
            }
            let target = root().join(&document).parent().expect("a folder").join(file);
            assert!(target.exists(), "{document}: {link} leads nowhere");
            links += 1;
        }
    }
    assert!(links >= 40, "the documents were not read: {links} links");
}

/// The fenced blocks of a language in a text.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    text.split(&fence).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// The program of each README becomes a project outside of this workspace, with only the lines that stand
/// there, and runs. They are built together: by itself each would have other features of its dependencies,
/// and most of them to build anew; that each crate enables what it needs is seen where each is compiled by
/// itself (scripts/test).
#[test]
fn the_readmes_programs_run_in_projects_outside() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scratch = folder.path();
    #[cfg(unix)]
    std::os::unix::fs::symlink(root(), scratch.join("mimik")).expect("the repository beside the projects");
    let mut readmes = vec![("mimik".to_owned(), "README.md".to_owned())];
    for krate in crates().into_iter().filter(|krate| is_library(krate)) {
        let readme = format!("crates/{krate}/README.md");
        readmes.push((krate, readme));
    }
    assert!(readmes.len() > 12, "the crates were not found: {readmes:?}");
    let manifest = "[workspace]\nresolver = \"3\"\nmembers = [\"use-*\"]\nexclude = [\"mimik\"]\n";
    fs::write(scratch.join("Cargo.toml"), manifest).expect("a manifest");
    // The same versions as here, so that nothing has to be fetched or built twice.
    fs::copy(root().join("Cargo.lock"), scratch.join("Cargo.lock")).expect("a lock file");
    for (name, readme) in &readmes {
        let text = read(readme);
        let (toml, rust) = (blocks(&text, "toml"), blocks(&text, "rust"));
        assert_eq!((toml.len(), rust.len()), (1, 1), "{readme}: expected one manifest and one program");
        let project = scratch.join(format!("use-{name}"));
        fs::create_dir_all(project.join("src")).expect("a folder");
        let package = format!("[package]\nname = \"use-{name}\"\nedition = \"2024\"\n\n{}\n", toml[0]);
        fs::write(project.join("Cargo.toml"), package).expect("a manifest");
        fs::write(project.join("src/main.rs"), rust[0]).expect("a program");
    }

    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--offline", "--workspace"]).current_dir(scratch);
    // The workspace's own profile and folder, so that dependencies are not built a second time.
    cargo.env("CARGO_TARGET_DIR", target_folder());
    for (setting, own) in
        [("CARGO_PROFILE_DEV_OPT_LEVEL", "1"), ("CARGO_PROFILE_DEV_DEBUG", "line-tables-only")]
    {
        // Whoever runs the tests may have settled it for all builds.
        if std::env::var_os(setting).is_none() {
            cargo.env(setting, own);
        }
    }
    let output = cargo.output().expect("cargo starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));

    for (name, readme) in &readmes {
        let program =
            target_folder().join("debug").join(format!("use-{name}{}", std::env::consts::EXE_SUFFIX));
        let mut program = Command::new(program);
        let output = program.current_dir(scratch.join(format!("use-{name}"))).output().expect("it starts");
        let stderr = String::from_utf8_lossy(&output.stderr);
        let no_adapter = stderr.contains("expected a GPU adapter");
        let required = std::env::var_os("MIMIK_REQUIRE_GPU").is_some_and(|value| value == "1");
        if no_adapter && !required {
            let skipped = format_args!("SKIPPED: the program of {readme}: {stderr}\n");
            let _ = std::io::Write::write_fmt(&mut std::io::stderr(), skipped);
            continue;
        }
        assert!(output.status.success(), "{readme}: {stderr}");
        assert!(!output.stdout.is_empty(), "{readme}: its program prints something");
    }
}
