"""``post clearance`` held against samples: random machines, bodies and programs, and hits that are planted.

Distances are those of python-fcl. Numbers are drawn anew each time: ``POST_SEED=N`` draws those of an earlier run
again, and ``POST_ROUNDS=N`` takes 3N times as many.
"""

import csv
import io
import math
import re
import subprocess
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import CHECKOUT, COMMAND, drawn, rounds

pytest.importorskip("fcl", reason="python-fcl is not installed: post clearance is held against no other library")
pytest.importorskip("tomllib", reason="Python 3.11 reads machine files")

from oracle.bodies import Body, bodies, pairs, tool_bodies  # noqa: E402
from oracle.distance import Poses  # noqa: E402
from oracle.machine import Machine  # noqa: E402
from oracle.program import Motion, motions  # noqa: E402
from oracle.worlds import World, shown, world  # noqa: E402

LIBRARY = CHECKOUT / "machines"
SHARES = np.linspace(0, 1, 33)
ROUNDING = 0.0005 + 1e-6
"""What the table's last digit leaves, mm."""
WITHIN = 0.01
"""What the proof cannot tell apart, mm."""


class Proven:
    """What the command says of a program: the table, by pairs of names in their order, and the faults."""

    def __init__(self, folder: Path, machine: str = "m.toml", *more: str) -> None:
        words = [COMMAND, "clearance", "p.nc", "-m", machine, *more]
        run = subprocess.run(words, cwd=folder, capture_output=True, text=True)
        assert run.returncode in (0, 1), run.stderr
        self.said, self.clear = run.stdout + run.stderr, run.returncode == 0
        self.refused = re.findall(r"error\[(?!clearance\])[^\n]*", run.stderr)
        found = re.search(r"^motions +(\d+)", run.stdout, re.M)
        self.motions = int(found[1]) if found else 0
        # clear by, nearest, its line, motions that are not clear
        self.rows: dict[tuple[str, ...], tuple[float, float, int, int]] = {}
        for line in run.stdout.splitlines():
            cells = re.split(r"\s{2,}", line.strip())
            if len(cells) == 6 and re.fullmatch(r"[\d.]+|-", cells[2]):
                far = [math.inf if cell == "-" else float(cell) for cell in cells[2:4]]
                counts = [0 if cell == "-" else int(cell) for cell in cells[4:]]
                self.rows[tuple(sorted(cells[:2]))] = (far[0], far[1], counts[0], counts[1])

    def faults(self) -> Iterator[tuple[tuple[str, ...], str, dict[str, float], int]]:
        """Of each fault at a pose: the pair, what is said of it, the axis values, the line."""
        text = r"error\[clearance\]: (?:that )?(.*?) (hits|comes within|stays clear of) (?:([\d.]+) mm of )?(.*?)"
        text += r"(?:;.*?| is not proven.*?)? at ((?:[A-Z] -?[\d.]+ ?)+), on .*\n *--> [^:]*:(\d+)"
        for one, verdict, near, other, pose, line in re.findall(text, self.said):
            values = {word: float(value) for word, value in re.findall(r"([A-Z]) (-?[\d.]+)", pose)}
            yield tuple(sorted((one, other))), f"{verdict} {near}".strip(), values, int(line)


def named(pairs: list[tuple[Body, Body]]) -> dict[tuple[str, ...], tuple[Body, Body]]:
    """Pairs by their names in order."""
    return {tuple(sorted((one.name, other.name))): (one, other) for one, other in pairs}


def at_pose(machine: Machine, pair: tuple[Body, Body], values: dict[str, float]) -> float:
    """How far two bodies are apart where the control shows these values."""
    q = np.array([[float(axis.value(values[axis.name])) for axis in machine.axes]])
    return Poses.of(machine, *pair, q).nearest()[0]


