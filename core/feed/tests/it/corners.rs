//! Batches that meet at corners, against closed forms.

use post_feed::limits::{AxisAcceleration, AxisVelocity, BlockTime, Collocation, Feed, Limit};
use post_feed::reach::{self, Stream};
use post_feed::{EndSpeeds, Infeasible, Problem, Samples, profile};
use post_testkit::Rng;

const FEED: f64 = 50.0;
const ACCELERATION: f64 = 200.0;

/// One side of a polygon.
#[derive(Clone, Copy)]
struct Side {
    length: f64,
    direction: [f64; 2],
    intervals: usize,
    /// Largest speed at the corner behind it, mm/s.
    corner: f64,
}

impl Side {
    /// What the axes allow along it: velocity squared, and acceleration.
    fn allowed(&self, velocity: f64) -> [f64; 2] {
        let [x, y] = self.direction;
        let largest = x.abs().max(y.abs());
        let speed = FEED.min(velocity / largest);
        [speed * speed, ACCELERATION / largest]
    }

    fn samples(&self) -> Samples {
        let mut samples = Samples::default();
        let [x, y] = self.direction;
        for index in 0..=self.intervals {
            let s = self.length * index as f64 / self.intervals as f64;
            let axes = [x, y].map(|first| [first, 0.0, 0.0]);
            samples.push(s, [[x, y, 0.0], [0.0; 3], [0.0; 3]], &axes);
        }
        samples
    }
}

/// The batches of a polygon; the corner behind each side is a bound of the side before or of the one behind.
fn batches(sides: &[Side], velocity: f64, collocation: Collocation) -> Vec<Problem> {
    let feed = Feed { most: FEED, collocation };
    let velocity = AxisVelocity { limits: vec![velocity; 2], collocation };
    let acceleration = AxisAcceleration { limits: vec![ACCELERATION; 2], collocation };
    let limits: [&dyn Limit; 3] = [&feed, &velocity, &acceleration];
    let problem =
        |side: &Side| Problem::new(&side.samples(), &limits, EndSpeeds::default()).unwrap();
    let mut batches: Vec<Problem> = sides.iter().map(problem).collect();
    for (index, side) in sides[..sides.len() - 1].iter().enumerate() {
        let bound = side.corner * side.corner;
        if index % 2 == 0 {
            batches[index].lower(side.intervals, bound, "corner");
        } else {
            batches[index + 1].lower(0, bound, "corner");
        }
    }
    batches
}

/// One problem of all batches, put together by hand.
fn joined(batches: &[Problem]) -> Problem {
    let mut whole = batches[0].clone();
    for batch in &batches[1..] {
        let joint = whole.upper.len() - 1;
        if batch.upper[0] < whole.upper[joint] {
            whole.upper[joint] = batch.upper[0];
            whole.causes[joint] = batch.causes[0];
        }
        whole.steps.extend(&batch.steps);
        whole.rows.extend(&batch.rows);
        whole.upper.extend(&batch.upper[1..]);
        whole.causes.extend(&batch.causes[1..]);
    }
    whole
}

/// `q` at every sample of a polygon by what constant acceleration reaches from corner to corner.
fn closed_form(sides: &[Side], velocity: f64) -> Vec<f64> {
    let mut corners = vec![0.0];
    for pair in sides.windows(2) {
        let of_axes = pair[0].allowed(velocity)[0].min(pair[1].allowed(velocity)[0]);
        corners.push(of_axes.min(pair[0].corner * pair[0].corner));
    }
    corners.push(0.0);
    let gain = |side: &Side| 2.0 * side.allowed(velocity)[1] * side.length;
    for (index, side) in sides.iter().enumerate() {
        corners[index + 1] = corners[index + 1].min(corners[index] + gain(side));
    }
    for (index, side) in sides.iter().enumerate().rev() {
        corners[index] = corners[index].min(corners[index + 1] + gain(side));
    }
    let mut all = vec![0.0];
    for (index, side) in sides.iter().enumerate() {
        let [most, acceleration] = side.allowed(velocity);
        for sample in 1..=side.intervals {
            let way = side.length * sample as f64 / side.intervals as f64;
            let up = corners[index] + 2.0 * acceleration * way;
            let down = corners[index + 1] + 2.0 * acceleration * (side.length - way);
            let end = if sample == side.intervals { corners[index + 1] } else { most };
            all.push(up.min(down).min(end));
        }
    }
    all
}

