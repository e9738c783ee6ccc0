//! A dialect that declares everything there is, and writes every event as it was told it, with one fault at a time.

use std::cell::Cell;
use std::sync::atomic::{AtomicU32, Ordering};

use post_plugin::export::Exported;
use post_plugin::{
    AxisNames, CAPABILITIES, Capabilities, CutRun, Cycle, Dialect, Event, Format, Linked, Meaning,
    OptionSpec, PlaneAngles, Setup, VocabularyWord, ascii, remark,
};

/// What is wrong, and a part of the sentence that says so.
pub const FAULTS: &[(&str, &str)] = &[
    ("drops the last cut of a run", "runs of cuts: a run of cuts, 1 of them"),
    ("one sense", "declared: an arc in X Y: the other sense makes no difference"),
    ("one sense", "declared: a full circle: the other sense makes no difference"),
    (
        "one radius",
        "declared: an arc by its radius: a radius below zero, the long way, makes no difference",
    ),
    ("flat helix", "declared: a helix: another depth of its end makes no difference"),
    ("arcs are cuts", "declared: an arc in Z X: a straight cut in its place makes no difference"),
    ("no weights", "declared: a spline: another weight makes no difference"),
    ("no circle", "declared: it declares a full circle, and writes nothing"),
    ("one plane", "declared: a tilted plane: another angle makes no difference"),
    ("one origin", "declared: a tilted plane: another origin makes no difference"),
    ("one depth", "declared: a drilling cycle: another depth makes no difference"),
    ("one hole", "declared: a boring cycle: a point less makes no difference"),
    ("no step", "declared: a deep drilling cycle: another step makes no difference"),
    ("no pitch", "declared: a tapping cycle: another pitch makes no difference"),
    ("no dwell in holes", "declared: a drilling cycle: a dwell makes no difference"),
    (
        "refuses clamps",
        "declared: it declares a clamp, and refuses it: dialect `boastful`, event Clamp: this dialect has no words for a clamp",
    ),
    ("no normals", "declared: a cut with a surface normal: another normal makes no difference"),
    ("one subprogram", "declared: a subprogram: how often makes no difference"),
    (
        "no switch",
        "with TCP: it declares a switch of tool centre point control, and writes nothing",
    ),
    ("writes both", "declared: lines in the place of a tool change: `ToolChange"),
    ("forgets the tool", "the new tool's register is not in force behind them"),
    (
        "loses lines",
        "declared: lines in the place of a tool change: `M198` is not written letter for letter",
    ),
    ("drops a probe", "every event: it takes Probe and writes nothing, without having declared it"),
    ("open remarks", "remarks: a remark with brackets and signs ends before its line does"),
    ("short remarks", "remarks: a remark of 10200 letters is refused"),
    ("seven digits", "rounding edges: X 99999.499 and 99999.5 are written alike"),
    ("shares", "two at once: a program is another one while a second is written"),
    (
        "clings to its thread",
        "two threads: within 8192 events from two threads in turn the program is another one",
    ),
    ("tires", "two threads: after 0 events: dialect `boastful`, event Linear: it is tired"),
    ("option without words", "options: with `bold = true`: "),
    ("option that rounds", "options: with `bold = true`: a cut: with X "),
    ("takes back", "after a refusal: before an event that it refuses it leaves"),
    ("empty word", "vocabulary: dialect `boastful`: its vocabulary has the word ``"),
];

struct Boastful {
    fault: String,
    bold: bool,
    tcp: bool,
    /// Lines in the place of the next event's.
    instead: Option<String>,
    register: u32,
    written: u32,
}

/// The dialect; its option `fault` says what is wrong with it, nothing where it is empty.
pub fn plugin() -> Linked {
    static BOASTFUL: Exported = Exported::dialect::<Boastful>("boastful", "1", "");
    Linked::dialect::<Boastful>(&BOASTFUL, "boastful")
}

static SHARED: AtomicU32 = AtomicU32::new(0);

thread_local! {
    static CUTS: Cell<u32> = const { Cell::new(0) };
}

impl Dialect for Boastful {
    fn options() -> &'static [OptionSpec] {
        const OPTIONS: &[OptionSpec] = &[
            OptionSpec::text("fault", "", "What is wrong with it."),
            OptionSpec::flag("bold", false, "Nothing, unless that is what is wrong with it."),
        ];
        OPTIONS
    }

    fn open(setup: &Setup<'_>) -> Result<Self, String> {
        AxisNames::ISO.check(setup)?;
        Ok(Boastful {
            fault: setup.text("fault").to_owned(),
            bold: setup.flag("bold"),
            tcp: setup.tcp,
            instead: None,
            register: if setup.units == post_plugin::Units::Inch { 1 } else { 0 },
            written: 0,
        })
    }

    fn format(&self) -> Format {
        Format {
            words: vec![3; 5],
            feed: 1,
            inverse_time: Some(3),
            feed_per_revolution: 3,
            extension: "nc".to_owned(),
            plane_angles: PlaneAngles::Xyz,
            plane_decimals: 3,
            ..Format::default()
        }
    }

    fn capabilities(&self) -> Capabilities {
        let left_out = match self.fault.as_str() {
            "drops a probe" => Capabilities::PROBE,
            _ => Capabilities::TOOL_TABLE,
        };
        // Facts of printers' firmware, which the format tells too.
        let firmware = [Capabilities::RAPIDS_AT_FEED, Capabilities::COMMAND_A_LINE];
        let left_out = [left_out, Capabilities::CYCLE_NO_DWELL, firmware[0], firmware[1]];
        let declared = CAPABILITIES.iter().filter(|spec| !left_out.contains(&spec.set));
        declared.fold(Capabilities::NONE, |all, spec| all | spec.set)
    }

    fn vocabulary(&self) -> Vec<VocabularyWord> {
        let word = if self.fault == "empty word" { "" } else { "Linear" };
        vec![VocabularyWord::new(word, Meaning::Linear)]
    }

    fn write(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        if let Event::Cuts { feed, columns } = *event {
            // The program of the kit has five axis words.
            let run = CutRun::new(feed, columns, 5)?;
            let mut words = Vec::new();
            let left_out = usize::from(self.fault == "drops the last cut of a run");
            return (0..run.len() - left_out)
                .try_for_each(|place| self.write(&run.linear(place, &mut words), out));
        }
        let instead = self.instead.take();
        if let Event::ToolChange { register, .. } = *event {
            let forgets = self.fault == "forgets the tool" && instead.is_some();
            self.register = if forgets { 0 } else { register };
        }
        match (instead, self.fault.as_str()) {
            (None, _) => self.event(event, out),
            (Some(lines), "writes both") => {
                out.push_str(&lines);
                self.event(event, out)
            }
            (Some(lines), _) => {
                out.push_str(&lines);
                Ok(())
            }
        }
    }
}

