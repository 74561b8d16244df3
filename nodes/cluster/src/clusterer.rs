//! The paper's clustering, one point at a time.

use crate::ball::{Ball, Sample, steps_per_metre};
use crate::grid::{CentreGrid, distance_squared};
use crate::movable::{END, MovablePoints, SETTLED};
use crate::pictures::Pictures;
use crate::{Config, ConfigError, Table, output, table};
use nalgebra::Vector3;
use wire::{Cloud, CloudPoint, Extent, Header, Phase, Refusal, Scan, ScanPoint};

/// Sorts points into balls, as they come.
///
/// The result is that of the paper's two passes over all points in the order in which they came, whatever the batches:
/// the first pass looks only at what came before, so it can run along; and when a ball is founded, those earlier points
/// that are closer to it than to their own centre go over to it, as the second pass would have had them.
///
/// A picture that comes again with what changed ([`Extent::Changes`]) takes its own place: its points of before leave their
/// balls without a trace. Only the centres stay where they once were founded, so such a cloud is for the eye; a scan that is
/// sent whole is clustered as if nothing had been before.
pub struct BallClusterer {
    config: Config,
    state: State,
    /// The latest scan's that went in.
    header: Header,
    /// Points refused since the last message.
    not_finite: u64,
    out_of_range: u64,
    of_older_scan: u64,
    /// The next message says that all before is void.
    afresh: bool,
}

/// However badly places are known, a ball of this radius leaves no shape in a thing that a hand can sweep.
const MOST_RADIUS_M: f64 = 0.01;

/// All that a new scan starts without.
pub(crate) struct State {
    pub balls: Vec<Ball>,
    pub grid: CentreGrid,
    movable: MovablePoints,
    pictures: Pictures,
    /// Balls that changed since they were last asked for.
    changed: Vec<u32>,
    pub radius_m: f32,
    pub steps_per_metre: f32,
    near: Vec<u32>,
    taken: Vec<Sample>,
}

/// What is held, for the log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Held {
    /// Balls, outliers among them.
    pub balls: usize,
    /// Points in them.
    pub points: u64,
    /// Memory for points that may yet go to another ball.
    pub movable_bytes: usize,
}

impl BallClusterer {
    /// Without points; refuses a configuration that cannot be.
    pub fn new(config: Config) -> Result<Self, ConfigError> {
        config.check()?;
        let state = State::new(config.ball_radius_m as f32);
        let header = Header::default();
        Ok(Self { config, state, header, not_finite: 0, out_of_range: 0, of_older_scan: 0, afresh: true })
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        self.state = State::new(self.config.ball_radius_m as f32);
        self.afresh = true;
    }

    /// Takes the points of one picture. A scan of a higher number or revision starts afresh, unless it is a change of the
    /// same scan: then its points take the place of those that the picture of the same stamp had. One of a lower number or
    /// revision is refused, as is each point that is not finite or lies beyond 2^20 D from the origin. While the operator
    /// is aiming nothing is kept.
    pub fn insert(&mut self, scan: &Scan) {
        if scan.header.phase == Phase::Aim {
            return;
        }
        let order = |header: &Header| (header.scan, header.revision);
        if order(&scan.header) < order(&self.header) {
            self.of_older_scan += scan.points.len() as u64;
            return;
        }
        let is_change = scan.header.scan == self.header.scan && scan.extent == Extent::Changes;
        if order(&scan.header) > order(&self.header) && !is_change {
            self.reset();
            self.header = scan.header.derived();
        }
        let (picture, revision) = (scan.header.stamp_nanos, scan.header.revision);
        self.header = Header { stamp_nanos: self.header.stamp_nanos.max(picture), ..scan.header.derived() };
        let outdated = self.state.pictures.outdated(picture, revision);
        self.state.take_back(&outdated);
        if self.state.balls.is_empty()
            && let Some(first) = scan.points.first()
        {
            self.state = State::new(self.radius_m(scan, first));
        }
        let mut taken = Vec::with_capacity(scan.points.len());
        for point in scan.points.iter() {
            match Sample::new(point, scan.region_sigma_m as f32, fold(picture)) {
                None => self.not_finite += 1,
                Some(sample) if !self.state.grid.reaches(sample.position_m) => self.out_of_range += 1,
                Some(sample) => {
                    self.state.insert(sample);
                    taken.push(sample);
                }
            }
        }
        self.state.pictures.keep(picture, revision, taken);
    }

