//! Signed distance by tangent planes, and its zero set
