//! Inside travel: one test for every stage, each with the slack that it says why it needs.

/// A value outside the travel of its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OverTravel {
    /// Place in the chain.
    pub joint: usize,
    /// The value asked for, mm or radians.
    pub value: f64,
    /// The limit that it passes.
    pub limit: f64,
}

/// Ends of travel come out of expressions and conversions: so far beyond an end is on it, mm or radians.
pub const AT_END: f64 = 1e-9;

/// The end of `travel` that `value` passes by more than `slack`; none if it stays inside, or nothing ends it.
#[inline]
pub fn passed(travel: Option<[f64; 2]>, value: f64, slack: f64) -> Option<f64> {
    let [least, most] = travel?;
    if value >= least - slack && value <= most + slack {
        None
    } else if value > most {
        Some(most)
    } else {
        Some(least)
    }
}

/// [`passed`] by the axis at `joint`, as a fault.
#[inline]
pub fn over(
    joint: usize,
    travel: Option<[f64; 2]>,
    value: f64,
    slack: f64,
) -> Result<(), OverTravel> {
    match passed(travel, value, slack) {
        None => Ok(()),
        Some(limit) => Err(OverTravel { joint, value, limit }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_belong_to_travel_and_slack_widens_it() {
        let travel = Some([-1.0, 2.0]);
        assert_eq!(passed(travel, 2.0, 0.0), None);
        assert_eq!(passed(travel, 2.1, 0.0), Some(2.0));
        assert_eq!(passed(travel, 2.1, 0.2), None);
        assert_eq!(passed(travel, -1.3, 0.2), Some(-1.0));
        assert_eq!(passed(None, 1e9, 0.0), None);
        // What is no number is nowhere inside.
        assert!(passed(travel, f64::NAN, 0.0).is_some());
    }
}
