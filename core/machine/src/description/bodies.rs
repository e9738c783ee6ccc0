//! What can hit something: shapes of bodies, fixtures; and the distances to keep.

use std::collections::BTreeMap;
use std::path::PathBuf;

use nalgebra::Vector3;
use toml::Spanned;

use super::Axis;
use super::bounds::Bounds;
use super::build::Builder;
use super::keys::axes_are;
use super::quantity::KeyedNumber;
use super::solids::link_of;
use super::stock::{StockCut, StockFile};
use super::table::{keys, words};
use crate::diagnostic::SourcePlace;

const KEPT: Bounds = Bounds {
    table: "[clearance] ",
    says: " mm",
    help: "0 or more",
    ..Bounds::from_zero("machine-body")
};

/// Names of bodies by what they are; those of a tool stand ahead of its number too: `holder T3`.
const KINDS: [&str; 3] = ["stock", "holder", "cutter"];
const RESOLUTION: Bounds =
    Bounds { table: "[stock] ", says: " mm", ..Bounds::above_zero("machine-body") };

/// A cylinder is longer than this, mm: of a shorter one rounding says where it points.
const SHORTEST: f64 = 1e-6;

const RADIUS: Bounds = Bounds { says: " mm", ..Bounds::above_zero("machine-body") };

words! {
    /// How the axes of a rapid go.
    RapidAxes = Independent {
        /// Each for itself: they need not arrive together, and a proof holds for all that is between the ends.
        Independent "independent",
        /// All together, on the straight line between the ends.
        Together "together",
    }
}

keys! {
    /// A body that can hit something. It has one of `block`, `cylinder` and `file`.
    BodyFile {
        /// What it hangs on: an axis letter is what that axis moves, `b` the bed, `t` the tool's side, `w` what carries the
        /// part; w if not said. A stock for which nothing is said stands where the CL file has the part.
        on: Option<Spanned<String>>,
        /// A box along X, Y and Z, from one corner to the opposite one, mm: a fixture, and a stock with `on`, in the machine
        /// frame with every axis at zero; another stock in the part frame, as the CL file has it.
        block: Option<Spanned<[[KeyedNumber; 3]; 2]>>,
        /// A cylinder, the middles of its ends, mm, in the frame of `block`.
        cylinder: Option<Spanned<[[KeyedNumber; 3]; 2]>>,
        /// Radius of the cylinder, mm.
        radius: Option<KeyedNumber> = RADIUS,
        /// An STL file, mm, in the frame of `block`. A path is that from this file; an empty one takes the body away that an
        /// extended machine has.
        file: Option<Spanned<String>>,
        /// The stock gets less by what is certainly cut of it; a fixture does not. If not said the stock is that before the
        /// first cut, all the way.
        cut: Option<Spanned<bool>>,
        /// Edge of the cells by which it is known what is left of a stock that is cut, mm; follows from its size if not said.
        /// Faces across X, Y and Z are exact, others are known to within this.
        resolution: Option<KeyedNumber> = RESOLUTION,
        /// The part that is to become of a stock that is cut, an STL file in the frame of `block`, mm: told is where it is cut
        /// into and what is left on it. A path is that from this file.
        part: Option<Spanned<String>>,
    }
}

keys! {
    /// What `post clearance` proves, and of what.
    ClearanceFile {
        /// Distance that bodies keep from one another at feed, mm; 0 if not said: they do not touch.
        keep: Option<KeyedNumber> = KEPT,
        /// Distance that they keep at rapid, mm; that at feed if not said.
        rapid: Option<KeyedNumber> = KEPT,
        /// Pairs that are not looked at, such as `[["C", "A"]]`: an axis letter, `b`, `w` and `t` mean all bodies that hang
        /// there, `stock`, `holder`, `cutter` and the name of a fixture these, `holder T3` that of one tool.
        ignore: Vec<[Spanned<String>; 2]>,
        /// Pairs that keep another distance, such as `[{ between = ["holder", "stock"], keep = 5, rapid = 10 }]`; of several
        /// that name the same two bodies the last holds.
        pairs: Vec<ClearancePairFile>,
        /// How the axes of a rapid go where the control does not keep the tip.
        rapid_axes: RapidAxes,
        /// Of several ways to turn the axes those are taken on which bodies stay clear, where there are any.
        choose: bool = Bounds::OFF,
        /// Between two positions of one tool it is retracted only as high as the way across is proven clear, and no program is
        /// written that is not proven clear: the part must sit where `[workpiece] mount` says.
        low_retracts: bool = Bounds::OFF,
        /// As `low_retracts`, and the way across goes past bodies where that is quicker than over them; rapids of the CL file
        /// between two cuts that point the tool alike go across as low as it is proven clear.
        link: bool = Bounds::OFF,
    }
}

keys! {
    /// Two bodies that keep another distance than all others.
    ClearancePairFile {
        /// Their names, as in `ignore`.
        between: [Spanned<String>; 2],
        /// Distance that they keep at feed, mm; that of `[clearance]` if not said.
        keep: Option<KeyedNumber> = KEPT,
        /// Distance that they keep at rapid, mm; that at feed if not said. Cutter and stock take this alone.
        rapid: Option<KeyedNumber> = KEPT,
    }
}

