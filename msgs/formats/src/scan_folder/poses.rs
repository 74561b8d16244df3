//! poses.csv: where the handset was.

use super::seconds;
use crate::Reason;
use crate::table::{Row, Table, Unknown};
use geometry::{rigid_from_wire, rigid_to_wire};
use std::path::Path;
use wire::{Header, Pose, Quality, RigidPose};

pub(super) const REQUIRED: [&str; 8] = ["stamp_s", "x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"];
pub(super) const OPTIONAL: [&str; 3] = ["position_sigma_m", "rotation_sigma_rad", "rotation_lag_s"];

/// One standard deviation of a position along each axis, where the file does not say: a good robot's or optical tracker's.
pub const POSITION_SIGMA_M: f64 = 0.3e-3;
/// One standard deviation of a rotation about each axis, where the file does not say.
pub const ROTATION_SIGMA_RAD: f64 = 0.5e-3;

/// A quaternion with few digits is still taken; one that is farther from unit length is some other four numbers.
const UNIT_TOLERANCE: f64 = 1e-2;

pub(super) fn read(path: &Path) -> Result<Vec<Pose>, Reason> {
    let table = Table::read(path, &REQUIRED, &OPTIONAL, Unknown::Refused)?;
    let mut poses: Vec<Pose> = Vec::new();
    for row in table.rows() {
        let pose = pose(&row, poses.len() as u64)?;
        if poses.last().is_some_and(|before| before.header.stamp_nanos >= pose.header.stamp_nanos) {
            return Err(row.cell("stamp_s", "is not later than the line before"));
        }
        poses.push(pose);
    }
    if poses.is_empty() { Err(Reason::syntax("lists no poses")) } else { Ok(poses) }
}

fn pose(row: &Row<'_>, seq: u64) -> Result<Pose, Reason> {
    let stamp = row.needed("stamp_s")?;
    let stamp_nanos = seconds::parse(stamp).ok_or_else(|| row.cell("stamp_s", format!("{stamp:?} is no time")))?;
    let translation_m = [row.number("x_m")?, row.number("y_m")?, row.number("z_m")?];
    let rotation_wxyz = [row.number("qw")?, row.number("qx")?, row.number("qy")?, row.number("qz")?];
    let length = rotation_wxyz.iter().map(|q| q * q).sum::<f64>().sqrt();
    let rigid = rigid_from_wire(&RigidPose { translation_m, rotation_wxyz });
    let rigid = rigid.filter(|_| (length - 1.0).abs() <= UNIT_TOLERANCE);
    let rigid = rigid.ok_or_else(|| row.cell("qw", format!("qw, qx, qy, qz have length {length:.4}, not 1")))?;
    let sigma = |column, default| match row.number_or(column, default)? {
        value if value >= 0.0 => Ok(value),
        value => Err(row.cell(column, format!("{value} is below 0"))),
    };
    let lag_s = row.number_or("rotation_lag_s", 0.0)?;
    if lag_s.abs() > 10.0 {
        return Err(row.cell("rotation_lag_s", format!("{lag_s} is more than 10 s")));
    }
    Ok(Pose {
        header: Header { seq, stamp_nanos, ..Header::default() },
        // Made a unit quaternion here, so that what follows need not ask again.
        world_from_body: rigid_to_wire(&rigid),
        position_sigma_m: [sigma("position_sigma_m", POSITION_SIGMA_M)?; 3],
        rotation_sigma_rad: [sigma("rotation_sigma_rad", ROTATION_SIGMA_RAD)?; 3],
        rotation_lag_nanos: (lag_s * 1e9).round() as i64,
        quality: Quality::Good,
        reason: String::new(),
    })
}
