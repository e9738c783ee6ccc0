//! Numbers of servos from a measured log.
