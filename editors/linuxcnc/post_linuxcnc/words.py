"""What LinuxCNC holds the words of a program to under TCP: the limits of its axes, which are not those of the joints.

It tells a block whose end passes them when it reads the block, which may be while the tool is in an earlier cut: `post`
knows joints alone, so that the filter looks for it before the screen gets the program.
"""

from __future__ import annotations

import re
from pathlib import Path

from .ini import Ini
from .machine import UNLIMITED, number

# What switches the kinematics where the machine file does not say: its dialect's own words.
DEFAULTS = {"tcp_on": "M428", "tcp_off": "M429"}


def tool_lengths(ini: Ini) -> dict[int, float]:
    """Lengths by number from the table of tools, mm: `T1 P1 Z30 D8 ;remark`."""
    path = ini.beside(ini.text("EMCIO", "TOOL_TABLE", "tool.tbl"))
    if not path.is_file():
        return {}
    found = {}
    for line in path.read_text(encoding="utf-8", errors="replace").splitlines():
        words = dict(re.findall(r"([A-Z])\s*([-+]?[\d.]+)", line.partition(";")[0].upper()))
        if "T" in words:
            found[int(float(words["T"]))] = float(words.get("Z", 0)) * ini.millimetres()
    return found


def switches(machine: str) -> dict[str, str]:
    """The words of the machine file that switch TCP on and off."""
    path = Path(machine)
    text = path.read_text(encoding="utf-8", errors="replace") if path.suffix == ".toml" else ""
    said = dict(re.findall(r'^\s*(tcp_on|tcp_off)\s*=\s*"(M\d+)"', text, re.MULTILINE))
    return {**DEFAULTS, **said}


def passed(ini: Ini, program: str, machine: str, offset: list[float]) -> list[str]:
    """What is wrong with the words under TCP, once for each axis and side; `offset` is X, Y, Z of the work offset, mm."""
    codes, lengths, unit = switches(machine), tool_lengths(ini), ini.millimetres()
    if codes["tcp_on"] not in program:
        return []
    limits = {}
    for letter in "XYZ":
        bounds = [ini.number(f"AXIS_{letter}", key) for key in ("MIN_LIMIT", "MAX_LIMIT")]
        limits[letter] = [None if bound is None or abs(bound) > UNLIMITED else bound * unit for bound in bounds]
    faults: dict[tuple[str, str], str] = {}
    tcp, scale, length = False, 1.0, 0.0
    for at, line in enumerate(program.splitlines(), 1):
        block = re.sub(r"\(.*?\)|;.*", "", line).upper()
        words = re.findall(r"([A-Z])([-+]?\d+\.?\d*|[-+]?\.\d+)", block)
        codes_here = {letter + digits for letter, digits in words if letter in "GM"}
        tcp = (tcp or codes["tcp_on"] in codes_here) and codes["tcp_off"] not in codes_here
        scale = 25.4 if "G20" in codes_here else 1.0 if "G21" in codes_here else scale
        if "G43" in codes_here:
            length = lengths.get(next((int(float(digits)) for letter, digits in words if letter == "H"), 0), 0.0)
        if "G49" in codes_here:
            length = 0.0
        if not tcp or "G53" in codes_here:
            continue
        is_hole = bool(codes_here & {"G73", "G81", "G82", "G83", "G84", "G85", "G86", "G89"})
        for letter, digits in words:
            axis = "Z" if letter == "R" and is_hole else letter
            if axis not in limits:
                continue
            here = float(digits) * scale + offset["XYZ".index(axis)] + (length if axis == "Z" else 0.0)
            for key, bound, beyond in zip(("MIN_LIMIT", "MAX_LIMIT"), limits[axis], (-1, 1)):
                if bound is not None and (here - bound) * beyond > 1e-6:
                    faults.setdefault(
                        (axis, key),
                        f"line {at} of the program: {axis} would be at {number(here)} mm in LinuxCNC's coordinates, the work "
                        f"offset{f' and the tool of {number(length)} mm' if axis == 'Z' else ''} in it, and [AXIS_{axis}] "
                        f"{key} is {number(bound)} mm: under TCP it holds for the tip, and LinuxCNC would stop before that "
                        "line. Make it wider (the joints have limits of their own), or clamp the part elsewhere",
                    )
    return list(faults.values())
