"""What a control does with a program of its own language: cuts as they run, with feed, spindle, coolant and tool.

The languages are those of the makers' manuals. What is not known here beyond doubt (tilted planes of ISG, Fagor and
Siemens) raises ``Unread``: it is not guessed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from oracle.machine import Machine, turn
from oracle.program import PLANES, Arc, Reader, Unread, arc_points

SHARES = np.linspace(0, 1, 17)
DWELLS = {
    **dict.fromkeys(["fanuc", "haas", "mazak", "mitsubishi", "syntec"], ("P", 1e-3)),
    **dict.fromkeys(["linuxcnc", "grbl", "hurco", "brother"], ("P", 1.0)),
    **dict.fromkeys(["okuma", "siemens"], ("F", 1.0)),
    "fagor": ("K", 1.0),
    "isg": ("X", 1.0),
}
"""The letter of a dwell, and seconds of one of it."""
DRILLS = {73, 81, 82, 83, 84, 85, 86, 89}
LED: dict[str, set[float]] = {"fanuc": {43.4}, "mazak": {43.4}, "mitsubishi": {43.4}, "syntec": {43.4}, "brother": {43.4}, "haas": {234}}
"""Codes by which the control keeps the tip; G49 ends it."""


@dataclass(frozen=True)
class Cut:
    """A motion at feed. ``q`` at ``SHARES`` of it, and by ``placed`` ``tips`` and ``axes`` there in the frame of the part;
    ``minutes`` that it lasts (none where the control's rule is not known), ``spindle`` in 1/min, negative against the
    clock's way."""

    line: int
    q: np.ndarray
    minutes: float | None
    led: bool
    tool: int | None
    spindle: float
    coolant: frozenset[int]
    dwelt: float
    tips: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))
    axes: np.ndarray = field(default_factory=lambda: np.empty((0, 3)))


@dataclass
class Hole:
    """A cycle in the words of the program: heights along its Z."""

    above: float
    bottom: float


def euler(i: float, j: float, k: float) -> np.ndarray:
    """About Z, the new X, the new Z, degrees: columns are the plane's axes."""
    x, z = np.eye(3)[0], np.eye(3)[2]
    one, two, three = (np.radians([angle]) for angle in (i, j, k))
    return turn(z, one)[0] @ turn(x, two)[0] @ turn(z, three)[0]


def spatial(a: float, b: float, c: float) -> np.ndarray:
    """About fixed X, then Y, then Z, degrees."""
    x, y, z = np.eye(3)
    one, two, three = (np.radians([angle]) for angle in (a, b, c))
    return turn(z, three)[0] @ turn(y, two)[0] @ turn(x, one)[0]


