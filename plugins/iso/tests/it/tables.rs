//! What a table can say, on controls that differ from those of the stock dialects.

use post_iso::{
    Control, CycleAddresses, Dwell, Iso, Leave, Length, MotionCodes, Plane, Table, Tcp,
};
use post_kit::{Bench, P1, P3, TOOL, TOP, at, cut, timed, turn};
use post_plugin::export::Exported;
use post_plugin::{Compensation, Cycle, Event, Feed, Linked, PlaneAngles, Setup};

/// A controller of a small machine: no length, no changer, no compensation, feeds a minute alone.
struct Small;

impl Control for Small {
    const TABLE: &'static Table = &Table {
        percent: false,
        codes: MotionCodes {
            feed: ["G94", "", ""],
            compensation: ["G40", "", ""],
            ..MotionCodes::ISO
        },
        safe: "G17 G90 G94",
        length: Length { on: "", off: "", ..Table::ISO.length },
        leave: &[Leave::Retract],
        dwell: Dwell::Seconds("P", 2),
        change: "",
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Small)
    }
}

/// The length by itself, before the switch of blocks; everything off the other way round.
struct Ordered;

impl Control for Ordered {
    const TABLE: &'static Table = &Table {
        length: Length { on: "G56", ..Table::ISO.length },
        tcp: Tcp::Blocks { on: "M128", off: "M129", length_first: true },
        leave: &[Leave::Tcp, Leave::Length, Leave::Retract],
        dwell: Dwell::Seconds("F", 2),
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Ordered)
    }

    fn write(
        &mut self,
        event: &Event<'_>,
        engine: &mut post_iso::Engine,
        out: &mut String,
    ) -> Result<bool, String> {
        let Event::Message { text } = *event else {
            return Ok(false);
        };
        engine.line(&format!("MSG={text}"), out);
        Ok(true)
    }
}

/// Lines of its own around planes and machine coordinates, a length by the word of its register, other words of cycles.
struct Instructed;

impl Control for Instructed {
    const TABLE: &'static Table = &Table {
        length: Length { on: "D", register: "", by_itself: false, across_plane: false, off: "" },
        tcp: Tcp::Blocks { on: "#TRAFO ON", off: "#TRAFO OFF", length_first: true },
        machine: "#MCS ON",
        machine_off: "#MCS OFF",
        leave: &[Leave::Tcp, Leave::Retract],
        dwell: Dwell::Seconds("K", 2),
        cycle_addresses: CycleAddresses {
            clearance: "Z",
            bottom: "I",
            step: "B",
            beside_step: "J1",
            dwell: "K",
        },
        plane: Plane::Turns {
            on: "{tcp_on}\n#CS ON [{x}, {y}, {z}, {third}, {second}, {first}]",
            off: "#CS OFF\n{tcp_off}",
            angles: PlaneAngles::Zyx,
        },
        ..Table::ISO
    };

    fn open(_: &Setup<'_>) -> Result<Self, String> {
        Ok(Instructed)
    }
}

fn instructed() -> Bench {
    static INSTRUCTED: Exported = Exported::dialect::<Iso<Instructed>>("instructed", "1", "");
    bench::<Instructed>(&INSTRUCTED)
}

fn bench<C: Control>(exported: &'static Exported) -> Bench {
    Bench::of(Linked::dialect::<Iso<C>>(exported, "test"))
}

fn small() -> Bench {
    static SMALL: Exported = Exported::dialect::<Iso<Small>>("small", "1", "");
    bench::<Small>(&SMALL)
}

fn ordered() -> Bench {
    static ORDERED: Exported = Exported::dialect::<Iso<Ordered>>("ordered", "1", "");
    bench::<Ordered>(&ORDERED)
}