def samples(rng: np.random.Generator, motion: Motion) -> np.ndarray:
    """Axis values on a motion; of axes that go for themselves corners of the box and points in it too."""
    found = [motion.at(SHARES)]
    if motion.boxed:
        first, last = motion.ends
        corners = rng.integers(0, 2, (32, len(first)))
        inside = rng.uniform(size=(60, len(first)))
        found.append(first + (last - first) * np.vstack([corners, inside]))
    return np.vstack(found)


class Judge:
    """Holds what is proven of a program against samples of its blocks."""

    def __init__(self, rng: np.random.Generator, made: World, count: Counter) -> None:
        self.made, self.count = made, count
        self.motions = list(motions(made.machine, made.text, made.lengths))
        # Where the machine stands before the first block leads it nobody says: of that block the end alone is looked at.
        found = [samples(rng, motion) if place else motion.at(SHARES[-1:]) for place, motion in enumerate(self.motions)]
        self.ends = np.cumsum([0] + [len(rows) for rows in found])
        self.q = np.vstack(found)
        self.all = bodies(made.machine) + tool_bodies(made.machine, 1, made.length)
        self.places: dict = {}

    def keep(self, pair: tuple[Body, Body], motion: Motion) -> float | None:
        """What is to be kept on a motion; none where the pair is not looked at, or need not be."""
        kinds = {body.kind for body in pair}
        if motion.tool is None and kinds & {"holder", "cutter"}:
            return None
        if kinds == {"cutter", "stock"}:
            return None if not motion.rapid or motion.withdraws else 0.0
        return self.made.rapid if motion.rapid else self.made.keep

    def pair(self, pair: tuple[Body, Body], row: tuple[float, float, int, int]) -> None:
        """A pair: no bound is more than a sample, and no motion clear on which a sample is not."""
        one, other = pair
        poses = Poses.of(self.made.machine, one, other, self.q, self.places)
        clear_by, nearest, _, faults = row
        error = one.error + other.error
        kept = {place: self.keep(pair, motion) for place, motion in enumerate(self.motions)}
        looked = {place: keep for place, keep in kept.items() if keep is not None}
        if not looked:
            return
        below, close = 0, 0
        for place, keep in looked.items():
            own = np.arange(self.ends[place], self.ends[place + 1])
            # Neither meshes that are a little too thin, nor what two per cent of a distance leave, is a fault of ours.
            found, _ = poses.nearest(own, keep / 0.98 + 2 * WITHIN + error)
            below += found < keep or found == 0
            close += found < keep / 0.98 + 2 * WITHIN + error
        self.count["blocks"] += len(looked)
        self.count["blocks that are not clear"] += below
        told = f"{one.name} {other.name} {row}: {below} blocks are not clear\n{self.made.text}"
        assert below <= faults, told
        if faults > close and not any(motion.boxed or motion.curved for motion in self.motions):
            self.count["refused without need"] += faults - close
        if faults:
            return
        everywhere = np.concatenate([np.arange(self.ends[place], self.ends[place + 1]) for place in looked])
        tight = (clear_by + WITHIN + error) / 0.95
        found, where = poses.nearest(everywhere, clear_by - ROUNDING, tight)
        assert found >= clear_by - ROUNDING, f"{found} {told}"
        if not any(motion.boxed for motion in self.motions):
            self.count["pairs"] += 1
            # What was found at a pose is no less than the truth, which lies between samples.
            self.count["pairs that are tight"] += min(poses.known[where], nearest + ROUNDING) <= tight + ROUNDING

    def judge(self, proven: Proven) -> None:
        """All pairs, and the poses that are told."""
        assert proven.motions == len(self.motions), f"{proven.said}\n{self.made.text}"
        by_names = named(pairs(self.made.machine, self.all))
        assert set(by_names) == set(proven.rows)
        for names, pair in by_names.items():
            self.pair(pair, proven.rows[names])
        for names, verdict, values, _ in proven.faults():
            found = at_pose(self.made.machine, by_names[names], values)
            error = sum(body.error for body in by_names[names]) + WITHIN
            self.count["poses"] += 1
            if verdict == "hits":
                assert found <= error, f"{names} {values} {found}"
            elif verdict.startswith("comes within"):
                assert abs(found - float(verdict.split()[-1])) <= error, f"{names} {values} {found}"


