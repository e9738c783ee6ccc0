"""Readers of the words of a program: what each block says, and whether it cuts. Nothing is read past: a word that is
not known here is an error."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

UNKNOWN = math.nan
"""A word that a block in machine coordinates has left behind."""


class Unread(Exception):
    """A block that this reader does not know."""


@dataclass
class Block:
    """Where the words stand at the end of a block. ``led``: the control keeps the tip, X Y Z are its own. ``mode``:
    the control's coordinates of a face or a mantle. ``frame``: what a robot's straight move says, its tip and the
    tool's way."""

    line: int
    cuts: bool
    words: dict[str, float]
    led: bool = False
    mode: str = ""
    frame: tuple[list[float], list[list[float]]] | None = None
    named: set[str] = field(default_factory=set)


class Ways(NamedTuple):
    """Turning words of a place within one turn: those whose sign is the way there, those that go the shorter way."""

    signed: str
    shorter: str


WORD = re.compile(r"([A-Z])(3?=|\s*=\s*)?\s*(DC\(|ACP\(|ACN\()?([-+]?(?:\d+\.?\d*|\.\d+))\)?")
LED = {"G43.4", "G234", "G169", "TRAORI", "TRAFO ON", "RTCP ON", "M128", "M428", "M150", "TRAORI(1)"}
LEFT = {"G49", "G170", "TRAFOOF", "TRAFO OFF", "RTCP OFF", "M129", "M429", "M151"}
MACHINE = {"G53", "SUPA", "M91", "G16"}
SILENT = {"G4", "G50", "G92", "G10", "G162"}
"""Codes whose blocks move nothing by their letters."""
REFUSED = {"G2", "G3", "G68.2", "G91", "G20", "G70", "G51", "G16.1", "G101", "G68", "G28", "G30"}
DRILLS = {"G73", "G81", "G82", "G83", "G84", "G85", "G86", "G89"}


def reached(start: float, value: float, way: str | None) -> float:
    """Where a turning axis comes to that is told a place within one turn: the shorter way, or counting up or down."""
    if way is None or math.isnan(start):
        return value
    ahead = (value - start) % 360
    if way == "ACP(":
        return start + ahead
    if way == "ACN(":
        return start + ahead - (360 if ahead else 0)
    return start + (ahead if ahead <= 180 else ahead - 360)


def code(letter: str, value: str) -> str:
    """A code without its leading zeros."""
    number = float(value)
    return f"{letter}{number:g}"


def blocks(text: str, letters: set[str], tips: bool, siemens: bool, ways: Ways) -> Iterator[Block]:
    """Of a program in G-code. ``letters`` are
    those that move something; ``tips``: X Y Z are of the tip while the control keeps it."""
    at: dict[str, float] = dict.fromkeys(letters, UNKNOWN)
    cuts, led, mode, machine = False, False, "", False
    for line, raw in enumerate(text.splitlines(), 1):
        block = re.sub(r";.*", "", raw) if siemens else re.sub(r"\(.*?\)|;.*", "", raw)
        block = re.sub(r"^N\d+\s*", "", block.strip()).strip()
        if not block or block[0] in "%O":
            continue
        for name, on in (("#MCS ON", True), ("#MCS OFF", False)):
            if block == name:
                machine = on
        if re.match(
            r"(MSG|STOPRE|#CS OFF$|LIMS|CYCLE800|ORI|DIAM|TRANS$|SET_|M140|M104|M190|M109|VELOCITY|BED_|G161)", block
        ):
            continue
        if block in ("TRANSMIT", "G12.1", "G112") or block.startswith(("TRACYL", "G7.1 C", "G107 C")):
            turn = re.search(r"C([-\d.]+)", block)
            mode = "face" if block in ("TRANSMIT", "G12.1", "G112") else "mantle"
            if turn and float(turn[1]) == 0:
                mode = ""
            if mode == "face":
                at |= {letter: UNKNOWN for letter in "XYC" if letter in letters or letter == "Y"}
            continue
        if block in ("TRAFOOF", "G13.1", "G113") and mode:
            mode = ""
            at.update({letter: UNKNOWN for letter in letters if letter in "XC"})
            at.pop("Y", None) if "Y" not in letters else None
            continue
        words = re.sub(r"\bDIAM(ON|OF)\b|\bHL=\d+", "", block)
        for name in (*LED, *LEFT, "#MCS ON", "#MCS OFF", "#MCS", "SUPA"):
            if not re.fullmatch(r"[GM][\d.]+", name) and name in words:
                led = True if name in LED else False if name in LEFT else led
                words = words.replace("#" + name, "").replace(name, "")
        here = machine or "SUPA" in block or block.startswith("#MCS G")
        codes, found, rest = set(), {}, words
        for match in WORD.finditer(words):
            letter, vector, way, value = match[1], match[2], match[3], str(match[4])
            rest = rest.replace(match[0], "", 1)
            if letter in "GM":
                codes.add(code(letter, value))
            elif vector and vector.startswith("3"):
                found[letter + "3"] = float(value)
            elif letter in letters or (mode == "face" and letter == "Y"):
                if letter in ways.signed:
                    way, value = "ACN(" if value.startswith("-") else "ACP(", value.lstrip("-")
                elif letter in ways.shorter:
                    way = "DC("
                found[letter] = reached(at[letter], float(value), way)
            elif letter not in "FSTDHLPEQRN":
                raise Unread(f"{line}: {raw}")
        if rest.strip():
            raise Unread(f"{line}: {raw} leaves {rest!r}")
        if codes & (REFUSED | DRILLS):
            raise Unread(f"{line}: {raw}")
        led = (led or bool(codes & LED)) and not codes & LEFT
        cuts = "G1" in codes or (cuts and "G0" not in codes)
        if codes & SILENT or not found:
            continue
        if here or codes & MACHINE:
            at.update(dict.fromkeys(found, UNKNOWN))
            continue
        at.update(found)
        yield Block(line, cuts, dict(at), led and tips, mode, None, set(found))


