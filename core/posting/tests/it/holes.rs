//! Holes as cycles of the control: a model of the control carries out what the dialect is asked to write, and what it
//! does is held against the moves of the same job.

use post_machine::description::{CompensationOnCentre, Machine, Source, load};
use post_plugin::{Capabilities, Cycle, Feed};
use post_posting::PostingRequest;
use post_posting::program::{DefaultSpindle, ReadingOptions};
use post_testkit::{Rng, randomised};
use post_testruns::posted::{Asked, Recorder, Run, Samples, watched};

pub(crate) const LINEAR: &str = "
[axis.X]
linear = [1, 0, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Y]
linear = [0, 1, 0]
travel = [-5000, 5000]
max_feed = 20000
[axis.Z]
linear = [0, 0, 1]
travel = [-5000, 5000]
max_feed = 15000
[accuracy]
tolerance = 0.01
axis_tolerance = 0.05
rapid_tolerance = 0.5
";

pub(crate) const TABLE: &str = "
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
cyclic = true
max_feed = 9000
[axis.A]
rotary = [1, 0, 0]
point = [0, 0.012, 50.004]
travel = [-100, 100]
max_feed = 9000
";

pub(crate) fn machine(chain: &str, axes: &str, control: &str) -> Machine {
    let text = format!(
        "name = \"test\"\nchain = \"{chain}\"\n[workpiece]\nmount = [3, 5, 60]\n[tool]\ngauge = [0, 0, 400]\naxis = [0, 0, 1]\n\
         [control]\ndialect = \"none\"\n{control}\n{axes}{LINEAR}"
    );
    let source = Source { name: "machine.toml".to_owned(), text };
    load(source, &[], &mut |_| Err(String::new())).unwrap_or_else(|faults| panic!("{faults:#?}"))
}

fn mill() -> Machine {
    machine("[w b Y X Z t]", "", "")
}

fn trunnion(tcp: &str) -> Machine {
    machine("[w C' A' b Y X Z t]", TABLE, &format!("tcp = \"{tcp}\""))
}

/// All cycles, in any place.
const CYCLES: Capabilities = Capabilities::CYCLE_DRILL
    .and(Capabilities::CYCLE_DEEP)
    .and(Capabilities::CYCLE_BREAK_CHIP)
    .and(Capabilities::CYCLE_TAP)
    .and(Capabilities::CYCLE_TAP_LEFT)
    .and(Capabilities::CYCLE_REAM)
    .and(Capabilities::CYCLE_BORE)
    .and(Capabilities::CYCLE_BORE_FINE)
    .and(Capabilities::CYCLE_TCP);

fn run(machine: &Machine, capabilities: Capabilities, cl: &str) -> Run {
    run_file(machine, capabilities, cl, false)
}

fn run_file(machine: &Machine, capabilities: Capabilities, cl: &str, no_tools: bool) -> Run {
    let mut recorder = Recorder::new(machine, 3);
    recorder.capabilities = capabilities;
    let job = PostingRequest {
        reading: ReadingOptions {
            spindle: DefaultSpindle::On(500.0),
            tool_from_cutter: no_tools,
            allowed: vec!["DEEP".to_owned()],
            ..ReadingOptions::default()
        },
        tool_length: Some(50.0),
        ..PostingRequest::default()
    };
    watched(machine, recorder, cl, job, &mut Samples, &mut [])
}

/// What the control does, in the words that it is told: places of X, Y and Z.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    Rapid([f64; 3]),
    Feed([f64; 3]),
    Dwell(f64),
}

/// So far above the last depth a control begins to feed again, and draws back to break a chip, mm.
const GAP: f64 = 0.5;

