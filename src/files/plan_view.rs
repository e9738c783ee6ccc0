//! A path as it is seen along one of the axes.

use super::svg::label;

/// The plane of two axes in which a path is largest, laid into a rectangle.
pub struct PlanView {
    plane: [usize; 2],
    ends: [[f64; 2]; 3],
    scale: f64,
    /// What stands in the middle of the rectangle.
    middle: [f64; 2],
    /// The middle of the rectangle, px.
    centre: [f64; 2],
}

impl PlanView {
    /// Of the points, in the rectangle from `corner`, px: X to the right and Y up, unless the path is flat there.
    pub fn of<'a>(
        points: impl Iterator<Item = &'a [f64; 3]>,
        corner: [f64; 2],
        size: [f64; 2],
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
        let plane = planes.into_iter().fold([0, 1], |best, plane| {
            if area(plane) > 1.5 * area(best) {
                plane
            } else {
                best
            }
        });
        let [across, up] = plane;
        Self {
            plane,
            ends,
            scale: 0.94 * (size[0] / long(across)).min(size[1] / long(up)),
            middle: plane.map(|axis| 0.5 * (ends[axis][0] + ends[axis][1])),
            centre: [corner[0] + size[0] / 2.0, corner[1] + size[1] / 2.0],
        }
    }

    /// Where a point is drawn, px.
    pub fn place(&self, point: &[f64; 3]) -> [f64; 2] {
        let [across, up] = self.plane;
        [
            self.centre[0] + self.scale * (point[across] - self.middle[0]),
            self.centre[1] - self.scale * (point[up] - self.middle[1]),
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

    /// Says above the rectangle what is seen.
    pub fn title(&self, svg: &mut String, at: [f64; 2]) {
        let names = ["X", "Y", "Z"];
        let [across, up] = self.plane;
        let text = format!(
            "{} to the right from {:.1} to {:.1} mm, {} up from {:.1} to {:.1} mm",
            names[across],
            self.ends[across][0],
            self.ends[across][1],
            names[up],
            self.ends[up][0],
            self.ends[up][1]
        );
        label(svg, at, "middle", &text);
    }
}
