//! Every pose that LinuxCNC's own kinematics modules computed (`shared/data/kinematics`), through machine files
//! written as a builder would write them: its tables turn the other way, which `reversed = true` is made for.

mod common;

use std::path::PathBuf;

use common::turned;
use post_core::kinematics::{Joints, Pose};
use post_core::machine::{Machine, Source, load};

/// Axes of all three layouts; directions and points are put in.
fn machine(chain: &str, rotary: &str, settings: &[String]) -> Machine {
    let travel = "travel = [-100000, 100000]";
    let text = format!(
        r#"
name = "LinuxCNC"
chain = "{chain}"
[parameters]
x-rot-point = 0
"#
    )
    .replace("x-rot-point = 0\n", "Rx = 0\nRy = 0\nRz = 0\nDx = 0\nDy = 0\nDz = 0\nP = 0\n")
        + &format!(
            r#"
[tool]
gauge = [0, 0, 0]
{rotary}
[axis.X]
linear = [1, 0, 0]
{travel}
[axis.Y]
linear = [0, 1, 0]
{travel}
[axis.Z]
linear = [0, 0, 1]
{travel}
[control]
dialect = "linuxcnc"
tcp = "post"
"#
        );
    let source = Source {
        name: "linuxcnc.toml".to_owned(),
        text,
    };
    load(source, settings, &mut |name| Err(name.to_owned())).expect("the machine file is good")
}
