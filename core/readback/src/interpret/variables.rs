//! Variables of a program: what it has set itself is known, everything else stands in the control and is refused.

use std::collections::{BTreeMap, BTreeSet};

use post_machine::diagnostic::Diagnostic;
use post_plugin::Language;

/// Variables that one program may hold: a text that sets more is refused.
const MOST: usize = 100_000;

/// What a variable holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum VariableValue {
    /// A number.
    Number(f64),
    /// A text.
    Text(String),
}

/// The variables that a program has set.
#[derive(Clone, Debug, Default)]
pub(super) struct Variables {
    language: Language,
    global: BTreeMap<String, VariableValue>,
    /// Variables of each subprogram that is running, the main program's first, the innermost one's last.
    local: Vec<BTreeMap<String, VariableValue>>,
    /// Names that `DEF INT` or `DEF BOOL` declared: they hold whole numbers.
    whole: BTreeMap<String, ()>,
    /// Fields that `DEF` declared.
    fields: BTreeSet<String>,
}

impl Variables {
    /// No variable is set yet.
    pub fn new(language: Language) -> Self {
        Self { language, local: vec![BTreeMap::new()], ..Self::default() }
    }

    /// Whose language it is.
    pub fn language(&self) -> Language {
        self.language
    }

    /// What `name` holds: `#1`, `R5`, `Q200`, `_Z_HOME`; in capitals.
    ///
    /// # Errors
    /// The program has not set it.
    pub fn get(&self, name: &str) -> Result<&VariableValue, Box<Diagnostic>> {
        let found = match self.is_local(name) {
            true => self.local.last().and_then(|local| local.get(name)),
            false => self.global.get(name),
        };
        found.ok_or_else(|| unknown(name, self.held_by_control(name)))
    }

    /// The program has declared or set a variable of this name.
    pub fn knows(&self, name: &str) -> bool {
        self.global.contains_key(name)
    }

    /// `name` holds `value` from here on.
    ///
    /// # Errors
    /// It is a variable by which the control itself is changed, or there are too many.
    pub fn set(&mut self, name: &str, value: VariableValue) -> Result<(), Box<Diagnostic>> {
        if self.held_by_control(name) {
            return Err(Diagnostic::error(
                "nc-variable",
                format!("`{name}` is given a value: it belongs to the control, and what that changes there is not followed"),
            )
            .help("leave the block out of the program that is read, or state its effect by --offsets")
            .boxed());
        }
        let value = match value {
            VariableValue::Number(number) if self.whole.contains_key(name) => {
                VariableValue::Number(libm::round(number))
            }
            other => other,
        };
        self.put(name, value)
    }

    /// The control sets `name` itself, as a plane with STAY sets `Q120`.
    ///
    /// # Errors
    /// There are too many.
    pub fn put(&mut self, name: &str, value: VariableValue) -> Result<(), Box<Diagnostic>> {
        let local = self.is_local(name);
        let map = match self.local.last_mut() {
            Some(innermost) if local => innermost,
            _ => &mut self.global,
        };
        if map.len() >= MOST && !map.contains_key(name) {
            return Err(too_many(name));
        }
        map.insert(name.to_owned(), value);
        Ok(())
    }

    /// `DEF`: a name exists from here on. Without a value a number is zero and a text is empty, as the control sets
    /// them.
    ///
    /// # Errors
    /// There are too many.
    pub fn define(
        &mut self,
        kind: &str,
        name: &str,
        value: Option<VariableValue>,
    ) -> Result<(), Box<Diagnostic>> {
        if matches!(kind, "INT" | "BOOL" | "CHAR") {
            self.whole.insert(name.to_owned(), ());
        }
        let value = value.unwrap_or(match kind {
            "STRING" => VariableValue::Text(String::new()),
            _ => VariableValue::Number(0.0),
        });
        self.set(name, value)
    }

