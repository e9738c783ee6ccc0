"""Bodies that move one another: a product of matrices from the bed to the part, another from the bed to the tool.

Nothing here is told which way "the tool as seen from the part" goes. A joint is told as who stands beside the machine
sees it: what it carries slides or turns that way when its word counts up. So a sign that is wrong in a machine file
shows.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

Floats = np.ndarray
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Joint:
    """A joint and the word that leads it: mm or degrees. ``way`` is how what it carries goes as the word counts up,
    in the frame of the bed with all joints at rest; ``shown`` is the word at rest."""

    word: str
    turns: bool
    way: Vector
    point: Vector = (0.0, 0.0, 0.0)
    shown: float = 0.0

    def moved(self, values: Floats) -> Floats:
        """The body's motions from rest at values in mm or degrees: n matrices, 4 by 4."""
        motion = np.tile(np.eye(4), (len(values), 1, 1))
        way = np.array(self.way, float) / np.linalg.norm(self.way)
        if not self.turns:
            motion[:, :3, 3] = values[:, None] * way
            return motion
        half = np.radians(values) / 2
        w, (x, y, z) = np.cos(half), way[:, None] * np.sin(half)
        rows = [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
        motion[:, :3, :3] = np.moveaxis(np.array(rows), 2, 0)
        point = np.array(self.point)
        motion[:, :3, 3] = point - motion[:, :3, :3] @ point
        return motion


def slides(word: str, *way: float) -> Joint:
    """A slide."""
    return Joint(word, False, (way[0], way[1], way[2]))


def turns(word: str, way: Vector, point: Vector = (0.0, 0.0, 0.0), shown: float = 0.0) -> Joint:
    """A turning joint, right-handed about ``way``."""
    return Joint(word, True, way, point, shown)


@dataclass(frozen=True)
class Poses:
    """Where the tool stands in the part's frame, a row each: its tip, its axis from the tip to the holder, and its
    edge."""

    tips: Floats
    axes: Floats
    edges: Floats


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
    less: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    """Words that are their joint less a multiple of another: of coupled arms and of wrists with bevel gears."""
    errors: Mapping[str, tuple[tuple[float, ...], ...]] = field(default_factory=dict)
    """Of slides of a machine that turns nothing: where one stands, and how far the tool is from where it should be
    over the part there, along X, Y and Z."""
    absolute: bool = False
    """Words of slides are those of the machine, not from where the part is."""

    def values(self, words: Mapping[str, Floats], count: int) -> dict[str, Floats]:
        """What the joints go from rest, by their words."""
        values = {}
        for joint in self.tool + self.part:
            told = words.get(joint.word, np.full(count, joint.shown))
            values[joint.word] = told / self.factors.get(joint.word, 1.0) - joint.shown
        for word, (other, factor) in self.less.items():
            values[word] = values[word] + factor * values[other]
        return values

    def poses(self, values: Mapping[str, Floats], length: float) -> Poses:
        """Of a tool of this length."""
        held = led = np.eye(4)
        for joint in self.part:
            held = held @ joint.moved(values[joint.word])
        for joint in self.tool:
            led = led @ joint.moved(values[joint.word])
        axis = np.array(self.axis, float) / np.linalg.norm(self.axis)
        tip = led @ np.append(np.array(self.nose) - length * axis, 1.0)
        part = np.eye(4)
        part[:3, 3] = self.origin
        seen = np.linalg.inv(held @ part)
        turned = seen[..., :3, :3] @ led[..., :3, :3]
        count = len(next(iter(values.values())))
        tips = (seen @ tip[..., None])[..., :3, 0]
        for word, rows in self.errors.items():
            places = np.array(rows)
            off = [np.interp(values[word], places[:, 0], places[:, column]) for column in (1, 2, 3)]
            tips = tips + np.stack(off, axis=1)
        return Poses(*(np.broadcast_to(one, (count, 3)) for one in (tips, turned @ axis, turned @ np.array(self.edge))))

    def slides_to(
        self, goals: Floats, values: Mapping[str, Floats], length: float, names: list[str]
    ) -> dict[str, Floats]:
        """Where the slides ``names`` bring the tip to each goal, the other joints being at ``values``."""
        rest = {**values, **{name: np.zeros(len(goals)) for name in names}}
        start = self.poses(rest, length).tips
        ones = [self.poses({**rest, name: np.ones(len(goals))}, length).tips - start for name in names]
        found = (np.linalg.pinv(np.stack(ones, axis=2)) @ (goals - start)[:, :, None])[:, :, 0]
        return {**values, **{name: found[:, place] for place, name in enumerate(names)}}

    def at_origin(self, length: float) -> dict[str, float]:
        """Where slides X, Y and Z stand as the tip touches the part's origin, nothing turned: the work offset."""
        names = [joint.word for joint in self.part + self.tool if not joint.turns and joint.word in "XYZ"]
        if self.absolute or not names:
            return dict.fromkeys(names, 0.0)
        rest = {joint.word: np.zeros(1) for joint in self.part + self.tool}
        found = self.slides_to(np.zeros((1, 3)), rest, length, names)
        return {name: float(found[name][0]) for name in names}
