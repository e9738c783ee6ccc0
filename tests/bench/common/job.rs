//! One whole job, its text thrown away.

use std::error::Error;
use std::fs::{self, File};
use std::path::Path;

use post_grammar::ClReader;
use post_host::{Plugin, ProgramSetup, ProgramWord};
use post_machine::axis_words;
use post_machine::description::{self, Machine, Setting, Source};
use post_plugin::Units;
use post_posting::report::PostingReport;
use post_posting::{Observer, Post, PostingRequest, TextSink};

/// A machine of the library.
pub fn machine(name: &str, settings: &[String]) -> Result<Machine, Box<dyn Error>> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("machines");
    let mut find = |name: &str| {
        let text = fs::read_to_string(root.join(format!("{name}.toml")));
        text.map(|text| Source { name: name.to_owned(), text }).map_err(|error| error.to_string())
    };
    let source = find(name)?;
    let settings: Vec<Setting> = settings.iter().cloned().map(Setting::Written).collect();
    description::load(source, &settings, &mut find).map_err(|faults| format!("{faults:?}").into())
}

/// Posts a CL file through the plugin boundary.
pub fn run(
    path: &Path,
    name: &str,
    settings: &[String],
    job: PostingRequest,
) -> Result<PostingReport, Box<dyn Error>> {
    watched(path, name, settings, job, None)
}

/// [`run`] with someone who looks at every cut.
pub fn watched(
    path: &Path,
    name: &str,
    settings: &[String],
    job: PostingRequest,
    watch: Option<&mut dyn Observer>,
) -> Result<PostingReport, Box<dyn Error>> {
    let machine = machine(name, settings)?;
    let depth = axis_words::depth(&machine);
    let setup = ProgramSetup {
        program: "BENCH".to_owned(),
        machine: machine.name.clone(),
        units: Units::Millimetre,
        tcp: machine.control.tcp == description::Tcp::Control,
        words: axis_words::order(&machine)
            .into_iter()
            .map(|place| ProgramWord {
                name: machine.axes[place].name.clone(),
                rotary: machine.axes[place].joint.rotary,
                depth: Some(place) == depth,
                ..ProgramWord::default()
            })
            .collect(),
        ..ProgramSetup::default()
    };
    let stock = |name: &str| post_stock::plugin(name).ok_or("no such plugin");
    let dialect = stock(&machine.control.dialect)?;
    let mut dialect = Plugin::linked(dialect)?.dialect(&setup)?;
    let mut model = Plugin::linked(stock("sampled")?)?.error_model(&[])?;
    let mut nowhere = Nowhere;
    let mut post = Post::new(&machine, job, &mut dialect, &mut model, &mut nowhere)
        .map_err(|finding| finding.message)?;
    if let Some(watch) = watch {
        post.watch(watch);
    }
    let mut reader = ClReader::new(File::open(path)?);
    while let Some(record) = reader.next_record()? {
        post.record(&record);
    }
    let (report, findings) = post.finish();
    report.ok_or_else(|| format!("{findings:?}").into())
}

struct Nowhere;

impl TextSink for Nowhere {
    fn write(&mut self, _: &[u8]) -> Result<(), String> {
        Ok(())
    }
}
