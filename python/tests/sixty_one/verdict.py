"""A machine's program, posted by the command, read by words, moved by bodies, and held against the CL file."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sixty_one import passes, words
from sixty_one.kinematics import Floats, Pose
from sixty_one.passes import Pass, Work
from sixty_one.table import Machine
from sixty_one.words import UNKNOWN, Block

HERE = Path(__file__).parent
CHECKOUT = HERE.parents[2]
ROBOTS = {"krl", "rapid", "urscript"}
SHARES = np.linspace(0, 1, 9)
DIGITS = 2e-3
"""What the digits of the words may leave beside the tolerance, mm."""
JOINTS = 0.05
"""How far a joint may be from where the summary has it, mm or degrees: digits of words, seen from a pivot, and nine places on
each way where a slide goes out and back again."""
DEGREES = 5e-3
"""The same of the tool's axis."""


def command() -> str:
    """The command."""
    return os.environ.get("POST_COMMAND", str(CHECKOUT / "target/debug/post"))


@dataclass(frozen=True)
class Verdict:
    """What came of a machine: works, in part, refused or wrong, and the largest deviations: tip in mm, the tool's axis and
    its edge in degrees, joints in mm or degrees, over so many points."""

    says: str
    why: str = ""
    tip: float = 0.0
    axis: float = 0.0
    edge: float | None = None
    joints: float = 0.0
    points: int = 0


class Wrong(Exception):
    """The program is not what the CL file has."""


def angle(one: Floats, other: Floats) -> float:
    """Between two unit vectors, degrees."""
    return math.degrees(2 * math.asin(min(1.0, float(np.linalg.norm(one - other)) / 2)))


CHANNELS = (("upper", 1.0), ("lower", -1.0))
"""What the files of two channels are called, and on which side of the centre each works."""


@dataclass(frozen=True)
class Program:
    """What the command wrote: a text a channel, and its summary; or what it said."""

    texts: tuple[str, ...]
    summary: dict
    said: str


