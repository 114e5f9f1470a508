//! Prints or checks who imports whom; see `scripts/imports`.

use std::path::Path;
use std::process::ExitCode;

use avatar_tests::imports::{Graph, circles, dependencies, order_that_fits, read_crates, rooms};

const USAGE: &str = "usage: imports [--check] [CRATE...]";

fn main() -> ExitCode {
    let (flags, wanted): (Vec<_>, Vec<_>) =
        std::env::args().skip(1).partition(|argument| argument.starts_with('-'));
    let check = flags.iter().any(|flag| flag == "--check");
    if flags.iter().any(|flag| flag != "--check") {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    }
    match run(check, &wanted) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(findings) => {
            eprintln!("{findings} findings");
            if check { ExitCode::FAILURE } else { ExitCode::SUCCESS }
        }
        Err(message) => {
            eprintln!("imports: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Prints the graphs unless only `check` is wanted, then all findings. Returns their number.
fn run(check: bool, wanted: &[String]) -> Result<usize, String> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let crates = read_crates(&workspace).map_err(|error| format!("{}: {error}", workspace.display()))?;
    if let Some(unknown) = wanted.iter().find(|name| !crates.iter().any(|krate| krate.name == **name)) {
        return Err(format!("there is no crate {unknown}"));
    }
    let mut count = 0;
    for krate in crates.iter().filter(|krate| wanted.is_empty() || wanted.contains(&krate.name)) {
        for root in ["lib.rs", "main.rs"].into_iter().filter(|root| krate.files.contains_key(*root)) {
            let graph =
                Graph::read(&krate.files, root).map_err(|error| format!("{}: {error}", krate.name))?;
            let (against, circles) = (rooms(&graph), circles(&graph));
            if !check {
                print_graph(&krate.name, root, &graph);
            }
            for circle in &circles {
                println!("{}: {circle}", krate.name);
            }
            for finding in &against {
                println!("crates/{}/src/{finding}", krate.name);
            }
            if !against.is_empty() {
                println!(
                    "    An order of {}/src/{root} that fits: {}",
                    krate.name,
                    order_that_fits(&graph).join(", ")
                );
            }
            count += circles.len() + against.len();
        }
    }
    if wanted.is_empty() {
        let path = workspace.join("ARCHITECTURE.md");
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let manifests: Vec<_> =
            crates.iter().map(|krate| (krate.name.as_str(), krate.manifest.as_str())).collect();
        let findings = dependencies(&text, &manifests);
        for finding in &findings {
            println!("{finding}");
        }
        count += findings.len();
    }
    Ok(count)
}

fn print_graph(name: &str, root: &str, graph: &Graph) {
    println!("{name}, from src/{root}:");
    for file in 0..graph.file_count() {
        let imported: Vec<_> = graph.imported_by(file).map(|to| graph.name(to)).collect();
        if !imported.is_empty() {
            println!("    {} → {}", graph.name(file), imported.join(", "));
        }
    }
}
