//! Where the handset points: the few numbers that a person thinks of, and the pose that they mean.

use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// How the camera looks at the thing. Angles in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// Of the camera, seen from the thing, from x towards y.
    pub azimuth: f64,
    /// Of the camera above the table; beyond a quarter turn it is on the far side.
    pub elevation: f64,
    /// Where the laser is beside the camera, in its picture before it is rolled: 0 right, a quarter turn below.
    pub laser: f64,
    /// What it looks at, from the middle of the thing, in metres.
    pub shift: Vector3<f64>,
}

impl Aim {
    /// Part of the way to another.
    pub fn towards(&self, other: &Self, at: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * at;
        Self {
            azimuth: mix(self.azimuth, other.azimuth),
            elevation: mix(self.elevation, other.elevation),
            laser: mix(self.laser, other.laser),
            shift: self.shift.lerp(&other.shift, at),
        }
    }

    /// The same, said with an elevation below a quarter turn and with angles near those of another.
    pub fn said_near(mut self, other: &Self) -> Self {
        use std::f64::consts::{FRAC_PI_2, PI, TAU};
        if self.elevation > FRAC_PI_2 {
            self.elevation = PI - self.elevation;
            self.azimuth += PI;
            self.laser += PI;
        }
        self.azimuth -= TAU * ((self.azimuth - other.azimuth) / TAU).round();
        self.laser -= TAU * ((self.laser - other.laser) / TAU).round();
        self
    }

    /// Unit vector from the thing to the camera.
    pub fn outward(&self) -> Vector3<f64> {
        let (level, up) = (self.elevation.cos(), self.elevation.sin());
        Vector3::new(level * self.azimuth.cos(), level * self.azimuth.sin(), up)
    }
}

/// What the hand must know of the thing and of the handset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reach {
    /// Middle of the thing.
    pub centre: Point3<f64>,
    /// Half its sides: the hand follows the ellipsoid in them.
    pub half: Vector3<f64>,
    /// From the camera to the ellipsoid.
    pub stand_off_m: f64,
    /// From the camera to where the laser's sheet leaves the handset, in the plane of the camera's x and y.
    pub laser_offset_m: nalgebra::Vector2<f64>,
}

impl Reach {
    /// The camera in the world.
    pub fn world_from_camera(&self, aim: &Aim, nearer_m: f64) -> Isometry3<f64> {
        let outward = aim.outward();
        let distance = self.distance_to_surface(&aim.shift, &outward) + self.stand_off_m - nearer_m;
        let (sin, cos) = (aim.elevation.sin(), aim.elevation.cos());
        let up = Vector3::new(-sin * aim.azimuth.cos(), -sin * aim.azimuth.sin(), cos);
        let axes = Matrix3::from_columns(&[up.cross(&outward), -up, -outward]);
        let roll = aim.laser - self.laser_offset_m.y.atan2(self.laser_offset_m.x);
        let rotation = Rotation3::from_matrix_unchecked(axes) * Rotation3::from_axis_angle(&Vector3::z_axis(), roll);
        let position = self.centre + aim.shift + outward * distance;
        Isometry3::from_parts(Translation3::from(position), UnitQuaternion::from_rotation_matrix(&rotation))
    }

    /// From a point to the far side of the ellipsoid; a ray that misses it goes on to where it would come near, without
    /// a jump or a kink, because a hand has none.
    fn distance_to_surface(&self, from: &Vector3<f64>, direction: &Vector3<f64>) -> f64 {
        const SOFT: f64 = 0.25;
        let (p, d) = (from.component_div(&self.half), direction.component_div(&self.half));
        let a = d.norm_squared();
        let to_nearest = -p.dot(&d) / a;
        // 1 through the middle, 0 where the ray touches.
        let depth = 1.0 - (p + d * to_nearest).norm_squared();
        let soft_depth = 0.5 * (depth + depth.hypot(SOFT));
        to_nearest + (soft_depth / a).sqrt()
    }

    /// The lower of camera and laser, above the table.
    pub fn height_m(&self, aim: &Aim) -> f64 {
        let camera = self.world_from_camera(aim, 0.0);
        let [x, y] = self.laser_offset_m.into();
        (camera * Point3::new(x, y, 0.0)).z.min(camera.translation.z)
    }
}
