//! Pictures of the report, as its readers see it: `docs/pictures` takes them anew.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use crate::browser::Browser;
use crate::common::{post, root};
use crate::guides::page::sources;

/// A picture may have so many bytes.
const LARGEST: u64 = 150_000;

/// A report, and what is pressed in it before the picture is taken.
struct Picture {
    name: &'static str,
    /// Samples are named from the checkout, real files by their name alone.
    file: &'static str,
    arguments: &'static str,
    keys: &'static [&'static str],
    dark: bool,
}

const fn picture(
    name: &'static str,
    file: &'static str,
    arguments: &'static str,
    keys: &'static [&'static str],
    dark: bool,
) -> Picture {
    Picture { name, file, arguments, keys, dark }
}

const BLADE: &str = "tests/samples/blade.cls";
const ON_BLADE: &str = "-m ac-trunnion --tool-length 120";
const S_PIECE: &str = "tests/samples/s-piece.cls";
const ON_S: &str = "-m ac-trunnion --tcp control --tool-length 100 --predict";
const FINISH: &str = "creo5x_4r19415_finition.ncl";
const ON_FINISH: &str = "-m ac-trunnion --tcp control --units mm --tool-length 80";
const LEANING: &str = "nx_HumMan_ust_a2.cls";
const ON_LEANING: &str = "-m head-head --tcp post --msys apply --tool-length 150 --spindle 3000";
const NURBS: &str = "nx_HumMan_nurbs.clsf";
const ON_NURBS: &str = "-m head-head --tool 1 --tool-length 150 --spindle 3000";
const INDEXED: &str = "swcam_aamorim_Interface-glue.clt";
const ON_INDEXED: &str = "-m ac-trunnion --tool-from-cutter --tool-length 150 --spindle 3000";
const HEADS: &str = "swcam_aamorim_Teste-Metrologia.apt";
const ON_HEADS: &str = "-m ac-trunnion --tool-length 80";
const ROUGH: &str = "creo3x_MichaHofft_schruppen_1.ncl";
const ON_ROUGH: &str = "-m vmc --tool-length 80";

const PICTURES: &[Picture] = &[
    picture("report-light", BLADE, ON_BLADE, &["x", "m", "-", "-"], false),
    picture("report-dark", BLADE, ON_BLADE, &["x", "m", "-", "-"], true),
    picture("report-path", BLADE, ON_BLADE, &["x", "2", "2"], false),
    picture("report-charts", S_PIECE, ON_S, &["x", "5", "5"], false),
    picture("job-finish-light", FINISH, ON_FINISH, &["x", "m", "-", "-"], false),
    picture("job-finish-dark", FINISH, ON_FINISH, &["x"], true),
    picture("job-leaning-light", LEANING, ON_LEANING, &["x"], false),
    picture("job-leaning-dark", LEANING, ON_LEANING, &["x", "m", "-", "-"], true),
    picture("job-nurbs-light", NURBS, ON_NURBS, &["x"], false),
    picture("job-nurbs-dark", NURBS, ON_NURBS, &["x", "m", "-", "-"], true),
    picture("job-indexed-light", INDEXED, ON_INDEXED, &["x", "m", "-", "-"], false),
    picture("job-indexed-dark", INDEXED, ON_INDEXED, &["x"], true),
    picture("job-probe-light", HEADS, ON_HEADS, &["x"], false),
    picture("job-probe-dark", HEADS, ON_HEADS, &["x", "m", "-", "-"], true),
    picture("job-rough-light", ROUGH, ON_ROUGH, &["x", "m", "-", "-"], false),
    picture("job-rough-dark", ROUGH, ON_ROUGH, &["x"], true),
];

fn folder() -> PathBuf {
    sources().join("nc-programmer/pictures")
}

/// The bytes of a text in base64.
fn bytes_of(base64: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let (mut bits, mut count) = (0_u32, 0);
    for letter in base64.bytes() {
        let value = match letter {
            b'A'..=b'Z' => letter - b'A',
            b'a'..=b'z' => letter - b'a' + 26,
            b'0'..=b'9' => letter - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            _ => break,
        };
        bits = bits << 6 | u32::from(value);
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count & 0xFF) as u8);
        }
    }
    bytes
}

/// The page as it looks, WebP of at most [`LARGEST`] bytes.
fn taken(browser: &mut Browser) -> Vec<u8> {
    for quality in [86, 78, 70, 60, 50] {
        let picture =
            browser.send("Page.captureScreenshot", &json!({"format": "webp", "quality": quality}));
        let bytes = bytes_of(picture["data"].as_str().unwrap());
        if bytes.len() as u64 <= LARGEST {
            return bytes;
        }
    }
    panic!("the picture is too large");
}

#[test]
#[ignore = "writes the pictures of the book: docs/pictures"]
fn pictures_are_taken() {
    let mut browser = Browser::start().expect("chromium-headless-shell");
    let scratch = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder()).unwrap();
    let size = json!({"width": 1280, "height": 800, "deviceScaleFactor": 1, "mobile": false});
    browser.send("Emulation.setDeviceMetricsOverride", &size);
    for picture in PICTURES {
        let file = match Path::new(picture.file).parent() {
            Some(folder) if folder != Path::new("") => root().join(picture.file),
            _ => root().join("../shared/data/cl").join(picture.file),
        };
        // The names of the files stand in the page.
        let [nc, page] = ["part.nc", "part.html"].map(|name| scratch.path().join(name));
        let mut arguments: Vec<&str> = picture.arguments.split(' ').collect();
        arguments.extend(["-q", file.to_str().unwrap(), "-o", nc.to_str().unwrap()]);
        arguments.extend(["--report", page.to_str().unwrap()]);
        let run = post(&arguments);
        assert_eq!(run.code, 0, "{}:\n{}", picture.name, run.err);
        let theme = ["light", "dark"][usize::from(picture.dark)];
        let media = json!({"features": [{"name": "prefers-color-scheme", "value": theme}]});
        browser.send("Emulation.setEmulatedMedia", &media);
        browser.send("Page.navigate", &json!({"url": "about:blank"}));
        browser.open(&page);
        for key in picture.keys {
            browser.press(key);
            browser.frames();
        }
        // Full detail comes after rest.
        std::thread::sleep(std::time::Duration::from_secs(1));
        browser.frames();
        let bytes = taken(&mut browser);
        fs::write(folder().join(format!("{}.webp", picture.name)), bytes).unwrap();
    }
    browser.assert_quiet();
}

#[test]
fn every_picture_is_there_and_small() {
    for picture in PICTURES {
        let path = folder().join(format!("{}.webp", picture.name));
        let size = fs::metadata(&path).unwrap().len();
        assert!(size <= LARGEST, "{}: {size} bytes", path.display());
    }
    // Others take pictures of the editor.
    let there = fs::read_dir(folder()).unwrap();
    let ours = |path: &Path| path.extension().is_some_and(|end| end == "webp");
    let there = there.filter(|entry| ours(&entry.as_ref().unwrap().path())).count();
    assert_eq!(there, PICTURES.len(), "a picture that nobody takes");
}
