//! Random tools on random ways: what they never touch is never removed, what they are deep in is, and a grid by brute force
//! agrees.

use nalgebra::Vector3;
use post_removal::been::Been;
use post_removal::field::{Cutter, Field};
use post_removal::profile::ToolPose;
use post_testkit::{Rng, at_least, randomised};

use crate::depth;

type V = Vector3<f64>;

const SIZE: f64 = 12.0;

/// A profile, convex or not.
fn any_profile(rng: &mut Rng) -> Vec<[f64; 2]> {
    match rng.pick(4) {
        0 => vec![[0.0, rng.range(0.8, 3.0)], [rng.range(4.0, 20.0), rng.range(0.8, 3.0)]],
        1 => {
            let r = rng.range(1.0, 3.0);
            let rounds = (0..=8).map(|step| {
                let angle = f64::from(step) * std::f64::consts::PI / 16.0;
                [r * (1.0 - libm::cos(angle)), r * libm::sin(angle)]
            });
            rounds.chain([[rng.range(5.0, 20.0), r]]).collect()
        }
        2 => vec![[0.0, 0.0], [1.0, rng.range(0.5, 3.0)], [rng.range(3.0, 20.0), 2.5]],
        _ => {
            let mut z = 0.0;
            let steps = 2 + rng.pick(4);
            let mut point = || {
                let at = z;
                z += rng.range(0.6, 4.0);
                [at, rng.range(0.3, 3.0)]
            };
            (0..=steps).map(|_| point()).collect()
        }
    }
}

fn any_pose(rng: &mut Rng, axis: V) -> ToolPose {
    ToolPose { tip: V::repeat(0.5 * SIZE) + rng.point(SIZE), axis }
}

/// A way: straight, or turning as well.
#[derive(Debug)]
struct Move {
    from: ToolPose,
    to: ToolPose,
    straight: bool,
}

impl Move {
    fn any(rng: &mut Rng) -> Self {
        let axis = match rng.pick(3) {
            0 => V::z(),
            1 => V::ith(rng.pick(3), 1.0),
            _ => rng.direction(),
        };
        let from = any_pose(rng, axis);
        let mut to = any_pose(rng, axis);
        match rng.pick(4) {
            // Along an axis of the grid, along the tool, in its plane.
            0 => to.tip = from.tip + V::ith(rng.pick(3), rng.range(-9.0, 9.0)),
            1 => to.tip = from.tip + axis * rng.range(-9.0, 9.0),
            2 => to.tip -= axis * (to.tip - from.tip).dot(&axis),
            _ => {}
        }
        let straight = rng.pick(3) > 0;
        if !straight {
            to.axis = (axis + rng.point(0.6)).normalize();
        }
        Self { from, to, straight }
    }

    fn at(&self, share: f64) -> ToolPose {
        let axis = self.from.axis + (self.to.axis - self.from.axis) * share;
        let tip = self.from.tip + (self.to.tip - self.from.tip) * share;
        ToolPose { tip, axis: axis.normalize() }
    }

    /// No point of a tool as long as this goes farther between two of `steps` poses, mm.
    fn step(&self, steps: f64) -> f64 {
        let way = (self.to.tip - self.from.tip).norm();
        // The share of a direction between two is no more than twice the chord of this.
        (way + 25.0 * 2.0 * (self.to.axis - self.from.axis).norm()) / steps
    }

    fn cut(&self, field: &mut Field, cutter: &Cutter) {
        let steps = 60;
        if self.straight {
            field.remove_straight(cutter, [self.from, self.to]);
        }
        for step in 0..=steps {
            let pose = self.at(f64::from(step) / f64::from(steps));
            if !self.straight {
                field.remove(cutter, &pose);
            }
            field.doubt(cutter, &pose, self.step(f64::from(steps)));
        }
    }
}