def test_axes_go_where_the_oracle_has_them(tmp_path: Path) -> None:
    """The two agree where each block of a program leads, each by its own kinematics."""
    rng, count = drawn(901), 0
    for _ in range(rounds(60)):
        made = world(rng, tmp_path, LIBRARY)
        words = [COMMAND, "read", "p.nc", "-m", "m.toml", "--csv", "-"]
        run = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True)
        if run.returncode:
            continue
        rows = list(csv.DictReader(io.StringIO(run.stdout)))
        own = list(motions(made.machine, made.text, made.lengths))
        assert [int(row["line"]) for row in rows] == [motion.line for motion in own], made.text
        for row, motion in zip(rows, own):
            for name, value in shown(made.machine, motion.ends[1]).items():
                assert abs(float(row[name]) - value) < 2e-6, f"{row} {made.text}"
            count += 1
    assert count > 100


def test_nothing_is_proven_that_samples_deny(tmp_path: Path) -> None:
    rng, count = drawn(902), Counter[str]()
    for _ in range(rounds(600)):
        made = world(rng, tmp_path, LIBRARY)
        proven = Proven(tmp_path)
        # An arc whose ends rounding takes off it.
        if proven.refused:
            count["refused"] += 1
            continue
        Judge(rng, made, count).judge(proven)
    print(dict(count))
    assert count["blocks"] > 25 * rounds(600) and count["blocks that are not clear"] > rounds(600), count
    assert count["pairs that are tight"] >= 0.95 * count["pairs"], count


JOBS = {
    "ac-trunnion": "blade.cls",
    "head-table-bc": "blade.cls",
    "vmc": "flange.ncl",
    "head-head": "s-piece.cls",
}

FIXTURES = {"jaw": [1, 0, 0], "stop": [-1, 0, 0], "clamp": [0, 1, 0], "table": [0, 0, -1]}
"""What stands about the part, and which way is away from it."""


