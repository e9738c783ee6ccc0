//! Profiles of lines and arcs: one outline around the arc, one in it, both close.

use post_machine::description::{NoArc, TurnedProfile};
use post_testkit::randomised;

/// Of how far a point may be from where lines stand for an arc, mm.
const WITHIN: f64 = 0.002 + 1e-9;

/// How near a line between two points comes to another, and how far its ends are from that, mm.
fn span(line: &[[f64; 2]], centre: [f64; 2]) -> [f64; 2] {
    let [from, to] = [line[0], line[1]].map(|[z, r]| [z - centre[0], r - centre[1]]);
    let way = [to[0] - from[0], to[1] - from[1]];
    let length = libm::hypot(way[0], way[1]).max(1e-12);
    let share = -(from[0] * way[0] + from[1] * way[1]) / (length * length);
    let share = share.clamp(0.0, 1.0);
    let nearest = libm::hypot(from[0] + way[0] * share, from[1] + way[1] * share);
    [nearest, libm::hypot(from[0], from[1]).max(libm::hypot(to[0], to[1]))]
}

/// Volume of a profile, mm³: frusta.
fn volume(points: &[[f64; 2]]) -> f64 {
    let frustum = |pair: &[[f64; 2]]| {
        let [[z, r], [end, wide]] = [pair[0], pair[1]];
        std::f64::consts::PI * (end - z) * (r * r + r * wide + wide * wide) / 3.0
    };
    points.windows(2).map(frustum).sum()
}

#[test]
fn a_ball_lies_between_its_outlines() {
    for size in [0.2, 5.0, 40.0] {
        let mut ball = TurnedProfile::from(vec![[0.0, 0.0]]);
        ball.arc_to([size, size], size).unwrap();
        for (line, way) in ball
            .outer
            .windows(2)
            .map(|line| (line, true))
            .chain(ball.inner.windows(2).map(|line| (line, false)))
        {
            let [near, far] = span(line, [size, 0.0]);
            match way {
                true => assert!(near > size - 1e-9 && far < size + WITHIN, "{size} {line:?}"),
                false => assert!(far < size + 1e-9 && near > size - WITHIN, "{size} {line:?}"),
            }
        }
        let truth = 2.0 / 3.0 * std::f64::consts::PI * size * size * size;
        let (inner, outer) = (volume(&ball.inner), volume(&ball.outer));
        assert!(inner < truth && truth < outer, "{size} {inner} {truth} {outer}");
        assert!(outer - inner < 4.0 * 0.002 * std::f64::consts::PI * size * size, "{size}");
    }
}

/// A hollow of a quarter: what it bounds is outside of its circle.
#[test]
fn a_hollow_lies_between_its_outlines() {
    let mut holder = TurnedProfile::from(vec![[0.0, 5.0], [10.0, 5.0]]);
    holder.arc_to([13.0, 8.0], -3.0).unwrap();
    let centre = [10.0, 8.0];
    for line in holder.outer[1..].windows(2) {
        let [near, far] = span(line, centre);
        assert!(far < 3.0 + 1e-9 && near > 3.0 - WITHIN, "{line:?}");
    }
    for line in holder.inner[1..].windows(2) {
        let [near, far] = span(line, centre);
        assert!(near > 3.0 - 1e-9 && far < 3.0 + WITHIN, "{line:?}");
    }
    // By Pappus: the square less the quarter of a circle, turned about the axis.
    let square = std::f64::consts::PI * (64.0 - 25.0) * 3.0;
    let quarter = std::f64::consts::PI * 9.0 / 4.0;
    let middle = 8.0 - 4.0 * 3.0 / (3.0 * std::f64::consts::PI);
    let fillet = square - 2.0 * std::f64::consts::PI * middle * quarter;
    let core = std::f64::consts::PI * 25.0 * 13.0;
    let (inner, outer) = (volume(&holder.inner), volume(&holder.outer));
    assert!(
        inner < core + fillet && core + fillet < outer && outer - inner < 1.0,
        "{inner} {fillet} {outer}"
    );
}

/// A barrel goes out and in again: where it is widest all outlines have the radius.
#[test]
fn a_barrel_is_as_wide_as_it_is() {
    let mut barrel = TurnedProfile::from(vec![[0.0, 4.0]]);
    barrel.arc_to([12.0, 4.0], 40.0).unwrap();
    let wide = 4.0 + 40.0 - (40.0f64 * 40.0 - 36.0).sqrt();
    for points in [&barrel.points, &barrel.outer, &barrel.inner] {
        let most = points.iter().map(|point| point[1]).fold(0.0, f64::max);
        assert!((most - wide).abs() < 1e-9, "{most} {wide}");
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
    }
}

#[test]
fn what_is_no_arc_is_none() {
    let arc = |from: [f64; 2], to: [f64; 2], radius: f64| {
        TurnedProfile::from(vec![from]).arc_to(to, radius)
    };
    assert_eq!(arc([0.0, 0.0], [6.0, 8.0], 4.9), Err(NoArc::Short(10.0)));
    assert_eq!(arc([0.0, 3.0], [0.0, 5.0], 4.0), Err(NoArc::Back));
    // The lower half of a ball that begins beside its pole.
    assert_eq!(arc([0.0, 3.0], [1.0, 10.0], 4.0), Err(NoArc::Back));
    assert!(
        matches!(arc([0.0, 1.0], [8.0, 1.0], -5.0), Err(NoArc::Beyond(nearest)) if (nearest + 1.0).abs() < 1e-9)
    );
    assert!(arc([0.0, 3.0], [8.0, 3.0], -5.0).is_ok());
}

/// Whatever arc there is: its points are on the circle, each outline on its side of it.
#[test]
fn random_arcs_keep_their_side() {
    let (rounds, mut rng) = randomised(3000, 77);
    let mut arcs = 0;
    for _ in rounds {
        let from = [0.0, rng.range(0.0, 20.0)];
        let to = [rng.range(0.0, 20.0), rng.range(0.0, 20.0)];
        let radius = rng.range(-60.0, 60.0);
        let mut profile = TurnedProfile::from(vec![from]);
        if profile.arc_to(to, radius).is_err() {
            continue;
        }
        arcs += 1;
        let (outer, inner) = (volume(&profile.outer), volume(&profile.inner));
        assert!(inner <= outer + 1e-9, "{from:?} {to:?} {radius}");
        let straight = volume(&[from, to]);
        match radius > 0.0 {
            true => assert!(inner >= straight - 1e-9, "{from:?} {to:?} {radius}"),
            false => assert!(outer <= straight + 1e-9, "{from:?} {to:?} {radius}"),
        }
        for points in [&profile.points, &profile.outer, &profile.inner] {
            assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]), "{points:?}");
            assert_eq!((points[0], points[points.len() - 1]), (from, to));
        }
    }
    assert!(arcs > 100, "{arcs}");
}
