//! What the demo needs is inside the program, so that one file is all there is to copy to the next machine. It is laid
//! out beside the result: there it can be read, changed, and started again with `limn up`.

use anyhow::{Context as _, Result};
use std::path::{Path, PathBuf};

const FILES: [(&str, &str); 11] = [
    ("launch/demo.toml", include_str!("../../demo.toml")),
    ("launch/pipeline.toml", include_str!("../../pipeline.toml")),
    ("config/rigs/fine.toml", include_str!("../../../config/rigs/fine.toml")),
    ("config/rigs/paper.toml", include_str!("../../../config/rigs/paper.toml")),
    ("config/rigs/field.toml", include_str!("../../../config/rigs/field.toml")),
    ("config/rigs/mixed.toml", include_str!("../../../config/rigs/mixed.toml")),
    ("config/rigs/flock.toml", include_str!("../../../config/rigs/flock.toml")),
    ("config/rigs/rough.toml", include_str!("../../../config/rigs/rough.toml")),
    ("config/scenes/cow.toml", include_str!("../../../config/scenes/cow.toml")),
    ("config/scenes/one_way.toml", include_str!("../../../config/scenes/one_way.toml")),
    ("config/scenes/tabletop.toml", include_str!("../../../config/scenes/tabletop.toml")),
];

/// Writes what the demo needs, and returns the launch file.
pub fn lay_out(out: &Path) -> Result<PathBuf> {
    write(out, &FILES)
}

/// Writes files into a folder, and returns the path of the first.
pub fn write(out: &Path, files: &[(&str, &str)]) -> Result<PathBuf> {
    for (name, text) in files {
        let path = out.join(name);
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).with_context(|| format!("making the folder {}", folder.display()))?;
        }
        std::fs::write(&path, text).with_context(|| format!("writing {}", path.display()))?;
    }
    Ok(files.first().map(|(name, _)| out.join(name)).unwrap_or_default())
}

/// A scene by its name, or a file.
pub fn scene(out: &Path, name: &str) -> PathBuf {
    named(out, "config/scenes", name)
}

/// A rig by its name, or a file.
pub fn rig(out: &Path, name: &str) -> PathBuf {
    named(out, "config/rigs", name)
}

fn named(out: &Path, folder: &str, name: &str) -> PathBuf {
    let own = format!("{folder}/{name}.toml");
    if FILES.iter().any(|(file, _)| *file == own) { out.join(own) } else { PathBuf::from(name) }
}
