//! Several CL files, read one behind the other as one text.

use std::io::{self, Cursor, Read};
use std::path::Path;
use std::sync::Arc;

use post_grammar::NEXT_FILE;
use post_grammar::text::as_remark;
use post_machine::diagnostic::{Diagnostic, FurtherFile};

use super::seen_files::SeenFiles;
use super::{ClInput, FileFault, PathArg};
use crate::failure::Failure;
use crate::session::Session;

/// Files that become one program at most: each of them is open while they are read.
const MOST_FILES: usize = 100;

/// CL files in their order, and where in their common text each begins.
pub struct JoinedFiles {
    arguments: Vec<PathArg>,
    further: Arc<[FurtherFile]>,
    /// As they were when they were counted.
    seen: SeenFiles,
}

/// What a file has at its end, and how long it is.
#[derive(Default)]
struct FileEnd {
    lines: u64,
    /// A line end stands after the last line.
    ended: bool,
    /// The last line, or its beginning.
    bytes: Vec<u8>,
}

impl FileEnd {
    /// Reads a file to its end: lines are counted as the reader of CL files counts them.
    fn of(input: &mut dyn Read) -> io::Result<Self> {
        let mut end = Self::default();
        let mut buffer = [0; 1 << 16];
        let mut before = b'\n';
        loop {
            let count = input.read(&mut buffer)?;
            if count == 0 {
                return Ok(end);
            }
            for byte in &buffer[..count] {
                match byte {
                    b'\n' if before == b'\r' => {}
                    b'\n' | b'\r' => end.lines += 1,
                    _ => {
                        if matches!(before, b'\n' | b'\r') {
                            end.bytes.clear();
                        }
                        if end.bytes.len() < 4096 {
                            end.bytes.push(*byte);
                        }
                    }
                }
                before = *byte;
            }
            end.ended = matches!(before, b'\n' | b'\r');
        }
    }

    /// The last line goes on in a line that is missing.
    fn goes_on(&self) -> bool {
        let text = self.bytes.trim_ascii_end();
        text.ends_with(b"$") && !text.windows(2).any(|pair| pair == b"$$")
    }
}

impl JoinedFiles {
    /// Of files, none of which is a stream.
    ///
    /// # Errors
    /// One of them cannot be read, or ends within a record.
    pub fn new(session: &Session, arguments: Vec<PathArg>) -> Result<Self, Failure> {
        let refused = |message: String, help: &str| {
            Failure::from(Diagnostic::error("cl-files", message).help(help))
        };
        if arguments.len() > MOST_FILES {
            let message = format!("more than {MOST_FILES} CL files for one program");
            return Err(refused(message, "post them as several programs"));
        }
        let mut further: Vec<FurtherFile> = Vec::new();
        let mut before = 0;
        let seen = SeenFiles::default();
        for (place, argument) in arguments.iter().enumerate() {
            let mut input = ClInput::open_again(session, argument, &seen)?;
            if input.length.is_none() {
                let message = format!(
                    "{} is no file, and several CL files are read more than once",
                    input.name
                );
                return Err(refused(message, "write it to a file first"));
            }
            let name = input.name;
            let end = FileEnd::of(&mut *input.bytes);
            let end = end.map_err(|error| FileFault::Read { name: name.clone(), error })?;
            let last = place + 1 == arguments.len();
            if end.goes_on() && !last {
                let message =
                    format!("{name} ends in a `$`: what follows in its last record is missing");
                return Err(refused(message, "let the CAM system write the file again"));
            }
            if let Some(file) = further.last_mut().filter(|_| place > 0) {
                file.name = name;
            }
            before += end.lines + u64::from(!end.ended);
            if !last {
                // The remark in front of it.
                before += 1;
                further.push(FurtherFile {
                    name: String::new(),
                    before,
                    behind_line_end: end.ended,
                });
            }
        }
        Ok(Self { arguments, further: further.into(), seen })
    }

    /// The files behind the first, and where they begin.
    pub fn further(&self) -> Arc<[FurtherFile]> {
        Arc::clone(&self.further)
    }

    /// None of them was written to since.
    ///
    /// # Errors
    /// One was.
    pub fn refuse_written(&self) -> Result<(), FileFault> {
        self.seen.refuse_written()
    }

    /// From the start of the first.
    ///
    /// # Errors
    /// One of them cannot be opened, or is not what it was.
    pub fn open(&self, session: &Session) -> Result<ClInput, FileFault> {
        let mut all: Option<ClInput> = None;
        let mut further = self.further.iter();
        for argument in &self.arguments {
            let next = ClInput::open_again(session, argument, &self.seen)?;
            let Some(before) = all.take() else {
                all = Some(next);
                continue;
            };
            let remark = further.next().map_or_else(String::new, remark);
            let length = before.length.zip(next.length);
            all = Some(ClInput {
                length: length.map(|(before, next)| before + remark.len() as u64 + next),
                bytes: Box::new(before.bytes.chain(Cursor::new(remark)).chain(next.bytes)),
                ..before
            });
        }
        let mut all = all.map_or_else(|| ClInput::open(session, &PathArg::Standard), Ok)?;
        all.further = Arc::clone(&self.further);
        Ok(all)
    }
}

/// The line before the first of a file.
fn remark(file: &FurtherFile) -> String {
    let name = Path::new(&file.name).file_name().unwrap_or_default();
    let name = as_remark(name.to_string_lossy().into_owned());
    let mark = char::from(NEXT_FILE);
    match file.behind_line_end {
        true => format!("$$ {name}{mark}\n"),
        // Twice, as the file before may have been cut off within its last line.
        false => format!("\n$$ {name}{mark}{mark}\n"),
    }
}