/// What a control does that is asked this. A hole, as the makers publish G81 to G89 with G98: across at rapid at the level
/// where the cycle was called, down at rapid to R, the hole, and at rapid back to that level; G83 goes in by Q, out to R
/// and back to where it was, G73 draws back a little; G85 comes back to R at feed; the others come back at rapid.
fn acts(asked: &[Asked]) -> Vec<Act> {
    let mut acts = Vec::new();
    let (mut at, mut cycle, mut initial) = ([f64::NAN; 3], None, f64::NAN);
    for event in asked {
        let to = |words: &[f64]| [words[0], words[1], words[2]];
        match event.kind {
            "Position" | "Rapid" | "Linear" => {
                assert!(cycle.is_none(), "a move while a cycle is in force");
                at = to(&event.words);
                acts.push(match event.feed {
                    None => Act::Rapid(at),
                    Some(_) => Act::Feed(at),
                });
            }
            "Dwell" => {
                assert!(cycle.is_none(), "a dwell while a cycle is in force");
                acts.push(Act::Dwell(event.value));
            }
            "Cycle" => {
                assert!(cycle.is_none(), "a cycle while another is in force");
                cycle = event.cycle;
                initial = at[2];
            }
            "CycleOff" => {
                assert!(cycle.take().is_some(), "the end of no cycle");
            }
            "CyclePoint" => {
                let told = cycle.expect("a point without a cycle");
                let [x, y, point] = to(&event.words);
                let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
                assert!(near(initial, point + told.retract), "{initial} {event:?}");
                assert!(near(at[2], initial), "not at the level: {at:?} {event:?}");
                let (start, bottom) = (point + told.clearance, point - told.depth);
                acts.push(Act::Rapid([x, y, initial]));
                acts.push(Act::Rapid([x, y, start]));
                if let (Cycle::Deep | Cycle::BreakChip, Some(step)) = (told.kind, told.step) {
                    let mut depth = start - step;
                    while depth > bottom {
                        acts.push(Act::Feed([x, y, depth]));
                        if told.kind == Cycle::Deep {
                            acts.push(Act::Rapid([x, y, start]));
                        }
                        acts.push(Act::Rapid([x, y, depth + GAP.min(step)]));
                        depth -= step;
                    }
                }
                acts.push(Act::Feed([x, y, bottom]));
                acts.extend(told.dwell.map(Act::Dwell));
                if matches!(told.kind, Cycle::Ream | Cycle::Tap | Cycle::TapLeft) {
                    acts.push(Act::Feed([x, y, start]));
                }
                acts.push(Act::Rapid([x, y, initial]));
                at = [x, y, initial];
            }
            _ => {}
        }
    }
    assert!(cycle.is_none(), "a cycle is in force at the end");
    acts
}

/// What the tool sweeps.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Swept {
    /// Across, or any other way.
    Way { to: [f64; 3], rapid: bool },
    /// Up and down over one place.
    Hole {
        at: [f64; 2],
        /// Down to here at rapid where nothing was cut before.
        air: f64,
        bottom: f64,
        end: f64,
        dwell: f64,
    },
}

fn swept(acts: &[Act]) -> Vec<Swept> {
    let mut swept = Vec::new();
    let (mut at, mut cut) = ([f64::NAN; 3], f64::NAN);
    for act in acts {
        let (to, rapid) = match *act {
            Act::Dwell(seconds) => {
                match swept.last_mut() {
                    Some(Swept::Hole { dwell, .. }) => *dwell += seconds,
                    other => panic!("a dwell at {other:?}"),
                }
                continue;
            }
            Act::Rapid(to) => (to, true),
            Act::Feed(to) => (to, false),
        };
        if to == at {
            continue;
        }
        let down = libm::hypot(to[0] - at[0], to[1] - at[1]) < 0.002;
        if down {
            if !matches!(swept.last(), Some(Swept::Hole { .. })) {
                cut = f64::INFINITY;
                swept.push(Swept::Hole {
                    at: [to[0], to[1]],
                    air: at[2],
                    bottom: at[2],
                    end: at[2],
                    dwell: 0.0,
                });
            }
            if let Some(Swept::Hole { air, bottom, end, .. }) = swept.last_mut() {
                match rapid {
                    true if to[2] < cut => *air = air.min(to[2]),
                    true => {}
                    false => cut = cut.min(to[2]),
                }
                *bottom = bottom.min(to[2]);
                *end = to[2];
            }
        } else {
            swept.push(Swept::Way { to, rapid });
        }
        at = to;
    }
    swept
}

