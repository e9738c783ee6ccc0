//! The page of the report in a real browser: what it shows is what the command has said, every key does what its help
//! says, and nothing is loaded.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use nalgebra::Vector3;
use post_machine::description::{Machine, Source, load};
use post_machine::kinematics::Joints;
use post_testkit::{all_drawn, drawn};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::browser::Browser;
use crate::common::{Run, post, read_json, root, sample};
use crate::generate;
use crate::library::LIBRARY;

/// A run with its report.
struct Made {
    folder: TempDir,
    page: PathBuf,
    nc: PathBuf,
    summary: Value,
}

/// Posts a file with a report; must succeed.
fn made(machine: &str, file: &Path, more: &[&str]) -> Made {
    let folder = tempfile::tempdir().unwrap();
    let [nc, page, summary] =
        ["part.nc", "part.html", "part.json"].map(|name| folder.path().join(name));
    let mut arguments = vec!["-q", "--machine", machine, file.to_str().unwrap()];
    arguments.extend(["--output", nc.to_str().unwrap()]);
    arguments.extend(["--report", page.to_str().unwrap()]);
    arguments.extend(["--summary", summary.to_str().unwrap()]);
    arguments.extend(more);
    let Run { code, err, .. } = post(&arguments);
    assert_eq!(code, 0, "{machine}, {}:\n{err}", file.display());
    let summary = read_json(&summary);
    Made { folder, page, nc, summary }
}

/// A cut of a blade on a trunnion machine: five axes, a tool, rapids.
fn blade() -> Made {
    made("ac-trunnion", &sample("blade.cls"), &["--tool-length", "0"])
}

/// The state of the page.
fn state(browser: &mut Browser, name: &str) -> Value {
    browser.ask(&format!("P.state.{name}"))
}

/// What was proven of pairs of bodies is told with the place of each nearest approach, and colours the path; bodies stand
/// where the machine file has them.
#[test]
fn clearance_is_told_of_pairs_and_along_the_path() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let machine = "extends = \"ac-trunnion\"\nname = \"with bodies\"\n[stock]\nblock = [[-50, -30, 0], [50, 30, 28]]\n\
                   [fixture.jaw]\nblock = [[60, -60, 0], [90, 60, 40]]\n[tools.3]\nlength = 100\n\
                   holder = [[0, 32], [20, 32], [20, 20], [60, 18]]\ncutter = [[0, 5], [40, 5]]\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bodies.toml");
    fs::write(&path, machine).unwrap();
    let made = made(path.to_str().unwrap(), &sample("blade.cls"), &["--clearance"]);
    browser.open(&made.page);
    let pairs = browser.ask("P.m.meta.clearance.pairs");
    let told = made.summary["clearance"]["pairs"].as_array().unwrap();
    assert_eq!(pairs.as_array().unwrap().len(), told.len());
    let nearest = &pairs[0];
    assert_eq!(nearest["bodies"], json!(["jaw", "holder T3"]));
    // It leads to its line.
    browser.ask("document.querySelectorAll('#verdict .maxima')[1].querySelector('button').click()");
    assert_eq!(browser.ask("P.m.lineOf('nc', P.state.row)"), nearest["nc"]);
    // No block is nearer than is proven of the program, and the nearest is as near as that.
    let blocks = browser.ask("[...P.m.column('clearance')]");
    let blocks: Vec<f64> = blocks.as_array().unwrap().iter().filter_map(Value::as_f64).collect();
    assert_eq!(json!(blocks.len()), browser.ask("P.m.rows"));
    let least = blocks.iter().copied().fold(f64::INFINITY, f64::min);
    let by = nearest["clear_by"].as_f64().unwrap();
    assert!((least - by).abs() < 0.06 * by, "{least} {by}");
    let own = browser.ask("P.m.at('clearance', P.state.row)").as_f64().unwrap();
    assert!(own <= nearest["nearest"].as_f64().unwrap() && own < 1.06 * least, "{own} {least}");
    // The path is coloured by it, the nearest as far up the scale as there is.
    browser.ask("P.set({ colour: P.colour.modes.findIndex(({ id }) => id === 'clearance') })");
    let place = browser.ask("P.colour.place(P.colour.mode(), P.colour.mode().value(P.worst()))");
    assert_eq!(place, browser.ask("P.colour.top"));
    assert_eq!(browser.ask("P.m.at('clearance', P.worst())").as_f64(), Some(least));
    // Twelve edges of the stock and of the jaw, and the tool as the machine file has it.
    browser.ask("P.set({ machine: true })");
    let corners = browser.ask("P.m.report.tables.solids.rows");
    assert_eq!(corners, json!(12 * 2 + 12 * 2 + 12 * 3));
    assert_eq!(browser.ask("P.parts.made.outline.holder.length"), json!(4));
}

/// Operations and tools stand in a list, in the order of the program, and each leads to where it begins.
#[test]
fn operations_and_tools_are_gone_to() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = made("vmc", &sample("flange.ncl"), &["--tool-length", "100"]);
    browser.open(&made.page);
    let steps = "[...document.querySelectorAll('.steps button')]";
    let names = browser.ask(&format!("{steps}.map((button) => button.textContent)"));
    let names: Vec<&str> = names.as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let tools: Vec<&&str> = names.iter().filter(|name| name.starts_with("tool ")).collect();
    assert_eq!(tools.len(), 4, "{names:?}");
    for (place, name) in names.iter().enumerate() {
        browser.ask(&format!("{steps}[{place}].click()"));
        let row = state(&mut browser, "row");
        let rows =
            "P.m.meta.events.filter(({ kind }) => ['operation', 'tool', 'head'].includes(kind))";
        assert_eq!(row, browser.ask(&format!("{rows}[{place}].row")), "{name}");
        let marked = browser.ask("document.querySelector('.steps [aria-current]').textContent");
        let begun = browser.ask(&format!("{rows}.findLast(({{ row }}) => row <= {row}).text"));
        assert_eq!(marked, begun);
    }
}

