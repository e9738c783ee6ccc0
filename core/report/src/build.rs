//! Puts the scripts of the page together: those of `page/order.txt`, one behind the other.

use std::path::Path;
use std::{env, fs};

fn main() {
    let root = env::var("CARGO_MANIFEST_DIR").expect("cargo names the folder of the crate");
    let page = Path::new(&root).join("page");
    println!("cargo::rerun-if-changed=page");
    let order = fs::read_to_string(page.join("order.txt")).expect("page/order.txt is there");
    let mut code = String::from("&[\n");
    for name in order.lines().map(str::trim).filter(|name| !name.is_empty()) {
        let path = page.join(name);
        assert!(
            path.is_file(),
            "page/order.txt names {name}, which is not there"
        );
        code.push_str(&format!("    include_str!({path:?}),\n"));
    }
    code.push_str("]\n");
    let out = env::var("OUT_DIR").expect("cargo names the folder of what is built");
    fs::write(Path::new(&out).join("scripts.rs"), code).expect("the list can be written");
}
