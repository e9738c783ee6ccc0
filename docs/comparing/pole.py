"""Degrees that C turns along waypoints near a pole, and how far the tool axis is off them.

    docs/comparing/pole.py CHECKOUT [--model simple_curve]     the waypoints and the program that its authors published
    docs/comparing/pole.py --own                               waypoints of the same kind, of our own

CHECKOUT is one of github.com/zhangty019/MultiAxis_3DP_MotionPlanning (BSD-3), Zhang, Chen, Fang, Tian, Wang: Singularity-
Aware Motion Planning for Multi-Axis Additive Manufacturing, IEEE RA-L 6(4), 2021. Nothing of it is kept here.

A pass is a file of waypoints. Told are the sum of the turns of C from waypoint to waypoint, the largest of them, and the
largest angle between the tool axis of the program and that of the waypoint; of `post` the certified one, which holds
between waypoints too.
"""

import argparse
import json
import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

from measuring import absent, command, cuts, run

MACHINE = Path(__file__).with_name("pole.toml")
HEIGHT = 40.5
"""Of the part origin over the crossing of the axes, mm: that of the published programs."""
BOUNDS = (0.05, 1.0, 6.0)
"""Degrees that the tool axis may be off; 6 is the radius of the singular region in the published program."""


@dataclass(frozen=True)
class Waypoint:
    """In the frame of the part: a place, mm, and the tool axis there, a unit vector away from the part."""

    place: tuple[float, float, float]
    axis: tuple[float, float, float]


@dataclass(frozen=True)
class Turned:
    """Of one program: the way of C, its largest step, and how far the tool axis is off at most, degrees."""

    path: float
    step: float
    off: float
    places: float = 0.0
    """How far its places are off the waypoints at most, mm."""


def published_passes(folder: Path) -> list[list[Waypoint]]:
    """A pass a file, in the order of their numbers."""
    files = sorted(folder.glob("*.txt"), key=lambda file: int(file.stem.rstrip("S")))
    if not files:
        absent(f"{folder} has no waypoints")
    passes = []
    for file in files:
        rows = [tuple(map(float, line.split()[:6])) for line in file.read_text().splitlines() if line.strip()]
        passes.append([Waypoint(row[:3], unit(row[3:])) for row in rows])  # type: ignore[arg-type]
    return passes


def own_passes() -> list[list[Waypoint]]:
    """Twenty passes over a cylinder about Y, from one side of its crest to the other and back on the next line.

    A pass leans by up to 3.2° to its side, so that each goes by the pole at another distance, some across it.
    """
    radius, count = 60.0, 81
    passes = []
    for line in range(20):
        side = math.radians((line - 8) * 0.4)
        angles = [math.radians(-15 + 30 * step / (count - 1)) for step in range(count)]
        row = []
        for angle in angles if line % 2 == 0 else reversed(angles):
            place = (radius * math.sin(angle), 0.8 * line, radius * (math.cos(angle) - 1))
            lean = side * math.cos(3 * angle)
            axis = unit((math.sin(angle), math.sin(lean), math.cos(angle)))
            row.append(Waypoint(place, axis))
        passes.append(row)
    return passes


def unit(vector: tuple[float, ...]) -> tuple[float, float, float]:
    size = math.hypot(*vector)
    x, y, z = (value / size for value in vector)
    return x, y, z


