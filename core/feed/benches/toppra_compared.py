"""TOPPRA on the paths and limits of `solvers.rs`, beside our own figures.

    python3 -m venv /tmp/toppra && /tmp/toppra/bin/pip install toppra
    cargo bench -p post-feed | tee /tmp/feed.txt
    /tmp/toppra/bin/python core/feed/benches/toppra_compared.py /tmp/feed.txt

Optional, and no part of the tests. Without a file it prints TOPPRA's figures alone; TOPPRA_MOST is the largest number
of samples (100000). Path and limits are made here a second time, from the same random numbers. What is timed is TOPPRA's
passes alone ("solved") and with the set-up of its constraints ("with limits"); of ours the columns "reach" and "limits"
are the same two things. Its wheel has no C++ part: the passes are a Python loop around linear programs in compiled
Cython.
"""

import os
import sys
import time
from importlib.metadata import version

import numpy as np
import toppra
from toppra import algorithm, constraint
from toppra.interpolator import AbstractGeometricPath

toppra.setup_logging("ERROR")
MASK = (1 << 64) - 1


class Numbers:
    """SplitMix64, as the tests' random numbers."""

    def __init__(self, seed):
        self.state = seed

    def range(self, low, high):
        self.state = (self.state + 0x9E3779B97F4A7C15) & MASK
        z = self.state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & MASK
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & MASK
        z ^= z >> 31
        return low + (high - low) * ((z >> 11) / (1 << 53))


class Waves(AbstractGeometricPath):
    """Each axis a straight part and three waves."""

    def __init__(self, numbers, axes, length):
        self.waves = [
            [(numbers.range(0.5, 6.0), numbers.range(0.05, 0.8), numbers.range(0.0, 6.3)) for _ in range(3)]
            for _ in range(axes)
        ]
        self.straight = [numbers.range(-0.6, 0.6) for _ in range(axes)]
        self.length = length

    def __call__(self, s, order=0):
        s = np.asarray(s, dtype=float)
        axes = []
        for waves, straight in zip(self.waves, self.straight):
            value = np.full_like(s, straight) if order == 1 else (straight * s if order == 0 else np.zeros_like(s))
            for size, rate, phase in waves:
                value = value + size * rate**order * np.sin(rate * s + phase + order * np.pi / 2)
            axes.append(value)
        return np.stack(axes, axis=-1)

    @property
    def dof(self):
        return len(self.straight)

    @property
    def path_interval(self):
        return np.array([0.0, self.length])

    @property
    def waypoints(self):
        return None


class TipFeed(constraint.LinearConstraint):
    """The feed of the first three axes together."""

    def __init__(self, feed, dof):
        super().__init__()
        self.feed, self.dof = feed, dof

    def compute_constraint_params(self, path, gridpoints):
        stretch = np.linalg.norm(path(gridpoints, 1)[:, :3], axis=1)
        bound = np.stack([np.zeros_like(stretch), (self.feed / stretch) ** 2], axis=1)
        return None, None, None, None, None, None, bound


def planned(axes, kind, count):
    """Samples a second of the passes, of passes and limits, and the time of the plan."""
    numbers = Numbers(7)
    path = Waves(numbers, axes, 0.1 * count)
    velocity = np.array([numbers.range(20.0, 120.0) for _ in range(axes)])
    acceleration = np.array([numbers.range(50.0, 2000.0) for _ in range(axes)])
    feed = numbers.range(30.0, 200.0)
    drives = constraint.JointAccelerationConstraint(np.stack([-acceleration, acceleration], axis=1))
    drives.set_discretization_type(kind)
    limits = [TipFeed(feed, axes), constraint.JointVelocityConstraint(np.stack([-velocity, velocity], axis=1)), drives]
    grid = np.linspace(0.0, path.length, count)
    begin = time.perf_counter()
    solver = algorithm.TOPPRA(limits, path, gridpoints=grid, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel")
    ready = time.perf_counter()
    _, speed, _ = solver.compute_parameterization(0.0, 0.0)
    end = time.perf_counter()
    if speed is None:
        return count / (end - ready), count / (end - begin), float("nan")
    seconds = np.sum(2.0 * np.diff(grid) / (speed[1:] + speed[:-1]))
    return count / (end - ready), count / (end - begin), seconds


def ours(path):
    """Rates of limits and reach, and the time of the plan, by axes, rows and samples."""
    found = {}
    with open(path, encoding="utf-8") as lines:
        for line in lines:
            words = line.split()
            if len(words) >= 7 and words[1] in ("Start", "Ends"):
                limits, reach, seconds = float(words[3]), float(words[4]), float(words[6])
                found[int(words[0]), words[1], int(words[2])] = (reach, 1.0 / (1.0 / limits + 1.0 / reach), seconds)
    return found


def main():
    own = ours(sys.argv[1]) if len(sys.argv) > 1 else {}
    most = int(os.environ.get("TOPPRA_MOST", "100000"))
    print(f"TOPPRA {version('toppra')}: samples a second, seconds of the plan, and how many times as fast we are")
    print("axes rows   samples     solved with limits    seconds |  reach x limits x  our seconds difference")
    # Where its rows are kept: at samples, or at both ends of an interval.
    for axes in (3, 5):
        for name, kind in (("Start", 0), ("Ends", 1)):
            count = 1000
            while count <= most:
                solved, whole, seconds = planned(axes, constraint.DiscretizationType(kind), count)
                line = f"{axes:4} {name:<6} {count:7} {solved:10.3e}  {whole:10.3e} {seconds:10.4f} |"
                if (axes, name, count) in own:
                    reach, both, time_of_ours = own[axes, name, count]
                    line += f" {reach / solved:8.0f} {both / whole:8.0f} {time_of_ours:12.4f} {time_of_ours / seconds - 1.0:+10.1e}"
                print(line, flush=True)
                count *= 10


if __name__ == "__main__":
    main()
