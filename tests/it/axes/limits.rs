//! `[[limit]]`: what must hold between axes, at the words and between them. The fork's axes are worked out by hand: B turns
//! 220 mm over the gauge line, 1120 mm over the machine's zero, the tool is 100 mm long, and the part sits 300 mm high.

use post_testkit::randomised;

use super::*;

/// Of the tip from the B axis, mm.
const ARM: f64 = 320.0;

/// By how much a limit holds at Z and B, but for a number.
type Margin = Box<dyn Fn([f64; 2]) -> f64>;

/// What rounding of words may take a limit beyond its end.
const SLACK: f64 = 2e-3;

fn fork(tcp: &str, keep: &str) -> Setup {
    on("bc-fork")
        .with("control.tcp", tcp)
        .with("workpiece.mount", "[0, 0, 300]")
        .file(format!("[[limit]]\nkeep = {keep:?}\n"))
}

/// Z of the machine and B, as they stand at `shares` of the ways between words of the cuts.
fn ways(setup: &Setup, made: &Made, shares: u32) -> Vec<[f64; 2]> {
    let [z, b] = ["Z", "B"].map(|name| made.words(name));
    let keeps = setup.set.contains(&("control.tcp".to_owned(), "control".to_owned()));
    let first = made.blocks.iter().position(|block| !block.rapid).unwrap_or(made.blocks.len());
    let mut places = Vec::new();
    for block in first..made.blocks.len() {
        for share in 0..=shares {
            let t = f64::from(share) / f64::from(shares);
            let at = |words: &[f64]| words[block - 1] + t * (words[block] - words[block - 1]);
            let (z, b) = (at(&z), at(&b));
            let arm = if keeps { ARM * libm::cos(b.to_radians()) } else { ARM };
            places.push([z + 300.0 - 1120.0 + arm, b]);
        }
    }
    places
}

/// A cut in which B goes to and fro.
fn swinging(rng: &mut post_testkit::Rng) -> String {
    let axis = |rng: &mut post_testkit::Rng| lean(rng.range(5.0, 55.0), rng.range(-30.0, 30.0));
    let first = axis(rng);
    let mut cl = cl().rapid(V::new(0.0, 0.0, 120.0), first);
    cl = cl.cut(V::new(0.0, 0.0, 20.0), first);
    let mut last = first;
    for step in 0..4 {
        last = axis(rng);
        cl = cl.cut(V::new(20.0 * f64::from(step), 5.0, rng.range(0.0, 40.0)), last);
    }
    cl.rapid(V::new(60.0, 5.0, 200.0), last).end()
}

#[test]
fn a_program_is_made_just_inside_a_limit_and_refused_just_outside() {
    let (rounds, mut rng) = randomised(36, 31);
    for round in rounds {
        let tcp = if round % 2 == 0 { "post" } else { "control" };
        let steep = rng.range(0.5, 6.0);
        let (term, margin): (String, Margin) = match round % 3 {
            0 => (format!("{steep} * abs(B)"), Box::new(move |[z, b]| z - steep * b.abs())),
            1 => (
                format!("{steep} * 100 * (1 - cos(B))"),
                Box::new(move |[z, b]| z - steep * 100.0 * (1.0 - libm::cos(b.to_radians()))),
            ),
            _ => (
                format!("max({steep} * B, -B) - 0.01 * B^2"),
                Box::new(move |[z, b]| z - (steep * b).max(-b) + 0.01 * b * b),
            ),
        };
        let text = swinging(&mut rng);
        let free = fork(tcp, "Z > -2000 + 0 * B");
        let free = free.with("solution.require", "{ B = \"positive\" }");
        let made = free.made(&text);
        let least = ways(&free, &made, 200).into_iter().map(&*margin).fold(f64::INFINITY, f64::min);
        let kept = |at: f64| {
            fork(tcp, &format!("Z > {at} + {term}"))
                .with("solution.require", "{ B = \"positive\" }")
        };
        let within = kept(least - 0.02);
        let same = within.made(&text);
        assert_eq!(same.text, made.text, "round {round}: {term}");
        let said = kept(least + 0.02).refused(&text);
        assert!(said.contains("[[limit]] `Z > "), "round {round}: {term}\n{said}");
        for place in ways(&within, &same, 50) {
            assert!(margin(place) > least - 0.02 - SLACK);
        }
    }
}

