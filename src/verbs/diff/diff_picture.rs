//! Both paths, and along them how far they are apart and how fast they are gone.

use std::fmt::Write as _;

use post_readback::diff::{Difference, OperationDifference};

use post_job::diff::{Bin, PathComparison};
use post_job::files::PlanView;
use post_job::files::chart::{Chart, DASHED, GREY, LOOKS, Series};
use post_job::files::svg::{self, label};

const WIDTH: f64 = 760.0;
const TOP: f64 = 64.0;
/// Of the paths, px.
const SIZE: [f64; 2] = [660.0, 460.0];
const LEFT: f64 = 72.0;
/// Left free about the path, px.
const ROOM: f64 = 14.0;
/// Radius of a ring, px.
const RING: f64 = 8.0;

/// The picture.
pub fn draw(names: [&str; 2], found: &Difference, along: &PathComparison) -> String {
    let charts = charts(along);
    let charts: Vec<(f64, String)> =
        charts.iter().map(|chart| (chart.height(), chart.svg())).collect();
    let below: f64 = charts.iter().map(|(height, _)| height).sum();
    let start = TOP + SIZE[1] + 60.0;
    let mut picture = svg::open(WIDTH, start + below);
    let [old, new] = names;
    let titles = [
        format!("{old} and {new}"),
        match found.same {
            true => "they make the machine do the same".to_owned(),
            false => "wide grey: the old path; thin black: the new one; dashed: rapids; rings: where an operation differs most".to_owned(),
        },
    ];
    for (line, title) in titles.iter().enumerate() {
        let up = 24.0 + 20.0 * line as f64;
        label(&mut picture, [WIDTH / 2.0, up], "middle", title);
    }
    paths(&mut picture, found, along);
    let mut up = start;
    for (height, chart) in charts {
        let _ = writeln!(picture, "<g transform=\"translate(0 {up:.2})\">\n{chart}</g>");
        up += height;
    }
    picture.push_str("</svg>\n");
    picture
}

/// Both paths in the plane of two axes in which they are largest.
fn paths(picture: &mut String, found: &Difference, along: &PathComparison) {
    let pieces = along.paths.iter().flat_map(|path| &path.pieces);
    let points = pieces.filter(|(cut, _)| *cut).flat_map(|(_, points)| points);
    let view = PlanView::of(points, [LEFT, TOP], SIZE, ROOM);
    let place = |point: &[f64; 3]| view.place(point);
    view.open_clip(picture);
    let looks = [("#bdbdbd", 4.0, 1.6), ("#000000", 0.9, 0.5)];
    for (path, (grey, cut_width, rapid_width)) in along.paths.iter().zip(looks) {
        for (cut, points) in &path.pieces {
            let mut text = String::new();
            for [x, y] in points.iter().map(place) {
                let _ = write!(text, "{x:.1},{y:.1} ");
            }
            let (width, dash) = match cut {
                true => (cut_width, ""),
                false => (rapid_width, " stroke-dasharray=\"5 4\""),
            };
            let _ = writeln!(
                picture,
                "<polyline points=\"{}\" stroke=\"{grey}\" stroke-width=\"{width}\"{dash}/>",
                text.trim_end()
            );
        }
    }
    view.close_clip(picture);
    // Names of rings that lie on one another stand side by side.
    let mut rings: Vec<(String, [f64; 2])> = Vec::new();
    let operations = found.operations.iter();
    for (name, at) in operations.filter(|operation| !operation.same).flat_map(marks) {
        let at = place(&at);
        let close = |ring: &&mut (String, [f64; 2])| {
            libm::hypot(ring.1[0] - at[0], ring.1[1] - at[1]) < RING
        };
        match rings.iter_mut().find(close) {
            Some((names, _)) => *names = format!("{names}, {name}"),
            None => rings.push((name, at)),
        }
    }
    for (names, [x, y]) in rings {
        let _ = writeln!(
            picture,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{RING}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1.4\"/>"
        );
        label(picture, [x + 11.0, y - 6.0], "start", &names);
    }
    view.frame(picture);
}

/// Where an operation differs most, and in what.
fn marks(operation: &OperationDifference) -> Vec<(String, [f64; 3])> {
    let worst = [
        (&operation.tip, operation.tip.on_mm > 0.0, "position"),
        (&operation.axis, operation.axis.on_mm > 0.0, "tool axis"),
        (&operation.feed.worst, operation.feed.worst.on_mm > 0.0, "feed"),
    ];
    let worst = worst.into_iter().filter(|(_, differs, _)| *differs);
    let worst = worst.map(|(worst, _, what)| (what.to_owned(), worst.at));
    let alone = [(&operation.left_out, "left out"), (&operation.added, "added")];
    let longest = alone.into_iter().filter_map(|(stretches, what)| {
        let longest = stretches.iter().max_by(|a, b| a.mm.total_cmp(&b.mm))?;
        Some((what.to_owned(), longest.at))
    });
    worst.chain(longest).collect()
}

/// What is drawn along the way.
fn charts(along: &PathComparison) -> Vec<Chart> {
    let line = |value: &dyn Fn(&Bin) -> f64| -> Vec<[f64; 2]> {
        let bins = along.bins.iter().enumerate();
        bins.map(|(place, bin)| [(place as f64 + 0.5) * along.width, value(bin)]).collect()
    };
    let chart = |title: &str, y: &str, series: Vec<Series>| Chart {
        title: title.to_owned(),
        note: "the largest on each share of the way".to_owned(),
        x: "way along the old program, mm".to_owned(),
        y: y.to_owned(),
        logarithmic: false,
        series,
    };
    let mut charts = vec![chart(
        "How far the tips are apart",
        "mm",
        vec![Series::line("", line(&|bin| bin.tip), LOOKS[0])],
    )];
    if along.bins.iter().any(|bin| bin.axis > 1e-6) {
        charts.push(chart(
            "Angle between the tool axes",
            "degrees",
            vec![Series::line("", line(&|bin| bin.axis), LOOKS[0])],
        ));
    }
    charts.push(chart(
        "Feeds",
        "mm/min",
        vec![
            Series::line("old", line(&|bin| bin.feeds[0]), GREY),
            Series::line("new", line(&|bin| bin.feeds[1]), DASHED),
        ],
    ));
    charts
}
