use post_machine::kinematics::Pose;
use post_testkit::{Rng, at_least, randomised};

use super::super::spline::FivePoints;
use super::tied::TIE;
use super::*;

/// A path that wanders: it turns gently and at once, slows down, stands, goes back the way it came, and crosses itself.
fn wandering(rng: &mut Rng, count: usize) -> Vec<Vector3<f64>> {
    let mut tip = rng.point(1.0);
    let mut way = rng.direction() * 0.05;
    let mut turn = Vector3::zeros();
    let mut points = Vec::new();
    while points.len() < count {
        match rng.pick(40) {
            0 => way = rng.direction() * rng.range(0.001, 0.1),
            1 => way = -way,
            2 => {
                for _ in 0..rng.pick(12) {
                    points.push(tip);
                }
            }
            3 => turn = rng.direction() * rng.range(0.0, 0.4),
            4 => turn = Vector3::zeros(),
            _ => {}
        }
        way += turn.cross(&way);
        way *= rng.range(0.97, 1.03);
        way *= (0.1 / way.norm()).min(1.0);
        tip += way;
        points.push(tip);
    }
    points.truncate(count);
    points
}

fn path(points: &[Vector3<f64>]) -> CommandedPath {
    let last = points[points.len() - 1];
    let mut path = CommandedPath::default();
    let mut tips = FivePoints::all_at(&points[0]);
    tips.take(&points[0]);
    tips.take(&points[1]);
    for (number, tip) in points.iter().enumerate() {
        let tip_ways = tips.take(points.get(number + 2).unwrap_or(&last));
        path.push(Knot {
            number: number as u64,
            at: ProgramPlace::default(),
            tip: *tip,
            axis: Vector3::z(),
            tip_ways,
            axis_ways: [Vector3::zeros(); 2],
            length: 0.0,
            gap: false,
        });
    }
    path
}

/// The places of a path, finely: length along it, as the search counts it, and point.
fn fine(path: &CommandedPath, parts: usize) -> Vec<(f64, Vector3<f64>)> {
    let mut places = Vec::new();
    for knot in 0..path.knots.len() - 1 {
        let cubic = path.cubic(knot).unwrap();
        let length = path.knots[knot].length;
        let way = path.knots[knot + 1].length - length;
        for part in 0..parts {
            let share = part as f64 / parts as f64;
            places.push((length + way * share, cubic.at(share)));
        }
    }
    places
}

/// Brute force: no place is nearer within eight times the distance along the path, and none at all than where the tool is
/// commanded.
#[test]
fn nothing_is_nearer_close_by() {
    let (turns, mut rng) = randomised(30u64, 5);
    let (mut asked, mut moved) = (0, 0);
    for _ in turns {
        let points = wandering(&mut rng, 400);
        let mut path = path(&points);
        let places = fine(&path, 60);
        let lag = rng.range(0.0, 12.0);
        let size = rng.order(-3.0, -0.8);
        let mut off = rng.point(size);
        for number in 20..points.len() {
            off += rng.point(size * 0.2);
            off *= (size / off.norm()).min(1.0);
            let late = (number as f64 - lag).max(0.0) as usize;
            let actual = Pose { tip: points[late] + off, axis: Vector3::z(), ..Pose::default() };
            let found =
                path.nearest(&actual, CommandedTip { number: number as u64, tip: points[number] });
            asked += 1;
            assert!((path.point(path.foot) - actual.tip).norm() <= found.distance + TIE);
            // Where it stands along the path: the finest place next to it.
            let before: usize = path.foot.knot * 60 + (path.foot.share * 60.0) as usize;
            let here = places[before.min(places.len() - 1)].0;
            let reach = 8.0 * found.distance;
            let nearest = places
                .iter()
                .filter(|(length, _)| (length - here).abs() < reach)
                .map(|(_, point)| (point - actual.tip).norm())
                .fold(f64::INFINITY, f64::min);
            moved += u32::from(found.missed > 0.0);
            assert!(
                found.distance <= nearest + 1e-9,
                "set-point {number}: {} found, {nearest} is there",
                found.distance
            );
            assert!(found.distance <= (points[number] - actual.tip).norm() + 1e-12);
        }
    }
    assert!(asked > at_least(10_000) && moved > at_least(20), "{asked} asked, {moved} corners");
}

/// A spline goes no further along a chord than its ends, and no further off than a path of such bends does.
#[test]
fn the_spline_overshoots_nothing() {
    let (turns, mut rng) = randomised(60u64, 6);
    for _ in turns {
        let points = wandering(&mut rng, 200);
        let path = path(&points);
        for knot in 0..path.knots.len() - 1 {
            let chord = path.knots[knot + 1].tip - path.knots[knot].tip;
            let cubic = path.cubic(knot).unwrap();
            let mut last = 0.0;
            for part in 0..=50 {
                let offset = cubic.at(f64::from(part) / 50.0) - path.knots[knot].tip;
                let along = offset.dot(&chord) / chord.norm_squared();
                assert!(along > last - 1e-9 && along < 1.0 + 1e-9, "{along}");
                last = along;
            }
        }
    }
}

/// Chips are broken, and a tool that lags by more than the way back never turns where it should: it is on its line all the
/// time, and so has no contour error.
#[test]
fn a_tool_that_goes_on_beyond_a_turn_is_on_a_way_ahead() {
    for late in [20.0, 60.0, 200.0] {
        let mut depth: f64 = 0.0;
        let mut points = vec![Vector3::zeros(); 5];
        for _ in 0..12 {
            for (steps, way) in [(50, -0.01), (20, 0.01)] {
                for _ in 0..steps {
                    depth += way;
                    points.push(Vector3::new(0.0, 0.0, depth));
                }
            }
        }
        let mut path = path(&points);
        let mut tool = Pose { axis: Vector3::z(), ..Pose::default() };
        let mut went = 0.0;
        for (number, point) in points.iter().enumerate() {
            let last = tool.tip;
            tool.tip += (point - tool.tip) / late;
            went += (tool.tip - last).norm();
            let found = path.nearest(&tool, CommandedTip { number: number as u64, tip: *point });
            assert!(found.distance < 1e-9, "{late}, {number}: {}", found.distance);
        }
        assert!(went > 1.0, "{went}");
    }
}

/// Where the axes are where they are commanded there is no error, however the path turns.
#[test]
fn a_tool_that_is_where_it_is_commanded_has_no_error() {
    let (turns, mut rng) = randomised(30u64, 7);
    for _ in turns {
        let points = wandering(&mut rng, 400);
        let mut path = path(&points);
        for (number, point) in points.iter().enumerate() {
            let tool = Pose { tip: *point, axis: Vector3::z(), ..Pose::default() };
            let found = path.nearest(&tool, CommandedTip { number: number as u64, tip: *point });
            // Of pieces that the tool stands on alike the rounding of the spline leaves it so far from one.
            assert!(found.distance < 5e-10, "{number}: {}", found.distance);
        }
    }
}
