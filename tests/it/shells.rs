//! `post completions` and `post man`.

use std::fs;
use std::process::Command;

use crate::common::{assert_contains, names, post, run};

#[test]
fn every_shell_has_its_completions() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let printed = post(&["completions", shell]);
        assert_eq!((printed.code, printed.err.as_str()), (0, ""), "{shell}");
        assert_contains(&printed.out, &["verify", "tool-length", "completions"]);
    }
    assert_eq!(post(&["completions", "cmd"]).code, 2);
    // What bash makes of it: a verb by its beginning.
    let script = post(&["completions", "bash"]).out;
    let asked = format!(
        "{script}\nCOMP_WORDS=(post ver)\nCOMP_CWORD=1\n_post post ver post\necho \"${{COMPREPLY[@]}}\"\n"
    );
    let answer = run(&mut Command::new("bash"), asked.as_bytes());
    assert_eq!((answer.code, answer.out.as_str()), (0, "verify\n"), "{}", answer.err);
}

/// Names of machines that begin so, and machine files, for every verb that takes one.
#[test]
fn machines_are_completed_by_name_and_by_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("ac-mine.toml"), "").unwrap();
    let script = post(&["completions", "bash"]).out;
    for words in [
        &["post", "-m", "ac-"][..],
        &["post", "lint", "--machine", "ac-"],
        &["post", "batch", "-m", "ac-"],
    ] {
        let last = words.len() - 1;
        let asked = format!(
            "{script}\nCOMP_WORDS=({})\nCOMP_CWORD={last}\n_post post ac- {}\nprintf '%s\\n' \"${{COMPREPLY[@]}}\"\n",
            words.join(" "),
            words[last - 1],
        );
        let answer = run(Command::new("bash").current_dir(folder.path()), asked.as_bytes());
        let mut found: Vec<&str> = answer.out.lines().collect();
        found.sort_unstable();
        assert!(
            found.contains(&"ac-mine.toml") && found.contains(&"ac-trunnion"),
            "{words:?}: {answer:?}"
        );
        assert!(found.iter().all(|name| name.starts_with("ac-")), "{found:?}");
    }
    let zsh = post(&["completions", "zsh"]).out;
    assert_contains(&zsh, &["_post_machines() {", "ac-trunnion", ":MACHINE:_post_machines'"]);
    assert!(!zsh.contains(":MACHINE:(") && !zsh.contains(":MACHINE:_default"));
    let fish = post(&["completions", "fish"]).out;
    let machines = fish.lines().filter(|line| line.contains(" -l machine "));
    let machines: Vec<&str> = machines.filter(|line| line.starts_with("complete ")).collect();
    assert!(machines.len() > 5 && fish.contains("\nac-trunnion\\t''"), "{fish}");
    for line in machines {
        assert!(line.contains(" -r -F -a "), "{line}");
    }
}

#[test]
fn every_verb_has_a_page_and_the_same_one_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let folders = ["one", "two"].map(|name| folder.path().join(name));
    for folder in &folders {
        let wrote = post(&["man", folder.to_str().unwrap()]);
        assert_eq!((wrote.code, wrote.err.as_str()), (0, ""));
    }
    let pages = names(&folders[0]);
    let help = post(&["--help"]).out;
    let verbs = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let verbs = verbs.take_while(|line| !line.is_empty());
    let verbs: Vec<&str> = verbs
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|verb| *verb != "help")
        .collect();
    assert!(verbs.len() > 10, "{help}");
    for verb in verbs {
        let page = format!("post-{verb}.1");
        assert!(pages.contains(&page), "{page} is not in {pages:?}");
        let text = fs::read_to_string(folders[0].join(&page)).unwrap();
        assert_contains(&text, &[".TH", ".SH SYNOPSIS", verb]);
    }
    assert_eq!(pages, names(&folders[1]));
    for page in pages {
        let [one, two] = folders.each_ref().map(|folder| fs::read(folder.join(&page)).unwrap());
        assert!(one == two, "{page}");
    }
}
