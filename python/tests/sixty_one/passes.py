"""CL files that fit the freedoms of a machine: points and tool axes in the part's frame, and the text of the file."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

Floats = np.ndarray


@dataclass(frozen=True)
class Pass:
    """One cut: where it comes from at rapid, the points that it is led along, and where it goes at rapid."""

    tips: Floats
    axes: Floats
    above: Floats
    away: Floats


@dataclass(frozen=True)
class Work:
    """What a machine is given: its cuts, and what the file says besides."""

    passes: tuple[Pass, ...]
    head: tuple[str, ...] = ("SPINDL/3000,CLW",)
    feed: str = "FEDRAT/600,MMPM"
    tail: tuple[str, ...] = ("SPINDL/OFF",)
    edged: bool = False
    """The tool's edge goes along the travel."""
    signs: tuple[str, ...] = ()
    """Records before each pass: of channels that wait."""
    operations: bool = False
    """Each pass is an operation of its own."""
    turned: tuple[float, ...] = ()
    """By how much a table B is set before each pass, degrees: ROTABL, and the file's points stand in the turned
    frame."""

    def text(self) -> str:
        """The CL file."""
        lines = ["PARTNO/SIXTY-ONE", "UNITS/MM", "LOADTL/1", *self.head, "MULTAX/ON"]
        for number, one in enumerate(self.passes):
            # Points of APT's digits: what the file says is what is held against the program.
            lines += self.signs[number : number + 1]
            lines += [f"TOOL PATH/CUT_{number},TOOL,T1"] if self.operations else []
            angle = self.turned[number] if self.turned else 0.0
            lines += [f"ROTABL/BAXIS,{angle:.6f}"] if self.turned else []
            back = about_y(-angle)
            lines += ["RAPID", goto(back @ one.above, back @ one.axes[0]), self.feed]
            lines += [goto(back @ tip, back @ axis) for tip, axis in zip(one.tips, one.axes)]
            lines += ["RAPID", goto(back @ one.away, back @ one.axes[-1])]
            lines += ["END-OF-PATH"] if self.operations else []
        return "\n".join([*lines, *self.tail, "FINI", ""])


def about_y(degrees: float) -> Floats:
    """A turn, right-handed."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def goto(tip: Floats, axis: Floats) -> str:
    """A point and the tool's axis there."""
    return "GOTO/" + ",".join(f"{value:.9f}" for value in [*tip, *axis])


def cut(tips: object, axes: object, room: float = 20.0) -> Pass:
    """A cut that comes along the tool's axis from ``room`` mm above its first point."""
    points = np.array(tips, float)
    ways = np.broadcast_to(np.array(axes, float), points.shape)
    ways = ways / np.linalg.norm(ways, axis=1)[:, None]
    return Pass(points, ways, points[0] + room * ways[0], points[-1] + room * ways[-1])


def frame(up: object) -> tuple[Floats, Floats, Floats]:
    """Two directions across ``up``, and it."""
    three = np.array(up, float) / np.linalg.norm(np.array(up, float))
    one = np.cross(three, [0.0, 0.0, 1.0] if abs(three[2]) < 0.9 else [1.0, 0.0, 0.0])
    one /= np.linalg.norm(one)
    return one, np.cross(three, one), three


def flat(up: object = (0, 0, 1), size: float = 30.0) -> Work:
    """Fixed tool: a hexagon with a step, and a hole plunged beside it."""
    one, two, three = frame(up)
    corners = [
        size * (math.cos(angle) * one + 0.8 * math.sin(angle) * two) + lift * three
        for angle, lift in zip(np.radians([0, 60, 120, 180, 240, 300, 360]), [0, 0, 4, 4, 9, 0, 0])
    ]
    hole = [7 * one - 11 * two + depth * three for depth in (2.0, -6.0, 2.0)]
    return Work((cut(corners, three), cut(hole, three)))