#[test]
fn what_a_control_has_no_word_for_is_left_out_or_refused() {
    let text = small().write(&[
        Event::Start,
        TOP,
        TOOL,
        turn(P1),
        at(P1),
        cut(P3, 500.0),
        Event::Dwell { seconds: 0.5 },
        TOP,
        Event::End,
    ]);
    assert_eq!(
        text.unwrap(),
        "(BRACKET)\n(AC TRUNNION)\nG21\nG17 G90 G94\nG53 G0 Z500.000\n(T1 BALL D10 [R5])\nT1\nG54\n\
         G0 A-30.000 C45.000\nX10.000 Y-20.500\nZ100.000\nG94 G1 X12.500 Z2.000 A-30.125 F500.\n\
         G4 P0.50\nG53 G0 Z500.000\nM5\nM9\nM30\n"
    );
    let refused = |event| small().write(&[Event::Start, event]).unwrap_err();
    assert!(refused(timed(P1, 2.0)).contains("in inverse time"));
    assert!(refused(Event::linear(P1, Feed::PerRevolution(0.1))).contains("a revolution"));
    let left = Event::Compensate(Compensation::Left { register: 1 });
    assert!(refused(left).ends_with("no words for cutter radius compensation"));
    assert!(small().tcp().write(&[]).unwrap_err().contains("tcp = "));
}

#[test]
fn the_order_of_switching_and_what_does_not_fit_are_the_dialects() {
    let text = ordered().tcp().write(&[
        TOP,
        TOOL,
        turn(P1),
        at(P1),
        Event::Dwell { seconds: 2.0 },
        Event::Message { text: "HALF" },
        TOP,
    ]);
    assert_eq!(
        text.unwrap(),
        "M129\nG49\nG53 G0 Z500.000\n(T1 BALL D10 [R5])\nT1 M6\nG54\nG0 A-30.000 C45.000\n\
         X10.000 Y-20.500\nG56 H1\nM128\nZ100.000\nG4 F2.00\nMSG=HALF\nM129\nG49\nG53 G0 Z500.000\n"
    );
}

#[test]
fn lines_of_their_own_stand_around_planes_and_machine_coordinates() {
    let plane = Event::Plane {
        origin: [1.0, 2.0, 3.5],
        x: [0.0, -1.0, 0.0],
        z: [0.5_f64.sqrt(), 0.0, 0.5_f64.sqrt()],
        angles: [-90.0, 0.0, -45.0],
        words: P1,
    };
    let text =
        instructed().write(&[TOP, TOOL, turn(P1), plane, at(P3), TOP, Event::PlaneOff, at(P1)]);
    assert_eq!(
        text.unwrap(),
        "#MCS ON\nG0 Z500.000\n#MCS OFF\n(T1 BALL D10 [R5])\nT1 M6\nG54\nG0 A-30.000 C45.000\nD1\n#TRAFO ON\n\
         #CS ON [1.000, 2.000, 3.500, -45.000, 0.000, -90.000]\nG0 A-30.125\nX12.500 Y-20.500\nZ2.000\n#CS OFF\n\
         #TRAFO OFF\n#MCS ON\nG0 Z500.000\n#MCS OFF\nG0 A-30.000 C45.000\nX10.000 Y-20.500\nD1 Z100.000\n"
    );
}

#[test]
fn words_of_cycles_have_the_addresses_of_the_table() {
    const HOLE: &[f64] = &[5.0, 6.0, 0.0, 0.0, 0.0];
    const OVER: &[f64] = &[5.0, 6.0, 10.0, 0.0, 0.0];
    let text = instructed().write(&[
        TOOL,
        at(OVER),
        Event::Cycle {
            cycle: Cycle::Deep,
            feed: Feed::PerMinute(120.0),
            depth: 20.0,
            clearance: 2.0,
            retract: 10.0,
            step: Some(6.0),
            dwell: None,
            pitch: None,
        },
        Event::CyclePoint { tool: None, words: HOLE },
        Event::CycleOff,
    ]);
    let text = text.unwrap();
    assert!(text.contains("G98 G83 X5.000 Y6.000 Z2.000 I-20.000 B6.000 J1 F120.\n"), "{text}");
}
