"""The INI file of a LinuxCNC machine, as LinuxCNC 2.8 to 2.10 reads it (its "INI Configuration" pages)."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from . import Refused

# Millimetres in one LINEAR_UNITS, degrees in one ANGULAR_UNITS.
LINEAR = {"mm": 1.0, "metric": 1.0, "in": 25.4, "inch": 25.4, "imperial": 25.4}
ANGULAR = {"deg": 1.0, "degree": 1.0, "rad": math.degrees(1), "radian": math.degrees(1), "grad": 0.9, "gon": 0.9}
DEPTH = 16  # INI files that include one another


@dataclass
class Entry:
    """A value with its place."""

    text: str
    place: str

    def number(self) -> float:
        """The value as a number, in the units of the file."""
        try:
            value = float(self.text.split()[0])
        except (ValueError, IndexError):
            raise Refused(f"{self.place}: {self.text!r} is not a number") from None
        if math.isnan(value):
            raise Refused(f"{self.place}: {self.text!r} is not a number")
        return value


@dataclass
class Ini:
    """Sections with their keys; a key may come several times, and its values keep their order."""

    path: Path
    sections: dict[str, dict[str, list[Entry]]] = field(default_factory=dict)
    heads: dict[str, str] = field(default_factory=dict)  # the place of a section's first line

    def entries(self, section: str, key: str) -> list[Entry]:
        return self.sections.get(section, {}).get(key, [])

    def first(self, section: str, key: str) -> Entry | None:
        """The value that LinuxCNC takes of a key: the first one."""
        found = self.entries(section, key)
        return found[0] if found else None

    def text(self, section: str, key: str, default: str = "") -> str:
        found = self.first(section, key)
        return found.text if found else default

    def number(self, section: str, key: str) -> float | None:
        found = self.first(section, key)
        return found.number() if found else None

    def at(self, section: str, *keys: str) -> str:
        """Where the keys of a section stand, with their values; those that it has not, by its line or else by the file."""
        found = [entry for key in keys if (entry := self.first(section, key))]
        if len(found) < len(keys):
            return self.heads.get(section, f"{self.path}: there is no section [{section}]")
        return ", ".join(f"{entry.place} = {entry.text}" for entry in found)

    def beside(self, name: str) -> Path:
        """A file as LinuxCNC finds it: from the folder of the INI file, which it changes to at its start."""
        return (self.path.parent / Path(name).expanduser()).resolve()

    def millimetres(self) -> float:
        """Millimetres in one unit of length."""
        entry = self.first("TRAJ", "LINEAR_UNITS")
        if entry is None:
            raise Refused(f"{self.at('TRAJ', 'LINEAR_UNITS')}: LINEAR_UNITS is missing: say mm or inch")
        if entry.text.lower() in LINEAR:
            return LINEAR[entry.text.lower()]
        return 1 / entry.number()  # as a number it is units a millimetre

    def degrees(self) -> float:
        """Degrees in one unit of angle."""
        entry = self.first("TRAJ", "ANGULAR_UNITS")
        if entry is None:
            return 1.0
        if entry.text.lower() in ANGULAR:
            return ANGULAR[entry.text.lower()]
        return 1 / entry.number()


def read(path: Path) -> Ini:
    """Reads an INI file and what it includes."""
    ini = Ini(path.resolve())
    _read_into(ini, ini.path, "", DEPTH, "")
    return ini


def _read_into(ini: Ini, path: Path, section: str, depth: int, asked: str) -> str:
    """Reads one file, which `asked`, the place of an `#INCLUDE`, names; the section that it ends in goes on behind that."""
    if depth == 0:
        raise Refused(f"{asked}{path}: included {DEPTH} deep: does it include itself?")
    try:
        lines = path.read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as fault:
        raise Refused(f"{asked}{path}: cannot be read: {fault.strerror}") from None
    number = 0
    while number < len(lines):
        line = lines[number].strip()
        number += 1
        while line.endswith("\\") and number < len(lines):
            line = line[:-1].rstrip() + " " + lines[number].strip()
            number += 1
        if line.startswith("#INCLUDE"):
            name = line[len("#INCLUDE") :].strip()
            section = _read_into(ini, ini.beside(name), section, depth - 1, f"{path}:{number}: {line}: ")
        elif not line or line[0] in "#;":
            continue
        elif line[0] == "[":
            section = line[1:].partition("]")[0].strip()
            ini.heads.setdefault(section, f"{path}:{number}: [{section}]")
        elif "=" in line:
            key, _, value = line.partition("=")
            entry = Entry(value.strip(), f"{path}:{number}: [{section}] {key.strip()}")
            ini.sections.setdefault(section, {}).setdefault(key.strip(), []).append(entry)
    return section