def dome(
    up: object = (0, 0, 1), least: float = 8.0, most: float = 35.0, radius: float = 40.0, turn: float = 250.0
) -> Work:
    """Over a dome the tool stands across its face, leaning by ``least`` to ``most`` degrees, and goes around by
    ``turn``; on a slope it leans another way."""
    one, two, three = frame(up)
    axes = []
    for share in np.linspace(0, 1, 15):
        lean, around = math.radians(least + (most - least) * share), math.radians(20 + turn * share)
        axes.append(math.sin(lean) * (math.cos(around) * one + math.sin(around) * two) + math.cos(lean) * three)
    ways = np.array(axes)
    lowered = radius * (ways - three)
    slope = np.array([x * one + (0.3 * x + 9) * two + 0.1 * abs(x) * three for x in (-24.0, -8.0, 8.0, 31.0)])
    tipped = np.array([math.sin(a) * two + math.cos(a) * three for a in np.radians(np.linspace(-most / 2, -least, 4))])
    return Work((cut(lowered, ways), cut(slope, tipped)))


def around(
    line: object,
    start: object,
    degrees: float = 140.0,
    radius: float = 25.0,
    climb: float = 12.0,
    beside: float = 5.0,
    lean: float = 0.0,
) -> Work:
    """A groove around ``line`` from the side of ``start``, the tool across it or leaning along it by ``lean``
    degrees, and two holes that pass the line by ``beside``."""
    along, side = np.array(line, float), np.array(start, float)
    third = np.cross(along, side)
    angles = np.radians(np.linspace(0, degrees, 12))
    ways = np.array([math.cos(angle) * side + math.sin(angle) * third for angle in angles])
    groove = radius * ways + np.linspace(0, climb, 12)[:, None] * along
    tipped = np.radians(np.linspace(lean / 2, lean, 12))[:, None]
    leant = np.cos(tipped) * ways + np.sin(tipped) * along
    holes = []
    for angle in np.radians([35.0, 110.0]):
        way = math.cos(angle) * side + math.sin(angle) * third
        aside = beside * np.cross(along, way) - 6 * along
        holes.append(cut([(radius + depth) * way + aside for depth in (2.0, -5.0, 2.0)], way))
    return Work((cut(groove, leant), *holes))


def face() -> Work:
    """On the end of a bar: a flat through a point beside the centre, a slot through it, holes."""
    up = (0, 0, 1)
    flat_ = [[18, y, -2] for y in (-14, -5, 5, 14)]
    slot = [[10, 4, -1], [-10, -4, -1]]
    hole = [[-9, 12, z] for z in (2, -8, 2)]
    edge = [[-20, -8, -3], [-6, -17, -3], [14, -15, -3]]
    return Work((cut(flat_, up), cut(slot, up), cut(hole, up), cut(edge, up)), operations=True)


def meridian() -> Work:
    """X, Z, B and C: in planes through the line of C the tool leans and goes along a cone; another plane at 70
    degrees."""
    passes = []
    for degrees in (0.0, 70.0, -130.0):
        side = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])
        leans = np.radians([20.0, 30.0, 45.0, 60.0, 75.0])
        axes = [math.sin(a) * side + math.cos(a) * np.array([0, 0, 1.0]) for a in leans]
        tips = [(14 + 5 * k) * side + np.array([0, 0, -1.5 * k * k]) for k in range(5)]
        passes.append(cut(tips, axes))
    return Work(tuple(passes))


