//! The rigs that are up on this machine: a file for each, so that `limn scan` and its like find them.

use anyhow::{Context as _, Result, bail};
use bus::BusConfig;
use serde::{Deserialize, Serialize};
use std::os::unix::fs::{DirBuilderExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// A rig that is up.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Running {
    /// What it is called: the stem of its launch file.
    pub name: String,
    /// How to reach its bus.
    pub bus: BusConfig,
    /// Its launcher.
    pub pid: u32,
    /// When that process started, in the kernel's ticks: a number that is used again is another process.
    pub started_ticks: u64,
}

/// Removes its file when it is dropped.
pub struct Announced(PathBuf);

impl Drop for Announced {
    fn drop(&mut self) {
        // It may have been removed by hand.
        let _ = std::fs::remove_file(&self.0);
    }
}

/// `$XDG_RUNTIME_DIR/limn`, or `/tmp/limn-UID`; only its owner may enter.
pub fn folder() -> Result<PathBuf> {
    let uid = rustix::process::getuid().as_raw();
    let path = match std::env::var_os("XDG_RUNTIME_DIR").filter(|dir| Path::new(dir).is_dir()) {
        Some(dir) => Path::new(&dir).join("limn"),
        None => PathBuf::from(format!("/tmp/limn-{uid}")),
    };
    std::fs::DirBuilder::new()
        .mode(0o700)
        .recursive(true)
        .create(&path)
        .with_context(|| format!("{}", path.display()))?;
    let about = std::fs::symlink_metadata(&path).with_context(|| format!("{}", path.display()))?;
    if !about.is_dir() || about.uid() != uid || about.mode() & 0o022 != 0 {
        bail!("{} belongs to somebody else, or others may write to it", path.display());
    }
    Ok(path)
}

/// Tells the other commands that a rig is up. Two of the same name cannot be.
pub fn announce(folder: &Path, name: &str, bus: &BusConfig) -> Result<Announced> {
    let path = folder.join(format!("{name}.json"));
    if let Some(other) = read(&path).filter(Running::is_alive) {
        bail!(
            "a rig {name:?} is up already (process {}); stop it, or launch from a copy under another name",
            other.pid
        );
    }
    let pid = std::process::id();
    let started_ticks = started_ticks(pid).context("reading /proc")?;
    let running = Running { name: name.to_owned(), bus: bus.clone(), pid, started_ticks };
    let text = serde_json::to_vec_pretty(&running)?;
    let fresh = folder.join(format!(".{name}.{pid}"));
    let mut options = std::fs::OpenOptions::new();
    let mut file = options.create(true).write(true).truncate(true).mode(0o600).open(&fresh)?;
    std::io::Write::write_all(&mut file, &text)?;
    std::fs::rename(&fresh, &path).with_context(|| format!("writing {}", path.display()))?;
    Ok(Announced(path))
}

/// The rig of a name, or the only one that is up.
pub fn find(folder: &Path, name: Option<&str>) -> Result<Running> {
    let mut rigs = all(folder)?;
    let names = rigs.iter().map(|rig| rig.name.clone()).collect::<Vec<_>>().join(", ");
    match (name, rigs.len()) {
        (_, 0) => bail!("no rig is up on this machine: start one with `limn up FILE`"),
        (Some(name), _) => match rigs.into_iter().find(|rig| rig.name == name) {
            Some(rig) => Ok(rig),
            None => bail!("no rig {name:?} is up; {names} is"),
        },
        (None, 1) => Ok(rigs.remove(0)),
        (None, _) => bail!("several rigs are up ({names}): say which with --rig NAME"),
    }
}

/// All rigs that are up. What a launcher left behind that was killed is cleared away.
pub fn all(folder: &Path) -> Result<Vec<Running>> {
    let mut rigs = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(|| format!("{}", folder.display()))? {
        let path = entry?.path();
        if path.extension().is_none_or(|extension| extension != "json") {
            continue;
        }
        match read(&path) {
            Some(rig) if rig.is_alive() => rigs.push(rig),
            _ => {
                let _ = std::fs::remove_file(&path);
            }
        }
    }
    rigs.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(rigs)
}

fn read(path: &Path) -> Option<Running> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

impl Running {
    fn is_alive(&self) -> bool {
        started_ticks(self.pid) == Some(self.started_ticks)
    }
}

/// Field 22 of /proc/PID/stat, proc(5).
fn started_ticks(pid: u32) -> Option<u64> {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    stat.rsplit_once(')')?.1.split_whitespace().nth(19)?.parse().ok()
}
