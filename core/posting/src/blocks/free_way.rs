//! A way of the axes past bodies: straight where that is clear, else by two trees of places that grow towards one another
//! (RRT-connect: Kuffner and LaValle 2000), and shortened then.
//!
//! Whether a piece is clear is asked of who proves it; nothing here believes that it is because its ends are. The draw is
//! the same in each run.

use post_machine::description::Machine;
use post_machine::kinematics::{Joints, MAX_AXES};

/// Pieces that are asked for while the trees grow.
const MOST_PIECES: usize = 240;

/// Pieces that are asked for to shorten a way.
const MOST_SHORTER: usize = 100;

/// A tree grows by no more than this share of the room at once.
const GROWTH: f64 = 0.3;

/// How far beyond both ends places of linear axes are looked for, mm; rotary ones stay between them.
const BEYOND: f64 = 300.0;

/// Where places are looked for.
#[derive(Clone, Debug)]
pub(super) struct Room {
    least: Joints,
    most: Joints,
}

impl Room {
    /// Around two places, inside travel, and no deeper than they are, whatever bodies say: from there up to the retract, which
    /// is told with the place of the depth axis.
    pub(super) fn new(machine: &Machine, ends: [&Joints; 2], retract: (usize, f64)) -> Self {
        let mut room = Self { least: *ends[0], most: *ends[0] };
        for (place, axis) in machine.axes.iter().enumerate() {
            let [one, other] = ends.map(|joints| joints[place]);
            let beyond = if axis.joint.rotary { 0.0 } else { BEYOND };
            let [least, most] = axis.travel.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            room.least[place] = (one.min(other) - beyond).max(least).min(one.min(other));
            room.most[place] = (one.max(other) + beyond).min(most).max(one.max(other));
        }
        let (depth, highest) = retract;
        let stands = ends.map(|joints| joints[depth]);
        let [least, most] = [stands[0].min(stands[1]), stands[0].max(stands[1])];
        let up = highest > most;
        room.least[depth] = if up { least } else { highest.min(least) };
        room.most[depth] = if up { highest } else { most };
        room
    }

    /// The place in it that is nearest to `joints`.
    pub(super) fn held(&self, joints: Joints) -> Joints {
        std::array::from_fn(|place| joints[place].max(self.least[place]).min(self.most[place]))
    }

    /// How far two places are from one another, as shares of the room: the axis that is farthest.
    fn distance(&self, one: &Joints, other: &Joints) -> f64 {
        let shares = (0..MAX_AXES).map(|place| {
            let room = self.most[place] - self.least[place];
            if room > 0.0 { (one[place] - other[place]).abs() / room } else { 0.0 }
        });
        shares.fold(0.0, f64::max)
    }
}

/// Draws numbers, the same in each run.
struct Draw(u64);

impl Draw {
    /// From 0 to 1.
    fn share(&mut self) -> f64 {
        // xorshift64* (Vigna 2016).
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn place(&mut self, room: &Room) -> Joints {
        std::array::from_fn(|place| between(room.least[place], room.most[place], self.share()))
    }
}

fn between(from: f64, to: f64, share: f64) -> f64 {
    from + (to - from) * share
}

/// Places that can be come to from the first, each with the one before it.
struct Tree(Vec<(Joints, usize)>);

impl Tree {
    fn nearest(&self, room: &Room, to: &Joints) -> usize {
        let places = self.0.iter().map(|(joints, _)| room.distance(joints, to));
        let nearest = places.enumerate().min_by(|one, other| one.1.total_cmp(&other.1));
        nearest.map_or(0, |(place, _)| place)
    }

    /// The places from one of them back to the first.
    fn back(&self, from: usize) -> Vec<Joints> {
        let mut way = vec![self.0[from].0];
        let mut place = from;
        while place > 0 {
            place = self.0[place].1;
            way.push(self.0[place].0);
        }
        way
    }
}

/// Says of a piece between two places whether it is clear.
pub(super) type IsClear<'c> = dyn FnMut(&Joints, &Joints) -> bool + 'c;

/// Looks for a way.
pub(super) struct FreeWay<'f> {
    /// Where.
    pub room: &'f Room,
    /// The place nearest to one that can be printed.
    pub printed: &'f dyn Fn(&Joints) -> Joints,
    /// How long a piece takes, s.
    pub seconds: &'f dyn Fn([&Joints; 2]) -> f64,
}

