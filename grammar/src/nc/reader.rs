//! Bytes of a file to blocks, in one buffer that is used again and again.
//!
//! A line ends at LF, CR LF or CR. What stands in front of the first `%`, and after one that ends a program, is
//! skipped and counted if its first line cannot be read as a block: it is a listing of whatever wrote the file.

use std::borrow::Cow;
use std::io::{Read, Seek};

use super::block::{NcBlock, NcFlow, NcItem, NcSyntax, Notation};
use super::fault::Unreadable;
use super::layout::BlockLayouts;
use super::lines::{NcMark, PhysicalBlockLine, ProgramLines, line_end};
use super::run::{NcRun, NcRunRule};
use super::search::JumpCache;
use super::{conversational, remarks, scan, statements, words};
use crate::fault::{ReadError, SyntaxFault};

/// Longest block, in bytes of the file, lines that continue it counted: no control takes a longer one.
pub(super) const LONGEST: usize = 16 * 1024;

/// Brackets inside one another.
const DEEPEST: usize = 32;

/// Lines within which the `%` stands that ends a listing's head.
const LONGEST_HEADER: usize = 200;

/// Reads the blocks of an NC program one by one; memory does not grow with the program.
///
/// The input need not be buffered.
#[derive(Debug)]
pub struct NcReader<R> {
    pub(super) lines: ProgramLines<R>,
    pub(super) syntax: NcSyntax,
    /// Jumps that were looked for.
    pub(super) found: JumpCache,
    scratch: BlockText,
    /// How blocks were laid out.
    layouts: BlockLayouts,
    /// The head of the file was looked at.
    opened: bool,
    /// A block was read since the last `%`.
    began: bool,
    /// A `%` stands in front of the next block.
    behind_percent: bool,
    header: u64,
    trailer: u64,
}

/// Room for one block, continuations joined.
#[derive(Debug, Default)]
struct BlockText {
    /// Text as written.
    text: String,
    /// Text in capitals, remarks blanked out.
    code: String,
}

impl<R: Read + Seek> NcReader<R> {
    /// Reads from `input`, from where it stands.
    pub fn new(input: R, syntax: NcSyntax) -> Self {
        Self {
            lines: ProgramLines::new(input),
            syntax,
            found: JumpCache::default(),
            scratch: BlockText::default(),
            layouts: BlockLayouts::new(),
            opened: false,
            began: false,
            behind_percent: false,
            header: 0,
            trailer: 0,
        }
    }

    /// Lines in front of the program that were skipped.
    pub fn header_lines(&self) -> u64 {
        self.header
    }

    /// Lines after the program's `%` that were skipped.
    pub fn trailer_lines(&self) -> u64 {
        self.trailer
    }

    /// Where the next block begins.
    pub fn mark(&self) -> NcMark {
        self.lines.mark()
    }