def turned(side: float = 1.0) -> Work:
    """A contour in X and Z, x a radius: a face, a shaft with a cone, a groove's end."""
    contour = [[side * x, 0, z] for x, z in ((20, 2), (20, -20), (22, -25), (25.1, -29.6), (30, -31), (36, -31))]
    end = [[side * x, 0, 0] for x in (22.0, 6.0)]
    up = np.array([0, 0, 1.0])
    first = Pass(
        np.array(end, float), np.broadcast_to(up, (2, 3)), np.array([side * 24, 0, 5.0]), np.array([side * 20, 0, 5.0])
    )
    second = Pass(
        np.array(contour, float),
        np.broadcast_to(up, (6, 3)),
        np.array([side * 20, 0, 4.0]),
        np.array([side * 40, 0, 4.0]),
    )
    return Work(
        (first, second),
        ("MODE/TURN", "SPINDL/180,SMM,MAXRPM,3000,CLW"),
        "FEDRAT/0.2,MMPR",
    )


def outline(up: object = (0, 0, 1), size: float = 60.0) -> Work:
    """A knife's way: a straight, a bend of chords, a straight, each along the edge."""
    one, two, three = frame(up)
    angles = np.radians(np.linspace(-90, 90, 25))
    bend = [size * (math.cos(a) * one + math.sin(a) * two) for a in angles]
    points = [bend[0] - 40 * one, *bend, bend[-1] - 40 * one]
    return Work((cut(points, three),), (), "FEDRAT/3000,MMPM", (), True)


def laid(least: float, most: float) -> Work:
    """A knife or roller along a bent way, its axis leaning: chords of 3 degrees."""
    points, axes = [], []
    for share in np.linspace(0, 1, 31):
        angle = math.radians(-60 + 120 * share)
        points.append([90 * math.cos(angle) - 60, 90 * math.sin(angle), 10 * share])
        lean = math.radians(least + (most - least) * share)
        axes.append([math.sin(lean) * math.cos(angle), math.sin(lean) * math.sin(angle), math.cos(lean)])
    return Work((cut(points, axes),), (), "FEDRAT/2000,MMPM", (), True)


def wound(radius: float = 300.0) -> Work:
    """Tape on a mandrel along X: the roller's axis stands across its face while it is led around and along."""
    points, axes = [], []
    for angle in np.radians(np.linspace(60, 120, 25)):
        way = np.array([0, math.cos(angle), math.sin(angle)])
        points.append(radius * way + np.array([3.0 * math.degrees(angle - math.radians(60)), 0, 0]))
        axes.append(way)
    return Work((cut(points, axes),), (), "FEDRAT/4000,MMPM", (), True)


def printed(work: Work) -> Work:
    """The same without a spindle."""
    return Work(work.passes, (), "FEDRAT/900,MMPM", (), work.edged)


def cone(up: object, line: object, radius: float = 30.0) -> Work:
    """A tool that keeps its angle to ``line`` and turns about it, around a ring, and along a straight with it
    standing."""
    third, lean = np.array(line, float), np.array(up, float) / np.linalg.norm(np.array(up, float))
    across = lean - (lean @ third) * third
    side = np.cross(third, across)
    points, axes = [], []
    for angle in np.radians(np.linspace(0, 200, 21)):
        way = math.cos(angle) * across + math.sin(angle) * side
        points.append(radius * way / np.linalg.norm(way))
        axes.append(way + (lean @ third) * third)
    straight = [[-20.0, 5.0, 3.0], [20.0, 9.0, 3.0]]
    return Work((cut(points, axes, 10.0), cut(straight, axes[6], 10.0)), (), "FEDRAT/900,MMPM", ())


def gaps(teeth: int = 8, radius: float = 30.0) -> Work:
    """Tooth gaps in a wheel about Z: across it and along Z, from one to the next."""
    passes = []
    for number in range(0, teeth, 3):
        angle = 2 * math.pi * number / teeth
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        aside = 1.5 * np.cross([0, 0, 1.0], way)
        passes.append(cut([radius * way + aside + np.array([0, 0, z]) for z in (12.0, -12.0)], way))
    return Work(tuple(passes))


