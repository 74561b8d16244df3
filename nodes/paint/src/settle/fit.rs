//! A small correction of one view, so that its picture says what the others say: robust Gauss-Newton on brightness (after
//! Lucas & Kanade 1981 and Zhou & Koltun 2014, section 4).

use crate::settle::consensus::Agreed;
use crate::settle::level::Level;
use crate::settle::together::{Slot, Unknowns};
use crate::settle::view::{View, moved};
use geometry::Camera;
use nalgebra::{Point2, Point3, SMatrix, SVector, Vector3, Vector6};

/// How far a view may have to move.
#[derive(Debug, Clone, Copy)]
pub struct Prior {
    /// One standard deviation of its place along each axis.
    pub shift_m: f64,
    /// One standard deviation of its turn about each axis.
    pub turn_rad: f64,
}

/// What one view is compared with: its picture, and what the others say of each point that it sees.
pub struct Comparison<'a> {
    pub camera: &'a Camera,
    pub level: &'a Level,
    pub points: &'a [Point3<f64>],
    pub view: &'a View,
    /// What all views say of each point.
    pub agreed: &'a [Agreed],
    /// What the others say, in the order of `view.seen`.
    pub others: Vec<Option<[f32; 3]>>,
}

/// How well a view agrees with the others at some correction.
#[derive(Debug, Clone, Copy)]
pub struct Agreement {
    /// The robust mean of the squared differences, in units of the scale that was given.
    pub cost: f64,
    /// The median difference (over the three channels together).
    pub median: f64,
    /// How many points were compared.
    pub points: usize,
}

/// The precision of each unknown of a view: its correction, then its gain.
pub fn precision(prior: &Prior) -> Unknowns {
    let [shift, turn] = [prior.shift_m, prior.turn_rad].map(|sigma| sigma.powi(-2));
    let [gain, along_u, along_v] = GAIN_SIGMA.map(|sigma| sigma.powi(-2));
    Unknowns::from([shift, shift, shift, turn, turn, turn, gain, along_u, along_v])
}

/// One point: what is said and what the others say, in each channel.
#[derive(Clone, Copy)]
struct Row {
    says: Vector3<f64>,
    others: Vector3<f64>,
    /// 1, and how far the point is from the optical axis: light that is not known well changes slowly over the picture.
    place: Vector3<f64>,
    p_in_camera: Vector3<f64>,
    slopes: SMatrix<f64, 3, 6>,
    weight: f64,
}

/// Fewer points hold no view.
pub const POINTS_MIN: usize = 60;
/// So many neighbouring points err together: in their normals, their depth and their blur.
const ERR_TOGETHER: f64 = 10.0;
/// Of the robust weight (Cauchy, 95 % efficiency).
const CAUCHY: f64 = 2.385;
/// Differences as small as this (of the white of the picture) are no differences.
const SCALE_MIN: f64 = 0.004;
const STEPS: usize = 4;
const HALVINGS: usize = 3;
/// One standard deviation of the gain, and of its change from the axis out to one radian.
const GAIN_SIGMA: [f64; 3] = [0.1, 0.3, 0.3];

type Gain = Vector3<f64>;

