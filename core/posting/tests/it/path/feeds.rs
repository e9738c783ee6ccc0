//! The feed is that of the tip, and no axis is too fast.

use super::*;

/// The time of a block as its control understands the feed, minutes.
fn minutes(model: &Model, from: &[f64], block: &Asked) -> f64 {
    let travel =
        |range: std::ops::Range<usize>| range.map(|index| block.words[index] - from[index]);
    match block.feed {
        Some(Feed::InverseTime(feed)) => 1.0 / feed,
        Some(Feed::PerMinute(feed)) => {
            let linear = travel(0..3).map(|step| step * step).sum::<f64>().sqrt();
            let rotary = travel(3..5).fold(0.0, |most: f64, step| most.max(step.abs()));
            if !model.tcp {
                assert_eq!(rotary, 0.0, "a feed a minute while an axis turns");
            }
            (if linear > 1e-9 { linear } else { rotary }) / feed
        }
        _ => panic!("{block:?}"),
    }
}

/// The largest share that any axis has of its largest feed (`most`, mm or radians a minute, by place) in a block of so
/// many minutes. Where the control keeps the tip, an axis is faster in the midst of a block than from end to end.
fn share(model: &Model, [from, to]: [&[f64]; 2], minutes: f64, most: &[f64]) -> f64 {
    let pieces = if model.tcp { 100 } else { 1 };
    let position = |piece: u32| {
        let t = f64::from(piece) / f64::from(pieces);
        let words = from.iter().zip(to).map(|(from, to)| from * (1.0 - t) + to * t);
        model.positions(&words.collect::<Vec<f64>>())
    };
    let mut share = 0.0f64;
    let mut start = position(0);
    for piece in 1..=pieces {
        let end = position(piece);
        for ((start, end), most) in start.iter().zip(&end).zip(most) {
            let speed = (end - start).abs() * f64::from(pieces) / minutes;
            share = share.max(speed / most);
        }
        start = end;
    }
    share
}

/// Every cut takes the time that its feed asks for, or longer where an axis would be too fast. Gives the largest
/// share that any axis has of its largest feed, as the control understands the printed words.
fn fastest(tcp: bool) -> f64 {
    let mut fastest: f64 = 0.0;
    for kind in ["trunnion", "head", "nutating"] {
        {
            let model = model(kind, tcp, WIDE, &[]);
            let most: Vec<f64> = model
                .machine
                .axes
                .iter()
                .map(|axis| match axis.name.as_str() {
                    "C" => 9000f64.to_radians(),
                    "A" | "B" => 5400f64.to_radians(),
                    "Z" => 15_000.0,
                    _ => 20_000.0,
                })
                .collect();
            for feed in [300.0, 6000.0] {
                let points = walk(&mut seeded(7), 80, 1.0);
                let run = model.run(&cl(&points, feed)).good("a path");
                let (mut at_feed, mut limited) = (0, 0);
                let mut last: Option<&Asked> = None;
                for (index, point) in points.iter().enumerate() {
                    let (mut time, mut slowest): (f64, f64) = (0.0, 0.0);
                    for block in run
                        .asked
                        .iter()
                        .filter(|asked| asked.line == line(index) && !asked.words.is_empty())
                    {
                        if let Some(last) = last
                            && block.kind == "Linear"
                        {
                            let minutes = minutes(&model, &last.words, block);
                            let share = share(&model, [&last.words, &block.words], minutes, &most);
                            fastest = fastest.max(share);
                            // A feed a minute is printed with one decimal, rounded down.
                            let coarse = match block.feed {
                                Some(Feed::PerMinute(feed)) => (feed + 0.1) / feed,
                                _ => 1.0,
                            };
                            slowest = slowest.max(share * coarse);
                            time += minutes;
                        }
                        last = Some(block);
                    }
                    if index == 0 || point.rapid {
                        continue;
                    }
                    let asked = (point.tip - points[index - 1].tip).norm() / feed;
                    if slowest > 0.99 {
                        limited += 1;
                        assert!(time > asked * 0.99);
                    } else {
                        at_feed += 1;
                        assert!(
                            (time / asked - 1.0).abs() < 0.01,
                            "{kind} {tcp} line {}: {time} for {asked}",
                            line(index)
                        );
                    }
                }
                eprintln!("{kind}, tcp {tcp}, F{feed}: {at_feed} moves at feed, {limited} limited");
                assert!(at_feed > 10);
            }
        }
    }
    fastest
}

#[test]
fn feeds_are_those_of_the_tip_and_no_axis_is_too_fast() {
    let fastest = fastest(false);
    assert!(fastest <= 1.0 + 1e-6, "an axis at {fastest} of its largest feed");
}

/// The same where the control keeps the tip: it divides the way between the printed tips by F.
#[test]
fn feeds_are_those_of_the_tip_and_no_axis_is_too_fast_under_tcp() {
    let fastest = fastest(true);
    assert!(fastest <= 1.0 + 1e-6, "an axis at {fastest} of its largest feed");
}