/// A hidden operation is neither drawn nor clicked at, and is back when it is asked for; one stands alone.
#[test]
fn operations_are_hidden_and_drawn() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = made("vmc", &sample("flange.ncl"), &["--tool-length", "100"]);
    browser.open(&made.page);
    let boxes = "[...document.querySelectorAll('.steps input')]";
    let drawn = "(() => { const { path, NONE } = P.scene; const rows = new Set();
        for (let at = 0; at < path.count; at++) if (path.look[at * 4 + 1] < NONE) rows.add(path.look[at * 4 + 2]); return [...rows]; })()";
    let all = browser.ask(drawn).as_array().unwrap().len();
    assert!(browser.ask(&format!("{boxes}.length")).as_u64().unwrap() >= 4);
    browser.ask(&format!("{boxes}[1].click()"));
    let hidden = state(&mut browser, "hidden");
    let span = browser.ask(&format!("P.m.span({})", hidden[0]));
    let [first, last] = [0, 1].map(|end| span[end].as_u64().unwrap());
    let rows = browser.ask(drawn);
    let rows: Vec<u64> = rows.as_array().unwrap().iter().filter_map(Value::as_u64).collect();
    assert!(!rows.iter().any(|row| (first..=last).contains(row)), "{first} to {last}: {rows:?}");
    assert!(rows.len() < all && !rows.is_empty());
    browser.ask(&format!("P.select({first})"));
    assert_eq!(browser.ask(&format!("{boxes}[1].checked")), false);
    browser.press("h");
    assert_eq!(browser.ask(drawn).as_array().unwrap().len(), all);
    browser.ask("P.step_alone()");
    let rows = browser.ask(drawn);
    let alone = rows.as_array().unwrap().iter().filter_map(Value::as_u64);
    assert!(alone.clone().count() > 0 && alone.clone().all(|row| (first..=last).contains(&row)));
    browser.press("H");
    assert_eq!(browser.ask(drawn).as_array().unwrap().len(), all);
    browser.assert_quiet();
}

/// Two points of the path are as far apart as the tips of their blocks, and a click takes the point that it is near.
#[test]
fn two_points_are_measured() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    for row in [40, 90] {
        browser.ask(&format!("P.select({row})"));
        browser.press("R");
    }
    let tips = "[40, 90].map((row) => ['x', 'y', 'z'].map((axis) => P.m.at(`tip.${axis}`, row)))";
    let far = browser.ask(&format!(
        "(([a, b]) => Math.hypot(...a.map((value, at) => b[at] - value)).toFixed(3))({tips})"
    ));
    let told = browser.ask("P.measure.told.textContent");
    let told = told.as_str().unwrap();
    assert!(told.contains(&format!("{} mm: ΔX ", far.as_str().unwrap())), "{far}: {told}");
    let place = browser.ask(
        "(() => { const [, last] = P.scene.points_of(60); const m = P.path.matrices().matrix; const box = P.path.canvas.getBoundingClientRect();
           const [x, y] = P.camera.pixel(m, ...P.scene.path.pos.subarray(last * 3, last * 3 + 3)); return [x + box.left, y + box.top]; })()",
    );
    let [x, y] = [0, 1].map(|at| place[at].as_f64().unwrap());
    let before = state(&mut browser, "row");
    browser.click(x, y);
    assert_eq!(browser.ask("P.measure.points.length"), 1);
    let apart = browser.ask(
        "(() => { const { at } = P.measure.points[0]; return Math.hypot(...['x', 'y', 'z'].map((axis, place) => at[place] - P.m.at(`tip.${axis}`, 60))); })()",
    );
    let pixel = browser.ask("1 / P.camera.per_mm()").as_f64().unwrap();
    assert!(apart.as_f64().unwrap() < 40.0 * pixel, "{apart} mm, a pixel is {pixel} mm");
    assert_eq!(state(&mut browser, "row"), before);
    browser.press("Escape");
    assert_eq!(browser.ask("P.measure.told.hidden"), true);
    browser.assert_quiet();
}

/// Panes have room on a small screen and on a tablet, and a grip makes one wider.
#[test]
fn panes_have_room_and_are_resized() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    for (width, height) in [(1366, 768), (1180, 820), (1024, 768), (820, 1180)] {
        let size =
            json!({"width": width, "height": height, "deviceScaleFactor": 1, "mobile": false});
        browser.send("Emulation.setDeviceMetricsOverride", &size);
        browser.open(&made.page);
        let narrow = browser.ask(
            "[...document.querySelectorAll('.view')].filter((view) => view.clientWidth && (view.clientWidth < 200 || view.clientHeight < 150)).map(({ id, clientWidth, clientHeight }) => [id, clientWidth, clientHeight])",
        );
        assert_eq!(narrow, json!([]), "{width} × {height}");
        let cut = browser.ask(
            "[...document.querySelectorAll('.bar, .bar button')].filter((bar) => bar.clientWidth && bar.scrollWidth > bar.clientWidth + 1).map((bar) => bar.textContent)",
        );
        assert_eq!(cut, json!([]), "{width} × {height}");
        let wide = browser.ask("[document.documentElement.scrollWidth, P.by('path').clientWidth]");
        assert!(wide[0].as_u64().unwrap() <= width, "the page goes past the screen: {wide}");
        assert!(wide[1].as_u64().unwrap() * 5 >= width * 2, "{width}: path {}", wide[1]);
        // Alone a view has all of the width, and a picture that is no strip.
        browser.ask("P.by('views').dataset.solo = 'path'; P.views.settle(); 0");
        let alone = browser
            .ask("[P.by('path').clientWidth, document.querySelector('.stage').clientHeight]");
        assert!(alone[0].as_u64().unwrap() * 10 >= width * 9, "{width}: path alone {alone}");
        assert!(alone[1].as_u64().unwrap() * 2 >= height, "{width}: path alone {alone}");
    }
    let size = json!({"width": 1440, "height": 900, "deviceScaleFactor": 1, "mobile": false});
    browser.send("Emulation.setDeviceMetricsOverride", &size);
    browser.open(&made.page);
    for (grip, view, side, key) in [
        ("verdict", "verdict", "clientWidth", "ArrowRight"),
        ("nc", "nc", "clientWidth", "ArrowLeft"),
        ("charts", "charts", "clientHeight", "ArrowUp"),
    ] {
        let asked = format!("P.by('{view}').{side}");
        let before = browser.ask(&asked).as_i64().unwrap();
        browser.ask(&format!("document.querySelector('.grip.{grip}').focus()"));
        browser.press(key);
        let after = browser.ask(&asked).as_i64().unwrap();
        assert!((after - before - 24).abs() <= 1, "{grip}: {before}, {after}");
        assert_eq!(state(&mut browser, "row"), browser.ask("P.worst()"), "a key of the page ran");
    }
    browser.assert_quiet();
}

