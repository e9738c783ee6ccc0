//! The path of the tip in the plane in which it is largest: with magnified contour errors, and drawn by their size.

use std::fmt::Write as _;

use super::file_name;
use super::trail::Spot;
use crate::files::svg::{self, label};
use crate::files::{PlanView, round_step};
use crate::predict::Prediction;
use crate::text::number;

const WIDTH: f64 = 760.0;
const LEFT: f64 = 72.0;
const TOP: f64 = 84.0;
/// Of the path, px.
const SIZE: [f64; 2] = [660.0, 520.0];
/// Of what stands below it, px.
const FOOT: f64 = 116.0;
/// Of the numbers of the ticks and what they count, px.
const TICKS: f64 = 64.0;
/// About the path where nothing stands beside it, px.
const ROOM: f64 = 16.0;
/// The largest error is drawn about so long, px.
const LONGEST: f64 = 60.0;
/// Steps of the error that are told apart.
const LEVELS: usize = 6;

/// How each step is drawn, the smallest first: a grey and a width.
const STEPS: [(&str, f64); LEVELS] = [
    ("#c4c4c4", 1.2),
    ("#a8a8a8", 2.0),
    ("#888888", 3.0),
    ("#666666", 4.2),
    ("#404040", 5.6),
    ("#000000", 7.2),
];

/// The error vectors, magnified and drawn outward from the path (Zhang, Chen 2025, fig. 12).
pub fn vectors(found: &Prediction, note: &str, cuts: &[Vec<Spot>]) -> String {
    let mut picture =
        Picture::new("Contour error, magnified, drawn from the path", note, cuts, ROOM + LONGEST);
    let seen = cuts.iter().flatten().map(|spot| picture.view.seen(&spot.error));
    let largest = seen.fold(1e-9, f64::max);
    // Rounded down, so that nothing is drawn longer than meant.
    let wanted = LONGEST / (picture.view.scale() * largest);
    let times = match round_step(wanted) {
        over if over > wanted => round_step(over / 2.6),
        exact => exact,
    };
    let far = |spot: &Spot| {
        let tip = spot.tip.iter().zip(spot.error);
        let mut tip = tip.map(|(tip, error)| tip + times * error);
        std::array::from_fn(|_| tip.next().unwrap_or_default())
    };
    let mut whiskers = String::new();
    for spot in cuts.iter().flatten() {
        let [from, to] = [spot.tip, far(spot)].map(|point| picture.view.place(&point));
        let _ = write!(whiskers, "M{:.1} {:.1}L{:.1} {:.1}", from[0], from[1], to[0], to[1]);
    }
    picture.view.open_clip(&mut picture.svg);
    let _ =
        writeln!(picture.svg, "<path d=\"{whiskers}\" stroke=\"#b8b8b8\" stroke-width=\"0.6\"/>");
    for cut in cuts {
        let path: Vec<[f64; 2]> = cut.iter().map(|spot| picture.view.place(&spot.tip)).collect();
        picture.line(&path, "#777777", 1.0);
        let path: Vec<[f64; 2]> = cut.iter().map(|spot| picture.view.place(&far(spot))).collect();
        picture.line(&path, "#000000", 1.3);
    }
    picture.view.close_clip(&mut picture.svg);
    picture.ring(found, cuts);
    let bar = round_step(0.4 * largest);
    let long = bar * times * picture.view.scale();
    let foot = TOP + SIZE[1] + TICKS;
    picture.line(&[[LEFT, foot], [LEFT + 38.0, foot]], "#777777", 1.0);
    picture.text([LEFT + 46.0, foot + 4.5], &path_of(found));
    picture.line(&[[LEFT + 190.0, foot], [LEFT + 228.0, foot]], "#000000", 1.3);
    let text = format!("error × {}, as it is seen in this plane", number(times, 0));
    picture.text([LEFT + 236.0, foot + 4.5], &text);
    let below = foot + 26.0;
    picture.line(&[[LEFT, below], [LEFT + long, below]], "#000000", 2.0);
    for end in [LEFT, LEFT + long] {
        picture.line(&[[end, below - 5.0], [end, below + 5.0]], "#000000", 1.2);
    }
    let text = format!("{} µm of error", micrometres(bar));
    picture.text([LEFT + long + 10.0, below + 4.5], &text);
    picture.end()
}