def angle(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Between two unit vectors, degrees; the sine and the cosine keep it exact close to 0."""
    cross = (
        one[1] * other[2] - one[2] * other[1],
        one[2] * other[0] - one[0] * other[2],
        one[0] * other[1] - one[1] * other[0],
    )
    return math.degrees(math.atan2(math.hypot(*cross), sum(a * b for a, b in zip(one, other))))


def turned(passes: list[list[Waypoint]], blocks: list[dict[str, float]], name: str) -> Turned:
    """Of a program that has one cut a waypoint."""
    count = sum(map(len, passes))
    if len(blocks) != count:
        absent(f"{name} has {len(blocks)} cuts, and there are {count} waypoints")
    path, step, off, places = 0.0, 0.0, 0.0, 0.0
    rest = iter(blocks)
    for row in passes:
        before = None
        for waypoint in row:
            block = next(rest)
            b, c = math.radians(block["B"]), math.radians(block["C"])
            # The machine's law: the part is turned by C about Z, then by B about Y, and the tool stands along Z.
            axis = (-math.cos(c) * math.sin(b), math.sin(c) * math.sin(b), math.cos(b))
            off = max(off, angle(axis, waypoint.axis))
            x, y = waypoint.place[0], waypoint.place[1]
            x, y, z = math.cos(c) * x - math.sin(c) * y, math.sin(c) * x + math.cos(c) * y, waypoint.place[2] + HEIGHT
            placed = (math.cos(b) * x + math.sin(b) * z, y, -math.sin(b) * x + math.cos(b) * z)
            places = max(places, math.dist(placed, tuple(block[letter] for letter in "XYZ")))
            if before is not None:
                path, step = path + abs(block["C"] - before), max(step, abs(block["C"] - before))
            before = block["C"]
    return Turned(path, step, off, places)


def cl_file(passes: list[list[Waypoint]]) -> str:
    lines = ["UNITS/MM", "CUTTER/0.8", "LOADTL/1", "SPINDL/RPM,1,CLW"]
    for row in passes:
        numbers = [
            "GOTO/" + ",".join(f"{value:.9f}" for value in (*waypoint.place, *waypoint.axis)) for waypoint in row
        ]
        first = row[0]
        above = tuple(place + 20 * axis for place, axis in zip(first.place, first.axis))
        lines += ["RAPID", "GOTO/" + ",".join(f"{value:.9f}" for value in (*above, *first.axis))]
        lines += ["FEDRAT/1500,MMPM", *numbers]
    return "\n".join([*lines, "RAPID", "GOTO/0,0,100,0,0,1", "FINI", ""])


def posted(passes: list[list[Waypoint]], *settings: str) -> Turned:
    """By `post`, the tip kept to its tolerance, points put in where that asks for them."""
    with tempfile.TemporaryDirectory() as room:
        part, program, summary = (Path(room) / name for name in ("part.cls", "part.ngc", "summary.json"))
        part.write_text(cl_file(passes))
        words = [word for setting in settings for word in ("--set", setting)]
        words += ["--mount", f"0,0,{HEIGHT}", "--tool-length", "0", "-o", program, "--summary", summary, "-q"]
        run(command("post"), "-m", MACHINE, part, *words)
        told = json.loads(summary.read_text())
        pieces = [[block["C"] for block in piece] for piece in cuts(program.read_text())]
        steps = [abs(after - before) for piece in pieces for before, after in zip(piece, piece[1:])]
        return Turned(sum(steps), max(steps), told["axis_deviation_deg"]["value"])


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("checkout", nargs="?", type=Path)
    asked.add_argument("--model", default="simple_curve")
    asked.add_argument("--own", action="store_true")
    given = asked.parse_args()
    if given.own:
        passes = own_passes()
        print(f"waypoints: {sum(map(len, passes))} in {len(passes)} passes, our own")
    else:
        data = (given.checkout or Path()) / "DataSet"
        program = data / f"Gcode/{given.model}_Gcode.txt"
        if given.checkout is None or not program.is_file():
            absent("the authors' repository (zhangty019/MultiAxis_3DP_MotionPlanning) is not beside the checkout")
        passes = published_passes(data / f"Sorce/{given.model}/waypoint")
        print(f"waypoints: {sum(map(len, passes))} in {len(passes)} passes, {given.model}")
        blocks = [block for pieces in cuts(program.read_text()) for block in pieces]
        theirs = turned(passes, blocks, program.name)
        print(f"published program: C {theirs.path:.0f}°, at most {theirs.step:.1f}° a block, axis off {theirs.off:.2f}°")
        print(f"its places are within {theirs.places:.3f} mm of the waypoints")
    exact = posted(passes, "solution.pole=exact")
    print(f"post, met exactly: C {exact.path:.0f}°, at most {exact.step:.1f}° a block, axis off {exact.off:.3f}°")
    for bound in BOUNDS:
        ours = posted(passes, f"accuracy.axis_tolerance={bound}")
        print(
            f"post, within {bound:g}°: C {ours.path:.0f}°, at most {ours.step:.1f}° a block, "
            f"axis off {ours.off:.3f}° (certified)"
        )


if __name__ == "__main__":
    main()