#[test]
fn the_solution_that_keeps_a_limit_is_taken() {
    let cut = |axis: V| {
        let at = V::new(0.0, 0.0, 20.0);
        cl().rapid(at + V::z() * 100.0, axis).cut(at, axis).rapid(at + V::z() * 100.0, axis).end()
    };
    for azimuth in [10.0, 100.0, -130.0] {
        for (side, sign) in [("max(0, B)", -1.0), ("max(0, -B)", 1.0)] {
            let made =
                fork("post", &format!("Z > -700 + 40 * {side}")).made(&cut(lean(30.0, azimuth)));
            let b = made.words("B");
            assert!(b.iter().any(|b| near(b * sign, 30.0, 1e-3)), "{azimuth} {side} {b:?}");
        }
    }
}

/// The tool swings about its tip from one side to the other: at both ends the limit is far.
#[test]
fn a_limit_holds_between_the_words() {
    let at = V::new(0.0, 0.0, 20.0);
    let text = cl()
        .rapid(at + V::z() * 100.0, lean(20.0, 0.0))
        .cut(at, lean(20.0, 0.0))
        .cut(at + V::x() * 0.5, lean(20.0, 180.0))
        .rapid(at + V::z() * 100.0, lean(20.0, 180.0))
        .end();
    // With B at 0 it stands at 20 + 300 - 1120 + 320, with B at 20 it is 19.3 mm lower.
    let said = fork("control", "Z > -470 - 10 * abs(B)").refused(&text);
    assert!(said.contains("between the ends of this motion"), "{said}");
    assert!(fork("control", "Z > -481 - 10 * abs(B)").made(&text).blocks.len() > 3);
}

/// Axes of a rapid that need not arrive together come by where Z is down and B turned.
#[test]
fn a_rapid_keeps_a_limit_whichever_axis_comes_first() {
    let at = V::new(0.0, 0.0, 20.0);
    let (upright, leant) = (V::z(), lean(40.0, 0.0));
    let text = cl()
        .rapid(at + V::z() * 20.0, upright)
        .cut(at, upright)
        .rapid(at + V::z() * 250.0, leant)
        .cut(at + V::z() * 240.0, leant)
        .rapid(at + V::z() * 250.0, leant)
        .end();
    // Z stands at -480 before, and goes up by 30 mm in the first 5 degrees.
    let keep = "Z > -482 + 0.8 * abs(B)";
    let together = fork("post", keep).with("clearance.rapid_axes", "\"together\"");
    let made = together.made(&text);
    for [z, b] in ways(&together, &made, 100) {
        assert!(z > -482.0 + 0.8 * b.abs() - SLACK, "Z {z} B {b}");
    }
    let said = fork("post", keep).refused(&text);
    assert!(said.contains("between the ends of this motion"), "{said}");
}