/// The path, darker and wider where the error is larger.
pub fn path(found: &Prediction, note: &str, cuts: &[Vec<Spot>]) -> String {
    let mut picture = Picture::new("Contour error on the path", note, cuts, ROOM);
    let largest = found.contour.tip_mm.largest.max(1e-9);
    // A few places that are far off would leave all others in the first step.
    let step = round_step(found.contour.tip_mm.p99.max(1e-9) / (LEVELS - 1) as f64);
    let level = |size: f64| ((size / step) as usize).min(LEVELS - 1);
    // Of each step its pieces of the path.
    let mut pieces: [Vec<Vec<[f64; 2]>>; LEVELS] = Default::default();
    for cut in cuts {
        let mut open = None;
        for pair in cut.windows(2) {
            let places = [&pair[0], &pair[1]].map(|spot| picture.view.place(&spot.tip));
            let level = level(pair[0].size.max(pair[1].size));
            match (pieces[level].last_mut(), open == Some(level)) {
                (Some(piece), true) => piece.push(places[1]),
                _ => pieces[level].push(places.to_vec()),
            }
            open = Some(level);
        }
    }
    picture.view.open_clip(&mut picture.svg);
    for (pieces, (grey, width)) in pieces.iter().zip(STEPS) {
        for piece in pieces {
            picture.line(piece, grey, width);
        }
    }
    picture.view.close_clip(&mut picture.svg);
    picture.ring(found, cuts);
    let used = level(largest) + 1;
    for (place, (grey, width)) in STEPS.iter().enumerate().take(used) {
        let left = LEFT + 238.0 * (place % 3) as f64;
        let foot = TOP + SIZE[1] + TICKS + 26.0 * (place / 3) as f64;
        picture.line(&[[left, foot], [left + 38.0, foot]], grey, *width);
        let [from, to] = [place, place + 1].map(|place| micrometres(place as f64 * step));
        let text = match place + 1 < LEVELS {
            true => format!("{from} to {to} µm"),
            false => format!("{from} µm and more"),
        };
        picture.text([left + 46.0, foot + 4.5], &text);
    }
    picture.end()
}

/// Which path the error is held against.
fn path_of(found: &Prediction) -> String {
    match &found.against {
        Some(file) => format!("path of {}", file_name(file)),
        None => "commanded path".to_owned(),
    }
}

/// A length in micrometres, with as many decimals as it needs.
fn micrometres(mm: f64) -> String {
    let value = mm * 1e3;
    let text = number(value, 6);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}

/// A picture of the path in the making.
struct Picture {
    svg: String,
    view: PlanView,
}

impl Picture {
    fn new(title: &str, note: &str, cuts: &[Vec<Spot>], room: f64) -> Self {
        let mut svg = svg::open(WIDTH, TOP + SIZE[1] + FOOT);
        label(&mut svg, [WIDTH / 2.0, 24.0], "middle", title);
        label(&mut svg, [WIDTH / 2.0, 44.0], "middle", note);
        let tips = cuts.iter().flatten().map(|spot| &spot.tip);
        let view = PlanView::of(tips, [LEFT, TOP], SIZE, room);
        view.frame(&mut svg);
        Self { svg, view }
    }

    fn line(&mut self, points: &[[f64; 2]], grey: &str, width: f64) {
        let mut text = String::new();
        for [x, y] in points {
            let _ = write!(text, "{x:.1},{y:.1} ");
        }
        let _ = writeln!(
            self.svg,
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{grey}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"/>",
            text.trim_end()
        );
    }

    fn text(&mut self, at: [f64; 2], text: &str) {
        label(&mut self.svg, at, "start", text);
    }

    /// A ring about the largest error, and above the frame what it is.
    fn ring(&mut self, found: &Prediction, cuts: &[Vec<Spot>]) {
        let spots = cuts.iter().flatten();
        let Some(worst) = spots.max_by(|a, b| a.size.total_cmp(&b.size)) else {
            return;
        };
        let [x, y] = self.view.place(&worst.tip);
        let _ = writeln!(
            self.svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1.4\"/>"
        );
        let text = format!(
            "ring: the largest, {} µm, line {}",
            number(found.contour.tip_mm.largest * 1e3, 2),
            found.contour.tip_mm.nc_line
        );
        let corner = [LEFT + SIZE[0], TOP - 9.0];
        label(&mut self.svg, corner, "end", &text);
    }

    fn end(mut self) -> String {
        self.svg.push_str("</svg>\n");
        self.svg
    }
}
