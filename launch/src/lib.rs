//! Starts, watches and stops nodes; the commands of the operator