#[test]
fn verify_and_read_tell_a_limit_that_a_program_passes() {
    let axis = lean(40.0, 0.0);
    let at = V::new(0.0, 0.0, 20.0);
    let text =
        cl().rapid(at + V::z() * 100.0, axis).cut(at, axis).rapid(at + V::z() * 100.0, axis).end();
    let program = fork("post", "Z > -900 + 2 * abs(B)").made(&text).text;
    let folder = tempfile::tempdir().unwrap();
    let [part, nc, machine] =
        ["part.ncl", "part.nc", "machine.toml"].map(|name| folder.path().join(name));
    fs::write(&part, &text).unwrap();
    fs::write(&nc, &program).unwrap();
    // Z stands at 20 + 300 - 1120 + 320 cos(40), which is -554.866; the limit is -900 + k.
    for (k, kept) in [(345.0, true), (345.3, false)] {
        let keep = format!("Z > -900 + {k} * abs(B) / 40");
        let more = format!("[workpiece]\nmount = [0, 0, 300]\n[[limit]]\nkeep = {keep:?}\n");
        fs::write(&machine, format!("extends = \"bc-fork\"\n{more}")).unwrap();
        let [part, nc, machine] = [&part, &nc, &machine].map(|path| path.to_str().unwrap());
        let with = ["-m", machine, "--tool-length", "100"];
        let verified = post(&[&["verify", nc, "--against", part][..], &with].concat());
        let read = post(&[&["read", nc][..], &with].concat());
        for run in [&verified, &read] {
            let told = format!("{}{}", run.out, run.err);
            assert_eq!(told.contains("[[limit]] `Z >"), !kept, "{told}");
            if !kept {
                assert!(told.contains("Z -554.866 mm, B 40.000°"), "{told}");
            }
        }
        assert_eq!(verified.code, i32::from(!kept));
    }
}

/// `post check` of the fork with a limit.
fn checked(keep: &str, more: &[&str]) -> Run {
    let folder = tempfile::tempdir().unwrap();
    let machine = folder.path().join("machine.toml");
    fs::write(&machine, format!("extends = \"bc-fork\"\n[[limit]]\nkeep = {keep:?}\n")).unwrap();
    post(&[&["check", machine.to_str().unwrap()][..], more].concat())
}

#[test]
fn check_tells_what_a_limit_leaves_of_the_travel() {
    let told = |keep: &str| {
        let run = checked(keep, &["--tool-length", "250"]);
        format!("{}{}", run.out, run.err)
    };
    let text = told("Z > -700 + 2 * abs(B)");
    for row in ["B -105: Z -490 to 50 mm", "B 0: Z -700 to 50 mm", "B 105: Z -490 to 50 mm"] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    assert!(!text.contains("warning["), "{text}");
    assert!(told("Z > -1300 + 2 * abs(B)").contains("it limits nothing"));
    assert!(told("Z > 100 + 2 * abs(B)").contains("holds nowhere"));
}

#[test]
fn what_a_limit_cannot_say_is_refused_with_its_line() {
    for (keep, message) in [
        (
            "Z > -300 + 2 * abs(D)",
            "D is neither an axis nor a parameter; its axes are X, Y, Z, C, B",
        ),
        ("pivot > 3", "names no axis"),
        ("Z + 3", "one of > >= < <= is missing"),
        ("-3 < Z < 3", "one comparison is possible"),
        ("Z > 2 *", "a number or a name is missing at the end"),
    ] {
        let run = checked(keep, &[]);
        assert_eq!(run.code, 1, "{keep}: {}", run.out);
        assert!(run.err.contains("machine-limit") && run.err.contains(message), "{}", run.err);
    }
    let twice = checked("Z > B", &["--set", "parameters.B=3"]);
    assert!(twice.err.contains("B is an axis and a parameter"), "{}", twice.err);
}

