//! The tool and the frame that a robot's straight moves go by. Its poses are those of the machine file only if both are
//! the machine file's.

use post_grammar::nc::NcTerm;
use post_machine::diagnostic::Diagnostic;
use post_plugin::Meaning;

use super::relied::ModalGroup;
use super::state::ControlState;
use crate::lexicon::WordMeaning;

/// What the program has said of both, as it is written there; none where it has said nothing.
#[derive(Clone, Debug, Default)]
pub(super) struct RobotFrames {
    tool: Option<String>,
    base: Option<String>,
}

/// Base of a move of RAPID that names none (RAPID reference manual, MoveL: `\WObj` left out is the world).
const WORLD: &str = "WOBJ0";

impl ControlState {
    /// `$TOOL=TOOL_DATA[1]`, `$BASE=$NULLFRAME`, `set_tcp(..)`.
    pub(super) fn set_robot_frame(&mut self, group: ModalGroup, to: &[NcTerm]) {
        self.robot_frame_is(group, written(to));
    }

    fn robot_frame_is(&mut self, group: ModalGroup, to: String) {
        match group {
            ModalGroup::ToolFrame => self.robot_frames.tool = Some(to),
            _ => self.robot_frames.base = Some(to),
        }
        self.modal.unset &= !group.bit();
    }

    /// `BAS(#TOOL,3)` and `BAS(#BASE,0)` set one of both by its number; `BAS(#INITMOV,0)` and `BAS(#FRAMES)` both from the
    /// control's defaults, which no program says; those that set accelerations and speeds of joints neither.
    pub(super) fn set_robot_frames(&mut self, terms: &[NcTerm]) -> Result<(), Box<Diagnostic>> {
        let [NcTerm::Group(b'(', inside)] = terms else {
            return Err(self.refuse("nc-statement", "what BAS sets is not understood"));
        };
        let mut parts = inside.split(|term| *term == NcTerm::Sign(b','));
        let command = parts.next().map(written).unwrap_or_default();
        let number = match parts.next() {
            Some([NcTerm::Number(number)]) => Some(number.value),
            _ => None,
        };
        let numbered = |list: &str| match number {
            Some(0.0) => "$NULLFRAME".to_owned(),
            Some(number) => format!("{list}[{number}]"),
            None => list.to_owned(),
        };
        match command.trim_start_matches('#') {
            "TOOL" => self.robot_frame_is(ModalGroup::ToolFrame, numbered("TOOL_DATA")),
            "BASE" => self.robot_frame_is(ModalGroup::BaseFrame, numbered("BASE_DATA")),
            "VEL_PTP" | "ACC_CP" | "ACC_PTP" | "ACC_ROT" | "ACC_ORI" | "PTP_DAT" => {}
            // KUKA's BAS.SRC sets $VEL.CP and its like in these.
            "VEL_CP" | "VEL_ROT" | "CP_DAT" | "CP_PARAMS" => {
                let message =
                    format!("BAS({command}) sets speeds of straight moves: that is not followed");
                return Err(self.refuse("nc-statement", message));
            }
            "INITMOV" | "FRAMES" | "PTP_PARAMS" | "EX_BASE" => {
                let both = ModalGroup::ToolFrame.bit() | ModalGroup::BaseFrame.bit();
                self.robot_frames = RobotFrames::default();
                self.modal.unset |= self.lexicon.modes() & both;
            }
            _ => {
                let message =
                    format!("BAS({command}) is not known here, and may set tool, frame or speed");
                return Err(self.refuse("nc-statement", message));
            }
        }
        Ok(())
    }

    /// The tool and the work object that a move of RAPID names itself: `spindle\WObj:=wobj0`.
    pub(super) fn move_names_frames(
        &mut self,
        name: &str,
        argument: Option<&&[NcTerm]>,
    ) -> Result<(), Box<Diagnostic>> {
        let Some([NcTerm::Name(tool), switches @ ..]) = argument else {
            return Err(self.refuse("nc-statement", format!("{name} names no tool")));
        };
        let mut base = WORLD.to_owned();
        for switch in switches.split(|term| *term == NcTerm::Sign(b'\\')).skip(1) {
            match switch {
                [NcTerm::Name(key), NcTerm::Sign(b':'), NcTerm::Sign(b'='), value @ ..]
                    if key == "WOBJ" =>
                {
                    base = written(value);
                }
                [NcTerm::Name(key), ..] if key == "TLOAD" => {}
                _ => {
                    let message = format!("a switch behind the tool of {name} is not understood");
                    return Err(self.refuse("nc-statement", message));
                }
            }
        }
        self.robot_frames = RobotFrames { tool: Some(tool.clone()), base: Some(base) };
        Ok(())
    }

    /// A straight move goes by both.
    pub(super) fn relies_on_robot_frames(&mut self) {
        let frames = std::mem::take(&mut self.robot_frames);
        for (group, said, own) in [
            (ModalGroup::ToolFrame, &frames.tool, Meaning::OwnToolFrame),
            (ModalGroup::BaseFrame, &frames.base, Meaning::WorkOffsetOff),
        ] {
            match said {
                None => self.relies_on(group),
                Some(said) if self.lexicon.name(said) == WordMeaning::Means(own) => {}
                Some(said) => {
                    let wants = self.lexicon.name_of(own).map(str::to_owned);
                    self.stands_otherwise(group, said, wants);
                }
            }
        }
        self.robot_frames = frames;
    }
}

/// Terms as they are written, without blanks.
fn written(terms: &[NcTerm]) -> String {
    let mut text = String::new();
    for term in terms {
        match term {
            NcTerm::Name(name) => text.push_str(name),
            NcTerm::Number(number) => text.push_str(&number.value.to_string()),
            NcTerm::Text(quoted) => text.push_str(quoted),
            NcTerm::Sign(sign) => text.push(char::from(*sign)),
            NcTerm::Group(opens, inside) => {
                let closes = match opens {
                    b'(' => ')',
                    b'[' => ']',
                    _ => '}',
                };
                text.push(char::from(*opens));
                text.push_str(&written(inside));
                text.push(closes);
            }
        }
    }
    text
}
