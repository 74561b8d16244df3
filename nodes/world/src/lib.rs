//! The known world of the simulator
