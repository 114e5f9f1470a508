//! Checks how files are laid out; see `scripts/check-style`.

use std::path::Path;
use std::process::ExitCode;

use avatar_tests::style::check_workspace;

fn main() -> ExitCode {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    match check_workspace(&workspace) {
        Ok(findings) if findings.is_empty() => ExitCode::SUCCESS,
        Ok(findings) => {
            for finding in &findings {
                println!("{finding}");
            }
            eprintln!("{} findings", findings.len());
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{}: {error}", workspace.display());
            ExitCode::FAILURE
        }
    }
}
