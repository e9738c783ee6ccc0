"""The machine: its axes from the part to the tool, and where each link stands."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

Toml = dict  # What a file of it, or a table, is read as.
SAME = np.eye(3)


def turn(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Right-handed turns about ``axis`` (a unit vector), radians, by Rodrigues' formula: n matrices."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return SAME + sine * cross + (1 - cosine) * (cross @ cross)


@dataclass
class Axis:
    """An axis, its direction a unit vector: ``sign`` is -1 if it is reversed, ``zero`` what the control shows at the
    drawing's zero."""

    name: str
    rotary: bool
    direction: np.ndarray
    point: np.ndarray
    sign: float = 1.0
    zero: float = 0.0
    carries_part: bool = False

    def value(self, shown: np.ndarray) -> np.ndarray:
        """From what the control shows to mm or radians of ISO 841."""
        value = self.sign * (np.asarray(shown, float) - self.zero)
        return np.radians(value) if self.rotary else value

    def shown(self, value: np.ndarray) -> np.ndarray:
        """And back."""
        return self.zero + self.sign * (np.degrees(value) if self.rotary else value)


def number(text: object, names: dict[str, float]) -> float:
    """A number of a machine file, or an expression of its parameters (degrees)."""
    if not isinstance(text, str):
        return float(text)  # type: ignore[arg-type]
    known: dict[str, object] = {
        "sin": lambda a: math.sin(math.radians(a)),
        "cos": lambda a: math.cos(math.radians(a)),
        "tan": lambda a: math.tan(math.radians(a)),
        "sqrt": math.sqrt,
        "abs": abs,
        "pi": math.pi,
    }
    return float(eval(text.replace("^", "**"), {"__builtins__": {}}, {**known, **names}))


def layers(path: Path, library: Path) -> Toml:
    """A machine file with what it extends below it."""
    file = tomllib.loads(path.read_text())
    if "extends" not in file:
        return file
    name = file.pop("extends")
    below = path.parent / name
    base = layers(below if below.is_file() else library / f"{name}.toml", library)

    def over(base: Toml, more: Toml) -> Toml:
        both = dict(base)
        for key, value in more.items():
            known = both.get(key)
            both[key] = over(known, value) if isinstance(known, dict) and isinstance(value, dict) else value
        return both

    return over(base, file)


@dataclass
class Machine:
    """Axes from the part to the tool. Link 0 carries the part, link n is what the nth axis leads to."""

    axes: list[Axis]
    gauge: np.ndarray
    tool_axis: np.ndarray
    mount: np.ndarray
    dialect: str
    file: Toml
    folder: Path
    together: bool

    @classmethod
    def read(cls, path: Path, library: Path) -> Machine:
        """The machine of a file; ``library`` has those that it may extend by name."""
        file = layers(path, library)
        names: dict[str, float] = {}
        waiting = dict(file.get("parameters", {}))
        while waiting:
            for key in list(waiting):
                try:
                    names[key] = number(waiting[key], names)
                    del waiting[key]
                except NameError:
                    pass

        def vector(three: list) -> np.ndarray:
            return np.array([number(one, names) for one in three])

        chain = re.sub(r"[\[\]()]", " ", file["chain"]).split()
        bed = chain.index("b")
        axes = []
        for place, word in enumerate(chain):
            if word in ("w", "b", "S", "t"):
                continue
            name = word.rstrip("'")
            table = file["axis"][name]
            direction = vector(table.get("rotary") or table["linear"])
            axes.append(
                Axis(
                    name,
                    "rotary" in table,
                    direction / np.linalg.norm(direction),
                    vector(table.get("point", [0, 0, 0])),
                    -1.0 if table.get("reversed") else 1.0,
                    number(table.get("zero", 0), names),
                    place < bed,
                )
            )
        tool = file.get("tool", {})
        axis = vector(tool.get("axis", [0, 0, 1]))
        return cls(
            axes,
            vector(tool["gauge"]),
            axis / np.linalg.norm(axis),
            vector(file.get("workpiece", {}).get("mount", [0, 0, 0])),
            file["control"]["dialect"],
            file,
            path.parent,
            file.get("clearance", {}).get("rapid_axes") == "together",
        )

    @property
    def bed(self) -> int:
        """The link that stands still."""
        return sum(axis.carries_part for axis in self.axes)

    def link_of(self, name: str) -> int:
        """What a body hangs on: an axis letter is what that axis moves."""
        if name in "wbt":
            return {"w": 0, "b": self.bed, "t": len(self.axes)}[name]
        place = [axis.name for axis in self.axes].index(name)
        return place if self.axes[place].carries_part else place + 1

    def _moved(self, place: int, q: np.ndarray) -> tuple[np.ndarray | None, np.ndarray]:
        """What an axis does to what it moves, a slide turns nothing: a table goes against the direction of the axis
        (ISO 841)."""
        axis, way = self.axes[place], q[:, place]
        if axis.carries_part:
            way = -way
        if not axis.rotary:
            return None, way[:, None] * axis.direction
        rotation = turn(axis.direction, way)
        return rotation, axis.point - rotation @ axis.point

    def place(self, link: int, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where a link stands: rotations and shifts against the bed, from the bed outward."""
        rotation, shift, turned = np.broadcast_to(SAME, (len(q), 3, 3)), np.zeros((len(q), 3)), False
        order = range(self.bed - 1, link - 1, -1) if link < self.bed else range(self.bed, link)
        for place in order:
            by, to = self._moved(place, q)
            shift = shift + (np.einsum("nij,nj->ni", rotation, to) if turned else to)
            if by is not None:
                rotation, turned = rotation @ by if turned else by, True
        return rotation, shift

    def tip(self, length: float) -> np.ndarray:
        """The tip with all axes at zero."""
        return self.gauge - self.tool_axis * length

    def tip_in_part(self, q: np.ndarray, length: float) -> np.ndarray:
        """The tip in the frame of the part."""
        rotation, shift = self.place(len(self.axes), q)
        at = rotation @ self.tip(length) + shift
        rotation, shift = self.place(0, q)
        return np.einsum("nji,nj->ni", rotation, at - shift) - self.mount

    def slides(self) -> list[int]:
        """Places of the linear axes."""
        return [place for place, axis in enumerate(self.axes) if not axis.rotary]

    def with_tip(self, tip: np.ndarray, q: np.ndarray, length: float) -> np.ndarray:
        """The rotary axes of ``q``, and slides that bring the tip to ``tip``: three linear equations."""
        slides, q = self.slides(), q.copy()
        q[:, slides] = 0.0
        # All slides at zero, and each of them at 1 mm.
        tried = np.repeat(q[None], 1 + len(slides), axis=0)
        for number, slide in enumerate(slides, 1):
            tried[number, :, slide] = 1.0
        tips = self.tip_in_part(tried.reshape(-1, q.shape[1]), length).reshape(1 + len(slides), len(q), 3)
        columns = np.moveaxis(tips[1:] - tips[0], 0, 2)
        q[:, slides] = np.linalg.solve(columns, (tip - tips[0])[:, :, None])[:, :, 0]
        return q

    def work_zero(self, length: float = 0.0) -> dict[str, float]:
        """What the control shows of its slides where the tip of a tool is at the part's origin, rotary axes at zero."""
        slides = self.slides()
        directions = np.stack([self.axes[slide].direction for slide in slides], axis=1)
        values, *_ = np.linalg.lstsq(directions, self.mount - self.tip(length), rcond=None)
        return {self.axes[slide].name: float(self.axes[slide].shown(value)) for slide, value in zip(slides, values)}