/// A body that a machine file describes.
#[derive(Clone, Debug, PartialEq)]
pub struct GivenBody {
    /// Its name: that of the fixture, `stock`, or `stock NAME` of one of several.
    pub name: String,
    /// The body of the machine that it hangs on: 0 carries the part, n is what follows the nth axis of the chain.
    pub link: usize,
    /// Its shape, mm: in the frame of the CL file, if it is in that of the part; else in the machine frame, every axis at zero.
    pub shape: GivenShape,
    /// A stock that stands where the CL file has the part.
    pub in_part: bool,
    /// Where the machine file has it.
    pub place: Option<SourcePlace>,
    /// It gets less by what is cut of it.
    pub cut: Option<StockCut>,
}

impl GivenBody {
    /// Least and largest corner of the box along the axes of its frame that it fills, mm; none of an STL file.
    pub fn extents(&self) -> Option<[[f64; 3]; 2]> {
        let [least, most] = match &self.shape {
            GivenShape::Block(corners) => *corners,
            GivenShape::Cylinder { ends: [one, other], radius } => {
                let along = (other - one).try_normalize(0.0).unwrap_or_default();
                let aside = along.map(|part| radius * (1.0 - part * part).max(0.0).sqrt());
                [one.inf(other) - aside, one.sup(other) + aside]
            }
            GivenShape::File(_) => return None,
        };
        Some([least.into(), most.into()])
    }
}

/// A shape that a machine file describes, mm.
#[derive(Clone, Debug, PartialEq)]
pub enum GivenShape {
    /// A box between two corners.
    Block([Vector3<f64>; 2]),
    /// A cylinder.
    Cylinder {
        /// Middles of its ends.
        ends: [Vector3<f64>; 2],
        /// Its radius.
        radius: f64,
    },
    /// An STL file.
    File(PathBuf),
}

/// Two bodies, or all bodies of two kinds, by the names that a machine file calls them.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPair {
    /// Their names.
    pub names: [String; 2],
    /// Where the machine file has them.
    pub place: Option<SourcePlace>,
    /// The one of them that is taken away with an empty `file`.
    pub taken_away: Option<String>,
}

/// Two bodies that keep another distance than all others.
#[derive(Clone, Debug, PartialEq)]
pub struct KeptPair {
    /// The bodies.
    pub between: BodyPair,
    /// Distance at feed, mm.
    pub keep: f64,
    /// Distance at rapid, mm.
    pub rapid: f64,
}

/// What is kept between bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClearanceRules {
    /// Distance at feed, mm.
    pub keep: f64,
    /// Distance at rapid, mm.
    pub rapid: f64,
    /// Pairs that are not looked at.
    pub ignore: Vec<BodyPair>,
    /// Pairs that keep other distances; the last that names two bodies holds.
    pub pairs: Vec<KeptPair>,
    /// How the axes of a rapid go.
    pub rapid_axes: RapidAxes,
    /// Solutions are chosen that keep bodies clear.
    pub choose: bool,
    /// Retracts go only as high as bodies ask for.
    pub low_retracts: bool,
    /// Ways across go past bodies.
    pub link: bool,
}

impl ClearanceRules {
    /// Ways between passes are as bodies leave them: clearance is proven of every program, and holds for one mount alone.
    pub fn shortens_ways(&self) -> bool {
        self.low_retracts || self.link
    }

    /// All pairs that are named.
    pub fn named(&self) -> impl Iterator<Item = &BodyPair> {
        self.ignore.iter().chain(self.pairs.iter().map(|pair| &pair.between))
    }
}

