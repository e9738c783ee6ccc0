//! The C header says what `raw` says: its numbers are generated from it, and the C compiler checks that the
//! structs in it have them.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use post_plugin::raw::{self, LAYOUTS, TABLES};

const BEGIN: &str = "/* generated: begin */\n";
const END: &str = "/* generated: end */\n";

fn header() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include/post_plugin.h")
}

fn generated() -> String {
    let mut text = String::new();
    macro_rules! define {
        ($($name:ident)*) => {
            $(writeln!(text, "#define POST_{} {}u", stringify!($name), raw::$name).unwrap();)*
        };
    }
    writeln!(text, "#define POST_MAGIC 0x{:016x}u", raw::MAGIC).unwrap();
    writeln!(text, "#define POST_LAYOUT 0x{:016x}u", raw::LAYOUT).unwrap();
    define! {
        ABI KIND_DIALECT KIND_MODEL MAX_WORDS
        OPTION_FLAG OPTION_INTEGER OPTION_NUMBER OPTION_TEXT OPTION_CHOICE
        UNITS_MILLIMETRE UNITS_INCH
        EVENT_START EVENT_COMMENT EVENT_LITERAL EVENT_TOOL_CHANGE EVENT_PRESELECT EVENT_SPINDLE
        EVENT_COOLANT EVENT_COMPENSATE EVENT_POSITION EVENT_RELEASE EVENT_RAPID EVENT_LINEAR
        EVENT_DWELL EVENT_STOP EVENT_OPTIONAL_STOP EVENT_HOME EVENT_END EVENT_WORD
        FEED_NONE FEED_PER_MINUTE FEED_INVERSE_TIME FEED_PER_REVOLUTION
        SPINDLE_OFF SPINDLE_CLOCKWISE SPINDLE_COUNTER_CLOCKWISE SPINDLE_ORIENT
        COOLANT_OFF COOLANT_FLOOD COOLANT_MIST COOLANT_THROUGH COOLANT_AIR
        COMPENSATE_OFF COMPENSATE_LEFT COMPENSATE_RIGHT
    }
    for layout in LAYOUTS.iter().chain(TABLES) {
        let name = layout.name;
        writeln!(
            text,
            "POST_ASSERT(sizeof({name}) == {} && POST_ALIGN({name}) == {}, \"{name}\");",
            layout.size, layout.align
        )
        .unwrap();
        for (field, offset) in layout.fields {
            let field = match *field {
                "register" => "register_",
                other => other,
            };
            writeln!(
                text,
                "POST_ASSERT(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");"
            )
            .unwrap();
        }
    }
    text
}

#[test]
fn the_numbers_in_the_header_are_ours() {
    let text = std::fs::read_to_string(header()).unwrap();
    let (before, rest) = text.split_once(BEGIN).unwrap();
    let (found, after) = rest.split_once(END).unwrap();
    let wanted = generated();
    if std::env::var_os("UPDATE_HEADER").is_some() {
        std::fs::write(header(), format!("{before}{BEGIN}{wanted}{END}{after}")).unwrap();
        return;
    }
    assert!(
        found == wanted,
        "post_plugin.h is stale: run UPDATE_HEADER=1 cargo test -p post-plugin --test it header"
    );
}

#[cfg(unix)]
#[test]
fn the_c_compiler_agrees_with_the_header() {
    for (language, standard) in [("c", "c11"), ("c++", "c++11")] {
        let mut compiler = Command::new("cc");
        compiler
            .args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-pedantic"])
            .args(["-x", language, &format!("-std={standard}")])
            .arg(header());
        let output = compiler.output().expect("a C compiler called cc");
        let message = String::from_utf8_lossy(&output.stderr);
        // A compiler may come without its C++ half.
        if language == "c++" && message.contains("cc1plus") {
            continue;
        }
        assert!(output.status.success(), "as {standard}: {message}");
    }
}