/// The tool that is drawn is as long and as thick as the one in use, and follows the tool changes.
#[test]
fn the_tool_is_true_to_size() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = made("dmu50", &sample("facets.apt"), &["--tool-length", "120"]);
    browser.open(&made.page);
    browser.ask("P.set({ machine: true })");
    let tools = browser
        .ask("P.m.meta.events.filter(({ kind }) => kind === 'tool').map(({ row, cutter }) => [row, cutter.diameter])");
    let tools = tools.as_array().unwrap();
    let sizes: Vec<f64> = tools.iter().filter_map(|tool| tool[1].as_f64()).collect();
    assert_eq!(sizes, [12.0, 5.0]);
    for tool in tools {
        browser.ask(&format!("P.select({}); P.path.draw(false)", tool[0]));
        // Of the faces of the tool: the largest distance from its axis, and their ends along it, from the tip.
        let found = browser.ask(
            "(() => { const { faces } = P.parts.made; const machine = P.chain.at(P.state.row); const k = P.chain.unit(machine.tool_axis);
               const tip = P.chain.tip(machine, P.chain.length(P.state.row)); let far = 0, low = Infinity, high = -Infinity;
               for (let at = 0; at < faces.length; at += 8) { if (Math.floor(faces[at + 7] / 10) * 10 !== P.TOOL) continue;
                 const way = P.vec.add([...faces.subarray(at, at + 3)], tip, -1); const along = P.vec.dot(way, k);
                 far = Math.max(far, Math.hypot(...P.vec.add(way, k, -along))); low = Math.min(low, along); high = Math.max(high, along); }
               return [far, low, high]; })()",
        );
        let [far, low, high] = [0, 1, 2].map(|at| found[at].as_f64().unwrap());
        let radius = tool[1].as_f64().unwrap() / 2.0;
        assert!((far - radius).abs() < 1e-3, "{far} of {radius}");
        assert!(low.abs() < 1e-3 && (high - 120.0).abs() < 1e-3, "{low} to {high}");
        let legend = browser.ask("P.path.legend.textContent");
        let told = format!("tool: ⌀ {:.3}", 2.0 * radius);
        assert!(legend.as_str().unwrap().contains(&told), "{legend}");
    }
    browser.assert_quiet();
}

/// Times have one form, and no vector below half of its tolerance is drawn.
#[test]
fn times_are_alike_and_small_vectors_are_not_drawn() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    for (seconds, digits, told) in [
        ("0", 1, "0.0 s"),
        ("59.96", 1, "1 min 00.0 s"),
        ("124.25", 2, "2 min 04.25 s"),
        ("3723.4", 1, "1 h 02 min 03.4 s"),
        ("3600", 0, "1 h 00 min 00 s"),
    ] {
        assert_eq!(browser.ask(&format!("P.clock({seconds}, {digits})")), told);
    }
    let kept = browser.ask(
        "(() => { const { vectors } = P.scene; const least = []; for (let at = 0; at < vectors.count; at++)
           least.push(Math.hypot(...vectors.vector.subarray(at * 3, at * 3 + 3)) / P.m.at('tolerance', vectors.row[at])); return [vectors.count, vectors.small, Math.min(...least)]; })()",
    );
    assert!(kept[0].as_u64().unwrap() > 0 && kept[1].as_u64().unwrap() > 0, "{kept}");
    assert!(kept[2].as_f64().unwrap() > 0.499, "{kept}");
    browser.assert_quiet();
}

#[test]
fn the_worst_block_is_the_summarys() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    for (machine, name) in
        [("ac-trunnion", "blade.cls"), ("dmu50", "facets.apt"), ("head-head", "blade.cls")]
    {
        let made = made(machine, &sample(name), &["--tool-length", "120"]);
        browser.open(&made.page);
        browser.press("Home");
        let worst = &made.summary["tip_deviation_mm"];
        let from_maxima = browser.ask("P.m.meta.maxima[0]");
        let cl = browser.ask(&format!("P.m.lineOf('cl', {})", from_maxima["row"]));
        assert_eq!(cl, worst["line"], "{machine} {name}");
        let value = from_maxima["value"].as_f64().unwrap();
        let told = worst["value"].as_f64().unwrap();
        assert!(value >= told - 1e-9 && value < told + 1e-4, "{value} against {told}");
        // Of all blocks none deviates more than the one that the page goes to.
        browser.press("x");
        let row = state(&mut browser, "row");
        assert_eq!(row, from_maxima["row"], "{machine} {name}");
        let held = browser
            .ask("P.m.column('deviation')[P.state.row] / P.m.column('tolerance')[P.state.row]");
        let most = browser.ask("Math.max(...P.m.column('deviation').map((value, row) => value / P.m.column('tolerance')[row]))");
        assert_eq!(held, most, "{machine} {name} row {row}");
    }
    browser.assert_quiet();
}

#[test]
fn the_address_leads_to_a_line() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    browser.ask("location.hash = '#nc=100'; new Promise(done => setTimeout(done, 50))");
    assert_eq!(browser.ask("P.m.lineOf('nc', P.state.row)"), 100);
    assert_eq!(
        browser.ask("P.by('nc').querySelector('[aria-selected=true] .at').textContent"),
        "100"
    );
    // One selection everywhere: the CL line, the words at the foot, the machine.
    let cl = browser.ask("P.m.lineOf('cl', P.state.row)");
    assert_eq!(
        browser.ask("Number(P.by('cl').querySelector('[aria-selected=true] .at').textContent)"),
        cl
    );
    let foot = browser.ask("P.by('foot').textContent");
    assert!(foot.as_str().unwrap().contains("NC 100"), "{foot}");
    browser.press("ArrowRight");
    assert_eq!(browser.ask("location.hash"), "#nc=101");
    browser.assert_quiet();
}

#[test]
fn a_click_selects_a_block_within_eight_pixels() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    let rows = browser.ask("P.m.rows").as_u64().unwrap();
    for row in (5..rows).step_by(17) {
        // The middle of the block's last piece, and from there some pixels aside.
        let place = browser.ask(&format!(
            "(() => {{ const [, last] = P.scene.points_of({row}); const m = P.path.matrices().matrix; const p = P.scene.path.pos;
               const at = n => P.camera.pixel(m, p[n * 3], p[n * 3 + 1], p[n * 3 + 2]);
               const [a, b] = [at(last - 1), at(last)]; const box = P.path.canvas.getBoundingClientRect();
               return [(a[0] + b[0]) / 2 + box.left + 4, (a[1] + b[1]) / 2 + box.top - 3]; }})()"
        ));
        let [x, y] = [0, 1].map(|at| place[at].as_f64().unwrap().round());
        browser.ask("P.select(0)");
        browser.click(x, y);
        // By the page's own drawing the chosen block passes the pointer within eight pixels.
        let apart = browser.ask(&format!(
            "(() => {{ const [first, last] = P.scene.points_of(P.state.row); const m = P.path.matrices().matrix; const p = P.scene.path.pos;
               const box = P.path.canvas.getBoundingClientRect(); let best = Infinity;
               for (let n = first; n < last; n++) for (let t = 0; t <= 1; t += 0.01) {{
                 const [x, y] = P.camera.pixel(m, ...[0, 1, 2].map(k => p[n * 3 + k] * (1 - t) + p[n * 3 + 3 + k] * t));
                 best = Math.min(best, Math.hypot(x + box.left - {x}, y + box.top - {y})); }}
               return best; }})()"
        ));
        let apart = apart.as_f64().unwrap();
        assert!(apart <= 8.0, "row {row}: {apart} pixels");
        assert_ne!(state(&mut browser, "row"), 0, "row {row}: nothing was selected");
    }
    browser.ask("P.select(3)");
    // Far from the path nothing is selected.
    let corner = browser.ask("(() => { const box = P.path.canvas.getBoundingClientRect(); return [box.left + 3, box.top + 3]; })()");
    browser.click(corner[0].as_f64().unwrap(), corner[1].as_f64().unwrap());
    assert_eq!(state(&mut browser, "row"), 3);
    browser.assert_quiet();
}

