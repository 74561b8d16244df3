//! Serial ports.

use crate::access;
use crate::listing::{entries, stable_name};
use std::path::{Path, PathBuf};

/// A serial port that is there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Port {
    /// The name for a launch file: one that stays the same, where there is one.
    pub path: PathBuf,
    /// The name that it has got this time.
    pub node: PathBuf,
    /// Maker and name of the adapter; none for a port that is built in.
    pub usb_name: Option<String>,
    /// What to do before this user may open it; none when it is open to him.
    pub missing: Option<String>,
}

/// Between a port and its adapter lie the port's device and the adapter's interface.
const LEVELS: usize = 4;

pub(crate) fn ports(root: &Path) -> Vec<Port> {
    entries(&root.join("sys/class/tty"))
        .into_iter()
        .filter_map(|system| {
            let name = system.file_name()?.to_str()?.to_owned();
            if !is_real(&system, &name) {
                return None;
            }
            let node = root.join("dev").join(&name);
            Some(Port {
                path: stable_name(&[root.join("dev/serial/by-id"), root.join("dev/serial/by-path")], &node),
                missing: access::missing(&node),
                usb_name: usb_name(&system),
                node,
            })
        })
        .collect()
}

/// The kernel keeps names for built-in ports that are not there (their type is 0), and every terminal is here as well.
fn is_real(system: &Path, name: &str) -> bool {
    let read = |file: &str| std::fs::read_to_string(system.join(file)).unwrap_or_default();
    let built_in = name.starts_with("ttyS") && !matches!(read("type").trim(), "" | "0");
    built_in || ["ttyUSB", "ttyACM", "ttyAMA"].iter().any(|kind| name.starts_with(kind))
}

fn usb_name(system: &Path) -> Option<String> {
    let device = system.join("device").canonicalize().ok()?;
    device.ancestors().take(LEVELS).find_map(|folder| {
        let product = std::fs::read_to_string(folder.join("product")).ok()?;
        let maker = std::fs::read_to_string(folder.join("manufacturer")).unwrap_or_default();
        Some(format!("{} {}", maker.trim(), product.trim()).trim().to_owned())
    })
}
