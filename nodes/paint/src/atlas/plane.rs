//! A chart on the plane that it is projected to: which cell lies where on the surface.

use super::chart::Chart;
use geometry::TriangleMesh;
use nalgebra::{Point2, Point3, Vector2, Vector3};

/// Free texels around the triangles of a chart. A bilinear sample inside a triangle reaches cells up to sqrt(2) away;
/// those are painted as the nearest place of the chart. The rest keeps the charts apart.
pub const PADDING_TEXELS: f32 = 2.0;
/// Square of how far from a triangle its colour is kept, in cells: what bilinear sampling reaches.
const REACH_SQUARED: f32 = 2.001;
/// Two places of a chart that meet in one cell belong to one sheet if they are at most this many cells apart along the
/// axis: neighbouring cells on a surface at the steepest angle of a chart differ by less.
const SHEET_CELLS: f32 = 4.0;

/// One texel of a chart.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Square of the distance from the texel's centre to the triangle, in cells; 0 inside.
    distance_squared: f32,
    /// The triangle of the mesh that is nearest.
    pub triangle: u32,
    /// Weights of its corners at the nearest place; they sum to 1.
    pub weights: [f32; 3],
    depth: f32,
}

impl Cell {
    const FREE: Self = Self { distance_squared: f32::INFINITY, triangle: u32::MAX, weights: [0.0; 3], depth: 0.0 };

    /// True when the texel belongs to the chart.
    pub fn is_used(&self) -> bool {
        self.triangle != u32::MAX
    }

    /// True when its centre lies on the chart, not beside it.
    pub fn is_inside(&self) -> bool {
        self.distance_squared == 0.0
    }
}

/// A chart's plane: maps the world to texels of the chart, (0, 0) its top-left corner.
#[derive(Debug, Clone)]
pub struct Plane {
    u: Vector3<f32>,
    v: Vector3<f32>,
    axis: Vector3<f32>,
    offset: Vector2<f32>,
    /// Texels of the chart's rectangle.
    pub size: [u32; 2],
}

impl Plane {
    /// The plane across the chart's axis, turned so that the chart's rectangle is small and lies along u.
    pub fn of(chart: &Chart, mesh: &TriangleMesh, cell_m: f32) -> Self {
        let axis = chart.axis;
        let helper = if axis.x.abs() < 0.7 { Vector3::x() } else { Vector3::y() };
        let a = axis.cross(&helper).normalize();
        let b = axis.cross(&a);
        let flat = |p: Point3<f32>| Vector2::new(a.dot(&p.coords), b.dot(&p.coords)) / cell_m;
        let points: Vec<Vector2<f32>> =
            chart.triangles.iter().flat_map(|&t| mesh.corners(t as usize)).map(flat).collect();
        let (along, [low, high]) = smallest_rectangle(&points);
        let (u, v) = ((a * along.x + b * along.y) / cell_m, (b * along.x - a * along.y) / cell_m);
        let size = (high - low).map(|extent| (extent.ceil() + 2.0 * PADDING_TEXELS) as u32);
        Self { u, v, axis: axis / cell_m, offset: low.map(|c| PADDING_TEXELS - c), size: size.into() }
    }

    /// Texel coordinates of a point; (0, 0) is the corner of the top-left texel.
    pub fn texel(&self, p_in_world: &Point3<f32>) -> Point2<f32> {
        Point2::new(self.u.dot(&p_in_world.coords), self.v.dot(&p_in_world.coords)) + self.offset
    }

