//! Quills, with a share of the way or in reserve.

use super::*;

// ---------------------------------------------------------------------------------------------------------------
// Quills
// ---------------------------------------------------------------------------------------------------------------

/// Straight down and up again along Z.
fn depths(depths: &[f64]) -> String {
    let mut text = cl();
    for (place, z) in depths.iter().enumerate() {
        text = text.line(&format!("GOTO / {place}, 0, {z}"));
    }
    text.end()
}

#[test]
fn a_quill_takes_its_share_of_the_whole_way() {
    let made = on("quill-mill").made(&depths(&[100.0, 50.0, 0.0, -10.0, 73.333]));
    for (z, block) in [100.0, 50.0, 0.0, -10.0, 73.333].iter().zip(&made.blocks) {
        let [main, quill] = ["Z", "W"].map(|name| block.words[made.place(name)]);
        assert!(near(quill, 0.3 * z, 0.0011), "{z}: W{quill}");
        assert!(near(main, 0.7 * z, 0.0011), "{z}: Z{main}");
        assert!(near(main + quill, *z, 0.0011), "{z}: {main} {quill}");
    }
}

/// From above, X and Y come first; Z and W follow, both along the tool.
#[test]
fn a_mill_with_a_quill_comes_down_last() {
    let text = depths(&[100.0, 50.0]);
    let made = on("quill-mill").made(&text);
    let moves = |line: &&str| line.contains(" X") || line.contains(" Z");
    let first = made.text.lines().skip_while(|line| *line != "G54").find(moves);
    assert!(!first.unwrap().contains('Z'), "{}", made.text);
    let made = on("quill-mill").with("control.dialect", "heidenhain").made(&text);
    assert!(made.text.contains("TOOL CALL 1 Z"), "{}", made.text);
}

/// With a tool of 150 mm the tip is 850 mm over the part origin with Z and W at zero: Z goes 600 of them, W the
/// rest, so Z 0 and W 0 in the program are axis positions -600 and -250.
#[test]
fn a_quill_in_reserve_moves_where_the_other_ends() {
    let levels = [500.0, 250.0, 249.0, 100.0, -30.0, 249.999, 250.5, -250.0];
    let made = on("boring-mill").long(150.0).made(&depths(&levels));
    let words = |name: &str| {
        let mut words = made.words(name);
        words.dedup();
        words
    };
    for z in levels {
        let wanted = [(z - 250.0).max(0.0), z.min(250.0)];
        let met = made.blocks.iter().any(|block| {
            let [main, quill] = ["Z", "W"].map(|name| block.words[made.place(name)]);
            near(main, wanted[0], 0.0011) && near(quill, wanted[1], 0.0011)
        });
        assert!(met, "{z}: {wanted:?}\n{}", made.text);
    }
    assert!(words("W").iter().all(|word| *word <= 250.0), "{:?}", words("W"));
    let said = on("boring-mill").long(150.0).refused(&depths(&[300.0, -251.0]));
    assert!(
        said.contains("error[over-travel]: W would be -501.000 mm, its limit is -500.000 mm"),
        "{said}"
    );
}

/// On the way past the end of Z the tip stays on its line: at the end of every block and half way along it.
#[test]
fn the_tip_is_exact_where_the_quill_takes_over() {
    let text = cl().line("GOTO / 0, 0, 350").line("GOTO / 300, 30, 150").end();
    let made = on("boring-mill").long(150.0).made(&text);
    let model = &made.model;
    for pair in made.blocks.windows(2) {
        let middle: Vec<f64> =
            pair[0].words.iter().zip(&pair[1].words).map(|(a, b)| (a + b) / 2.0).collect();
        for words in [&middle, &pair[1].words] {
            let tip = model.pose(words, 150.0).tip;
            let t = tip.x / 300.0;
            let line = V::new(300.0 * t, 30.0 * t, 350.0 - 200.0 * t);
            assert!((tip - line).norm() < 0.010 + ROUNDING, "{tip} {line}\n{}", made.text);
        }
    }
}

