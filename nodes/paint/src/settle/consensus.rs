//! What the pictures say together of each point of the surface.

use crate::settle::view::View;
use rayon::prelude::*;

/// The agreed value of one point.
#[derive(Debug, Clone, Copy, Default)]
pub struct Agreed {
    /// The views' weighted mean, strays left out by degrees.
    mean: [f32; 3],
    /// The sum of the weights in it; 0 when too few see the point.
    weight: f32,
    centre: [f32; 3],
    reach: f32,
}

/// Fewer views are no consensus.
const VIEWS_MIN: usize = 3;
/// The others have at least this share of the say.
const OTHERS_MIN: f32 = 0.3;
/// Views farther from the median than this many robust standard deviations are left out (Tukey's biweight).
const TUKEY: f32 = 4.0;
/// Views that agree to this share of the median are all good.
const AGREED: f32 = 0.04;

impl Agreed {
    /// Of what is seen, with its weight.
    fn of(seen: &mut [([f32; 3], f32)]) -> Self {
        if seen.len() < VIEWS_MIN {
            return Self::default();
        }
        let mut sorted = vec![0.0; seen.len()];
        let mut median = |value: &dyn Fn(&[f32; 3]) -> f32| {
            sorted.iter_mut().zip(seen.iter()).for_each(|(to, (from, _))| *to = value(from));
            *sorted.select_nth_unstable_by(seen.len() / 2, f32::total_cmp).1
        };
        let centre = [0, 1, 2].map(|c| median(&|value| value[c]));
        // 1.4826: a standard deviation from a median of absolute deviations.
        let sigma = (1.4826 * median(&|value| apart(value, &centre))).max(AGREED * apart(&centre, &[0.0; 3]));
        let mut agreed = Self { centre, reach: TUKEY * sigma, ..Self::default() };
        for (value, weight) in seen.iter() {
            let weight = weight * agreed.share(value);
            agreed.weight += weight;
            (0..3).for_each(|c| agreed.mean[c] += weight * value[c]);
        }
        agreed.mean = agreed.mean.map(|sum| sum / agreed.weight);
        if agreed.weight > 0.0 && agreed.mean.iter().all(|c| c.is_finite()) { agreed } else { Self::default() }
    }

    fn share(&self, value: &[f32; 3]) -> f32 {
        (1.0 - (apart(value, &self.centre) / self.reach).powi(2)).max(0.0).powi(2)
    }

    /// The mean, when there is one.
    pub fn mean(&self) -> Option<[f32; 3]> {
        (self.weight > 0.0).then_some(self.mean)
    }

    /// The mean of the others, for the view that said `own` with this weight; `None` when they are next to nothing.
    pub fn without(&self, own: &[f32; 3], weight: f32) -> Option<[f32; 3]> {
        let mean = self.mean()?;
        if own.iter().any(|c| !c.is_finite()) {
            return Some(mean);
        }
        let own_weight = weight * self.share(own);
        let left = self.weight - own_weight;
        let others = || [0, 1, 2].map(|c| mean[c] + (mean[c] - own[c]) * (own_weight / left));
        (left > OTHERS_MIN * self.weight).then(others)
    }
}

/// Of the agreed values, those of white: 99 of 100 are darker in every channel. 1 when nothing is agreed.
pub fn white(agreed: &[Agreed]) -> f64 {
    let brightest = |mean: [f32; 3]| mean.into_iter().fold(0.0, f32::max);
    let mut brightest: Vec<f32> = agreed.iter().filter_map(Agreed::mean).map(brightest).collect();
    if brightest.is_empty() {
        return 1.0;
    }
    let at = (brightest.len() - 1) * 99 / 100;
    let white = f64::from(*brightest.select_nth_unstable_by(at, f32::total_cmp).1);
    if white > 0.0 { white } else { 1.0 }
}

fn apart(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f32>().sqrt()
}

/// Who sees each point: places in the views, point by point, in the order of the views.
pub struct Witnesses {
    /// Those of point `p` are `places[from[p]..from[p + 1]]`.
    from: Vec<u32>,
    /// View, and the place in it.
    places: Vec<[u32; 2]>,
}

impl Witnesses {
    /// Turns "which points does each view see" around.
    pub fn of(views: &[View], points: usize) -> Self {
        let mut from = vec![0; points + 1];
        for seen in views.iter().flat_map(|view| &view.seen) {
            from[seen.point as usize + 1] += 1;
        }
        for point in 0..points {
            from[point + 1] += from[point];
        }
        let mut next = from.clone();
        let mut places = vec![[0; 2]; from[points] as usize];
        for (number, view) in views.iter().enumerate() {
            for (at, seen) in view.seen.iter().enumerate() {
                let next = &mut next[seen.point as usize];
                places[*next as usize] = [number as u32, at as u32];
                *next += 1;
            }
        }
        Self { from, places }
    }

    /// The weighted mean over the views at each point, of what they have in each of their places; 0 where nothing weighs.
    pub fn means(&self, value: impl Fn(usize, usize) -> ([f32; 3], f32) + Sync) -> Vec<[f32; 3]> {
        let of_point = |range: &[u32]| {
            let (mut sum, mut total) = ([0.0; 3], 0.0);
            for &[view, at] in &self.places[range[0] as usize..range[1] as usize] {
                let (value, weight) = value(view as usize, at as usize);
                total += weight;
                (0..3).for_each(|c| sum[c] += weight * value[c]);
            }
            if total > 0.0 { sum.map(|sum| sum / total) } else { [0.0; 3] }
        };
        self.from.par_windows(2).map(of_point).collect()
    }

    /// What each point is agreed to be, from what each view says in each of its places (not a number: nothing).
    pub fn agree(&self, views: &[View], said: &[Vec<[f32; 3]>]) -> Vec<Agreed> {
        let of_point = |range: &[u32]| {
            let places = &self.places[range[0] as usize..range[1] as usize];
            let mut seen: Vec<([f32; 3], f32)> = places
                .iter()
                .map(|&[view, at]| (said[view as usize][at as usize], views[view as usize].seen[at as usize].weight))
                .filter(|(value, _)| value.iter().all(|c| c.is_finite()))
                .collect();
            Agreed::of(&mut seen)
        };
        self.from.par_windows(2).map(of_point).collect()
    }
}