def klartext(text: str, letters: set[str], tips: bool) -> Iterator[Block]:
    """Of a program in Heidenhain's own language."""
    at: dict[str, float] = dict.fromkeys(letters, UNKNOWN)
    led = False
    for line, raw in enumerate(text.splitlines(), 1):
        block = re.sub(r"^\d+\s*", "", raw.split(";")[0].strip()).strip()
        quiet = r"(BEGIN|END|CYCL DEF|Q\d|PLANE RESET|TOOL|STOP|BLK|\*|M\d|FN|$)"
        for name, on in (("M128", True), ("M129", False), ("FUNCTION TCPM", True), ("FUNCTION RESET TCPM", False)):
            if re.search(rf"\b{name}\b", block):
                led = on
        if re.match(quiet, block) or block.startswith("FUNCTION"):
            continue
        if not block.startswith("L "):
            raise Unread(f"{line}: {raw}")
        body = re.sub(r"\bR0\b|\bFMAX\b|\bM\d+\b|\bF[\d.]+\b|\bFAUTO\b", "", block[2:])
        found = {letter: float(value) for letter, value in re.findall(r"([A-Z])([-+]\d+\.?\d*)", body)}
        if re.sub(r"[A-Z][-+]\d+\.?\d*", "", body).strip() or set(found) - letters:
            raise Unread(f"{line}: {raw}")
        if re.search(r"\bM9[12]\b", block):
            at.update(dict.fromkeys(found, UNKNOWN))
            continue
        if found:
            at.update(found)
            yield Block(line, "FMAX" not in block, dict(at), led and tips, "", None, set(found))


def numbers(text: str) -> list[float]:
    """All of them."""
    return [float(value) for value in re.findall(r"[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?", text)]


ARM = "ABCUVW"


def rapid(text: str) -> Iterator[Block]:
    """Of a module in RAPID: joint moves, each with its time where it cuts."""
    at: dict[str, float] = {}
    for line, raw in enumerate(text.splitlines(), 1):
        move = re.match(r"\s*MoveAbsJ\s+\[\[([^\]]*)\],\[([^\]]*)\]\](.*)", raw)
        if "MoveL" in raw or "MoveC" in raw or "MoveJ" in raw:
            raise Unread(f"{line}: {raw}")
        if not move:
            continue
        at.update(zip(ARM, numbers(move[1])))
        at.update(zip("XYZ", numbers(move[2])))
        yield Block(line, "\\T" in move[3], dict(at))


def krl(text: str) -> Iterator[Block]:
    """Of a program in KRL: joint moves, and straight ones to poses."""
    names = {f"A{place + 1}": letter for place, letter in enumerate(ARM)}
    at: dict[str, float] = {}
    pose: dict[str, float] = {}
    for line, raw in enumerate(text.splitlines(), 1):
        move = re.match(r"\s*(PTP|LIN)\s*\{([^}]*)\}", raw)
        if re.match(r"\s*(CIRC|SPL|SLIN|PTP_REL|LIN_REL|PTP|LIN)\b", raw) and not move:
            if "$AXIS_ACT" in raw:
                continue
            raise Unread(f"{line}: {raw}")
        if not move:
            continue
        found = {name: float(value) for name, value in re.findall(r"([A-Z]\d?)\s+([-+]?[\d.]+)", move[2])}
        if move[1] == "PTP":
            at.update({names.get(name, name): value for name, value in found.items()})
            yield Block(line, False, dict(at))
            continue
        pose.update(found)
        at.update({name: value for name, value in found.items() if name[0] == "E"})
        a, b, c = (math.radians(pose[name]) for name in "ABC")
        # Turned about Z by A, about the new Y by B, about the new X by C.
        rows = [
            [
                math.cos(a) * math.cos(b),
                math.cos(a) * math.sin(b) * math.sin(c) - math.sin(a) * math.cos(c),
                math.cos(a) * math.sin(b) * math.cos(c) + math.sin(a) * math.sin(c),
            ],
            [
                math.sin(a) * math.cos(b),
                math.sin(a) * math.sin(b) * math.sin(c) + math.cos(a) * math.cos(c),
                math.sin(a) * math.sin(b) * math.cos(c) - math.cos(a) * math.sin(c),
            ],
            [-math.sin(b), math.cos(b) * math.sin(c), math.cos(b) * math.cos(c)],
        ]
        yield Block(line, True, dict(at), False, "", ([pose[name] for name in "XYZ"], rows))


def urscript(text: str) -> Iterator[Block]:
    """Of a script: joint moves in degrees; those with a time cut."""
    for line, raw in enumerate(text.splitlines(), 1):
        if re.search(r"\bmove[lpc]\(", raw):
            raise Unread(f"{line}: {raw}")
        move = re.search(r"movej\(\[([^\]]*)\](.*)\)", raw)
        if move and "d2r" in move[1]:
            at = dict(zip(ARM, (float(one) for one in re.findall(r"d2r\(([-+\d.]+)\)", move[1]))))
            yield Block(line, bool(re.search(r"\bt\s*=", move[2])), at)


def read(dialect: str, text: str, letters: set[str], tips: bool, ways: Ways) -> list[Block]:
    """The blocks of a program."""
    if dialect == "heidenhain":
        return list(klartext(text, letters, tips))
    if dialect == "rapid":
        return list(rapid(text))
    if dialect == "krl":
        return list(krl(text))
    if dialect == "urscript":
        return list(urscript(text))
    return list(blocks(text, letters, tips, dialect == "siemens", ways))
