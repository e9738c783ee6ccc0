//! Servos: where the axes are while they follow their set-points.
