//! A launch file with all that it includes.

use crate::file;
use crate::setting::{Settings, Value, merge};
use anyhow::{Context as _, Result, bail};
use std::path::{Path, PathBuf};

/// Reads `path`. What it includes (a path beside it, or a list of them) comes first and is overruled by what it says itself.
pub fn load(path: &Path) -> Result<Settings> {
    load_below(path, &mut Vec::new())
}

fn load_below(path: &Path, above: &mut Vec<PathBuf>) -> Result<Settings> {
    let text =
        std::fs::read_to_string(path).with_context(|| format!("cannot read the launch file {}", path.display()))?;
    let identity = path.canonicalize().with_context(|| format!("cannot find {}", path.display()))?;
    if above.contains(&identity) {
        bail!("{} includes itself, by way of {}", path.display(), list(above));
    }
    above.push(identity);
    let mut own = file::parse(path, &text)?;
    let mut whole = Settings::new();
    for (included, origin) in includes(&mut own)? {
        let beside = path.parent().unwrap_or(Path::new("")).join(included);
        let below = load_below(&beside, above).with_context(|| format!("{origin}: include {}", beside.display()))?;
        merge(&mut whole, below);
    }
    merge(&mut whole, own);
    above.pop();
    Ok(whole)
}

fn includes(settings: &mut Settings) -> Result<Vec<(String, String)>> {
    let Some(setting) = settings.remove("include") else { return Ok(Vec::new()) };
    let origin = setting.origin.to_string();
    let paths = match setting.value {
        Value::Leaf(toml::Value::String(path)) => vec![toml::Value::String(path)],
        Value::Leaf(toml::Value::Array(paths)) => paths,
        _ => bail!("{origin}: include takes a path or a list of paths"),
    };
    paths
        .into_iter()
        .map(|path| match path {
            toml::Value::String(path) => Ok((path, origin.clone())),
            other => bail!("{origin}: include names {other}, which is no path"),
        })
        .collect()
}

fn list(paths: &[PathBuf]) -> String {
    paths.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join(", ")
}