    /// The cells of a chart, row by row, and those of its triangles that lie above or below another sheet of it.
    pub fn cells(&self, chart: &Chart, mesh: &TriangleMesh) -> (Vec<Cell>, Vec<u32>) {
        let mut cells = vec![Cell::FREE; self.size[0] as usize * self.size[1] as usize];
        let mut second_sheet = Vec::new();
        for &t in &chart.triangles {
            let corners = mesh.corners(t as usize);
            let flat = corners.map(|p| self.texel(&p));
            let depth = corners.map(|p| self.axis.dot(&p.coords));
            let found = self.reached(&flat).map(|(index, centre)| {
                let (weights, distance_squared) = nearest_place(&flat, centre);
                let depth = weights[0] * depth[0] + weights[1] * depth[1] + weights[2] * depth[2];
                (index, Cell { distance_squared, triangle: t, weights, depth })
            });
            let found: Vec<(usize, Cell)> = found.filter(|(_, cell)| cell.distance_squared <= REACH_SQUARED).collect();
            let other_sheet = |(index, cell): &(usize, Cell)| {
                cells[*index].is_used() && (cells[*index].depth - cell.depth).abs() > SHEET_CELLS
            };
            if found.iter().any(other_sheet) {
                second_sheet.push(t);
                continue;
            }
            for (index, cell) in found {
                if cell.distance_squared < cells[index].distance_squared {
                    cells[index] = cell;
                }
            }
        }
        (cells, second_sheet)
    }

    /// Index and centre of the cells around a triangle.
    fn reached(&self, flat: &[Point2<f32>; 3]) -> impl Iterator<Item = (usize, Point2<f32>)> {
        const REACH: f32 = 1.5;
        let low = flat[0].inf(&flat[1]).inf(&flat[2]);
        let high = flat[0].sup(&flat[1]).sup(&flat[2]);
        let first = low.map(|c| (c - REACH).max(0.0) as u32);
        let end = |axis: usize| ((high[axis] + REACH) as u32 + 1).min(self.size[axis]);
        let (end_u, end_v, width) = (end(0), end(1), self.size[0]);
        (first.y..end_v).flat_map(move |row| {
            (first.x..end_u).map(move |column| {
                ((row * width + column) as usize, Point2::new(column as f32 + 0.5, row as f32 + 0.5))
            })
        })
    }
}

/// The direction along which the rectangle around the points is smallest, and its corners in that direction and across.
fn smallest_rectangle(points: &[Vector2<f32>]) -> (Vector2<f32>, [Vector2<f32>; 2]) {
    // A quarter turn swaps the sides; of those two the wide one is taken.
    const TURNS: usize = 24;
    let rectangle = |turn: usize| {
        let (sine, cosine) = (std::f32::consts::PI * turn as f32 / TURNS as f32).sin_cos();
        let turned = |p: &Vector2<f32>| Vector2::new(cosine * p.x + sine * p.y, cosine * p.y - sine * p.x);
        let far = Vector2::repeat(f32::INFINITY);
        let corners = points.iter().map(turned).fold([far, -far], |[low, high], p| [low.inf(&p), high.sup(&p)]);
        (Vector2::new(cosine, sine), corners)
    };
    let cost = |[low, high]: &[Vector2<f32>; 2]| {
        let size = high - low;
        (size.x + 2.0 * PADDING_TEXELS) * (size.y + 2.0 * PADDING_TEXELS) * if size.x < size.y { 1.001 } else { 1.0 }
    };
    let first = rectangle(0);
    (1..TURNS).map(rectangle).fold(first, |best, next| if cost(&next.1) < cost(&best.1) { next } else { best })
}

/// Weights of the corners at the place of a triangle that is nearest to a point, and the square of its distance.
fn nearest_place(corners: &[Point2<f32>; 3], point: Point2<f32>) -> ([f32; 3], f32) {
    let [a, b, c] = *corners;
    let doubled_area = (b - a).perp(&(c - a));
    let inside = [(b - point).perp(&(c - point)), (c - point).perp(&(a - point)), (a - point).perp(&(b - point))]
        .map(|part| part / doubled_area);
    if inside.iter().all(|w| (0.0..=1.0).contains(w)) {
        return (inside, 0.0);
    }
    let on_side = |i: usize| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let along = to - from;
        let at = ((point - from).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let at = if at.is_nan() { 0.0 } else { at };
        let mut weights = [0.0; 3];
        weights[i] = 1.0 - at;
        weights[(i + 1) % 3] = at;
        // A centre on the very edge may be outside by rounding: the least that is not inside.
        (weights, (from + along * at - point).norm_squared().max(f32::MIN_POSITIVE))
    };
    let [first, second, third] = [on_side(0), on_side(1), on_side(2)];
    let nearer = if second.1 < first.1 { second } else { first };
    if third.1 < nearer.1 { third } else { nearer }
}