    /// The text of the line of this number, which is that at `mark` or one after it: for messages about a block that
    /// was just read. None if it is no longer at hand.
    pub fn text(&self, mark: NcMark, line: u64) -> Option<Cow<'_, str>> {
        self.lines.kept(mark, line).map(decode)
    }

    /// Goes on with the block at `mark`.
    ///
    /// # Errors
    /// The input fails.
    pub fn go_to(&mut self, mark: NcMark) -> Result<(), ReadError> {
        Ok(self.lines.go_to(mark)?)
    }

    /// Puts the next block into `block`; false at the end of the file. Lines with neither a word nor a remark are
    /// passed over, and so is the `%` in front of a program; one after a program, if more blocks follow, is a block of
    /// the name `%`.
    ///
    /// # Errors
    /// A block that cannot be read: the next call goes on with the one after it. Or the input fails.
    pub fn next_block(&mut self, block: &mut NcBlock) -> Result<bool, ReadError> {
        block.clear();
        if !self.opened {
            self.open()?;
        }
        block.line = self.lines.line();
        let mut plain = self.plain(block);
        // The line may go on after what was read of the file.
        if plain.is_none() && self.lines.read_on()? {
            block.clear();
            plain = self.plain(block);
        }
        if let Some(length) = plain {
            self.lines.pass(length);
            self.began = true;
            self.behind_percent = false;
            return Ok(true);
        }
        block.clear();
        while let Some(physical) = self.lines.physical()? {
            block.line = self.lines.line();
            let line = self.lines.text(&physical);
            if is_blank(line) {
                self.lines.consume(&physical)?;
                continue;
            }
            if is_percent(line) && self.syntax.notation == Notation::Words {
                self.lines.consume(&physical)?;
                if self.percent()? {
                    block.items.push(NcItem::Name("%".into()));
                    return Ok(true);
                }
                continue;
            }
            let named = self.behind_percent.then(|| program_name(line)).flatten();
            self.began = true;
            self.behind_percent = false;
            if let Some(name) = named {
                self.lines.consume(&physical)?;
                block.items.push(NcItem::Flow(Box::new(NcFlow::Label(name))));
                return Ok(true);
            }
            self.logical(&physical, block)?;
            if block.items.is_empty() && block.remarks.is_empty() && !block.skipped {
                continue;
            }
            return Ok(true);
        }
        Ok(false)
    }

    /// Takes the blocks that follow, as far as they are at hand, are laid out as others before them and keep to `rule`,
    /// into `run`. There may be none: [`Self::next_block`] goes on then.
    pub fn next_run(&mut self, rule: &NcRunRule, run: &mut NcRun) {
        run.count = 0;
        let plain = self.opened && self.began && !self.behind_percent;
        if !plain || self.syntax.notation != Notation::Words {
            return;
        }
        run.line = self.lines.line();
        self.layouts.take(self.lines.buffer(), self.lines.at_hand(), rule, run);
        if let Some(last) = run.count.checked_sub(1) {
            self.lines.pass_lines(run.ends[last], run.count as u64);
        }
    }

    /// Goes back to the block behind the first `count` of the run that was taken last: what follows is no part of it.
    pub fn shorten(&mut self, run: &mut NcRun, count: usize) {
        if count >= run.count {
            return;
        }
        let end = |count: usize| count.checked_sub(1).map_or(0, |last| run.ends[last]);
        self.lines.step_back(end(run.count) - end(count), (run.count - count) as u64);
        run.count = count;
    }

    /// Reads a block of words and numbers; gives the length of its line. None if it is anything else, or if more of the
    /// file must be read to know where it ends.
    #[inline(always)]
    fn plain(&self, block: &mut NcBlock) -> Option<usize> {
        let pending = self.lines.pending();
        let end = scan::plain(pending, self.syntax.notation, block)?;
        if end > LONGEST {
            return None;
        }
        line_end(&pending[end..], self.lines.ended()).map(|length| end + length)
    }

    /// Reads the block that begins with the line `first`, and goes past it.
    fn logical(&mut self, first: &PhysicalBlockLine, block: &mut NcBlock) -> Result<(), ReadError> {
        let line = self.lines.line();
        self.scratch.text.clear();
        self.scratch.code.clear();
        let mut taken = self.scratch.add(self.lines.text(first), &self.syntax, block);
        let mut overlong = first.overlong;
        self.lines.consume(first)?;
        if self.syntax.notation == Notation::Conversational {
            while !overlong && self.continues(block)? {
                let Some(next) = self.lines.physical()? else {
                    break;
                };
                let more = self.scratch.add(self.lines.text(&next), &self.syntax, block);
                taken = taken.and(more);
                overlong = next.overlong || self.scratch.text.len() > LONGEST;
                self.lines.consume(&next)?;
            }
        }
        if overlong {
            return Err(overlong_block(&self.scratch.text, line).into());
        }
        let BlockText { text, code } = &self.scratch;
        let read =
            taken.and_then(|()| check_depth(code)).and_then(|()| match self.syntax.notation {
                Notation::Words => words::parse(code, text, &self.syntax, block),
                Notation::Conversational => conversational::parse(code, text, block),
                Notation::Statements => statements::parse(code, text, block),
            });
        read.map_err(|fault| fault.fault(text, line).into())
    }

    /// Whether the conversational block in hand goes on in the next line: it ends in `~`, or it defines a cycle and the
    /// next line has no number and gives a parameter.
    fn continues(&mut self, block: &mut NcBlock) -> Result<bool, ReadError> {
        if self.scratch.joins(block) {
            return Ok(true);
        }
        if !conversational::defines_cycle(&self.scratch.code) {
            return Ok(false);
        }
        let Some(next) = self.lines.physical()? else {
            return Ok(false);
        };
        Ok(conversational::gives_parameter(self.lines.text(&next)))
    }

    /// Passes over the listing in front of the program.
    fn open(&mut self) -> Result<(), ReadError> {
        self.opened = true;
        self.lines.skip_byte_order_mark()?;
        let start = self.lines.mark();
        let (mut listing, mut remarks) = (None, false);
        let mut program: Option<NcMark> = None;
        for _ in 0..LONGEST_HEADER {
            let Some(physical) = self.lines.physical()? else {
                break;
            };
            let line = self.lines.text(&physical);
            if is_blank(line) {
                self.lines.consume(&physical)?;
                continue;
            }
            if let Some(program) = program {
                // Something follows, so it was no program that ends there.
                self.header = program.line() - start.line();
                return Ok(self.lines.go_to(program)?);
            }
            if begins_program(line, self.syntax.notation) {
                if !listing.unwrap_or(remarks) {
                    break;
                }
                program = Some(self.lines.mark());
            } else if listing.is_none() {
                match self.is_remark(line) {
                    true => remarks = true,
                    false => listing = Some(!self.is_block(line)),
                }
            }
            self.lines.consume(&physical)?;
        }
        Ok(self.lines.go_to(start)?)
    }

    /// Reads on after a `%`: whether blocks of another program follow one that ended. A listing is passed over.
    fn percent(&mut self) -> Result<bool, ReadError> {
        self.behind_percent = true;
        if !std::mem::take(&mut self.began) {
            return Ok(false);
        }
        let behind = self.lines.mark();
        let mut listing = false;
        while let Some(physical) = self.lines.physical()? {
            let line = self.lines.text(&physical);
            if is_percent(line) {
                return Ok(true);
            }
            if !listing && !is_blank(line) {
                if self.is_block(line) {
                    self.lines.go_to(behind)?;
                    return Ok(true);
                }
                listing = true;
            }
            self.trailer += u64::from(listing);
            self.lines.consume(&physical)?;
        }
        Ok(false)
    }

    /// Whether a line is a remark and nothing else: a block, or a line in front of the program.
    fn is_remark(&self, line: &[u8]) -> bool {
        let mut block = NcBlock::default();
        let read = BlockText::default().read(line, &self.syntax, &mut block);
        read.is_ok()
            && block.items.is_empty()
            && block.number.is_none()
            && !block.remarks.is_empty()
    }

    /// Whether a line can be a block, and is not just words of a text.
    fn is_block(&self, line: &[u8]) -> bool {
        let mut block = NcBlock::default();
        let read = BlockText::default().read(line, &self.syntax, &mut block);
        let names = |item: &NcItem| matches!(item, NcItem::Name(_));
        let prose =
            block.number.is_none() && block.items.len() > 1 && block.items.iter().all(names);
        (read.is_ok() && !prose) || program_name(line).is_some()
    }
}