#[test]
fn what_no_pose_touches_is_never_removed_and_what_is_deep_inside_is() {
    let (rounds, mut rng) = randomised(240, 3301);
    let (mut removed, mut certain, mut deep) = (0, 0, 0);
    for _ in rounds {
        let resolution = rng.range(0.4, 1.2);
        let size = V::new(SIZE, rng.range(6.0, SIZE), rng.range(6.0, SIZE));
        let mut field = Field::block(size, resolution);
        let mut moves = Vec::new();
        for _ in 0..1 + rng.pick(3) {
            let profile = any_profile(&mut rng);
            let way = Move::any(&mut rng);
            way.cut(&mut field, &Cutter::new(&profile));
            moves.push((profile, way));
        }
        let looks = 240;
        for _ in 0..400 {
            let point = V::from_fn(|axis, _| rng.range(0.0, size[axis]));
            let (mut deepest, mut deep_inside) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
            // How deep it may be between two looks.
            let mut between: f64 = 0.0;
            for (profile, way) in &moves {
                between = between.max(way.step(f64::from(looks)));
                for look in 0..=looks {
                    let pose = way.at(f64::from(look) / f64::from(looks));
                    let depth = depth(profile, &pose, point);
                    deepest = deepest.max(depth);
                    // Convex in one piece: others have parts that are thinner than a section.
                    if look % 4 == 0 && (profile.len() == 2 || profile.len() == 10) {
                        deep_inside = deep_inside.max(depth);
                    }
                }
            }
            let (may, holds) = (field.may_hold(point), field.holds(point));
            assert!(may || deepest > -between, "{point:?} was removed, {deepest} deep {moves:?}");
            assert!(!holds || deepest < 1e-5, "{point:?} is said to be left, {deepest} deep");
            removed += u32::from(!may);
            certain += u32::from(holds);
            // Sections of a prism do not fit into what is thinner than they are.
            if deep_inside > 2.0 * resolution {
                deep += 1;
                assert!(!may, "{point:?} is left, {deep_inside} deep {moves:?}");
            }
        }
    }
    assert!(removed > at_least(4000) && certain > at_least(8000) && deep > at_least(200));
    println!("{removed} removed, {certain} left for certain, {deep} deep");
}

/// The same bounds by trying every corner and every cell of a small grid, without intervals.
#[test]
fn a_grid_by_brute_force_agrees() {
    let (rounds, mut rng) = randomised(60, 3302);
    for _ in rounds {
        let resolution = 1.0;
        let mut field = Field::block(V::repeat(SIZE), resolution);
        let profile = any_profile(&mut rng);
        let way = Move::any(&mut rng);
        way.cut(&mut field, &Cutter::new(&profile));
        let poses: Vec<ToolPose> = (0..=200).map(|step| way.at(f64::from(step) / 200.0)).collect();
        let mut both = [0.0; 2];
        let cell = 0.5;
        let count = (SIZE / cell) as usize;
        let step = way.step(200.0);
        for place in 0..count * count * count {
            let at = V::new(
                (place % count) as f64 + 0.5,
                (place / count % count) as f64 + 0.5,
                (place / count / count) as f64 + 0.5,
            ) * cell;
            let deepest = poses.iter().map(|pose| depth(&profile, pose, at));
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
            // A cell that is touched at most, and one that is inside at least.
            let around = 0.5 * cell * 3.0f64.sqrt() + step;
            let volume = cell * cell * cell;
            both[0] += if deepest > around { 0.0 } else { volume };
            both[1] += if deepest > -around { 0.0 } else { volume };
        }
        let found = field.volume();
        // Bounds of the two are of the same: they overlap.
        assert!(found.at_least <= both[0] + 1e-6, "{found:?} {both:?}");
        assert!(both[1] <= found.at_most + 1e-6, "{found:?} {both:?}");
    }
}

/// A finer grid, of cells that lie within those of a coarse one, never knows less.
#[test]
fn half_the_cells_know_no_less() {
    let (rounds, mut rng) = randomised(60, 3303);
    for _ in rounds {
        let profile = any_profile(&mut rng);
        let way = Move::any(&mut rng);
        let cutter = Cutter::new(&profile);
        let volumes = [1.5, 0.75, 0.375].map(|resolution| {
            let mut field = Field::block(V::repeat(SIZE), resolution);
            way.cut(&mut field, &cutter);
            field.volume()
        });
        for pair in volumes.windows(2) {
            // The search for where a tool reaches farthest along a line ends somewhere.
            let slack = 0.3;
            assert!(pair[1].at_most <= pair[0].at_most + slack, "{volumes:?}");
            assert!(pair[1].at_least >= pair[0].at_least - slack, "{volumes:?}");
        }
    }
}

