//! A machine with its settings, as the command loads it.

use std::path::Path;

use post_machine::description::Machine;
use post_plugin::DialectSession as _;
use post_posting::program::{MoveFeed, StraightMove};
use post_posting::whole_pass;

use super::{MachineKinematics, MadeProgram, NamedOption, Refusal, StopSignal, ToolPoses, quietly};
use crate::session::Session;
use crate::settings::MachineSettings;
use crate::{machine_files, plugin_finder};

/// Decimals that leave axis values as they are solved: a millionth of a micrometre.
const EXACT: u8 = 9;

/// Which machine, and what is set over its file.
#[derive(Clone, Debug, Default)]
pub struct MachineSelection {
    /// A TOML file, or the name of one in a machine folder or built in.
    pub name: String,
    /// What is set.
    pub over: MachineSettings,
}

/// A machine that is loaded, a tool in it.
#[derive(Debug)]
pub struct LoadedMachine {
    told: MachineSelection,
    machine: Machine,
    kinematics: MachineKinematics,
}

impl LoadedMachine {
    /// Loads it as the command does.
    ///
    /// # Errors
    /// There is none of that name, its file is refused, or its chain cannot be solved.
    pub fn load(stop: &StopSignal, told: MachineSelection) -> Result<Self, Refusal> {
        let load = |session: &Session| {
            machine_files::load(session, &told.name, &told.over.machines, &told.over.settings())
        };
        let (machine, _) = quietly(stop, load)?;
        let kinematics = MachineKinematics::new(&machine, told.over.tool_length.unwrap_or(0.0))?;
        Ok(Self { told, machine, kinematics })
    }

    /// What it was loaded by.
    pub fn told(&self) -> &MachineSelection {
        &self.told
    }

    /// What its file means.
    pub fn description(&self) -> &Machine {
        &self.machine
    }

    /// Where its tool goes, and how its axes get there.
    pub fn kinematics(&self) -> &MachineKinematics {
        &self.kinematics
    }

    /// Posts the CL file `input` with these options of the command, to `output` if that is named; its blocks are kept if `keep_blocks` says so. The file
    /// of the machine is read anew for it.
    ///
    /// # Errors
    /// Why it is refused.
    pub fn post(
        &self,
        stop: &StopSignal,
        input: &Path,
        output: Option<&Path>,
        options: &[NamedOption],
        keep_blocks: bool,
    ) -> Result<MadeProgram, Refusal> {
        MadeProgram::post(stop, &self.told, input, output, options, keep_blocks)
    }

    /// Axis values for a path, chosen over the whole of it as posting does: by point and axis. `cut` says of each point
    /// whether the tool comes to it cutting, or in a rapid.
    ///
    /// # Errors
    /// A point that is none or cannot be reached, or where a cut cannot go on.
    pub fn route(
        &self,
        stop: &StopSignal,
        wanted: &ToolPoses<'_>,
        cut: &[bool],
    ) -> Result<Vec<f64>, Refusal> {
        let poses = wanted.poses(self.kinematics.has_edge())?;
        let path: Vec<StraightMove> = poses
            .iter()
            .zip(cut)
            .map(|(pose, cut)| StraightMove {
                tip: pose.tip,
                axis: pose.axis,
                edge: pose.edge,
                pace: match cut {
                    true => MoveFeed::PerMinute(1000.0),
                    false => MoveFeed::Rapid,
                },
                chord: 0.0,
            })
            .collect();
        let machine = &self.machine;
        let open = |session: &Session| {
            let finder = plugin_finder::finder(session, &self.told.over.plugins)?;
            let (dialect, _) = plugin_finder::dialect(&finder, machine, "ROUTE", None)?;
            let mut format = dialect.format().clone();
            // Axis values are wanted as they are solved.
            format.words.fill(EXACT);
            Ok(format)
        };
        let (format, _) = quietly(stop, open)?;
        let length = self.told.over.tool_length.unwrap_or(0.0);
        let found = whole_pass(machine, &format, length, &path, &|| stop())?;
        let count = self.kinematics.count();
        let mut q = vec![0.0; found.len() * count];
        for (joints, row) in found.iter().zip(q.chunks_exact_mut(count)) {
            self.kinematics.readings(joints, row);
        }
        Ok(q)
    }
}