/// What is swept is the same but for the last decimal.
fn alike(one: &[Swept], other: &[Swept]) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < 0.0025;
    one.len() == other.len()
        && one.iter().zip(other).all(|pair| match pair {
            (Swept::Way { to, rapid }, Swept::Way { to: b, rapid: fast }) => {
                rapid == fast && (0..3).all(|place| near(to[place], b[place]))
            }
            (
                Swept::Hole { at, air, bottom, end, dwell },
                Swept::Hole { at: b, air: c, bottom: d, end: e, dwell: f },
            ) => {
                near(at[0], b[0])
                    && near(at[1], b[1])
                    && near(*air, *c)
                    && near(*bottom, *d)
                    && near(*end, *e)
                    && (dwell - f).abs() < 1e-12
            }
            _ => false,
        })
}

fn pick<'t>(rng: &mut Rng, texts: &[&'t str]) -> &'t str {
    texts[(rng.next() % texts.len() as u64) as usize]
}

/// A job of holes at all heights, the tool axis tilted about X by `tilt` radians.
fn job(rng: &mut Rng, tilt: f64) -> String {
    let mut cl = format!(
        "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,200,0,{},{}\n",
        libm::sin(tilt),
        libm::cos(tilt)
    );
    for _ in 0..3 {
        let clearance = rng.range(0.5, 4.0);
        let retract = match rng.next() % 2 {
            0 => String::new(),
            _ => format!(",RTRCTO,{:.3}", clearance + rng.range(0.0, 20.0)),
        };
        let kind = pick(rng, &["DRILL", "DEEP", "BRKCHP", "REAM", "BORE", "FACE", "CSINK"]);
        // No control waits at the bottom of a hole in pecks.
        let dwell = match kind {
            "DEEP" | "BRKCHP" => "",
            _ => pick(rng, &["", ",DWELL,0.5"]),
        };
        let step = match kind {
            "DEEP" | "BRKCHP" => format!(",STEP,{:.3}", rng.range(0.6, 6.0)),
            _ => String::new(),
        };
        cl += &format!(
            "CYCLE/{kind},FEDTO,-{:.3},RAPTO,{clearance:.3}{retract}{step}{dwell},MMPM,250\n",
            rng.range(1.0, 25.0)
        );
        let mut height = 0.0;
        for _ in 0..4 {
            // Some holes have the height of the one before.
            if rng.next().is_multiple_of(2) {
                height = rng.range(-20.0, 20.0);
            }
            let [x, y] = [0, 1].map(|_| rng.range(-50.0, 50.0));
            cl += &format!("GOTO/{x:.3},{y:.3},{height:.3}\n");
        }
        cl += "CYCLE/OFF\n";
        if rng.next().is_multiple_of(2) {
            cl += "RAPID\nGOTO/0,0,100\n";
        }
    }
    cl
}