def sided(angles: tuple[float, ...] = (0.0, 90.0, 37.0), radius: float = 80.0) -> Work:
    """Holes and a straight in the faces of a column about Y, a face at a time."""
    passes = []
    for degrees in angles:
        way = np.array([math.sin(math.radians(degrees)), 0, math.cos(math.radians(degrees))])
        aside = np.cross([0, 1, 0], way)
        hole = [radius * way + 12 * aside + np.array([0, 20, 0]) + depth * way for depth in (2.0, -9.0, 2.0)]
        line = [radius * way + x * aside + np.array([0, 30 + 0.2 * x, 0]) for x in (-20.0, 20.0)]
        passes += [cut(hole, way), cut(line, way)]
    return Work(tuple(passes))


def beside() -> Work:
    """On a mantle with Y: holes beside the line of C, square to flats, and a flat milled along Z."""
    passes = []
    for degrees in (0.0, 50.0, 200.0):
        way = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])
        aside = np.cross([0, 0, 1.0], way)
        passes.append(
            cut([22 * way + 9 * aside + np.array([0, 0, -15.0]) + depth * way for depth in (2.0, -4.0, 2.0)], way)
        )
        passes.append(cut([21 * way + y * aside + np.array([0, 0, -30.0 - 0.2 * y]) for y in (-12.0, 12.0)], way))
    return Work(tuple(passes))


def level() -> Work:
    """An outline in one plane, of a wire that stands upright."""
    points = [[30 * math.cos(a), 22 * math.sin(a), 0.0] for a in np.radians(np.linspace(0, 340, 18))]
    tips = np.array(points)
    return Work(
        (Pass(tips, np.broadcast_to([0, 0, 1.0], tips.shape), np.array([12.0, 3.0, 0.0]), np.array([12.0, 3.0, 0.0])),)
    )


def sawn() -> Work:
    """Cuts of a disc, from one side of a slab to the other: its arbor lies across the way."""
    passes = []
    for degrees in (0.0, 90.0, 30.0):
        way = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])
        arbor = np.cross([0, 0, 1.0], way)
        points = np.array([x * way + 20 * arbor for x in (-200.0, -60.0, 200.0)])
        passes.append(Pass(points, np.broadcast_to(arbor, (3, 3)), points[0] - 60 * way, points[-1] + 60 * way))
    return Work(tuple(passes), ("SPINDL/1500,CLW",), "FEDRAT/2000,MMPM", ("SPINDL/OFF",), True)


def walls() -> Work:
    """Two layers of a printed ring."""
    rounds = [[25 * math.cos(a), 18 * math.sin(a), 0.4] for a in np.radians(np.linspace(0, 350, 25))]
    second = [
        [22 * math.cos(a), 16 * math.sin(a), 0.8 + 0.02 * n] for n, a in enumerate(np.radians(np.linspace(0, 330, 19)))
    ]
    return printed(Work((cut(rounds, (0, 0, 1), 5.0), cut(second, (0, 0, 1), 5.0))))


def along_rail(reach: float) -> Work:
    """A way along Y that is longer than an arm, the tool leaning to both sides."""
    share = np.linspace(-1, 1, 33)
    points = np.stack([30 * np.cos(3 * share), reach * share, 10 * share], axis=1)
    lean = np.radians(12 * np.sin(4 * share))
    axes = np.stack([np.sin(lean) * 0.5, np.sin(lean), np.ones_like(lean)], axis=1)
    return Work((cut(points, axes, 40.0),))


def bowl(radius: float, lean: float, degrees: float) -> Work:
    """Around a ring, the tool leaning outwards."""
    points, axes = [], []
    for angle in np.radians(np.linspace(150, 150 + degrees, 41)):
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        points.append(radius * way)
        axes.append(math.sin(math.radians(lean)) * way + np.array([0, 0, math.cos(math.radians(lean))]))
    return Work((cut(points, axes, 40.0),))


def waiting(side: float) -> Work:
    """As ``turned``, where the channels wait for one another before each cut."""
    return replace(turned(side), signs=("SYNC/1", "SYNC/2"))
