//! Machine files of classes whose law stands in formulas: that of the library's machine, with what the flags say in place of
//! its numbers.

use post_machine::description::{OutputUnits, Tcp};

use super::Choices;
use super::template::given;

/// The file: `text` is that of the library's machine `name`.
pub fn write(name: &str, text: &str, choices: &Choices) -> String {
    let mut file = format!(
        "# Written by `post new` from {name}.toml of the library: every number is an example until it was measured on the\n# machine.\n#\n"
    );
    let mut section = "";
    for line in text.lines() {
        if let Some(header) = line.strip_prefix('[') {
            section = header.trim_end_matches(']');
        }
        let key = line.split('=').next().unwrap_or_default().trim();
        // How one dialect is told the tool's direction is said for all of them; a machine without bodies has no clearance.
        if section.starts_with("control.") || section == "clearance" {
            continue;
        }
        match own_line(section, key, choices) {
            Some(own) => file.push_str(&own),
            None => file.push_str(line),
        }
        file.push('\n');
        if let ("control", "dialect") = (section, key) {
            if choices.tcp == Tcp::Control {
                file.push_str("orientation = \"vector\"                # the control finds the wrist's angles by itself\n");
            }
            if choices.units == OutputUnits::Inch {
                file.push_str("units   = \"inch\"                        # of the NC program; this file stays in mm\n");
            }
        }
        let axis = section.strip_prefix("axis.").unwrap_or_default();
        if matches!(key, "linear" | "rotary") && choices.reversed.iter().any(|own| own == axis) {
            file.push_str("reversed = true\n");
        }
    }
    file
}

/// What stands in the place of a line.
fn own_line(section: &str, key: &str, choices: &Choices) -> Option<String> {
    let axis = section.strip_prefix("axis.").unwrap_or_default();
    match (section, key) {
        ("", "name") => {
            let title = choices.title.replace('\\', "\\\\").replace('"', "\\\"");
            let title: String = title.chars().filter(|letter| !letter.is_control()).collect();
            Some(format!("name  = \"{title}\""))
        }
        ("control", "dialect") => Some(format!("dialect = \"{}\"", choices.dialect)),
        ("control", "tcp") => Some(format!("tcp     = \"{}\"", choices.tcp.name())),
        ("accuracy", "tolerance") => Some(format!("tolerance = {}", choices.tolerance)),
        (_, "travel" | "cyclic") if choices.cyclic.iter().any(|own| own == axis) => {
            Some("cyclic   = true".to_owned())
        }
        (_, "travel" | "cyclic") => {
            let [least, most] = given(&choices.travel, axis)?;
            Some(format!("travel   = [{least}, {most}]"))
        }
        (_, "max_feed") => Some(format!("max_feed = {}", given(&choices.max_feed, axis)?)),
        (_, "point") => {
            let [x, y, z] = given(&choices.point, axis)?;
            Some(format!("point    = [{x}, {y}, {z}]"))
        }
        _ => None,
    }
}