/// A machine of the library.
fn machine(name: &str) -> Machine {
    let find = |name: &str| {
        let text = fs::read_to_string(root().join("machines").join(format!("{name}.toml")));
        text.map(|text| Source { name: name.to_owned(), text })
    };
    load(find(name).unwrap(), &[], &mut |name| find(name).map_err(|error| error.to_string()))
        .unwrap()
}

/// The page's product from the workpiece to the tool against the command's, at the axis values of every block.
#[test]
fn the_chain_is_the_commands_for_every_machine() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let (mut places, mut swapped, mut heads) = (0, 0, 0);
    for row in drawn(LIBRARY.iter().collect(), 4) {
        let file = Path::new("tests/machines").join(format!("{}.{}", row.machine, row.ending));
        let made = made(row.machine, &file, &["--tool-length", &row.length.to_string()]);
        browser.open(&made.page);
        let asked = browser.ask(
            "(() => { const { machine, head_rows } = P.m.meta; const out = [];
               for (let row = 0; row < P.m.rows; row += 1) {
                 const m = P.chain.at(row); const head = (head_rows.findLast(([from]) => from <= row) || [0, 0])[1]; const values = P.chain.values(row, 1); const length = P.chain.length(row);
                 const { tip, axis } = P.chain.forward(m, values, length);
                 out.push({ head, values, length, tip, axis, told: ['tip.x', 'tip.y', 'tip.z'].map(name => P.m.column(name)[row]) });
               } return { out, name: machine.axes.map(axis => axis.name) }; })()",
        );
        let base = machine(row.machine);
        heads += base.heads.len();
        let names: Vec<&str> = base.axes.iter().map(|axis| axis.name.as_str()).collect();
        assert_eq!(asked["name"], json!(names), "{}", row.machine);
        for (index, place) in asked["out"].as_array().unwrap().iter().enumerate() {
            let number = |value: &Value| value.as_f64().unwrap();
            let machine = match place["head"].as_u64().unwrap() {
                0 => &base,
                head => &base.heads[head as usize - 1].machine,
            };
            swapped += u64::from(place["head"] != 0);
            let solver = machine.solver(number(&place["length"])).unwrap();
            let mut joints = Joints::default();
            for (at, axis) in machine.axes.iter().enumerate() {
                joints[at] = number(&place["values"][at]) * axis.unit() - axis.zero;
            }
            // The page draws the chain without the errors of its axes, and is told the tips of a machine that has any.
            let pose = solver.chain().clone().with_errors(&[].into()).forward(&joints);
            let derived = !machine.errs();
            for at in 0..3 {
                // Axes or tip are derived by the page: together they are what the command has told.
                let told = (number(&place["told"][at]) - pose.tip[at]).abs();
                assert!(!derived || told < 2e-4, "{} block {}: {told} mm", row.machine, index + 1);
                let tip = (number(&place["tip"][at]) - pose.tip[at]).abs();
                assert!(tip < 1e-6, "{} block {}: {tip} mm", row.machine, index + 1);
                let axis = (number(&place["axis"][at]) - pose.axis[at]).abs();
                assert!(axis < 1e-9, "{} block {}: {axis}", row.machine, index + 1);
            }
            places += 1;
        }
        drop(made.folder);
    }
    assert!(places > 1000 || !all_drawn(), "{places}");
    assert!(heads == 0 || swapped > 5, "{swapped} blocks with another head");
    browser.assert_quiet();
}

/// Places between the ends of the blocks are packed against the chain, deviations against them: both are those of Rust's chain.
#[test]
fn places_on_the_way_are_those_of_the_chain() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    for (name, more) in [
        ("ac-trunnion", &["--tcp", "post"][..]),
        ("head-head", &["--tcp", "post"]),
        ("dmu50", &["--tcp", "post", "--verify"]),
    ] {
        let arguments = [&["--tool-length", "120"], more].concat();
        let made = made(name, &sample("blade.cls"), &arguments);
        browser.open(&made.page);
        let asked = browser.ask(
            "(() => { const out = []; const { path, centre, vectors } = P.scene; const at = n => [0, 1, 2].map(k => path.pos[n * 3 + k] + centre[k]);
               const values = row => P.m.meta.machine.axes.map(({ name }) => P.m.column(`q.${name}`)[row]);
               for (let n = 1; n + 1 < path.count; n++) { const row = path.look[n * 4 + 2];
                 if (row > 0 && path.look[n * 4 - 2] !== row && path.look[n * 4 + 6] === row && path.look[n * 4 + 10] !== row)
                   out.push({ from: values(row - 1), to: values(row), place: at(n), length: P.chain.length(row) }); }
               const feet = Array.from({ length: vectors.count }, (_, n) => { const row = vectors.row[n];
                 const [last] = P.scene.points_of(row); const end = P.scene.points_of(row)[1];
                 return { foot: [0, 1, 2].map(k => vectors.foot[n * 3 + k] + centre[k]), vector: [...vectors.vector.slice(n * 3, n * 3 + 3)], from: at(last), to: at(end), deviation: P.m.column('deviation')[row] }; });
               return { out, feet }; })()",
        );
        let machine = machine(name);
        let number = |value: &Value| value.as_f64().unwrap();
        let vector = |value: &Value| Vector3::from_fn(|at, _| number(&value[at]));
        let places = asked["out"].as_array().unwrap();
        assert!(places.len() > 20, "{name}: {}", places.len());
        for place in places {
            let solver = machine.solver(number(&place["length"])).unwrap();
            let mut half = Joints::default();
            for (at, axis) in machine.axes.iter().enumerate() {
                let mean = 0.5 * (number(&place["from"][at]) + number(&place["to"][at]));
                half[at] = mean * axis.unit() - axis.zero;
            }
            let far = (solver.chain().forward(&half).tip - vector(&place["place"])).norm();
            assert!(far < 2e-4, "{name}: {far} mm at {place}");
        }
        // The CL path is straight between its points: there a vector stands on the way from tip to tip, as long as it may be.
        // Vectors are kept to the micrometre.
        let kept = 1.2e-3;
        let mut longest: f64 = 0.0;
        let feet = asked["feet"].as_array().unwrap();
        assert!(feet.len() > 20, "{name}: {}", feet.len());
        for told in feet {
            let [foot, from, to] = ["foot", "from", "to"].map(|key| vector(&told[key]));
            let way = (to - from).normalize();
            let off = (foot - from) - way * (foot - from).dot(&way);
            assert!(off.norm() < kept, "{name}: {} mm: {told}", off.norm());
            let size = vector(&told["vector"]).norm();
            assert!(size < number(&told["deviation"]) + kept, "{name}: {told}");
            longest = longest.max(size);
        }
        assert!(longest > 3.0 * kept, "{name}: {longest}");
    }
    browser.assert_quiet();
}