class Control(Reader):
    """A control that runs a program block by block."""

    def __init__(self, machine: Machine, lengths: dict[int, float], dialect: str) -> None:
        super().__init__(machine, lengths)
        self.dialect = dialect
        self.frame: tuple[np.ndarray, np.ndarray] | None = None
        self.follows_table = self.in_machine = False
        self.rate, self.feed, self.spindle, self.sense = 94, 0.0, 0.0, 0
        self.coolant: frozenset[int] = frozenset()
        self.dwelt = 0.0
        self.hole: Hole | None = None
        self.plunge = 0.0
        self.centre: dict[str, float] = {}
        self.names = {axis.name for axis in machine.axes}

    def cuts(self, text: str) -> Iterator[Cut | None]:
        """The cuts, and None where a rapid comes between."""
        language = {"heidenhain": self._klartext, "siemens": self._siemens}.get(self.dialect, self._iso)
        lines = re.sub(r"~\s*\n", " ", text) if self.dialect == "heidenhain" else text
        for line, block in enumerate(lines.splitlines(), 1):
            try:
                yield from language(line, block.strip())
            except (KeyError, IndexError) as wrong:
                raise Unread(f"{line}: {block}: {wrong!r}") from wrong

    # Motion

    def go(
        self, line: int, axes: dict[str, float], mode: int, arc: dict[str, float], machine_words: bool = False
    ) -> Iterator[Cut | None]:
        """A motion of words ``axes`` by G0 to G3; ``arc`` has I J K from the start, R, or the centre U V."""
        machine, to = self.machine, dict(self.shown)
        first = self.joints(to)
        led = (self.tcp or self.frame is not None) and not machine_words
        for letter in set(axes) - set("XYZ"):
            to[letter] = axes[letter]
        turned = [to[axis.name] - self.shown[axis.name] for axis in machine.axes if axis.rotary]
        t = SHARES
        shown = {name: self.shown[name] + (to[name] - self.shown[name]) * t for name in to}
        if led:
            rotation, origin = self.frame or (np.eye(3), np.zeros(3))
            length = (
                self.offset if self.offset is not None else self.lengths.get(self.tool or 0, 0) if self.tcp else 0.0
            )
            begin = rotation.T @ (machine.tip_in_part(first, length)[0] - origin)
        else:
            zero = dict.fromkeys("XYZ", 0.0) if machine_words else self._zero(first)
            begin = np.array([self.shown[letter] - zero[letter] for letter in "XYZ"])
        end = np.array([axes.get(letter, begin[place]) for place, letter in enumerate("XYZ")])
        way = begin + (end - begin) * t[:, None]
        if mode in (2, 3):
            if "U" in arc:
                pick = ["XYZ".index(letter) for letter in PLANES[self.plane]]
                arc = {"IJK"[place]: arc[key] - begin[place] for place, key in zip(pick, "UV")}
            way = arc_points(Arc(self.plane, mode == 3, arc), begin, end, t)
        if led:
            q = np.stack([axis.value(shown[axis.name]) for axis in machine.axes], axis=1)
            q = machine.with_tip(way @ rotation.T + origin, q, length)
        else:
            for place, letter in enumerate("XYZ"):
                shown[letter] = way[:, place] + zero[letter]
            q = np.stack([axis.value(shown[axis.name]) for axis in machine.axes], axis=1)
        self.shown = {axis.name: float(axis.shown(q[-1, place])) for place, axis in enumerate(machine.axes)}
        if mode == 0:
            yield None
            return
        steps = np.linalg.norm(np.diff(way, axis=0), axis=1).sum()
        if mode in (2, 3):  # Chords are shorter than their arcs.
            angles = np.linspace(0, 1, 2049)
            fine = arc_points(Arc(self.plane, mode == 3, arc), begin, end, angles)
            steps = np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()
        if steps < 1e-9 and not np.any(np.abs(turned) > 1e-9):
            return
        if self.tool not in self.lengths:
            raise Unread(f"{line}: a cut without a tool")
        yield Cut(
            line,
            q,
            self._minutes(float(steps), float(np.linalg.norm(turned)), led),
            led,
            self.tool,
            self.sense * self.spindle,
            self.coolant,
            self.dwelt,
        )

    def _zero(self, first: np.ndarray) -> dict[str, float]:
        """What the control shows of its slides where the words are zero."""
        if not self.follows_table:
            return self.counted_from()
        q = self.machine.with_tip(np.zeros((1, 3)), first, 0.0)
        zero = {axis.name: float(axis.shown(value)) for axis, value in zip(self.machine.axes, q[0])}
        zero[self.along] += self.offset or 0.0
        return zero

    def _minutes(self, way: float, turned: float, led: bool) -> float | None:
        """How long a cut lasts by the control's own rule."""
        if self.feed <= 0:
            return math.inf
        if self.rate == 93:
            return 1 / self.feed
        feed = self.feed * (self.spindle if self.rate == 95 else 1.0)
        if led or turned < 1e-9:
            return way / feed if way > 1e-9 else None
        if self.dialect in ("linuxcnc", "grbl"):
            return (way or turned) / feed if self.dialect == "linuxcnc" else math.hypot(way, turned) / feed
        if self.dialect in ("fanuc", "mazak", "mitsubishi", "okuma", "hurco"):
            return math.hypot(way, turned) / feed
        return None

    def _drill(self, line: int, axes: dict[str, float]) -> Iterator[Cut | None]:
        """Over the hole, down to the stock, at feed to the bottom, and out again."""
        assert self.hole
        yield from self.go(line, {key: value for key, value in axes.items() if key != "Z"}, 0, {})
        yield from self.go(line, {"Z": self.hole.above}, 0, {})
        yield from self.go(line, {"Z": self.hole.bottom}, 1, {})
        yield from self.go(line, {"Z": self.hole.above}, 0, {})

    def _switch(self, switches: set[int], words: dict[str, float]) -> None:
        """Spindle, coolant and tool."""
        if 6 in switches or (self.dialect == "grbl" and "T" in words and 0 in switches):
            self.tool, self.sense = self.called, 0
            # At GRBL's stop the user measures each tool against the work offset.
            if self.dialect in ("fagor", "grbl"):
                self.offset = self.lengths[self.tool or 0]
        if "S" in words:
            self.spindle = words["S"]
        for code in switches & {3, 4, 5}:
            self.sense = {3: 1, 4: -1, 5: 0}[code]
        if 9 in switches:
            self.coolant = frozenset()
        self.coolant |= switches & {7, 8}
        if self.dialect == "linuxcnc" and switches & {428, 429}:
            self.tcp = 428 in switches
        if self.dialect in ("hurco", "heidenhain") and switches & {128, 129}:
            self.tcp = 128 in switches

    # Languages

    def _iso(self, line: int, block: str) -> Iterator[Cut | None]:
        block = re.sub(r"\(.*?\)|;.*", "", block).strip().upper()
        if not block or re.match(r"%|O\d", block):
            return
        machine_words = self.in_machine
        if block.startswith("#"):
            word = re.match(r"#(RTCP|TRAFO|MCS|CS)\s*(ON|OFF)?", block)
            if not word or (word[1] == "CS" and word[2] == "ON"):
                raise Unread(f"{line}: {block}")
            if word[1] in ("RTCP", "TRAFO"):
                self.tcp = word[2] == "ON"
            elif word[1] == "MCS":
                machine_words = self.in_machine = word[2] == "ON"
                machine_words = machine_words or word[2] is None
            block = block[word.end() :].strip()
        found = re.findall(r"([A-Z])\s*([-+]?[\d.]+)", block)
        if "".join(letter + value for letter, value in found) != block.replace(" ", ""):
            raise Unread(f"{line}: {block}")
        codes = {float(value) for letter, value in found if letter == "G"}
        words = {letter: float(value) for letter, value in found if letter not in "GMN"}
        self.called = int(words.get("T", self.called or 0)) or None
        self._switch({int(value) for letter, value in found if letter == "M"}, words)
        if 4 in codes:
            letter, unit = DWELLS[self.dialect]
            self.dwelt += words[letter] * unit
            return
        okuma = self.dialect == "okuma"
        known = {
            0,
            1,
            2,
            3,
            8,
            17,
            18,
            19,
            21,
            40,
            43,
            49,
            53,
            54,
            61,
            64,
            69,
            71,
            80,
            90,
            91.1,
            92.1,
            92.2,
            93,
            94,
            95,
        }
        known |= {97, 98, 99, 15, 16, 56, 53.1, 68.2, 254, 255, 162} | DRILLS | LED.get(self.dialect, set())
        if codes - known:
            raise Unread(f"{line}: {block}")
        self._modes(codes, words)
        if 53 in codes:
            machine_words = not okuma
            if okuma:
                self.offset = None
        if okuma and 16 in codes:
            machine_words = True
        if 68.2 in codes:
            self.frame = euler(words["I"], words["J"], words["K"]), np.array([words[letter] for letter in "XYZ"])
            return
        if 69 in codes:
            self.frame = None
        if codes & {254, 255}:
            self.follows_table = 254 in codes
        if okuma and 71 in codes:
            return
        if codes & DRILLS:
            deep = words["I"] if self.dialect == "fagor" else words["Z"]
            self.hole = Hole(words["Z"] if self.dialect == "fagor" else words["R"], deep)
        elif codes & {80, 0, 1, 2, 3}:
            self.hole = None
        # A peck of Fagor's cycles is B, whatever axes there are.
        own = {"B"} if self.dialect == "fagor" and codes & DRILLS else set()
        axes = {letter: value for letter, value in words.items() if letter in self.names - own}
        if self.hole and axes:
            yield from self._drill(line, axes)
        elif axes or (self.mode > 1 and set(words) & set("IJK")):
            arc = {letter: value for letter, value in words.items() if letter in "IJKR"}
            yield from self.go(line, axes, self.mode, arc, machine_words)

    def _modes(self, codes: set[float], words: dict[str, float]) -> None:
        """Modal codes that are the same in all languages of the family, and the length of the tool."""
        for code in codes:
            if code in (0, 1, 2, 3):
                self.mode = int(code)
            elif code in PLANES:
                self.plane = int(code)
            elif code in (93, 94, 95):
                self.rate = int(code)
        self.feed = words.get("F", 0.0 if self.rate == 93 else self.feed)
        led = LED.get(self.dialect, set())
        if codes & ({43} | led | ({56} if self.dialect == "okuma" else set())):
            self.offset = self.lengths[int(words.get("H", self.tool or 0))]
        if 49 in codes:
            self.offset, self.tcp = None, self.tcp and not led
        if codes & led:
            self.tcp = True
        if self.dialect == "isg" and "D" in words:
            self.offset = self.lengths[self.tool or 0] if words["D"] else None

    def _siemens(self, line: int, block: str) -> Iterator[Cut | None]:
        block = re.sub(r"^N\d+\s*", "", block.split(";")[0].strip())
        cycle = re.fullmatch(r"MCALL(?:\s+CYCLE8([1-3])\((.*)\))?", block)
        if cycle:
            args = [float(one or 0) for one in (cycle[2] or "").split(",")]
            self.hole = Hole(args[1] + args[2], args[3]) if cycle[1] else None
            return
        if "CYCLE" in block:
            raise Unread(f"{line}: {block}")
        for name, on in (("TRAORI", True), ("TRAFOOF", False)):
            if name in block:
                self.tcp = on
        machine_words = "SUPA" in block
        rest = re.sub(r"TRAORI|TRAFOOF|SUPA|TRANS|ORIMKS|ORIAXES|ORIWKS|DC", "", block).replace("=", "")
        rest = re.sub(r"\(([^)]*)\)", r"\1", rest)
        found = re.findall(r"([A-Z])\s*([-+]?[\d.]+)", rest)
        if "".join(letter + value for letter, value in found) != rest.replace(" ", ""):
            raise Unread(f"{line}: {block}")
        codes = {float(value) for letter, value in found if letter == "G"}
        words = {letter: float(value) for letter, value in found if letter not in "GMN"}
        if 4 in codes:
            self.dwelt += words["F"]
            return
        self.called = int(words.get("T", self.called or 0)) or None
        self._switch({int(value) for letter, value in found if letter == "M"}, words)
        if "D" in words:
            self.offset = self.lengths[self.tool or 0] if words["D"] else None
        self._modes(codes, words)
        axes = {letter: value for letter, value in words.items() if letter in self.names}
        for letter in re.findall(r"([ABC])=DC\(", block):
            axes[letter] = self.shown[letter] + (axes[letter] - self.shown[letter] + 180) % 360 - 180
        if self.hole and axes:
            yield from self._drill(line, axes)
        elif axes or (self.mode > 1 and set(words) & set("IJK")):
            arc = {letter: value for letter, value in words.items() if letter in "IJK"}
            yield from self.go(line, axes, self.mode, arc, machine_words)

    def _klartext(self, line: int, block: str) -> Iterator[Cut | None]:
        block = re.sub(r"^\d+\s*", "", block)
        numbers = {key: float(value) for key, value in re.findall(r"\b(Q\d+)=([-+]?[\d.]+)", block)}
        block = block.split(";")[0].strip() if not numbers else block
        switches = {int(value) for value in re.findall(r"\bM(\d+)\b", block)}
        words = {key: float(value) for key, value in re.findall(r"\b([XYZABCFS])([-+]?\d[\d.]*)", block)}
        if block.startswith("TOOL CALL"):
            call = re.match(r"TOOL CALL (\d+)", block)
            if call:
                self.tool = self.called = int(call[1])
                self.offset, self.sense = self.lengths[self.tool], 0
        self._switch(switches, words if block.startswith("TOOL CALL") else {})
        plane = re.match(r"PLANE SPATIAL SPA([-+.\d]+) SPB([-+.\d]+) SPC([-+.\d]+)", block)
        if plane:
            self.frame = spatial(*(float(one) for one in plane.groups())), np.zeros(3)
        elif block.startswith("PLANE RESET"):
            self.frame = None
        elif block.startswith("CYCL DEF 9.1"):
            self.dwelt += float(block.split()[-1])
        elif block.startswith("CYCL DEF 7.") and words and any(words.values()):
            raise Unread(f"{line}: {block}")
        elif numbers and "Q201" in numbers:
            self.hole = Hole(numbers["Q203"] + numbers["Q200"], numbers["Q203"] + numbers["Q201"])
            self.plunge = numbers["Q206"]
        elif block.startswith("CC "):
            self.centre = words
        elif block.startswith(("LN", "CP", "CR", "CT", "CYCL CALL", "FN")):
            raise Unread(f"{line}: {block}")
        elif block.startswith(("L ", "C ")):
            axes = {letter: value for letter, value in words.items() if letter in self.names}
            feed, rapid = self.feed, "FMAX" in block
            self.feed = words.get("F", feed)
            if 99 in switches and self.hole:
                self.feed = self.plunge
                yield from self._drill(line, axes)
                self.feed = feed
            elif block[0] == "L":
                yield from self.go(line, axes, 0 if rapid else 1, {}, bool({91, 92} & switches))
            else:
                arc = {"U": self.centre["X"], "V": self.centre["Y"]}
                yield from self.go(line, axes, 3 if "DR+" in block else 2, arc)


