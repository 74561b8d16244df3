//! A surface of triangles.

use nalgebra::{Point3, Vector3};

/// Triangles, counter-clockwise seen from outside. Attributes are one a vertex, or none at all.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TriangleMesh {
    /// In metres.
    pub vertices: Vec<Point3<f32>>,
    /// Unit normals, or none.
    pub normals: Vec<Vector3<f32>>,
    /// Red, green, blue as a picture stores them (sRGB), or none.
    pub colours: Vec<[u8; 3]>,
    /// Texture coordinates, u right and v down, or none.
    pub uv: Vec<[f32; 2]>,
    /// Three vertices each.
    pub triangles: Vec<[u32; 3]>,
}

/// What makes a mesh unusable.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum MeshError {
    /// Only points, or nothing.
    #[error("a mesh without faces ({vertices} vertices)")]
    NoFaces {
        /// How many points there are.
        vertices: usize,
    },
    /// NaN or infinite.
    #[error("vertex {index} is not finite")]
    NotFinite {
        /// The first bad vertex.
        index: usize,
    },
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are {vertices}")]
    Index {
        /// The first bad face.
        face: usize,
        /// What it names.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// An attribute that is there for some vertices only.
    #[error("{count} {what} for {vertices} vertices")]
    Attribute {
        /// Which.
        what: &'static str,
        /// How many came.
        count: usize,
        /// How many there are vertices.
        vertices: usize,
    },
}

impl TriangleMesh {
    /// Refuses a mesh without faces, with vertices that are not finite or faces that name none.
    pub fn check(&self) -> Result<(), MeshError> {
        let vertices = self.vertices.len();
        if self.triangles.is_empty() {
            return Err(MeshError::NoFaces { vertices });
        }
        if let Some(index) = self.vertices.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NotFinite { index });
        }
        for (face, triangle) in self.triangles.iter().enumerate() {
            if let Some(&vertex) = triangle.iter().find(|&&i| i as usize >= vertices) {
                return Err(MeshError::Index { face, vertex, vertices });
            }
        }
        for (what, count) in [("normals", self.normals.len()), ("colours", self.colours.len()), ("uv", self.uv.len())] {
            if count != 0 && count != vertices {
                return Err(MeshError::Attribute { what, count, vertices });
            }
        }
        Ok(())
    }

    /// The corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Point3<f32>; 3] {
        self.triangles[triangle].map(|i| self.vertices[i as usize])
    }

    /// Twice the area times the unit normal of a triangle.
    pub fn area_normal(&self, triangle: usize) -> Vector3<f32> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a))
    }

    /// The area of all triangles, in square metres.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| 0.5 * f64::from(self.area_normal(t).norm())).sum()
    }

    /// How many edges have no triangle, or not exactly one, on their other side: none of a mesh that is closed.
    pub fn open_edges(&self) -> usize {
        let of = |&[a, b, c]: &[u32; 3]| [(a, b), (b, c), (c, a)];
        let mut edges: Vec<(u32, u32)> = self.triangles.iter().flat_map(of).collect();
        edges.sort_unstable();
        let uses = |edge: (u32, u32)| edges.partition_point(|e| *e <= edge) - edges.partition_point(|e| *e < edge);
        edges.iter().filter(|&&(a, b)| uses((a, b)) != 1 || uses((b, a)) != 1).count()
    }

    /// Smallest and largest corner of the box around it; `None` without vertices.
    pub fn bounds(&self) -> Option<[Point3<f32>; 2]> {
        let first = *self.vertices.first()?;
        Some(self.vertices.iter().fold([first, first], |[low, high], p| [low.inf(p), high.sup(p)]))
    }

    /// Normals of the vertices, weighted by the areas of their triangles.
    pub fn vertex_normals(&self) -> Vec<Vector3<f32>> {
        let mut normals = vec![Vector3::zeros(); self.vertices.len()];
        for (t, triangle) in self.triangles.iter().enumerate() {
            let normal = self.area_normal(t);
            for &i in triangle {
                normals[i as usize] += normal;
            }
        }
        normals.iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::z)).collect()
    }

    /// Appends another mesh; an attribute that either lacks is dropped.
    pub fn append(&mut self, other: &Self) {
        fn join<T: Clone>(mine: &mut Vec<T>, count: usize, theirs: &[T], their_count: usize) {
            if mine.len() == count && theirs.len() == their_count {
                mine.extend_from_slice(theirs);
            } else {
                mine.clear();
            }
        }
        let (count, their_count) = (self.vertices.len(), other.vertices.len());
        join(&mut self.normals, count, &other.normals, their_count);
        join(&mut self.colours, count, &other.colours, their_count);
        join(&mut self.uv, count, &other.uv, their_count);
        let offset = count as u32;
        self.vertices.extend_from_slice(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
    }
}

impl From<&wire::Mesh> for TriangleMesh {
    fn from(mesh: &wire::Mesh) -> Self {
        Self {
            vertices: mesh.vertices_m.iter().map(|&p| Point3::from(p)).collect(),
            normals: mesh.normals.iter().map(|&n| Vector3::from(n)).collect(),
            triangles: mesh.triangles.to_vec(),
            ..Self::default()
        }
    }
}