/// The lines of a text of the page.
fn lines(browser: &mut Browser, name: &str) -> Vec<String> {
    let told = browser.ask(&format!(
        "(() => {{ const text = P.m.report.texts.{name}; return Array.from({{ length: text.lines }}, (_, at) => text.line(at)); }})()"
    ));
    serde_json::from_value(told).unwrap()
}

#[test]
fn the_texts_are_the_files() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    for (machine, name) in [("ac-trunnion", "blade.cls"), ("vmc", "plate.ncl")] {
        let made = made(machine, &sample(name), &["--tool-length", "0"]);
        browser.open(&made.page);
        let cl = fs::read_to_string(root().join(sample(name))).unwrap();
        assert_eq!(lines(&mut browser, "cl"), cl.lines().collect::<Vec<_>>());
        let nc = fs::read_to_string(&made.nc).unwrap();
        assert_eq!(lines(&mut browser, "nc"), nc.lines().collect::<Vec<_>>());
    }
    browser.assert_quiet();
}

#[test]
fn hostile_texts_stay_text() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let hostile = "</script><img src=x onerror=alert(1)><b>";
    let name = "a<img src=x onerror=alert(2)>b.cls";
    let text = format!(
        "PARTNO/{hostile}\n$$ {hostile}\nUNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nPPRINT/{hostile}\nFEDRAT/100,MMPM\nGOTO/0,0,50\nGOTO/20,0,50\n$$ <!-- <script>\nFINI\n"
    );
    let file = folder.path().join(name);
    fs::write(&file, &text).unwrap();
    let made = made("vmc", &file, &["--tool-length", "0"]);
    browser.open(&made.page);
    assert_eq!(lines(&mut browser, "cl"), text.lines().collect::<Vec<_>>());
    assert_eq!(browser.ask("document.querySelectorAll('img, b b, iframe, object').length"), 0);
    assert_eq!(browser.ask("document.querySelectorAll('script').length"), 1);
    let shown = browser.ask("P.by('cl').textContent");
    assert!(shown.as_str().unwrap().contains(hostile), "{shown}");
    browser.assert_quiet();
}

/// What holds before a key, the key, and what must hold after it.
const KEYS: &[(&str, &str, &str)] = &[
    ("P.select(40)", "ArrowLeft", "P.state.row === 39"),
    ("P.select(40)", "ArrowRight", "P.state.row === 41"),
    ("P.select(150)", "Shift+ArrowLeft", "P.state.row === 50"),
    ("P.select(40)", "Shift+ArrowRight", "P.state.row === 140"),
    ("P.select(40)", "Home", "P.state.row === 0"),
    ("P.select(40)", "End", "P.state.row === P.m.rows - 1"),
    (
        "window.before = P.worth()(40); P.select(40)",
        "w",
        "P.worth()(P.state.row) >= before && P.state.row !== 40",
    ),
    (
        "window.before = P.worth()(40); P.select(40)",
        "W",
        "P.worth()(P.state.row) <= before && P.state.row !== 40",
    ),
    ("P.select(40)", "x", "P.state.row === P.worst()"),
    (
        "P.select(0); P.scene.marks = [...P.scene.marks, { row: 70, kind: 'stop', text: 'stop', point: 1 }]",
        "e",
        "P.state.row === 70",
    ),
    (
        "P.select(P.m.rows - 1); window.mark = P.scene.marks.findLast(mark => mark.row < P.m.rows - 1)",
        "E",
        "P.state.row === mark.row",
    ),
    ("P.set({ colour: 0 })", "c", "P.state.colour === 1"),
    ("P.set({ colour: 0 })", "C", "P.state.colour === P.colour.modes.length - 1"),
    (
        "P.set({ hidden: [] }); P.select(40)",
        "h",
        "P.state.hidden.length === 1 && P.scene.hides(40)",
    ),
    ("P.set({ hidden: [0] })", "H", "P.state.hidden.length === 0 && !P.scene.hides(40)"),
    ("P.set({ measuring: false })", "r", "P.state.measuring && !P.measure.told.hidden"),
    (
        "P.set({ measuring: false }); P.select(40)",
        "R",
        "P.measure.points.length === 1 && P.measure.points[0].row === 40",
    ),
    ("P.set({ machine: false })", "m", "P.state.machine === true"),
    ("P.set({ frame: 'part' })", "f", "P.state.frame === 'machine'"),
    ("P.set({ playing: false })", " ", "P.state.playing === true"),
    ("P.set({ playing: false, speed: 10 })", "<", "P.state.speed === 5"),
    ("P.set({ speed: 10 })", ">", "P.state.speed === 25"),
    ("P.set({ by: 'time' })", "b", "P.state.by === 'block'"),
    (
        "P.by('nc').querySelector('.lines').focus()",
        "/",
        "document.activeElement === P.texts.panes.nc.find",
    ),
    (
        "P.by('cl').querySelector('.lines').focus()",
        "g",
        "document.activeElement === P.texts.panes.cl.go",
    ),
    ("", "1", "P.by('verdict').contains(document.activeElement)"),
    ("", "2", "P.by('path').contains(document.activeElement)"),
    ("", "3", "P.by('nc').contains(document.activeElement)"),
    ("", "4", "P.by('cl').contains(document.activeElement)"),
    ("", "5", "P.by('charts').contains(document.activeElement)"),
    ("", "6", "P.by('spread').contains(document.activeElement) && P.by('spread').clientHeight > 0"),
    ("", "7", "P.by('table').contains(document.activeElement) && P.by('table').clientHeight > 0"),
    ("P.set({ chart: 0 })", "q", "P.state.chart === 1"),
    ("P.select(40)", "[", "String(P.state.brush) === '40,' + (P.m.rows - 1)"),
    ("P.set({ brush: null }); P.select(40)", "]", "String(P.state.brush) === '0,40'"),
    ("P.set({ scale: 100 })", "d", "P.state.scale === 1000"),
    ("P.set({ scale: 100 })", "D", "P.state.scale === 10"),
    ("P.path.look(0)", "v", "P.camera.looked === 1 && P.camera.tilt > 1.5"),
    ("window.before = P.camera.span", "+", "P.camera.span < before"),
    ("window.before = P.camera.span", "-", "P.camera.span > before"),
    ("P.path.look(0); window.before = P.camera.tilt", "i", "P.camera.tilt > before"),
    ("window.before = P.camera.tilt", "k", "P.camera.tilt < before"),
    ("window.before = P.camera.turn", "j", "P.camera.turn > before"),
    ("window.before = P.camera.turn", "l", "P.camera.turn < before"),
    ("P.camera.span = 7", "0", "P.camera.span !== 7"),
    (
        "delete document.documentElement.dataset.theme",
        "t",
        "document.documentElement.dataset.theme === 'light'",
    ),
    ("P.set({ brush: [3, 5] })", "Escape", "P.state.brush === null"),
    ("", "?", "P.by('help').open"),
];