impl<'a> Comparison<'a> {
    /// `said` is what the view said as the others agreed.
    pub fn new(
        camera: &'a Camera,
        level: &'a Level,
        points: &'a [Point3<f64>],
        view: &'a View,
        (agreed, said): (&'a [Agreed], &[[f32; 3]]),
    ) -> Self {
        let others =
            view.seen.iter().zip(said).map(|(seen, said)| agreed[seen.point as usize].without(said, seen.weight));
        Self { camera, level, points, view, agreed, others: others.collect() }
    }

    /// How the view as it stands differs from what all say, itself too, in the order of what it sees; and the gain under
    /// which it agrees best. Silent when it sees too little.
    pub fn linear(&self, white: f64) -> (Vec<Slot>, Gain) {
        let all: Vec<_> = self.view.seen.iter().map(|seen| self.agreed[seen.point as usize].mean()).collect();
        let rows = self.each_row(&self.view.correction, &all);
        let known: Vec<Row> = rows.iter().flatten().copied().collect();
        if known.len() < POINTS_MIN {
            return (vec![Slot::SILENT; rows.len()], Gain::zeros());
        }
        let scale = scale_of(&known, white);
        let gain = gain_of(&known, scale);
        let slot = |row: &Option<Row>| row.as_ref().map_or(Slot::SILENT, |row| row.slot(&gain, scale));
        (rows.iter().map(slot).collect(), gain)
    }

    /// The correction that agrees best; the one that the view has where nothing better is found.
    pub fn settle(&self, prior: &Prior, white: f64) -> Vector6<f64> {
        let precision = [prior.shift_m, prior.turn_rad].map(|sigma| sigma.powi(-2));
        let precision = Vector6::from_fn(|i, _| precision[i / 3]);
        let mut best = self.view.correction;
        let mut rows = self.rows(&best);
        if rows.len() < POINTS_MIN {
            return best;
        }
        let scale = scale_of(&rows, white);
        let mut gain = gain_of(&rows, scale);
        let say = rows.iter().map(|row| row.weight).sum::<f64>() / ERR_TOGETHER;
        let cost_at = |rows: &[Row], gain: &Gain, correction: &Vector6<f64>| {
            let data = say * cost(rows, gain, scale);
            data + correction.component_mul(correction).dot(&precision)
        };
        let mut least = cost_at(&rows, &gain, &best);
        for _ in 0..STEPS {
            let Some(mut step) = step(&rows, &gain, scale, &best, &precision) else { break };
            let mut better = false;
            for _ in 0..HALVINGS {
                let tried = best + step;
                let tried_rows = self.rows(&tried);
                let tried_gain = gain_of(&tried_rows, scale);
                let tried_cost = cost_at(&tried_rows, &tried_gain, &tried);
                if tried_rows.len() >= POINTS_MIN && tried_cost < least {
                    (best, rows, gain, least, better) = (tried, tried_rows, tried_gain, tried_cost, true);
                    break;
                }
                step *= 0.5;
            }
            if !better {
                break;
            }
        }
        best
    }

    /// How well the view agrees at a correction, differences measured by `scale`; without it, by their own median.
    pub fn agreement(&self, correction: &Vector6<f64>, white: f64, scale: Option<f64>) -> (Agreement, f64) {
        let rows = self.rows(correction);
        let scale = scale.unwrap_or_else(|| scale_of(&rows, white));
        let gain = gain_of(&rows, scale);
        let median = median_of(&rows, &gain);
        (Agreement { cost: cost(&rows, &gain, scale), median, points: rows.len() }, scale)
    }

    fn rows(&self, correction: &Vector6<f64>) -> Vec<Row> {
        self.each_row(correction, &self.others).into_iter().flatten().collect()
    }

    /// In the order of what the view sees; `None` where it or those that it is compared with say nothing.
    fn each_row(&self, correction: &Vector6<f64>, others: &[Option<[f32; 3]>]) -> Vec<Option<Row>> {
        let correction = moved(correction);
        let camera_from_world = correction * self.view.camera_from_world;
        let row = |(seen, others): (&crate::settle::view::Seen, &Option<[f32; 3]>)| {
            let others = (*others)?;
            let p = camera_from_world * self.points[seen.point as usize];
            let pixel = self.camera.project(&p)?;
            let shown = self.level.at(&pixel)?;
            let mut slopes = SMatrix::<f64, 3, 6>::zeros();
            for c in 0..3 {
                let slope = shown.slope[c].map(|slope| slope * f64::from(seen.scale[c]));
                slopes.set_row(c, &slope_of_pose(self.camera, &p, slope).transpose());
            }
            Some(Row {
                says: Vector3::from_fn(|c, _| f64::from(shown.value[c] * seen.scale[c])),
                others: Vector3::from(others).cast(),
                place: Vector3::new(1.0, p.x / p.z, p.y / p.z),
                p_in_camera: p.coords,
                slopes,
                weight: f64::from(seen.weight.min(1.0)),
            })
        };
        self.view.seen.iter().zip(others).map(row).collect()
    }
}

/// How a value changes with the shift and turn of the camera's frame, from its slopes in the picture. Distortion changes
/// the slopes by a few per cent, which only lengthens or shortens a step.
fn slope_of_pose(camera: &Camera, p: &Point3<f64>, [along_u, along_v]: [f64; 2]) -> Vector6<f64> {
    let by_place = Point2::new(along_u * camera.fx / p.z, along_v * camera.fy / p.z);
    let by_place = Vector3::new(by_place.x, by_place.y, -(by_place.x * p.x + by_place.y * p.y) / p.z);
    let by_turn = p.coords.cross(&by_place);
    Vector6::new(by_place.x, by_place.y, by_place.z, by_turn.x, by_turn.y, by_turn.z)
}

impl Row {
    fn difference(&self, gain: &Gain) -> Vector3<f64> {
        self.says - self.others * (1.0 + gain.dot(&self.place))
    }

