//! Things modelled in the code: solids as signed distances, made into triangles, and painted.
//!
//! Modelling is done in millimetres, x along the thing, z up, because a person reads these numbers.

mod coat;
mod cow;
mod cow_coat;
mod extract;
mod primitive;
mod sheets;
mod solid;

use coat::{Coat, paint};
pub use cow::cow;
use extract::surface_nets;
pub use primitive::{Pattern, Primitive, primitive};
