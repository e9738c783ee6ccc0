//! The C header says what `raw` says: its numbers are generated from it, and the C compiler checks that the
//! structs in it have them.

// Clippy lets test functions unwrap, but not the helpers beside them.
#![allow(clippy::unwrap_used)]

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use post_plugin::raw::{self, LAYOUTS, TABLES};
use post_plugin::{CAPABILITIES, CODES, EVENTS, FieldShape};

const BEGIN: &str = "/* generated: begin */\n";
const END: &str = "/* generated: end */\n";

/// The code whose names stand with the assertions, in a file of their own: there are many, and only a vocabulary says them.
const MEANINGS: &str = "MEANING";

fn header(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("include").join(file)
}

fn numbers() -> String {
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
        OPTION_FLAG OPTION_INTEGER OPTION_NUMBER OPTION_TEXT OPTION_CHOICE OPTION_LINES
    }
    codes(&mut text, |name| name != MEANINGS);
    for capability in CAPABILITIES {
        comment(&mut text, capability.doc);
        let (name, bits) = (capability.name, capability.set.bits());
        writeln!(text, "#define POST_WRITES_{name} 0x{bits:016x}u").unwrap();
    }
    events(&mut text);
    text
}

fn tables() -> String {
    let mut text = String::new();
    codes(&mut text, |name| name == MEANINGS);
    for layout in LAYOUTS.iter().chain(TABLES) {
        let name = layout.name;
        writeln!(
            text,
            "POST_ASSERT(sizeof({name}) == {} && POST_ALIGN({name}) == {}, \"{name}\");",
            layout.size, layout.align
        )
        .unwrap();
        for (field, offset) in layout.fields {
            writeln!(
                text,
                "POST_ASSERT(offsetof({name}, {field}) == {offset}, \"{name}.{field}\");"
            )
            .unwrap();
        }
    }
    text
}

fn codes(text: &mut String, wanted: fn(&str) -> bool) {
    for codes in CODES.iter().filter(|codes| wanted(codes.name)) {
        for (name, code) in codes.codes {
            writeln!(text, "#define POST_{}_{name} {code}u", codes.name).unwrap();
        }
    }
}

/// The kinds, and where the numbers of each stand: places have names apart from those of what stands there.
fn events(text: &mut String) {
    for event in EVENTS {
        comment(text, event.doc);
        writeln!(text, "#define POST_EVENT_{} {}u", event.c_name, event.kind).unwrap();
        // Behind a list nobody knows where the next number stands.
        let mut numbers = Some(0);
        let mut texts = 0;
        for field in event.fields {
            let name = format!("{}_{}", event.c_name, field.name.to_uppercase());
            let doc = field.doc.trim();
            match field.shape {
                FieldShape::Text => {
                    comment(text, &format!("texts[{texts}], {}: {doc}", field.name));
                    texts += 1;
                }
                FieldShape::Numbers(count) => {
                    let at = numbers.expect("numbers stand before lists");
                    let count_of = match count {
                        1 => String::new(),
                        _ => format!("{count} numbers: "),
                    };
                    comment(text, &format!("{count_of}{doc}"));
                    writeln!(text, "#define POST_AT_{name} {at}u").unwrap();
                    numbers = Some(at + count);
                }
                FieldShape::List => {
                    let list = "how many there are, and behind it as many";
                    match numbers {
                        Some(at) => {
                            comment(text, &format!("{list}: {doc}"));
                            writeln!(text, "#define POST_AT_{name} {at}u").unwrap();
                        }
                        None => comment(text, &format!("then {}, {list}: {doc}", field.name)),
                    }
                    numbers = None;
                }
            }
        }
    }
}

/// Documentation as a C comment, without the links of rustdoc.
fn comment(text: &mut String, doc: &str) {
    let mut plain = String::new();
    let mut rest = doc.trim();
    while let Some((before, link)) = rest.split_once("[`") {
        let (name, after) = link.split_once("`]").unwrap();
        plain.push_str(before);
        plain.push_str(name);
        rest = match after.strip_prefix('(') {
            Some(target) => target.split_once(')').unwrap().1,
            None => after,
        };
    }
    plain.push_str(rest);
    let mut line = String::from("/*");
    for word in plain.replace('`', "").split_whitespace() {
        if line.len() + word.len() > 112 {
            text.push_str(line.trim_end());
            text.push('\n');
            line = String::from(" *");
        }
        line.push(' ');
        line.push_str(word);
    }
    text.push_str(&line);
    text.push_str(" */\n");
}

#[test]
fn the_numbers_in_the_header_are_ours() {
    for (file, wanted) in [("post_plugin.h", numbers()), ("post_plugin_tables.h", tables())] {
        let text = std::fs::read_to_string(header(file)).unwrap();
        let (before, rest) = text.split_once(BEGIN).unwrap();
        let (found, after) = rest.split_once(END).unwrap();
        if std::env::var_os("UPDATE_HEADER").is_some() {
            std::fs::write(header(file), format!("{before}{BEGIN}{wanted}{END}{after}")).unwrap();
            continue;
        }
        assert!(
            found == wanted,
            "{file} is stale: run UPDATE_HEADER=1 cargo test -p post-plugin --test it header"
        );
    }
}

#[cfg(unix)]
#[test]
#[cfg_attr(miri, ignore = "Miri starts no compiler")]
fn the_c_compiler_agrees_with_the_header() {
    for (language, standard) in [("c", "c11"), ("c++", "c++11")] {
        let mut compiler = Command::new("cc");
        compiler
            .args(["-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-pedantic"])
            .args(["-x", language, &format!("-std={standard}")])
            .arg(header("post_plugin.h"));
        let output = compiler.output().expect("a C compiler called cc");
        let message = String::from_utf8_lossy(&output.stderr);
        // A compiler may come without its C++ half.
        if language == "c++" && message.contains("cc1plus") {
            continue;
        }
        assert!(output.status.success(), "as {standard}: {message}");
    }
}