impl BlockText {
    /// Puts a line after those of its block.
    fn add(
        &mut self,
        line: &[u8],
        syntax: &NcSyntax,
        block: &mut NcBlock,
    ) -> Result<(), Unreadable> {
        let line = decode(line);
        if !self.text.is_empty() {
            self.text.push(' ');
            self.code.push(' ');
        }
        self.text.push_str(&line);
        let taken = remarks::take_out(&line, syntax, &mut self.code, &mut block.remarks);
        // Of a line with a fault the rest is not taken: both stay as long as each other.
        let missing = self.text.len().saturating_sub(self.code.len());
        self.code.extend(std::iter::repeat_n(' ', missing));
        taken
    }

    /// Reads the block in hand by its grammar.
    fn parse(&self, syntax: &NcSyntax, block: &mut NcBlock) -> Result<(), Unreadable> {
        let Self { text, code } = self;
        check_depth(code)?;
        match syntax.notation {
            Notation::Words => words::parse(code, text, syntax, block),
            Notation::Conversational => conversational::parse(code, text, block),
            Notation::Statements => statements::parse(code, text, block),
        }
    }

    /// Reads a block of one line by its grammar.
    fn read(
        &mut self,
        line: &[u8],
        syntax: &NcSyntax,
        block: &mut NcBlock,
    ) -> Result<(), Unreadable> {
        self.add(line, syntax, block)?;
        self.parse(syntax, block)
    }

