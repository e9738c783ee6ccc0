//! What is marked on the rows of a page: events, and where heads are swapped in.

use post_machine::description::{ToolData, ToolOutline};
use post_report::meta::{CutterMeta, EventMeta, Meta, OutlineMeta};

/// More events than this are counted and not listed.
const MOST_EVENTS: usize = 5000;

/// Marks of the rows of a program.
#[derive(Debug, Default)]
pub struct Marks {
    events: Vec<EventMeta>,
    left_out: u64,
    heads: Vec<[u64; 2]>,
}

impl Marks {
    /// Before `row` something happens.
    pub fn event(&mut self, row: u64, kind: &'static str, text: impl Into<String>) {
        self.push(EventMeta { row, kind, text: text.into(), ..EventMeta::default() });
    }

    /// Before `row` a tool comes; its outline is that of the machine file, if it has one.
    pub fn tool(
        &mut self,
        row: u64,
        text: String,
        cutter: Option<CutterMeta>,
        outline: Option<&ToolOutline>,
    ) {
        let outline = outline.map(|outline| OutlineMeta {
            cutter: outline.cutter.points.clone(),
            holder: outline.holder.points.clone(),
        });
        self.push(EventMeta { row, kind: "tool", text, cutter, outline });
    }

    fn push(&mut self, event: EventMeta) {
        match self.events.len() < MOST_EVENTS {
            true => self.events.push(event),
            false => self.left_out += 1,
        }
    }

    /// From `row` on a head is in use, known by its name and its number from 1; 0: none.
    pub fn head(&mut self, row: u64, name: &str, number: u64) {
        self.heads.push([row, number]);
        self.event(row, "head", format!("head {name}"));
    }

    /// All is marked.
    pub fn finish(self, meta: &mut Meta) {
        meta.head_rows = self.heads;
        meta.events = self.events;
        meta.events_left_out = self.left_out;
    }
}

/// The size of a tool: by the CL file, `[diameter, corner radius]` in mm, else by the file of tools.
pub fn cutter(told: [Option<f64>; 2], listed: Option<&ToolData>) -> Option<CutterMeta> {
    let [diameter, corner] = told;
    let own = diameter.is_some();
    let diameter = diameter.or_else(|| listed?.diameter()).filter(|size| *size > 0.0)?;
    let corner = if own { corner } else { listed.and_then(|tool| tool.corner_radius) };
    Some(CutterMeta {
        diameter,
        corner_radius: corner.unwrap_or(0.0).clamp(0.0, diameter / 2.0),
        stick_out: listed.and_then(|tool| tool.stick_out),
    })
}
