use nalgebra::Vector3;
use post_plugin::{Coolant, Spindle, SpindleSense};
use post_posting::internals::LineWindow;
use post_posting::program::{Command, MoveFeed, ProgramStep, StraightMove, ToolChange};

#[test]
fn a_part_begins_in_the_state_that_the_lines_before_it_set() {
    let mut window = LineWindow::new(std::iter::once(10..20).collect());
    let mut steps = Vec::new();
    let tool = |number| Command::Tool(ToolChange { number, ..ToolChange::default() });
    for (line, command) in [
        (1, Command::Coolant(Coolant::Mist)),
        (2, tool(1)),
        (3, Command::Spindle(Spindle::Off)),
        (4, tool(2)),
        (5, Command::Stop),
        (10, Command::Comment("A".to_owned())),
        (11, Command::Coolant(Coolant::Flood)),
        (12, Command::OptionalStop),
        (19, Command::Home),
        (20, Command::Stop),
    ] {
        window.step(line, ProgramStep::Command(command), &mut steps);
    }
    let command = |line, command| (line, ProgramStep::Command(command));
    assert_eq!(
        steps,
        [
            command(10, Command::Comment("A".to_owned())),
            command(12, tool(2)),
            command(12, Command::Coolant(Coolant::Flood)),
            command(12, Command::OptionalStop),
            command(19, Command::Home),
        ]
    );
}

/// The spindle of the tool before waits until the tool cuts without a speed of its own.
#[test]
fn a_tool_begins_with_its_own_speed() {
    let tool = || Command::Tool(ToolChange { number: 2, ..ToolChange::default() });
    let turning = |rpm| Command::Spindle(Spindle::On { rpm, sense: SpindleSense::Clockwise });
    let made = |said: &[Command]| {
        let mut window = LineWindow::new(std::iter::once(10..20).collect());
        let mut steps = Vec::new();
        window.step(1, ProgramStep::Command(turning(15_000.0)), &mut steps);
        window.step(2, ProgramStep::Command(Command::Coolant(Coolant::Mist)), &mut steps);
        let motion = StraightMove {
            tip: Vector3::zeros(),
            axis: Vector3::z(),
            edge: Vector3::zeros(),
            pace: MoveFeed::PerMinute(100.0),
            chord: 0.0,
        };
        for command in said {
            window.step(10, ProgramStep::Command(command.clone()), &mut steps);
        }
        window.step(11, ProgramStep::Move(motion), &mut steps);
        let commands = steps.into_iter().filter_map(|(_, step)| match step {
            ProgramStep::Command(command) => Some(command),
            _ => None,
        });
        commands.collect::<Vec<_>>()
    };
    let mist = Command::Coolant(Coolant::Mist);
    assert_eq!(
        made(&[tool(), Command::Preselect(3), turning(800.0)]),
        [tool(), Command::Preselect(3), turning(800.0), mist.clone()]
    );
    assert_eq!(
        made(&[tool(), Command::Preselect(3)]),
        [tool(), Command::Preselect(3), turning(15_000.0), mist.clone()]
    );
    // No tool came: what turned goes on turning.
    assert_eq!(made(&[Command::Stop]), [turning(15_000.0), mist, Command::Stop]);
}
