//! What comes from outside: each crate of the lock file may be had under a licence that `deny.toml` allows and comes from
//! crates.io, and the page on security has a row for each that a manifest of ours names, with the version that is built.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::process::Command;

use serde_json::Value;

use crate::common::root;

/// The page that tells of each direct dependency.
const PAGE: &str = "docs/src/reference/security.md";

/// What cargo knows of the workspace and of every crate in its lock file, those for other systems left out.
fn metadata() -> Value {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["metadata", "--format-version", "1", "--locked", "--offline"]);
    command.args(["--filter-platform", "x86_64-unknown-linux-gnu"]);
    let output = command.current_dir(root()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

fn packages(metadata: &Value) -> impl Iterator<Item = &Value> {
    metadata["packages"].as_array().unwrap().iter()
}

fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key].as_str().unwrap_or_default()
}

fn from_outside(package: &&Value) -> bool {
    !package["source"].is_null()
}

/// The licences that `deny.toml` allows.
fn allowed() -> BTreeSet<String> {
    let rules: toml::Table = fs::read_to_string(root().join("deny.toml")).unwrap().parse().unwrap();
    let list = rules["licenses"]["allow"].as_array().unwrap();
    list.iter().map(|licence| licence.as_str().unwrap().to_owned()).collect()
}

/// Whether one may choose allowed licences from an expression of SPDX without brackets in one another.
fn may_be_had(expression: &str, allowed: &BTreeSet<String>) -> bool {
    let whole = expression.replace('/', " OR ").replace(['(', ')'], "");
    // AND binds tighter than OR; where brackets say otherwise, each part of AND must be allowed for itself.
    let every = |parts: &str| parts.split(" AND ").all(|part| allowed.contains(part.trim()));
    let bracketed = expression.contains('(');
    if bracketed {
        let parts = expression.split(" AND ");
        return parts
            .map(|part| part.replace(['(', ')'], ""))
            .all(|part| part.split(" OR ").any(every));
    }
    whole.split(" OR ").any(every)
}

#[test]
fn licences_are_chosen_as_spdx_reads_them() {
    let allowed: BTreeSet<String> = ["MIT", "Unicode-3.0"].map(str::to_owned).into();
    for (expression, may) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("MIT/Apache-2.0", true),
        ("GPL-3.0 OR MIT", true),
        ("GPL-3.0 AND MIT", false),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("(MIT OR Apache-2.0) AND NCSA", false),
    ] {
        assert_eq!(may_be_had(expression, &allowed), may, "{expression}");
    }
}

#[test]
fn what_comes_from_outside_may_be_had_under_allowed_licences_and_comes_from_crates_io() {
    let (metadata, allowed) = (metadata(), allowed());
    let mut seen = 0;
    for package in packages(&metadata).filter(from_outside) {
        let name = text(package, "name");
        let licence = text(package, "license");
        assert!(may_be_had(licence, &allowed), "{name} is licensed under {licence}");
        let source = text(package, "source");
        assert!(
            source.starts_with("registry+") && source.contains("crates.io-index"),
            "{name} comes from {source}"
        );
        seen += 1;
    }
    assert!(seen > 100, "{seen}");
}

#[test]
fn the_page_on_security_has_a_row_for_each_direct_dependency() {
    let metadata = metadata();
    let ours: Vec<&Value> = packages(&metadata).filter(|package| !from_outside(package)).collect();
    let names: BTreeSet<&str> = ours
        .iter()
        .flat_map(|package| package["dependencies"].as_array().unwrap())
        .filter(|dependency| dependency["path"].is_null())
        .map(|dependency| text(dependency, "name"))
        .collect();
    let of_lock = |name: &str| {
        let found = packages(&metadata)
            .filter(|package| from_outside(package) && text(package, "name") == name);
        found.map(|package| text(package, "version").split('+').next().unwrap()).max().unwrap()
    };
    let wanted: BTreeMap<String, String> =
        names.iter().map(|name| ((*name).to_owned(), of_lock(name).to_owned())).collect();

    let page = fs::read_to_string(root().join(PAGE)).unwrap();
    let table = page.split_once("| crate | what for |").unwrap().1;
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let told: BTreeMap<String, String> = rows
        .map(|line| {
            let cell = line.split('|').nth(1).unwrap().trim();
            let (name, version) = cell.trim_start_matches('`').split_once("` ").unwrap();
            (name.to_owned(), version.to_owned())
        })
        .collect();
    assert_eq!(told, wanted, "the table of {PAGE}");

    let count = packages(&metadata).count() - ours.len();
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap();
    let locked = lock.matches("source = \"registry+").count();
    assert!(count <= locked);
    assert!(
        page.contains(&format!("{locked} crates in the lock file")),
        "{locked} crates are in the lock file"
    );
}

/// Crates are packed one after the other, each behind those that it stands on and that its tests name by version.
#[test]
fn the_crates_can_be_published_in_some_order() {
    let metadata = metadata();
    let published = packages(&metadata)
        .filter(|package| !from_outside(package) && package["publish"].is_null());
    let published: BTreeMap<&str, &Value> =
        published.map(|package| (text(package, "name"), package)).collect();
    assert!(published.len() > 30, "{:?}", published.keys());
    let mut waiting: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (name, package) in &published {
        let mut stands_on = BTreeSet::new();
        for dependency in package["dependencies"].as_array().unwrap() {
            let ours = dependency["source"].is_null();
            let by_path_alone = text(dependency, "req") == "*";
            let of_tests = text(dependency, "kind") == "dev";
            let on = text(dependency, "name");
            assert!(
                !ours || of_tests || !by_path_alone && published.contains_key(on),
                "{name} stands on {on}, which is not published"
            );
            if ours && !by_path_alone {
                stands_on.insert(on);
            }
        }
        waiting.insert(name, stands_on);
    }
    while !waiting.is_empty() {
        let ready: Vec<&str> = waiting
            .iter()
            .filter(|(_, on)| on.iter().all(|on| !waiting.contains_key(on)))
            .map(|(name, _)| *name)
            .collect();
        assert!(!ready.is_empty(), "each of these waits for another: {waiting:?}");
        waiting.retain(|name, _| !ready.contains(name));
    }
}