fn check(sides: &[Side], velocity: f64, lookahead: usize) {
    for collocation in [Collocation::Start, Collocation::Ends, Collocation::Throughout] {
        let batches = batches(sides, velocity, collocation);
        let mut stream = Stream::new(batches[0].stride(), lookahead);
        let (mut plan, mut active) = (Vec::new(), Vec::new());
        let mut take = |sample: reach::Settled<'_>| {
            assert_eq!(sample.sample, plan.len());
            plan.push(sample.q);
            active.push(sample.active());
        };
        for batch in &batches {
            stream.push(batch, &mut take).unwrap();
        }
        stream.finish(0.0, &mut take).unwrap();
        assert!(stream.all_certain());
        let whole = joined(&batches);
        assert_eq!(plan, reach::solve(&whole).unwrap());
        let exact = closed_form(sides, velocity);
        for (sample, (q, exact)) in plan.iter().zip(&exact).enumerate() {
            assert!(
                (q - exact).abs() < 1e-9 * (FEED * FEED),
                "{collocation:?}, sample {sample}: {q} {exact}"
            );
            // What the stream tells is what the whole path tells, and its name is that of the whole.
            let told = whole.active(&plan, sample);
            assert_eq!(active[sample], told, "sample {sample}");
        }
        assert_eq!(plan.len(), exact.len());
        let seconds = profile::duration(&whole.steps, &plan);
        assert!((seconds / profile::duration(&whole.steps, &exact) - 1.0).abs() < 1e-9);
    }
}

/// 40 mm along X, 30 mm along Y; around the corner with 8 mm/s.
#[test]
fn an_l_is_gone_as_its_corner_allows() {
    let side = |length, direction, intervals| Side { length, direction, intervals, corner: 8.0 };
    // Sampled so that the change from acceleration to feed falls on samples: the time is that of the trapezoids.
    let sides = [side(40.0, [1.0, 0.0], 10_000), side(30.0, [0.0, 1.0], 7500)];
    check(&sides, 60.0, 2000);
    let exact = closed_form(&sides, 60.0);
    let whole = joined(&batches(&sides, 60.0, Collocation::Throughout));
    let seconds = profile::duration(&whole.steps, &exact);
    let trapezoid = |length: f64| {
        let ways = (FEED * FEED + FEED * FEED - 64.0) / (2.0 * ACCELERATION);
        (FEED + FEED - 8.0) / ACCELERATION + (length - ways) / FEED
    };
    let want = trapezoid(40.0) + trapezoid(30.0);
    assert!((seconds / want - 1.0).abs() < 1e-5, "{seconds} {want}");
}

/// Regular and random polygons: sides so short that several corners brake together, and corners that are stops.
#[test]
fn polygons_are_gone_as_their_corners_allow() {
    let mut random = Rng::new(15);
    for count in [3, 5, 12, 60] {
        let sides: Vec<Side> = (0..count)
            .map(|index| {
                let angle = 2.0 * std::f64::consts::PI * index as f64 / count as f64;
                let (sin, cos) = libm::sincos(angle);
                let stop = random.range(0.0, 1.0) < 0.1;
                Side {
                    length: random.range(0.2, 8.0),
                    direction: [cos, sin],
                    intervals: random.range(1.0, 60.0) as usize,
                    corner: if stop { 0.0 } else { random.range(1.0, 60.0) },
                }
            })
            .collect();
        // A second limit of the axes that is below the feed on most sides.
        for velocity in [100.0, 40.0] {
            check(&sides, velocity, 400);
        }
    }
}

/// At a corner the active limit is the corner, by its name, whichever batch lowered the bound and whatever else the
/// batches lowered.
#[test]
fn a_corner_is_named_as_the_limit_that_is_active_there() {
    let side = |direction| Side { length: 40.0, direction, intervals: 400, corner: 5.0 };
    let sides = [[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]].map(side);
    let mut batches = batches(&sides, 60.0, Collocation::Throughout);
    // Known to the last batch alone, and before the corner.
    batches[2].names.truncate(3);
    batches[2].lower(200, 1.0, "clamp");
    batches[2].causes[0] = batches[0].causes[0];
    batches[2].upper[0] = FEED * FEED;
    batches[2].lower(0, 25.0, "corner");
    let mut stream = Stream::new(batches[0].stride(), 100);
    let mut active = Vec::new();
    for batch in &batches {
        stream.push(batch, &mut |sample| active.push(sample.active())).unwrap();
    }
    stream.finish(0.0, &mut |sample| active.push(sample.active())).unwrap();
    let name = |sample: usize| stream.name(active[sample].source);
    assert_eq!(name(400), "corner");
    assert_eq!(name(800), "corner");
    assert_eq!(name(1000), "clamp");
    assert_eq!(name(200), "feed");
    assert_eq!(name(390), "axis acceleration of axis 0");
    assert_eq!(name(410), "axis acceleration of axis 1");
}

