"""How far bodies are apart at many poses."""

from __future__ import annotations

from dataclasses import dataclass, field

import fcl
import numpy as np

from oracle.bodies import Body
from oracle.machine import Machine


def apart(one: fcl.BVHModel, other: fcl.BVHModel, rotation: np.ndarray, shift: np.ndarray) -> float:
    """Between two meshes, the second placed in the frame of the first; 0 where their surfaces meet."""
    first = fcl.CollisionObject(one, fcl.Transform())
    last = fcl.CollisionObject(other, fcl.Transform(rotation, shift))
    return max(float(fcl.distance(first, last, fcl.DistanceRequest(), fcl.DistanceResult())), 0.0)


@dataclass
class Poses:
    """Where the second of two bodies is seen from the first, at n poses, and what is known of their distances."""

    one: Body
    other: Body
    rotation: np.ndarray
    shift: np.ndarray
    least: np.ndarray = field(init=False)
    known: np.ndarray = field(init=False)

    @classmethod
    def of(cls, machine: Machine, one: Body, other: Body, q: np.ndarray, places: dict | None = None) -> Poses:
        """At axis values ``q``; ``places`` keeps where links stand there from one pair to the next."""
        places = {} if places is None else places
        for link in (one.link, other.link):
            if link not in places:
                places[link] = machine.place(link, q)
        (r1, s1), (r2, s2) = places[one.link], places[other.link]
        back = np.swapaxes(r1, 1, 2)
        return cls(one, other, back @ r2, (back @ (s2 - s1)[:, :, None])[:, :, 0])

    def __post_init__(self) -> None:
        self.corners = self.other.corners @ np.swapaxes(self.rotation, 1, 2) + self.shift[:, None]
        centre = self.rotation @ self.other.centre + self.shift
        spheres = np.linalg.norm(centre - self.one.centre, axis=1) - self.one.radius - self.other.radius
        low, high = self.one.points.min(axis=0), self.one.points.max(axis=0)
        boxes = np.linalg.norm(np.maximum(np.maximum(low - centre, centre - high), 0), axis=1) - self.other.radius
        self.least = np.maximum(np.maximum(spheres, boxes), 0.0)
        self.known = np.full(len(self.shift), np.inf)
        # What is wholly inside the other has no distance of surfaces.
        near = np.flatnonzero(self.least <= 0)
        if len(near):
            held = np.zeros(len(near), bool)
            for seed in self.other.seeds:
                held |= self.one.inside(self.rotation[near] @ seed + self.shift[near])
            for seed in self.one.seeds:
                back = np.einsum("nji,nj->ni", self.rotation[near], seed - self.shift[near])
                held |= self.other.inside(back)
            self.known[near[held]] = 0.0

    def look(self, place: int) -> float:
        """The distance at a pose."""
        if np.isinf(self.known[place]):
            self.known[place] = apart(self.one.model, self.other.model, self.rotation[place], self.shift[place])
        return float(self.known[place])

    def nearest(
        self, places: np.ndarray | None = None, enough: float = np.inf, until: float = np.inf, share: float = 1.0
    ) -> tuple[float, int]:
        """The least distance among poses, and where. It is not looked for closer than whether one is nearer than
        ``enough``, where one no farther than ``until`` is known, nor closer than ``share`` of it: what comes back then
        is no less than the former, and no more than the least.

        A distance says something of the other poses too: between two poses no point of a body goes farther than the
        corner of its box that goes farthest.
        """
        waiting = np.arange(len(self.shift)) if places is None else places
        zero = waiting[self.known[waiting] == 0]
        if len(zero):
            return 0.0, int(zero[0])
        best, where, bar = np.inf, int(waiting[0]), enough if until == np.inf else np.inf
        corners = self.corners[waiting]
        while len(waiting):
            least = self.least[waiting]
            pick = int(np.argmin(least))
            if least[pick] >= bar:
                return min(best, float(least[pick])), where
            found = self.look(int(waiting[pick]))
            if found < best:
                best, where = found, int(waiting[pick])
                bar = min(best, enough) * share if best <= until else best * share
            moved = np.linalg.norm(corners - corners[pick], axis=2).max(axis=1)
            least = np.maximum(least, found - moved - 1e-9)
            least[pick] = found
            self.least[waiting] = least
            keep = least < bar
            keep[pick] = False
            waiting, corners = waiting[keep], corners[keep]
        return best, where