#[test]
fn every_key_does_what_the_help_says() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    let told: Vec<String> =
        serde_json::from_value(browser.ask("P.keys.list.flatMap(({ keys }) => keys)")).unwrap();
    for key in &told {
        assert!(KEYS.iter().any(|(_, known, _)| known == key), "no test presses {key:?}");
    }
    let settle = "P.set({ playing: false, brush: null }); delete P.by('views').dataset.solo; if (document.activeElement) document.activeElement.blur();";
    for (before, key, after) in KEYS {
        assert!(told.iter().any(|known| known == key), "the help does not tell {key:?}");
        browser.ask(&format!("{settle} {before}; 0"));
        let held = !before.is_empty() && browser.ask(after) == true;
        assert!(!held, "{key:?} has nothing to do");
        browser.press(key);
        assert_eq!(browser.ask(after), true, "{key:?}: {after}");
    }
    // In the help every key stands; Esc closes it, and the keys are keys again.
    let help = browser.ask("P.by('help').querySelectorAll('dt').length");
    assert_eq!(help, browser.ask("P.keys.list.length"));
    browser.ask("P.by('help').close()");
    // Where something is typed, letters are letters.
    browser.press("/");
    browser.press("w");
    browser.press("x");
    assert_eq!(browser.ask("P.keys.pane().find.value"), "wx");
    browser.assert_quiet();
}

#[test]
fn a_view_stands_alone_when_it_is_asked_for_again() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    for (at, name) in
        ["verdict", "path", "nc", "cl", "charts", "spread", "table"].iter().enumerate()
    {
        let key = (at + 1).to_string();
        for (solo, seen) in [(Value::Null, true), (json!(name), false), (Value::Null, true)] {
            browser.press(&key);
            assert_eq!(browser.ask("P.by('views').dataset.solo || null"), solo, "{name}");
            let other = if *name == "verdict" { "path" } else { "verdict" };
            assert_eq!(browser.ask(&format!("P.by('{other}').clientHeight > 0")), seen, "{name}");
        }
    }
    browser.assert_quiet();
}

#[test]
fn what_is_looked_for_is_found_and_told_when_it_is_not() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    let program = fs::read_to_string(&made.nc).unwrap();
    assert!(program.contains("M5"), "{program}");
    browser.ask("P.by('nc').querySelector('.lines').focus()");
    browser.press("/");
    for key in ["M", "5", "Enter"] {
        browser.press(key);
    }
    let at =
        browser.ask("Number(P.by('nc').querySelector('[aria-selected=true] .at').textContent)");
    let found = program.lines().nth(at.as_u64().unwrap() as usize - 1).unwrap();
    assert!(found.contains("M5"), "line {at}: {found}");
    browser.ask("P.texts.find(P.texts.panes.nc, 'no such words', false, P.by('nc').querySelector('output'))");
    assert_eq!(browser.ask("P.by('nc').querySelector('output').textContent"), "not found");
    browser.assert_quiet();
}

#[test]
fn the_same_page_looks_the_same() {
    let made = blade();
    let mut pictures = Vec::new();
    for _ in 0..2 {
        let Some(mut browser) = Browser::start() else {
            return;
        };
        browser.open(&made.page);
        browser.press("x");
        browser.press("m");
        browser.frames();
        pictures.push(browser.picture());
        browser.press("c");
        browser.frames();
        assert_ne!(pictures.last(), Some(&browser.picture()), "the colour changes nothing");
        browser.assert_quiet();
    }
    assert!(pictures[0] == pictures[1], "two runs differ in their pixels");
}

#[test]
fn a_lost_context_comes_back() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    browser.frames();
    assert_eq!(browser.ask("P.path.renderer.kind"), "WebGL2");
    let before = browser.picture();
    browser.ask("window.lose = P.path.renderer.gl.getExtension('WEBGL_lose_context'); lose.loseContext(); 0");
    browser.frames();
    assert_eq!(browser.ask("P.path.renderer.lost()"), true);
    browser.ask("lose.restoreContext(); 0");
    browser.frames();
    assert_eq!(browser.ask("P.path.renderer.lost()"), false);
    assert!(browser.picture() == before, "not what it was");
    assert!(browser.ask("P.path.drawn.vertices").as_u64().unwrap() > 100);
}

#[test]
fn less_is_drawn_where_less_can_be() {
    let made = blade();
    for (gone, kind) in [("['webgl2']", json!("Canvas2D")), ("['webgl2', '2d']", Value::Null)] {
        let Some(mut browser) = Browser::start() else {
            return;
        };
        // Contexts of canvases in the page, not of the one that looks colours up.
        let source = format!(
            "const given = HTMLCanvasElement.prototype.getContext;
             HTMLCanvasElement.prototype.getContext = function (kind, ...more) {{
               return this.closest('.stage') && !this.classList.contains('over') && {gone}.includes(kind) ? null : given.call(this, kind, ...more); }};"
        );
        browser.send("Page.addScriptToEvaluateOnNewDocument", &json!({"source": source}));
        browser.open(&made.page);
        assert_eq!(browser.ask("P.path.renderer ? P.path.renderer.kind : null"), kind);
        assert_eq!(browser.ask("P.path.notice.hidden"), false);
        if kind.is_null() {
            assert_eq!(browser.ask("P.by('views').dataset.lower"), "table");
        } else {
            assert!(browser.ask("P.path.drawn.vertices").as_u64().unwrap() > 100);
        }
        for key in ["x", "ArrowRight", "c", "m", "f", "v", "0", "6", "7", "t"] {
            browser.press(key);
        }
        browser.assert_quiet();
    }
}

/// Lightness by OKLab, and as eyes without one kind of cones see it (Machado 2009).
const LIGHTNESS: &str = "(() => {
  const linear = v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  const eyes = [[1,0,0,0,1,0,0,0,1], [0.152286,1.052583,-0.204868,0.114503,0.786281,0.099216,-0.003882,-0.048116,1.051998],
    [0.367322,0.860646,-0.227968,0.280085,0.672501,0.047413,-0.011820,0.042940,0.968881],
    [1.255528,-0.076749,-0.178779,-0.078411,0.930809,0.147602,0.004733,0.691367,0.303900]];
  const light = (rgb, e) => { const c = rgb.map(linear); const [r, g, b] = [0, 1, 2].map(k => Math.max(0, e[k*3]*c[0] + e[k*3+1]*c[1] + e[k*3+2]*c[2]));
    const l = Math.cbrt(0.4122214708*r + 0.5363325363*g + 0.0514459929*b), m = Math.cbrt(0.2119034982*r + 0.6806995451*g + 0.1073969566*b), s = Math.cbrt(0.0883024619*r + 0.2817188376*g + 0.6299787005*b);
    return 0.2104542553*l + 0.7936177850*m - 0.0040720468*s; };
  return [false, true].map(dark => eyes.map(e => Array.from({ length: 256 }, (_, at) => light(P.colour.scale(at, dark), e)))); })()";

