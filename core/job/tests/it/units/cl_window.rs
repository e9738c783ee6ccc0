//! The path of the CL file on a page: one that cannot be read to its end makes none.

use std::io::{self, Read};

use post_job::report::{ClWindow, ExtraColumns, MotionRows, Parts};
use post_job::session::Session;
use post_machine::description::{Machine, Source, load};
use post_readback::course::cl::ClSettings;
use post_report::meta::Meta;

const TEXT: &str = "UNITS/MM\nFEDRAT/MMPM,500\nGOTO/0,0,50\nGOTO/10,0,50\n";

/// A disk that fails.
struct Failing;

impl Read for Failing {
    fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
        Err(io::Error::other("the disk"))
    }
}

fn machine() -> Machine {
    let text = include_str!("../../../../../machines/vmc.toml");
    let source = Source { name: "vmc".to_owned(), text: text.to_owned() };
    load(source, &[], &mut |_| Err(String::new())).unwrap()
}

#[test]
fn a_file_that_cannot_be_read_on_makes_no_page() {
    let machine = machine();
    let whole: Box<dyn Read> = Box::new(TEXT.as_bytes());
    let torn: Box<dyn Read> = Box::new(TEXT.as_bytes().chain(Failing));
    for (input, is_torn) in [(whole, false), (torn, true)] {
        let cl = ClWindow::new(&machine, ClSettings::of(&machine, "part.cls"), input).unwrap();
        let rows = MotionRows::new(&machine, Some(cl), ExtraColumns::default()).unwrap();
        let mut meta = Meta::default();
        let mut parts = Parts::of(&Session::quiet(), &machine, &mut meta).unwrap();
        let told = rows.finish(&mut parts, &mut meta).err().map(|fault| fault.findings());
        let told: Vec<String> = told.iter().flatten().map(|found| found.message.clone()).collect();
        let asked: &[&str] = if is_torn { &["part.cls cannot be read: the disk"] } else { &[] };
        assert_eq!(told, asked);
    }
}
