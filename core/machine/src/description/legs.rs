//! `[[leg]]`: what drives the platform of a parallel machine.

use std::ops::Range;

use nalgebra::Vector3;
use post_grammar::text::excerpt;
use toml::Spanned;

use super::Axis;
use super::bounds::Bounds;
use super::build::Builder;
use super::file::MachineFile;
use super::formulas::Formulas;
use super::keys::axes_are;
use super::limits::MOST_LEGS;
use super::quantity::KeyedNumber;
use super::table::{keys, words};
use crate::dependent_limit::{DependentLimit, SHOWN};
use crate::kinematics::{Drive, Leg};

const CODE: &str = "machine-leg";

const SIZE: Bounds = Bounds::above_zero(CODE);

keys! {
    /// A leg of a parallel machine: the chain says how its platform can move, legs say what drives do then. Without `slide`
    /// and `shaft` the leg itself grows, and its drive is its length.
    LegFile {
        /// What its drive is called.
        name: Spanned<String>,
        /// The axis whose link carries its end nearer the bed; without it the bed does.
        on: Option<Spanned<String>>,
        /// Its end nearer the bed, mm, machine frame, all axes and drives at zero: the joint of a strut, that of the slide, or
        /// any point of the shaft in the plane in which the crank turns.
        from: [KeyedNumber; 3],
        /// The axis whose link is the platform.
        at: Spanned<String>,
        /// Its end on the platform, mm, machine frame, all axes at zero.
        to: [KeyedNumber; 3],
        /// Direction in which its end nearer the bed slides; the drive is the way of that, mm.
        slide: Option<[KeyedNumber; 3]>,
        /// Direction of the shaft that carries its end nearer the bed, right-handed; the drive is the angle of that, degrees.
        shaft: Option<[KeyedNumber; 3]>,
        /// From the shaft to that end with the drive at zero, mm, across the shaft.
        arm: Option<[KeyedNumber; 3]>,
        /// Length of the rod between both ends, mm; a strut has none.
        rod: Option<KeyedNumber> = SIZE,
        /// Which of both places of the slide or crank is meant.
        side: LegSide = Bounds { default: Some("\"ahead\""), ..Bounds::ANY },
        /// What the control shows where the drive is at zero, mm or degrees.
        zero: Option<KeyedNumber>,
        /// Least and largest value that the control shows of the drive, mm or degrees.
        travel: Option<Spanned<[KeyedNumber; 2]>>,
        /// Largest feed of the drive, mm/min or degrees/min.
        max_feed: Option<KeyedNumber> = SIZE,
    }
}

words! {
    /// Which of both places of a slide or crank is meant: both reach the platform.
    LegSide = Ahead {
        /// The one with the larger value of the drive.
        Ahead "ahead",
        /// The one with the smaller value of the drive.
        Behind "behind",
    }
}