/// The box of tips is what limits between the axes leave, to a thousandth; it says which do. With the tool upright the tip of the
/// fork stands 900 mm above Z.
#[test]
fn check_tells_where_the_tip_goes_within_limits() {
    let told = |keep: &str| {
        let run = checked(keep, &[]);
        let text = run.out.replace("\n                  ", " ");
        let row = text.lines().find(|line| line.starts_with("travel of the tip")).unwrap();
        row.to_owned()
    };
    let all = told("Z > -1300 + 2 * abs(B)");
    assert!(all.ends_with("X -1000 to 1000, Y -750 to 750, Z -50 to 950 mm"), "{all}");
    for (keep, left) in [
        ("Z > -300 + 2 * abs(B)", "X -1000 to 1000, Y -750 to 750, Z 600 to 950 mm"),
        ("Z + abs(X) < -100", "X -850 to 850, Y -750 to 750, Z -50 to 800 mm"),
        ("X + Y + Z < -2000", "X -1000 to -300, Y -750 to -50, Z -50 to 650 mm"),
    ] {
        let row = told(keep);
        let within = "as far as what must hold between the axes leaves it:";
        assert!(row.ends_with(&format!("{left} {within} `{keep}`")), "{row}");
    }
    let none = told("Z > 100 + abs(B)");
    assert!(none.contains("none that was found: `Z > 100 + abs(B)` leaves nothing"), "{none}");
    // What names rotary axes alone says where the tool can point.
    let cone = checked("abs(B) < 30", &[]).out;
    assert!(cone.contains("tilt from +Z in all azimuths: 30°"), "{cone}");
    assert!(cone.contains("where `abs(B) < 30` holds"), "{cone}");
}

/// The tip's box of `post check` in a round limit, the slides leaning: X- X+ Y- Y+ Z- Z+, and what is not ruled out.
fn tip_box(keep: &str, seen: &str) -> ([f64; 6], f64) {
    let lean = std::f64::consts::FRAC_1_SQRT_2;
    let text = format!(
        "name = \"disc\"\nchain = \"[w b X Y Z (S) t]\"\ntool.gauge = [0, 0, 500]\nworkpiece.mount = [0, 0, 0]\n\
         [axis.X]\nlinear = [{lean}, {lean}, 0]\ntravel = [-310, 290]\n[axis.Y]\nlinear = [-{lean}, {lean}, 0]\n\
         travel = [-300, 333]\n[axis.Z]\nlinear = [0, 0, 1]\ntravel = [-450, 0]\n[[limit]]\nkeep = {keep:?}\n\
         [control]\ndialect = \"fanuc\"\n"
    );
    let folder = crate::common::with_file("m.toml", &text);
    let run = crate::common::post_in(folder.path(), &["check", "m.toml", "--tool-length", "50"]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(!run.err.contains("holds nowhere"), "{}", run.err);
    assert!(run.out.contains(seen), "{}", run.out);
    let line = run.out.lines().skip_while(|line| !line.starts_with("travel of the tip")).nth(1);
    let numbers = line.unwrap().split([' ', ',']).filter_map(|word| word.parse().ok());
    let open =
        run.out.split("up to ").nth(1).and_then(|rest| rest.split(" mm more at an end").next());
    let open = open.and_then(|open| open.parse().ok()).unwrap_or(0.0);
    (numbers.collect::<Vec<f64>>().try_into().unwrap(), open)
}

/// Ends of a disc and of a ball across slides that lean by 45 degrees, worked out by hand.
#[test]
fn the_tips_box_in_a_round_limit_has_its_ends() {
    let (ends, open) = tip_box("X^2 + Y^2 < 200^2", "");
    let wanted = [-200.0, 200.0, -200.0, 200.0, 0.0, 450.0];
    assert!(open == 0.0, "{open}");
    for (own, wanted) in ends.iter().zip(wanted) {
        assert!((own - wanted).abs() < 0.003, "{ends:?}");
    }
    // Away from where the axes rest, too.
    let (ends, open) = tip_box("(X - 20)^2 + (Y + 30)^2 + (Z + 200)^2 < 180^2", "not ruled out");
    let lean = std::f64::consts::FRAC_1_SQRT_2;
    let middle = [(20.0 + 30.0) * lean, (20.0 - 30.0) * lean, 250.0];
    assert!(open < 1.5, "{open}");
    for (place, own) in ends.iter().enumerate() {
        let wanted = middle[place / 2] + if place % 2 == 0 { -180.0 } else { 180.0 };
        let inside = (middle[place / 2] - own).abs() < 180.001;
        assert!(inside && (own - wanted).abs() <= open + 0.01, "{place}: {ends:?}, {wanted}");
    }
}
