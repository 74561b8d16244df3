//! The line under all arrivals.

use std::collections::VecDeque;

/// No window holds more: eight seconds of the fastest tracker (240 a second).
const MOST_POINTS: usize = 2048;

/// A line y = y0 + slope (x - x0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedLine {
    /// Where the line is anchored.
    pub x0: f64,
    /// Its height there.
    pub y0: f64,
    /// Nanoseconds for each step of x.
    pub slope: f64,
}

impl FittedLine {
    /// The height at x.
    pub fn at(&self, x: f64) -> f64 {
        self.y0 + self.slope * (x - self.x0)
    }
}

/// The recent points of a sending clock x and an arrival y. An arrival is late, never early; so the clocks run along the
/// line that lies below all points and, among those, closest to them: the edge of the lower convex hull beneath the mean
/// of x (Moon, Skelly, Towsley, "Estimation and removal of clock skew from network delay measurements", 1999).
/// Late arrivals, however late, do not move it. It allocates only when it is made.
#[derive(Debug, Clone)]
pub struct Envelope {
    points: VecDeque<(f64, f64)>,
    hull: Vec<(f64, f64)>,
    span: f64,
}

impl Envelope {
    /// Remembers arrivals of the last `span` nanoseconds.
    pub fn new(span: f64) -> Self {
        Self { points: VecDeque::with_capacity(MOST_POINTS), hull: Vec::with_capacity(MOST_POINTS), span }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.points.clear();
    }

    /// Takes an arrival; its x lies beyond all others'.
    pub fn push(&mut self, x: f64, y: f64) {
        if self.points.len() == MOST_POINTS {
            self.points.pop_front();
        }
        self.points.push_back((x, y));
        while self.points.front().is_some_and(|oldest| oldest.1 < y - self.span) {
            self.points.pop_front();
        }
    }

    /// Moves the points from `x` on along x; they stay behind those before.
    pub fn shift_from(&mut self, x: f64, by: f64) {
        for point in self.points.iter_mut().rev().take_while(|point| point.0 >= x) {
            point.0 += by;
        }
    }

    /// How many points are remembered.
    pub fn count(&self) -> usize {
        self.points.len()
    }

    /// How many nanoseconds they span.
    pub fn duration(&self) -> f64 {
        match (self.points.front(), self.points.back()) {
            (Some(first), Some(last)) => last.1 - first.1,
            _ => 0.0,
        }
    }

    /// The line under all points. With a `slope` given it only finds the height.
    pub fn fit(&mut self, slope: Option<f64>) -> Option<FittedLine> {
        match slope {
            Some(slope) => self.under(slope),
            None => self.edge(),
        }
    }

    /// The slope of least squares: what is known before there is a hull worth its name.
    pub fn mean_slope(&self) -> Option<f64> {
        let n = self.points.len() as f64;
        let (sx, sy) = self.points.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x, sy + y));
        let (mx, my) = (sx / n, sy / n);
        let (sxx, sxy) = self.points.iter().fold((0.0, 0.0), |(sxx, sxy), (x, y)| {
            let dx = x - mx;
            (sxx + dx * dx, sxy + dx * (y - my))
        });
        (sxx > 0.0).then(|| sxy / sxx)
    }

    /// How far the points lie above a line: root mean square about their mean, and the most.
    pub fn scatter(&self, line: &FittedLine) -> (f64, f64) {
        let n = self.points.len().max(1) as f64;
        let (mut sum, mut squares, mut most) = (0.0, 0.0, 0.0_f64);
        for (x, y) in &self.points {
            let above = y - line.at(*x);
            sum += above;
            squares += above * above;
            most = most.max(above);
        }
        ((squares / n - (sum / n).powi(2)).max(0.0).sqrt(), most)
    }

    fn under(&self, slope: f64) -> Option<FittedLine> {
        let (x0, _) = *self.points.back()?;
        let y0 = self.points.iter().map(|(x, y)| y - slope * (x - x0)).fold(f64::INFINITY, f64::min);
        Some(FittedLine { x0, y0, slope })
    }

    /// Andrew's monotone chain, lower half; then the edge beneath the mean.
    fn edge(&mut self) -> Option<FittedLine> {
        self.hull.clear();
        for &point in &self.points {
            while let [.., a, b] = self.hull[..]
                && (b.0 - a.0) * (point.1 - a.1) - (b.1 - a.1) * (point.0 - a.0) <= 0.0
            {
                self.hull.pop();
            }
            self.hull.push(point);
        }
        let mean = self.points.iter().map(|(x, _)| x).sum::<f64>() / self.points.len() as f64;
        let edge = self.hull.windows(2).find(|edge| mean <= edge[1].0)?;
        let (a, b) = (edge[0], edge[1]);
        (b.0 > a.0).then(|| FittedLine { x0: a.0, y0: a.1, slope: (b.1 - a.1) / (b.0 - a.0) })
    }
}