class Job:
    """A program of the library's machine, with bodies that it is clear of."""

    LENGTH = 120.0

    def __init__(self, folder: Path, name: str) -> None:
        self.folder, self.name = folder, name
        words = ["-m", name, str(CHECKOUT / "tests/samples" / JOBS[name]), "-o", "p.nc", "-q"]
        words += [f"--tool-length={self.LENGTH}", "--set=control.planes=false"]
        made = subprocess.run([COMMAND, *words], cwd=folder, capture_output=True, text=True)
        assert made.returncode == 0, made.stderr
        self.text = (folder / "p.nc").read_text()
        self.tools = sorted({int(tool) for tool in re.findall(r"\bT(\d+) M6", self.text)})
        self.away = {fixture: 0.0 for fixture in FIXTURES}
        self.low, self.high, self.gauge = np.zeros(3), np.zeros(3), np.zeros(3)
        # The line from which on it is known where the machine stands.
        self.known = 0
        machine = self.describe({})
        tips = [machine.tip_in_part(m.at(SHARES), self.LENGTH) for m in self.course(machine, {}) if not m.rapid]
        self.low, self.high = np.vstack(tips).min(axis=0), np.vstack(tips).max(axis=0)
        self.gauge = machine.gauge
        for _ in range(40):
            self.describe({})
            proven = Proven(folder)
            if proven.clear:
                break
            names = {name for names, *_ in proven.faults() for name in names} & set(FIXTURES)
            assert names, proven.said
            for fixture in names:
                self.away[fixture] += 12
        assert proven.clear, proven.said
        self.known = max(map(int, re.findall(r"the way to line (\d+) is not looked at", proven.said)), default=0)

    def describe(self, plant: dict[str, float]) -> Machine:
        """Writes the machine file: of ``plant`` how far the holder is longer, a tool shorter, a fixture nearer, mm."""
        middle, (x, y, z), (low_x, _, low_z) = (self.low + self.high) / 2, self.high, self.low
        blocks = {
            "jaw": [[x + 12, middle[1] - 30, low_z - 25], [x + 37, middle[1] + 30, (low_z + z) / 2]],
            "stop": [[low_x - 37, middle[1] - 30, low_z - 25], [low_x - 12, middle[1] + 30, (low_z + z) / 2]],
            "clamp": [[middle[0] - 12, y + 20, low_z - 25], [middle[0] + 12, y + 40, z + 5]],
            "table": [[middle[0] - 200, middle[1] - 200, low_z - 65], [middle[0] + 200, middle[1] + 200, low_z - 30]],
        }
        lines = [f'extends = "{self.name}"', 'name = "with bodies"']
        for fixture, block in blocks.items():
            away = np.array(FIXTURES[fixture]) * (self.away[fixture] - plant.get(fixture, 0.0))
            lines += [f"[fixture.{fixture}]", f"block = {(np.array(block) + away).tolist()}"]
        nose = self.gauge + [0, 0, 0.5]
        lines += ["[fixture.spindle]", 'on = "t"', "radius = 60"]
        lines.append(f"cylinder = [{nose.tolist()}, {(nose + [0, 0, 180]).tolist()}]")
        for tool in self.tools:
            longer = 70 + plant.get("holder", 0.0)
            lines += [f"[tools.{tool}]", f"length = {self.length(plant)}"]
            lines.append(f"holder = [[0, 32], [22, 32], [22, 22], [60, 18], [{longer}, 15]]")
            lines.append("cutter = [[0, 4], [40, 4]]")
        lines += ["[clearance]", 'rapid_axes = "together"', ""]
        (self.folder / "m.toml").write_text("\n".join(lines))
        return Machine.read(self.folder / "m.toml", LIBRARY)

    def length(self, plant: dict[str, float]) -> float:
        return self.LENGTH - plant.get("tool", 0.0)

    def course(self, machine: Machine, plant: dict[str, float]) -> list[Motion]:
        all_motions = motions(machine, self.text, {tool: self.length(plant) for tool in self.tools})
        return [motion for motion in all_motions if motion.line > self.known]

    def nearest(self, plant: dict[str, float], share: float) -> tuple[float, tuple[str, ...]]:
        """How near what is planted comes to anything at samples, or a ``share`` less, and which pair that is."""
        machine = self.describe(plant)
        found = [(motion.tool or 0, motion.at(SHARES[::4])) for motion in self.course(machine, plant)]
        tools = np.concatenate([np.full(len(q), tool) for tool, q in found])
        q, best, places = np.vstack([q for _, q in found]), (math.inf, ("",)), {}  # type: ignore[var-annotated]
        (part,) = plant
        moved = {"tool": ("holder", "spindle")}.get(part, (part,))
        for one, other in self.pairs(machine, plant):
            if not any(body.name.split()[0] in moved for body in (one, other)):
                continue
            own = np.arange(len(q))
            for body in (one, other):
                if " T" in body.name:
                    own = own[tools[own] == int(body.name.split("T")[-1])]
            if len(own):
                far, _ = Poses.of(machine, one, other, q, places).nearest(own, best[0], share=share)
                if far < best[0]:
                    best = far, tuple(sorted((one.name, other.name)))
        return best

    def pairs(self, machine: Machine, plant: dict[str, float]) -> list[tuple[Body, Body]]:
        tools = [body for tool in self.tools for body in tool_bodies(machine, tool, self.length(plant))]
        return pairs(machine, bodies(machine) + tools)


