//! Text of the program and what is done of itself: `[program]`.

use std::ops::Range;

use toml::Spanned;

use super::Machine;
use super::build::Builder;
use super::program_file::{ProgramFile, TextLines};
use super::smoothing::SmoothingRules;
use crate::diagnostic::{Diagnostic, SourcePlace};
use crate::program_text::{
    CompensationFacts, DeclaredLines, Extents, Facts, OperationFacts, PlaneFacts, ProgramFacts,
    SpindleFacts, TemplateFault, TextTemplate, ToolFacts,
};

/// A place of the program that a machine file has text for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextPlace {
    /// Before all else.
    FirstLines,
    /// Behind all else.
    LastLines,
    /// The end of the program.
    End,
    /// After the start.
    Header,
    /// Lines before the end.
    Footer,
    /// A tool change.
    ToolChange,
    /// After a tool change.
    AfterToolChange,
    /// Before a tool change but the first.
    BetweenTools,
    /// The start of an operation.
    BeforeOperation,
    /// The end of an operation.
    AfterOperation,
    /// Before the rotary axes turn.
    BeforeTurn,
    /// After the rotary axes have turned.
    AfterTurn,
    /// Before a tilted plane.
    BeforePlane,
    /// After a tilted plane.
    AfterPlane,
    /// Before tool centre point control.
    BeforeTcp,
    /// After tool centre point control.
    AfterTcp,
    /// A retract.
    Retract,
    /// Smoothing on.
    SmoothingOn,
    /// Smoothing off.
    SmoothingOff,
}

impl TextPlace {
    /// The key of a machine file for it.
    pub fn key(self) -> &'static str {
        match self {
            Self::FirstLines => "first_lines",
            Self::LastLines => "last_lines",
            Self::End => "end",
            Self::Header => "header",
            Self::Footer => "footer",
            Self::ToolChange => "tool_change",
            Self::AfterToolChange => "after_tool_change",
            Self::BetweenTools => "between_tools",
            Self::BeforeOperation => "before_operation",
            Self::AfterOperation => "after_operation",
            Self::BeforeTurn => "before_turn",
            Self::AfterTurn => "after_turn",
            Self::BeforePlane => "before_plane",
            Self::AfterPlane => "after_plane",
            Self::BeforeTcp => "before_tcp",
            Self::AfterTcp => "after_tcp",
            Self::Retract => "retract",
            Self::SmoothingOn => "smoothing_on",
            Self::SmoothingOff => "smoothing_off",
        }
    }

    /// The lines stand in the place of the dialect's.
    pub fn replaces(self) -> bool {
        matches!(self, Self::ToolChange | Self::Retract | Self::End)
    }

    /// Facts of the kind that its templates are filled with: all that may be known is, on a machine with these `rotary`
    /// axes.
    fn sample(self, rotary: &[String]) -> Facts {
        let tool = ToolFacts {
            number: 1,
            register: 1,
            name: "MILL".to_owned(),
            length: Some(100.0),
            diameter: Some(10.0),
            corner_radius: Some(1.0),
            speed: Some(1000.0),
        };
        let begins = matches!(self, Self::FirstLines | Self::Header);
        let turned = matches!(
            self,
            Self::BeforeTurn | Self::AfterTurn | Self::BeforePlane | Self::BeforeTcp
        );
        let some = |whether: bool| whether.then(|| tool.clone());
        let operation = matches!(self, Self::BeforeOperation | Self::AfterOperation);
        let smooth = self == Self::SmoothingOn;
        Facts {
            program: ProgramFacts {
                name: "PART".to_owned(),
                cl_file: "part.cls".to_owned(),
                machine: "MILL".to_owned(),
                dialect: "DIALECT".to_owned(),
                units: "mm".to_owned(),
                tolerance: 0.01,
                axis_tolerance: 0.05,
                tools: Some(vec![tool.clone()]),
                extents: Some(Extents::default()),
                time: Some(60.0),
                stock: Some(Extents::default()),
            },
            tool: some(!begins),
            last_tool: some(matches!(
                self,
                Self::ToolChange | Self::AfterToolChange | Self::BetweenTools
            )),
            next_tool: (!begins).then_some(2),
            operation: operation.then(|| OperationFacts {
                name: "ROUGH".to_owned(),
                number: 1,
                feed: Some(600.0),
            }),
            spindle: (!begins).then(|| SpindleFacts {
                speed: Some(1000.0),
                surface_speed: Some(100.0),
                direction: "cw".to_owned(),
            }),
            coolant: (!begins).then(|| "flood".to_owned()),
            work_offset: (!begins).then_some(1),
            compensation: (!begins)
                .then(|| CompensationFacts { side: "left".to_owned(), register: 1 }),
            plane: (!begins)
                .then(|| PlaneFacts { angles: Some([0.0; 3]), ..PlaneFacts::default() }),
            rotary: turned.then(|| rotary.iter().map(|name| (name.clone(), 0.0)).collect()),
            tolerance: smooth.then_some(0.01),
            axis_tolerance: smooth.then_some(0.05),
            line: 1,
        }
    }
}