impl Builder<'_> {
    /// The legs and drives, each as the limit that it is to `axes`.
    pub(super) fn legs(
        &mut self,
        file: &MachineFile,
        formulas: &Formulas,
        axes: &[Axis],
    ) -> Vec<DependentLimit> {
        let legs = file.leg.iter().map(|leg| &leg.get_ref().name);
        let drives = file.drive.iter().map(|drive| &drive.get_ref().name);
        let names: Vec<&Spanned<String>> = legs.chain(drives).collect();
        self.check_size("[[leg]]", file.leg.iter().map(Spanned::span), MOST_LEGS);
        for (place, name) in names.iter().enumerate() {
            let taken = axes.iter().any(|axis| axis.name == *name.get_ref())
                || names[..place].iter().any(|other| other.get_ref() == name.get_ref());
            if taken {
                let name_text = excerpt(name.get_ref(), SHOWN);
                let message = format!("{name_text} is the name of another axis or leg");
                self.fault(CODE, name.span(), message, "each has one of its own");
            }
        }
        let given = file.leg.iter().take(MOST_LEGS);
        let legs = given.filter_map(|given| self.leg(given.get_ref(), given.span(), axes));
        let mut legs: Vec<Leg> = legs.collect();
        legs.extend(self.drives(&file.drive, formulas, axes));
        legs.into_iter().map(DependentLimit::of_leg).collect()
    }

    /// The travel of a drive that the control shows as `zero` where it stands at zero, mm or radians.
    pub(super) fn drive_travel(
        &mut self,
        travel: Option<&Spanned<[KeyedNumber; 2]>>,
        unit: f64,
        zero: f64,
    ) -> Option<[f64; 2]> {
        let travel = travel?;
        let [least, most] = [0, 1].map(|end| self.number(&travel.get_ref()[end]));
        if least >= most {
            let message =
                format!("the travel goes from {least} to {most}: the first must be the smaller");
            self.fault("machine-travel", travel.span(), message, "travel = [least, most]");
        }
        Some([least * unit - zero, most * unit - zero])
    }

    fn leg(&mut self, file: &LegFile, span: Range<usize>, axes: &[Axis]) -> Option<Leg> {
        let name = excerpt(file.name.get_ref(), SHOWN).to_string();
        let bed = axes.iter().take_while(|axis| axis.carries_part).count();
        let first = match &file.on {
            Some(on) => self.link(on, axes)? + 1,
            None => bed,
        };
        let last = self.link(&file.at, axes)?;
        if first > last {
            let message = format!("leg {name} ends on the link that it begins on, or before it");
            let help = "on = nearer the bed, at = nearer the tool";
            self.fault(CODE, file.at.span(), message, help);
            return None;
        }
        let drive = self.leg_drive(file, &name, span)?;
        let turns = matches!(drive, Drive::Crank { .. });
        let unit = if turns { 1f64.to_radians() } else { 1.0 };
        let zero = file.zero.as_ref().map_or(0.0, |zero| self.number(zero)) * unit;
        let travel = self.drive_travel(file.travel.as_ref(), unit, zero);
        let max_feed = self.checked(&file.max_feed).map_or(f64::INFINITY, |feed| feed * unit);
        Some(Leg {
            name,
            first,
            joints: axes[first..=last].iter().map(|axis| axis.joint).collect(),
            from: self.vector(&file.from),
            to: self.vector(&file.to),
            drive,
            zero,
            travel,
            max_feed,
        })
    }

    /// The place of the axis that moves a link of the tool's side.
    fn link(&mut self, name: &Spanned<String>, axes: &[Axis]) -> Option<usize> {
        let place = axes.iter().position(|axis| axis.name == *name.get_ref());
        let text = excerpt(name.get_ref(), SHOWN);
        let Some(place) = place else {
            let message = format!("{text} is no axis; {}", axes_are(axes));
            self.fault(CODE, name.span(), message, "");
            return None;
        };
        if axes[place].carries_part {
            let message = format!("{text} carries the part: legs carry the tool");
            let help = "for a platform that carries the part write the chain as if it carried the tool, and turn directions round";
            self.fault(CODE, name.span(), message, help);
            return None;
        }
        Some(place)
    }

    fn leg_drive(&mut self, file: &LegFile, name: &str, span: Range<usize>) -> Option<Drive> {
        let rod = self.checked(&file.rod);
        let ahead = file.side == LegSide::Ahead;
        match (&file.slide, &file.shaft, &file.arm, rod) {
            (None, None, None, None) => Some(Drive::Strut),
            (Some(slide), None, None, Some(rod)) => {
                let along = self.direction("the direction of a slide", slide)?;
                Some(Drive::Slide { along, rod, ahead })
            }
            (None, Some(shaft), Some(arm), Some(rod)) => {
                let about = self.direction("the direction of a shaft", shaft)?;
                let arm: Vector3<f64> = self.vector(arm);
                if libm::fabs(about.dot(&arm)) > 1e-6 * arm.norm() || arm.norm() < 1e-6 {
                    let message = format!("the arm of leg {name} does not stand across its shaft");
                    let help = "arm leads from the shaft to the joint that it carries";
                    self.fault(CODE, span, message, help);
                    return None;
                }
                Some(Drive::Crank { about, arm, rod, ahead })
            }
            _ => {
                let message = format!("leg {name} is neither a strut, nor a slide, nor a crank");
                let help = "a strut has none of slide, shaft, arm and rod; a slide has slide and rod; a crank has shaft, arm and rod";
                self.fault(CODE, span, message, help);
                None
            }
        }
    }
}
