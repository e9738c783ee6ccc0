//! The reachable directions as a picture: azimuth around, tilt from +Z outwards, in greys that print well.

use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

use post_machine::check::{Check, number};

use post_job::files::svg::{self, label};

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 700.0;
/// Middle of the map, px.
const MIDDLE: [f64; 2] = [320.0, 334.0];
/// Radius of a tilt of 180°, px.
const RADIUS: f64 = 250.0;
/// Fills: none for directions out of reach, then the numbers of solutions that there are, the fewest first.
const GREYS: [&str; 5] = ["#ffffff", "#dedede", "#bcbcbc", "#999999", "#767676"];

/// The picture of a check.
pub fn draw(check: &Check) -> String {
    let mut svg = svg::open(WIDTH, HEIGHT);
    label(
        &mut svg,
        [320.0, 20.0],
        "middle",
        &format!("{}: reachable directions of the tool", check.machine),
    );
    label(
        &mut svg,
        [320.0, 38.0],
        "middle",
        "Tool axis seen from the part: tilt from +Z (outwards) and azimuth (around), degrees",
    );
    cells(&mut svg, check);
    curve(&mut svg, check);
    scale(&mut svg);
    legend(&mut svg, check);
    svg.push_str("</svg>\n");
    svg
}

/// Where a direction is drawn: azimuth counter-clockwise from the right, as +X and +Y lie on paper.
fn place(tilt: f64, azimuth: f64) -> [f64; 2] {
    let (sine, cosine) = libm::sincos(azimuth);
    let radius = RADIUS * tilt / PI;
    [MIDDLE[0] + radius * cosine, MIDDLE[1] - radius * sine]
}

fn cells(svg: &mut String, check: &Check) {
    let rows = &check.reach.map.cells;
    let shades = shades(check);
    let grey = |ways: usize| grey(&shades, ways);
    for (band, row) in rows.iter().enumerate() {
        let [near, far] = [band, band + 1].map(|edge| PI * edge as f64 / rows.len() as f64);
        let width = TAU / row.len() as f64;
        let mut start = 0;
        // Neighbours of one grey are one piece, so that no seams are seen.
        while start < row.len() {
            let run =
                row[start..].iter().take_while(|ways| grey(**ways) == grey(row[start])).count();
            if row[start] > 0 {
                let from = width * start as f64;
                let to = width * (start + run) as f64;
                sector(svg, [near, far], [from, to], GREYS[grey(row[start])]);
            }
            start += run;
        }
    }
}

/// The numbers of solutions that there are, the fewest first.
fn shades(check: &Check) -> Vec<usize> {
    let shares = check.reach.shares_by_solutions.iter().enumerate();
    shares.filter(|(ways, share)| *ways > 0 && **share > 0.0).map(|(ways, _)| ways).collect()
}

/// Which of the greys a number of solutions has.
fn grey(shades: &[usize], ways: usize) -> usize {
    let place = shades.iter().position(|shade| *shade == ways);
    place.map_or(0, |place| (place + 1).min(GREYS.len() - 1))
}

/// A piece of a ring between two tilts and two azimuths. Arcs are drawn in thirds at most, since the ends of a whole
/// circle are one point.
fn sector(svg: &mut String, [near, far]: [f64; 2], [from, to]: [f64; 2], fill: &str) {
    let parts = (((to - from) / (TAU / 3.0)).ceil() as usize).max(1);
    let at = |part: usize| from + (to - from) * part as f64 / parts as f64;
    let mut path = String::new();
    let [x, y] = place(far, from);
    let _ = write!(path, "M{x:.2} {y:.2}");
    let arc = |path: &mut String, tilt: f64, azimuth: f64, sweep: u8| {
        let [x, y] = place(tilt, azimuth);
        let radius = RADIUS * tilt / PI;
        let _ = write!(path, "A{radius:.2} {radius:.2} 0 0 {sweep} {x:.2} {y:.2}");
    };
    for part in 1..=parts {
        arc(&mut path, far, at(part), 0);
    }
    let [x, y] = place(near, to);
    let _ = write!(path, "L{x:.2} {y:.2}");
    if near > 0.0 {
        for part in (0..parts).rev() {
            arc(&mut path, near, at(part), 1);
        }
    }
    let _ = writeln!(
        svg,
        "<path d=\"{path}Z\" fill=\"{fill}\" stroke=\"{fill}\" stroke-width=\"0.8\"/>"
    );
}