#[test]
fn the_lightness_of_the_scale_rises_or_falls_alone() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    let scales: Vec<Vec<Vec<f64>>> = serde_json::from_value(browser.ask(LIGHTNESS)).unwrap();
    for (dark, eyes) in scales.iter().enumerate() {
        let sign = if dark == 1 { 1.0 } else { -1.0 };
        for (eye, scale) in eyes.iter().enumerate() {
            for (at, pair) in scale.windows(2).enumerate() {
                assert!(
                    (pair[1] - pair[0]) * sign > -1e-3,
                    "dark {dark} eyes {eye} at {at}: {pair:?}"
                );
            }
            assert!((scale[191] - scale[0]).abs() > 0.15, "dark {dark} eyes {eye}");
        }
    }
}

/// Contrast of what is read, by WCAG 2.2, in both themes.
#[test]
fn text_is_readable_and_everything_has_a_name() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    browser.open(&made.page);
    for theme in ["light", "dark"] {
        browser
            .ask(&format!("document.documentElement.dataset.theme = '{theme}'; P.views.repaint()"));
        let pairs = browser.ask(
            "(() => { const linear = v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
               const luma = name => { const c = P.colour.of(name).rgb.map(linear); return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
               const ratio = (a, b) => { const [x, y] = [luma(a), luma(b)]; return (Math.max(x, y) + 0.05) / (Math.min(x, y) + 0.05); };
               return [['text','panel'],['quiet','panel'],['quiet','raised'],['accent','panel'],['on-accent','accent'],['good','good-ground'],['warn','warn-ground'],['bad','bad-ground'],['bad','panel'],
                 ['quiet','warn-ground'],['text','chosen'],['word','panel'],['number','panel'],['remark','panel'],['word','chosen'],['number','chosen'],['remark','chosen']].map(pair => [pair.join(' on '), ratio(...pair)]); })()",
        );
        for pair in pairs.as_array().unwrap() {
            assert!(pair[1].as_f64().unwrap() >= 4.5, "{theme}: {pair}");
        }
    }
    let nameless = browser.ask(
        "[...document.querySelectorAll('button, input, select, [role=listbox], [role=grid], canvas[role], section')].filter(one => !(one.getAttribute('aria-label') || one.textContent.trim() || (one.getAttribute('aria-labelledby') && P.by(one.getAttribute('aria-labelledby'))))).map(one => one.outerHTML)",
    );
    assert_eq!(nameless, json!([]));
    let small = browser.ask(
        "[...document.querySelectorAll('button, input, select')].filter(one => one.clientHeight && one.getBoundingClientRect().height < 24 && !one.closest('p')).map(one => one.outerHTML)",
    );
    assert_eq!(small, json!([]));
}

/// A moving frame draws a bounded part, whatever the program's length.
#[test]
fn a_moving_frame_is_small() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made =
        made("ac-trunnion", &sample("s-piece.cls"), &["--tcp", "control", "--tool-length", "0"]);
    browser.open(&made.page);
    browser.press("m");
    browser.ask("P.path.draw(true)");
    let drawn = browser.ask("P.path.drawn");
    assert!(drawn["draws"].as_u64().unwrap() <= 40, "{drawn}");
    assert!(drawn["vertices"].as_u64().unwrap() <= 60_000, "{drawn}");
    // The same of a million points, kinds of block in turn.
    let kept = browser.ask(
        "(() => { const count = 1e6, values = Float64Array.from({ length: count }, (_, at) => Math.sin(at));
           const line = P.scene.line(count, values, values, values, at => at, at => at % 7 ? 0 : 1);
           return P.scene.thin(line, P.scene.budget.path).count * 4 + P.scene.thin(line, P.scene.budget.cl).count + P.scene.budget.vectors * 4; })()",
    );
    let machine = browser.ask("P.parts.made.faces.length / 8 + P.parts.made.edges.length / 4 + P.parts.made.boxes.length / 4");
    let all = kept.as_f64().unwrap() + machine.as_f64().unwrap();
    assert!(all <= 60_000.0, "{all}");
    browser.assert_quiet();
}

#[test]
fn the_page_is_small_and_its_files_too() {
    let folder = root().join("core/report/page");
    let order = fs::read_to_string(folder.join("order.txt")).unwrap();
    for entry in fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if !name.ends_with(".js") {
            continue;
        }
        assert!(order.lines().any(|line| line == name), "{name} is not in order.txt");
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.lines().count() < 400, "{name} is long");
        for word in [
            "innerHTML",
            "outerHTML",
            "insertAdjacent",
            "document.write",
            "eval(",
            "fetch(",
            "http:",
            "https:",
        ] {
            let own = word == "http:"
                && text.matches(word).count() == text.matches("http://www.w3.org/2000/svg").count();
            assert!(own || !text.contains(word), "{name} has {word}");
        }
    }
    // What a report carries besides its data.
    let made = blade();
    let page = fs::read_to_string(&made.page).unwrap();
    let between = |from: &str, to: &str| {
        let from = page.rfind(from).unwrap() + from.len();
        page[from..].find(to).unwrap()
    };
    let all = between("<style>", "</style>") + between("<script>", "</script>");
    assert!(all <= 137_000, "{all} bytes");
}

/// Every far line is there at once: what is unpacked for it is a chunk of each text and of each column that is shown, whatever
/// the length of the program.
#[test]
fn a_far_selection_unpacks_what_it_shows_alone() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut text = Vec::new();
    generate::write_file(&mut text, 60_000).unwrap();
    let file = folder.path().join("wave.cls");
    fs::write(&file, text).unwrap();
    let made = made("ac-trunnion", &file, &["--tcp", "control"]);
    browser.open(&made.page);
    let work = browser.ask(
        "(() => { P.select(5);
           const { inflate, integers } = P;
           let bytes, values;
           P.inflate = (...given) => { const made = inflate(...given); bytes += made.length; return made; };
           P.integers = (...given) => { values += given[2]; return integers(...given); };
           const work = [];
           for (let at = 1; at <= 15; at++) { bytes = values = 0; P.select((at * 27017) % P.m.rows); work.push([bytes, values]); }
           Object.assign(P, { inflate, integers });
           return { work, rows: P.m.rows }; })()",
    );
    let most = |at: usize| {
        work["work"].as_array().unwrap().iter().map(|one| one[at].as_u64().unwrap()).max().unwrap()
    };
    let (bytes, values) = (most(0), most(1));
    assert!(bytes > 0 && values > 0, "{work}");
    // Sixteen thousand rows of a column go together, of sixty thousand.
    assert!(bytes <= 150_000 && values <= 30 * 16_384, "{work}");
    browser.assert_quiet();
}

