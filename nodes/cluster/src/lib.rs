//! The ball clustering of the paper (section 2.4), incremental: many noisy points go in, few good ones come out.
//!
//! **In**: [`wire::Scan`], the points of one picture in the world, any number of them in any batches.
//! **Out**: [`wire::Cloud`]: for each ball the average of its points ([`BallClusterer::changes`] as they come,
//! [`BallClusterer::whole`] at the end), with its number, count, normal, spread and the sigma of the mean.
//!
//! **Method**. D is `ball_radius_m`, T is `least_points`. A point with no centre within D founds a ball; every point
//! belongs to the ball with the closest centre; balls with fewer than T points are outliers. The paper runs over all
//! points twice; here each point is handled once, as it comes, with the same result ([`BallClusterer`] says why, and a
//! property test compares with the paper's pseudo code word by word). "Within" includes D itself; of two centres that
//! are equally close the older one counts.
//!
//! The normal is that of the plane through the means of the neighbours within 2 D that were seen from the same side,
//! turned towards the sensor; where fewer than four lie about a plane it is the mean direction to the sensor. It is meant
//! for drawing and as a first guess: `surface` fits its own. `sigma_m` is the larger of the points' spread and their own
//! mean sigma, over the root of the number of pictures, and besides it what no number of pictures averages away
//! ([`wire::Scan::region_sigma_m`]). Scans bring no colour, so there is none.
//!
//! Of a scan that is refined while it goes on, a picture may come again, better placed ([`wire::Scan::extent`]): it takes its own
//! place, and all else stays.
//!
//! On request [`BallClusterer::whole`] leaves out the table on which the thing stands ([`geometry::Table`]), which the paper
//! edited by hand, and tells where it is ([`wire::TablePlane`]): nothing of the thing is below it.
//!
//! **Units and frames**: metres, in the world. **Limits**: points beyond 2^20 D from the origin are refused (839 m for
//! 0.8 mm). Memory: about 1 kB a ball on a surface, and 28 bytes for each point, twice for one that a later ball might
//! still take over (farther than D/2 from its centre: about half of them). **Speed**: one look into a hash a point.
//!
//! ```
//! use cluster::{BallClusterer, Config};
//! use wire::{Header, Phase, Scan, ScanPoint};
//! let at = |x: f32, z: f32| ScanPoint { position_m: [x, 0.0, z], to_sensor: [0.0, 0.0, 1.0], sigma_m: 1e-4, amplitude: 90.0 };
//! let scan = Scan {
//!     points: vec![at(0.0, 0.0), at(0.0002, 0.0001), at(-0.0002, -0.0001), at(0.05, 0.0)].into(),
//!     ..Scan::none(Header { phase: Phase::Shape, ..Header::default() })
//! };
//! let mut clusterer = BallClusterer::new(Config { ball_radius_m: 0.0008, least_points: 3, ..Config::default() }).unwrap();
//! clusterer.insert(&scan);
//! let cloud = clusterer.whole();
//! assert_eq!(cloud.points.len(), 1);
//! assert_eq!(cloud.points[0].count, 3);
//! assert_eq!(cloud.refused[0].count, 1); // the lonely point: an outlier
//! ```

mod ball;
mod clusterer;
mod config;
mod grid;
mod movable;
#[cfg(feature = "node")]
pub mod node;
mod output;
mod pictures;
mod table;

pub use clusterer::{BallClusterer, Held};
pub use config::{Config, ConfigError, Table};
