//! Points: the thinned cloud with all that is known of each ball, and the bare points of others.

use crate::ply::{Column, Ply, PlyWriter, Table as PlyTable};
use crate::table::{Row, Table, Unknown};
use crate::{FormatError, Reason, write_whole};
use std::io::{self, Write};
use std::path::Path;
use wire::CloudPoint;

/// The endings that [`read`] understands.
pub const KNOWN: &str = "ply, xyz, csv";

const UNITS: &str = "limn: metres, z up; sigma_m: of the mean along the normal; spread_m: rms distance of count points";
const POSITION: [&str; 3] = ["x", "y", "z"];
const NORMAL: [&str; 3] = ["nx", "ny", "nz"];
const COLOUR: [&str; 3] = ["red", "green", "blue"];

/// Writes a cloud, in metres. Colours stand there when any point has one; `coloured` is then 255 for those that have.
pub fn write_ply(path: &Path, points: &[CloudPoint]) -> Result<(), FormatError> {
    if points.is_empty() {
        return Err(Reason::Empty("the cloud has no points").of(path));
    }
    write_whole(path, |out| Ok(ply(out, points)?))
}

fn ply(out: &mut impl Write, points: &[CloudPoint]) -> io::Result<()> {
    let coloured = points.iter().any(|p| p.colour[3] != 0);
    let mut ply = PlyWriter::begin(out, &[UNITS])?;
    ply.element("vertex", points.len())?;
    ply.properties("float", &[POSITION, NORMAL].concat())?;
    ply.properties("float", &["spread_m", "sigma_m"])?;
    ply.properties("uint", &["count", "id"])?;
    if coloured {
        ply.properties("uchar", &COLOUR)?;
        ply.properties("uchar", &["coloured"])?;
    }
    ply.end_header()?;
    for p in points {
        ply.values(&[p.position_m, p.normal])?;
        ply.values(&[p.spread_m, p.sigma_m])?;
        ply.values(&[p.count, p.id])?;
        if coloured {
            ply.values(&p.colour)?;
        }
    }
    Ok(())
}

/// Reads points; the format is told by the ending of the name.
///
/// * ply: what [`write_ply`] writes, or any other's vertices;
/// * xyz: lines of `x y z`, or `x y z nx ny nz`, or `x y z nx ny nz red green blue` (0..255); lines with `#` are comments;
/// * csv: columns named x, y, z and perhaps nx, ny, nz, red, green, blue, count, sigma_m, spread_m, id; others are skipped.
///
/// What a file does not say is 0 (a zero normal is an unknown one), but for `count`, which is 1, and `id`, which is the
/// place in the file. Numbers are those of the file; positions that are not finite are refused.
pub fn read(path: &Path) -> Result<Vec<CloudPoint>, FormatError> {
    read_points(path).map_err(|reason| reason.of(path))
}

fn read_points(path: &Path) -> Result<Vec<CloudPoint>, Reason> {
    let found = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let points = match found.as_str() {
        "ply" => from_ply(&std::fs::read(path)?)?,
        "xyz" => from_xyz(&std::fs::read(path)?)?,
        "csv" => from_csv(path)?,
        _ => return Err(Reason::Extension { found, known: KNOWN }),
    };
    if points.is_empty() {
        return Err(Reason::syntax("holds no points"));
    }
    if let Some(bad) = points.iter().position(|p| !p.position_m.iter().chain(&p.normal).all(|c| c.is_finite())) {
        return Err(Reason::syntax(format!("point {bad} is not finite")));
    }
    Ok(points)
}

fn bare(position_m: [f32; 3], place: usize) -> CloudPoint {
    CloudPoint { position_m, count: 1, id: place as u32, ..CloudPoint::default() }
}