/// What cannot be planned is refused with its place, leaves nothing behind, and another batch may take its place.
#[test]
fn a_batch_that_is_refused_leaves_the_stream_as_it_was() {
    let side = |length, corner| Side { length, direction: [1.0, 0.0], intervals: 100, corner };
    let sides = [side(10.0, 40.0), side(10.0, 20.0), side(10.0, 0.0)];
    let good = batches(&sides, 60.0, Collocation::Throughout);
    let whole = reach::solve(&joined(&good)).unwrap();
    let mut stream = Stream::new(good[0].stride(), 70);
    let mut plan = Vec::new();
    let mut refused = 0;
    for (index, batch) in good.iter().enumerate() {
        let mut wrong = [batch.clone(), batch.clone(), batch.clone(), batch.clone()];
        // Lower than what it should have at the joint.
        wrong[0].upper[0] = 1.0;
        wrong[0].upper[7] = f64::NAN;
        wrong[1].rows[5].here = f64::INFINITY;
        wrong[2].steps[3] = 0.0;
        wrong[3].sources.pop();
        wrong[3].rows.truncate(2 * wrong[3].steps.len());
        for wrong in &wrong {
            if index == 0 && wrong.stride() != good[0].stride() {
                continue;
            }
            let fault = stream.push(wrong, &mut |sample| plan.push(sample.q));
            refused += usize::from(fault.is_err());
        }
        stream.push(batch, &mut |sample| plan.push(sample.q)).unwrap();
    }
    assert_eq!(refused, 11);
    // Faster than the path can be left with.
    let before = plan.len();
    let fault = stream.finish(2501.0, &mut |sample| plan.push(sample.q));
    let last = whole.len() - 1;
    assert!(
        matches!(fault, Err(Infeasible::OutOfReach { sample, .. }) if sample == last),
        "{fault:?}"
    );
    let fault = stream.finish(f64::NAN, &mut |sample| plan.push(sample.q));
    assert_eq!((fault, plan.len()), (Err(Infeasible::Shape), before));
    stream.finish(0.0, &mut |sample| plan.push(sample.q)).unwrap();
    assert_eq!(plan, whole);
}

/// A start from which nothing ahead can be kept: named, nothing handed on, and the stream begins anew.
#[test]
fn after_a_start_that_is_too_fast_the_stream_begins_anew() {
    let side = Side { length: 10.0, direction: [1.0, 0.0], intervals: 1000, corner: 2.0 };
    let mut good = batches(&[side, side, side], 60.0, Collocation::Throughout);
    // Needs 3.1 mm to stop.
    good[0].lower(300, 0.0, "stop");
    good[0].ends.start = 1240.0;
    let mut stream = Stream::new(good[0].stride(), 100);
    let mut plan = Vec::new();
    let fault = stream.push(&good[0], &mut |sample| plan.push(sample.q)).unwrap_err();
    let Infeasible::TooFastStart { sample, source, .. } = fault else {
        panic!("{fault:?}");
    };
    assert_eq!((sample, stream.name(source)), (300, "stop".to_owned()));
    assert_eq!((plan.len(), stream.waiting()), (0, 0));
    stream.clear();
    good[0].ends.start = 1190.0;
    for batch in &good {
        stream.push(batch, &mut |sample| plan.push(sample.q)).unwrap();
    }
    stream.finish(0.0, &mut |sample| plan.push(sample.q)).unwrap();
    let mut whole = joined(&good);
    whole.ends.start = 1190.0;
    assert_eq!(plan.len(), 3001);
    assert!(whole.worst(&plan).share <= 1.0 + 1e-11);
    assert_eq!(plan[0], 1190.0);
}

/// What waits in a stream does not grow with the path.
#[test]
fn the_memory_of_a_stream_is_that_of_its_look_ahead() {
    let time = BlockTime { seconds: 0.002, collocation: Collocation::Throughout };
    let feed = Feed { most: FEED, collocation: Collocation::Throughout };
    let side = Side { length: 10.0, direction: [1.0, 0.0], intervals: 64, corner: 0.0 };
    let mut samples = side.samples();
    samples.blocks = vec![0.08; 65];
    let batch = Problem::new(&samples, &[&feed, &time], EndSpeeds::default()).unwrap();
    for lookahead in [10, 100] {
        let mut stream = Stream::new(batch.stride(), lookahead);
        let mut most = 0;
        let mut count = 0;
        for _ in 0..5000 {
            stream.push(&batch, &mut |_| count += 1).unwrap();
            most = most.max(stream.waiting());
        }
        stream.finish(0.0, &mut |_| count += 1).unwrap();
        assert_eq!(count, 5000 * 64 + 1);
        assert!(most <= 4 * lookahead + 1, "{most}");
    }
}
