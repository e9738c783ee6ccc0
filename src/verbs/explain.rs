//! `post explain`: what the code of a message means.

use clap::Args;
use clap::error::ErrorKind;
use post_machine::diagnostic::nearest;

use crate::codes::{Code, CodeGroup, codes};
use post_cli::failure::CommandFault;
use post_cli::terminal::print;
use post_job::session::Session;

/// Explains the codes of messages: what is found, and what helps; without a code all of them
#[derive(Debug, Args)]
pub struct ExplainArguments {
    /// The code as it stands in brackets: over-travel for error[over-travel].
    code: Option<String>,
}

/// Prints what is known of a code.
pub fn run(session: &Session, arguments: &ExplainArguments) -> Result<(), CommandFault> {
    let wanted = arguments.code.as_deref().map(bare);
    let is_wanted = |code: &&Code| wanted.is_none_or(|wanted| wanted == code.name);
    let mut text = String::new();
    for group in codes() {
        let codes: Vec<&Code> = group.codes.iter().filter(is_wanted).collect();
        if !codes.is_empty() {
            tell(&group, &codes, &mut text);
        }
    }
    match (wanted, text.is_empty()) {
        (Some(wanted), true) => Err(unknown(wanted)),
        _ => {
            print(session, &text);
            Ok(())
        }
    }
}

/// `error[over-travel]:` is `over-travel`.
fn bare(code: &str) -> &str {
    let code = code.trim().trim_end_matches(':');
    let code = code.split_once('[').map_or(code, |(_, behind)| behind);
    code.trim_end_matches(']')
}

fn tell(group: &CodeGroup, codes: &[&Code], text: &mut String) {
    if !text.is_empty() {
        text.push('\n');
    }
    text.push_str(&format!("{} ({})\n", group.title, group.verbs));
    for code in codes {
        let Code { name, meaning, remedy } = code;
        text.push_str(&format!("\n{name}\n    {meaning}\n    What helps: {remedy}\n"));
    }
}

fn unknown(code: &str) -> CommandFault {
    let names = codes().into_iter().flat_map(|group| group.codes);
    let near = nearest(code, names.map(|code| code.name));
    let help = near.map_or_else(
        || "  tip: `post explain` lists all codes".to_owned(),
        |near| format!("  tip: a similar code exists: '{near}'"),
    );
    let message = format!("no message has the code '{code}'\n\n{help}\n");
    CommandFault::Usage(clap::Error::raw(ErrorKind::InvalidValue, message))
}
