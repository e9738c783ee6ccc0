//! The part frame as it is cut: the box that the tip goes through, the part origin, and where the tools point.

use std::fmt::Write as _;

use nalgebra::Vector3;
use post_posting::ProgramPreview;
use post_report::document::escaped;

/// Width and height of the picture, pixels.
const SIZE: [f64; 2] = [520.0, 320.0];

/// Room at each side for arrows and names, pixels.
const MARGIN: f64 = 55.0;

/// Length of an arrow, pixels.
const ARROW: f64 = 42.0;

/// Directions that are drawn; more would hide one another.
const MOST_ARROWS: usize = 24;

/// Tool axes that differ by less are one arrow, as unit vectors.
const SAME: f64 = 1e-6;

/// Where a place of the part frame stands on paper, seen from the front, the right and above (from X, -Y and Z alike):
/// x to the right, y down.
fn on_paper(place: Vector3<f64>) -> [f64; 2] {
    let (across, down) = (0.866_025_403_784_438_6, 0.5);
    [(place.x + place.y) * across, (place.x - place.y) * down - place.z]
}

/// A box whose corners are drawn, and a scale.
struct Projection {
    scale: f64,
    middle: [f64; 2],
}

impl Projection {
    /// What shows all of these places.
    fn of(places: &[Vector3<f64>]) -> Self {
        let mut ends = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for [x, y] in places.iter().map(|place| on_paper(*place)) {
            ends = [[ends[0][0].min(x), ends[0][1].min(y)], [ends[1][0].max(x), ends[1][1].max(y)]];
        }
        let [least, most] = ends;
        let room = |axis: usize| (SIZE[axis] - 2.0 * MARGIN) / (most[axis] - least[axis]).max(1e-6);
        Self {
            scale: room(0).min(room(1)),
            middle: [0, 1].map(|axis| (least[axis] + most[axis]) / 2.0),
        }
    }

    fn point(&self, place: Vector3<f64>) -> [f64; 2] {
        let paper = on_paper(place);
        [0, 1].map(|axis| SIZE[axis] / 2.0 + (paper[axis] - self.middle[axis]) * self.scale)
    }
}

/// The picture; empty where nothing moves.
pub(super) fn svg(ahead: &ProgramPreview) -> String {
    let Some([least, most]) = ahead.extents else {
        return String::new();
    };
    let corner = |corner: usize| {
        let part = |axis: usize| if corner >> axis & 1 == 0 { least[axis] } else { most[axis] };
        Vector3::new(part(0), part(1), part(2))
    };
    let corners: Vec<Vector3<f64>> = (0..8).map(corner).collect();
    let origin = Vector3::zeros();
    let projection = Projection::of(&[&corners[..], &[origin]].concat());
    let mut text = format!(
        "<svg viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" aria-label=\"The part origin, the box that the tip \
         goes through, and the directions of the tools\" font-family=\"sans-serif\" font-size=\"11\">\n\
         <defs><marker id=\"end\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"7\" markerHeight=\"7\" orient=\"auto\">\
         <path d=\"M0 0 8 4 0 8z\"/></marker></defs>\n",
        SIZE[0], SIZE[1], SIZE[0], SIZE[1]
    );
    for from in 0..8_usize {
        for axis in (0..3).filter(|axis| from >> axis & 1 == 0) {
            let ends = [corners[from], corners[from | 1 << axis]].map(|end| projection.point(end));
            line(&mut text, ends, "stroke=\"#888\" stroke-dasharray=\"4 3\"", "");
        }
    }
    let triad =
        [(Vector3::x(), "X", "#b00"), (Vector3::y(), "Y", "#080"), (Vector3::z(), "Z", "#00b")];
    for (axis, name, colour) in triad {
        let style = format!("stroke=\"{colour}\" stroke-width=\"2\" marker-end=\"url(#end)\"");
        line(&mut text, arrow(&projection, origin, axis), &style, name);
    }
    let middle = (corners[0] + corners[7]) / 2.0;
    let top = Vector3::new(middle.x, middle.y, most[2]);
    for (axis, names) in directions(ahead) {
        // The tool comes from where it points: the arrow ends at the part.
        let [end, from] = arrow(&projection, top, axis);
        line(
            &mut text,
            [from, end],
            "stroke=\"#000\" stroke-width=\"2\" marker-end=\"url(#end)\"",
            "",
        );
        caption(&mut text, from, &names);
    }
    text + "</svg>\n"
}

/// Where an arrow along `axis` begins and ends, as long on paper as the axis is seen.
fn arrow(projection: &Projection, from: Vector3<f64>, axis: Vector3<f64>) -> [[f64; 2]; 2] {
    let begin = projection.point(from);
    let way = on_paper(axis);
    [begin, [begin[0] + way[0] * ARROW, begin[1] + way[1] * ARROW]]
}

/// The directions in which tools stand while they cut, and the tools that do.
fn directions(ahead: &ProgramPreview) -> Vec<(Vector3<f64>, String)> {
    let mut found: Vec<(Vector3<f64>, Vec<u32>)> = Vec::new();
    for work in ahead.work.iter().filter(|work| !work.turns) {
        let Some(tool) = work.tool else {
            continue;
        };
        for axis in &work.axes {
            match found.iter().position(|(known, _)| (known - axis).norm() < SAME) {
                Some(place) if found[place].1.contains(&tool) => {}
                Some(place) => found[place].1.push(tool),
                None if found.len() < MOST_ARROWS => found.push((*axis, vec![tool])),
                None => {}
            }
        }
    }
    let names =
        |tools: Vec<u32>| tools.iter().map(|tool| format!("T{tool}")).collect::<Vec<_>>().join(" ");
    found.into_iter().map(|(axis, tools)| (axis, names(tools))).collect()
}

fn line(text: &mut String, [from, to]: [[f64; 2]; 2], style: &str, name: &str) {
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "<path d=\"M{:.1} {:.1} {:.1} {:.1}\" fill=\"none\" {style}/>",
        from[0], from[1], to[0], to[1]
    );
    caption(text, to, name);
}

/// Writes a name beside a place on paper.
fn caption(text: &mut String, [x, y]: [f64; 2], name: &str) {
    if !name.is_empty() {
        let _ = writeln!(
            text,
            "<text x=\"{:.1}\" y=\"{:.1}\">{}</text>",
            x + 5.0,
            y - 4.0,
            escaped(name)
        );
    }
}
