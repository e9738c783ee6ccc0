//! Lines of the machine file's own, told apart in a program.

use post_machine::description::load;

use crate::source;

const FILE: &str = r#"
extends = "vmc"
[cl.words]
TOUCH = ["G65 P9811 Z{n:.3} Q{n2}", "CYCLE977({n})", "TCH PROBE 427 MEASURE ~", "Q263={n:.3} ;POINT"]
[program]
footer = ["M{{ tool.number }}", "({{ program.name }})", "{% if tool.number == 2 %}M51{% else %}M52{% endif %}"]
between_tools = ["MSG({{ tool.number }}{% if coolant is not none %} WET{% endif %})", "{% if coolant is none %}", "M77 M78", "{% endif %}"]
end = "M99"
"#;

#[test]
fn lines_of_the_machine_file_are_known_whatever_facts_stand_in_them() {
    let vmc = include_str!("../../../../machines/vmc.toml");
    let machine = load(source("mine.toml", FILE), &[], &mut |name| Ok(source(name, vmc))).unwrap();
    let declared = machine.declared_lines();
    for line in [
        "G65 P9811 Z-5.200 Q7",
        "N120 G65P9811Z5.Q0",
        "12 CYCLE977(3)",
        "MSG(3 WET)",
        "msg(3)",
        "M77 M78",
        "M99",
        "M51",
        "M52",
        "32 TCH PROBE 427 MEASURE   Q263=-1.000 ;POINT",
    ] {
        assert!(declared.has_line(line), "{line}");
    }
    // Another macro or word; patterns with a letter alone of their own are those of any line.
    for line in [
        "G65 P9812 Z-5.200 Q7",
        "G65 P9811 Q7",
        "CYCLE978(3)",
        "MSG 3",
        "M77",
        "M3",
        "(A)",
        "",
        "G1 X5",
    ] {
        assert!(!declared.has_line(line), "{line}");
    }
    assert!(declared.has_end("N9 M99") && !declared.has_end("M77 M78"));
    assert!(declared.has_word("M51") && declared.has_word("M77") && !declared.has_word("M3"));
}
