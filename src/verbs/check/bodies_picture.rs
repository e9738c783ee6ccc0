//! All bodies of a machine with their names, from the front, from the side and from above.

use std::fmt::Write as _;

use post_job::files::svg::{self, label};
use post_job::report::solids::{self, BodyEdges};
use post_machine::description::Machine;

/// Width and height of a view, px, and the room about it.
const VIEW: [f64; 2] = [380.0, 420.0];
const ROOM: f64 = 26.0;

/// Height of the heading, px.
const HEAD: f64 = 56.0;

/// Height of a line of the legend, px.
const LINE: f64 = 18.0;

/// Colours that differ in print too; of more bodies than these they come again.
const COLOURS: [&str; 8] =
    ["#1f4e9c", "#b3420f", "#2f7d3b", "#7a2f8f", "#8a6d00", "#0f7f86", "#a01850", "#4d4d4d"];

/// What a view shows: its name, the axis to the right, the axis upwards.
const VIEWS: [(&str, usize, usize); 3] =
    [("from the front (X, Z)", 0, 2), ("from the side (Y, Z)", 1, 2), ("from above (X, Y)", 0, 1)];

/// The picture of the bodies of a machine.
pub fn draw(machine: &Machine) -> String {
    let bodies = solids::edges(machine);
    let height = HEAD + VIEW[1] + LINE * (bodies.len() as f64 + 2.0);
    let mut svg = svg::open(VIEW[0] * 3.0, height);
    let middle = VIEW[0] * 1.5;
    let title = format!("{}: bodies, every axis at zero, machine frame", machine.name);
    label(&mut svg, [middle, 22.0], "middle", &title);
    if bodies.is_empty() {
        let none = "no body has a shape: [solids], [fixture.NAME], [stock] and [tools.N] have them";
        label(&mut svg, [middle, HEAD + 40.0], "middle", none);
    }
    let (least, most) = extents(&bodies);
    for (place, (name, across, up)) in VIEWS.into_iter().enumerate() {
        let left = VIEW[0] * place as f64;
        label(&mut svg, [left + VIEW[0] / 2.0, 44.0], "middle", name);
        let room = |at: usize| most[at] - least[at];
        let scale = [across, up].map(room).map(|size: f64| size.max(1e-3));
        let scale = ((VIEW[0] - 2.0 * ROOM) / scale[0]).min((VIEW[1] - 2.0 * ROOM) / scale[1]);
        let centre = |at: usize| 0.5 * (least[at] + most[at]);
        let seen = |point: &[f64; 3]| {
            [
                left + VIEW[0] / 2.0 + (point[across] - centre(across)) * scale,
                HEAD + VIEW[1] / 2.0 - (point[up] - centre(up)) * scale,
            ]
        };
        view(&mut svg, &bodies, &seen);
    }
    for (place, body) in bodies.iter().enumerate() {
        let y = HEAD + VIEW[1] + LINE * (place as f64 + 1.0);
        svg::line(&mut svg, [ROOM, y - 4.0], [ROOM + 24.0, y - 4.0], colour(place), 3.0);
        let (low, high) = extents(std::slice::from_ref(body));
        let ends = [0, 1, 2]
            .map(|at| format!("{} {:.1} to {:.1}", ["X", "Y", "Z"][at], low[at], high[at]));
        label(
            &mut svg,
            [ROOM + 34.0, y],
            "start",
            &format!("{}: {} mm", body.name, ends.join(", ")),
        );
    }
    svg.push_str("</svg>\n");
    svg
}

fn colour(place: usize) -> &'static str {
    COLOURS[place % COLOURS.len()]
}

/// Bodies as lines, each with its name beside its middle; names that would lie over one another stand below.
fn view(svg: &mut String, bodies: &[BodyEdges], seen: &dyn Fn(&[f64; 3]) -> [f64; 2]) {
    let mut names: Vec<[f64; 2]> = Vec::new();
    for (place, body) in bodies.iter().enumerate() {
        let mut path = String::new();
        for [from, to] in &body.edges {
            let [[x, y], [u, v]] = [from, to].map(seen);
            // Writing to a String cannot fail.
            let _ = write!(path, "M{x:.1} {y:.1}L{u:.1} {v:.1}");
        }
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"0.8\"/>",
            colour(place)
        );
        let (low, high) = extents(std::slice::from_ref(body));
        let middle: [f64; 3] = std::array::from_fn(|at| 0.5 * (low[at] + high[at]));
        let mut at = seen(&middle);
        let near = |one: &[f64; 2], other: &[f64; 2]| {
            (one[0] - other[0]).abs() < 60.0 && (one[1] - other[1]).abs() < 14.0
        };
        while names.iter().any(|name| near(name, &at)) {
            at[1] += 14.0;
        }
        names.push(at);
        label(svg, at, "middle", &body.name);
    }
}

/// Least and largest corner of the box around bodies, mm.
fn extents(bodies: &[BodyEdges]) -> ([f64; 3], [f64; 3]) {
    let mut ends = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in bodies.iter().flat_map(|body| body.edges.iter().flatten()) {
        for (at, value) in point.iter().enumerate() {
            ends.0[at] = ends.0[at].min(*value);
            ends.1[at] = ends.1[at].max(*value);
        }
    }
    ends
}
