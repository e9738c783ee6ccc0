//! Puts the scripts of the page together: those of `page/order.txt`, one after the other, squeezed like the styles.

mod squeeze;

use std::path::Path;
use std::{env, fs};

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").expect("cargo names the folder of the crate");
    let page = Path::new(&root).join("page");
    println!("cargo::rerun-if-changed=page");
    println!("cargo::rerun-if-changed=src/squeeze.rs");
    let read = |name: &str| {
        let text = fs::read_to_string(page.join(name));
        text.unwrap_or_else(|fault| panic!("page/{name} is asked for: {fault}"))
    };
    let mut scripts = String::new();
    let order = read("order.txt");
    for name in order.lines().map(str::trim).filter(|name| !name.is_empty()) {
        scripts.push_str(&squeeze::script(&read(name)));
        scripts.push('\n');
    }
    let out = env::var("OUT_DIR").expect("cargo names the folder of what is built");
    let write = |name: &str, text: &str| {
        fs::write(Path::new(&out).join(name), text).expect("what is built can be written");
    };
    write("page.js", &scripts);
    write("page.css", &squeeze::style(&read("page.css")));
}