impl Boastful {
    fn event(&mut self, event: &Event<'_>, out: &mut String) -> Result<(), String> {
        self.written += 1;
        let fault = self.fault.as_str();
        let mut event = *event;
        match &mut event {
            Event::Arc { turn, .. } if fault == "one sense" => *turn = turn.abs(),
            Event::Arc { turn, .. } if fault == "no circle" && turn.abs() == 360.0 => return Ok(()),
            Event::Arc { radius: Some(radius), turn, .. } if fault == "one radius" => {
                (*radius, *turn) = (radius.abs(), 120.0);
            }
            Event::Arc { words, centre, .. } if fault == "flat helix" => {
                (*words, *centre) = (&[1.0; 5], [0.0; 3]);
            }
            Event::Arc { feed, words, .. } if fault == "arcs are cuts" => {
                event = Event::linear(words, *feed);
            }
            Event::Spline { weights, .. } if fault == "no weights" => weights.0 = &[],
            Event::Plane { angles, .. } if fault == "one plane" => *angles = [0.0; 3],
            Event::Plane { origin, .. } if fault == "one origin" => *origin = [0.0; 3],
            Event::Cycle { depth, .. } if fault == "one depth" => *depth = 10.0,
            Event::Cycle { step, .. } if fault == "no step" => *step = None,
            Event::Cycle { pitch, feed, cycle: Cycle::Tap, .. } if fault == "no pitch" => {
                (*pitch, *feed) = (None, post_plugin::Feed::PerMinute(1.0));
            }
            Event::Cycle { dwell, .. } if fault == "no dwell in holes" => *dwell = None,
            Event::CyclePoint { words, .. } if fault == "one hole" && words[0] > 10.0 => {
                return Ok(());
            }
            Event::Clamp { .. } if fault == "refuses clamps" => return Err(event.refusal()),
            Event::Surface { normal, .. } if fault == "no normals" => *normal = [0.0, 0.0, 1.0],
            Event::Subprogram { times, .. } if fault == "one subprogram" => *times = 1,
            Event::Tcp { .. } if fault == "no switch" => return Ok(()),
            Event::Probe { .. } if fault == "drops a probe" => return Ok(()),
            _ => {}
        }
        match event {
            Event::Unknown { .. } => {
                if fault == "takes back" {
                    out.truncate(5);
                }
                return Err(event.refusal());
            }
            Event::Literal { text } | Event::Word { text } => out.push_str(text),
            Event::Comment { text } if fault == "short remarks" && text.len() > 5000 => {
                return Err("that is too long".to_owned());
            }
            Event::Comment { text } if fault == "open remarks" => {
                out.push_str(&format!("({})", ascii(text)));
            }
            Event::Comment { text } => out.push_str(&remark(text)),
            Event::Instead { text } => {
                let text = if fault == "loses lines" { text.lines().next() } else { Some(text) };
                self.instead = Some(format!("{}\n", text.unwrap_or_default()));
                return Ok(());
            }
            Event::Start => out.push_str(&format!("Start {} {}", self.tcp, self.register)),
            Event::Position { .. } => out.push_str(&format!("{event:?} H{}", self.register)),
            Event::Linear { words, .. } => {
                if fault == "tires" && self.written > 5_000 {
                    return Err("it is tired".to_owned());
                }
                if self.bold && fault == "option without words" {
                    return Err(String::new());
                }
                let text = format!("{event:?}");
                let rounded: Vec<f32> = words.iter().map(|word| *word as f32).collect();
                let coarse: Vec<f64> = words.iter().map(|word| word.round()).collect();
                out.push_str(&match fault {
                    "seven digits" => format!("{rounded:?}"),
                    "option that rounds" if self.bold => format!("{coarse:?}"),
                    "shares" => format!("{text} {}", SHARED.fetch_add(1, Ordering::Relaxed)),
                    "clings to its thread" => {
                        format!("{text} {}", CUTS.replace(CUTS.get() + 1))
                    }
                    _ => text,
                });
            }
            _ => out.push_str(&format!("{event:?}")),
        }
        out.push('\n');
        Ok(())
    }
}