/// Where a tool need not be held against what is left it has been, or nothing may be left: by its poses.
#[test]
fn a_tool_is_spared_where_it_has_been() {
    let (rounds, mut rng) = randomised(6000, 3304);
    let (mut spared, mut above, mut all) = (0, 0, 0);
    for _ in rounds {
        let axis = if rng.pick(2) == 0 { V::z() } else { rng.direction() };
        let height = rng.range(1.0, 4.0);
        let r = rng.range(1.0, 2.0);
        // Edges with a round or a flat end, a neck, a shank that may be thick.
        let low = if rng.pick(2) == 0 { r } else { 0.2 * r };
        let mut profile = vec![[0.0, low], [0.3, r], [height, r]];
        if rng.pick(4) > 0 {
            let shank = rng.range(0.5, 1.3) * r;
            profile.extend([
                [height, 0.8 * r],
                [height + 1.5, 0.8 * r],
                [height + 1.5, shank],
                [9.0, shank],
            ]);
        }
        let mut field = Field::block(V::repeat(SIZE), 1.5);
        let mut been = Been::new(&profile);
        let middle = V::repeat(0.5 * SIZE) + rng.point(3.0);
        let along = if rng.pick(2) == 0 { V::zeros() } else { rng.direction() };
        let any = |rng: &mut Rng| {
            let aside = along - axis * axis.dot(&along) * f64::from(rng.pick(2) as u8);
            let tip = middle + aside * rng.range(-2.0, 2.0) + axis * rng.range(-4.0, 7.0);
            ToolPose { tip, axis }
        };
        let mut gone = Vec::new();
        let mut from = any(&mut rng);
        for _ in 0..1 + rng.pick(4) {
            let to = any(&mut rng);
            been.add([from, to]);
            field.remove_straight(&Cutter::new(&profile), [from, to]);
            gone.push([from, to]);
            from = to;
        }
        let to = match rng.pick(3) {
            0 => any(&mut rng),
            _ => ToolPose { tip: from.tip + axis * rng.range(-3.0, 9.0), axis },
        };
        // As words are printed.
        let [from, to] =
            [from, to].map(|pose| ToolPose { tip: pose.tip + rng.point(5e-4), ..pose });
        all += 1;
        let free = match been.covers(Some(&mut field), [from, to]) {
            true => 0.0,
            false if been.covers_above(height, [from, to]) => height,
            false => continue,
        };
        spared += 1;
        above += u32::from(free > 0.0);
        for _ in 0..40 {
            let point = from.tip + (to.tip - from.tip) * rng.range(0.0, 1.0);
            let pose = ToolPose { tip: point, axis };
            let place = rng.pick(profile.len() - 1);
            let share = rng.range(0.0, 1.0);
            let [z, radius] = [0, 1].map(|part: usize| {
                profile[place][part] + (profile[place + 1][part] - profile[place][part]) * share
            });
            let out = rng.direction();
            let out = (out - axis * axis.dot(&out)).normalize();
            if z < free {
                continue;
            }
            let point = pose.tip + axis * z + out * (radius - 1e-3).max(0.0);
            let inside = point.iter().all(|part| (0.0..=SIZE).contains(part));
            if !inside || !field.may_hold(point) {
                continue;
            }
            // It may be left by the grid alone: the tool has been there, or higher up on its way in.
            let top = profile[profile.len() - 1][0];
            let mut whole = profile.clone();
            if profile.len() == 3 {
                whole.push([top + 40.0, r]);
            }
            let deepest = gone.iter().flat_map(|[from, to]| {
                (0..=600).map(move |step| {
                    let share = f64::from(step) / 600.0;
                    ToolPose { tip: from.tip + (to.tip - from.tip) * share, axis }
                })
            });
            let deepest = deepest.map(|pose| depth(&whole, &pose, point));
            let deepest = deepest.fold(f64::NEG_INFINITY, f64::max);
            assert!(deepest > -0.02, "{point:?} {deepest} {profile:?} {from:?} {to:?} {gone:?}");
        }
    }
    println!("{spared} of {all} spared, {above} of them above the edges");
    assert!(spared > at_least(300) && above > at_least(30), "{spared} {above} of {all}");
}

/// However often it is cut, a field takes no more memory than its prisms, and its bounds stay bounds.
#[test]
fn memory_is_that_of_the_field() {
    let mut rng = post_testkit::seeded(3305);
    let mut field = Field::block(V::new(60.0, 3.0, 60.0), 1.0);
    let prisms = 3 * 60 * 3 + 60 * 60 + 60 * 3;
    let cutter = Cutter::new(&[[0.0, 0.72], [80.0, 0.72]]);
    let mut last = field.volume();
    for hole in 0..400 {
        let tip = V::new(rng.range(0.0, 60.0), -5.0, rng.range(0.0, 60.0));
        let pose = ToolPose { tip, axis: V::y() };
        field.remove(&cutter, &pose);
        field.doubt(&cutter, &pose, 0.0);
        let volume = field.volume();
        assert!(volume.at_least <= last.at_least + 1e-3, "{hole}");
        assert!(volume.at_least <= volume.at_most);
        last = volume;
    }
    assert!(field.bytes() < prisms * (24 + 64 * 8), "{} bytes", field.bytes());
}