/// The cycle must not go where the moves did not: through the step between two holes, or down at rapid into the part.
#[test]
fn a_cycle_of_the_control_sweeps_what_the_moves_sweep() {
    let (trials, mut rng) = randomised(60u32, 20);
    let (mut cycles, mut before, mut after) = (0, 0, 0);
    for trial in trials {
        // With the table tilted the post keeps the tip, and the hole lies along Z all the same.
        let (machine, tilt) = match trial % 4 {
            0 => (mill(), 0.0),
            1 => (trunnion("control"), 0.0),
            _ => (trunnion("post"), rng.range(-1.4, 1.4)),
        };
        let cl = job(&mut rng, tilt);
        let moves = run(&machine, Capabilities::NONE, &cl).good(&cl);
        let native = run(&machine, CYCLES, &cl).good(&cl);
        let (moved, drilled) = (swept(&acts(&moves.asked)), swept(&acts(&native.asked)));
        assert!(alike(&moved, &drilled), "{cl}\n{moved:#?}\n{drilled:#?}");
        let [slow, fast] = [&moves, &native].map(|run| run.report.as_ref().unwrap().time_s);
        assert!((slow - fast).abs() < 1e-6, "{slow} {fast}");
        let points = native.asked.iter().filter(|asked| asked.kind == "CyclePoint");
        assert_eq!(points.count(), 12, "{cl}\n{:#?}", native.asked);
        cycles += native.asked.iter().filter(|asked| asked.kind == "Cycle").count();
        before += moves.motions().len();
        after += native.motions().len();
    }
    println!("{cycles} cycles; {before} blocks as moves, {after} with cycles");
}

const HOLE: &str = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,100,0,0,1\nCYCLE/DRILL,FEDTO,-10,RAPTO,2,MMPM,250\nGOTO/1,2,0\nGOTO/9,2,0\nCYCLE/OFF\n";

fn kinds(run: &Run) -> Vec<&'static str> {
    run.asked.iter().map(|asked| asked.kind).collect()
}

/// Where the control would do something else, the moves are written: along a tilted tool axis, where a tool leans, under
/// tool centre point control that is not said to take cycles.
#[test]
fn what_the_control_would_do_otherwise_stays_moves() {
    let tilted = HOLE.replace("0,0,1\n", "0,0.6,0.8\n");
    let head = || {
        let axes = "
[axis.A]
rotary = [1, 0, 0]
point = [0, 0, 250]
travel = [-100, 100]
max_feed = 9000
[axis.C]
rotary = [0, 0, 1]
point = [0, 0, 0]
travel = [-400, 400]
max_feed = 9000
";
        machine("[w b X Y Z C A t]", axes, "tcp = \"post\"")
    };
    let without_tcp = CYCLES.and(Capabilities::CYCLE_ANY_AXIS);
    for (name, machine, capabilities, cl, native) in [
        ("a mill", mill(), CYCLES, HOLE, true),
        ("drilling alone unknown", mill(), Capabilities::CYCLE_DEEP, HOLE, false),
        ("a tilted table", trunnion("post"), CYCLES, &tilted, true),
        ("a tilted tool under TCP", trunnion("control"), CYCLES, &tilted, false),
        ("the same, the control can", trunnion("control"), without_tcp, &tilted, true),
        ("TCP", trunnion("control"), CYCLES, HOLE, true),
        ("TCP without cycles", trunnion("control"), Capabilities::CYCLE_DRILL, HOLE, false),
        ("an upright head", head(), CYCLES, HOLE, true),
        ("a head that leans", head(), without_tcp, &tilted, false),
        ("moves wanted", machine("[w b Y X Z t]", "", "cycles = \"moves\""), CYCLES, HOLE, false),
    ] {
        let run = run(&machine, capabilities, cl).good(name);
        let kinds = kinds(&run);
        assert_eq!(kinds.contains(&"Cycle"), native, "{name}: {kinds:?}");
        let ends = kinds.iter().filter(|kind| **kind == "CycleOff").count();
        assert_eq!(ends, usize::from(native), "{name}: {kinds:?}");
    }
}