/// A template of a machine file.
#[derive(Clone, Debug)]
pub struct ProgramText {
    /// Where its lines come.
    pub at: TextPlace,
    template: TextTemplate,
    /// Where each of its lines begins and ends, and where that stands in the file.
    places: Vec<(Range<usize>, Option<SourcePlace>)>,
}

impl ProgramText {
    /// Fills the template with these facts.
    ///
    /// # Errors
    /// What is wrong, with its place in the machine file.
    pub fn lines(&self, facts: &Facts) -> Result<Vec<String>, Box<Diagnostic>> {
        self.template.lines(facts).map_err(|fault| {
            let at = fault.span.map_or(0, |span| span.start);
            let place = self.places.iter().find(|(line, _)| at <= line.end);
            let place = place.or(self.places.first()).and_then(|(_, place)| place.clone());
            Diagnostic::error(
                "program-text",
                format!("[program] {}: {}", self.at.key(), fault.message),
            )
            .at(place)
            .boxed()
        })
    }
}

/// What the machine file says of the program's text.
#[derive(Clone, Debug, Default)]
pub struct ProgramRules {
    /// Templates.
    pub texts: Vec<ProgramText>,
    /// The next tool is made ready behind each tool change.
    pub preselect: bool,
    /// Ending of the program's file, without a dot.
    pub extension: Option<String>,
    /// Some template speaks of what is known ahead alone: tools, extents, time, the next tool, speeds and feeds, the tool of
    /// an operation ahead of it.
    pub looks_ahead: bool,
    /// The names of the rotary axes.
    rotary: Vec<String>,
}

impl ProgramRules {
    /// The text for a place.
    pub fn text(&self, at: TextPlace) -> Option<&ProgramText> {
        self.texts.iter().find(|text| text.at == at)
    }

    /// Has the program end by this word of the control, in the place of the dialect's.
    pub fn end_by(&mut self, word: &str) {
        if let Ok(template) = TextTemplate::parse(word) {
            self.texts.push(ProgramText { at: TextPlace::End, template, places: Vec::new() });
        }
    }

    /// The words of all lines of the user's own, facts of samples in them.
    pub fn own_words(&self) -> impl Iterator<Item = String> {
        let lines =
            self.texts.iter().filter_map(|text| text.lines(&text.at.sample(&self.rotary)).ok());
        let words = lines.flatten().flat_map(|line| {
            let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
            words
        });
        words.collect::<Vec<_>>().into_iter()
    }
}

/// Facts that a first pass over the CL file finds.
const AHEAD: [&str; 6] = [
    "program.tools",
    "program.extents",
    "program.time",
    "next_tool",
    "tool.speed",
    "operation.feed",
];

impl Machine {
    /// The machine without text of its own: for a pass whose program nobody reads, and in which not all is known that a
    /// template asks for.
    pub fn without_text(&self) -> Self {
        let mut plain = self.clone();
        if self.program.text(TextPlace::SmoothingOn).is_some() {
            plain.smoothing = SmoothingRules::default();
        }
        plain.program = ProgramRules::default();
        plain
    }

    /// The lines that its file has of its own: templates of `[program]`, rules of `[cl.words]`.
    pub fn declared_lines(&self) -> DeclaredLines {
        let mut declared = DeclaredLines::default();
        for text in &self.program.texts {
            match text.at {
                TextPlace::End => declared.end(&text.template),
                _ => declared.template(&text.template),
            }
        }
        self.word_rules.iter().for_each(|rule| declared.rule(rule.texts()));
        declared
    }
}

