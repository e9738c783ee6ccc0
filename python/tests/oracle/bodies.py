"""Bodies as meshes, and which pairs of them are looked at."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import fcl
import numpy as np

from oracle.machine import Machine

SIDES = 96
"""Sides of the polygon that stands for a circle."""


def cylinder_mesh(low: float, high: float, radii: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A frustum along Z."""
    angle = 2 * np.pi * np.arange(SIDES) / SIDES
    ring = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.vstack([ring * radii[0] + [0, 0, low], ring * radii[1] + [0, 0, high], [[0, 0, low], [0, 0, high]]])
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    skin = [np.stack([i, j, i + SIDES], 1), np.stack([j, j + SIDES, i + SIDES], 1)]
    caps = [np.stack([0 * i + 2 * SIDES, j, i], 1), np.stack([0 * i + 2 * SIDES + 1, i + SIDES, j + SIDES], 1)]
    return points, np.vstack(skin + caps)


def model_of(points: np.ndarray, faces: np.ndarray) -> fcl.BVHModel:
    """What fcl asks for distances."""
    model = fcl.BVHModel()
    model.beginModel(len(points), len(faces))
    model.addSubModel(np.ascontiguousarray(points, float), np.ascontiguousarray(faces))
    model.endModel()
    return model


def box_mesh(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A box along the axes."""
    points = np.array([[(low, high)[corner >> axis & 1][axis] for axis in range(3)] for corner in range(8)])
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return points, np.array([half for a, b, c, d in quads for half in ([a, b, c], [a, c, d])])


def onto(axis: np.ndarray) -> np.ndarray:
    """A rotation that takes Z to ``axis``."""
    aside = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(aside, axis)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(axis, x), axis], axis=1)


@dataclass
class Body:
    """A body in the machine frame, axes at zero. ``inside`` tells of points whether they are in it; ``seeds`` are a
    point of each part of it that hangs together; the true body is nowhere more than ``error`` outside its mesh."""

    name: str
    link: int
    points: np.ndarray
    faces: np.ndarray
    inside: Callable[[np.ndarray], np.ndarray]
    seeds: np.ndarray
    error: float = 0.0
    kind: str = "body"
    model: fcl.BVHModel = field(init=False, repr=False)
    corners: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        self.model = model_of(self.points, self.faces)
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        self.corners = box_mesh(low, high)[0]
        self.centre = (low + high) / 2
        self.radius = float(np.linalg.norm(self.points - self.centre, axis=1).max())

    @classmethod
    def block(cls, name: str, link: int, low: object, high: object, **more: object) -> Body:
        """A box between two opposite corners."""
        one, other = np.array(low, float), np.array(high, float)
        low, high = np.minimum(one, other), np.maximum(one, other)
        points, faces = box_mesh(low, high)

        def inside(at: np.ndarray) -> np.ndarray:
            return ((at >= low) & (at <= high)).all(axis=1)

        return cls(name, link, points, faces, inside, points[:1], **more)  # type: ignore[arg-type]

    @classmethod
    def turned(cls, name: str, link: int, profile: list, origin: np.ndarray, axis: np.ndarray, **more: object) -> Body:
        """A profile of revolution, points [z, r] along ``axis`` from ``origin``: a frustum between each two."""
        frame = onto(axis)
        solid = [(*one, *other) for one, other in zip(profile, profile[1:]) if one[0] != other[0]]

        # Nothing is made of a disc: the frustum beside it ends in it.
        parts = [cylinder_mesh(z, z2, (r, r2)) for z, r, z2, r2 in solid]
        starts = np.cumsum([0] + [len(points) for points, _ in parts])
        points = np.vstack([points for points, _ in parts]) @ frame.T + origin
        faces = np.vstack([faces + start for (_, faces), start in zip(parts, starts)])

        def inside(at: np.ndarray) -> np.ndarray:
            local = (at - origin) @ frame
            z, r = local[:, 2], np.hypot(local[:, 0], local[:, 1])
            held = np.zeros(len(at), bool)
            for low, first, high, last in solid:
                share = (z - low) / (high - low)
                held |= (share >= 0) & (share <= 1) & (r <= first + (last - first) * share)
            return held

        low, first, high, last = solid[0]
        seed = origin + axis * (low + high) / 2
        widest = max(max(r, r2) for _, r, _, r2 in solid)
        error = widest * (1 - math.cos(math.pi / SIDES))
        return cls(name, link, points, faces, inside, seed[None], error, **more)  # type: ignore[arg-type]

    @classmethod
    def cylinder(cls, name: str, link: int, ends: object, radius: float, **more: object) -> Body:
        """A cylinder between the middles of its ends."""
        one, other = np.array(ends, float)
        height = float(np.linalg.norm(other - one))
        return cls.turned(name, link, [[0, radius], [height, radius]], one, (other - one) / height, **more)

    @classmethod
    def mesh(cls, name: str, link: int, points: np.ndarray, faces: np.ndarray, **more: object) -> Body:
        """A closed mesh; inside is what sees it all around (van Oosterom, Strackee 1983)."""
        triangles = points[faces]
        root = np.arange(len(points))
        for _ in range(len(points)):
            least = root[faces].min(axis=1)
            known = root.copy()
            for corner in range(3):
                np.minimum.at(root, faces[:, corner], least)
            if (root == known).all():
                break

        def inside(at: np.ndarray) -> np.ndarray:
            arms = triangles[None] - at[:, None, None]
            a, b, c = arms[:, :, 0], arms[:, :, 1], arms[:, :, 2]
            x, y, z = (np.linalg.norm(arm, axis=2) for arm in (a, b, c))
            volume = np.einsum("nti,nti->nt", a, np.cross(b, c))
            dot = lambda one, other: np.einsum("nti,nti->nt", one, other)  # noqa: E731
            below = x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y
            return np.abs(2 * np.arctan2(volume, below).sum(axis=1)) > 2 * np.pi

        seeds = points[np.unique(root[np.unique(faces)])]
        return cls(name, link, points, faces, inside, seeds, **more)  # type: ignore[arg-type]


def stl(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Corners and triangles of an STL file, text or binary."""
    data = path.read_bytes()
    if data[:5] == b"solid" and b"vertex" in data[:2000]:
        corners = np.array(re.findall(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", data)).astype(float)
    else:
        count = int.from_bytes(data[80:84], "little")
        kind = np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
        corners = np.frombuffer(data, kind, count, 84)["v"].reshape(-1, 3).astype(float)
    points, places = np.unique(corners, axis=0, return_inverse=True)
    return points, places.reshape(-1, 3)


def bodies(machine: Machine) -> list[Body]:
    """What the machine file has, without its tools."""
    found = []

    def given(name: str, link: int, table: dict, shift: np.ndarray, kind: str) -> Body:
        if "block" in table:
            low, high = (np.array(corner, float) + shift for corner in table["block"])
            return Body.block(name, link, low, high, kind=kind)
        if "cylinder" in table:
            ends = [np.array(end, float) + shift for end in table["cylinder"]]
            return Body.cylinder(name, link, ends, table["radius"], kind=kind)
        points, faces = stl(machine.folder / table["file"])
        return Body.mesh(name, link, points + shift, faces, kind=kind)

    stock = machine.file.get("stock", {})
    plain = {"block", "cylinder", "file"} & stock.keys()
    stocks = {"stock": stock} if plain else {f"stock {name}": table for name, table in stock.items()}
    for name, table in stocks.items():
        # One that hangs somewhere is drawn in the machine frame.
        shift = np.zeros(3) if "on" in table else machine.mount
        found.append(given(name, machine.link_of(table.get("on", "w")), table, shift, "stock"))
    for name, table in machine.file.get("fixture", {}).items():
        found.append(given(name, machine.link_of(table.get("on", "w")), table, np.zeros(3), "fixture"))
    for name, file in machine.file.get("solids", {}).items():
        if file:
            points, faces = stl(machine.folder / file)
            kind = "fixture" if name == "w" else "machine"
            found.append(Body.mesh(name, machine.link_of(name), points, faces, kind=kind))
    return found


def expanded(profile: list) -> list:
    """A profile without arcs: of each points on it, by the angles of a circle through both ends."""
    points: list = []
    for z, r, *way in profile:
        for arc in way:
            (low, first), size = points[-1], arc["arc"]
            chord = np.array([z - low, r - first])
            far = np.linalg.norm(chord)
            middle = np.array([low + z, first + r]) / 2
            height = math.sqrt(max(size * size - far * far / 4, 0.0))
            aside = np.array([chord[1], -chord[0]]) / far
            centre = middle + aside * math.copysign(height, size)
            angle, half = math.atan2(first - centre[1], low - centre[0]), math.asin(min(1.0, far / 2 / abs(size)))
            for share in np.linspace(0, 1, 33)[1:-1]:
                at = angle - math.copysign(2 * half * share, size)
                points.append([centre[0] + abs(size) * math.cos(at), centre[1] + abs(size) * math.sin(at)])
        points.append([z, r])
    return points


def tool_bodies(machine: Machine, number: int, length: float) -> list[Body]:
    """Holder and cutter of a tool."""
    table = machine.file.get("tools", {}).get(str(number), {})
    if not isinstance(table, dict):
        return []
    found, link, axis = [], len(machine.axes), machine.tool_axis
    if table.get("holder"):
        found.append(Body.turned(f"holder T{number}", link, expanded(table["holder"]), machine.gauge, -axis, kind="holder"))
    if table.get("cutter"):
        found.append(Body.turned(f"cutter T{number}", link, expanded(table["cutter"]), machine.tip(length), axis, kind="cutter"))
    return found


def pairs(machine: Machine, all_bodies: list[Body]) -> list[tuple[Body, Body]]:
    """Those that move against one another, but neighbours of the machine's own, and what is left out."""
    left_out = machine.file.get("clearance", {}).get("ignore", [])

    def called(body: Body, name: str) -> bool:
        if name in (body.name, body.kind):
            return True
        return (name in "wbt" or name in [axis.name for axis in machine.axes]) and machine.link_of(name) == body.link

    found = []
    for place, one in enumerate(all_bodies):
        for other in all_bodies[place + 1 :]:
            beside = one.kind == other.kind == "machine" and abs(one.link - other.link) == 1
            out = any(
                (called(one, a) and called(other, b)) or (called(one, b) and called(other, a)) for a, b in left_out
            )
            if one.link != other.link and not beside and not out:
                found.append((one, other))
    return found
