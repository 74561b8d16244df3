//! frames.csv: which picture was taken when, and what lit it.

use super::seconds;
use crate::Reason;
use crate::table::{Row, Table, Unknown};
use std::path::{Path, PathBuf};
use wire::{Header, Light, Phase};

pub(super) const REQUIRED: [&str; 3] = ["stamp_s", "phase", "file"];
pub(super) const OPTIONAL: [&str; 4] = ["light", "exposure_s", "gain", "gamma"];

/// One line of frames.csv.
#[derive(Debug, Clone, PartialEq)]
pub struct FrameEntry {
    /// Middle of the exposure.
    pub stamp_nanos: i64,
    /// What the operator was doing.
    pub phase: Phase,
    /// The picture.
    pub path: PathBuf,
    /// What lit it.
    pub light: Light,
    /// How long the shutter was open; 0 when the file does not say.
    pub exposure_nanos: i64,
    /// Linear gain of the camera, 1 = none.
    pub gain: f32,
    /// Exponent that the camera applied, 1 = none.
    pub gamma: f32,
}

impl FrameEntry {
    /// The header of the picture at this place of the list.
    pub(super) fn header(&self, index: usize) -> Header {
        Header { phase: self.phase, seq: index as u64, stamp_nanos: self.stamp_nanos, ..Header::default() }
    }
}

/// What lights a picture when the file does not say.
pub(super) fn default_light(phase: Phase) -> Light {
    let lamp = phase == Phase::Colour;
    Light { laser: !lamp, lamp }
}

const PHASES: [(&str, Phase); 4] =
    [("aim", Phase::Aim), ("shape", Phase::Shape), ("colour", Phase::Colour), ("both", Phase::Both)];
const LIGHTS: [(&str, Light); 4] = [
    ("laser", Light { laser: true, lamp: false }),
    ("lamp", Light { laser: false, lamp: true }),
    ("both", Light { laser: true, lamp: true }),
    ("none", Light { laser: false, lamp: false }),
];

/// The word for a phase; `None` for the end, which is no picture.
pub(super) fn phase_word(phase: Phase) -> Option<&'static str> {
    PHASES.iter().find(|(_, known)| *known == phase).map(|(word, _)| *word)
}

/// The word for what lit a picture.
pub(super) fn light_word(light: Light) -> &'static str {
    LIGHTS.iter().find(|(_, known)| *known == light).map_or("none", |(word, _)| word)
}

pub(super) fn read(path: &Path, folder: &Path) -> Result<Vec<FrameEntry>, Reason> {
    let table = Table::read(path, &REQUIRED, &OPTIONAL, Unknown::Refused)?;
    let mut frames: Vec<FrameEntry> = Vec::new();
    for row in table.rows() {
        let entry = entry(&row, folder)?;
        if frames.last().is_some_and(|before| before.stamp_nanos >= entry.stamp_nanos) {
            return Err(row.cell("stamp_s", "is not later than the line before"));
        }
        frames.push(entry);
    }
    if frames.is_empty() { Err(Reason::syntax("lists no pictures")) } else { Ok(frames) }
}

fn entry(row: &Row<'_>, folder: &Path) -> Result<FrameEntry, Reason> {
    let stamp = row.needed("stamp_s")?;
    let stamp_nanos = seconds::parse(stamp).ok_or_else(|| row.cell("stamp_s", format!("{stamp:?} is no time")))?;
    let phase = word(row, "phase", &PHASES)?.ok_or_else(|| row.cell("phase", "is empty"))?;
    let file = row.needed("file")?;
    let path = folder.join(file.replace('\\', "/"));
    if !path.is_file() {
        return Err(row.cell("file", format!("{file:?} is not there (looked for {})", path.display())));
    }
    let positive = |column, default| match row.number_or(column, default)? {
        value if value > 0.0 => Ok(value),
        value => Err(row.cell(column, format!("{value} is not above 0"))),
    };
    let exposure_s = row.number_or("exposure_s", 0.0)?;
    if !(0.0..3600.0).contains(&exposure_s) {
        return Err(row.cell("exposure_s", format!("{exposure_s} is no exposure")));
    }
    Ok(FrameEntry {
        stamp_nanos,
        phase,
        path,
        light: word(row, "light", &LIGHTS)?.unwrap_or(default_light(phase)),
        exposure_nanos: (exposure_s * 1e9).round() as i64,
        gain: positive("gain", 1.0)? as f32,
        gamma: positive("gamma", 1.0)? as f32,
    })
}

fn word<T: Copy>(row: &Row<'_>, column: &'static str, words: &[(&str, T)]) -> Result<Option<T>, Reason> {
    let Some(text) = row.text(column) else { return Ok(None) };
    let found = words.iter().find(|(word, _)| *word == text).map(|(_, value)| *value);
    found.map(Some).ok_or_else(|| {
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        row.cell(column, format!("{text:?} is not one of {}", known.join(", ")))
    })
}