    /// Takes off the `~` that joins the next line to this one; false if there is none. It may be the last character of
    /// the line's remark, if the block is more than a remark.
    fn joins(&mut self, block: &mut NcBlock) -> bool {
        let code = self.code.trim_end();
        if let Some(body) = code.strip_suffix('~') {
            let at = body.len();
            self.code.replace_range(at..=at, " ");
            self.text.replace_range(at..=at, " ");
            return true;
        }
        let blank = code.trim_start_matches(|each: char| each.is_ascii_digit() || each == ' ');
        let joined = !blank.is_empty() && self.text.trim_end().ends_with('~');
        if joined && let Some(remark) = block.remarks.last_mut() {
            let body = remark.trim_end_matches('~').trim_end().len();
            remark.truncate(body);
        }
        joined
    }
}

/// Reads a block of one line by the grammar alone, as [`NcReader`] does with all that is more than words and numbers.
///
/// # Errors
/// What cannot be read in it.
pub fn parse_block(line: &str, syntax: &NcSyntax) -> Result<NcBlock, SyntaxFault> {
    let mut block = NcBlock { line: 1, ..NcBlock::default() };
    let read = BlockText::default().read(line.as_bytes(), syntax, &mut block);
    read.map_err(|fault| fault.fault(line, 1))?;
    Ok(block)
}

/// The text of a line. What is not UTF-8 is taken for Latin-1, which older systems write.
fn decode(raw: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(raw) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => Cow::Owned(raw.iter().map(|&byte| char::from(byte)).collect()),
    }
}

/// Neither word nor remark; old systems pad with NUL, and end a file with 0x1A.
fn is_blank(line: &[u8]) -> bool {
    line.iter().all(|byte| matches!(byte, b' ' | b'\t' | 0 | 0x1A))
}

fn is_percent(line: &[u8]) -> bool {
    line.trim_ascii() == b"%"
}

/// Whether a listing ends in front of this line.
fn begins_program(line: &[u8], notation: Notation) -> bool {
    let line = line.trim_ascii();
    match notation {
        Notation::Words => line == b"%" || line.starts_with(b"%_N_"),
        Notation::Conversational => {
            let behind = line.trim_ascii_start().iter().skip_while(|byte| byte.is_ascii_digit());
            let behind: Vec<u8> = behind.copied().take(16).collect();
            behind.trim_ascii().to_ascii_uppercase().starts_with(b"BEGIN PGM")
        }
        Notation::Statements => false,
    }
}

/// The name after the `O` of a program that has no number: `OFinal ToolPath`.
fn program_name(line: &[u8]) -> Option<String> {
    let line = line.trim_ascii();
    let name = line.strip_prefix(b"O").or(line.strip_prefix(b"o"))?;
    if !name.first()?.is_ascii_alphabetic() || name.iter().any(|byte| !is_of_a_name(*byte)) {
        return None;
    }
    Some(decode(line).to_ascii_uppercase())
}

fn is_of_a_name(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b' ' | b'_' | b'-' | b'.')
}

/// Brackets are counted before the grammar calls itself for each.
fn check_depth(code: &str) -> Result<(), Unreadable> {
    let mut depth = 0_usize;
    for (at, byte) in code.bytes().enumerate() {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let fault = Unreadable::new(format!("more than {DEEPEST} brackets are open"));
            return Err(fault.at(at..at + 1));
        }
    }
    Ok(())
}

fn overlong_block(text: &str, line: u64) -> SyntaxFault {
    Unreadable::new(format!("a block of more than {LONGEST} bytes"))
        .help("is this a program of this control?")
        .fault(text, line)
}