def placed(machine: Machine, cuts: list[Cut], lengths: dict[int, float]) -> list[Cut]:
    """The cuts with tip and tool axis, worked out at once for all of them that one tool makes."""
    found = list(cuts)
    for tool in {cut.tool for cut in cuts if cut.tool is not None}:
        own = [place for place, cut in enumerate(cuts) if cut.tool == tool]
        q = np.vstack([cuts[place].q for place in own])
        carried, _ = machine.place(len(machine.axes), q)
        held, _ = machine.place(0, q)
        axes = np.einsum("nji,nj->ni", held, carried @ machine.tool_axis)
        tips = machine.tip_in_part(q, lengths[tool])
        for number, place in enumerate(own):
            rows = slice(number * len(SHARES), (number + 1) * len(SHARES))
            found[place] = replace(cuts[place], tips=tips[rows], axes=axes[rows])
    return found


def groups(machine: Machine, text: str, lengths: dict[int, float], dialect: str) -> list[list[Cut]]:
    """Cuts that follow one another with no rapid between them; ``dwelt`` is what was dwelt since the program's start."""
    run = list(Control(machine, lengths, dialect).cuts(text))
    cuts = iter(placed(machine, [cut for cut in run if cut is not None], lengths))
    found: list[list[Cut]] = [[]]
    for cut in run:
        if cut is not None:
            found[-1].append(next(cuts))
        elif found[-1]:
            found.append([])
    return [group for group in found if group]
