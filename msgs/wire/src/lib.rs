//! What travels between the nodes: one file a message