fn from_ply(bytes: &[u8]) -> Result<Vec<CloudPoint>, Reason> {
    let ply = Ply::parse(bytes)?;
    let table = ply.table("vertex").ok_or_else(|| Reason::syntax("has no element \"vertex\""))?;
    let position = table.scalars(POSITION).ok_or_else(|| Reason::syntax("its vertices have no x, y, z"))?;
    let (normal, colour) = (table.scalars(NORMAL), table.scalars(COLOUR));
    let scalar = |table: &PlyTable, name: &str, row: usize| table.scalar(name).map(|c| c.values[row]);
    let triple = |columns: [&Column; 3], row: usize| columns.map(|c| c.values[row] as f32);
    let point = |row: usize| {
        let mut point = bare(triple(position, row), row);
        point.normal = normal.map_or([0.0; 3], |n| triple(n, row));
        if let Some([r, g, b]) = colour.map(|c| c.map(|c| c.byte(row))) {
            point.colour = [r, g, b, scalar(table, "coloured", row).map_or(255, |c| c as u8)];
        }
        point.spread_m = scalar(table, "spread_m", row).unwrap_or(0.0) as f32;
        point.sigma_m = scalar(table, "sigma_m", row).unwrap_or(0.0) as f32;
        point.count = scalar(table, "count", row).map_or(point.count, |c| c as u32);
        point.id = scalar(table, "id", row).map_or(point.id, |c| c as u32);
        point
    };
    Ok((0..table.rows).map(point).collect())
}

fn from_xyz(bytes: &[u8]) -> Result<Vec<CloudPoint>, Reason> {
    let mut points = Vec::new();
    for (number, line) in bytes.split(|&b| b == b'\n').enumerate() {
        let bad = |what: String| Reason::Line { line: number + 1, what };
        let text = std::str::from_utf8(line).map_err(|_| bad("is not text".into()))?.trim();
        if text.is_empty() || text.starts_with('#') || text.starts_with("//") {
            continue;
        }
        let number = |word: &str| word.parse::<f32>().map_err(|_| bad(format!("{word:?} is no number")));
        let values: Vec<f32> = text.split_ascii_whitespace().map(number).collect::<Result<_, _>>()?;
        let point = xyz_point(&values, points.len());
        points.push(point.ok_or_else(|| bad(format!("{} numbers, where 3, 6 or 9 are understood", values.len())))?);
    }
    Ok(points)
}

fn xyz_point(values: &[f32], place: usize) -> Option<CloudPoint> {
    let triple = |at: usize| Some([*values.get(at)?, *values.get(at + 1)?, *values.get(at + 2)?]);
    let mut point = bare(triple(0)?, place);
    match values.len() {
        3 => {}
        6 => point.normal = triple(3)?,
        9 => {
            point.normal = triple(3)?;
            let [r, g, b] = triple(6)?.map(|c| c.round() as u8);
            point.colour = [r, g, b, 255];
        }
        _ => return None,
    }
    Some(point)
}

fn from_csv(path: &Path) -> Result<Vec<CloudPoint>, Reason> {
    let optional = [&NORMAL[..], &COLOUR, &["count", "sigma_m", "spread_m", "id"]].concat();
    let table = Table::read(path, &POSITION, &optional, Unknown::Skipped)?;
    let triple = |row: &Row<'_>, names: [&'static str; 3]| -> Result<[f32; 3], Reason> {
        Ok([
            row.number_or(names[0], 0.0)? as f32,
            row.number_or(names[1], 0.0)? as f32,
            row.number_or(names[2], 0.0)? as f32,
        ])
    };
    let point = |(place, row): (usize, Row<'_>)| {
        let position = [row.number("x")? as f32, row.number("y")? as f32, row.number("z")? as f32];
        let mut point = bare(position, place);
        point.normal = triple(&row, NORMAL)?;
        if row.text("red").is_some() {
            let [r, g, b] = triple(&row, COLOUR)?.map(|c| c.round() as u8);
            point.colour = [r, g, b, 255];
        }
        point.count = row.number_or("count", 1.0)? as u32;
        point.sigma_m = row.number_or("sigma_m", 0.0)? as f32;
        point.spread_m = row.number_or("spread_m", 0.0)? as f32;
        point.id = row.number_or("id", place as f64)? as u32;
        Ok(point)
    };
    table.rows().enumerate().map(point).collect()
}
