"""Motion of LinuxCNC, a joint position a millisecond, beside what `post` predicts and what the CL file asks for.

    docs/comparing/linuxcnc.py recorded      a program that LinuxCNC 2.9 ran once: ../shared/data/motion
    docs/comparing/linuxcnc.py run           our program of tests/machines/xyzac-trt.cls in LinuxCNC itself, a minute:
                                             ../shared/linuxcnc installs and calls it
"""

import csv
import gzip
import json
import math
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from measuring import ABSENT, CHECKOUT, absent, command, run

SHARED = CHECKOUT.parent / "shared"
MACHINE = Path(__file__).with_name("recorded.toml")
AXES = "XYZAC"
STANDS = 2e-6
"""A joint that changes by less stands, mm and degrees."""

Point = tuple[float, ...]


def minus(one: Sequence[float], other: Sequence[float]) -> Point:
    return tuple(a - b for a, b in zip(one, other))


def dot(one: Sequence[float], other: Sequence[float]) -> float:
    return sum(a * b for a, b in zip(one, other))


def nearest(point: Sequence[float], start: Sequence[float], end: Sequence[float]) -> tuple[float, float]:
    """The distance of a point from a straight piece, and the fraction of it where that is."""
    way, arm = minus(end, start), minus(point, start)
    square = dot(way, way)
    share = min(1.0, max(0.0, dot(way, arm) / square)) if square else 0.0
    return math.dist(arm, tuple(share * each for each in way)), share


def moving(rows: list[Point]) -> list[Point]:
    """Without the time before the first motion and behind the last, a row a millisecond."""

    def stands(one: Point, other: Point) -> bool:
        return max(abs(a - b) for a, b in zip(one, other)) <= STANDS

    first = next(at for at, row in enumerate(rows) if not stands(row, rows[0])) - 1
    last = next(at for at in range(len(rows) - 1, -1, -1) if not stands(rows[at], rows[-1])) + 1
    return rows[first : last + 1]


def predicted(program: Path, machine: Path | str, *more: str) -> list[Point]:
    with tempfile.TemporaryDirectory() as room:
        table = Path(room) / "ours.csv"
        run(command("post"), "predict", program, "-m", machine, "--csv", table, "-q", *more)
        with table.open() as file:
            return moving([tuple(float(row[name]) for name in AXES) for row in csv.DictReader(file)])