/// Words of the CL file and the cycle that comes of them.
#[test]
fn the_kinds_of_the_cl_file_are_those_of_the_control() {
    for (text, kind, step, dwell, depth) in [
        ("DRILL,FEDTO,-10,RAPTO,2,MMPM,50", Cycle::Drill, None, None, 10.0),
        ("DRILL,FEDTO,-10,RAPTO,2,MMPM,50,DWELL,1", Cycle::Drill, None, Some(1.0), 10.0),
        ("FACE,FEDTO,-10,RAPTO,2,MMPM,50,DWELL,1", Cycle::Drill, None, Some(1.0), 10.0),
        ("DEEP,DEPTH,10,STEP,3,MMPM,50,CLEAR,1", Cycle::Deep, Some(3.0), None, 10.0),
        ("DEEP,DEPTH,10,STEP,30,MMPM,50,CLEAR,1", Cycle::Drill, None, None, 10.0),
        ("BRKCHP,DEPTH,10,STEP,3,MMPM,50,CLEAR,1", Cycle::BreakChip, Some(3.0), None, 10.0),
        ("CHIP,DEPTH,10,STEP,3,MMPM,50,CLEAR,1", Cycle::BreakChip, Some(3.0), None, 10.0),
        ("REAM,DEPTH,10,MMPM,50,CLEAR,1", Cycle::Ream, None, None, 10.0),
        ("BORE,DEPTH,10,MMPM,50,CLEAR,1", Cycle::Ream, None, None, 10.0),
        ("BORE,DRAG,DEPTH,10,MMPM,50,CLEAR,1", Cycle::Bore, None, None, 10.0),
        ("BORE,NODRAG,0.2,DEPTH,10,MMPM,50,CLEAR,1", Cycle::BoreFine, Some(0.2), None, 10.0),
        ("TAP,DEPTH,10,PITCH,1.5,CLEAR,3", Cycle::Tap, None, None, 10.0),
        ("TAP,DEPTH,10,MMPR,1.5,CLEAR,3", Cycle::Tap, None, None, 10.0),
        ("TAP,DEPTH,10,MMPM,750,CLEAR,3", Cycle::Tap, None, None, 10.0),
        ("CSINK,DIAMET,8,ANGLE,90,MMPM,50,CLEAR,1", Cycle::Drill, None, None, 4.0),
        ("CSINK,DEPTH,3,MMPM,50,CLEAR,1", Cycle::Drill, None, None, 3.0),
        ("THRU,DEPTH,10,MMPM,50,CLEAR,1", Cycle::Drill, None, None, 10.0),
        ("DRILL,DEPTH,10,THRU,2,MMPM,50,CLEAR,1", Cycle::Drill, None, None, 12.0),
        // The CAMWorks files of the field: the first peck reaches the bottom.
        ("DRILL,G98,4,PECKING,5,2,MMPM,50,3,25", Cycle::Drill, None, None, 4.0),
    ] {
        let cl = format!("UNITS/MM\nRAPID\nGOTO/0,0,100\nCYCLE/{text}\nGOTO/1,2,0\nCYCLE/OFF\n");
        let run = run(&mill(), CYCLES, &cl).good(text);
        let told: Vec<_> = run.asked.iter().filter_map(|asked| asked.cycle).collect();
        let [told] = told[..] else {
            panic!("{text}: {:?}", kinds(&run));
        };
        assert_eq!(
            (told.kind, told.step, told.dwell, told.depth),
            (kind, step, dwell, depth),
            "{text}"
        );
        if kind == Cycle::Tap {
            assert_eq!((told.pitch, told.feed), (Some(1.5), Feed::PerMinute(750.0)), "{text}");
        }
    }
}