    fn slot(&self, gain: &Gain, scale: f64) -> Slot {
        let difference = self.difference(gain);
        Slot {
            p_in_camera: self.p_in_camera.cast(),
            slopes: std::array::from_fn(|c| self.slopes.fixed_view::<1, 3>(c, 0).transpose().cast()),
            agreed: self.others.cast().into(),
            difference: difference.cast().into(),
            weight: (self.weight * robust(&difference, scale) / (scale.powi(2) * ERR_TOGETHER)) as f32,
        }
    }
}

fn median_of(rows: &[Row], gain: &Gain) -> f64 {
    let mut sizes: Vec<f64> = rows.iter().map(|row| row.difference(gain).norm()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let middle = sizes.len() / 2;
    *sizes.select_nth_unstable_by(middle, f64::total_cmp).1
}

fn scale_of(rows: &[Row], white: f64) -> f64 {
    let gain = gain_of(rows, 0.1 * white);
    (1.4826 * median_of(rows, &gain)).max(SCALE_MIN * white)
}

fn robust(difference: &Vector3<f64>, scale: f64) -> f64 {
    1.0 / (1.0 + difference.norm_squared() / (CAUCHY * scale).powi(2))
}

/// The weighted mean of the robust squares, in units of the scale.
fn cost(rows: &[Row], gain: &Gain, scale: f64) -> f64 {
    let one = |row: &Row| -row.weight * CAUCHY.powi(2) * robust(&row.difference(gain), scale).ln();
    let total: f64 = rows.iter().map(|row| row.weight).sum();
    rows.iter().map(one).sum::<f64>() / total.max(f64::MIN_POSITIVE)
}

/// The gain under which a view agrees best with the others, as it stands.
fn gain_of(rows: &[Row], scale: f64) -> Gain {
    let mut gain = Gain::zeros();
    for _ in 0..2 {
        let mut normal = SMatrix::<f64, 3, 3>::from_diagonal(&Vector3::from(GAIN_SIGMA.map(|s| s.powi(-2))));
        let mut right = Vector3::zeros();
        for row in rows {
            let weight = row.weight * robust(&row.difference(&gain), scale) / scale.powi(2);
            normal += row.place * row.place.transpose() * (weight * row.others.norm_squared());
            right += row.place * (weight * row.others.dot(&(row.says - row.others)));
        }
        let Some(solved) = normal.cholesky() else { break };
        gain = solved.solve(&right);
    }
    gain
}

/// The Gauss-Newton step of the correction, the gain going along.
fn step(
    rows: &[Row],
    gain: &Gain,
    scale: f64,
    correction: &Vector6<f64>,
    precision: &Vector6<f64>,
) -> Option<Vector6<f64>> {
    let mut normal = SMatrix::<f64, 9, 9>::zeros();
    let mut right = SVector::<f64, 9>::zeros();
    for row in rows {
        let difference = row.difference(gain);
        let weight = row.weight * robust(&difference, scale) / (scale.powi(2) * ERR_TOGETHER);
        let mut slopes = SMatrix::<f64, 3, 9>::zeros();
        slopes.fixed_columns_mut::<6>(0).copy_from(&row.slopes);
        slopes.fixed_columns_mut::<3>(6).copy_from(&(-row.others * row.place.transpose()));
        normal += slopes.transpose() * slopes * weight;
        right -= slopes.transpose() * difference * weight;
    }
    for i in 0..6 {
        normal[(i, i)] += precision[i];
        right[i] -= precision[i] * correction[i];
    }
    for i in 0..3 {
        normal[(6 + i, 6 + i)] += GAIN_SIGMA[i].powi(-2);
        right[6 + i] -= gain[i] * GAIN_SIGMA[i].powi(-2);
    }
    Some(normal.cholesky()?.solve(&right).fixed_rows::<6>(0).into_owned())
}
