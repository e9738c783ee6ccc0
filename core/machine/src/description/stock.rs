//! `[stock]`: what is cut, one body or several by names of their own.

use std::collections::BTreeMap;
use std::path::PathBuf;

use nalgebra::Vector3;

use super::bodies::{BodyFile, GivenBody};
use super::build::Builder;
use super::keys::axes_are;
use super::solids::link_of;
use super::table::{
    DeTable, DeValue, EntryError, Key, KeyType, Schemas, Spanned, Value, defined, entries,
    table_schema,
};
use super::{Axis, Machine};

/// `[stock]`: a body, or tables `[stock.NAME]` of bodies.
#[derive(Debug, Default)]
pub(crate) struct StockFile {
    /// The body that `[stock]` itself is, and where it stands.
    pub whole: Option<Spanned<BodyFile>>,
    /// Those that have names.
    pub named: BTreeMap<Spanned<String>, Spanned<BodyFile>>,
}

impl KeyType for StockFile {
    fn read(value: &Spanned<DeValue<'_>>, key: &'static Key) -> Result<Self, EntryError> {
        let mut read = Self::default();
        let mut own = DeTable::new();
        for (name, inner) in entries(value, "a table")? {
            let known = BodyFile::KEYS.iter().any(|key| key.name == name.get_ref().as_ref());
            if known || !inner.get_ref().is_table() {
                own.insert(name.clone(), inner.clone());
                continue;
            }
            let body = BodyFile::read(inner, key)?;
            let name = Spanned::new(name.span(), name.get_ref().to_string());
            read.named.insert(name, Spanned::new(inner.span(), body));
        }
        if !own.is_empty() || read.named.is_empty() {
            read.whole = Some(Spanned::new(value.span(), BodyFile::of(&own, value.span())?));
        }
        Ok(read)
    }

    fn schema(named: &mut Schemas) -> Value {
        let about = "What is cut: one body, or several, each a table by a name of your own.";
        let each = BodyFile::schema(named);
        defined(named, "StockFile", about, |named| {
            let mut schema = table_schema(named, BodyFile::KEYS);
            schema["additionalProperties"] = each;
            schema
        })
    }
}

/// How it is known what is left of a stock.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StockCut {
    /// Edge of a cell, mm; that which follows from its size where none is said.
    pub resolution: Option<f64>,
    /// The part that is to become of it, an STL file.
    pub part: Option<PathBuf>,
}

impl Machine {
    /// Least and largest corner of the box around all stocks in the part frame, mm; none where there is none, or an STL file
    /// among them.
    pub fn stock_extents(&self) -> Option<[[f64; 3]; 2]> {
        let on_part = self.stocks.iter().filter(|body| body.in_part);
        let all = on_part.map(GivenBody::extents).collect::<Option<Vec<_>>>()?;
        let corners = all.into_iter().map(|corners| corners.map(Vector3::from));
        let around =
            corners.reduce(|[low, high], [least, most]| [low.inf(&least), high.sup(&most)]);
        around.map(|corners| corners.map(Into::into))
    }
}

impl Builder<'_> {
    /// The stocks.
    pub(super) fn stocks(
        &mut self,
        file: Option<&Spanned<StockFile>>,
        axes: &[Axis],
    ) -> Vec<GivenBody> {
        let Some(file) = file.map(Spanned::get_ref) else { return Vec::new() };
        let whole = file.whole.iter().filter_map(|body| self.stock("stock", body, axes));
        let mut stocks: Vec<GivenBody> = whole.collect();
        if let (Some(whole), false, false) = (&file.whole, stocks.is_empty(), file.named.is_empty())
        {
            let message = "[stock] is a body, and there are others by names".to_owned();
            let help = "[stock.NAME] for each of them; stock.file = \"\" takes one away that an extended machine has";
            self.fault("machine-body", whole.span(), message, help);
        }
        for (name, body) in &file.named {
            let called = name.get_ref();
            let plain = |letter: char| letter.is_alphanumeric() || matches!(letter, '-' | '_');
            if called.is_empty() || !called.chars().all(plain) {
                let message = format!("a stock cannot be called `{called}`");
                let help =
                    "letters, digits, - and _: what is left of it becomes a file of that name";
                self.fault("machine-body", name.span(), message, help);
                continue;
            }
            stocks.extend(self.stock(&format!("stock {called}"), body, axes));
        }
        stocks
    }

    fn stock(&mut self, name: &str, file: &Spanned<BodyFile>, axes: &[Axis]) -> Option<GivenBody> {
        let BodyFile { on, cut, resolution, part, .. } = file.get_ref();
        let link = match on.as_ref().map(|on| (on, link_of(on.get_ref(), axes))) {
            None => 0,
            Some((_, Some(link))) if link < axes.len() => link,
            Some((on, link)) => {
                let (message, help) = match link {
                    Some(_) => (
                        format!("{name} hangs on the tool's side: no tool comes to it"),
                        "what carries it: an axis letter, `b` or `w`".to_owned(),
                    ),
                    None => (
                        format!("{name} hangs on nothing of the machine"),
                        format!("{}; w and b are part and bed", axes_are(axes)),
                    ),
                };
                self.fault("machine-body", on.span(), message, &help);
                return None;
            }
        };
        let resolution = self.checked(resolution);
        let is_cut = cut.as_ref().is_some_and(|cut| *cut.get_ref());
        if let (Some(part), false) = (part, is_cut) {
            let message = format!("{name} has a part, and is not cut");
            self.fault("machine-body", part.span(), message, "cut = true");
        }
        let part = part.as_ref().and_then(|part| self.stl_path("machine-body", part));
        let cut = is_cut.then_some(StockCut { resolution, part });
        let in_part = on.is_none();
        self.body(name, link, file).map(|body| GivenBody { cut, in_part, ..body })
    }
}
