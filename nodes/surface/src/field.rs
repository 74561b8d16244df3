//! The signed distance (Hoppe et al. 1992, section 3.4), blended over the near quadrics.
//!
//! Hoppe takes the one nearest tangent plane, and so has a step wherever the nearest one changes. Here the near quadrics are
//! averaged with a kernel that falls with distance (implicit moving least squares, Kolluri 2005; partition of unity,
//! Ohtake et al. 2003), but for those whose normals disagree with the nearest one's. Hoppe's own rule of where the distance is
//! undefined is kept: where the foot of the point lies farther than rho + delta from any sample. And it is undefined where the
//! samples around the foot all lie to one side of it: past a rim a quadric only guesses.

use crate::grid::{BlockKey, Grid};
use crate::quadric::Quadric;
use nalgebra::Vector3;

/// Hoppe's rho + delta, in reaches of the nearest quadric. Of random samples one voxel apart on average, a gap as wide
/// as this comes once in ten million.
const DEFINED_REACHES: f32 = 0.75;
/// How far the centre of the samples may lie off the foot, in reaches: 0.24 on a straight rim, about 0.4 where the surface ends.
const LOPSIDED_REACHES: f32 = 0.4;
/// Farther than this from the surface, in cells, no distance is wanted: more than a cell's diagonal.
const BAND_CELLS: f32 = 2.0;
/// Below this cosine a quadric belongs to another sheet or face than the nearest one.
const LEAST_AGREEMENT: f32 = 0.2;

/// The surface as seen from one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Signed distance in metres, positive outside.
    pub distance_m: f32,
    /// Unit normal.
    pub normal: Vector3<f32>,
    /// One standard deviation of the distance, in metres.
    pub sigma_m: f32,
}

fn falloff(squared: f32, per_reach_squared: f32) -> f32 {
    let u = (1.0 - squared * per_reach_squared).max(0.0);
    let u = u * u;
    u * u
}

/// What makes a quadric the nearest: its distance, and thrice as much of it along the surface as across. At a crease, the face
/// whose samples a point stands over wins against the one that it would have to be stretched to.
fn remoteness(quadric: &Quadric, offset: &Vector3<f32>, squared: f32) -> f32 {
    3.0 * squared - 2.0 * quadric.normal.dot(offset).powi(2)
}

fn agreement(a: &Quadric, b: &Quadric) -> f32 {
    let cosine = a.normal.dot(&b.normal);
    if cosine < LEAST_AGREEMENT { 0.0 } else { cosine * cosine }
}

/// The surface around one point; `None` where no quadric reaches.
pub fn look(quadrics: &[Quadric], p: &Vector3<f32>) -> Option<Seen> {
    let reaches = |(q, d): &(&Quadric, Vector3<f32>)| d.norm_squared() < q.reach_m * q.reach_m;
    let in_reach: Vec<(&Quadric, Vector3<f32>)> = quadrics.iter().map(|q| (q, p - q.centre)).filter(reaches).collect();
    let remote = |(q, d): &(&Quadric, Vector3<f32>)| remoteness(q, d, d.norm_squared());
    let (nearest, _) = in_reach.iter().min_by(|a, b| remote(a).total_cmp(&remote(b)))?;
    let (mut weights, mut distance, mut square, mut sigma, mut gradient) = (0.0, 0.0, 0.0, 0.0, Vector3::zeros());
    for (quadric, offset) in &in_reach {
        let falloff = falloff(offset.norm_squared(), quadric.reach_m.powi(-2));
        let weight = falloff * quadric.weight * agreement(nearest, quadric);
        weights += weight;
        let apart = quadric.distance(offset);
        distance += weight * apart;
        square += weight * apart * apart;
        sigma += weight * quadric.sigma_m;
        gradient += quadric.gradient(offset) * weight;
    }
    let slope = gradient.norm() / weights;
    let normal = gradient.try_normalize(0.0)?;
    let mean = distance / weights;
    // Where no quadric fits the shape, those around it disagree.
    let disagreement = (square / weights - mean * mean).max(0.0).sqrt() / slope;
    let sigma_m = (sigma / weights).hypot(disagreement);
    (weights > 0.0).then_some(Seen { distance_m: mean / slope, normal, sigma_m })
}

/// Signed distances at the corners of a block's cells.
pub struct Corners {
    /// Corners along an edge: one more than cells.
    pub along: usize,
    /// x slowest, z fastest; NaN where undefined.
    pub distances_m: Vec<f32>,
}

/// Where the corners of a block stand along each axis.
struct Lattice {
    along: usize,
    cell_m: f32,
    axes: [Vec<f32>; 3],
}

impl Lattice {
    fn new(grid: &Grid, key: BlockKey) -> Self {
        let along = grid.cells + 1;
        let axes = [0, 1, 2].map(|axis| (0..along).map(|n| grid.corner(key, [n; 3])[axis]).collect());
        Self { along, cell_m: grid.cell_m(), axes }
    }

