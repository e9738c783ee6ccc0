"""Random CL programs: operations, as lines of a CL file and as what is asked of the machine."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from oracle.machine import Machine, turn

Floats = np.ndarray


@dataclass(frozen=True)
class Leg:
    """A way at feed: from the point before to ``points[-1]``, the arc of a circle in short chords."""

    points: Floats
    axes: Floats
    length: float = 0.0
    arc: tuple[Floats, Floats, float, float] | None = None
    """Centre, normal, radius and degrees, right-handed."""


@dataclass(frozen=True)
class Operation:
    """An approach at rapid to ``start``, cuts, and a way out; holes of a cycle if there is one."""

    start: Floats
    axis: Floats
    legs: tuple[Leg, ...]
    tool: int = 1
    spindle: float = 5000.0
    unit: str = "MMPM"
    feed: float = 800.0
    coolant: str = ""
    dwell: float = 0.0
    cycle: str = ""
    depth: float = 0.0
    peck: float = 0.0

    @property
    def pecks(self) -> int:
        """How many whole pecks the depth has."""
        return round(self.depth / self.peck)

    def feed_a_minute(self) -> float:
        """mm/min."""
        return self.feed * (abs(self.spindle) if self.unit == "MMPR" else 1.0)


@dataclass(frozen=True)
class Job:
    """Operations in their order; ``inch``: the CL file counts in inches."""

    operations: tuple[Operation, ...]
    inch: bool = False
    options: tuple[str, ...] = ()
    dialect: str = "fanuc"
    lengths: dict[int, float] = field(default_factory=dict)

    def text(self) -> str:
        """The CL file."""
        unit = 25.4 if self.inch else 1.0
        lines = ["PARTNO/PROPERTIES", f"UNITS/{'INCHES' if self.inch else 'MM'}", "MULTAX/ON"]
        tool = None

        def goto(tip: Floats, axis: Floats) -> str:
            return "GOTO/" + ",".join(f"{value:.10f}" for value in [*(tip / unit), *axis])

        for one in self.operations:
            if one.tool != tool:
                lines.append(f"LOADTL/{one.tool}")
                tool = one.tool
            lines.append(f"SPINDL/RPM,{abs(one.spindle):.0f},{'CLW' if one.spindle > 0 else 'CCLW'}")
            lines.append(f"COOLNT/{one.coolant or 'OFF'}")
            per = {"MMPM": "IPM", "MMPR": "IPR"}[one.unit] if self.inch else one.unit
            speed = f"{one.feed / unit:.8f}"
            lines += ["RAPID", goto(one.start, one.axis)]
            if one.dwell:
                lines.append(f"DELAY/{one.dwell:.3f}")
            if one.cycle:
                deep = f"FEDTO,{-one.depth / unit:.8f}"
                peck = f"STEP,{one.peck / unit:.8f}," if one.cycle == "DEEP" else ""
                lines.append(f"CYCLE/{one.cycle},{deep},{peck}{per},{speed},RAPTO,{3 / unit:.8f}")
                lines += [goto(leg.points[-1], leg.axes[-1]) for leg in one.legs]
                lines.append("CYCLE/OFF")
            else:
                lines.append(f"FEDRAT/{speed},{per}")
                for leg in one.legs:
                    if leg.arc:
                        centre, normal, radius, sweep = leg.arc
                        numbers = [*(centre / unit), *normal, radius / unit]
                        about = ",".join(f"{value:.10f}" for value in numbers)
                        lines.append(f"MOVARC/{about},ANGLE,{sweep:.10f}")
                    lines.append(goto(leg.points[-1], leg.axes[-1]))
            last = one.legs[-1]
            lines += ["RAPID", goto(last.points[-1] + 25 * last.axes[-1], last.axes[-1])]
        return "\n".join([*lines, "SPINDL/OFF", "FINI", ""])

    def smaller(self) -> list[Job]:
        """The same with something left out."""
        found = []
        many = self.operations
        for place in range(len(many)):
            if len(many) > 1:
                found.append(replace(self, operations=many[:place] + many[place + 1 :]))
        for place in range(0, len(self.options), 2):
            found.append(replace(self, options=self.options[:place] + self.options[place + 2 :]))
        if self.inch:
            found.append(replace(self, inch=False))
        for place, one in enumerate(many):
            others = [replace(one, legs=one.legs[: len(one.legs) // 2])] if len(one.legs) > 1 else []
            others += [replace(one, legs=one.legs[:-1])] if len(one.legs) > 1 else []
            if one.coolant:
                others.append(replace(one, coolant=""))
            if one.dwell:
                others.append(replace(one, dwell=0.0))
            if one.unit != "MMPM":
                others.append(replace(one, unit="MMPM", feed=500.0))
            found += [replace(self, operations=(*many[:place], other, *many[place + 1 :])) for other in others]
        return found


def lean(machine: Machine, turned: dict[str, Floats], count: int) -> Floats:
    """Tool axes in the frame of the part where the rotary axes show that."""
    q = np.zeros((count, len(machine.axes)))
    for place, axis in enumerate(machine.axes):
        if axis.rotary:
            q[:, place] = axis.value(turned[axis.name])
    led, _ = machine.place(len(machine.axes), q)
    held, _ = machine.place(0, q)
    return np.einsum("nji,nj->ni", held, led @ machine.tool_axis)


def drawn_turns(rng: np.random.Generator, machine: Machine, count: int, still: bool) -> dict[str, Floats]:
    """What rotary axes show on a smooth way."""
    share, found = np.linspace(0, 1, count), {}
    for axis in machine.axes:
        if axis.rotary:
            most = 160.0 if axis.carries_part else 80.0
            way = 0.0 if still else rng.uniform(0, 0.4) * most
            found[axis.name] = rng.uniform(-most / 2, most / 2) + way * np.sin(rng.uniform(0.5, 2) * share * 2)
    return found


def line(begin: Floats, end: Floats, one: Floats, other: Floats) -> Leg:
    """A straight leg."""
    return Leg(np.array([begin, end]), np.array([one, other]), float(np.linalg.norm(end - begin)))


def circle(rng: np.random.Generator, begin: Floats, axis: Floats) -> Leg:
    """An arc about a line along the tool, with or against it."""
    normal = axis * rng.choice([-1, 1])
    across = np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    across /= np.linalg.norm(across)
    radius, sweep = float(rng.uniform(2, 30)), float(rng.choice([rng.uniform(10, 170), rng.uniform(190, 350)]))
    centre = begin + radius * (turn(axis, np.array([rng.uniform(0, 6.28)]))[0] @ across)
    shares = np.linspace(0, math.radians(sweep), 1 + int(sweep / 0.5))
    points = centre + turn(normal, shares) @ (begin - centre)
    return Leg(points, np.tile(axis, (len(points), 1)), radius * math.radians(sweep), (centre, normal, radius, sweep))


def operation(rng: np.random.Generator, machine: Machine) -> Operation:
    """A cut of five axes, one in a plane with arcs, or holes."""
    kind = str(rng.choice(["five", "plane", "upright", "holes"]))
    count = int(rng.integers(2, 9))
    turns = drawn_turns(rng, machine, count, kind != "five")
    upright = kind == "upright" or (kind == "holes" and rng.random() < 0.5)
    axes = np.tile(machine.tool_axis, (count, 1)) if upright else lean(machine, turns, count)
    axes = (axes / np.linalg.norm(axes, axis=1)[:, None]).round(10)
    at = rng.uniform(-50, 50, 3)
    share = np.linspace(0, 1, count)[:, None]
    tips = (at + rng.uniform(5, 40, 3) * np.sin(rng.uniform(0.5, 3, 3) * share * 2)).round(6)
    cycle = str(rng.choice(["DRILL", "DEEP"])) if kind == "holes" else ""
    start = (tips[0] + float(rng.uniform(5, 30)) * axes[0]).round(6)
    legs: list[Leg] = []
    last, before = start, axes[0]
    for tip, axis in zip(tips, axes):
        if kind in ("plane", "upright") and legs and rng.random() < 0.4:
            leg = circle(rng, last, axis)
        else:
            leg = line(last, tip, before, axis)
        legs.append(leg)
        last, before = leg.points[-1], axis
    depth = round(float(rng.uniform(2, 25)), 3)
    peck = depth / int(rng.integers(2, 6)) if rng.random() < 0.1 else round(depth * float(rng.uniform(0.2, 1.2)), 3)
    per_turn = rng.random() < 0.15
    return Operation(
        start,
        axes[0],
        tuple(legs),
        int(rng.integers(1, 3)),
        float(rng.integers(500, 9000) * rng.choice([-1, 1], p=[0.1, 0.9]))
        if not cycle
        else float(rng.integers(500, 9000)),
        "MMPR" if per_turn else "MMPM",
        round(float(rng.uniform(0.05, 0.4)), 3) if per_turn else float(rng.integers(100, 3000)),
        str(rng.choice(["", "FLOOD", "MIST"])),
        round(float(rng.uniform(0.2, 3)), 1) if rng.random() < 0.2 else 0.0,
        cycle,
        depth,
        peck,
    )
