//! `[[drive]]`: what a drive does that moves several axes at once, as a formula of these.

use std::sync::Arc;

use nalgebra::Vector3;
use post_grammar::text::excerpt;
use toml::Spanned;

use super::Axis;
use super::bounds::Bounds;
use super::build::Builder;
use super::formulas::{Formulas, Gathered};
use super::limits::MOST_LEGS;
use super::quantity::KeyedNumber;
use super::table::keys;
use crate::axis_formula::AxisFormula;
use crate::dependent_limit::SHOWN;
use crate::kinematics::{Drive, Leg};

const CODE: &str = "machine-drive";

keys! {
    /// A drive behind the axes of the program, by the formula that its maker or a paper has for it.
    DriveFile {
        /// What it is called.
        name: Spanned<String>,
        /// Where it stands, mm or degrees, of axes (mm or degrees, as the control shows them), formulas and parameters:
        /// `"sqrt(X^2 + Y^2 + Z^2)"`.
        is: Spanned<String>,
        /// It is an angle, degrees; without it a length, mm.
        turns: bool = Bounds::OFF,
        /// Least and largest value, mm or degrees, kept at the words and between them.
        travel: Option<Spanned<[KeyedNumber; 2]>>,
        /// Largest feed, mm/min or degrees/min.
        max_feed: Option<KeyedNumber> = Bounds::above_zero(CODE),
    }
}

impl Builder<'_> {
    /// The drives that formulas tell.
    pub(super) fn drives(
        &mut self,
        file: &[Spanned<DriveFile>],
        formulas: &Formulas,
        axes: &[Axis],
    ) -> Vec<Leg> {
        self.check_size("[[drive]]", file.iter().map(Spanned::span), MOST_LEGS);
        let file = file.iter().take(MOST_LEGS);
        file.filter_map(|given| self.formula_drive(given.get_ref(), formulas, axes)).collect()
    }

    fn formula_drive(
        &mut self,
        file: &DriveFile,
        formulas: &Formulas,
        axes: &[Axis],
    ) -> Option<Leg> {
        let expression = self.axis_expression(CODE, &file.is)?;
        let mut gathered = Gathered::new(formulas, axes);
        for name in expression.names() {
            self.gather(CODE, name, &file.is, &mut gathered)?;
        }
        let is = AxisFormula::new(gathered.names, expression);
        let text = excerpt(file.is.get_ref(), SHOWN);
        if is.axes() == 0 {
            let message = format!("`{text}` names no axis");
            let help = "a drive that no axis of the program moves is not said";
            self.fault(CODE, file.is.span(), message, help);
            return None;
        }
        let unit = if file.turns { 1f64.to_radians() } else { 1.0 };
        Some(Leg {
            name: excerpt(file.name.get_ref(), SHOWN).to_string(),
            first: 0,
            joints: Vec::new(),
            from: Vector3::zeros(),
            to: Vector3::zeros(),
            drive: Drive::Formula { is: Arc::new(is), turns: file.turns },
            zero: 0.0,
            travel: self.drive_travel(file.travel.as_ref(), unit, 0.0),
            max_feed: self.checked(&file.max_feed).map_or(f64::INFINITY, |feed| feed * unit),
        })
    }
}