    /// The corners along an axis that may lie within `reach_m` of `centre`; rounding may add one, but never lose one.
    fn span(&self, axis: usize, centre: f32, reach_m: f32) -> std::ops::Range<usize> {
        let first = self.axes[axis][0];
        // Casts cut towards zero and stop at it: a floor that needs no call.
        let low = ((centre - reach_m - first) / self.cell_m) as usize;
        let high = ((centre + reach_m - first) / self.cell_m) as usize + 2;
        low..high.min(self.along)
    }

    /// Calls `visit` with the number of each corner that the quadric reaches, and the corner's offset from its centre.
    fn each_in_reach(&self, quadric: &Quadric, mut visit: impl FnMut(usize, Vector3<f32>, f32)) {
        let (centre, reach_squared) = (&quadric.centre, quadric.reach_m * quadric.reach_m);
        for x in self.span(0, centre.x, quadric.reach_m) {
            let dx = self.axes[0][x] - centre.x;
            let left = (reach_squared - dx * dx).max(0.0);
            for y in self.span(1, centre.y, left.sqrt()) {
                let dy = self.axes[1][y] - centre.y;
                for z in self.span(2, centre.z, (left - dy * dy).max(0.0).sqrt()) {
                    let offset = Vector3::new(dx, dy, self.axes[2][z] - centre.z);
                    let squared = offset.norm_squared();
                    if squared < reach_squared {
                        visit((x * self.along + y) * self.along + z, offset, squared);
                    }
                }
            }
        }
    }

    fn corner(&self, n: usize) -> Vector3<f32> {
        let [x, y, z] = &self.axes;
        Vector3::new(x[n / (self.along * self.along)], y[n / self.along % self.along], z[n % self.along])
    }
}

/// Weighted sums at one corner.
#[derive(Clone, Copy)]
struct Sum {
    remoteness: f32,
    nearest: u32,
    in_band: bool,
    weight: f32,
    distance: f32,
    offset: Vector3<f32>,
}

const NOTHING: Sum = Sum {
    remoteness: f32::INFINITY,
    nearest: 0,
    in_band: false,
    weight: 0.0,
    distance: 0.0,
    offset: Vector3::new(0.0, 0.0, 0.0),
};

impl Sum {
    /// The distance, or NaN where it is undefined.
    fn distance(&self, quadrics: &[Quadric], corner: &Vector3<f32>) -> f32 {
        if self.weight <= 0.0 {
            return f32::NAN;
        }
        let nearest = &quadrics[self.nearest as usize];
        let along = |offset: &Vector3<f32>| (offset - nearest.normal * nearest.normal.dot(offset)).norm();
        let far = along(&(corner - nearest.centre)) > DEFINED_REACHES * nearest.reach_m;
        let lopsided = along(&(self.offset / self.weight)) > LOPSIDED_REACHES * nearest.reach_m;
        if far || lopsided { f32::NAN } else { self.distance / self.weight }
    }
}

/// The distance at every corner of a block; `quadrics` are all that reach it, in the order of their blocks. Two blocks
/// that share a corner sum the same quadrics in the same order, so they agree on it to the last bit.
pub fn corners(grid: &Grid, key: BlockKey, quadrics: &[Quadric]) -> Corners {
    let lattice = Lattice::new(grid, key);
    let along = lattice.along;
    let mut sums = vec![NOTHING; along * along * along];
    for (index, quadric) in (0..).zip(quadrics) {
        lattice.each_in_reach(quadric, |corner, offset, squared| {
            let (sum, remoteness) = (&mut sums[corner], remoteness(quadric, &offset, squared));
            let nearer = remoteness < sum.remoteness;
            sum.remoteness = if nearer { remoteness } else { sum.remoteness };
            sum.nearest = if nearer { index } else { sum.nearest };
        });
    }
    // A cell that the surface passes has no corner farther from it than its diagonal.
    let band_m = BAND_CELLS * lattice.cell_m;
    for (n, sum) in sums.iter_mut().enumerate().filter(|(_, sum)| sum.remoteness.is_finite()) {
        let nearest = &quadrics[sum.nearest as usize];
        sum.in_band = nearest.distance(&(lattice.corner(n) - nearest.centre)).abs() < band_m;
    }
    for quadric in quadrics {
        let per_reach_squared = quadric.reach_m.powi(-2);
        lattice.each_in_reach(quadric, |corner, offset, squared| {
            let sum = &mut sums[corner];
            if !sum.in_band {
                return;
            }
            let agreement = agreement(&quadrics[sum.nearest as usize], quadric);
            let weight = falloff(squared, per_reach_squared) * quadric.weight * agreement;
            sum.weight += weight;
            sum.distance += weight * quadric.distance(&offset);
            sum.offset += offset * weight;
        });
    }
    let distance = |(n, sum): (usize, &Sum)| sum.distance(quadrics, &lattice.corner(n));
    Corners { along, distances_m: sums.iter().enumerate().map(distance).collect() }
}
