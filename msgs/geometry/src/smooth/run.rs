//! One run of readings without a long silence, and the penalised spline through it (Eilers and Marx 1996, with third
//! differences): minimise sum w |y - B c|^2 + lambda |D3 c|^2.

use super::band::Band;
use super::basis::{Place, blend};
use nalgebra::SVector;

/// A reading of one part of the pose.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample<const D: usize> {
    pub stamp_nanos: i64,
    pub value: SVector<f64, D>,
    /// The inverse of its variance, relative to the other readings'.
    pub weight: f64,
    /// One standard deviation of its whole error, as the tracker says; 0 when it says nothing.
    pub stated: f64,
    /// False for one that fits nowhere.
    pub active: bool,
}

/// Readings and the control points that act on them.
#[derive(Debug, Clone)]
pub(super) struct Run<const D: usize> {
    samples: Vec<Sample<D>>,
    /// Of each sample the first control point that acts on it, and the weights of four.
    places: Vec<(usize, [f64; 4])>,
    knot_nanos: i64,
    first_knot: i64,
    /// Subtracted from all values, so that digits are spent on what changes.
    origin: SVector<f64, D>,
    normal: Normal<D>,
}

/// The normal equations of the samples that are active, without the penalty: the same for every lambda.
#[derive(Debug, Clone)]
struct Normal<const D: usize> {
    matrix: Band,
    right: Vec<SVector<f64, D>>,
}

/// A reading against the spline through all readings.
#[derive(Debug, Clone, Copy)]
pub(super) struct Residual<const D: usize> {
    /// Reading minus spline.
    pub off: SVector<f64, D>,
    /// The share of its own error that the spline at this reading takes over, 0..1; 0 for a reading that is left out.
    pub leverage: f64,
}

/// The solution.
#[derive(Debug, Clone)]
pub(super) struct Spline<const D: usize> {
    knot_nanos: i64,
    first_knot: i64,
    controls: Vec<SVector<f64, D>>,
    /// The inverse of the normal matrix: covariances of the control points in units of the readings' variance.
    inverse: Band,
}

impl<const D: usize> Run<D> {
    /// The spline reaches to `until_nanos` when that lies behind the last reading. `None` without readings.
    pub(super) fn new(samples: Vec<Sample<D>>, knot_nanos: i64, until_nanos: i64) -> Option<Self> {
        let (first, last) = (samples.first()?.stamp_nanos, samples.last()?.stamp_nanos.max(until_nanos));
        let first_knot = Place::of(first, knot_nanos).knot;
        let controls = usize::try_from(Place::of(last, knot_nanos).knot - first_knot).ok()? + 4;
        let place = |sample: &Sample<D>| {
            let place = Place::of(sample.stamp_nanos, knot_nanos);
            ((place.knot - first_knot) as usize, place.weights())
        };
        let places: Vec<_> = samples.iter().map(place).collect();
        let origin = samples.iter().map(|s| s.value).sum::<SVector<f64, D>>() / samples.len() as f64;
        let normal = Normal::new(&samples, &places, origin, controls);
        Some(Self { samples, places, knot_nanos, first_knot, origin, normal })
    }

    /// In the order of time.
    pub(super) fn samples(&self) -> &[Sample<D>] {
        &self.samples
    }

    /// Takes samples in, or leaves them out.
    pub(super) fn set_active(&mut self, which: &[usize], active: bool) {
        if !which.is_empty() {
            which.iter().for_each(|&i| self.samples[i].active = active);
            self.normal = Normal::new(&self.samples, &self.places, self.origin, self.normal.right.len());
        }
    }

    /// The lambda at which a sway of so many Hz comes out halved: its sixth power against the readings between two knots.
    pub(super) fn lambda_of(&self, hz: f64) -> f64 {
        let knots = (self.normal.right.len() - 3) as f64;
        self.samples.len() as f64 / knots / (std::f64::consts::TAU * hz * self.knot_nanos as f64 * 1e-9).powi(6)
    }

    /// `None` when the readings do not hold a quadratic.
    pub(super) fn solve(&self, lambda: f64) -> Option<Spline<D>> {
        let Normal { mut matrix, right: mut controls } = self.normal.clone();
        matrix.add_third_differences(lambda);
        let factor = matrix.factor()?;
        factor.solve(&mut controls);
        controls.iter_mut().for_each(|control| *control += self.origin);
        let inverse = factor.inverse();
        Some(Spline { knot_nanos: self.knot_nanos, first_knot: self.first_knot, controls, inverse })
    }

    /// In the order of the readings.
    pub(super) fn residuals<'a>(&'a self, spline: &'a Spline<D>) -> impl Iterator<Item = Residual<D>> + 'a {
        self.samples.iter().zip(&self.places).map(|(sample, &(first, weights))| {
            let leverage = if sample.active { sample.weight * spline.inverse.quadratic(first, &weights) } else { 0.0 };
            Residual { off: sample.value - blend(&weights, &spline.controls[first..]), leverage }
        })
    }
}

impl<const D: usize> Normal<D> {
    fn new(samples: &[Sample<D>], places: &[(usize, [f64; 4])], origin: SVector<f64, D>, controls: usize) -> Self {
        let (mut matrix, mut right) = (Band::zeros(controls), vec![SVector::zeros(); controls]);
        for (sample, &(first, weights)) in samples.iter().zip(places).filter(|(sample, _)| sample.active) {
            matrix.add_outer(first, &weights, sample.weight);
            for (control, weight) in right[first..].iter_mut().zip(weights) {
                *control += (sample.value - origin) * (weight * sample.weight);
            }
        }
        Self { matrix, right }
    }
}

impl<const D: usize> Residual<D> {
    /// What remains of the reading's own error in the residual; never quite 0, so that it can be divided by.
    pub(super) fn own_share(&self) -> f64 {
        (1.0 - self.leverage).max(1e-6)
    }
}

impl<const D: usize> Spline<D> {
    /// Where among the control points, and with which weights: `None` off the spline.
    fn place(&self, stamp_nanos: i64) -> Option<(usize, Place)> {
        let place = Place::of(stamp_nanos, self.knot_nanos);
        let first = usize::try_from(place.knot.checked_sub(self.first_knot)?).ok()?;
        (first + 4 <= self.controls.len()).then_some((first, place))
    }

    pub(super) fn at(&self, stamp_nanos: i64) -> Option<SVector<f64, D>> {
        let (first, place) = self.place(stamp_nanos)?;
        Some(blend(&place.weights(), &self.controls[first..]))
    }

    /// The change in a second.
    pub(super) fn rate(&self, stamp_nanos: i64) -> Option<SVector<f64, D>> {
        let (first, place) = self.place(stamp_nanos)?;
        Some(blend(&place.slopes(), &self.controls[first..]) * (1e9 / self.knot_nanos as f64))
    }

    /// The variance there, in units of a reading's (Wahba 1983).
    pub(super) fn variance(&self, stamp_nanos: i64) -> Option<f64> {
        let (first, place) = self.place(stamp_nanos)?;
        Some(self.inverse.quadratic(first, &place.weights()).max(0.0))
    }
}
