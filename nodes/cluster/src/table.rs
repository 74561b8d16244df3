//! The table on which the thing stands, taken away: the paper cut its cow out by hand.

use geometry::{Facing, Table, TableSearch};
use nalgebra::{Point3, Vector3};
use wire::{CloudPoint, TablePlane};

/// A ball within 2 mm of a plane, with a normal that is nearly the plane's (what touches the table has other normals).
const SEARCH: TableSearch = TableSearch {
    near_m: 2e-3,
    least_facing: 0.9,
    least_share: 0.05,
    most_behind: 0.02,
    trials: 1500,
    looked_at: 4000,
};
/// So far from the table, in multiples of its own roughness, a ball belongs to the thing; and at least so far.
const MARGIN_RMS: f64 = 5.0;
const LEAST_MARGIN_M: f64 = 4e-4;

/// Takes away the balls that lie on the table or behind it, and tells where it is. `None` without a table.
pub fn take_away(balls: &mut Vec<CloudPoint>) -> Option<TablePlane> {
    let at = |ball: &CloudPoint| Point3::from(ball.position_m).cast();
    let facing = |ball: &CloudPoint| Facing { position: at(ball), towards: Vector3::from(ball.normal).cast() };
    let seen: Vec<Facing> = balls.iter().map(facing).collect();
    let table = Table::find(&seen, &SEARCH)?;
    let margin_m = (MARGIN_RMS * table.rms_m).max(LEAST_MARGIN_M);
    balls.retain(|ball| table.height_m(&at(ball)) > margin_m);
    Some(TablePlane { normal: table.normal.into(), distance_m: table.distance_m })
}
