"""Whether a machine can make a cut inside its travel and limits: searched from many places, by the test's own kinematics.

What is found exists; that nothing is found says that no such way starts at any of the places that were looked at.
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
            kept &= (shown >= low - 1e-6) & (shown <= high + 1e-6)
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

    def way(self, tips: Floats, axes: Floats, above: float) -> str | None:
        """None if there is a way through all points that keeps to travel and limits, begins and ends `above` them, and
        turns no axis by a leap; else what stands against it."""
        ways = self.solutions(tips[0], axes[0])
        if not len(ways):
            return "its first point has no solution inside travel and limits"
        ways = ways[self._off(ways, tips[0], axes[0], above)]
        for number in range(1, len(tips)):
            bend = float(np.arccos(np.clip(axes[number - 1] @ axes[number], -1, 1)))
            count = max(4, int(np.ceil(bend / STEP)))
            for share in np.arange(1, count + 1) / count if len(ways) else []:
                goal = axes[number - 1] * np.sin((1 - share) * bend) + axes[number] * np.sin(share * bend)
                goal = goal / np.linalg.norm(goal) if bend > 1e-9 else axes[number]
                tip = tips[number - 1] + share * (tips[number] - tips[number - 1])
                ways = self.turned(ways, goal, 4)
                ways = ways[np.linalg.norm(tool_axes(self.machine, ways) - goal, axis=1) < self.lean]
                ways = self.machine.with_tip(np.broadcast_to(tip, (len(ways), 3)), ways, self.length)
                ways = ways[self.within(ways)]
                if not len(ways):
                    break
            if not len(ways):
                here = len(self.solutions(tips[number], axes[number]))
                return "no way leads on to a point" if here else "a point has no solution inside travel and limits"
        ways = ways[self._off(ways, tips[-1], axes[-1], above)]
        return None if len(ways) else "no way comes off the part"

    def _off(self, q: Floats, tip: Floats, axis: Floats, above: float) -> Floats:
        """Whether the tool can stand `above` as it is turned."""
        out = np.broadcast_to(tip + above * axis, (len(q), 3))
        return self.within(self.machine.with_tip(out, q, self.length))