@pytest.mark.parametrize("name", JOBS)
def test_hits_that_are_planted_are_found(tmp_path: Path, name: str) -> None:
    """What grows or is moved until it touches, and 0.05 to 5 mm more, is found, with its pair and a block of it."""
    rng, count, planted = drawn(903), rounds(9), 0
    job = Job(tmp_path, name)
    for _ in range(8 * count):
        if planted == count:
            break
        part = str(rng.choice(["holder", "tool", *FIXTURES]))
        most = 300.0 if part in FIXTURES else job.LENGTH - 75
        far, apart = 0.0, math.inf
        # As far as it is from touching it can be moved without.
        while apart > 2e-4 and far < most:
            apart, _ = job.nearest({part: far}, 0.8)
            far += apart
        far += float(np.exp(rng.uniform(math.log(0.05), math.log(5))))
        if far > most:
            continue
        plant = {part: far}
        hit, pair = job.nearest(plant, 1.0)
        # What was moved past a corner that it touched.
        if hit > 0:
            continue
        proven, machine = Proven(tmp_path), job.describe(plant)
        faults = {names: (verdict, values, line) for names, verdict, values, line in proven.faults()}
        assert pair in faults, f"{plant} {pair}\n{proven.said}"
        by_names = named(job.pairs(machine, plant))
        for names, (_, values, line) in faults.items():
            error = 2 * WITHIN + sum(body.error for body in by_names[names])
            assert at_pose(machine, by_names[names], values) <= error, f"{plant} {names} {values}"
            there = [motion.at(np.linspace(0, 1, 201)) for motion in job.course(machine, plant) if motion.line == line]
            near, _ = Poses.of(machine, *by_names[names], np.vstack(there)).nearest()
            assert near <= error, f"{plant} {names} {line}"
        planted += 1
    assert planted == count


TWO_TOOLS = """extends = "vmc"
name = "two tools"
[workpiece]
mount = [0, 0, -100]
[tools.1]
length = 100
cutter = [[0, 5], [60, 5]]
[tools.2]
length = 150
cutter = [[0, 5], [60, 5]]
[clearance]
rapid_axes = "together"
"""

AROUND = [[(8, -60), (40, 60)], [(-40, -60), (-8, 60)], [(-8, 8), (8, 60)], [(-8, -60), (8, -8)]]
"""Four walls about a hole 16 mm wide, XY of their corners."""

BY_HAND = {
    "clear": ("G43 H1 Z50.|G1 Z-20. F500.", AROUND, True),
    "plain hit": ("G43 H1 Z50.|G1 Z-20. F500.|X5.", AROUND, False),
    "own length": ("T2 M6|G43 H2 Z50.", [[(-10, -10), (10, 10)]], True),
    "a shorter tool's length": ("T2 M6|G43 H1 Z0.", [[(-10, -10), (10, 10)]], False),
    "a length that is still in force": ("G43 H1 Z50.|T2 M6|G0 Z0.", [[(-10, -10), (10, 10)]], False),
    "a length that the program writes": ("G10 L10 P1 R85.|G43 H1 Z-5.", [[(-10, -10), (10, 10)]], False),
    "beside its path": ("G43 H1 Z-20.|G41 D1 X20. F500.|G1 X100.|G40 X120.", [[(40, 8), (80, 40)]], False),
    "fine boring": ("G43 H1 Z50.|G98 G76 X0. Y0. Z-20. R2. Q10. F100.|G80", AROUND, False),
    "back boring": ("G43 H1 Z50.|G98 G87 X0. Y0. Z-10. R-20. Q10. F100.|G80", AROUND, False),
    "a block that may be skipped": ("G43 H1 Z-20.|/G0 Z50.|G0 X100.", [[(40, -30), (80, 30)]], False),
}
"""Blocks, what stands there from 30 to 15 mm below the part's zero, and whether nothing is hit."""


