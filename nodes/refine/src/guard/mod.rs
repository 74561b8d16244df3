//! What may go wrong, noticed.

pub(crate) mod coloured;
pub(crate) mod moved;
pub(crate) mod strokes;
