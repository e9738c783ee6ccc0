//! The examples of the book, run as their reader would.

use std::env;
use std::fs;
use std::path::Path;
use std::process::Command;

use tempfile::TempDir;

use super::page::{Part, language, pages, parts, sources, told, update, updating, write};
use crate::common::{BINARY, PACKAGE, command_as, root};

/// What the folder of a page has.
const COPIED: [&str; 5] =
    ["machines", "tests/samples", "tests/jobs", "tests/measured", "papers/samples"];

/// A folder like the checkout's, of which a reader may write in any part.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in COPIED {
        let copy = folder.path().join(name);
        fs::create_dir_all(&copy).unwrap();
        for entry in fs::read_dir(root().join(name)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                fs::copy(&path, copy.join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    folder
}

/// What a command prints, standard error with standard output, and how it ends.
fn run(folder: &Path, line: &str) -> (String, i32) {
    let built = Path::new(BINARY).parent().unwrap();
    let others = env::var_os("PATH").unwrap_or_default();
    let path = env::join_paths([built.to_owned()].into_iter().chain(env::split_paths(&others)));
    let mut shell: Command = command_as("sh");
    let output = shell
        .current_dir(folder)
        .env("PATH", path.unwrap())
        .env_remove("COLUMNS")
        .args(["-c", &format!("exec 2>&1\n{line}")])
        .stdin(std::process::Stdio::null())
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    (text, output.status.code().unwrap())
}

/// `text` is `pattern`, in which `[..]` is anything.
fn line_is(pattern: &str, text: &str) -> bool {
    let mut parts = pattern.split("[..]");
    let Some(mut rest) = text.strip_prefix(parts.next().unwrap()) else {
        return false;
    };
    let mut parts: Vec<&str> = parts.collect();
    let Some(last) = parts.pop() else {
        return rest.is_empty();
    };
    for part in parts {
        let Some((_, behind)) = rest.split_once(part) else {
            return false;
        };
        rest = behind;
    }
    rest.ends_with(last)
}

/// `lines` are `pattern`, in which `...` is any lines.
fn lines_are(pattern: &[&str], lines: &[&str]) -> bool {
    match pattern.split_first() {
        None => lines.is_empty(),
        Some((&"...", behind)) => (0..=lines.len()).any(|skip| lines_are(behind, &lines[skip..])),
        Some((first, behind)) => lines
            .split_first()
            .is_some_and(|(line, others)| line_is(first, line) && lines_are(behind, others)),
    }
}

/// A block's commands, each with what it must print.
fn commands<'a>(lines: &[&'a str]) -> Vec<(String, Vec<&'a str>)> {
    let mut commands: Vec<(String, Vec<&str>)> = Vec::new();
    for line in lines {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.to_owned(), Vec::new())),
            (None, Some((command, shown))) if shown.is_empty() && command.ends_with('\\') => {
                command.push('\n');
                command.push_str(line);
            }
            (None, Some((_, shown))) => shown.push(line),
            (None, None) => panic!("a block `console` begins with `$ `, not with {line}"),
        }
    }
    commands
}

/// Whether the tests of this package run them: those of `post-papers` run blocks with its command.
fn are_ours(commands: &[(String, Vec<&str>)]) -> bool {
    let of_papers = commands.iter().any(|(command, _)| command.starts_with("papers "));
    of_papers == (PACKAGE == "post-papers")
}

/// Runs a page. What it would be with what its commands print, how many there are, and what is wrong.
fn run_page(name: &Path) -> (String, usize, Vec<String>) {
    let text = fs::read_to_string(sources().join(name)).unwrap();
    let (mut page, mut ran, mut faults) = (Vec::<String>::new(), 0, Vec::new());
    let folder = folder();
    for part in parts(&text) {
        let (info, at, lines) = match part {
            Part::Text(lines) => {
                page.extend(lines.into_iter().map(str::to_owned));
                continue;
            }
            Part::Block { info, line, lines } => (info, line, lines),
        };
        if let Some(file) = told(info, "file") {
            write(&folder.path().join(file), &(lines.join("\n") + "\n"));
        }
        let commands = match language(info) {
            "console" => commands(&lines),
            _ => Vec::new(),
        };
        if commands.is_empty() || !are_ours(&commands) {
            page.extend(lines.into_iter().map(str::to_owned));
            continue;
        }
        let last = commands.len() - 1;
        for (index, (command, shown)) in commands.into_iter().enumerate() {
            let (printed, code) = run(folder.path(), &command);
            ran += 1;
            let printed: Vec<&str> = printed.lines().map(str::trim_end).collect();
            let wanted = match told(info, "exit") {
                Some(code) if index == last => code.parse().unwrap(),
                _ => 0,
            };
            let place = format!("docs/src/{}:{at}: {command}", name.display());
            if code != wanted {
                let all = printed.join("\n");
                faults.push(format!("{place}\nends with {code}, not {wanted}:\n{all}"));
            }
            page.extend(format!("$ {command}").lines().map(str::to_owned));
            if lines_are(&shown, &printed) {
                page.extend(shown.into_iter().map(str::to_owned));
            } else {
                if !updating() {
                    let all = printed.join("\n");
                    faults.push(format!("{place}\nprints something else:\n{all}"));
                }
                page.extend(printed.into_iter().map(str::to_owned));
            }
        }
    }
    (page.join("\n") + "\n", ran, faults)
}

#[test]
fn every_example_of_the_book_runs() {
    let wanted = env::var("GUIDE_PAGE").unwrap_or_default();
    let mut names = pages();
    names.retain(|name| name.to_str().unwrap().contains(&wanted));
    // The long ones do not wait for each other.
    let rooms = std::thread::available_parallelism().map_or(1, usize::from);
    let next = std::sync::atomic::AtomicUsize::new(0);
    let done: Vec<_> = std::thread::scope(|scope| {
        let work = || {
            let take = || next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            std::iter::from_fn(|| names.get(take()))
                .map(|name| (name.clone(), run_page(name)))
                .collect::<Vec<_>>()
        };
        let workers: Vec<_> = (0..rooms).map(|_| scope.spawn(work)).collect();
        let all = workers.into_iter().map(|worker| worker.join().unwrap());
        all.flatten().collect()
    });
    let ran: usize = done.iter().map(|(_, (_, ran, _))| ran).sum();
    assert!(ran > 0, "no page has an example");
    let mut faults = Vec::new();
    for (name, (text, _, wrong)) in done {
        if updating() {
            write(&sources().join(name), &text);
        }
        faults.extend(wrong);
    }
    faults.sort();
    assert!(faults.is_empty(), "{}\n\n{} writes what is printed", faults.join("\n\n"), update());
}

#[test]
fn patterns_stand_for_what_they_say() {
    for (pattern, text, is) in [
        ("a[..]c", "abc", true),
        ("a[..]c", "ac", true),
        ("a[..]", "a", true),
        ("[..]c", "abc", true),
        ("a[..]b[..]c", "a-b-b-c", true),
        ("a[..]c", "abd", false),
        ("abc", "abcd", false),
        ("abc", "ab", false),
    ] {
        assert_eq!(line_is(pattern, text), is, "{pattern} {text}");
    }
    for (pattern, lines, is) in [
        (&["a", "...", "c"][..], &["a", "b", "b", "c"][..], true),
        (&["a", "..."], &["a"], true),
        (&["...", "c"], &["a", "c", "d"], false),
        (&[], &["a"], false),
    ] {
        assert_eq!(lines_are(pattern, lines), is, "{pattern:?} {lines:?}");
    }
}