    /// `DEF REAL A[5]`: a field exists from here on.
    ///
    /// # Errors
    /// There are too many.
    pub fn define_field(&mut self, name: &str) -> Result<(), Box<Diagnostic>> {
        if self.fields.len() >= MOST && !self.fields.contains(name) {
            return Err(too_many(name));
        }
        self.fields.insert(name.to_owned());
        Ok(())
    }

    /// An element of this field can be set: R of a Siemens, what `DEF` declared, and by the custom of builders' own what
    /// begins with `_`. What begins with `$` is the control's, and told so.
    pub fn has_field(&self, name: &str) -> bool {
        name == "R" || name.starts_with(['_', '$']) || self.fields.contains(name)
    }

    /// A subprogram begins, with these variables of its own.
    pub fn enter(&mut self, own: impl IntoIterator<Item = (String, f64)>) {
        let own = own.into_iter();
        self.local.push(own.map(|(name, value)| (name, VariableValue::Number(value))).collect());
    }

    /// A subprogram ends.
    pub fn leave(&mut self) {
        if self.local.len() > 1 {
            self.local.pop();
        }
    }

    /// Each running subprogram has one of its own.
    fn is_local(&self, name: &str) -> bool {
        match self.language {
            Language::Macro => hash(name).is_some_and(|number| (1..=33).contains(&number)),
            Language::Rs274 => match hash(name) {
                Some(number) => (1..=30).contains(&number),
                None => name.starts_with("#<") && !name.starts_with("#<_"),
            },
            // The names of a subprogram in the same file are those of the program.
            Language::Names | Language::Instructions | Language::Joints => false,
            Language::Conversational => name.starts_with("QL"),
        }
    }

    /// Whether the variable is read from the control or changes it.
    fn held_by_control(&self, name: &str) -> bool {
        match self.language {
            Language::Macro => {
                !hash(name).is_some_and(|number| matches!(number, 1..=33 | 100..=199 | 500..=999))
            }
            Language::Rs274 => match hash(name) {
                Some(number) => !(1..=5060).contains(&number),
                None => RS274_OWN.contains(&name),
            },
            Language::Names => name.starts_with('$'),
            // Its programs set none that is read.
            Language::Instructions | Language::Joints => true,
            Language::Conversational => {
                let digits = name.trim_start_matches(['Q', 'L', 'R', 'S']);
                let number: Option<u32> = digits.parse().ok();
                !name.starts_with("QL")
                    && !name.starts_with("QR")
                    && number.is_none_or(|number| (100..200).contains(&number))
            }
        }
    }
}

/// Named parameters that its interpreter answers itself.
const RS274_OWN: &[&str] = &[
    "#<_VMAJOR>",
    "#<_VMINOR>",
    "#<_LINE>",
    "#<_MOTION_MODE>",
    "#<_PLANE>",
    "#<_CCOMP>",
    "#<_METRIC>",
    "#<_IMPERIAL>",
    "#<_ABSOLUTE>",
    "#<_INCREMENTAL>",
    "#<_INVERSE_TIME>",
    "#<_UNITS_PER_MINUTE>",
    "#<_UNITS_PER_REV>",
    "#<_COORD_SYSTEM>",
    "#<_TOOL_OFFSET>",
    "#<_RETRACT_R_PLANE>",
    "#<_RETRACT_OLD_Z>",
    "#<_SPINDLE_RPM_MODE>",
    "#<_SPINDLE_CSS_MODE>",
    "#<_IJK_ABSOLUTE_MODE>",
    "#<_LATHE_DIAMETER_MODE>",
    "#<_LATHE_RADIUS_MODE>",
    "#<_SPINDLE_ON>",
    "#<_SPINDLE_CW>",
    "#<_MIST>",
    "#<_FLOOD>",
    "#<_SPEED_OVERRIDE>",
    "#<_FEED_OVERRIDE>",
    "#<_ADAPTIVE_FEED>",
    "#<_FEED_HOLD>",
    "#<_FEED>",
    "#<_RPM>",
    "#<_X>",
    "#<_Y>",
    "#<_Z>",
    "#<_A>",
    "#<_B>",
    "#<_C>",
    "#<_U>",
    "#<_V>",
    "#<_W>",
    "#<_ABS_X>",
    "#<_ABS_Y>",
    "#<_ABS_Z>",
    "#<_ABS_A>",
    "#<_ABS_B>",
    "#<_ABS_C>",
    "#<_CURRENT_TOOL>",
    "#<_CURRENT_POCKET>",
    "#<_SELECTED_TOOL>",
    "#<_SELECTED_POCKET>",
    "#<_VALUE>",
    "#<_VALUE_RETURNED>",
    "#<_TASK>",
    "#<_CALL_LEVEL>",
    "#<_REMAP_LEVEL>",
];

