"""Bodies that move one another: a product of matrices from the bed to the part, another from the bed to the tool.

Nothing here is told which way "the tool as seen from the part" goes. A joint is told as who stands beside the machine sees
it: what it carries slides or turns that way when its word counts up. So a sign that is wrong in a machine file shows.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

Floats = np.ndarray
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Joint:
    """A joint and the word that leads it: mm or degrees. ``way`` is how what it carries goes as the word counts up, in the
    frame of the bed with all joints at rest; ``shown`` is the word at rest."""

    word: str
    turns: bool
    way: Vector
    point: Vector = (0.0, 0.0, 0.0)
    shown: float = 0.0

    def moved(self, value: float) -> Floats:
        """The body's motion from rest, 4 by 4, at a value in mm or degrees."""
        motion = np.eye(4)
        way = np.array(self.way, float) / np.linalg.norm(self.way)
        if not self.turns:
            motion[:3, 3] = way * value
            return motion
        half = math.radians(value) / 2
        w, (x, y, z) = math.cos(half), way * math.sin(half)
        motion[:3, :3] = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        point = np.array(self.point)
        motion[:3, 3] = point - motion[:3, :3] @ point
        return motion


def slides(word: str, *way: float) -> Joint:
    """A slide."""
    return Joint(word, False, (way[0], way[1], way[2]))


def turns(word: str, way: Vector, point: Vector = (0.0, 0.0, 0.0), shown: float = 0.0) -> Joint:
    """A turning joint, right-handed about ``way``."""
    return Joint(word, True, way, point, shown)


@dataclass(frozen=True)
class Pose:
    """Where the tool stands in the part's frame: its tip, its axis from the tip to the holder, and its edge."""

    tip: Floats
    axis: Floats
    edge: Floats


@dataclass(frozen=True)
class Bodies:
    """A machine: the joints from the bed to the part, those from the bed to the tool, where the part's origin and the
    tool's nose rest, and how the tool lies."""

    part: tuple[Joint, ...]
    tool: tuple[Joint, ...]
    origin: Vector
    nose: Vector
    axis: Vector = (0.0, 0.0, 1.0)
    edge: Vector = (1.0, 0.0, 0.0)
    factors: Mapping[str, float] = field(default_factory=dict)
    """Words that are multiples of what their joint goes: 2 of a diameter."""
    minus: Mapping[str, str] = field(default_factory=dict)
    """Words that are the difference of their joint and another."""
    absolute: bool = False
    """Words of slides are those of the machine, not from where the part is."""

    def values(self, words: Mapping[str, float]) -> dict[str, float]:
        """What the joints are at, by their words."""
        values = {}
        for joint in self.tool + self.part:
            values[joint.word] = words.get(joint.word, joint.shown) / self.factors.get(joint.word, 1.0) - joint.shown
        for word, other in self.minus.items():
            values[word] += values[other]
        return values

    def pose(self, values: Mapping[str, float], length: float) -> Pose:
        """Of a tool of this length."""
        held, led = np.eye(4), np.eye(4)
        for joint in self.part:
            held = held @ joint.moved(values[joint.word])
        for joint in self.tool:
            led = led @ joint.moved(values[joint.word])
        axis = np.array(self.axis, float) / np.linalg.norm(self.axis)
        tip = led @ np.append(np.array(self.nose) - length * axis, 1.0)
        part = np.eye(4)
        part[:3, 3] = self.origin
        seen = np.linalg.inv(held @ part)
        return Pose((seen @ tip)[:3], seen[:3, :3] @ led[:3, :3] @ axis, seen[:3, :3] @ led[:3, :3] @ self.edge)

    def at_origin(self, length: float) -> dict[str, float]:
        """Where slides X, Y and Z stand as the tip touches the part's origin, nothing turned: the work offset."""
        rest = {joint.word: 0.0 for joint in self.part + self.tool}
        names = [joint.word for joint in self.part + self.tool if not joint.turns and joint.word in "XYZ"]
        if self.absolute or not names:
            return dict.fromkeys(names, 0.0)
        start = self.pose(rest, length).tip
        ways = np.stack([self.pose({**rest, name: 1.0}, length).tip - start for name in names], axis=1)
        found, *_ = np.linalg.lstsq(ways, -start, rcond=None)
        return {name: float(value) for name, value in zip(names, found)}