/// Machines with fewer than two turning axes: the directions that they have, as a line of dots.
fn curve(svg: &mut String, check: &Check) {
    for [tilt, azimuth] in &check.reach.map.curve {
        let [x, y] = place(*tilt, *azimuth);
        let _ =
            writeln!(svg, "<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"3\" fill=\"{}\"/>", GREYS[4]);
    }
}

fn scale(svg: &mut String) {
    for tilt in [30, 60, 90, 120, 150, 180] {
        let radius = RADIUS * f64::from(tilt) / 180.0;
        let (width, dash) = match tilt {
            90 => (1.2, ""),
            180 => (1.0, ""),
            _ => (0.6, " stroke-dasharray=\"3 3\""),
        };
        let _ = writeln!(
            svg,
            "<circle cx=\"{}\" cy=\"{}\" r=\"{radius:.2}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"{width}\"{dash}/>",
            MIDDLE[0], MIDDLE[1]
        );
        // Beside the line at azimuth 75°, on white so that it can be read on any grey.
        let [x, y] = place(f64::from(tilt).to_radians(), 75f64.to_radians());
        let _ = writeln!(
            svg,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"34\" height=\"15\" fill=\"#ffffff\" fill-opacity=\"0.85\"/>",
            x - 17.0,
            y - 8.0
        );
        label(svg, [x, y + 4.0], "middle", &format!("{tilt}°"));
    }
    for azimuth in (0..360).step_by(30) {
        let around = f64::from(azimuth).to_radians();
        let [[x1, y1], [x2, y2]] = [place(0.0, around), place(PI, around)];
        let _ = writeln!(
            svg,
            "<line x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\" stroke=\"#000000\" stroke-width=\"0.4\" stroke-opacity=\"0.6\"/>"
        );
        let [x, y] = place(PI * 1.085, around);
        let name = match azimuth {
            0 => "0° +X".to_owned(),
            90 => "90° +Y".to_owned(),
            180 => "180° -X".to_owned(),
            270 => "270° -Y".to_owned(),
            other => format!("{other}°"),
        };
        let anchor = match azimuth {
            90 | 270 => "middle",
            0..90 | 271..360 => "start",
            _ => "end",
        };
        let x = match anchor {
            "start" => x - 8.0,
            "end" => x + 8.0,
            _ => x,
        };
        label(svg, [x, y + 4.0], anchor, &name);
    }
}

fn legend(svg: &mut String, check: &Check) {
    let top = HEIGHT - 78.0;
    if !check.reach.map.curve.is_empty() {
        let _ = writeln!(
            svg,
            "<circle cx=\"40\" cy=\"{:.2}\" r=\"3\" fill=\"{}\"/>",
            top + 9.0,
            GREYS[4]
        );
        label(svg, [52.0, top + 14.0], "start", "directions inside the travel of the rotary axes");
        return;
    }
    label(svg, [30.0, top + 14.0], "start", "Solutions inside travel:");
    let shades = shades(check);
    for (place, fill) in GREYS.iter().enumerate().take(shades.len() + 1) {
        let left = 205.0 + 85.0 * place as f64;
        let _ = writeln!(
            svg,
            "<rect x=\"{left:.2}\" y=\"{top:.2}\" width=\"20\" height=\"18\" fill=\"{fill}\" stroke=\"#000000\" stroke-width=\"0.8\"/>"
        );
        let name = match place.checked_sub(1) {
            None => "none".to_owned(),
            Some(place) if place + 2 == GREYS.len() && shades.len() > place + 1 => {
                format!("{} and more", shades[place])
            }
            Some(place) => shades[place].to_string(),
        };
        label(svg, [left + 26.0, top + 14.0], "start", &name);
    }
    let tilt = |tilt: Option<f64>| {
        tilt.map_or("not even +Z".to_owned(), |tilt| format!("{}°", number(tilt, 1)))
    };
    label(
        svg,
        [30.0, top + 42.0],
        "start",
        &format!(
            "{} % of all directions; tilt in all azimuths: {}; largest in some: {}",
            number(100.0 * check.reach.share_of_sphere, 1),
            tilt(check.reach.tilt_in_all_azimuths_deg),
            tilt(check.reach.tilt_in_some_azimuth_deg),
        ),
    );
}
