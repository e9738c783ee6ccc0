"""The motions of an NC program: where each axis is on the way."""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from oracle.machine import Machine


@dataclass
class Motion:
    """A motion: where each axis is at shares of it. ``boxed``: the axes go for themselves between ``ends``."""

    line: int
    rapid: bool
    tool: int | None
    ends: np.ndarray
    at: Callable[[np.ndarray], np.ndarray]
    boxed: bool
    keeps_tip: bool
    turns: bool
    curved: bool
    withdraws: bool


class Unread(Exception):
    """A word that this reader does not know."""


PLANES = {17: "XY", 18: "ZX", 19: "YZ"}


@dataclass
class Arc:
    """G2 or G3, and I J K from its start, or R."""

    plane: int
    left: bool
    words: dict[str, float]


def arc_points(arc: Arc, a: np.ndarray, b: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Points on the arc from a to b, XYZ: radius, turn and height go evenly."""
    pick = ["XYZ".index(letter) for letter in PLANES[arc.plane]]
    (first, last), sense = (a[pick], b[pick]), 1.0 if arc.left else -1.0
    if "R" in arc.words:
        radius, chord = arc.words["R"], last - first
        half = np.linalg.norm(chord) / 2
        side = np.array([-chord[1], chord[0]]) / (2 * half)
        centre = (first + last) / 2 + side * math.sqrt(max(radius**2 - half**2, 0.0)) * sense * math.copysign(1, radius)
    else:
        centre = first + [arc.words.get("IJK"[place], 0.0) for place in pick]
    begin, end = (math.atan2(*(point - centre)[::-1]) for point in (first, last))
    way = (end - begin) * sense % (2 * math.pi)
    if way < 1e-9 or np.array_equal(first, last):
        way = 2 * math.pi
    radii = [np.linalg.norm(point - centre) for point in (first, last)]
    points = a + (b - a) * t[:, None]
    angle, radius = begin + way * sense * t, radii[0] + (radii[1] - radii[0]) * t
    points[:, pick[0]] = centre[0] + radius * np.cos(angle)
    points[:, pick[1]] = centre[1] + radius * np.sin(angle)
    return points


CODES = {*range(5), 8, 17, 18, 19, 21, 40, 43, 43.4, 49, 53, 54, 61, 64, 69, 80, 90, 91, 91.1, 92.2, 93, 94, 97, 98, 99}
MEASURED = 1.8e-3
"""A tool that leans from the slide along it by less than this (0.1 degrees) was measured so, mm of a mm of length."""
CYCLES = {73, 81, 82, 83, 84, 85, 86, 89}


class Reader:
    """A program in the language of Fanuc or LinuxCNC, as far as post writes it and the tests do."""

    def __init__(self, machine: Machine, lengths: dict[int, float]) -> None:
        self.machine, self.lengths = machine, lengths
        self.work_zero = functools.cache(machine.work_zero)
        self.zero = {**{axis.name: 0.0 for axis in machine.axes}, **self.work_zero(0.0)}
        self.shown = {axis.name: float(axis.shown(0.0)) for axis in machine.axes}
        self.mode, self.plane, self.absolute, self.tcp = 0, 17, True, False
        self.offset: float | None = None
        self.tool: int | None = None
        self.called: int | None = None
        self.cycle: dict[str, float] = {}
        self.initial, self.height = False, 0.0
        self.along = "XYZ"[int(np.argmax(np.abs(machine.tool_axis)))]
        along = next(axis.direction for axis in machine.axes if axis.name == self.along)
        self.leans = float(np.linalg.norm(along * np.sign(along @ machine.tool_axis) - machine.tool_axis))

    def counted_from(self) -> dict[str, float]:
        """What the control shows where the words are zero: its one work offset, and its length along one slide while that is
        called. Where the tool leans from that slide by as little as is measured, the offset was measured with this tool, as
        the warning of ``post`` asks; else with the gauge point."""
        called = self.offset or 0.0
        length = self.lengths.get(self.tool or 0, self.offset or 0.0)
        measured = length if self.leans < MEASURED else 0.0
        zero = {**self.zero, **self.work_zero(measured)}
        # One unit of that slide's word is a mm along it, whichever way it points.
        return {**zero, self.along: zero[self.along] + called - measured}

    def joints(self, at: dict[str, float]) -> np.ndarray:
        """Axis values of what the control shows: one row."""
        return np.array([[float(axis.value(at[axis.name])) for axis in self.machine.axes]])

    def motions(self, text: str) -> Iterator[Motion]:
        """Block by block."""
        names = {axis.name for axis in self.machine.axes}
        for line, block in enumerate(text.splitlines(), 1):
            block = re.sub(r"\(.*?\)|;.*", "", block).strip().upper()
            if not block or block[0] in "%O":
                continue
            words = re.findall(r"([A-Z])\s*([-+]?[\d.]+)", block)
            if "".join(letter + value for letter, value in words) != block.replace(" ", ""):
                raise Unread(f"{line}: {block}")
            codes = {float(value) for letter, value in words if letter == "G"}
            switches = {int(value) for letter, value in words if letter == "M"}
            axes = {letter: float(value) for letter, value in words if letter in names}
            others = {letter: float(value) for letter, value in words if letter in "IJKRHTQ"}
            if codes - CODES - CYCLES or switches & {98, 99}:
                raise Unread(f"{line}: {block}")
            self._states(codes, switches, others)
            if codes & CYCLES or (self.cycle and axes):
                yield from self._hole(line, axes, others)
                continue
            arc = self.mode in (2, 3) and bool(set(others) & set("IJK"))
            if axes or arc:
                motion = self.move(line, axes, self.mode, others, 53 in codes)
                if motion is not None:
                    yield motion

    def _states(self, codes: set[float], switches: set[int], others: dict[str, float]) -> None:
        linuxcnc = self.machine.dialect == "linuxcnc"
        for code in codes:
            if code in (0, 1, 2, 3):
                self.mode = int(code)
            elif code in PLANES:
                self.plane = int(code)
            elif code in (90, 91):
                self.absolute = code == 90
            elif code in (98, 99):
                self.initial = code == 98
        if codes & {0, 1, 2, 3, 80}:
            self.cycle = {}
        if "T" in others:
            self.called = int(others["T"])
        if 6 in switches:
            self.tool = self.called
        if codes & {43, 43.4}:
            self.offset = self.lengths[int(others.get("H", self.tool or 0))]
        if 49 in codes:
            self.offset = None
        if linuxcnc and switches & {428, 429}:
            self.tcp = 428 in switches
        if not linuxcnc and codes & {43, 43.4, 49}:
            self.tcp = 43.4 in codes

    def _hole(self, line: int, axes: dict[str, float], others: dict[str, float]) -> Iterator[Motion]:
        """A cycle: over the hole, down to R, at feed to Z, and out; pecks go up and down on the same way."""
        fresh = not self.cycle
        self.cycle = {**self.cycle, **{key: axes[key] for key in "Z" if key in axes}}
        self.cycle |= {key: others[key] for key in "R" if key in others}
        if fresh:
            self.height = self.shown["Z"] - self.counted_from()["Z"]
        over = {key: value for key, value in axes.items() if key != "Z"}
        out = max(self.height, self.cycle["R"]) if self.initial else self.cycle["R"]
        for axes, mode in ((over, 0), ({"Z": self.cycle["R"]}, 0), ({"Z": self.cycle["Z"]}, 1), ({"Z": out}, 0)):
            motion = self.move(line, axes, mode, {}, False)
            if motion is not None:
                yield motion

    def move(
        self, line: int, axes: dict[str, float], mode: int, others: dict[str, float], machine_words: bool
    ) -> Motion | None:
        """A motion to ``axes``, by G0 to G3; none where nothing moves."""
        machine, start, to, zero = self.machine, dict(self.shown), dict(self.shown), self.counted_from()
        keeps = self.tcp and not machine_words
        length = self.offset or self.lengths.get(self.tool or 0, 0.0)
        first = self.joints(start)
        here = machine.tip_in_part(first, length)[0]
        goal = here.copy()
        for letter, value in axes.items():
            if keeps and letter in "XYZ":
                goal["XYZ".index(letter)] = value + (0 if self.absolute else goal["XYZ".index(letter)])
            elif machine_words:
                to[letter] = value
            elif not self.absolute:
                to[letter] += value
            else:
                to[letter] = value + zero[letter]
        curved = mode in (2, 3) and not machine_words
        arc = Arc(self.plane, mode == 3, others) if curved else None
        if keeps:
            at = functools.partial(self._led, start, to, here, goal, arc, length)
            end = at(np.ones(1))
            for place in machine.slides():
                to[machine.axes[place].name] = float(machine.axes[place].shown(end[0, place]))
        else:
            at = functools.partial(self._free, start, to, arc)
            end = self.joints(to)
        moving = (np.abs(first - end) > 1e-9)[0]
        if not moving.any() and not curved:
            return None
        self.shown = to
        turns = any(moving[place] for place, axis in enumerate(machine.axes) if axis.rotary)
        boxed = mode == 0 and not machine.together and int(moving.sum()) > 1
        withdraws = not (turns or curved or boxed) and self._straight_off(first, here, end, length)
        ends = np.vstack([first, end])
        return Motion(line, mode == 0, self.tool, ends, at, boxed, keeps, turns, curved, withdraws)

    def _straight_off(self, first: np.ndarray, here: np.ndarray, end: np.ndarray, length: float) -> bool:
        """Whether the tip goes from `here` along its tool, away from the part."""
        machine = self.machine
        way = machine.tip_in_part(end, length)[0] - here
        rotation, _ = machine.place(len(machine.axes), first)
        held, _ = machine.place(0, first)
        axis = held[0].T @ rotation[0] @ machine.tool_axis
        out = float(way @ axis)
        # As far aside as three linear words at both ends and two rotary ones are rounded, by half of their last digit.
        lean = 6 * 0.5e-3 + 2 * math.radians(0.5e-3) * abs(out)
        return out >= 0 and float(np.linalg.norm(way - axis * out)) <= 1.01 * lean

    def _free(self, start: dict, to: dict, arc: Arc | None, t: np.ndarray) -> np.ndarray:
        """Axes that go evenly, or X, Y and Z on an arc."""
        shown = {name: start[name] + (to[name] - start[name]) * t for name in start}
        if arc:
            one, other = (np.array([end[letter] for letter in "XYZ"]) for end in (start, to))
            shown.update(zip("XYZ", arc_points(arc, one, other, t).T))
        return np.stack([axis.value(shown[axis.name]) for axis in self.machine.axes], axis=1)

    def _led(
        self, start: dict, to: dict, here: np.ndarray, goal: np.ndarray, arc: Arc | None, length: float, t: np.ndarray
    ) -> np.ndarray:
        """Rotary axes that go evenly, and a tip that is led along a line or an arc in the frame of the part."""
        tips = arc_points(arc, here, goal, t) if arc else here + (goal - here) * t[:, None]
        turned = [axis.value(start[axis.name] + (to[axis.name] - start[axis.name]) * t) for axis in self.machine.axes]
        return self.machine.with_tip(tips, np.stack(turned, axis=1), length)


def motions(machine: Machine, text: str, lengths: dict[int, float]) -> Iterator[Motion]:
    """The motions of a program, with the lengths of its tools."""
    return Reader(machine, lengths).motions(text)
