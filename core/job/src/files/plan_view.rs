//! A path as it is seen along one of the axes, in a frame with ticks.

use std::fmt::Write as _;

use super::scale::Scale;
use super::svg::{label, line, upright};

/// Names of the axes of the part.
const NAMES: [&str; 3] = ["X", "Y", "Z"];

/// From tick to tick, about, px.
const TICK: f64 = 70.0;

/// The plane of two axes in which a path is largest, laid into a rectangle. Left of it there are to be 62 px for ticks and
/// what they count, below it 44 px.
pub struct PlanView {
    plane: [usize; 2],
    scale: f64,
    /// What stands in the middle of the rectangle.
    middle: [f64; 2],
    /// The upper left corner of the rectangle, and its size, px.
    corner: [f64; 2],
    size: [f64; 2],
}

impl PlanView {
    /// Of the points, in the rectangle from `corner`, px, with `room` on all sides: X to the right and Y up, unless the path
    /// is flat there.
    pub fn of<'a>(
        points: impl Iterator<Item = &'a [f64; 3]>,
        corner: [f64; 2],
        size: [f64; 2],
        room: f64,
    ) -> Self {
        let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
        for point in points {
            for (end, value) in ends.iter_mut().zip(point) {
                *end = [end[0].min(*value), end[1].max(*value)];
            }
        }
        if ends[0][0] > ends[0][1] {
            ends = [[0.0, 1.0]; 3];
        }
        let long = |axis: usize| (ends[axis][1] - ends[axis][0]).max(1e-3);
        let planes = [[0, 1], [0, 2], [1, 2]];
        let area = |[across, up]: [usize; 2]| long(across) * long(up);
        let plane = planes
            .into_iter()
            .fold([0, 1], |best, plane| if area(plane) > 1.5 * area(best) { plane } else { best });
        let [across, up] = plane;
        let inner = size.map(|size| size - 2.0 * room);
        Self {
            plane,
            scale: (inner[0] / long(across)).min(inner[1] / long(up)),
            middle: plane.map(|axis| 0.5 * (ends[axis][0] + ends[axis][1])),
            corner,
            size,
        }
    }

    /// Where a point is drawn, px.
    pub fn place(&self, point: &[f64; 3]) -> [f64; 2] {
        let [across, up] = self.plane;
        let [x, y] = self.centre();
        [
            x + self.scale * (point[across] - self.middle[0]),
            y - self.scale * (point[up] - self.middle[1]),
        ]
    }

    /// How long a vector is as it is seen, mm.
    pub fn seen(&self, vector: &[f64; 3]) -> f64 {
        let [across, up] = self.plane;
        libm::hypot(vector[across], vector[up])
    }

    /// Pixels of a millimetre.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// What follows is seen inside the rectangle alone.
    pub fn open_clip(&self, svg: &mut String) {
        let ([x, y], [width, height]) = (self.corner, self.size);
        let _ = writeln!(
            svg,
            "<clipPath id=\"frame\"><rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/></clipPath>\n<g clip-path=\"url(#frame)\" fill=\"none\">"
        );
    }

    /// What follows is seen everywhere.
    pub fn close_clip(&self, svg: &mut String) {
        svg.push_str("</g>\n");
    }

    /// The rectangle, its ticks and the names of its axes.
    pub fn frame(&self, svg: &mut String) {
        let ([left, top], [width, height]) = (self.corner, self.size);
        let [x, y] = self.centre();
        let bottom = top + height;
        let scales = [0, 1].map(|axis| {
            let half = 0.5 * self.size[axis] / self.scale;
            let ends = [self.middle[axis] - half, self.middle[axis] + half];
            Scale::over(ends, self.size[axis] / TICK)
        });
        for (value, text) in scales[0].ticks() {
            let at = left + width * scales[0].share(value);
            line(svg, [at, bottom], [at, bottom + 5.0], "#000000", 1.0);
            label(svg, [at, bottom + 19.0], "middle", &text);
        }
        for (value, text) in scales[1].ticks() {
            let at = bottom - height * scales[1].share(value);
            line(svg, [left - 5.0, at], [left, at], "#000000", 1.0);
            label(svg, [left - 9.0, at + 4.5], "end", &text);
        }
        let _ = writeln!(
            svg,
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"none\" stroke=\"#000000\" stroke-width=\"1\"/>"
        );
        let [across, up] = self.plane.map(|axis| format!("{}, mm", NAMES[axis]));
        label(svg, [x, bottom + 38.0], "middle", &across);
        upright(svg, [18.0, y], &up);
    }

    /// The middle of the rectangle, px.
    fn centre(&self) -> [f64; 2] {
        [self.corner[0] + self.size[0] / 2.0, self.corner[1] + self.size[1] / 2.0]
    }
}
