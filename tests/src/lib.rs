//! Whole rigs as real processes on a real bus: what the tests in `tests/` share.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The program under test, beside the test that runs: `cargo test --workspace` builds both.
///
/// # Panics
/// When it has not been built.
pub fn limn() -> Command {
    let beside = std::env::current_exe().ok().and_then(|test| Some(test.parent()?.parent()?.join("limn")));
    match beside.filter(|path| path.is_file()) {
        Some(path) => Command::new(path),
        None => panic!("the program limn is not built: run `cargo test --workspace`"),
    }
}

/// Runs it to its end, and fails with all that it said unless it succeeded.
///
/// # Panics
/// When it fails.
pub fn succeed(command: &mut Command) -> Output {
    match command.output() {
        Ok(output) if output.status.success() => output,
        Ok(output) => panic!(
            "{command:?} failed with {}\n{}\n{}",
            output.status,
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        ),
        Err(error) => panic!("{command:?}: {error}"),
    }
}

/// The numbers of a run.
///
/// # Panics
/// When there are none.
pub fn report(out: &Path) -> serde_json::Value {
    let path = out.join("report.json");
    match std::fs::read(&path).map_err(anyhow::Error::from).and_then(|text| Ok(serde_json::from_slice(&text)?)) {
        Ok(report) => report,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

/// Real data that is not part of the project, where there is some; says so where there is none.
pub fn shared_data(name: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data").join(name);
    if !path.is_dir() {
        eprintln!("SKIPPED: {} is not there, so nothing of it was tested", path.display());
        return None;
    }
    Some(path)
}
