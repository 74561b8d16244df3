//! The surface (paper, section 2.4: the zero set).

use crate::layout::{layout, message};
use crate::{Bulk, Header};

layout! {
    /// The whole surface as triangles, counter-clockwise seen from outside. What was measured comes first; what only closes it
    /// stands behind, with vertices that come behind all others.
    pub struct Mesh {
        /// The stamp is the latest scan's that went in; phase `End` marks the final one.
        pub header: Header,
        /// In the world, in metres.
        pub vertices_m: Bulk<[f32; 3]>,
        /// One unit normal for each vertex, or none.
        pub normals: Bulk<[f32; 3]>,
        /// One standard deviation of each vertex along its normal, or none.
        pub sigma_m: Bulk<f32>,
        /// Three vertices each.
        pub triangles: Bulk<[u32; 3]>,
        /// So many of the triangles, from the first one on, were measured. Behind them are caps over what nobody saw.
        pub measured: u32,
    }
}
message!(Mesh @ 2);

impl Mesh {
    /// What was measured, without the caps that close it.
    ///
    /// ```
    /// # use wire::{Header, Mesh};
    /// let corners = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0], [0.0, 0.0, 0.1]];
    /// let closed = Mesh {
    ///     header: Header::default(),
    ///     vertices_m: corners.to_vec().into(),
    ///     normals: vec![].into(),
    ///     sigma_m: vec![1e-4; 4].into(),
    ///     triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]].into(),
    ///     measured: 1,
    /// };
    /// let open = closed.without_caps();
    /// assert_eq!((open.triangles.len(), open.vertices_m.len(), open.sigma_m.len()), (1, 3, 3));
    /// assert_eq!(open.without_caps(), open);
    /// ```
    pub fn without_caps(&self) -> Self {
        let measured = self.triangles.len().min(self.measured as usize);
        let vertices = self.triangles[..measured].iter().flatten().max().map_or(0, |&last| last as usize + 1);
        Self {
            header: self.header,
            vertices_m: self.vertices_m.iter().take(vertices).copied().collect(),
            normals: self.normals.iter().take(vertices).copied().collect(),
            sigma_m: self.sigma_m.iter().take(vertices).copied().collect(),
            triangles: self.triangles.iter().take(measured).copied().collect(),
            measured: measured as u32,
        }
    }
}