/// What assistive technology is told, by the browser itself.
#[test]
fn the_accessibility_tree_names_everything() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = made("ac-trunnion", &sample("blade.cls"), &["--tool-length", "0", "--predict"]);
    browser.open(&made.page);
    browser.press("ArrowRight");
    browser.press("7");
    browser.frames();
    let tree = browser.send("Accessibility.getFullAXTree", &json!({}));
    let mut seen = BTreeMap::new();
    for node in tree["nodes"].as_array().unwrap() {
        if node["ignored"] == true {
            continue;
        }
        let role = node["role"]["value"].as_str().unwrap_or_default();
        let name = node["name"]["value"].as_str().unwrap_or_default().trim();
        *seen.entry(role.to_owned()).or_insert(0) += 1;
        let asked = [
            "button",
            "combobox",
            "grid",
            "image",
            "img",
            "listbox",
            "option",
            "region",
            "slider",
            "tab",
            "tablist",
            "textbox",
            "dialog",
            "navigation",
        ];
        assert!(!asked.contains(&role) || !name.is_empty(), "{node}");
    }
    for (role, least) in [
        ("button", 20),
        ("combobox", 3),
        ("grid", 1),
        ("listbox", 2),
        ("region", 5),
        ("slider", 2),
        ("textbox", 4),
    ] {
        let count = seen.get(role).copied().unwrap_or(0);
        assert!(count >= least, "{role}: {count} of {least}, {seen:?}");
    }
    // What is selected is told as it changes.
    let told = tree["nodes"].as_array().unwrap().iter().find(|node| {
        let live = node["properties"].as_array();
        node["role"]["value"] == "status"
            && live.is_some_and(|all| {
                all.iter().any(|one| one["name"] == "live" && one["value"]["value"] == "polite")
            })
    });
    let told = told.expect("a region tells the selection");
    let id = &told["backendDOMNodeId"];
    let node = browser.send("DOM.resolveNode", &json!({"backendNodeId": id}));
    let text = browser.send(
        "Runtime.callFunctionOn",
        &json!({"objectId": node["object"]["objectId"], "functionDeclaration": "function () { return this.textContent; }"}),
    );
    let row = browser.ask("P.state.row").as_u64().unwrap() + 1;
    let text = text["result"]["value"].as_str().unwrap();
    assert!(text.starts_with(&format!("Block {row}")), "{text}");
    browser.assert_quiet();
}

#[test]
fn what_is_predicted_is_drawn_over_time() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = made("ac-trunnion", &sample("blade.cls"), &["--tool-length", "0", "--predict"]);
    browser.open(&made.page);
    let titles = browser.ask("P.charts.groups.map(({ title }) => title)");
    for title in ["Velocities", "Accelerations", "Prediction"] {
        assert!(titles.as_array().unwrap().contains(&json!(title)), "{titles}");
    }
    browser.ask("P.set({ chart: P.charts.groups.findIndex(({ title }) => title === 'Prediction') }); P.charts.range(0, 1)");
    browser.frames();
    // The lanes are those of the set-points; none is lost between the pixels.
    let [lanes, rows, largest, drawn] = [
        "P.charts.places.map(({ lane }) => lane.get().length)",
        "P.m.report.tables.series.rows",
        "P.largest(P.m.report.tables.series.columns.get('contour').values)",
        "(() => { const { lane } = P.charts.places[0]; const rows = Int32Array.from({ length: Math.floor(P.charts.room()) + 1 }, (_, x) => P.charts.index(lane, P.charts.left + x)); return P.lane.spans(lane.get(), rows).most; })()",
    ]
    .map(|ask| browser.ask(ask));
    assert_eq!(lanes, json!([rows, rows]));
    assert!(rows.as_u64().unwrap() > 1000, "{rows}");
    assert_eq!(largest, drawn);
    assert!(largest.as_f64().unwrap() > 0.0);
    // A click on the peak goes to the block that has it.
    browser.ask("(() => { const { series } = P.m.report.tables; const values = series.columns.get('contour').values; const at = values.indexOf(P.largest(values)); P.charts.click(P.charts.x_of(series.columns.get('t').values[at])); })()");
    assert_eq!(browser.ask("P.m.column('contour')[P.state.row]"), largest, "the block of the peak");
    browser.press("b");
    browser.frames();
    browser.assert_quiet();
}

#[test]
fn two_programs_are_followed_line_by_line() {
    let Some(mut browser) = Browser::start() else {
        return;
    };
    let made = blade();
    let page = made.folder.path().join("diff.html");
    let other = made.folder.path().join("other.nc");
    let text = fs::read_to_string(&made.nc).unwrap();
    // The new program has lines more at its head, and its path is a little off in one place.
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let place = lines.len() / 2;
    let word = lines[place].split(' ').find(|word| word.starts_with('Y'));
    let word = word.unwrap().to_owned();
    let moved: f64 = word[1..].parse::<f64>().unwrap() + 0.25;
    lines[place] = lines[place].replace(&word, &format!("Y{moved:.3}"));
    lines.insert(2, "(one)".to_owned());
    lines.insert(3, "(two)".to_owned());
    fs::write(&other, lines.join("\n") + "\n").unwrap();
    let [nc, other, page] = [&made.nc, &other, &page].map(|path| path.to_str().unwrap());
    let run = post(&[
        "diff",
        nc,
        other,
        "--machine",
        "ac-trunnion",
        "--tool-length",
        "0",
        "--report",
        page,
    ]);
    assert_eq!(run.code, 1, "{}", run.err);
    browser.open(Path::new(page));
    // The same lines, two farther down.
    let far = browser.ask(
        "(() => { const [now, old] = ['nc', 'nc2'].map(P.m.column); let wrong = 0; let told = 0; for (let row = 0; row < P.m.rows; row++) if (old[row]) { told++; wrong += now[row] !== old[row] + 2; } return [told, wrong, P.m.rows]; })()",
    );
    let [told, wrong, rows] = [0, 1, 2].map(|at| far[at].as_u64().unwrap());
    assert!(told * 10 >= rows * 9 && wrong * 50 <= told, "{far}");
    let line = place + 3;
    browser.ask(&format!("P.select_line('nc', {})", line - 1));
    assert_eq!(
        browser.ask("Number(P.by('cl').querySelector('[aria-selected=true] .at').textContent)"),
        line - 2
    );
    browser.ask(&format!("P.select_line('nc2', {})", line - 3));
    assert_eq!(browser.ask("P.m.lineOf('nc', P.state.row)"), line);
    // The page begins where the programs are farthest apart.
    browser.ask("P.select(0); location.hash = ''");
    browser.open(Path::new(page));
    let begun = browser.ask("P.m.lineOf('nc', P.state.row)");
    assert_eq!(begun, browser.ask("P.m.meta.maxima[0].nc"));
    // Where the paths are apart a vector says by how much.
    let longest = browser.ask("(() => { const { vector } = P.scene.vectors; let most = 0; for (let at = 0; at < vector.length; at += 3) most = Math.max(most, Math.hypot(...vector.subarray(at, at + 3))); return most; })()");
    let longest = longest.as_f64().unwrap();
    assert!(longest > 0.1 && longest <= 0.26, "{longest}");
    browser.assert_quiet();
}
