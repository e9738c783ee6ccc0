//! `post schema`, judged by a validator of others: every machine file is in order, and slips are found.

use crate::common;

use std::fs;

use common::{post, root};
use jsonschema::Validator;
use serde_json::{Value, json};

fn schema() -> Value {
    let run = post(&["schema"]);
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    serde_json::from_str(&run.out).unwrap()
}

fn validator() -> Validator {
    jsonschema::validator_for(&schema()).unwrap()
}

/// What the validator has against a machine file.
fn faults(validator: &Validator, text: &str) -> Vec<String> {
    let table: toml::Table = text.parse().unwrap();
    let value = serde_json::to_value(table).unwrap();
    let faults = validator.iter_errors(&value);
    faults
        .map(|fault| format!("{}: {fault}", fault.instance_path()))
        .collect()
}

#[test]
fn it_is_a_schema() {
    jsonschema::meta::validate(&schema()).unwrap();
}

#[test]
fn every_machine_file_is_in_order() {
    let validator = validator();
    for entry in fs::read_dir(root().join("machines")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|ending| ending == "toml") {
            let found = faults(&validator, &fs::read_to_string(&path).unwrap());
            assert!(found.is_empty(), "{}: {}", path.display(), found.join("\n"));
        }
    }
}

/// Every table is closed, so that a misspelt key is found, and every key is explained.
#[test]
fn every_table_is_closed_and_every_key_explained() {
    let schema = schema();
    let tables = schema["definitions"].as_object().unwrap().iter();
    let tables = tables.filter(|(_, table)| table["type"] == "object");
    for (name, table) in tables.chain([(&"the file".to_owned(), &schema)]) {
        let rest = &table["additionalProperties"];
        // Sub-tables hold the options of plugins.
        assert!(*rest == false || rest["type"] == "object", "{name}");
        for (key, property) in table["properties"].as_object().unwrap() {
            assert!(property["description"].is_string(), "{name}.{key}");
        }
    }
}

/// A line of the AC trunnion's file, what stands there instead, and where the fault is found.
const SLIPS: &[(&str, &str, &str)] = &[
    ("name  = \"AC trunnion\"", "nane = \"AC trunnion\"", ""),
    ("name  = \"AC trunnion\"", "", ""),
    ("chain = \"[w C' A' b Y X Z (S) t]\"", "chain = 5", "/chain"),
    ("gauge = [0, 0, 400]", "gauge = [0, 400]", "/tool/gauge"),
    ("gauge = [0, 0, 400]", "", "/tool"),
    (
        "gauge = [0, 0, 400]",
        "gauge = [0, 0, true]",
        "/tool/gauge/2",
    ),
    ("travel    = [-120, 30]", "travle = [-120, 30]", "/axis/A"),
    ("travel    = [-120, 30]", "travel = 30", "/axis/A/travel"),
    ("rotary    = [1, 0, 0]", "", "/axis/A"),
    (
        "rotary    = [1, 0, 0]",
        "rotary = [1, 0, 0]\nlinear = [1, 0, 0]",
        "/axis/A",
    ),
    ("cyclic    = true", "cyclic = \"yes\"", "/axis/C/cyclic"),
    ("max_feed  = 5400", "max_feed = -5400", "/axis/A/max_feed"),
    ("tcp     = \"post\"", "tcp = \"both\"", "/control/tcp"),
    ("tcp     = \"post\"", "tpc = \"post\"", "/control/tpc"),
    ("dialect = \"fanuc\"", "", "/control"),
    (
        "tolerance       = 0.005",
        "tolerance = [0.005]",
        "/accuracy/tolerance",
    ),
    (
        "[accuracy]",
        "[solution]\nrule = \"fastest\"\n[accuracy]",
        "/solution/rule",
    ),
    (
        "[accuracy]",
        "[solution]\nprefer = { A = \"down\" }\n[accuracy]",
        "/solution/prefer/A",
    ),
    ("[accuracy]", "[rewind]\nlength = 50\n[accuracy]", "/rewind"),
    (
        "[accuracy]",
        "[head.2]\nwrod = \"M62\"\n[accuracy]",
        "/head/2",
    ),
    (
        "[accuracy]",
        "[control.fanuc]\ndecimals = [3]\n[accuracy]",
        "/control/fanuc/decimals",
    ),
];

#[test]
fn slips_are_found() {
    let validator = validator();
    let text = fs::read_to_string(root().join("machines/ac-trunnion.toml")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("slip.toml");
    let part = root().join("tests/samples/plate.ncl");
    for (line, slip, place) in SLIPS {
        assert!(text.contains(line), "{line}");
        let text = text.replacen(line, slip, 1);
        let found = faults(&validator, &text);
        assert!(
            found
                .iter()
                .any(|fault| fault.starts_with(&format!("{place}:"))),
            "{line} -> {slip}: {found:?}"
        );
        // The command finds them too.
        fs::write(&path, text).unwrap();
        let run = post(&[
            "-m",
            path.to_str().unwrap(),
            part.to_str().unwrap(),
            "-o",
            "-",
        ]);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{line} -> {slip}");
    }
}

/// What is right though it is rare.
#[test]
fn what_is_right_passes() {
    let validator = validator();
    for text in [
        "extends = \"vmc\"",
        "extends = \"vmc\"\n[axis.X]\ntravel = [-100, \"2 * reach\"]\n[parameters]\nreach = 80",
        "extends = \"vmc\"\n[control]\nunits = \"inch\"\n[control.fanuc]\ndecimals = 4\ntrailing_zeros = true",
        "extends = \"vmc\"\n[accuracy]\nmodel = \"sampled\"\n[accuracy.sampled]\nsamples = 5",
        "extends = \"vmc\"\n[head.2]\nword = \"M62\"\n[head.2.tool]\ngauge = [0, 0, 1]\n[head.2.axis.C]\nindexed = 0",
        "extends = \"vmc\"\n[tools]\n1 = 120.5\n[solution]\nstart = { C = 90 }\nexclusive = [[\"A\", \"C\"]]",
    ] {
        let found = faults(&validator, text);
        assert!(found.is_empty(), "{text}: {found:?}");
    }
    assert!(!validator.is_valid(&json!({ "extends": "vmc", "chains": "" })));
}

/// The options of a dialect that is built in are known to an editor, with what they take.
#[test]
fn options_of_dialects_are_in_it() {
    let validator = validator();
    let file = |options: &str| format!("extends = \"vmc\"\n[control.fanuc]\n{options}\n");
    let good =
        "block_numbers = \"tools\"\nprogram_number = 12\nretract = [\"G91 G28 Z0.\", \"G90\"]";
    assert_eq!(faults(&validator, &file(good)), [] as [&str; 0]);
    for bad in [
        "program_numbr = 12",
        "program_number = 12345678",
        "block_numbers = true",
        "retract = 3",
    ] {
        assert_eq!(faults(&validator, &file(bad)).len(), 1, "{bad}");
    }
}
