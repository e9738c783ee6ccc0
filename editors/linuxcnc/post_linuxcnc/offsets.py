"""Where the part sits: a work offset of LinuxCNC, as the machine has it now."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass

from . import Refused
from .ini import Ini

SYSTEMS = ("G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3")
FIRST, STEP = 5221, 20  # parameter of X of G54, and from one system to the next ("Coordinate Systems" of LinuxCNC)
TURN = 9  # behind X, the turn about Z (R of G10 L2)
G92_ON, G92 = 5210, 5211


@dataclass
class Offset:
    """X to W of a work offset in machine coordinates, units of the INI file, and its turn about Z, degrees."""

    axes: list[float]
    turn: float


def mount(ini: Ini, system: str) -> str:
    """The part origin in the frame of the machine file, mm, as `--mount` takes it."""
    if system not in SYSTEMS:
        raise Refused(f"[POST] MOUNT = {system}: one of {', '.join(SYSTEMS)}")
    offset = _running(system) or _saved(ini, system)
    turned = [letter for letter, value in zip("ABC", offset.axes[3:6]) if value]
    if turned or offset.turn:
        raise Refused(
            f"[POST] MOUNT = {system}: it is turned ({'R' if offset.turn else turned[0]}), and programs are written for one that is "
            "not: set it to 0"
        )
    return ",".join(f"{value * ini.millimetres():.6f}" for value in offset.axes[:3])


# Asked in a process of its own: the module writes to standard output, where the program goes.
ASK = "import json, linuxcnc; s = linuxcnc.stat(); s.poll(); print(json.dumps([s.g5x_index, s.g5x_offset, s.g92_offset, s.rotation_xy]))"


def _running(system: str) -> Offset | None:
    """From the LinuxCNC that runs here, which is newer than its file; it tells the system in force alone."""
    try:
        answer = subprocess.run([sys.executable, "-c", ASK], capture_output=True, text=True, timeout=10).stdout
        index, axes, g92, turn = json.loads(answer.splitlines()[-1])
    except (OSError, subprocess.TimeoutExpired, IndexError, ValueError):
        return None  # not installed, or nothing runs: the file has it
    if SYSTEMS[index - 1] != system:
        return None
    if any(g92):
        raise Refused(f"[POST] MOUNT = {system}: G92 is in force besides: G92.1 takes it off")
    return Offset(axes, turn)


def _saved(ini: Ini, system: str) -> Offset:
    """From the file of parameters."""
    name = ini.text("RS274NGC", "PARAMETER_FILE", "rs274ngc.var")
    path = ini.beside(name)
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        raise Refused(f"[POST] MOUNT = {system}: {path} cannot be read: LinuxCNC writes it when it ends") from None
    values = {}
    for line in lines:
        words = line.split()
        if len(words) >= 2 and words[0].isdigit():
            values[int(words[0])] = float(words[1])
    if values.get(G92_ON) and any(values.get(G92 + axis) for axis in range(9)):
        raise Refused(f"[POST] MOUNT = {system}: {path} has a G92 besides: G92.1 takes it off")
    first = FIRST + STEP * SYSTEMS.index(system)
    return Offset([values.get(first + axis, 0.0) for axis in range(9)], values.get(first + TURN, 0.0))