/// The number of `#12`.
fn hash(name: &str) -> Option<u32> {
    name.strip_prefix('#')?.parse().ok()
}

fn too_many(name: &str) -> Box<Diagnostic> {
    let number = MOST + 1;
    let message =
        format!("`{name}` would be the variable number {number}: no more than {MOST} are kept");
    Diagnostic::error("nc-variable", message).boxed()
}

fn unknown(name: &str, held_by_control: bool) -> Box<Diagnostic> {
    let message = match held_by_control {
        true => format!("`{name}` stands in the control: what it holds there is not known"),
        false => format!(
            "`{name}` has not been given a value by the program: what it holds is not known"
        ),
    };
    Diagnostic::error("nc-variable", message)
        .help("set it in a block in front, to the value that the machine has")
        .boxed()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(variables: &Variables, name: &str) -> Option<f64> {
        match variables.get(name) {
            Ok(VariableValue::Number(number)) => Some(*number),
            _ => None,
        }
    }

    #[test]
    fn what_the_program_has_not_set_is_refused() {
        for (language, name) in [
            (Language::Macro, "#1"),
            (Language::Macro, "#5021"),
            (Language::Rs274, "#<_X>"),
            (Language::Names, "$P_UIFR"),
            (Language::Names, "R1"),
            (Language::Conversational, "Q108"),
        ] {
            assert!(Variables::new(language).get(name).is_err(), "{name}");
        }
    }

    #[test]
    fn what_belongs_to_the_control_is_not_set() {
        for (language, name, allowed) in [
            (Language::Macro, "#100", true),
            (Language::Macro, "#5221", false),
            (Language::Macro, "#3000", false),
            (Language::Rs274, "#5060", true),
            (Language::Rs274, "#5220", false),
            (Language::Rs274, "#<_MINE>", true),
            (Language::Names, "$TC_DP3", false),
            (Language::Conversational, "Q99", true),
            (Language::Conversational, "Q120", false),
            (Language::Conversational, "QL120", true),
        ] {
            let mut variables = Variables::new(language);
            assert_eq!(variables.set(name, VariableValue::Number(1.0)).is_ok(), allowed, "{name}");
        }
    }

    #[test]
    fn a_subprogram_has_its_own() {
        let mut variables = Variables::new(Language::Macro);
        variables.set("#1", VariableValue::Number(5.0)).unwrap();
        variables.set("#100", VariableValue::Number(6.0)).unwrap();
        variables.enter([("#2".to_owned(), 7.0)]);
        assert_eq!(number(&variables, "#1"), None);
        assert_eq!(number(&variables, "#2"), Some(7.0));
        assert_eq!(number(&variables, "#100"), Some(6.0));
        variables.leave();
        assert_eq!(number(&variables, "#1"), Some(5.0));
        assert_eq!(number(&variables, "#2"), None);
    }

    #[test]
    fn whole_numbers_are_rounded() {
        let mut variables = Variables::new(Language::Names);
        variables.define("INT", "_N", None).unwrap();
        assert_eq!(number(&variables, "_N"), Some(0.0));
        variables.set("_N", VariableValue::Number(2.5)).unwrap();
        assert_eq!(number(&variables, "_N"), Some(3.0));
    }
}
