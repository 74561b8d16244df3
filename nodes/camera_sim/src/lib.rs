//! Pictures of a world that is known exactly