impl FreeWay<'_> {
    /// A way from one place to another, both among its places; each of its pieces was found clear.
    pub(super) fn find(&self, ends: [&Joints; 2], clear: &mut IsClear<'_>) -> Option<Vec<Joints>> {
        if clear(ends[0], ends[1]) {
            return Some(vec![*ends[0], *ends[1]]);
        }
        let mut draw = Draw(0x9E37_79B9_7F4A_7C15);
        let mut way = self.grown(ends, &mut draw, clear)?;
        self.shorten(&mut way, &mut draw, clear);
        Some(way)
    }

    fn grown(
        &self,
        ends: [&Joints; 2],
        draw: &mut Draw,
        clear: &mut IsClear<'_>,
    ) -> Option<Vec<Joints>> {
        let mut trees = ends.map(|joints| Tree(vec![(*joints, 0)]));
        let mut pieces = 0;
        let mut turn = 0;
        while pieces < MOST_PIECES {
            let drawn = draw.place(self.room);
            pieces += 1;
            if let Some(new) = self.grow(&mut trees[turn], &drawn, clear) {
                let to = trees[turn].0[new].0;
                // The other tree comes as far towards it as it is clear.
                while pieces < MOST_PIECES {
                    pieces += 1;
                    let Some(met) = self.grow(&mut trees[1 - turn], &to, clear) else {
                        break;
                    };
                    if trees[1 - turn].0[met].0 == to {
                        let mut ways = [trees[turn].back(new), trees[1 - turn].back(met)];
                        if turn == 1 {
                            ways.swap(0, 1);
                        }
                        let [mut way, rest] = ways;
                        way.reverse();
                        way.extend_from_slice(&rest[1..]);
                        return Some(way);
                    }
                }
            }
            turn = 1 - turn;
        }
        None
    }

    /// Grows a tree towards a place; the new place.
    fn grow(&self, tree: &mut Tree, to: &Joints, clear: &mut IsClear<'_>) -> Option<usize> {
        let nearest = tree.nearest(self.room, to);
        let from = tree.0[nearest].0;
        let distance = self.room.distance(&from, to);
        let new = match distance <= GROWTH {
            true => *to,
            false => {
                let share = GROWTH / distance;
                (self.printed)(&std::array::from_fn(|place| between(from[place], to[place], share)))
            }
        };
        if new == from || !clear(&from, &new) {
            return None;
        }
        tree.0.push((new, nearest));
        Some(tree.0.len() - 1)
    }

    /// Leaves places out, and puts others in the place of corners, where the way is quicker then.
    fn shorten(&self, way: &mut Vec<Joints>, draw: &mut Draw, clear: &mut IsClear<'_>) {
        for _ in 0..MOST_SHORTER {
            if way.len() < 3 {
                return;
            }
            let pieces = (way.len() - 1) as f64;
            let at = [draw.share() * pieces, draw.share() * pieces];
            let [from, to] = [at[0].min(at[1]), at[0].max(at[1])];
            let [first, last] = [from, to].map(|at| (at as usize).min(way.len() - 2));
            if first == last {
                continue;
            }
            // Ends of pieces as often as places between them.
            let snaps = draw.share() < 0.5;
            let place = |at: f64, piece: usize, end: usize| match snaps {
                true => way[end],
                false => {
                    let share = at - piece as f64;
                    let [one, other] = [&way[piece], &way[piece + 1]];
                    (self.printed)(&std::array::from_fn(|axis| {
                        between(one[axis], other[axis], share)
                    }))
                }
            };
            let cut = [place(from, first, first), place(to, last, last + 1)];
            let mut shorter = way[..=first].to_vec();
            shorter.extend(cut);
            shorter.extend_from_slice(&way[last + 1..]);
            shorter.dedup();
            let seconds = |way: &[Joints]| -> f64 {
                way.windows(2).map(|ends| (self.seconds)([&ends[0], &ends[1]])).sum()
            };
            let quicker = seconds(&shorter) < seconds(way);
            // All of its pieces are new or as they were.
            if quicker
                && shorter
                    .windows(2)
                    .all(|ends| way.windows(2).any(|old| old == ends) || clear(&ends[0], &ends[1]))
            {
                *way = shorter;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use post_testkit::{Rng, randomised};

    use super::*;

    /// What is in the way: boxes of the first three axes.
    type Blocks = Vec<[[f64; 3]; 2]>;

    /// Some place of the way from one place to another is inside of a box: by the shares of the way on which each axis is.
    fn hits(blocks: &Blocks, from: &Joints, to: &Joints) -> bool {
        blocks.iter().any(|[least, most]| {
            let mut shares = [0.0f64, 1.0];
            for axis in 0..3 {
                let (at, way) = (from[axis], to[axis] - from[axis]);
                let ends = [least[axis], most[axis]];
                if way == 0.0 {
                    if at < ends[0] || at > ends[1] {
                        return false;
                    }
                    continue;
                }
                let [one, other] = ends.map(|end| (end - at) / way);
                shares = [shares[0].max(one.min(other)), shares[1].min(one.max(other))];
            }
            shares[0] <= shares[1]
        })
    }

    fn place(x: f64, y: f64, z: f64) -> Joints {
        let mut joints = Joints::default();
        joints[..3].copy_from_slice(&[x, y, z]);
        joints
    }

    /// The way among these boxes, its pieces as many as are asked for.
    fn found(blocks: &Blocks, ends: [&Joints; 2]) -> Option<Vec<Joints>> {
        let room = Room { least: place(0.0, 0.0, 0.0), most: place(100.0, 100.0, 100.0) };
        let way = FreeWay {
            room: &room,
            printed: &|joints| joints.map(libm::rint),
            seconds: &|ends| room.distance(ends[0], ends[1]),
        };
        way.find(ends, &mut |from, to| !hits(blocks, from, to))
    }

    fn drawn(rng: &mut Rng) -> [f64; 3] {
        std::array::from_fn(|_| rng.range(0.0, 100.0))
    }

    /// Wherever boxes stand: no place of a way that is found is inside of one, looked at by small steps.
    #[test]
    fn no_place_of_a_way_is_in_a_box() {
        let (rounds, mut rng) = randomised(300, 71);
        let (mut round_them, mut ways) = (0, 0);
        for _ in rounds {
            let blocks: Blocks = (0..rng.pick(12) + 1)
                .map(|_| {
                    let at = drawn(&mut rng);
                    let size = rng.range(5.0, 40.0);
                    [at, at.map(|value| value + size)]
                })
                .collect();
            let ends = [(); 2].map(|()| {
                let [x, y, z] = drawn(&mut rng);
                place(x, y, z)
            });
            let Some(way) = found(&blocks, ends.each_ref()) else {
                continue;
            };
            ways += 1;
            round_them += usize::from(way.len() > 2);
            assert_eq!([way[0], way[way.len() - 1]], ends);
            for piece in way.windows(2) {
                for step in 0..=500 {
                    let share = f64::from(step) / 500.0;
                    let at: Joints =
                        std::array::from_fn(|axis| between(piece[0][axis], piece[1][axis], share));
                    assert!(!hits(&blocks, &at, &at), "{way:?} in {blocks:?}");
                }
            }
        }
        assert!(ways > 30 && round_them > 5, "{ways} ways, {round_them} round boxes");
    }

    #[test]
    fn a_wall_is_gone_round_and_the_way_is_the_same_again() {
        let wall = vec![[[40.0, -1.0, -1.0], [60.0, 80.0, 101.0]]];
        let ends = [place(10.0, 10.0, 50.0), place(90.0, 10.0, 50.0)];
        let way = found(&wall, ends.each_ref()).unwrap();
        assert!(way.len() > 2 && way.iter().any(|at| at[1] > 80.0), "{way:?}");
        assert_eq!(found(&wall, ends.each_ref()).unwrap(), way);
        // No way leads through one without an end.
        let closed = vec![[[40.0, -1.0, -1.0], [60.0, 101.0, 101.0]]];
        assert_eq!(found(&closed, ends.each_ref()), None);
        assert_eq!(found(&Blocks::new(), ends.each_ref()).unwrap(), ends);
    }
}
