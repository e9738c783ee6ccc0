//! How programs are made of a CL file.

use clap::Args;

/// What a program is made with, beside CL file and machine.
#[derive(Clone, Debug, Args)]
pub struct MakingArguments {
    /// The program's number (O1234); of several programs the first's. Short for --set
    /// control.DIALECT.program_number=…
    #[arg(long, value_name = "N")]
    pub number: Option<u32>,

    /// Moves points of the path so that the tool, the servos in between, comes nearer to the path of the CL file; by no
    /// more than the machine file allows (`servo_compensation` under `[accuracy]`; words are rounded besides), and only
    /// where a prediction against the CL file says that it helps by a hundredth or more.
    /// Rapids, holes, tool axes and the ends of cuts stay. Arcs and splines go as moves then, and no
    /// CL point is left out. `--verify` grants the moves; `post verify` later is told so by `--tolerance`, the tolerance and
    /// the bound together. A point of the file takes 150 bytes of memory.
    #[arg(long)]
    pub compensate_servo: bool,

    /// Plans the feed: the fastest that keeps the feed of the CL file, velocity and acceleration of axes and tip, and what
    /// `[plan]` of the machine file limits besides (contour error of the servos, chord error of the interpolation); jerk too
    /// with its `solver = "jerk"`.
    /// Blocks are cut where their feed changes. `--set plan.contour_error=0.02` sets a limit for one run.
    #[arg(long)]
    pub plan: bool,

    /// Plans again where the servos are predicted (`post predict`) to leave the tool farther off its path than `[plan]
    /// contour_error`: more gently there, up to so many times, until the limit is kept or the rounds are used up. Tells the
    /// time of each round, and of the program without a plan. Each round posts and predicts the whole program.
    #[arg(long, value_name = "N", requires = "plan", value_parser = clap::value_parser!(u32).range(1..=100))]
    pub plan_rounds: Option<u32>,

    /// Takes the error model's word where the certificate finds more, and only reports it. (The placement `fewest` asks
    /// no model.)
    #[arg(long, help_heading = "Plugins")]
    pub trust_model: bool,
}
