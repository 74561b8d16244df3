//! The devices of a machine.

use crate::access;
use crate::camera::{Camera, Details};
use crate::port::{Port, ports};
use std::path::{Path, PathBuf};

/// All devices that Limn could use.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Listing {
    /// By the number of their node.
    pub cameras: Vec<Camera>,
    /// By name.
    pub ports: Vec<Port>,
}

/// Lists what is under `root` (`/` but for tests). `inspect` opens a camera's node and says what it can do, or why that
/// cannot be told; none for what is no camera: most cameras have a second node, for data about their pictures.
pub fn list(root: &Path, mut inspect: impl FnMut(&Path) -> Option<Result<Details, String>>) -> Listing {
    let mut cameras: Vec<Camera> = Vec::new();
    for system in entries(&root.join("sys/class/video4linux")) {
        let Some(node) = system.file_name().map(|name| root.join("dev").join(name)) else { continue };
        if !node.to_string_lossy().contains("video") {
            continue;
        }
        let missing = access::missing(&node);
        let details = match &missing {
            Some(_) => Some(Err("it may not be opened".to_owned())),
            None => inspect(&node),
        };
        let Some(details) = details else { continue };
        let name = std::fs::read_to_string(system.join("name")).unwrap_or_default().trim().to_owned();
        let path = stable_name(&[root.join("dev/v4l/by-id"), root.join("dev/v4l/by-path")], &node);
        cameras.push(Camera { path, node, name, missing, details });
    }
    Listing { cameras, ports: ports(root) }
}

/// For [`list`], where no code for cameras is built in.
pub fn not_built_in(_: &Path) -> Option<Result<Details, String>> {
    Some(Err("this limn was built without cameras: `cargo build --release --features v4l` (needs libclang)".to_owned()))
}

/// What is in a folder, by name, with numbers in their order; nothing when there is no such folder.
pub(crate) fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(read) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut found: Vec<PathBuf> = read.flatten().map(|entry| entry.path()).collect();
    found.sort_by_key(|path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let letters = name.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
        let number: u64 = name[letters.len()..].parse().unwrap_or_default();
        (letters, number, name)
    });
    found
}

/// The first link in these folders that leads to a node; else the node itself.
pub(crate) fn stable_name(folders: &[PathBuf], node: &Path) -> PathBuf {
    let leads_here = |link: &PathBuf| match (link.canonicalize(), node.canonicalize()) {
        (Ok(end), Ok(node)) => end == node,
        _ => false,
    };
    folders.iter().flat_map(|folder| entries(folder)).find(leads_here).unwrap_or_else(|| node.to_owned())
}
