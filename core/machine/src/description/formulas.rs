//! `[formulas]`: quantities of axes by names of the file's own.

use std::collections::BTreeMap;

use post_grammar::text::excerpt;
use post_grammar::{Expression, parse_expression};
use toml::Spanned;

use super::Axis;
use super::build::Builder;
use crate::axis_formula::FormulaNames;
use crate::dependent_limit::SHOWN;

const CODE: &str = "machine-formula";

/// Formulas of the file by their names: those that can be read.
pub(super) type Formulas = BTreeMap<String, (Spanned<String>, Expression)>;

/// What the names of a formula stand for, as far as they are gathered.
pub(super) struct Gathered<'a> {
    formulas: &'a Formulas,
    axes: &'a [Axis],
    /// Formulas that wait for what they name.
    waiting: Vec<String>,
    /// What is gathered.
    pub names: FormulaNames,
}

impl<'a> Gathered<'a> {
    /// Nothing yet.
    pub fn new(formulas: &'a Formulas, axes: &'a [Axis]) -> Self {
        Self { formulas, axes, waiting: Vec::new(), names: FormulaNames::default() }
    }
}

impl Builder<'_> {
    /// The formulas of the file; that they name one another in a circle is told where one is used.
    pub(super) fn formulas(
        &mut self,
        file: &BTreeMap<Spanned<String>, Spanned<String>>,
        axes: &[Axis],
    ) -> Formulas {
        let mut formulas = Formulas::new();
        for (name, text) in file {
            let own = name.get_ref();
            let axis = axes.iter().any(|axis| axis.name == *own);
            if axis || own == "pi" || self.parameters.contains_key(own) {
                let message = format!("{} is the name of something else", excerpt(own, SHOWN));
                let help = "a formula is called as no axis and no parameter is";
                self.fault(CODE, name.span(), message, help);
                continue;
            }
            let known = |other: &str| file.keys().any(|key| key.get_ref() == other);
            let Some(expression) = self.axis_expression(CODE, text) else {
                continue;
            };
            let others = expression.names().into_iter().filter(|other| !known(other));
            let lacks: Vec<&str> =
                others.filter(|other| self.named(CODE, other, text, axes).is_none()).collect();
            if lacks.is_empty() {
                formulas.insert(own.clone(), (text.clone(), expression));
            }
        }
        formulas
    }

    /// An expression of axes.
    pub(super) fn axis_expression(
        &mut self,
        code: &'static str,
        text: &Spanned<String>,
    ) -> Option<Expression> {
        match parse_expression(text.get_ref()) {
            Ok(expression) => Some(expression),
            Err(fault) => {
                let message = format!("`{}`: {}", excerpt(text.get_ref(), SHOWN), fault.message);
                self.fault(code, text.span(), message, &fault.help.unwrap_or_default());
                None
            }
        }
    }

    /// Gathers what `name` stands for, which is written in `text`: with a formula what that is written with, before it.
    pub(super) fn gather(
        &mut self,
        code: &'static str,
        name: &str,
        text: &Spanned<String>,
        gathered: &mut Gathered<'_>,
    ) -> Option<()> {
        let FormulaNames { named, formulas } = &gathered.names;
        let is = |known: &String| known == name;
        if named.iter().any(|(known, _)| is(known)) || formulas.iter().any(|(known, _)| is(known)) {
            return Some(());
        }
        if gathered.waiting.iter().any(is) {
            let message = format!("{name}: formulas that are defined by one another in a circle");
            self.fault(CODE, text.span(), message, "");
            return None;
        }
        let all = gathered.formulas;
        let Some((of, expression)) = all.get(name) else {
            let named = self.named(code, name, text, gathered.axes)?;
            gathered.names.named.push((name.to_owned(), named));
            return Some(());
        };
        gathered.waiting.push(name.to_owned());
        for other in expression.names() {
            self.gather(CODE, other, of, gathered)?;
        }
        gathered.waiting.pop();
        gathered.names.formulas.push((name.to_owned(), expression.clone()));
        Some(())
    }
}
