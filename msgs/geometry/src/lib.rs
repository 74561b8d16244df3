//! Space, as several nodes need it
