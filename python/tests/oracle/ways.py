"""Whether a machine can make a cut inside its travel and limits: searched from many places, by the test's own kinematics.

What is found exists, with a little to spare; that nothing is found says that no such way starts at any of the places that
were looked at.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from oracle.machine import Machine

Floats = np.ndarray
Inside = Callable[[Floats], Floats]

SEEDS = {0: 1, 1: 361, 2: 41, 3: 13}
"""Places on the travel of each rotary axis that a search starts from, by how many there are."""
EXACT = 1e-5
"""Tool axes that differ by less are the same (unit vectors): CL files have nine decimals, and beside a pole their root."""
SPARE = 0.01
"""What a way has to spare before the end of a travel, mm and degrees: at the very end words are rounded."""
STEP = 0.01
"""Way of a tool axis between two looks, rad."""


def tool_axes(machine: Machine, q: Floats) -> Floats:
    """In the frame of the part."""
    led, _ = machine.place(len(machine.axes), q)
    held, _ = machine.place(0, q)
    return np.einsum("nji,nj->ni", held, led @ machine.tool_axis)


@dataclass
class Search:
    """`travel` by axis, as the control shows it; `inside` tells of poses whether limits between axes are kept; `lean` is how
    far a tool axis may be off between two points, rad."""

    machine: Machine
    travel: dict[str, tuple[float, float]]
    inside: Inside
    length: float
    lean: float

    @property
    def rotary(self) -> list[int]:
        return [place for place, axis in enumerate(self.machine.axes) if axis.rotary]

    def within(self, q: Floats) -> Floats:
        """Whether poses keep to travel and limits."""
        kept = self.inside(q)
        for place, axis in enumerate(self.machine.axes):
            low, high = self.travel[axis.name]
            shown = axis.shown(q[:, place])
            kept &= (shown >= low + SPARE) & (shown <= high - SPARE)
        return kept

    def turned(self, q: Floats, goal: Floats, steps: int) -> Floats:
        """Rotary axes by damped steps to where the tool points along `goal` (one for each row, or for all)."""
        q, rotary = q.copy(), self.rotary
        for _ in range(steps if rotary else 0):
            here = tool_axes(self.machine, q)
            slope = np.empty((len(q), 3, len(rotary)))
            for number, place in enumerate(rotary):
                moved = q.copy()
                moved[:, place] += 1e-6
                slope[:, :, number] = (tool_axes(self.machine, moved) - here) / 1e-6
                # At a pole an axis stands.
            step = np.einsum("nij,nj->ni", np.linalg.pinv(slope, rcond=1e-4), goal - here)
            q[:, rotary] += np.clip(step, -0.3, 0.3)
        return q

    def solutions(self, tip: Floats, goal: Floats) -> Floats:
        """Poses with this tip and tool axis inside travel and limits, all full turns among them."""
        rotary = self.rotary
        grids = []
        for place in rotary:
            axis = self.machine.axes[place]
            grids.append(axis.value(np.linspace(*self.travel[axis.name], SEEDS[len(rotary)])))
        seeds = np.array(list(itertools.product(*grids)), float)
        q = np.zeros((len(seeds), len(self.machine.axes)))
        q[:, rotary] = seeds
        if rotary:
            near = np.linalg.norm(tool_axes(self.machine, q) - goal, axis=1)
            q = self.turned(q[near < max(0.6, np.sort(near)[:40][-1])], goal, 12)
        q = q[np.linalg.norm(tool_axes(self.machine, q) - goal, axis=1) < EXACT]
        if not len(q):
            return q
        first = np.array([0])
        if rotary:
            _, first = np.unique((q[:, rotary] / 0.02).round(), axis=0, return_index=True)
        q = self.machine.with_tip(np.broadcast_to(tip, (len(first), 3)), q[first], self.length)
        return q[self.within(q)]

    def branch(self, q: Floats) -> Floats:
        """On which side of the pole two rotary axes are: the sense of the tool axis' ways by each and the tool axis."""
        if len(self.rotary) != 2:
            return np.ones(len(q))
        here, ways = tool_axes(self.machine, q), []
        for place in self.rotary:
            moved = q.copy()
            moved[:, place] += 1e-6
            ways.append((tool_axes(self.machine, moved) - here) / 1e-6)
        return np.sign(np.einsum("ni,ni->n", np.cross(*ways), here))

    def sense(self, q: Floats) -> Floats:
        """Of the slides' directions as the part sees them: where it changes they lie in one plane, and lead nowhere."""
        slides = self.machine.slides()
        tried = np.repeat(q[None], 1 + len(slides), axis=0)
        for number, slide in enumerate(slides, 1):
            tried[number, :, slide] += 1.0
        tips = self.machine.tip_in_part(tried.reshape(-1, q.shape[1]), self.length).reshape(1 + len(slides), len(q), 3)
        return np.sign(np.linalg.det(np.moveaxis(tips[1:] - tips[0], 0, 2)))

    def way(self, tips: Floats, axes: Floats, above: float) -> str | None:
        """None if there is a way through all points that keeps to travel and limits, begins and ends `above` them, turns no
        axis by a leap and stays on its side of the pole; else what stands against it."""
        ways = self.solutions(tips[0], axes[0])
        if not len(ways):
            return "its first point has no solution inside travel and limits"
        ways = ways[self._off(ways, tips[0], axes[0], above)]
        begun = self.branch(ways)
        for number in range(1, len(tips)):
            ends = tips[number - 1 : number + 1], axes[number - 1 : number + 1]
            # Beside a pole the axes turn fast: smaller steps where none leads on.
            led = ways[:0], begun[:0]
            for finer in (1, 16) if len(ways) else ():
                if not len(led[0]):
                    led = self._along(ways, begun, *ends, finer)
            ways, begun = led
            if not len(ways):
                here = len(self.solutions(tips[number], axes[number]))
                return "no way leads on to a point" if here else "a point has no solution inside travel and limits"
        kept = self._off(ways, tips[-1], axes[-1], above)
        if not kept.any():
            return "no way comes off the part"
        stayed = self.branch(ways) == begun
        return None if (kept & stayed).any() else "all ways lead through a pole to its other side"

    def _along(self, q: Floats, begun: Floats, tips: Floats, axes: Floats, finer: int) -> tuple[Floats, Floats]:
        """From one point to the next: the tip straight, the tool axis in its plane. Which poses lead there, and where."""
        bend = float(np.arccos(np.clip(axes[0] @ axes[1], -1, 1)))
        count = max(4, int(np.ceil(bend / STEP))) * finer

        def goal(share: float) -> Floats:
            if bend < 1e-9:
                return axes[1]
            made = axes[0] * np.sin((1 - share) * bend) + axes[1] * np.sin(share * bend)
            return made / np.linalg.norm(made)

        for share in np.arange(1, count + 1) / count:
            before = q
            q = self.turned(before, goal(share), 3)
            q = self.machine.with_tip(
                np.broadcast_to(tips[0] + share * (tips[1] - tips[0]), (len(q), 3)), q, self.length
            )
            kept = np.linalg.norm(tool_axes(self.machine, q) - goal(share), axis=1) < self.lean
            half = goal(share - 0.5 / count)
            kept &= np.linalg.norm(tool_axes(self.machine, (before + q) / 2) - half, axis=1) < self.lean
            kept &= self.within(q) & (self.sense(q) == self.sense(before))
            q, begun = q[kept], begun[kept]
            if not len(q):
                break
        return q, begun

    def _off(self, q: Floats, tip: Floats, axis: Floats, above: float) -> Floats:
        """Whether the tool can stand `above` as it is turned."""
        out = np.broadcast_to(tip + above * axis, (len(q), 3))
        return self.within(self.machine.with_tip(out, q, self.length))