impl Builder<'_> {
    /// `rotary` are the names of the rotary axes.
    pub(super) fn program(&mut self, file: &ProgramFile, rotary: Vec<String>) -> ProgramRules {
        let mut rules = ProgramRules {
            preselect: file.preselect,
            looks_ahead: file.preselect,
            rotary,
            ..ProgramRules::default()
        };
        self.texts(file, &mut rules);
        self.extension(file, &mut rules);
        rules
    }

    fn texts(&mut self, file: &ProgramFile, rules: &mut ProgramRules) {
        for (at, lines) in [
            (TextPlace::FirstLines, &file.first_lines),
            (TextPlace::LastLines, &file.last_lines),
            (TextPlace::End, &file.end),
            (TextPlace::Header, &file.header),
            (TextPlace::Footer, &file.footer),
            (TextPlace::ToolChange, &file.tool_change),
            (TextPlace::AfterToolChange, &file.after_tool_change),
            (TextPlace::BetweenTools, &file.between_tools),
            (TextPlace::BeforeOperation, &file.before_operation),
            (TextPlace::AfterOperation, &file.after_operation),
            (TextPlace::BeforeTurn, &file.before_turn),
            (TextPlace::AfterTurn, &file.after_turn),
            (TextPlace::BeforePlane, &file.before_plane),
            (TextPlace::AfterPlane, &file.after_plane),
            (TextPlace::BeforeTcp, &file.before_tcp),
            (TextPlace::AfterTcp, &file.after_tcp),
            (TextPlace::Retract, &file.retract),
            (TextPlace::SmoothingOn, &file.smoothing_on),
            (TextPlace::SmoothingOff, &file.smoothing_off),
        ] {
            let Some(lines) = lines else { continue };
            let source: Vec<&str> =
                lines.get_ref().0.iter().map(|(line, _)| line.as_str()).collect();
            let source = source.join("\n");
            rules.looks_ahead |= AHEAD.iter().any(|fact| source.contains(fact))
                // The tool of an operation comes behind its name.
                || at == TextPlace::BeforeOperation && source.contains("tool.");
            let text = self.text(at, lines, &source, &rules.rotary);
            rules.texts.extend(text);
        }
        for (on, off) in [
            (TextPlace::SmoothingOn, TextPlace::SmoothingOff),
            (TextPlace::SmoothingOff, TextPlace::SmoothingOn),
        ] {
            if let (Some(text), None) = (rules.text(on), rules.text(off)) {
                let place = text.places.first().and_then(|(_, place)| place.clone());
                let message = format!("[program] has {} and no {}", on.key(), off.key());
                self.faults.push(Diagnostic::error("program-text", message).at(place));
            }
        }
    }

    fn extension(&mut self, file: &ProgramFile, rules: &mut ProgramRules) {
        if let Some(extension) = &file.extension {
            let name = extension.get_ref();
            let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
            if name.is_empty() || name.len() > 16 || !name.chars().all(plain) {
                let message = format!("{name:?} is no ending of a file");
                let help = "letters and digits, without a dot: \"nc\"";
                self.fault("machine-program", extension.span(), message, help);
            }
            rules.extension = Some(name.clone());
        }
    }

    /// A template, filled once with facts of the kind that it will be filled with.
    fn text(
        &mut self,
        at: TextPlace,
        lines: &Spanned<TextLines>,
        source: &str,
        rotary: &[String],
    ) -> Option<ProgramText> {
        let mut begin = 0;
        let spans: Vec<LineSpans> = lines
            .get_ref()
            .0
            .iter()
            .map(|(line, span)| {
                let template = begin..begin + line.len();
                begin = template.end + 1;
                LineSpans { template, file: span.clone().unwrap_or(lines.span()) }
            })
            .collect();
        let read = TextTemplate::parse(source);
        let read = read.and_then(|template| template.lines(&at.sample(rotary)).map(|_| template));
        match read {
            Ok(template) => Some(ProgramText {
                at,
                template,
                places: spans
                    .into_iter()
                    .map(|spans| (spans.template, self.sources.place(spans.file)))
                    .collect(),
            }),
            Err(TemplateFault { message, span }) => {
                let span = span.map_or(lines.span(), |span| file_span(&spans, &span, lines.span()));
                let message = format!("[program] {}: {message}", at.key());
                let help = "machines/README.md lists the facts that a template can speak of";
                self.fault("program-text", span, message, help);
                None
            }
        }
    }
}

/// Where a line of a template stands, bytes: in the text of the template, and in the file, with its quotes.
struct LineSpans {
    template: Range<usize>,
    file: Range<usize>,
}

/// The bytes of the file that are those of a template, where its line is written as it is read, without escapes.
fn file_span(lines: &[LineSpans], fault: &Range<usize>, whole: Range<usize>) -> Range<usize> {
    let Some(LineSpans { template: line, file: raw }) =
        lines.iter().find(|spans| fault.start <= spans.template.end)
    else {
        return whole;
    };
    // A quote at both ends.
    if raw.len() != line.len() + 2 {
        return raw.clone();
    }
    let start = raw.start + 1 + (fault.start - line.start.min(fault.start));
    let end =
        raw.start + 1 + (fault.end.clamp(fault.start, line.end) - line.start.min(fault.start));
    start..end.max(start + 1).min(raw.end)
}
