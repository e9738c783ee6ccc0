//! Tilted planes.

use post_plugin::{Capabilities, PlaneAngles, Setup, quantise};

use crate::engine::Engine;
use crate::options::flag;
use crate::table::{Plane, Table, Tcp};

/// mm in an inch.
pub(crate) const INCH: f64 = 25.4;

/// The tilted planes of a control, and the one in force.
#[derive(Debug)]
pub(crate) struct PlaneWords {
    words: Plane,
    /// Decimals of the angles.
    decimals: u8,
    /// Cycles, arcs and cutter compensation in it.
    cycles: bool,
    on: bool,
}

impl PlaneWords {
    pub(crate) fn new(table: &Table, setup: &Setup<'_>, decimals: u8) -> Self {
        let offered = flag(setup, "planes", true);
        // An offset that turns with the part knows nothing of a head.
        let head = setup.words.iter().any(|word| word.rotary && !word.carries_part);
        let possible = !(head && matches!(table.plane, Plane::Turned { .. }));
        PlaneWords {
            words: if offered && possible { table.plane } else { Plane::None },
            decimals,
            cycles: flag(setup, "cycles_in_plane", table.cycles_in_plane),
            on: false,
        }
    }

    pub(crate) fn capabilities(&self) -> Capabilities {
        match (self.words, self.cycles) {
            (Plane::None, _) => Capabilities::NONE,
            (_, true) => Capabilities::PLANE | Capabilities::CYCLE_IN_PLANE,
            (_, false) => Capabilities::PLANE,
        }
    }

    /// How the control is told one, and the decimals of its angles.
    pub(crate) fn angles(&self) -> (PlaneAngles, u8) {
        match self.words {
            Plane::Euler { .. } => (PlaneAngles::Zxz, self.decimals),
            Plane::Turns { angles, .. } => (angles, self.decimals),
            Plane::None | Plane::Turned { .. } => (PlaneAngles::Rotary, 0),
        }
    }

    /// The words that the options leave.
    pub(crate) fn words(&self) -> Plane {
        self.words
    }

    /// Cycles, arcs and cutter compensation stand in it.
    pub(crate) fn curves(&self) -> bool {
        self.cycles
    }

    /// One is in force.
    pub(crate) fn is_on(&self) -> bool {
        self.on
    }

    /// Refuses what must not stand in a tilted plane.
    pub(crate) fn must_be_off(&self, what: &str) -> Result<(), String> {
        match self.on {
            true => Err(format!("{what} inside a tilted plane: it must end before")),
            false => Ok(()),
        }
    }
}

impl Engine {
    /// Refuses what must not stand in a tilted plane.
    ///
    /// # Errors
    /// The sentence for the user, if a plane is in force.
    pub fn must_leave_plane(&self, what: &str) -> Result<(), String> {
        self.plane.must_be_off(what)
    }

    /// A plane begins. The work offset is in force, the axes have been turned.
    pub(crate) fn begin_plane(
        &mut self,
        origin: [f64; 3],
        angles: [f64; 3],
        words: &[f64],
        out: &mut String,
    ) -> Result<(), String> {
        self.plane.must_be_off("a tilted plane")?;
        self.cancel_what_was(out);
        self.motion.settle(out);
        // The axes stand there: what is not known of it is written, and moves nothing.
        self.motion.turn(words, out);
        match self.plane.words() {
            Plane::None => return Err("this control has no words for a tilted plane".to_owned()),
            Plane::Turned { on, .. } => {
                if origin != [0.0; 3] {
                    return Err(format!(
                        "the tilted plane begins at {origin:?}, and on this control it begins at the work offset"
                    ));
                }
                self.motion.line(on, out);
            }
            Plane::Euler { on, turn, .. } => {
                let (_, decimals) = self.plane.angles();
                let style = self.motion.style;
                let origin = self.printed_origin(origin)?;
                self.motion.plane_xy();
                self.motion.block.word(on);
                for (place, part) in origin.into_iter().enumerate() {
                    let printed = self.motion.linear_decimals(place);
                    let block = &mut self.motion.block;
                    block.number(["X", "Y", "Z"][place], part, printed, style);
                }
                for (address, angle) in ["I", "J", "K"].into_iter().zip(angles) {
                    self.motion.block.number(address, angle, decimals, style);
                }
                self.motion.block.end(out);
                self.motion.line(turn, out);
            }
            Plane::Turns { on, .. } => {
                let lines = self.plane_lines(on, origin, angles)?;
                if self.length_ahead_of_plane() {
                    let length = self.length()?;
                    self.motion.line(&length, out);
                }
                self.motion.line(&lines, out);
            }
        }
        self.plane.on = true;
        // Its words are others from here on.
        self.motion.other_frame();
        Ok(())
    }

    /// The origin of a plane in program units, if its decimals say it.
    fn printed_origin(&self, origin: [f64; 3]) -> Result<[f64; 3], String> {
        let origin = origin.map(|part| if self.inch { part / INCH } else { part });
        for (place, part) in origin.into_iter().enumerate() {
            let printed = self.motion.linear_decimals(place);
            if (quantise(part, printed) - part).abs() > 1e-7 {
                return Err(format!(
                    "the tilted plane begins at {part} along {}, and {printed} decimals are written",
                    ["X", "Y", "Z"][place]
                ));
            }
        }
        Ok(origin)
    }

    /// The lines of [`Plane::Turns`] that begin a plane.
    fn plane_lines(
        &self,
        form: &str,
        origin: [f64; 3],
        angles: [f64; 3],
    ) -> Result<String, String> {
        let mut lines = form.replace("{tcp_on}", &self.tcp_begin());
        let mut put = |place: &str, value: f64, decimals: u8| {
            let mut number = String::new();
            self.motion.style.write(&mut number, value, decimals);
            lines = lines.replace(place, &number);
        };
        for (place, part) in self.printed_origin(origin)?.into_iter().enumerate() {
            put(["{x}", "{y}", "{z}"][place], part, self.motion.linear_decimals(place));
        }
        let (_, decimals) = self.plane.angles();
        for (place, angle) in ["{first}", "{second}", "{third}"].into_iter().zip(angles) {
            put(place, angle, decimals);
        }
        Ok(lines)
    }

    /// The length is in force ahead of the plane, since the control keeps the tip in it.
    pub(crate) fn length_ahead_of_plane(&self) -> bool {
        matches!(self.plane.words(), Plane::Turns { .. })
            && matches!(self.table.tcp, Tcp::Blocks { length_first: true, .. })
    }

    /// A plane in which the control keeps the tip ends, unless it has: where that is switched off ahead of the retract,
    /// machine coordinates stand outside of both.
    pub(crate) fn end_kept_plane(&mut self, out: &mut String) {
        let Plane::Turns { off, .. } = self.plane.words() else {
            return;
        };
        if std::mem::take(&mut self.plane.on) {
            self.motion.settle(out);
            let lines = off.replace("{tcp_off}", self.tcp_end());
            self.motion.line(&lines, out);
            self.motion.other_frame();
            self.tcp_active.set(false);
        }
    }

    /// The plane ends, the tool retracted.
    pub(crate) fn end_plane(&mut self, out: &mut String) -> Result<(), String> {
        match self.plane.words() {
            Plane::None => return Err("this control has no words for a tilted plane".to_owned()),
            Plane::Turned { off, .. } | Plane::Euler { off, .. } => {
                self.motion.settle(out);
                self.motion.line(off, out);
            }
            Plane::Turns { .. } => self.end_kept_plane(out),
        }
        self.plane.on = false;
        self.motion.other_frame();
        Ok(())
    }
}