def off_path(theirs: list[Point], ours: list[Point]) -> float:
    """How far a recorded position lies from the predicted way of the axes within 0.2 s of it, mm and degrees alike; of some
    2,000 positions."""
    worst = 0.0
    for at in range(0, len(theirs), max(1, len(theirs) // 2000)):
        here = at * len(ours) // len(theirs)
        near = range(max(1, here - 200), min(here + 200, len(ours)))
        worst = max(worst, min(nearest(theirs[at], ours[place - 1], ours[place])[0] for place in near))
    return worst


def compare(theirs: list[Point], ours: list[Point]) -> None:
    seconds, own = (len(theirs) - 1) / 1000, (len(ours) - 1) / 1000
    print(f"LinuxCNC {seconds:.2f} s, predicted {own:.2f} s, {100 * (own / seconds - 1):+.1f} %")
    print(f"axes at most {1000 * off_path(theirs, ours):.1f} µm or m° from the predicted way")


def recorded() -> None:
    folder = SHARED / "data/motion"
    table = folder / "linuxcnc_t1_xyzac_1ms.txt.gz"
    if not table.is_file():
        absent(f"{folder.relative_to(CHECKOUT.parent)} is not beside the checkout")
    with gzip.open(table, "rt") as file:
        theirs = moving([tuple(map(float, line.split()[:5])) for line in file])
    with tempfile.TemporaryDirectory() as room:
        program = Path(room) / "t1.ngc"
        # It was recorded with the tip kept from the start.
        program.write_text("T1 M6\nM428\n" + (folder / "t1.ngc").read_text())
        compare(theirs, predicted(program, MACHINE))


@dataclass(frozen=True)
class Pose:
    """In the frame of the part: the tip, mm, and the tool axis, a unit vector from the tip to the spindle."""

    tip: Point
    axis: Point


def pose(joint: Point, tool: float) -> Pose:
    """The law of xyzac-trt-kins: the A axis lies 20 mm and 10 mm off the C axis."""
    a, c = math.radians(-joint[3]), math.radians(-joint[4])
    x, y, z = joint[0], joint[1] - 20, joint[2] - tool - 10
    y, z = y * math.cos(a) - z * math.sin(a) + 20, y * math.sin(a) + z * math.cos(a) + 10
    tip = (x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c), z)
    return Pose(tip, (math.sin(a) * math.sin(c), -math.sin(a) * math.cos(c), math.cos(a)))


def between(start: Pose, end: Pose, share: float) -> Point:
    """The tool axis on the great circle between two."""
    whole = math.acos(max(-1.0, min(1.0, dot(start.axis, end.axis))))
    if whole < 1e-9:
        return end.axis
    weights = math.sin((1 - share) * whole) / math.sin(whole), math.sin(share * whole) / math.sin(whole)
    return tuple(weights[0] * a + weights[1] * b for a, b in zip(start.axis, end.axis))


def cl_cuts(file: Path) -> dict[int, Pose]:
    """The points of the first run of cuts by their lines, and the two that it is approached over."""
    found: dict[int, Pose] = {}
    axis, feed = (0.0, 0.0, 1.0), False
    for number, line in enumerate(file.read_text().splitlines(), 1):
        word = line.split("/")[0]
        if word == "RAPID" and feed:
            return found
        feed = feed or word == "FEDRAT"
        if word == "GOTO":
            values = [float(value) for value in line.split("/")[1].split(",")]
            axis = tuple(values[3:6]) if len(values) > 3 else axis  # type: ignore[assignment]
            if not feed:
                found = dict(list(found.items())[-1:])
            found[number] = Pose(tuple(values[:3]), tuple(each / math.hypot(*axis) for each in axis))
    return found


def in_linuxcnc() -> None:
    part, tool = CHECKOUT / "tests/machines/xyzac-trt.cls", 30.0
    runner = SHARED / "linuxcnc/run"
    if not runner.is_file():
        absent("shared/linuxcnc is not beside the checkout")
    with tempfile.TemporaryDirectory() as room:
        # The recorder gives LinuxCNC to a user of its own.
        folder = Path(room)
        folder.chmod(0o755)
        program, table, links = folder / "part.ngc", folder / "joints.csv", folder / "map.json"
        said = ["--tool-length", f"{tool:g}"]
        posted = run(command("post"), "-m", "xyzac-trt", part, *said, "-o", program, "-q", "--summary", "-")
        certified = json.loads(posted.stdout)
        tip, axis = (certified[name]["value"] for name in ("tip_deviation_mm", "axis_deviation_deg"))
        print(f"certified: tip {1000 * tip:.3f} µm, tool axis {axis:.4f}°")
        run(command("post"), "verify", program, "-m", "xyzac-trt", "--against", part, *said, "-q", "--map", links)
        done = run(
            *(runner, program, "--machine", "xyzac-trt", "--tool", f"1={tool:g}", "--start", "Z=100", "-o", table),
            accepted=(0, ABSENT),
        )
        if done.returncode == ABSENT:
            absent(done.stderr.strip().splitlines()[-1])
        if "samples lost" in done.stderr:
            absent("the recorder lost samples beside other load: again")
        of_line = {row["nc_line"]: row["cl_line"] for row in json.loads(links.read_text()) if "cl_line" in row}
        with table.open() as file:
            rows = list(csv.DictReader(file))
        points = cl_cuts(part)
        lines = sorted(points)
        tip, axis, count = 0.0, 0.0, 0
        for row in rows:
            end = of_line.get(int(row["line"]))
            if row["motion"] != "feed" or row["kinematics"] != "tcp" or end not in lines[2:]:
                continue
            stance = pose(tuple(float(row[name]) for name in AXES), float(row["tool_z"]))
            # A row may still be on the piece before: joints lag by 2 ms.
            place = lines.index(end)
            pieces = [(points[lines[at - 1]], points[lines[at]]) for at in (place - 1, place)]
            off, share, start, last = min(
                ((*nearest(stance.tip, one.tip, other.tip), one, other) for one, other in pieces), key=lambda it: it[0]
            )
            turned = dot(stance.axis, between(start, last, share))
            tip, axis, count = max(tip, off), max(axis, math.degrees(math.acos(min(1.0, turned)))), count + 1
        print(f"tip at most {1000 * tip:.3f} µm off the CL file, axis at most {axis:.4f}°, {count} positions")
        theirs = moving([tuple(float(row[name]) for name in AXES) for row in rows])
        start = "solution.start={ X = 0, Y = 0, Z = 100, A = 0, C = 0 }"
        compare(theirs, predicted(program, "xyzac-trt", *said, "--set", start))


if __name__ == "__main__":
    {"recorded": recorded, "run": in_linuxcnc}[sys.argv[1]]()
