//! The sums over the points of one ball, in whole numbers, so that a point can leave again without a trace and the order
//! in which points came leaves none either.

use wire::ScanPoint;

/// Offsets from the centre are counted in this part of D (12 nm for D = 0.8 mm, below the resolution of an f32 half a
/// metre from the origin). With it the sums of squares hold 2^31 points.
const STEPS_PER_RADIUS: f32 = 65_536.0;
/// Directions are counted in this part of 1.
const STEPS_PER_UNIT: f32 = 32_767.0;
/// Standard deviations are counted in 0.1 micrometres, and none is taken for more than 10 mm.
const SIGMA_STEP_M: f32 = 1e-7;
const SIGMA_STEPS_MOST: f32 = 1e5;

/// What a ball needs of a point.
#[derive(Clone, Copy, Default, PartialEq)]
pub struct Sample {
    /// In the world.
    pub position_m: [f32; 3],
    sigma_steps: u32,
    region_sigma_steps: u32,
    to_sensor_steps: [i16; 3],
    /// Of the stamp of the picture that it is from.
    picture: u16,
}

impl Sample {
    /// `None` when anything in it, or what its region shares, is not finite.
    pub fn new(point: &ScanPoint, region_sigma_m: f32, picture: u16) -> Option<Self> {
        let ScanPoint { position_m, to_sensor, sigma_m, .. } = *point;
        let sigmas = sigma_m + region_sigma_m;
        let sum = position_m[0] + position_m[1] + position_m[2] + to_sensor[0] + to_sensor[1] + to_sensor[2] + sigmas;
        // One that is not finite makes the sum so; a finite sum that overflows is refused as well, rightly.
        sum.is_finite().then(|| Self {
            position_m,
            sigma_steps: sigma_steps(sigma_m),
            region_sigma_steps: sigma_steps(region_sigma_m),
            to_sensor_steps: to_sensor.map(|c| (c * STEPS_PER_UNIT) as i16),
            picture,
        })
    }
}

impl Sample {
    /// The mark of its picture.
    pub fn picture(&self) -> u16 {
        self.picture
    }
}

fn sigma_steps(sigma_m: f32) -> u32 {
    (sigma_m / SIGMA_STEP_M).clamp(0.0, SIGMA_STEPS_MOST) as u32
}

fn square(steps: u32) -> u64 {
    u64::from(steps) * u64::from(steps)
}

/// One ball.
#[derive(Clone)]
pub struct Ball {
    /// The point that founded it.
    pub centre_m: [f32; 3],
    /// How many points it has.
    pub count: u32,
    /// From how many pictures they came: so many of their errors are independent. It is not lowered again when points leave
    /// for a younger ball, but when a picture leaves.
    pub pictures: u32,
    latest_picture: u16,
    /// The list of its points that may yet go to another ball (see `movable`).
    pub movable: u32,
    /// True when it is on the list of balls that changed.
    pub changed: bool,
    /// True when it was sent: then its later changes are sent too, even when it has lost points.
    pub sent: bool,
    offset: [i64; 3],
    /// xx, yy, zz, xy, xz, yz.
    square: [i64; 6],
    to_sensor: [i64; 3],
    variance: u64,
    region_variance: u64,
}

/// The averages over a ball, in metres about its centre.
pub struct Averages {
    /// Mean position less the centre.
    pub offset_m: [f64; 3],
    /// Covariance of the positions: xx, yy, zz, xy, xz, yz.
    pub covariance_m2: [f64; 6],
    /// Mean direction towards the sensor, of any length.
    pub to_sensor: [f64; 3],
    /// Mean of the points' own variances.
    pub variance_m2: f64,
    /// Mean of the variances that all points of a region share.
    pub region_variance_m2: f64,
}

impl Ball {
    /// A ball without points.
    pub fn new(centre_m: [f32; 3], movable: u32) -> Self {
        Self {
            centre_m,
            count: 0,
            pictures: 0,
            latest_picture: 0,
            movable,
            changed: false,
            sent: false,
            offset: [0; 3],
            square: [0; 6],
            to_sensor: [0; 3],
            variance: 0,
            region_variance: 0,
        }
    }

    /// Takes a point in.
    pub fn add(&mut self, sample: &Sample, steps_per_metre: f32) {
        self.sum(sample, steps_per_metre, 1);
        if self.pictures == 0 || self.latest_picture != sample.picture {
            (self.pictures, self.latest_picture) = (self.pictures + 1, sample.picture);
        }
        self.count += 1;
        self.variance += square(sample.sigma_steps);
        self.region_variance += square(sample.region_sigma_steps);
    }

    /// Lets a point go that was taken in.
    pub fn remove(&mut self, sample: &Sample, steps_per_metre: f32) {
        self.sum(sample, steps_per_metre, -1);
        self.count -= 1;
        self.variance -= square(sample.sigma_steps);
        self.region_variance -= square(sample.region_sigma_steps);
    }

    /// All points of a picture have left.
    pub fn forget(&mut self, picture: u16) {
        self.pictures = self.pictures.saturating_sub(1);
        if self.latest_picture == picture {
            // Should it come again, it counts again.
            self.latest_picture = !picture;
        }
    }

    fn sum(&mut self, sample: &Sample, steps_per_metre: f32, sign: i64) {
        let step = |axis: usize| {
            let offset = (sample.position_m[axis] - self.centre_m[axis]) * steps_per_metre;
            (offset + 0.5f32.copysign(offset)) as i32
        };
        let [x, y, z] = [0, 1, 2].map(|axis| i64::from(step(axis)));
        let products = [x * x, y * y, z * z, x * y, x * z, y * z];
        for (sum, term) in self.offset.iter_mut().zip([x, y, z]) {
            *sum += sign * term;
        }
        for (sum, term) in self.square.iter_mut().zip(products) {
            *sum += sign * term;
        }
        for (sum, term) in self.to_sensor.iter_mut().zip(sample.to_sensor_steps) {
            *sum += sign * i64::from(term);
        }
    }

    /// The averages; a ball always holds the point that founded it.
    pub fn averages(&self, steps_per_metre: f32) -> Averages {
        let count = f64::from(self.count.max(1));
        let step_m = 1.0 / f64::from(steps_per_metre);
        let offset_m = self.offset.map(|sum| sum as f64 * step_m / count);
        let [x, y, z] = offset_m;
        let of_mean = [x * x, y * y, z * z, x * y, x * z, y * z];
        let mean_square_m2 = |sum: u64| sum as f64 * f64::from(SIGMA_STEP_M).powi(2) / count;
        let mut covariance_m2 = self.square.map(|sum| sum as f64 * step_m * step_m / count);
        for (c, m) in covariance_m2.iter_mut().zip(of_mean) {
            *c -= m;
        }
        Averages {
            offset_m,
            covariance_m2,
            to_sensor: self.to_sensor.map(|sum| sum as f64 / count),
            variance_m2: mean_square_m2(self.variance),
            region_variance_m2: mean_square_m2(self.region_variance),
        }
    }
}

/// How finely offsets are counted for balls of this radius.
pub fn steps_per_metre(radius_m: f32) -> f32 {
    STEPS_PER_RADIUS / radius_m
}
