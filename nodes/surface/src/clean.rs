//! From the raw zero set to a mesh that others can use.

use crate::Config;
use crate::ground::Ground;
use crate::sheet::Sheet;
use crate::{calm, flips, holes, slivers, topology};
use geometry::METRES_PER_MM;

/// Cuts bow-ties, drops islands, fills holes, collapses or flips slivers, smooths saws. Afterwards no edge has more than two triangles, and
/// the triangles at a vertex form one fan.
pub fn clean(sheet: &mut Sheet, config: &Config, cell_m: f32, ground: Option<&Ground>) {
    topology::split_bow_ties(sheet);
    topology::drop_islands(sheet, (config.drop_islands_mm * METRES_PER_MM) as f32);
    holes::fill(sheet, config.fill_holes_mm * METRES_PER_MM, ground);
    slivers::collapse(sheet, cell_m);
    flips::flip(sheet);
    calm::calm(sheet);
    sheet.compact();
    sheet.complete_normals();
}