@pytest.mark.parametrize("name", BY_HAND)
def test_what_the_control_makes_of_a_block(tmp_path: Path, name: str) -> None:
    """Where the tool is not where the words of a block have it, or may not be: by hand."""
    blocks, walls, clear = BY_HAND[name]
    lines = [TWO_TOOLS]
    for place, ((x, y), (x2, y2)) in enumerate(walls):
        lines.append(f"[fixture.f{place}]\nblock = [[{x}, {y}, -130], [{x2}, {y2}, -115]]")
    (tmp_path / "m.toml").write_text("\n".join(lines) + "\n")
    start = ["%", "O1", "G21 G17 G40 G80 G90 G94", "G53 G0 Z20.", "T1 M6", "G54", "G0 X0. Y0."]
    text = [*start, *blocks.split("|"), "G0 Z80.", "G49", "G53 G0 Z20.", "M30", "%", ""]
    (tmp_path / "p.nc").write_text("\n".join(text))
    assert Proven(tmp_path).clear == clear


BESIDE = """extends = "vmc"
name = "beside"
[workpiece]
mount = [0, 0, -300]
[stock]
block = [[-200, -200, -30], [200, 200, 0]]
[tools.1]
length = 100
cutter = [[0, 5], [60, 5]]
[clearance]
rapid_axes = "together"
pairs = [{ between = ["cutter", "stock"], rapid = 2 }]
"""


class BesideRule:
    """Which rapids over a plane at Z0 are clear, as the page has it: a cutter of one radius keeps 2 mm from it."""

    KEEP = 2.0
    # Steps of 0.3 and 0.6 mm lie 30 degrees off one another: these are within.
    ONWARD = math.cos(math.radians(30.001))

    def __init__(self) -> None:
        self.cuts: list[tuple[np.ndarray, np.ndarray]] = []
        self.stands, self.first, self.last = "cut", np.zeros(3), np.zeros(3)

    def been(self, one: np.ndarray, other: np.ndarray) -> tuple[bool, bool]:
        """Whether a way goes where the cutter was at feed or above that, and whether back along it."""
        above = back = False
        for begin, end in self.cuts:
            way = end - begin
            flat = float(np.hypot(*way[:2]))
            over = []
            for point in (one, other):
                to = point - begin
                share = float(to[:2] @ way[:2]) / flat**2 if flat else 0.0
                aside = np.hypot(*(to[:2] - share * way[:2]))
                low = begin[2] + share * way[2] if flat else min(begin[2], end[2])
                over.append(point[2] - low if aside < 1e-6 and -1e-9 <= share <= 1 + 1e-9 else -math.inf)
            above |= min(over) >= -1e-9
            back |= flat > 0 and np.hypot(*(other - one)[:2]) > 0 and all(abs(height) < 1e-9 for height in over)
        return above, back

    def feed(self, one: np.ndarray, other: np.ndarray) -> None:
        self.cuts.append((one, other))
        self.stands = "cut"

    def parts(self, one: np.ndarray, other: np.ndarray) -> list[np.ndarray]:
        """Where a rapid leaves the lines of cuts that it begins on, and where it comes to those that it ends on."""
        way = other - one
        length = float(np.linalg.norm(way))
        spans = []
        for cut in self.cuts:
            ends = [(point - one) @ way / length**2 for point in cut]
            aside = [np.linalg.norm(point - one - way * end) for point, end in zip(cut, ends)]
            if max(aside) < 1e-6 and max(ends) > min(ends):
                spans.append((min(ends), max(ends)))
        first, last = 0.0, 1.0
        for begin, end in sorted(spans):
            first = max(first, end) if begin < first + 1e-9 else first
        for begin, end in sorted(spans, key=lambda span: -span[1]):
            last = min(last, begin) if end > last - 1e-9 else last
        stops = [0.0, *([first] if 0 < first < 1 else []), *([last] if max(first, 0.0) < last < 1 else []), 1.0]
        return [one + way * stop for stop in stops]

    def rapids(self, one: np.ndarray, other: np.ndarray) -> int:
        """Takes a rapid, by its parts unless all of it is spared; how many are not clear."""
        stops = [one, other] if self.been(one, other)[0] else self.parts(one, other)
        return sum(not self.rapid(*ends) for ends in zip(stops, stops[1:]))

    def rapid(self, one: np.ndarray, other: np.ndarray) -> bool:
        """Takes a part of a rapid; whether it is clear."""
        way = other - one
        unit = way / np.linalg.norm(way)
        begins, ends = one[2] < self.KEEP, other[2] < self.KEEP
        spared, back = self.been(one, other)
        if not begins:
            self.stands = "away"
        may, onward, last = True, unit, way
        if self.stands == "near":
            onward = self.first
            in_line = np.linalg.norm(np.cross(unit, self.last)) < 1e-9
            last = self.last + way if in_line else way
            returns = in_line and unit @ self.last < 0 and (not ends or np.linalg.norm(way) <= np.linalg.norm(self.last) + 1e-9)
            if not returns and unit @ self.first < self.ONWARD:
                may, onward = unit[2] >= self.ONWARD, np.array([0.0, 0.0, 1.0])
            if not may:
                onward, last = self.first, np.zeros(3)
        if not ends:
            self.stands = "away"
        elif not (self.stands == "cut" and back):
            self.stands, self.first, self.last = "near", onward, last
        low = min(one[2], other[2])
        return spared or low > (0.0 if may else self.KEEP)