/// W is held 100 mm out, and the tip is 400 - 100 - 100 mm over the table with Z at zero.
#[test]
fn a_quill_that_is_held_stays() {
    let held = on("vmc").file(
        "name = \"held quill\"\nchain = \"[w Y' X' b Z W (S) t]\"\n\
         [axis.Z]\ntravel = [-500, 20]\n\
         [axis.W]\nlinear = [0, 0, 1]\ntravel = [-200, 0]\nindexed = -100\n",
    );
    let levels = [100.0, 50.0, 20.0, 80.0];
    let made = held.made(&depths(&levels));
    let words = made.words("W");
    assert!(words.iter().all(|word| *word == words[0]), "{words:?}");
    // Z takes the whole way.
    let ways = made.words("Z");
    for (z, word) in levels.iter().zip(&ways) {
        assert!(near(word - ways[0], z - levels[0], 1e-9), "{z}: {ways:?}");
    }
}

/// The same with the key written out.
#[test]
fn a_quill_without_reserve_can_be_held() {
    let made = on("boring-mill")
        .with("axis.W.reserve", "false")
        .with("axis.W.indexed", "-100")
        .made(&depths(&[300.0, 200.0]));
    assert_eq!(made.words("W")[0], made.words("W")[1]);
}

/// Axes that were measured have their zeros beside the printed numbers: a quill that rests at its end stays inside it.
#[test]
fn a_quill_of_a_measured_machine_rests_inside_its_travel() {
    let measured = on("boring-mill")
        .long(150.0)
        .with("axis.X.linear", "[1.000210574588, 0.000250926841, -0.000291328416]")
        .with("axis.Y.linear", "[0.000132501651, 0.999777745065, 0.000065327332]")
        .with("workpiece.mount", "[0, 40, 0]")
        .with("tool.gauge", "[0.0003, 500.0004, 1000.00037]");
    let levels = [500.0, 250.0, 249.0, 100.0, -30.0, 249.999, 250.0004, 250.5, -249.0];
    let made = measured.made(&depths(&levels));
    for (place, z) in levels.iter().enumerate() {
        let wanted = V::new(place as f64, 0.0, *z);
        let hit = |block: &Block| (made.model.pose(&block.words, 150.0).tip - wanted).norm();
        let nearest = made.blocks.iter().map(hit).fold(f64::INFINITY, f64::min);
        assert!(nearest < ROUNDING, "{z}: {nearest}\n{}", made.text);
    }
}

/// With the tool centre point control on, a quill that stands keeps its own word, and X Y Z are the tip's: Z follows A with
/// the quill as a part of the head.
#[test]
fn a_quill_that_is_held_stays_beside_the_words_of_the_tip() {
    let file = |at: f64| {
        format!(
            "name = \"fork and quill\"\nchain = \"[w b X Y Z C A W (S) t]\"\n[control]\ntcp = \"control\"\n\
             [axis.W]\nlinear = [0, 0, 1]\ntravel = [-200, 0]\nindexed = {at}\n"
        )
    };
    let mut text = cl();
    for (x, tilt) in [(0.0f64, 0.0f64), (40.0, 12.0), (90.0, 31.0), (120.0, 20.0)] {
        text = text.cut(V::new(x, 10.0, 30.0), lean(tilt, 90.0));
    }
    let text = text.end();
    let of = |at: f64| on("head-head").file(file(at)).made(&text);
    let (short, long) = (of(0.0), of(-150.0));
    for made in [&short, &long] {
        let words = made.words("W");
        assert!(words.iter().all(|word| *word == words[0]), "{words:?}");
        for block in made.blocks.iter().filter(|block| !block.rapid) {
            let pose = made.model.pose(&block.words, made.length);
            assert!((pose.tip.y - 10.0).abs() < 0.011, "{}", made.text);
        }
    }
    assert_eq!(long.words("W")[0], -150.0, "{}", long.text);
    // The tip's words and angles are the same wherever the quill stands.
    let same = |name: &str| (short.words(name), long.words(name));
    for name in ["X", "Y", "A", "C"] {
        let (one, other) = same(name);
        assert_eq!(one.last(), other.last(), "{name}");
    }
    // It moves nothing by itself in a cut.
    let share = file(0.0).replace("indexed = 0", "share = 0.5");
    let said = on("head-head").file(share).refused(&text);
    assert!(said.contains("indexed = … says where"), "{said}");
}