def run(machine: Machine, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command, with the libraries of robots' languages where they are asked for."""
    plugins = ["--plugins", str(library(machine.dialect).parent)] if machine.dialect in ROBOTS else []
    done = subprocess.run([command(), *plugins, *arguments], cwd=folder, capture_output=True, text=True)
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
class Placed:
    """A block with the poses on its way: the start is where the block before left off."""

    block: Block
    poses: list[Pose]
    values: list[dict[str, float]]


def mixed(one: Floats, other: Floats, share: float) -> Floats:
    """Between two directions, on the great circle."""
    whole = math.radians(angle(one, other))
    if whole < 1e-9:
        return one
    return (math.sin((1 - share) * whole) * one + math.sin(share * whole) * other) / math.sin(whole)


def between(machine: Machine, zero: dict[str, float], start: Block | None, end: Block, share: float) -> tuple[Pose, dict[str, float]]:
    """The pose on the way to the end of a block."""
    bodies, start = machine.bodies, start or end
    told = {
        name: start.words.get(name, value) + share * (value - start.words.get(name, value)) for name, value in end.words.items()
    }
    if end.frame is not None:
        # A robot's straight move: the tip goes straight. Between two, the tool's own direction is on the great circle.
        first = start.frame or end.frame
        tips = [np.array(one[0]) - np.array(bodies.origin) for one in (first, end.frame)]
        ways = [-np.array(one[1])[:, 2] for one in (first, end.frame)]
        across = np.array(end.frame[1])[:, 0]
        return Pose(tips[0] + share * (tips[1] - tips[0]), mixed(ways[0], ways[1], share), across), told
    values = bodies.values({name: value for name, value in told.items() if not name.endswith("3")})
    if not end.led:
        for name, value in zero.items():
            values[name] += value
    pose = bodies.pose(values, machine.length)
    if end.led:
        tip = np.array([told[name] for name in "XYZ"])
        axis = pose.axis
        if machine.vectors:
            axis = mixed(*(np.array([one.words[name] for name in ("A3", "B3", "C3")]) for one in (start, end)), share)
        return Pose(tip, axis, pose.edge), values
    if end.mode == "face":
        # Right-angled coordinates of the part, X as the lathe counts it.
        across = told["Y"] if "Y" in told else told["C"]
        return replace(pose, tip=np.array([told["X"] / bodies.factors.get("X", 1.0), across, pose.tip[2]])), values
    return pose, values


def placed(machine: Machine, found: list[Block]) -> list[Placed]:
    """The blocks with their poses; those whose words are not all known have none."""
    zero = machine.bodies.at_origin(machine.length)
    ways, last = [], None
    needed = set(zero) | {joint.word for joint in machine.bodies.part + machine.bodies.tool}
    if machine.vectors:
        needed = {"X", "Y", "Z", "A3", "B3", "C3"}
    for block in found:
        missing = UNKNOWN if machine.vectors else 0.0
        known = all(not math.isnan(block.words.get(name, missing)) for name in needed - left_out(block))
        if not known:
            if block.cuts:
                raise Wrong(f"line {block.line} cuts, and not all words are known: {block.words}")
            last = None
            continue
        shares = SHARES if last is not None and last.led == block.led and last.mode == block.mode else SHARES[-1:]
        both = [between(machine, zero, last, block, share) for share in shares]
        ways.append(Placed(block, [pose for pose, _ in both], [values for _, values in both]))
        last = block
    return ways


def left_out(block: Block) -> set[str]:
    """Words that a mode of the control does without."""
    return {"C"} if block.mode == "face" and "Y" in block.words else set()


def aside(pose: Floats, start: Floats, end: Floats) -> float:
    """From a straight between two points."""
    way = end - start
    share = min(1.0, max(0.0, float((pose - start) @ way) / max(float(way @ way), 1e-12)))
    return float(np.linalg.norm(pose - start - share * way))


def held(machine: Machine, work: Work, ways: list[Placed]) -> Verdict:
    """All points of all passes, in order, and the ways between them."""
    cuts = [one for one in ways if one.block.cuts]
    tip, lean, edge, at, points = 0.0, 0.0, 0.0, 0, 0
    room, most = machine.tolerance + DIGITS, machine.lean + DEGREES
    for one in work.passes:
        for place, goal, way in zip(range(len(one.tips)), one.tips, one.axes):
            start = one.tips[place - 1] if place else one.above
            for number in range(at, len(cuts)):
                end = cuts[number].poses[-1]
                if np.linalg.norm(end.tip - goal) <= room and angle(end.axis, way) <= most:
                    break
            else:
                near = min(cuts[at:] or cuts, key=lambda c: float(np.linalg.norm(c.poses[-1].tip - goal)), default=None)
                told = f", nearest line {near.block.line} at {near.poses[-1].tip.round(3)} {near.poses[-1].axis.round(4)}" if near else ""
                raise Wrong(f"point {points + 1} at {goal.round(3)} {way.round(4)} is not met{told}")
            tip = max(tip, float(np.linalg.norm(end.tip - goal)))
            lean = max(lean, angle(end.axis, way))
            own = cuts[at : number + 1]
            if not place:
                # What comes before the way down from above are rapids that are written as feed moves.
                starts = [k for k, done in enumerate(own) if np.linalg.norm(done.poses[0].tip - start) <= 0.5]
                own = own[starts[-1] :] if starts else own[-1:]
            for done in own:
                for pose in done.poses:
                    off = aside(pose.tip, start, goal)
                    if off > room:
                        raise Wrong(f"line {done.block.line} strays by {off:.4f} mm from the way to {goal.round(3)}")
                    tip = max(tip, off)
                    if place:
                        edge = max(edge, heading(work, one, place, pose))
            at, points = number + 1, points + 1
    if work.edged and edge > most:
        raise Wrong(f"the edge stands {edge:.3f} degrees beside the way")
    return Verdict("works", "", tip, lean, edge if work.edged else None, 0.0, points)


def heading(work: Work, one: Pass, place: int, pose: Pose) -> float:
    """By how much the edge is beside the travel, across the tool, degrees; corners may be taken on the spot."""
    if not work.edged:
        return 0.0
    way = one.tips[place] - one.tips[place - 1]
    way = way - (way @ pose.axis) * pose.axis
    off = angle(way / np.linalg.norm(way), pose.edge)
    # A way of chords is headed along a curve: as far as a chord turns to the next.
    turn = 0.0
    for other in (place - 1, place + 1):
        if 1 <= other < len(one.tips):
            more = one.tips[other] - one.tips[other - 1]
            more = more - (more @ pose.axis) * pose.axis
            turn = max(turn, angle(way / np.linalg.norm(way), more / np.linalg.norm(more)))
    return max(0.0, off - turn)


def led_to(machine: Machine, pose: Pose, values: dict[str, float]) -> dict[str, float]:
    """Joints of a tip that the control keeps: its slides bring the tip there, the others being where they are told."""
    bodies = machine.bodies
    names = [joint.word for joint in bodies.part + bodies.tool if not joint.turns]
    rest = {**values, **dict.fromkeys(names, 0.0)}
    start = bodies.pose(rest, machine.length).tip
    ways = np.stack([bodies.pose({**rest, name: 1.0}, machine.length).tip - start for name in names], axis=1)
    found, *_ = np.linalg.lstsq(ways, pose.tip - start, rcond=None)
    return {**values, **{name: float(value) for name, value in zip(names, found)}}


def joined(machine: Machine, ways: list[Placed], summary: dict) -> float:
    """How far the summary's ranges of axes and drives are from where bodies and published formulas have them, mm or degrees,
    from the first pass to the last. A range that is wider at one end has the way to the part and from it: the nearer end
    counts, and whatever lies outside."""
    found: dict[str, list[float]] = {}
    first, last = machine.work.passes[0].above, machine.work.passes[-1].away
    begins = [k for k, way in enumerate(ways) if np.linalg.norm(way.poses[-1].tip - first) < 0.5]
    ends_ = [k for k, way in enumerate(ways) if np.linalg.norm(way.poses[-1].tip - last) < 0.5]
    # Words of a mode and poses are no joints: of these programs not all of the way is among what is found here.
    modes = any(way.block.mode or way.block.frame for way in ways)
    for number, way in enumerate(ways[begins[0] : ends_[-1] + 1]):
        if way.block.frame is not None:
            continue
        for pose, values in list(zip(way.poses, way.values))[0 if number else -1 :]:
            if way.block.led and not machine.vectors:
                values = led_to(machine, pose, values)
            if not machine.vectors and not way.block.mode:
                for joint in machine.bodies.part + machine.bodies.tool:
                    found.setdefault(joint.word, []).append(values[joint.word] + joint.shown)
            middle = np.array(machine.bodies.origin) + pose.tip + (machine.length - machine.bodies.nose[2]) * pose.axis
            for name, law in machine.drives:
                found.setdefault("drive " + name, []).append(law(middle, pose.axis))
    told = {one["name"]: one for one in summary["axes"]}
    told |= {"drive " + one["name"]: one for one in summary.get("drives") or []}
    turning = {joint.word for joint in machine.bodies.part + machine.bodies.tool if joint.turns}
    if "W" in found:
        # Z and a quill share their way, and where each is counted from is the builder's.
        found = {name: values for name, values in found.items() if name not in ("Z", "W") or name in turning}
    worst = 0.0
    for name, values_ in found.items():
        if name in told:
            low, high = told[name]["min"], told[name]["max"]
            # Whole turns are one place.
            shift = round((low + high - min(values_) - max(values_)) / 720) * 360 if name in turning else 0
            ends = min(values_) + shift - low, high - max(values_) - shift
            nearer = 0.0 if modes else min(abs(ends[0]), abs(ends[1]))
            worst = max(worst, -ends[0], -ends[1], nearer)
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
    ways = placed(machine, words.read(machine.dialect, program.texts[0], letters, machine.tips))
    return replace(held(machine, machine.work, ways), joints=joined(machine, ways, program.summary))


def both(machine: Machine, program: Program) -> Verdict:
    """Of a machine of two channels: that of the worse, where they wait for one another."""
    found = []
    for (name, side), bodies, text in zip(CHANNELS, (machine.bodies, machine.second or machine.bodies), program.texts):
        if re.findall(r"^M1\d\d$", text, re.M) != ["M100", "M101"]:
            raise Wrong(f"the {name} channel does not wait by M100 and M101")
        own = replace(machine, bodies=bodies)
        found.append(held(own, passes.waiting(side), placed(own, words.read(machine.dialect, text, {"X", "Z"}, False))))
    worse = max(found, key=lambda one: one.tip)
    return replace(worse, points=sum(one.points for one in found))
