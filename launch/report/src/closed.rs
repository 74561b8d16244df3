//! Whether the model is closed, and what of it nobody measured.

use geometry::{Distances, TriangleMesh};
use serde::{Deserialize, Serialize};
use wire::Mesh;

/// The final surface with the caps over what nobody saw.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Closed {
    /// Every edge has two triangles that agree on which side is out: it can be printed.
    pub watertight: bool,
    /// Edges of triangles for which that does not hold.
    pub open_edges: usize,
    /// The share of its area that nobody measured, 0..1.
    pub unmeasured_share: f64,
    /// From those caps to the truth.
    pub caps_to_truth: Option<Distances>,
    /// From the whole of it to the truth: root mean square.
    pub rms_mm: Option<f64>,
}

/// What can be said of a surface without its truth; `None` of an empty one.
pub fn closed(mesh: &Mesh) -> Option<Closed> {
    let whole = TriangleMesh::from(mesh);
    let (area, open_edges) = (whole.area(), whole.open_edges());
    (area > 0.0).then(|| Closed {
        watertight: open_edges == 0,
        open_edges,
        unmeasured_share: caps(mesh).area() / area,
        caps_to_truth: None,
        rms_mm: None,
    })
}

/// The caps alone, on the vertices of the whole.
pub fn caps(mesh: &Mesh) -> TriangleMesh {
    let mut caps = TriangleMesh::from(mesh);
    caps.triangles.drain(..caps.triangles.len().min(mesh.measured as usize));
    caps
}

impl Closed {
    /// With what is known of the truth: the distances of the caps, if there are any, and of what was measured.
    pub fn against(self, caps: Option<Distances>, measured: &Distances) -> Self {
        let share = self.unmeasured_share;
        let squares = measured.rms_mm.powi(2) * (1.0 - share) + caps.map_or(0.0, |caps| caps.rms_mm.powi(2)) * share;
        Self { caps_to_truth: caps, rms_mm: Some(squares.sqrt()), ..self }
    }
}
