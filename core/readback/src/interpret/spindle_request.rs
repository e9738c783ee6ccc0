//! What a program asks of the spindle.

/// What the spindle does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpindleRequest {
    /// It turns clockwise.
    Clockwise,
    /// It turns the other way.
    CounterClockwise,
    /// It stands.
    Off,
    /// It is held at an angle.
    Oriented,
}
