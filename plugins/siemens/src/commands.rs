//! A constant cutting speed, and calls of subprograms.

use post_iso::Engine;
use post_plugin::{Event, NumberStyle, SpindleSense};

use crate::Siemens;

impl Siemens {
    /// G961 leaves the feed a minute.
    pub(crate) fn surface_speed(
        &mut self,
        speed: f64,
        most: Option<f64>,
        sense: SpindleSense,
        engine: &mut Engine,
        out: &mut String,
    ) {
        let block = &mut engine.motion.block;
        if let Some(most) = most {
            block
                .number("LIMS=", most, 0, NumberStyle::default())
                .end(out);
        }
        block.word("G961").number(
            "S",
            speed,
            1,
            NumberStyle {
                trim: true,
                ..self.style
            },
        );
        block.word(turns(sense));
        block.end(out);
        engine.motion.forget_feed();
        engine.motion.feeds_per_minute();
        self.surface = Some(sense);
        self.turning = None;
    }

    /// L and a number, or a name that the control can call by itself.
    pub(crate) fn subprogram(
        &mut self,
        number: Option<u32>,
        times: u32,
        name: &str,
        engine: &mut Engine,
        out: &mut String,
    ) -> Result<(), String> {
        let known = |letter: u8| letter.is_ascii_alphanumeric() || letter == b'_';
        let first = name
            .bytes()
            .take(2)
            .filter(|letter| !letter.is_ascii_digit());
        let mut call = match number {
            Some(number) => format!("L{number}"),
            None if name.len() <= 24 && name.bytes().all(known) && first.count() == 2 => {
                name.to_owned()
            }
            None => {
                return Err(format!(
                    "the subprogram's name `{name}` must be up to 24 letters, digits and _, two letters first"
                ));
            }
        };
        if times > 1 {
            call.push_str(&format!(" P{times}"));
        }
        self.forget();
        engine.write(&Event::Literal { text: &call }, out)
    }
}

pub(crate) fn turns(sense: SpindleSense) -> &'static str {
    match sense {
        SpindleSense::Clockwise => "M3",
        SpindleSense::CounterClockwise => "M4",
    }
}