impl Builder<'_> {
    /// Fixtures.
    pub(super) fn fixtures(
        &mut self,
        file: &BTreeMap<Spanned<String>, Spanned<BodyFile>>,
        axes: &[Axis],
    ) -> Vec<GivenBody> {
        let bodies = file.iter().filter_map(|(name, body)| {
            let called = name.get_ref().as_str();
            let first = called.split(' ').next().unwrap_or_default();
            if KINDS.contains(&first) || first == "shank" || link_of(called, axes).is_some() {
                let message = format!("a fixture cannot be called {called}: that is another body");
                let help = "a name of your own; stock, holder, cutter, shank and what begins with these words, b, w, t and axis letters are taken, the stock is [stock]";
                self.fault("machine-body", name.span(), message, help);
                return None;
            }
            let on = body.get_ref().on.as_ref();
            let link = match on {
                Some(on) => link_of(on.get_ref(), axes),
                None => Some(0),
            };
            let BodyFile { cut, resolution, part, .. } = body.get_ref();
            if cut.is_some() || resolution.is_some() || part.is_some() {
                let message = format!("fixture {} says how it is cut", name.get_ref());
                self.fault("machine-body", body.span(), message, "only a stock gets less");
            }
            let Some(link) = link else {
                let span = on.map_or_else(|| name.span(), Spanned::span);
                let message = format!("fixture {} hangs on nothing of the machine", name.get_ref());
                let help = format!("{}; w, b and t are part, bed and tool", axes_are(axes));
                self.fault("machine-body", span, message, &help);
                return None;
            };
            self.body(name.get_ref(), link, body)
        });
        bodies.collect()
    }

    /// A body of this name on a link, as its table has it; none where that takes it away.
    pub(super) fn body(
        &mut self,
        name: &str,
        link: usize,
        file: &Spanned<BodyFile>,
    ) -> Option<GivenBody> {
        let BodyFile { block, cylinder, radius, file: stl, .. } = file.get_ref();
        let radius = self.checked(radius);
        let shape = match (block, cylinder, radius, stl) {
            (Some(corners), None, None, None) => {
                let [one, other] = corners.get_ref().each_ref().map(|corner| self.vector(corner));
                if one.iter().zip(&other).any(|(one, other)| one == other) {
                    let message = format!("{name} has no room between its corners");
                    let help = "corners that differ in X, Y and Z";
                    self.fault("machine-body", corners.span(), message, help);
                    return None;
                }
                GivenShape::Block([one.inf(&other), one.sup(&other)])
            }
            (None, Some(ends), Some(radius), None) => {
                let [one, other] = ends.get_ref().each_ref().map(|end| self.vector(end));
                if (other - one).norm() < SHORTEST {
                    let message = format!("{name} has no length between the ends of its cylinder");
                    let help = "the middles of both ends, which differ; a disc has its thickness";
                    self.fault("machine-body", ends.span(), message, help);
                    return None;
                }
                GivenShape::Cylinder { ends: [one, other], radius }
            }
            (None, None, None, Some(stl)) if stl.get_ref().is_empty() => return None,
            (None, None, None, Some(stl)) => GivenShape::File(self.stl_path("machine-body", stl)?),
            _ => {
                let message = format!("{name} has no shape, or more than one");
                let help = "block = [[x, y, z], [x, y, z]], or cylinder = [[x, y, z], [x, y, z]] with radius, or file = \"NAME.stl\"";
                self.fault("machine-body", file.span(), message, help);
                return None;
            }
        };
        let place = self.sources.place(file.span());
        Some(GivenBody { name: name.to_owned(), link, shape, place, in_part: false, cut: None })
    }

    /// What is to be kept; pairs may name fixtures that are taken away.
    pub(super) fn clearance(
        &mut self,
        file: &ClearanceFile,
        fixtures: &BTreeMap<Spanned<String>, Spanned<BodyFile>>,
        stock: Option<&Spanned<StockFile>>,
    ) -> ClearanceRules {
        let gone =
            |body: &BodyFile| body.file.as_ref().is_some_and(|file| file.get_ref().is_empty());
        let fixtures = fixtures.iter().map(|(name, body)| (name.get_ref().clone(), body));
        let stocks = stock.into_iter().flat_map(|stock| &stock.get_ref().named);
        let stocks = stocks.map(|(name, body)| (format!("stock {}", name.get_ref()), body));
        let gone = fixtures.chain(stocks).filter(|(_, body)| gone(body.get_ref()));
        let gone: Vec<String> = gone.map(|(name, _)| name).collect();
        let keep = self.checked(&file.keep).unwrap_or(0.0);
        let mut pairs = Vec::with_capacity(file.pairs.len());
        for pair in &file.pairs {
            let kept = self.checked(&pair.keep);
            self.check_cutter_and_stock(pair, kept);
            let kept = kept.unwrap_or(keep);
            pairs.push(KeptPair {
                between: self.body_pair(&pair.between, &gone),
                keep: kept,
                rapid: self.checked(&pair.rapid).unwrap_or(kept),
            });
        }
        ClearanceRules {
            keep,
            rapid: self.checked(&file.rapid).unwrap_or(keep),
            ignore: file.ignore.iter().map(|pair| self.body_pair(pair, &gone)).collect(),
            pairs,
            rapid_axes: file.rapid_axes,
            choose: file.choose,
            low_retracts: file.low_retracts,
            link: file.link,
        }
    }

    /// At feed the cutter is in the stock: there is a distance at rapid alone.
    fn check_cutter_and_stock(&mut self, pair: &ClearancePairFile, keep: Option<f64>) {
        let mut names = pair.between.iter().map(|name| name.get_ref().as_str());
        let cutter = names.clone().any(|name| name == "cutter" || name.starts_with("cutter T"));
        if let Some(given) = pair.keep.as_ref().filter(|_| keep.is_some_and(|keep| keep > 0.0))
            && cutter
            && names.any(|name| name == "stock" || name.starts_with("stock "))
        {
            let message = "[clearance] pairs: cutter and stock keep no distance at feed".to_owned();
            let help = "rapid = in the place of keep =: what they keep at rapid";
            self.fault("machine-body", given.span(), message, help);
        }
    }

    fn body_pair(&self, [one, other]: &[Spanned<String>; 2], gone: &[String]) -> BodyPair {
        let names = [one, other].map(|name| name.get_ref().clone());
        let taken_away = names.iter().find(|name| gone.contains(name)).cloned();
        let place = self.sources.place(one.span().start..other.span().end);
        BodyPair { names, place, taken_away }
    }
}