    /// D, for points whose poses are as well known as this one's.
    fn radius_m(&self, scan: &Scan, point: &ScanPoint) -> f32 {
        let Config { ball_radius_m, radius_per_sigma, .. } = self.config;
        let eye = Vector3::from(scan.world_from_camera.translation_m);
        let lever_m = (Vector3::from(point.position_m).cast() - eye).norm();
        let sigma_m = scan.position_sigma_m.hypot(scan.rotation_sigma_rad * lever_m);
        // What is not finite is no reason for a larger ball, and its points are refused one by one.
        let wanted = (radius_per_sigma * sigma_m).min(MOST_RADIUS_M);
        if wanted > ball_radius_m { wanted as f32 } else { ball_radius_m as f32 }
    }

    /// The balls that changed since the last call and have enough points, by number; also a ball that was sent before and
    /// has since lost so many points that it is an outlier (then its count is 0). After a new scan or revision began, the
    /// first of these is [`Extent::Whole`].
    pub fn changes(&mut self) -> Cloud {
        let mut ids = self.state.take_changed();
        ids.retain(|&id| {
            let ball = &mut self.state.balls[id as usize];
            ball.sent |= ball.count >= self.config.least_points;
            ball.sent
        });
        let points = output::points(&self.state, &ids, self.config.least_points);
        let refused = self.take_refused();
        let extent = if std::mem::take(&mut self.afresh) { Extent::Whole } else { Extent::Changes };
        Cloud { header: self.header, extent, table: None, points: points.into(), refused }
    }

    /// All balls with enough points, by number; the points of the others are refused as outliers, and the balls of the
    /// table when it is to be removed: then the cloud tells where it is.
    pub fn whole(&mut self) -> Cloud {
        self.state.take_changed();
        self.afresh = false;
        let least = self.config.least_points;
        let (kept, outliers): (Vec<u32>, Vec<u32>) =
            (0..self.state.balls.len() as u32).partition(|&id| self.state.balls[id as usize].count >= least);
        let mut points: Vec<CloudPoint> = output::points(&self.state, &kept, least);
        let mut refused = self.take_refused();
        let all = points.len();
        let table = if self.config.table == Table::Remove { table::take_away(&mut points) } else { None };
        refuse(&mut refused, "ball of the table", (all - points.len()) as u64);
        let count = outliers.iter().map(|&id| u64::from(self.state.balls[id as usize].count)).sum();
        refuse(&mut refused, &format!("outlier: in a ball of fewer than {least} points"), count);
        Cloud { header: self.header, extent: Extent::Whole, table, points: points.into(), refused }
    }

    /// How much is held.
    pub fn held(&self) -> Held {
        Held {
            balls: self.state.balls.len(),
            points: self.state.balls.iter().map(|ball| u64::from(ball.count)).sum(),
            movable_bytes: self.state.movable.bytes(),
        }
    }

    fn take_refused(&mut self) -> Vec<Refusal> {
        let mut refused = Vec::new();
        refuse(&mut refused, "point not finite", std::mem::take(&mut self.not_finite));
        refuse(&mut refused, "point out of range", std::mem::take(&mut self.out_of_range));
        refuse(&mut refused, "point of an older scan or revision", std::mem::take(&mut self.of_older_scan));
        refused
    }
}