def test_rapids_beside_the_part_are_those_of_the_page(tmp_path: Path) -> None:
    """Random cuts and rapids over a plane, by the rule as it is written for people."""
    rng, count = drawn(904), Counter[str]()
    (tmp_path / "m.toml").write_text(BESIDE)
    for _ in range(rounds(150)):
        rule, at, faults, low = BesideRule(), np.array([0.0, 0.0, 10.0]), 0, {}
        lines = ["%", "O1", "G21 G17 G40 G80 G90 G94", "G53 G0 Z20.", "T1 M6", "S1000 M3", "G54"]
        lines += ["G0 X0. Y0.", "G43 H1 Z10.", "G1 Z9. F500."]
        at[2] = 9.0
        rule.feed(np.array([0.0, 0.0, 10.0]), at)
        for _ in range(25):
            to, fed = at.copy(), rng.uniform() < 0.2
            kind = rng.integers(0, 5)
            if kind in (0, 1):
                to[2] = rng.choice([0.3, 0.7, 1.2, 1.8, 9.0])
            if kind in (1, 2, 3):
                to[rng.integers(0, 2)] = rng.choice([0.0, 5.0, 10.0])
            if kind == 3:
                to += [*rng.choice([-0.3, 0.0, 0.3], 2), rng.choice([-0.6, 0.6])]
            if kind == 4:
                # As far as it was.
                fed, to[2] = fed or at[2] > 0, rng.choice([-1.0, 0.3])
            to = np.round(to, 3)
            if 1.99 < to[2] < 2.01 or abs(to[2]) < 1e-9 or np.array_equal(to, at):
                continue
            lines.append(f"G{int(fed)} X{to[0]:.3f} Y{to[1]:.3f} Z{to[2]:.3f}")
            if fed:
                rule.feed(at, to)
            else:
                told = rule.rapids(at, to)
                faults += told
                low[len(lines)] = max(0.0, min(at[2], to[2]))
                count["rapids"] += 1
                count["not clear"] += told
            at = to
        lines += ["G0 Z60.", "M30", "%", ""]
        faults += rule.rapids(at, np.array([*at[:2], 60.0]))
        (tmp_path / "p.nc").write_text("\n".join(lines))
        proven = Proven(tmp_path, "m.toml", "--csv", "lines.csv")
        assert proven.rows["cutter T1", "stock"][3] == faults, "\n".join(lines) + proven.said
        for row in csv.DictReader((tmp_path / "lines.csv").open()):
            if (line := int(row["line"])) in low and row["clear_by"]:
                assert float(row["clear_by"]) <= low[line] + ROUNDING, f"{row} {lines[line - 1]}"
                count["told"] += 1
    print(dict(count))
    assert count["rapids"] > 10 * rounds(150) and count["rapids"] > 1.5 * count["not clear"] > 3 * rounds(150), count
    assert count["told"] > 10 * rounds(150), count
