//! Machines, moves and runs of the planner.

use std::sync::Arc;

use nalgebra::Vector3;
use post_machine::description::{Machine, Setting, Source, load};
use post_machine::kinematics::{Joints, Solver};
use post_motion::path::{Interpolation, Stance};
use post_motion::trajectory::{FillOutcome, Planner, TaskTime};
use post_motion::{CornerMode, Move, MovePace, SetPoints, Task};

/// A machine from the text of its file.
pub fn machine(text: &str) -> Machine {
    let source = Source { name: "test".to_owned(), text: text.to_owned() };
    let settings: [Setting; 0] = [];
    load(source, &settings, &mut |_| Err(String::new()))
        .unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// An XYZAC trunnion; `linear` and `rotary` are put into the tables of their axes, `motion` into `[motion]`.
pub fn trunnion(linear: &str, rotary: &str, motion: &str) -> Machine {
    machine(&format!(
        r#"
name = "trunnion"
chain = "[w C' A' b X Y Z t]"
tool = {{ gauge = [0, 0, 0] }}
[axis]
X = {{ linear = [1, 0, 0], travel = [-1e5, 1e5], {linear} }}
Y = {{ linear = [0, 1, 0], travel = [-1e5, 1e5], {linear} }}
Z = {{ linear = [0, 0, 1], travel = [-1e5, 1e5], {linear} }}
A = {{ rotary = [1, 0, 0], point = [0, 0, 0], cyclic = true, reversed = true, {rotary} }}
C = {{ rotary = [0, 0, 1], point = [0, 0, 0], cyclic = true, reversed = true, {rotary} }}
[motion]
{motion}
[control]
dialect = "linuxcnc"
tcp = "control"
"#
    ))
}

/// Moves one after the other.
pub struct Program {
    pub solver: Arc<Solver>,
    pub here: Stance,
    pub tasks: Vec<Task>,
}

impl Program {
    /// Begins with the tip on `tip` and all rotary axes at zero.
    pub fn new(machine: &Machine, tip: [f64; 3]) -> Self {
        let solver = Arc::new(machine.solver(0.0).expect("a solver"));
        let mut program = Self { solver, here: Stance::default(), tasks: Vec::new() };
        program.here = program.stance(tip, &Joints::default());
        program
    }

    /// The stance with the tip there and the rotary axes as in `joints`.
    pub fn stance(&self, tip: [f64; 3], joints: &Joints) -> Stance {
        let mut joints = *joints;
        let chain = self.solver.chain();
        let turns = chain.turns(&joints);
        self.solver.place(Vector3::from(tip), &mut joints, &turns).expect("the axes reach it");
        Stance { joints, pose: chain.forward(&joints) }
    }

    pub fn go(&mut self, way: Interpolation, to: Stance, pace: MovePace, corner: CornerMode) {
        let task = Move {
            line: self.tasks.len() as u64 + 1,
            way,
            from: self.here,
            to,
            solver: Arc::clone(&self.solver),
            keeps_tip: true,
            pace,
            corner,
        };
        self.here = to;
        self.tasks.push(Task::Move(task));
    }
}

/// What came of a program.
pub struct Run {
    pub points: SetPoints,
    pub times: Vec<TaskTime>,
}

/// Runs the planner over tasks, `chunk` set-points at a time.
pub fn run(machine: &Machine, tasks: &[Task], solver: &Arc<Solver>, chunk: usize) -> Run {
    let mut planner = Planner::new(machine);
    let mut all = SetPoints::new(Arc::clone(solver), machine.motion.period);
    let mut batch = SetPoints::new(Arc::clone(solver), machine.motion.period);
    let mut times = Vec::new();
    let mut drain = |planner: &mut Planner, times: &mut Vec<TaskTime>| loop {
        let filled = planner.fill(&mut batch, chunk, times).expect("reachable");
        assert!(batch.len() <= chunk);
        all.joints.extend(&batch.joints);
        all.poses.extend(&batch.poses);
        all.at.extend(&batch.at);
        all.jumps.extend(&batch.jumps);
        batch.clear();
        if filled != FillOutcome::Full {
            return filled;
        }
    };
    for task in tasks {
        planner.push(task.clone()).expect("reachable");
        assert_eq!(drain(&mut planner, &mut times), FillOutcome::Wants);
    }
    planner.end();
    assert_eq!(drain(&mut planner, &mut times), FillOutcome::Ended);
    Run { points: all, times }
}