/// Tells a picture from the one before and behind.
fn fold(stamp_nanos: i64) -> u16 {
    (stamp_nanos ^ (stamp_nanos >> 16) ^ (stamp_nanos >> 32)) as u16
}

fn refuse(refused: &mut Vec<Refusal>, reason: &str, count: u64) {
    if count > 0 {
        refused.push(Refusal { reason: reason.to_owned(), count });
    }
}

impl State {
    fn new(radius_m: f32) -> Self {
        Self {
            balls: Vec::new(),
            grid: CentreGrid::new(radius_m),
            movable: MovablePoints::new(),
            pictures: Pictures::default(),
            changed: Vec::new(),
            radius_m,
            steps_per_metre: steps_per_metre(radius_m),
            near: Vec::new(),
            taken: Vec::new(),
        }
    }

    fn insert(&mut self, sample: Sample) {
        match self.grid.closest(sample.position_m) {
            Some((id, squared)) => self.assign(id, &sample, squared),
            None => self.found(&sample),
        }
    }

    fn assign(&mut self, id: u32, sample: &Sample, distance_squared: f32) {
        let ball = &mut self.balls[id as usize];
        ball.add(sample, self.steps_per_metre);
        if distance_squared > SETTLED * self.radius_m * self.radius_m {
            self.movable.push(&mut ball.movable, *sample);
        }
        self.mark(id);
    }

    /// Lets the points of one picture go.
    fn take_back(&mut self, samples: &[Sample]) {
        let Some(first) = samples.first() else { return };
        let mut left: Vec<u32> = samples.iter().filter_map(|sample| self.let_go(sample)).collect();
        left.sort_unstable();
        left.dedup();
        for id in left {
            self.balls[id as usize].forget(first.picture());
            self.mark(id);
        }
    }

    /// Returns the ball that lost it: a point is always in the ball with the closest centre, of two the older one.
    fn let_go(&mut self, sample: &Sample) -> Option<u32> {
        let (id, squared) = self.grid.closest(sample.position_m)?;
        let ball = &mut self.balls[id as usize];
        ball.remove(sample, self.steps_per_metre);
        if squared > SETTLED * self.radius_m * self.radius_m {
            self.movable.take_one(&mut ball.movable, sample);
        }
        Some(id)
    }

    /// Notes that a ball has changed.
    fn mark(&mut self, id: u32) {
        if !std::mem::replace(&mut self.balls[id as usize].changed, true) {
            self.changed.push(id);
        }
    }

    /// No centre is within D: the point becomes one, and takes over the points that are now closer to it.
    fn found(&mut self, sample: &Sample) {
        let centre = sample.position_m;
        let id = self.balls.len() as u32;
        let mut near = std::mem::take(&mut self.near);
        self.grid.near(centre, 2.0 * f64::from(self.radius_m), &mut near);
        self.balls.push(Ball::new(centre, END));
        self.grid.insert(id, centre);
        self.assign(id, sample, 0.0);
        for &other in &near {
            self.take_over(other, id, centre);
        }
        self.near = near;
    }

    fn take_over(&mut self, from: u32, to: u32, centre: [f32; 3]) {
        let mut taken = std::mem::take(&mut self.taken);
        let ball = &mut self.balls[from as usize];
        let old_centre = ball.centre_m;
        let closer = |s: &Sample| distance_squared(s.position_m, centre) < distance_squared(s.position_m, old_centre);
        self.movable.take(&mut ball.movable, closer, &mut taken);
        for sample in &taken {
            ball.remove(sample, self.steps_per_metre);
        }
        if !taken.is_empty() {
            self.mark(from);
        }
        for sample in taken.drain(..) {
            self.assign(to, &sample, distance_squared(sample.position_m, centre));
        }
        self.taken = taken;
    }

    fn take_changed(&mut self) -> Vec<u32> {
        let mut ids = std::mem::take(&mut self.changed);
        ids.sort_unstable();
        for &id in &ids {
            self.balls[id as usize].changed = false;
        }
        ids
    }
}
