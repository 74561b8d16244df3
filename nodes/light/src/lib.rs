//! Laser and lamp on a serial port.
//!
//! In: what the operator is doing ([`wire::RunPhase`]). Out: lines on a serial port, which switch the laser and the lamp:
//! the laser for shape (and while aiming), the lamp for colour, both in turn for `both`, neither after the end.
//!
//! Nothing depends on when exactly a light goes on: what lit a picture is seen in the picture itself
//! (`camera_v4l::LightJudge`). So lines and answers may be late.
//!
//! - [`protocol`]: the lines of both dialects, and the answers.
//! - [`lit`]: which light is on, when.
//! - `Lights` (feature `serial`): says it again and again to whoever is there, names what is wrong, and tries for ever.
//!
//! Safety. Lights that hear nothing for a second put themselves out (dialect `limn`); a Ciclop's board does not, and stays
//! as it was when its cable is pulled.
//!
//! ```
//! use light::{Config, protocol};
//! use wire::Light;
//! let laser = Light { laser: true, lamp: false };
//! assert_eq!(protocol::switch(&Config::default(), laser), ["light 1 0\n"]);
//! let mut answers = protocol::Answers::new(protocol::Dialect::Limn);
//! let answer = b"ok 1 0\n".iter().find_map(|byte| answers.push(*byte));
//! assert_eq!(answer, Some(protocol::Answer::Done(Some(laser))));
//! ```

mod config;
#[cfg(feature = "serial")]
mod lights;
#[cfg(feature = "node")]
pub mod node;
mod plan;
pub mod protocol;

pub use config::Config;
#[cfg(feature = "serial")]
pub use lights::Lights;
pub use plan::{DARK, lit};
pub use serial_line::ConfigError;
