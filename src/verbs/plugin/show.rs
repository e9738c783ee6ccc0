//! `post plugin show`: the options of a plugin, what a dialect writes, and the words of its control.

use std::path::PathBuf;

use clap::Args;
use post_host::{OpenedDialect, Plugin, PluginKind, ProgramSetup, ProgramWord, default_of, takes};
use post_machine::diagnostic::Diagnostic;
use post_plugin::{CAPABILITIES, CODES, DialectSession, Format};

use super::title;
use post_cli::terminal::print;
use post_job::failure::Failure;
use post_job::plugin_finder::by_name_or_file;
use post_job::session::Session;

/// Prints the options of a plugin, and what a dialect writes.
#[derive(Debug, Args)]
pub struct ShowArguments {
    /// The name of a plugin in a folder of --plugins or built in, or a library. Opening a library runs its code.
    #[arg(value_name = "PLUGIN")]
    plugin: PathBuf,

    /// Also the words of a dialect's control and what they mean, by which its programs can be read back.
    #[arg(long)]
    vocabulary: bool,

    /// A folder of plugin libraries; POST_PLUGINS adds more.
    #[arg(long, value_name = "FOLDER")]
    plugins: Vec<PathBuf>,
}

/// Does as the arguments say.
pub fn run(session: &Session, arguments: &ShowArguments) -> Result<(), Failure> {
    let plugin = by_name_or_file(session, &arguments.plugin, &arguments.plugins)?;
    let mut text = format!("{}\n", title(&plugin));
    if !plugin.about().is_empty() {
        text.push_str(&format!("{}\n", plugin.about()));
    }
    text.push_str(&options(&plugin));
    if plugin.kind() == PluginKind::Dialect {
        text.push_str(&match plugin.dialect(&five_axes()) {
            Ok(mut opened) => {
                let mut told = writes(&opened);
                told.push_str(&relied_on(&mut opened)?);
                if arguments.vocabulary {
                    told.push_str(&vocabulary(&mut opened)?);
                }
                told
            }
            Err(fault) => format!("\nWhat it writes cannot be asked: {fault}\n"),
        });
    } else if arguments.vocabulary {
        text.push_str("\nOnly a dialect has a vocabulary.\n");
    }
    print(session, &text);
    Ok(())
}

fn options(plugin: &Plugin) -> String {
    let section = match plugin.kind() {
        PluginKind::Dialect => "control",
        PluginKind::ErrorModel => "accuracy",
    };
    if plugin.options().is_empty() {
        return "\nIt has no options.\n".to_owned();
    }
    let mut text = format!("\nOptions, [{section}.{}]:\n", plugin.name());
    for spec in plugin.options() {
        let (key, default) = (spec.key, default_of(spec));
        text.push_str(&format!("  {key} = {default}    # {}\n", takes(spec.kind)));
        if !spec.help.is_empty() {
            text.push_str(&format!("      {}\n", spec.help));
        }
    }
    text
}

fn writes(opened: &OpenedDialect) -> String {
    let format = opened.format();
    let mut text = format!("\nNumbers: {}\n", numbers(format));
    let capabilities = opened.capabilities();
    let written = CAPABILITIES.iter().filter(|spec| capabilities.has(spec.set));
    let mut known = 0;
    let mut rows = String::new();
    for spec in written {
        known |= spec.set.bits();
        let doc = spec.doc.trim().replace('`', "");
        rows.push_str(&format!("  {:<16} {doc}\n", spec.name));
    }
    match rows.as_str() {
        "" => text.push_str("\nIt writes straight moves and plain commands alone.\n"),
        rows => text.push_str(&format!("\nBeyond straight moves it writes:\n{rows}")),
    }
    let unknown = (capabilities.bits() & !known).count_ones();
    if unknown > 0 {
        text.push_str(&format!(
            "  and {unknown} more that this version does not know and does not ask for\n"
        ));
    }
    text
}

/// What its programs rely on at the control.
fn relied_on(opened: &mut OpenedDialect) -> Result<String, Failure> {
    let sentences = opened.relies_on();
    let sentences = sentences.map_err(|fault| Diagnostic::error("plugin", fault))?;
    let rows: String = sentences.iter().map(|sentence| format!("  {sentence}\n")).collect();
    Ok(if rows.is_empty() { rows } else { format!("\nIts programs rely on:\n{rows}") })
}

/// The words in the order of what they mean.
fn vocabulary(opened: &mut OpenedDialect) -> Result<String, Failure> {
    let words = opened.vocabulary();
    let words = words.map_err(|fault| Diagnostic::error("plugin", fault))?;
    if words.is_empty() {
        return Ok("\nIt tells no vocabulary: its programs cannot be read back.\n".to_owned());
    }
    let mut text = "\nVocabulary:\n".to_owned();
    let meanings = CODES.iter().filter(|codes| codes.name == "MEANING");
    for (meaning, _) in meanings.flat_map(|codes| codes.codes) {
        let of_it = words.iter().filter(|word| word.meaning.name() == *meaning);
        let of_it: Vec<&str> = of_it.map(|word| &*word.word).collect();
        if !of_it.is_empty() {
            text.push_str(&format!("  {meaning:<26} {}\n", of_it.join(", ")));
        }
    }
    Ok(text)
}

fn numbers(format: &Format) -> String {
    let decimals: Vec<String> = format.words.iter().map(u8::to_string).collect();
    let inverse_time = match format.inverse_time {
        Some(decimals) => format!("inverse time with {decimals}"),
        None => "no inverse time".to_owned(),
    };
    format!(
        "{} decimals of X, Y, Z, A, C in mm and degrees; feeds with {}, {inverse_time}; files end with .{}",
        decimals.join(", "),
        format.feed,
        format.extension
    )
}

/// A machine that every dialect knows.
fn five_axes() -> ProgramSetup {
    let word = |name: &str| ProgramWord {
        name: name.to_owned(),
        rotary: matches!(name, "A" | "C"),
        depth: name == "Z",
        carries_part: matches!(name, "A" | "C"),
        ..ProgramWord::default()
    };
    ProgramSetup {
        program: "show".to_owned(),
        machine: "five axes".to_owned(),
        words: ["X", "Y", "Z", "A", "C"].map(word).to_vec(),
        ..ProgramSetup::default()
    }
}
