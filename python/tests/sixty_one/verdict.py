"""A machine's program, posted by the command, read by words, moved by bodies, and held against the CL file."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from sixty_one import passes, words
from sixty_one.kinematics import Floats
from sixty_one.passes import Pass, Work
from sixty_one.table import Machine
from sixty_one.words import UNKNOWN, Block

HERE = Path(__file__).parent
CHECKOUT = HERE.parents[2]
ROBOTS = {"krl", "rapid", "urscript"}
SHARES = np.linspace(0, 1, 9)
DIGITS = 2e-3
"""What the digits of the words may leave beside the tolerance, mm."""
JOINTS = 0.1
"""How far a joint may be from where the summary has it, mm or degrees: digits of words, seen from a pivot, and nine
places on each way where a slide goes out and back again."""
DEGREES = 5e-3
"""The same of the tool's axis."""


def command() -> str:
    """The command."""
    return os.environ.get("POST_COMMAND", str(CHECKOUT / "target/debug/post"))


@dataclass(frozen=True)
class Verdict:
    """What came of a machine: works, in part, refused or wrong, and the largest deviations: tip in mm, the tool's
    axis and its edge in degrees, joints in mm or degrees, over so many points."""

    says: str
    why: str = ""
    tip: float = 0.0
    axis: float = 0.0
    edge: float | None = None
    joints: float = 0.0
    points: int = 0


class Wrong(Exception):
    """The program is not what the CL file has."""


def angle(one: Floats, other: Floats) -> Floats:
    """Between unit vectors, degrees."""
    return np.asarray(np.degrees(2 * np.arcsin(np.minimum(1.0, np.linalg.norm(one - other, axis=-1) / 2))))


CHANNELS = (("upper", 1.0), ("lower", -1.0))
"""What the files of two channels are called, and on which side of the centre each works."""


@dataclass(frozen=True)
class Program:
    """What the command wrote: a text a channel, and its summary; or what it said."""

    texts: tuple[str, ...]
    summary: dict[str, Any]
    said: str


