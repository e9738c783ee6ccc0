"""Machine files of ours against kinematics modules of LinuxCNC: rosekins, scarakins, pumakins, genhexkins, corexykins and
matrixkins, each called in this process; where they are not to be had the tests are skipped and say so.

LinuxCNC is told poses, and such a module makes joints of them. Two files say so of each: one whose axes are the joints, so
that a program of ours has joints as words, and one whose words are the pose, its joints drives behind them. Of the first,
tips and tool axes at random joints are the module's, and so are those of the words that are posted for them; of the second,
how far the drives of a posted program went is what the module says at its poses. Numbers are drawn anew each time:
``POST_SEED=N`` draws those of an earlier run again, ``POST_ROUNDS=N`` takes N times as many.
"""

import ctypes
import csv
import json
import os
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from conftest import CHECKOUT, drawn, rounds
from linuxcnc_parts import MODULES, Module, post, stub

__all__ = ["stub"]  # a fixture

Floats = np.ndarray

CLOSE = 2e-6
"""Tables have six decimals: half of the last digit of three coordinates, and some more, mm (and of unit vectors)."""
POSTED = 3e-5
"""The same of words that are posted, with six decimals: of six joints that turn at 900 mm, mm."""


def direction(values: Floats | list[float]) -> str:
    return "[" + ", ".join(f"{value:.15f}" for value in values) + "]"


