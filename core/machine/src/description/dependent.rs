//! `[[limit]]`: what must hold between the axes of a machine.

use post_grammar::parse_inequality;
use post_grammar::text::excerpt;
use toml::Spanned;

use super::Axis;
use super::build::Builder;
use super::formulas::{Formulas, Gathered};
use super::keys::axes_are;
use super::limits::MOST_AXIS_LIMITS;
use super::table::keys;
use crate::dependent_limit::{DependentLimit, Named, SHOWN};

keys! {
    /// A limit of axes that depends on other axes.
    LimitFile {
        /// What must hold, at the words and between them: two expressions with `>`, `>=`, `<` or `<=` between, of axes
        /// (mm or degrees, as the control shows them), formulas, parameters and numbers, such as `"Z > -300 + 2 * abs(B)"`.
        keep: Spanned<String>,
    }
}

impl Builder<'_> {
    /// What must hold between `axes`.
    pub(super) fn dependent_limits(
        &mut self,
        file: &[Spanned<LimitFile>],
        formulas: &Formulas,
        axes: &[Axis],
    ) -> Vec<DependentLimit> {
        self.check_size("[[limit]]", file.iter().map(Spanned::span), MOST_AXIS_LIMITS);
        let limits = file.iter().take(MOST_AXIS_LIMITS);
        limits
            .filter_map(|limit| self.dependent_limit(&limit.get_ref().keep, formulas, axes))
            .collect()
    }

    fn dependent_limit(
        &mut self,
        keep: &Spanned<String>,
        formulas: &Formulas,
        axes: &[Axis],
    ) -> Option<DependentLimit> {
        let text = excerpt(keep.get_ref(), SHOWN);
        let inequality = match parse_inequality(keep.get_ref()) {
            Ok(inequality) => inequality,
            Err(fault) => {
                let message = format!("`{text}`: {}", fault.message);
                let help = fault.help.unwrap_or_default();
                self.fault("machine-limit", keep.span(), message, &help);
                return None;
            }
        };
        let mut gathered = Gathered::new(formulas, axes);
        for (_, name) in inequality.references() {
            self.gather("machine-limit", name, keep, &mut gathered)?;
        }
        let names = gathered.names;
        let limit = DependentLimit::new(keep.get_ref(), inequality, names);
        if limit.joints().next().is_none() {
            let message = format!("`{text}` names no axis: {}", axes_are(axes));
            let help = "it says where an axis may stand: Z > -300 + 2 * abs(B)";
            self.fault("machine-limit", keep.span(), message, help);
            return None;
        }
        Some(limit)
    }

    /// What a name in a limit or a formula stands for.
    pub(super) fn named(
        &mut self,
        code: &'static str,
        name: &str,
        keep: &Spanned<String>,
        axes: &[Axis],
    ) -> Option<Named> {
        let axis = axes.iter().position(|axis| axis.name == name);
        let text = excerpt(keep.get_ref(), SHOWN);
        let parameter = self.values.get(name).copied();
        match (axis, parameter) {
            (Some(_), Some(_)) => {
                let message = format!("`{text}`: {name} is an axis and a parameter");
                self.fault(code, keep.span(), message, "rename the parameter");
                None
            }
            (Some(joint), None) => Some(Named::of(joint, &axes[joint])),
            (None, Some(value)) => Some(Named::Parameter(value)),
            // That it has no value is told where it stands.
            (None, None) if self.without.contains(name) => None,
            (None, None) => {
                let message = format!(
                    "`{text}`: {name} is neither an axis nor a parameter; {}",
                    axes_are(axes)
                );
                self.fault(code, keep.span(), message, "");
                None
            }
        }
    }
}