def run(machine: Machine, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command, with the libraries of robots' languages where they are asked for."""
    plugins = ["--plugins", str(library(machine.dialect).parent)] if machine.dialect in ROBOTS else []
    done = subprocess.run([command(), *plugins, *arguments], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{machine.name}: {done.stderr}")
    return done


def library(dialect: str) -> Path:
    """The library of a dialect that is not built in: beside the command, or where tests have it."""
    folder, name = Path(command()).parent, f"libpost_{dialect}.so"
    return next((path for path in (folder / name, folder / "deps" / name) if path.is_file()), folder / name)


def posted(machine: Machine, folder: Path) -> Program:
    """The machine's work, posted."""
    folder.mkdir(parents=True, exist_ok=True)
    if machine.second is None:
        (folder / "part.cls").write_text(machine.work.text())
        told = ["-m", str(HERE / f"{machine.name}.toml"), "part.cls", "-o", "part.nc", "--summary", "part.json"]
        done = run(machine, folder, *told, "--tool-length", f"{machine.length:g}", *machine.options)
        if done.returncode:
            return Program((), {}, done.stderr)
        return Program(((folder / "part.nc").read_text(),), json.loads((folder / "part.json").read_text()), done.stderr)
    lines = [f"tool_length = {machine.length:g}"]
    for name, side in CHANNELS:
        (folder / f"{name}.cls").write_text(passes.waiting(side).text())
        file = HERE / f"{machine.name}-{name}.toml"
        lines += ["[[channel]]", f"machine = '{file}'", f'cl = "{name}.cls"', f'output = "{name}.nc"']
    (folder / "part.job.toml").write_text("\n".join([*lines, ""]))
    done = run(machine, folder, "part.job.toml")
    if done.returncode:
        return Program((), {}, done.stderr)
    return Program(tuple((folder / f"{name}.nc").read_text() for name, _ in CHANNELS), {}, done.stderr)


@dataclass
class Way:
    """A block with the poses on its way, a row at each share, and the joints; the start is where the block before
    left off."""

    block: Block
    tips: Floats
    axes: Floats
    edges: Floats
    values: dict[str, Floats]


def mixed(one: Floats, other: Floats) -> Floats:
    """Between two directions, on the great circle."""
    whole = math.radians(float(angle(one, other)))
    if whole < 1e-9:
        return np.broadcast_to(other, (len(SHARES), 3))
    rows = np.outer(np.sin((1 - SHARES) * whole), one) + np.outer(np.sin(SHARES * whole), other)
    return rows / math.sin(whole)


def told(start: Block, end: Block, name: str) -> Floats:
    """A word on the way."""
    first, last = start.words.get(name, math.nan), end.words.get(name, math.nan)
    return (last if math.isnan(first) else first) * (1 - SHARES) + last * SHARES


def placed(machine: Machine, found: list[Block]) -> list[Way]:
    """The blocks whose words are all known, with their poses."""
    bodies, zero = machine.bodies, machine.bodies.at_origin(machine.length)
    joints = [joint.word for joint in bodies.part + bodies.tool]
    vector = ["A3", "B3", "C3"] if machine.vectors else []
    pairs: list[tuple[Block, Block]] = []
    last = None
    for block in found:
        needed = {"X", "Y", "Z", *vector} if vector else {*zero, *joints} - left_out(block)
        if any(math.isnan(block.words.get(name, UNKNOWN if vector else 0.0)) for name in needed):
            if block.cuts:
                raise Wrong(f"line {block.line} cuts, and not all words are known: {block.words}")
            last = None
            continue
        same = last is not None and (last.led, last.mode) == (block.led, block.mode)
        pairs.append((last if same and last else block, block))
        last = block
    count = len(pairs) * len(SHARES)
    names = {name for _, end in pairs for name in end.words}
    words_ = {name: np.concatenate([told(*pair, name) for pair in pairs]) for name in names}
    known = {name: np.nan_to_num(words_[name]) for name in joints if name in words_}
    values = bodies.values(known, count)
    led = np.repeat([end.led for _, end in pairs], len(SHARES))
    for name, value in zero.items():
        values[name] = values[name] + np.where(led, 0.0, value)
    poses = bodies.poses(values, machine.length)
    ways = []
    for number, (start, end) in enumerate(pairs):
        rows = slice(number * len(SHARES), (number + 1) * len(SHARES))
        tips, axes, edges = poses.tips[rows], poses.axes[rows], poses.edges[rows]
        if end.led:
            tips = np.stack([words_[name][rows] for name in "XYZ"], axis=1)
            if vector:
                axes = mixed(*(np.array([one.words[name] for name in vector]) for one in (start, end)))
        elif end.mode == "face":
            # Right-angled coordinates of the part, X as the lathe counts it.
            across = words_["Y" if "Y" in end.words else "C"][rows]
            tips = np.stack([words_["X"][rows] / bodies.factors.get("X", 1.0), across, tips[:, 2]], axis=1)
        elif end.frame is not None:
            # A robot's straight move: the tip goes straight, and the tool's own direction turns on the great circle.
            ends = [one or end.frame for one in (start.frame, end.frame)]
            first, goal = (np.array(one[0]) - np.array(bodies.origin) for one in ends)
            tips = first + SHARES[:, None] * (goal - first)
            axes = mixed(*(-np.array(one[1])[:, 2] for one in ends))
        own = {name: value[rows] for name, value in values.items()}
        ways.append(Way(end, tips, axes, edges, own))
    return ways


def left_out(block: Block) -> set[str]:
    """Words that a mode of the control does without."""
    return {"C"} if block.mode == "face" and "Y" in block.words else set()


def aside(tips: Floats, start: Floats, end: Floats) -> float:
    """The farthest of the points from the straight between two."""
    way = end - start
    share = np.clip((tips - start) @ way / max(float(way @ way), 1e-12), 0, 1)
    return float(np.linalg.norm(tips - start - share[:, None] * way, axis=1).max())


def held(machine: Machine, work: Work, ways: list[Way]) -> Verdict:
    """All points of all passes, in order, and the ways between them."""
    cuts = [one for one in ways if one.block.cuts]
    if not cuts:
        raise Wrong("nothing cuts")
    tips, axes = (np.stack([getattr(one, name)[-1] for one in cuts]) for name in ("tips", "axes"))
    tip, lean, edge, at, points = 0.0, 0.0, 0.0, 0, 0
    room, most = machine.tolerance + DIGITS, machine.lean + DEGREES
    for one in work.passes:
        for place, (goal, way) in enumerate(zip(one.tips, one.axes)):
            start = one.tips[place - 1] if place else one.above
            off, leant = np.linalg.norm(tips - goal, axis=1), angle(axes, way)
            met = np.flatnonzero((off[at:] <= room) & (leant[at:] <= most))
            if not len(met):
                near = at + int(np.argmin(off[at:])) if at < len(cuts) else -1
                raise Wrong(
                    f"point {points + 1} at {goal.round(3)} {way.round(4)} is not met, nearest line"
                    f" {cuts[near].block.line} at {tips[near].round(3)} {axes[near].round(4)}"
                )
            number = at + int(met[0])
            tip, lean = max(tip, float(off[number])), max(lean, float(leant[number]))
            own = cuts[at : number + 1]
            if not place:
                # What comes before the way down from above are rapids that are written as feed moves.
                starts = [k for k, done in enumerate(own) if np.linalg.norm(done.tips[0] - start) <= 0.5]
                own = own[starts[-1] :] if starts else own[-1:]
            for done in own:
                strays = aside(done.tips, start, goal)
                if strays > room:
                    raise Wrong(f"line {done.block.line} strays by {strays:.4f} mm from the way to {goal.round(3)}")
                tilt = tilted(done.axes, one.axes[place - 1], way) if place else 0.0
                if tilt > most:
                    raise Wrong(f"line {done.block.line}: the tool leaves its plane by {tilt:.4f} degrees")
                tip, lean = max(tip, strays), max(lean, tilt)
                if place and work.edged:
                    edge = max(edge, headed(one, place, done))
            at, points = number + 1, points + 1
    if edge > most:
        raise Wrong(f"the edge stands {edge:.3f} degrees beside the way")
    return Verdict("works", "", tip, lean, edge if work.edged else None, 0.0, points)


def tilted(axes: Floats, first: Floats, last: Floats) -> float:
    """By how much the tool leaves the plane that it turns in, degrees."""
    normal = np.cross(first, last)
    size = float(np.linalg.norm(normal))
    if size < 1e-4:
        return float(angle(axes, last).max())
    return float(np.degrees(np.arcsin(np.clip(np.abs(axes @ normal) / size, 0, 1))).max())


def headed(one: Pass, place: int, done: Way) -> float:
    """By how much the edge is beside the travel, across the tool, degrees; corners may be taken on the spot."""

    def across(number: int) -> Floats:
        way = one.tips[number] - one.tips[number - 1]
        flat = way - (done.axes @ way)[:, None] * done.axes
        return np.asarray(flat / np.linalg.norm(flat, axis=1)[:, None])

    way = across(place)
    # A way of chords is headed along a curve: as far as a chord turns to the next.
    others = [other for other in (place - 1, place + 1) if 1 <= other < len(one.tips)]
    turn = max([float(angle(way, across(other)).max()) for other in others], default=0.0)
    return max(0.0, float(angle(way, done.edges).max()) - turn)


def joined(machine: Machine, ways: list[Way], summary: dict[str, Any]) -> float:
    """How far the summary's ranges of axes and drives are from where bodies and published formulas have them, mm or
    degrees, from the first pass to the last. A range that is wider at one end has the way to the part and from it:
    the nearer end counts, and whatever lies outside."""
    bodies = machine.bodies
    first, last = machine.work.passes[0].above, machine.work.passes[-1].away
    begins = [k for k, way in enumerate(ways) if np.linalg.norm(way.tips[-1] - first) < 0.5]
    ends = [k for k, way in enumerate(ways) if np.linalg.norm(way.tips[-1] - last) < 0.5]
    if not begins or not ends:
        raise Wrong("the way to the first pass or from the last does not stand in the program")
    # Words of a mode and poses are no joints: of these programs not all of the way is among what is found here.
    # An arm's joints leave the part on ways of their own.
    partly = bodies.absolute or any(way.block.mode or way.block.frame for way in ways)
    own = [way for way in ways[begins[0] + 1 : ends[-1] + 1] if way.block.frame is None and not way.block.mode]
    if machine.work.operations:
        # Between operations the tool is retracted, of which the summary says nothing.
        own, partly = [way for way in own if way.block.cuts], True
    if not own:
        return 0.0
    tips, axes = (np.concatenate([getattr(way, name) for way in own]) for name in ("tips", "axes"))
    found: dict[str, Floats] = {}
    if not machine.vectors:
        values = {name: np.concatenate([way.values[name] for way in own]) for name in own[0].values}
        if machine.tips:
            names = [joint.word for joint in bodies.part + bodies.tool if not joint.turns]
            values = bodies.slides_to(tips, values, machine.length, names)
        found = {joint.word: values[joint.word] + joint.shown for joint in bodies.part + bodies.tool}
    if machine.room is not None and float(machine.room(found).min()) < -DIGITS:
        raise Wrong(f"a limit is passed by {-float(machine.room(found).min()):.3f} mm")
    if "W" in found and "Z" in found and not any(joint.word == "W" and joint.turns for joint in bodies.tool):
        # Z and a quill share their way, and where each is counted from is the builder's.
        del found["W"], found["Z"]
    middles = np.array(bodies.origin) + tips + (machine.length - bodies.nose[2]) * axes
    some = np.arange(len(tips)) % len(SHARES) % 4 == 0
    for name, law in machine.drives:
        found["drive " + name] = np.array([law(*pose) for pose in zip(middles[some], axes[some])])
    ranges = {one["name"]: one for one in summary["axes"]}
    ranges |= {"drive " + one["name"]: one for one in summary.get("drives") or []}
    turning = {joint.word for joint in bodies.part + bodies.tool if joint.turns}
    worst = 0.0
    for name in found.keys() & ranges.keys():
        low, high = ranges[name]["min"], ranges[name]["max"]
        least, most = float(found[name].min()), float(found[name].max())
        # Whole turns are one place.
        shift = round((low + high - least - most) / 720) * 360 if name in turning else 0
        inside = least + shift - low, high - most - shift
        worst = max(worst, -min(inside), 0.0 if partly else min(abs(inside[0]), abs(inside[1])))
    return worst


def judged(machine: Machine, program: Program) -> Verdict:
    """The verdict on what was posted for a machine."""
    if not program.texts:
        first = re.search(r"error\[[a-z-]+\].*", program.said)
        return Verdict("refused", first[0] if first else program.said)
    try:
        found = both(machine, program) if machine.second else single(machine, program)
    except (Wrong, words.Unread) as why:
        return Verdict("wrong", str(why))
    if found.joints > JOINTS:
        return Verdict("wrong", f"a joint is off by {found.joints:.3f}")
    return replace(found, says=machine.after, why=machine.but)


def single(machine: Machine, program: Program) -> Verdict:
    """Of a machine of one channel."""
    letters = {joint.word for joint in machine.bodies.part + machine.bodies.tool}
    found = words.read(
        machine.dialect, program.texts[0], letters, machine.tips, words.Ways(machine.signed, machine.shorter)
    )
    if machine.vectors:
        pointed(machine, found)
    ways = placed(machine, found)
    return replace(held(machine, machine.work, ways), joints=joined(machine, ways, program.summary))


def pointed(machine: Machine, found: list[Block]) -> None:
    """Before the control is told vectors its axes are turned to where the first of them points."""
    turned = [block for block in found if not block.led and not math.isnan(block.words.get("A", UNKNOWN))]
    if not turned:
        raise Wrong("no axis is turned before the first vector")
    values = machine.bodies.values({name: np.array([turned[0].words[name]]) for name in "AC"}, 1)
    axis = machine.bodies.poses(values, machine.length).axes[0]
    if angle(axis, machine.work.passes[0].axes[0]) > machine.lean:
        raise Wrong(f"the axes are turned to {axis.round(4)} before the first vector")


def both(machine: Machine, program: Program) -> Verdict:
    """Of a machine of two channels: that of the worse, where they wait for one another."""
    found = []
    for (name, side), bodies, text in zip(CHANNELS, (machine.bodies, machine.second or machine.bodies), program.texts):
        if re.findall(r"^M1\d\d$", text, re.MULTILINE) != ["M100", "M101"]:
            raise Wrong(f"the {name} channel does not wait by M100 and M101")
        own = replace(machine, bodies=bodies)
        found.append(
            held(
                own,
                passes.waiting(side),
                placed(own, words.read(machine.dialect, text, {"X", "Z"}, False, words.Ways("", ""))),
            )
        )
    worse = max(found, key=lambda one: one.tip)
    return replace(worse, points=sum(one.points for one in found))
