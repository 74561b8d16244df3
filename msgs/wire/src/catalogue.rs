//! All messages, told in words: what stands in a recording beside the bytes.

use crate::Message;
use crate::codec::schema;
use std::collections::BTreeMap;

/// The only list of all messages: hands their types to another macro, as `mine!(wire::Calibration, wire::Cloud, ...)`.
///
/// ```
/// macro_rules! names {
///     ($($message:ty),*) => { [$(<$message as wire::Message>::NAME),*] };
/// }
/// assert!(wire::for_all_messages!(names).contains(&"Frame"));
/// ```
#[macro_export]
macro_rules! for_all_messages {
    ($mine:ident) => {
        $mine!(
            $crate::Calibration,
            $crate::Cloud,
            $crate::Frame,
            $crate::Health,
            $crate::LogLine,
            $crate::Mesh,
            $crate::Model,
            $crate::Pose,
            $crate::Profile,
            $crate::Progress,
            $crate::Refinement,
            $crate::RunPhase,
            $crate::Scan,
            $crate::Stripe,
            $crate::Trajectory
        )
    };
}

/// The fields of a message and of all that it is made of.
pub fn layout_text<M: Message>() -> String {
    let mut known = BTreeMap::new();
    let name = M::describe(&mut known);
    let first = known.remove(&name).unwrap_or_default();
    let others: String = known.into_values().collect();
    format!(
        "// bincode 2, standard configuration: integers are variable-length, little-endian, signed ones zigzag.\n\
         // Bulk<T> is a count and then the plain little-endian values, packed as in C.\n{first}{others}"
    )
}

/// Schema and layout of every message of this version.
pub fn catalogue() -> BTreeMap<String, String> {
    macro_rules! entries {
        ($($message:ty),*) => { BTreeMap::from([$((schema::<$message>(), layout_text::<$message>())),*]) };
    }
    crate::for_all_messages!(entries)
}