def turned(roll: float, pitch: float, yaw: float) -> Floats:
    """LinuxCNC's A, B and C, degrees: about X, then about the old Y, then about the old Z."""
    (sa, sb, sc), (ca, cb, cc) = np.sin(np.radians([roll, pitch, yaw])), np.cos(np.radians([roll, pitch, yaw]))
    about_x = np.array([[1, 0, 0], [0, ca, -sa], [0, sa, ca]])
    about_y = np.array([[cb, 0, sb], [0, 1, 0], [-sb, 0, cb]])
    about_z = np.array([[cc, -sc, 0], [sc, cc, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def leaning(rng: np.random.Generator, most: float) -> Floats:
    """A tool axis that leans about X and Y by so many degrees at most."""
    roll, pitch = rng.uniform(-most, most, 2).tolist()
    return turned(roll, pitch, 0)[:, 2]


@dataclass
class Chain:
    """A machine file whose axes are the joints of the module, in their order: `letters`, between `low` and `high`, mm and
    degrees. The spindle's nose is at `nose` of the module's last frame, the tool axis along `axis` of it."""

    text: str
    letters: str
    low: list[float]
    high: list[float]
    dialect: str = "linuxcnc"
    mount: tuple[float, float, float] = (0, 0, 0)
    nose: tuple[float, float, float] = (0, 0, 0)
    axis: tuple[float, float, float] = (0, 0, 1)
    near: Callable[[Floats, Floats], bool] = lambda tip, axis: True
    """Whether a program goes to this tip and tool axis: the straight ways between those must be ways of the machine."""
    scales: list[float] = field(default_factory=lambda: [1.0] * 6)
    """What the control shows of a millimetre of the axis in the machine file: the module's joint of it."""

    def pose(self, module: "Law", joints: list[float]) -> tuple[Floats, Floats]:
        """The tip in the frame of the part and the tool axis, as the module has them."""
        pose = np.array(module.forward(joints))
        frame = turned(*pose[3:])
        return pose[:3] + frame @ self.nose - self.mount, frame @ self.axis


@dataclass
class Poses:
    """A machine file whose words are the pose, X, Y and Z of it where the tip is in the part, but for `shift`: `say` draws
    what is said beside the file (an axis that stands), `goal` a tip in the part with a tool axis."""

    text: str
    goal: Callable[[np.random.Generator], tuple[Floats, Floats]]
    say: Callable[[np.random.Generator], list[str]] = lambda rng: []
    shift: tuple[float, float, float] = (0, 0, 0)
    branch: int = 0


@dataclass
class Law:
    """A module, its pins, and our files of it; without `library` it is the law that its manual states."""

    name: str
    pins: dict[str, float]
    joints: int
    chain: Chain | None
    poses: Poses
    library: Module | None = None

    def forward(self, joints: list[float]) -> list[float]:
        if self.library:
            return self.library.forward(joints)
        return [*np.linalg.solve(MATRIX, joints[:3]), 0, 0, 0]

    def inverse(self, pose: list[float], branch: int) -> list[float]:
        if self.library:
            self.library.branch = ctypes.c_ulong(branch)
            return self.library.inverse(pose, self.joints)
        return [*(MATRIX @ pose[:3])]


POST_TCP = """
tcp = "post"
retract = {}
leave = { along = "tool", distance = 30 }
"""
DIGITS = """
[control.linuxcnc]
decimals = 6
rotary_decimals = 6
"""
SET_TCP = """
[control.linuxcnc]
decimals = 6
rotary_decimals = 6
tcp_on = "M150"
tcp_off = "M151"
"""
ACCURACY = """
[clearance]
rapid_axes = "together"
[accuracy]
tolerance = 0.01
axis_tolerance = 0.05
"""


def slides(places: Floats | None = None, travel: float = 900) -> str:
    """X, Y and Z, along the columns of a matrix."""
    columns = np.eye(3) if places is None else places
    return "".join(
        f"[axis.{letter}]\nlinear = {direction(column)}\ntravel = [-{travel}, {travel}]\nmax_feed = 20000\n"
        for letter, column in zip("XYZ", columns.T, strict=True)
    )


def turns(letter: str, along: str, point: list[float], most: float, more: str = "", zero: float = 0) -> str:
    """A rotary axis that goes to `most` either way of `zero`, which it shows in the drawing."""
    travel = f"zero = {zero}\ntravel = [{zero - most}, {zero + most}]\nmax_feed = 20000\n"
    return f"[axis.{letter}]\nrotary = {along}\npoint = {direction(point)}\n{travel}{more}\n"


def drives(formulas: dict[str, str], drives: dict[str, str], lengths: str) -> str:
    """Formulas, and drives of the same letters as the joints: those that turn begin with R."""
    lines = ["[formulas]", *(f'{name} = "{formula}"' for name, formula in formulas.items())]
    for name, formula in drives.items():
        lines += ["[[drive]]", f'name = "{name}"', f'is = "{formula}"', f"turns = {str(name[0] == 'R').lower()}"]
        lines += ["travel = [-2000, 2000]", "max_feed = 100000"]
    return "\n".join(["[parameters]", lengths, *(lines if formulas else lines[1:]), ""])


def oblique(matrix: Floats) -> tuple[str, list[float]]:
    """A machine file of three slides that shows `matrix` times the place of its tip, and what it shows of a millimetre."""
    places = np.linalg.inv(matrix)
    shown = (1 / np.linalg.norm(places, axis=0)).tolist()
    words = "".join(
        f'[word.{letter}]\nis = "{scale:.15f} * {letter}"\n' for letter, scale in zip("XYZ", shown, strict=True)
    )
    text = 'chain = "[w b X Y Z (S) t]"\n[tool]\ngauge = [0, 0, 0]\n' + slides(places) + words
    return text + '[control]\ndialect = "linuxcnc"\nretract = {}\n' + DIGITS + ACCURACY, shown


def straight(joints: dict[str, str]) -> Poses:
    """X, Y and Z, and three drives."""
    text = 'chain = "[w b X Y Z (S) t]"\n' + drives({}, joints, "") + "[tool]\ngauge = [0, 0, 0]\n" + slides()
    text += '[control]\ndialect = "linuxcnc"\nretract = {}\n' + DIGITS + ACCURACY
    return Poses(text, lambda rng: (rng.uniform(-300, 300, 3), np.eye(3)[2]))


# A mill out of square and of scale, larger than any is.
MATRIX = np.array([[1.002, 0.013, -0.021], [-0.008, 0.997, 0.017], [0.011, -0.019, 1.004]])
BELTS = np.array([[1.0, 1, 0], [1, -1, 0], [0, 0, 1]])


def matrix_law(name: str, matrix: Floats, pins: dict[str, float]) -> Law:
    text, shown = oblique(matrix)
    chain = Chain(text, "XYZ", [-150.0] * 3, [150.0] * 3, scales=shown)
    rows = [
        " + ".join(f"({factor:.15f}) * {letter}" for factor, letter in zip(row, "XYZ", strict=True)) for row in matrix
    ]
    return Law(name, pins, 3, chain, straight({f"J{place}": row for place, row in enumerate(rows)}))


def rose() -> Law:
    """A spindle that turns the part, a slide across and one along: joints are radius, Z and angle."""
    text = (
        'chain = "[w C\' b X Z (S) t]"\n[tool]\ngauge = [0, 0, 0]\n[axis.X]\nlinear = [1, 0, 0]\ntravel = [1, 400]\n'
        "max_feed = 20000\n[axis.Z]\nlinear = [0, 0, 1]\ntravel = [-900, 900]\nmax_feed = 20000\n"
        + turns("C", "[0, 0, 1]", [0, 0, 0], 720)
        + '[control]\ndialect = "linuxcnc"'
        + POST_TCP
        + DIGITS
        + ACCURACY
    )
    poses = straight({"J0": "sqrt(X^2 + Y^2)", "J1": "Z", "R2": "atan2(Y, X)"})
    poses.goal = lambda rng: (rng.uniform([20, -300, -300], 300), np.eye(3)[2])
    return Law("rosekins", {}, 3, Chain(text, "XZC", [2, -200, -175], [300, 200, 175]), poses)


def scara() -> Law:
    """Two arms, a slide that goes down, and a hand with a tool beside its line."""
    d = {"D1": 490.0, "D2": 340.0, "D3": 50.0, "D4": 250.0, "D5": 60.0, "D6": 45.0}
    high, far = d["D1"] + d["D3"] - d["D5"], d["D2"] + d["D4"]
    # Z goes down, so that a control that added the tool's length would go deeper.
    tool = f'gauge = [{far + d["D6"]}, 0, {high}]\nlength_axis = "none"\n'
    text = (
        f'chain = "[w b A B Z C (S) t]"\n[workpiece]\nmount = [0, 0, {high}]\n[tool]\n'
        + tool
        + turns("A", "[0, 0, 1]", [0, 0, 0], 170)
        + turns("B", "[0, 0, 1]", [d["D2"], 0, 0], 150)
        + "[axis.Z]\nlinear = [0, 0, -1]\ntravel = [-400, 400]\nmax_feed = 20000\n"
        + turns("C", "[0, 0, 1]", [far, 0, 0], 360)
        + '[control]\ndialect = "linuxcnc"'
        + POST_TCP
        + DIGITS
        + ACCURACY
    )
    chain = Chain(text, "ABZC", [-160, 20, -150, -170], [160, 140, 150, 170], mount=(0, 0, high))
    chain.near = lambda tip, axis: 250 < tip[0] < 470 and abs(tip[1]) < 250
    formulas = {
        "x": "X - D6 * cos(C)",
        "y": "Y - D6 * sin(C)",
        "elbow": "acos((x^2 + y^2 - D2^2 - D4^2) / (2 * D2 * D4))",
        "arm": "atan2(y, x) - atan2(D4 * sin(elbow), D2 + D4 * cos(elbow))",
    }
    joints = {"R0": "arm", "R1": "elbow", "J2": "D1 + D3 - D5 - Z", "R3": "C - arm - elbow"}
    lengths = "\n".join(f"{name} = {value}" for name, value in d.items())
    pose = (
        'chain = "[w b X Y Z C (S) t]"\n'
        + drives(formulas, joints, lengths)
        + '[[limit]]\nkeep = "x^2 + y^2 > 150^2"\n[[limit]]\nkeep = "x^2 + y^2 < 560^2"\n[[limit]]\nkeep = "x > 20"\n'
        + "[tool]\ngauge = [0, 0, 0]\n"
        + slides()
        + turns("C", "[0, 0, 1]", [0, 0, 0], 180, "indexed = 0")
        + '[control]\ndialect = "linuxcnc"\ntcp = "control"\nretract = {}\n'
        + SET_TCP
        + ACCURACY
    )

    def goal(rng: np.random.Generator) -> tuple[Floats, Floats]:
        return np.array([*rng.uniform([220, -250], [420, 250]), rng.uniform(-100, 100)]), np.eye(3)[2]

    return Law(
        "scarakins", d, 4, chain, Poses(pose, goal, lambda rng: [f"axis.C.indexed={rng.uniform(-170, 170):.6f}"])
    )


def puma() -> Law:
    """An arm beside its first axis, its wrist's axes in a point, a spindle across the flange."""
    d = {"A2": 432.0, "A3": 20.0, "D3": 125.0, "D4": 433.0, "D6": 60.0}
    nose, along = np.array([40.0, 10.0, 30.0]), np.array([-0.8, 0.0, -0.6])
    flipped = np.diag([1.0, -1.0, -1.0])  # the flange with all joints at zero
    wrist = np.array([d["A2"] + d["A3"], d["D3"], -d["D4"]])
    gauge = wrist + flipped @ (nose + [0, 0, d["D6"]])
    text = (
        f'chain = "[w b A B C U V W (S) t]"\n[tool]\ngauge = {direction(gauge)}\naxis = {direction(flipped @ along)}\n'
        'length_axis = "none"\n'
        + turns("A", "[0, 0, 1]", [0, 0, 0], 180)
        + turns("B", "[0, 1, 0]", [0, 0, 0], 200)
        + turns("C", "[0, 1, 0]", [d["A2"], 0, 0], 200)
        + turns("U", "[0, 0, -1]", list(wrist), 200)
        + turns("V", "[0, 1, 0]", list(wrist), 130)
        + turns("W", "[0, 0, -1]", list(wrist), 300)
        + '[control]\ndialect = "siemens"'
        + POST_TCP
        + "[control.siemens]\ndecimals = 6\nrotary_decimals = 6\n"
        + ACCURACY
        + "[solution]\nstart = { A = 0, B = -20, C = 10, V = 40 }\n"
    )
    low, high = [-60.0, -60, -20, -80, 25, -80], [60.0, 0, 50, 80, 100, 80]
    chain = Chain(text, "ABCUVW", low, high, "siemens", nose=tuple(nose), axis=tuple(along))
    # About where the arm is with its joints in the middle.
    middle = np.array([466.0, 115, -287])
    chain.near = lambda tip, axis: bool(np.linalg.norm(tip - middle) < 260 and axis[2] > 0.75)
    # The wrist's middle from the tip of the flange, in the plane of the arm; the forearm by the law of cosines.
    formulas = {
        "zx": "cos(C) * sin(B) * cos(A) + sin(C) * sin(A)",
        "zy": "sin(C) * sin(B) * cos(A) - cos(C) * sin(A)",
        "zz": "cos(B) * cos(A)",
        "xx": "cos(C) * cos(B)",
        "xy": "sin(C) * cos(B)",
        "xz": "-sin(B)",
        "yx": "cos(C) * sin(B) * sin(A) - sin(C) * cos(A)",
        "yy": "sin(C) * sin(B) * sin(A) + cos(C) * cos(A)",
        "yz": "cos(B) * sin(A)",
        "px": "X - D6 * zx",
        "py": "Y - D6 * zy",
        "up": "Z - D6 * zz",
        "out": "sqrt(px^2 + py^2 - D3^2)",
        "first": "atan2(py, px) - atan2(D3, out)",
        "fore": "sqrt(A3^2 + D4^2)",
        "bend": "acos((out^2 + up^2 - A2^2 - fore^2) / (2 * A2 * fore))",
        "third": "bend - atan2(D4, A3)",
        "both": "atan2(-up, out) - atan2(fore * sin(bend), A2 + fore * cos(bend)) + third",
        # Z and Y of the flange, seen from the forearm.
        "zf": "cos(first) * zx + sin(first) * zy",
        "zs": "-sin(first) * zx + cos(first) * zy",
        "za": "cos(both) * zf - sin(both) * zz",
        "zd": "-sin(both) * zf - cos(both) * zz",
        "xd": "-sin(both) * (cos(first) * xx + sin(first) * xy) - cos(both) * xz",
        "yd": "-sin(both) * (cos(first) * yx + sin(first) * yy) - cos(both) * yz",
        "tilt": "sqrt(za^2 + zs^2)",
    }
    joints = {
        "R0": "first",
        "R1": "both - third",
        "R2": "third",
        "R3": "atan2(zs, -za)",
        "R4": "atan2(tilt, zd)",
        "R5": "atan2(-yd, xd)",
    }
    lengths = "\n".join(f"{name} = {value}" for name, value in d.items())
    pose = (
        'chain = "[w b X Y Z C B A (S) t]"\n'
        + drives(formulas, joints, lengths)
        + "[tool]\ngauge = [0, 0, 0]\n"
        + slides()
        + turns("C", "[0, 0, 1]", [0, 0, 0], 80, "indexed = 0")
        + turns("B", "[0, 1, 0]", [0, 0, 0], 80)
        # The flange looks down.
        + turns("A", "[1, 0, 0]", [0, 0, 0], 80, zero=180)
        + '[control]\ndialect = "linuxcnc"\ntcp = "control"\nretract = {}\n'
        + SET_TCP
        + ACCURACY
    )

    def goal(rng: np.random.Generator) -> tuple[Floats, Floats]:
        return rng.uniform([600, -150, -120], [720, 150, 20]), leaning(rng, 14)

    return Law("pumakins", d, 6, chain, Poses(pose, goal, lambda rng: [f"axis.C.indexed={rng.uniform(-30, 30):.6f}"]))


def hexapod() -> Law:
    """That of the library: six struts. The pose is the tip's, as the spindle's nose is 50 mm below its platform; with that
    offset the module counts from 50 mm below the frame too, and the library's part lies 1,000 mm below it."""
    text = re.sub(r"^name .*", "", (CHECKOUT / "machines/hexapod.toml").read_text(), count=1, flags=re.MULTILINE)
    text = text.replace("[control.linuxcnc]", "[control.linuxcnc]\ndecimals = 6\nrotary_decimals = 6")

    def goal(rng: np.random.Generator) -> tuple[Floats, Floats]:
        return rng.uniform([-80, -80, 230], [80, 80, 330]), leaning(rng, 12)

    say = lambda rng: [f"axis.C.indexed={rng.uniform(-9, 9):.6f}"]  # noqa: E731
    return Law("genhexkins", {"spindle-offset": 50}, 6, None, Poses(text, goal, say, (0, 0, -1000 + 50)))


MAKERS: dict[str, Callable[[], Law]] = {
    "rosekins": rose,
    "scarakins": scara,
    "pumakins": puma,
    "genhexkins": hexapod,
    "corexykins": lambda: matrix_law("corexykins", BELTS, {}),
    "matrixkins": lambda: matrix_law(
        "matrixkins",
        MATRIX,
        {f"C_{row}{column}": MATRIX["xyz".index(row), "xyz".index(column)] for row in "xyz" for column in "xyz"},
    ),
}


def write_cl(path: Path, goals: list[tuple[Floats, Floats]], above: float) -> None:
    """A CL file that comes to each point at feed from straight above it, and leaves it so."""
    lines = ["PARTNO/JOINTS", "UNITS/MM", "LOADTL/1", "SPINDL/5000,CLW"]

    def goto(tip: Floats, axis: Floats) -> str:
        return "GOTO/" + ",".join(f"{value:.9f}" for value in [*tip, *axis])

    for tip, axis in goals:
        out = goto(tip + above * axis, axis)
        lines += ["RAPID", out, "FEDRAT/800,MMPM", goto(tip, axis), "RAPID", out]
    path.write_text("\n".join([*lines, "SPINDL/OFF", "FINI", ""]))


def words(program: str, letters: str) -> Iterator[list[float]]:
    """What stands behind each letter at the end of each block with a motion; a control that is told joints adds nothing."""
    at = dict.fromkeys(letters, 0.0)
    for block in program.splitlines():
        found = re.findall(rf"([{letters}])=?(-?\d+\.\d*)", re.sub(r"\(.*?\)|;.*", "", block))
        at |= {letter: float(value) for letter, value in found}
        if found:
            yield list(at.values())


def rows(machine: Path, program: str, *said: str) -> list[dict[str, str]]:
    """Each motion of a program as `post` reads it."""
    run = post("read", program, "-m", machine.name, "--csv", "-", "--tool-length", "0", *said, folder=machine.parent)
    assert run.returncode == 0, run.stderr
    return list(csv.DictReader(run.stdout.splitlines()))


def forward(
    law: Law, chain: Chain, rng: np.random.Generator, machine: Path
) -> tuple[float, list[tuple[Floats, Floats]]]:
    """Tips and tool axes at random joints; how far they are off at most, and the poses."""
    joints = rng.uniform(chain.low, chain.high, (rounds(600), law.joints)).round(6)
    lines = [
        " ".join(f"{letter}={value:.6f}" for letter, value in zip(chain.letters, row, strict=True)) for row in joints
    ]
    first = "G21 G90 G17 G94"
    if chain.dialect == "linuxcnc":
        lines = [line.replace("=", "") for line in lines]
    else:
        first = "G710 G90 G17 G94"
    program = machine.with_name("joints.nc")
    program.write_text("\n".join([first, *(f"G1 {line} F1000" for line in lines), "M30", ""]))
    found = rows(machine, program.name)
    assert len(found) == len(joints)
    off, goals = 0.0, []
    for row, at in zip(joints, found, strict=True):
        tip, axis = chain.pose(law, row.tolist())
        ours = (
            np.array([float(at[f"tip_{each}"]) for each in "xyz"]),
            np.array([float(at[f"axis_{each}"]) for each in "ijk"]),
        )
        off = max(off, float(np.linalg.norm(tip - ours[0])), float(np.linalg.norm(axis - ours[1])))
        goals.append((tip, axis))
    assert off < CLOSE, f"forward is off by {off}"
    return off, goals


def inverse(law: Law, chain: Chain, goals: list[tuple[Floats, Floats]], machine: Path) -> float:
    """The words of a program that is posted, in the module: how far it is off the CL file at most."""
    write_cl(machine.with_name("part.cls"), goals, 20)
    said = ["--tool-length", "0"]
    run = post("part.cls", "-m", machine.name, "-o", "part.nc", *said, folder=machine.parent)
    assert run.returncode == 0, run.stderr
    made = [chain.pose(law, joints) for joints in words(machine.with_name("part.nc").read_text(), chain.letters)]
    worst, at = 0.0, 0
    for tip, axis in goals:
        offs = [max(float(np.linalg.norm(tip - one)), float(np.linalg.norm(axis - other))) for one, other in made[at:]]
        near = next((place for place, off in enumerate(offs) if off < POSTED), None)
        assert near is not None, f"{tip} {axis} is not met behind block {at}: nearest {min(offs)}"
        worst, at = max(worst, offs[near]), at + near
    return worst


def drive_ranges(law: Law, poses: Poses, rng: np.random.Generator, machine: Path) -> tuple[float, int]:
    """Least and largest of the joints behind the poses of small programs: how far off at most, and how many. Each is the
    module's of some pose, and no pose of a cut is outside."""
    worst, count = 0.0, 0
    for _ in range(rounds(30)):
        said = [word for setting in poses.say(rng) for word in ("--set", setting)]
        goals = [poses.goal(rng) for _ in range(3)]
        write_cl(machine.with_name("part.cls"), goals, 5)
        summary = ["--summary", "part.json", "--tool-length", "0"]
        run = post("part.cls", "-m", machine.name, "-o", "part.ngc", *summary, *said, folder=machine.parent)
        assert run.returncode == 0, run.stderr
        motions = rows(machine, "part.ngc", *said)
        tips = np.array([[float(row[f"tip_{each}"]) for each in "xyz"] for row in motions])
        angles = [[float(row.get(letter) or 0) for letter in "ABC"] for row in motions]
        theirs = np.array(
            [law.inverse([*(tip + poses.shift), *turn], poses.branch) for tip, turn in zip(tips, angles, strict=True)]
        )
        cut = np.array([row["kind"] == "feed" for row in motions])
        met = [float(np.linalg.norm(tips[cut] - tip, axis=1).min()) for tip, _ in goals]
        assert max(met) < POSTED, f"points that are not met by {max(met)}"
        for drive in json.loads(machine.with_name("part.json").read_text())["drives"]:
            values = theirs[:, int(drive["name"][-1])]
            # The way to the first position, which begins where nobody knows, is in no range.
            ends = (drive["min"], drive["max"])
            off = max(float(np.nanmin(np.abs(values - end))) for end in ends)
            off = max(off, ends[0] - float(values[cut].min()), float(values[cut].max()) - ends[1])
            assert off < POSTED, f"{drive}: the module has {values} at {tips}, {angles}"
            worst, count = max(worst, off), count + 2
    return worst, count


def settle(law: Law) -> None:
    """The module's pins: those of `law`, and of the hexapod its own, which are inches, in mm as the library's file."""
    assert law.library
    for pin, value in law.pins.items():
        law.library.set(pin, value)
    for strut in range(6 if law.name == "genhexkins" else 0):
        for pin in (f"{part}.{strut}.{along}" for part in ("base", "platform") for along in "xyz"):
            place = law.library.pin(pin)
            place[0] = 25.4 * place[0]


@pytest.mark.parametrize("name", MAKERS)
def test_the_file_is_the_module(name: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    law, rng = MAKERS[name](), drawn(31)
    folder = Path(os.environ.get("POST_LINUXCNC_MODULES", MODULES))
    if name == "matrixkins" and not (folder / f"{name}.so").is_file():
        print(
            "matrixkins is not in this LinuxCNC (it came behind 2.9.0~pre1): its manual's matrix is taken in its place"
        )
    else:
        law.library = Module(request.getfixturevalue("stub"), name, folder=folder)
        settle(law)
    told: dict[str, object] = {"module": name, "called": law.library is not None}
    if law.chain:
        joints = tmp_path / "joints.toml"
        joints.write_text(f'name = "{name}"\n{law.chain.text}')
        off, goals = forward(law, law.chain, rng, joints)
        some = [goal for goal in goals if law.chain.near(*goal)][: rounds(120)]
        told |= {
            "forward": off,
            "joints": len(goals),
            "inverse": inverse(law, law.chain, some, joints),
            "posted": len(some),
        }
    poses = tmp_path / "poses.toml"
    poses.write_text(f'name = "{name}"\n{law.poses.text}')
    off, count = drive_ranges(law, law.poses, rng, poses)
    print(json.dumps(told | {"drives": off, "values": count}))


def test_a_wrong_sign_is_seen(stub: ctypes.CDLL, tmp_path: Path) -> None:
    """What the comparison is worth: of each joint of the arm that turns the other way."""
    law = puma()
    assert law.chain
    law.library = Module(stub, "pumakins")
    settle(law)
    machine = tmp_path / "joints.toml"
    for letter in law.chain.letters:
        machine.write_text(
            'name = "arm"\n' + law.chain.text.replace(f"[axis.{letter}]", f"[axis.{letter}]\nreversed = true")
        )
        with pytest.raises(AssertionError, match="forward is off"):
            forward(law, law.chain, np.random.default_rng(1), machine)