/// A tap that is fed otherwise than its thread breaks; a left-hand one in a spindle that turns right too.
#[test]
fn a_thread_is_cut_by_a_cycle_that_fits_it_or_not_at_all() {
    let tap = |spindle: &str, words: &str, capabilities: Capabilities| {
        let cl = format!(
            "UNITS/MM\n{spindle}\nRAPID\nGOTO/0,0,100\nCYCLE/TAP,DEPTH,10,CLEAR,3{words}\nGOTO/1,2,0\nCYCLE/OFF\n"
        );
        let run = run(&mill(), capabilities, &cl);
        let told = run.asked.iter().find_map(|asked| asked.cycle);
        match run.report {
            Some(_) => Ok(told.map(|told| (told.kind, told.pitch))),
            None => Err(run.told()),
        }
    };
    const RIGHT: &str = "SPINDL/RPM,500,CLW";
    const LEFT: &str = "SPINDL/RPM,500,CCLW";
    assert_eq!(tap(RIGHT, ",PITCH,1.5", CYCLES), Ok(Some((Cycle::Tap, Some(1.5)))));
    assert_eq!(tap(RIGHT, ",TPI,20", CYCLES), Ok(Some((Cycle::Tap, Some(1.27)))));
    assert_eq!(tap(LEFT, ",PITCH,1.5", CYCLES), Ok(Some((Cycle::TapLeft, Some(1.5)))));
    assert_eq!(tap(LEFT, ",PITCH,-1.5", CYCLES), Ok(Some((Cycle::TapLeft, Some(1.5)))));
    assert_eq!(tap(RIGHT, ",MMPM,600", CYCLES), Ok(Some((Cycle::Tap, Some(1.2)))));
    for (spindle, words, capabilities, why) in [
        (RIGHT, ",PITCH,-1.5", CYCLES, "left-hand"),
        (RIGHT, ",PITCH,1.5,MMPM,600", CYCLES, "needs a feed of 750"),
        (RIGHT, ",PITCH,1.5,STEP,2", CYCLES, "pecks"),
        (RIGHT, ",PITCH,100", CYCLES, "max_feed"),
        (RIGHT, ",PITCH,1.5", Capabilities::CYCLE_DRILL, "moves cannot"),
    ] {
        let refused = tap(spindle, words, capabilities);
        assert!(refused.as_ref().is_err_and(|told| told.contains(why)), "{words}: {refused:?}");
    }
    // With a tilted tool under tool centre point control no thread can be cut.
    let cl = "UNITS/MM\nMULTAX/ON\nRAPID\nGOTO/0,0,100,0,0.6,0.8\nCYCLE/TAP,DEPTH,10,CLEAR,3,PITCH,1.5\nGOTO/1,2,0\n";
    let refused = run(&trunnion("control"), CYCLES, cl);
    assert!(refused.told().contains("must be the control's own"), "{}", refused.told());
}

/// Blocks of the real files with holes, as moves and as cycles.
#[test]
fn real_files_need_fewer_blocks_with_cycles() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data/cl");
    for (file, least, no_tools) in [
        ("nx_HumMan_standart_drill.clsf", 2, false),
        ("nx_HumMan_deep_drill.clsf", 2, false),
        ("creo3x_MichaHofft_bohren_1.ncl", 2, false),
        ("swcam_aamorim_basemach.apt", 16, false),
        // Its first peck is deeper than the others: no cycle of a control does that.
        ("camworks_neMoguta_UniSource.clt", 0, true),
    ] {
        let Ok(cl) = std::fs::read(format!("{folder}/{file}")) else {
            println!("{file} is not here");
            continue;
        };
        let cl = String::from_utf8_lossy(&cl);
        let mut machine = trunnion("post");
        machine.control.compensation_on_centre = CompensationOnCentre::Wear;
        let moves = run_file(&machine, Capabilities::NONE, &cl, no_tools).good(file);
        let native = run_file(&machine, CYCLES, &cl, no_tools).good(file);
        let count = |kind| native.asked.iter().filter(|asked| asked.kind == kind).count();
        println!(
            "{file}: {} blocks as moves, {} with {} cycles at {} points",
            moves.motions().len(),
            native.motions().len(),
            count("Cycle"),
            count("CyclePoint")
        );
        assert!(count("CyclePoint") >= least, "{file}");
        let (moved, drilled) = (swept(&acts(&moves.asked)), swept(&acts(&native.asked)));
        assert!(alike(&moved, &drilled), "{file}");
    }
}
