"""Which chain of axes a kinematics module of LinuxCNC is.

Each law is that of the module's source as of LinuxCNC 2.9 (`trtfuncs.c`, `5axiskins.c`, `corexykins.c`, `rotatekins.c`,
`maxkins.c`, `scarakins.c`, `xyzab_tdr_kins.comp`); `python/tests/test_linuxcnc_machine.py` holds the chains against the modules themselves. Lengths are
those of the INI file, in the frame of the joints at zero.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from . import Refused
from .hal import Hal, Length
from .ini import Entry, Ini

LINEAR = "XYZUVW"
ROTARY = "ABC"
DIRECTIONS = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1), "A": (1, 0, 0), "B": (0, 1, 0), "C": (0, 0, 1)}

# Modules that cannot be written as a machine file, and why.
ARM = "its words X Y Z A B C are a pose, and no axis of it has a word of its own"
PARALLEL = "its joints are not a chain: they move the tool together"
REFUSED = {
    "scarakins": ARM,
    "pumakins": ARM,
    "genserkins": ARM,
    "scorbot-kins": ARM,
    "three21kins": ARM,
    "genhexkins": PARALLEL,
    "pentakins": PARALLEL,
    "tripodkins": PARALLEL,
    "lineardeltakins": PARALLEL,
    "rotarydeltakins": PARALLEL,
    "rosekins": "its words are the angle and radius of a rose engine",
    "millturn": "which of its two laws holds is switched in the program: describe the mill and the lathe in two files",
    "maxkins": "it cannot be switched off, so that G53 moves the tip and not the axes, and no retract in it is proven; "
    "and up to LinuxCNC 2.9 it adds the head's swing behind the table's turn, as no machine with C in the table does. "
    "Programs of trivkins for the same machine can be posted: [KINS] KINEMATICS = trivkins coordinates=XYZBC, "
    "--table C=0,0,0 --head B=0,0,PIVOT",
}


@dataclass
class RotaryAxis:
    """A rotary axis: what it turns, and a point of its line in the frame of the joints, units of the INI file."""

    letter: str
    carries_part: bool
    point: tuple[float, float, float]
    reversed: bool = False


@dataclass
class Law:
    """A machine's chain and what its programs must know of it."""

    chain: str
    linear: list[str]
    rotary: list[RotaryAxis] = field(default_factory=list)
    tcp: bool = False
    tcp_on: str = ""
    tcp_off: str = ""
    belt: bool = False  # joints 0 and 1 are the sum and the difference of X and Y
    remarks: list[str] = field(default_factory=list)


@dataclass
class Module:
    """A line `KINEMATICS = name key=value …`, and the letters of its joints."""

    entry: Entry
    name: str
    arguments: dict[str, str]
    letters: str
    axes: str

    @property
    def place(self) -> str:
        """Where the line stands, with its value."""
        return f"{self.entry.place} = {self.entry.text}"

    def joints(self, letter: str) -> list[int]:
        """The joints that a letter moves: two of a gantry."""
        return [number for number, each in enumerate(self.letters) if each == letter]


# The letters of the joints of modules that have them fixed, or take them where `coordinates=` is not said.
LETTERS = {"xyzac-trt-kins": "XYZAC", "xyzbc-trt-kins": "XYZBC", "xyzab_tdr_kins": "XYZAB", "5axiskins": "XYZBCW"}


def module(ini: Ini) -> Module:
    """The kinematics that the INI file names."""
    entry = ini.first("KINS", "KINEMATICS")
    if entry is None:
        raise Refused(
            f"{ini.at('KINS', 'KINEMATICS')}: KINEMATICS is missing: which axes the machine has is not known; say the module, "
            "such as trivkins coordinates=XYZ"
        )
    words = entry.text.split()
    arguments = dict(word.partition("=")[::2] for word in words[1:])
    name = words[0].lower()
    letters = arguments.get("coordinates", LETTERS.get(name, "XYZABCUVW")).upper()
    axes = re.sub(r"[^XYZABCUVW]", "", ini.text("TRAJ", "COORDINATES", letters).upper())
    return Module(entry, name, arguments, letters, "".join(dict.fromkeys(axes)))


@dataclass
class Said:
    """What the user says beside the INI file."""

    rotary: list[RotaryAxis] = field(default_factory=list)
    left_out: str = ""
    reversed: str = ""


def law(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """The chain of a module, or why there is none."""
    if kins.name in REFUSED:
        raise Refused(f"{kins.place}: {kins.name}: {REFUSED[kins.name]}")
    makers = {
        "trivkins": _trivial,
        "corexykins": _corexy,
        "rotatekins": _rotate,
        "xyzac-trt-kins": _trunnion,
        "xyzbc-trt-kins": _trunnion,
        "xyzab_tdr_kins": _dual_table,
        "5axiskins": _bridge,
    }
    if kins.name not in makers:
        known = ", ".join(sorted(makers))
        raise Refused(
            f"{kins.place}: {kins.name} is not known here; known are {known}: write the machine file by hand"
        )
    for pin in hal.pins:
        if pin.startswith(f"{kins.name}.") and pin.partition(".")[2] not in PINS.get(kins.name, {}):
            raise Refused(f"{kins.place}: the HAL files set {pin}, which is not known here")
    made = makers[kins.name](ini, kins, hal, said)
    known = {axis.letter for axis in made.rotary}
    for letter in said.reversed:
        if letter not in known:
            raise Refused(f"--reversed {letter}: the machine has no rotary axis {letter}")
    return made


def _words(ini: Ini, kins: Module, said: Said, *, have: str) -> list[str]:
    """The letters that programs have, without those that are left out; refuses what the chain would not have."""
    letters = [letter for letter in kins.axes if letter not in said.left_out]
    named = ini.first("TRAJ", "COORDINATES")
    place = ini.at("TRAJ", "COORDINATES") if named else kins.place
    faults = [
        f"{place}: {kins.name} gives {letter} no place in a chain: --leave-out {letter}, "
        "where programs need not move it"
        for letter in letters
        if letter not in have
    ]
    missing = [letter for letter in "XYZ" if letter not in letters]
    if missing:
        faults.append(
            f"{place}: has no {' and no '.join(missing)}: a lathe or another machine without X, Y and "
            "Z is described by hand (docs/src/machine-builder/mill-turn.md)"
        )
    if faults:
        raise Refused(*faults)
    return letters


def _trivial(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """Each word is an axis. What a rotary axis turns, and where its line is, LinuxCNC does not know."""
    letters = _words(ini, kins, said, have="XYZABC")
    named = {axis.letter: axis for axis in said.rotary}
    faults = [
        f"{kins.place}: what {letter} turns, and where its line is, stands in no INI file: --table {letter}=X,Y,Z "
        f"where it turns the part, --head {letter}=X,Y,Z where it turns the tool: a point of its line, in machine "
        "coordinates with all axes at zero"
        for letter in letters
        if letter in ROTARY and letter not in named
    ]
    faults += [f"--table or --head {letter}: programs have no {letter}" for letter in named if letter not in letters]
    if faults:
        raise Refused(*faults)
    for axis in said.rotary:
        axis.reversed = axis.letter in said.reversed
    tables = [f"{axis.letter}'" for axis in said.rotary if axis.carries_part]
    heads = [axis.letter for axis in said.rotary if not axis.carries_part]
    chain = " ".join(["w", *tables, "b", "X", "Y", "Z", *heads, "(S)", "t"])
    return Law(f"[{chain}]", ["X", "Y", "Z"], said.rotary)


def _corexy(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """Two belts: joint 0 is X + Y, joint 1 is X - Y; the words are X, Y and Z."""
    _words(ini, kins, said, have="XYZ")
    return Law("[w b X Y Z (S) t]", ["X", "Y", "Z"], belt=True)


def _rotate(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """X and Y turn with C, so that words are in the frame of the part whatever C is: a program that does not turn it."""
    _words(ini, kins, Said(left_out=said.left_out + "C"), have="XYZ")
    remark = "C is left out: rotatekins turns X and Y with it, so a program that does not move it is right at any C; the travel below holds at C0"
    return Law("[w b X Y Z (S) t]", ["X", "Y", "Z"], remarks=[remark])


# The pins of each module, and what they are worth if nothing sets them.
TRUNNION = dict.fromkeys(
    ("x-rot-point", "y-rot-point", "z-rot-point", "x-offset", "y-offset", "z-offset", "tool-offset"), 0.0
)
PINS = {
    "xyzac-trt-kins": {**TRUNNION, "conventional-directions": 0.0},
    "xyzbc-trt-kins": {**TRUNNION, "conventional-directions": 0.0},
    # `x-offset` cancels out of its law.
    "xyzab_tdr_kins": dict.fromkeys(
        ("x-rot-point", "y-rot-point", "z-rot-point", "x-offset", "z-offset", "tool-offset-z"), 0.0
    ),
    "5axiskins": {"pivot-length": 250.0},
}


def _lengths(kins: Module, hal: Hal) -> dict[str, Length]:
    found = {pin: hal.length(f"{kins.name}.{pin}", default) for pin, default in PINS[kins.name].items()}
    moved = [pin for pin, value in found.items() if value.tool and not pin.startswith(("tool-offset", "pivot-length"))]
    if moved:
        raise Refused(f"{kins.place}: {kins.name}.{moved[0]} changes with the tool: no chain does")
    return found


def _known_tool(kins: Module, pin: str, value: Length) -> None:
    """The kinematics must know the length of the tool, or the tip is elsewhere than the program says."""
    if value.tool != 1:
        raise Refused(
            f"{kins.place}: {kins.name}.{pin} does not hold the tool's length: the tip would be led wrong. Connect it to "
            "motion.tooloffset.z in a HAL file, as LinuxCNC's own configuration does"
        )


def _trunnion(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """A rotary C on a tilting A or B; the words of a table count against ISO 841 unless a pin says otherwise."""
    tilt = kins.name[3].upper()
    _words(ini, kins, said, have=f"XYZ{tilt}C")
    pins = _lengths(kins, hal)
    _known_tool(kins, "tool-offset", pins["tool-offset"])
    at = {name: value.constant for name, value in pins.items()}
    unused = "x-offset" if tilt == "A" else "y-offset"
    if at[unused]:
        raise Refused(f"{kins.place}: {kins.name}.{unused} is set, and the module's law has no place for it")
    against = not at["conventional-directions"]
    centre = (at["x-rot-point"], at["y-rot-point"], at["z-rot-point"])
    swing = tuple(base + at[f"{axis}-offset"] for base, axis in zip(centre, "xyz"))
    rotary = [RotaryAxis("C", True, centre, against), RotaryAxis(tilt, True, swing, against)]
    first = 1 if kins.arguments.get("sparm") == "identityfirst" else 0
    return _switched(ini, kins, hal, Law(f"[w C' {tilt}' X' Y' b Z (S) t]", ["X", "Y", "Z"], rotary), first)


def _dual_table(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """A on B, both in the table; they count as ISO 841 has it. A is `z-offset` above the line of B."""
    _words(ini, kins, said, have="XYZAB")
    pins = _lengths(kins, hal)
    _known_tool(kins, "tool-offset-z", pins["tool-offset-z"])
    at = {name: value.constant for name, value in pins.items()}
    centre = (at["x-rot-point"], at["y-rot-point"], at["z-rot-point"])
    above = (centre[0], centre[1], centre[2] + at["z-offset"])
    rotary = [RotaryAxis("A", True, above), RotaryAxis("B", True, centre)]
    return _switched(ini, kins, hal, Law("[w A' B' b X Y Z (S) t]", ["X", "Y", "Z"], rotary), 1)


def _bridge(ini: Ini, kins: Module, hal: Hal, said: Said) -> Law:
    """B on C in the head; B counts against ISO 841. W, which lengthens the tool in the program, is left out."""
    _words(ini, kins, Said(left_out=said.left_out + "W"), have="XYZBC")
    pivot = _lengths(kins, hal)["pivot-length"]
    _known_tool(kins, "pivot-length", pivot)
    rotary = [RotaryAxis("C", False, (0, 0, 0)), RotaryAxis("B", False, (0, 0, pivot.constant), True)]
    made = Law("[w b X Y Z C B (S) t]", ["X", "Y", "Z"], rotary)
    if "W" in kins.axes:
        made.remarks.append("W is left out: it stays where it is, at 0")
    return _switched(ini, kins, hal, made, 0)


def _switched(ini: Ini, kins: Module, hal: Hal, made: Law, tcp_type: int) -> Law:
    """Which M codes switch the kinematics, found in the remaps: `M68 E3 Q1`, or the number under a name."""
    if "motion.switchkins-type" not in [pin for pins in hal.nets.values() for pin in pins]:
        raise Refused(
            f"{kins.place}: nothing is connected to motion.switchkins-type, so a program cannot switch {kins.name} on and "
            "off, and G53 would move the tip and not the axes: see the configurations of LinuxCNC under configs/sim/axis/vismach"
        )
    codes = {}
    for entry in ini.entries("RS274NGC", "REMAP"):
        found = re.match(r"(M\d+)\b.*\bngc=(\S+)", entry.text, re.IGNORECASE)
        if found and (number := _kinematics_number(ini, found[2])) is not None:
            codes.setdefault(number, found[1].upper())
    identity = 0 if tcp_type == 1 else 1
    if tcp_type not in codes or identity not in codes:
        raise Refused(
            f"{kins.place}: no REMAP of [RS274NGC] sets the kinematics to {tcp_type} ({kins.name}) and to {identity} (axes): "
            "take M428 and M429 of LinuxCNC's own configurations"
        )
    made.tcp, made.tcp_on, made.tcp_off = True, codes[tcp_type], codes[identity]
    return made


def _kinematics_number(ini: Ini, name: str) -> int | None:
    """The kinematics that a subroutine switches to."""
    folders = [ini.path.parent]
    folders += [ini.beside(part) for part in ini.text("RS274NGC", "SUBROUTINE_PATH").split(":") if part]
    folders += [ini.beside(ini.text("DISPLAY", "PROGRAM_PREFIX"))]
    for folder in folders:
        path = folder / f"{name}.ngc"
        if not path.is_file():
            continue
        text = re.sub(r"\(.*?\)|;.*", "", path.read_text(encoding="utf-8", errors="replace"))
        values = dict(re.findall(r"#\s*<(\w+)>\s*=\s*(\d+)", text))
        asked = re.search(r"M68\s+E\S+\s+Q\s*(?:#\s*<(\w+)>|(\d+))", text, re.IGNORECASE)
        if asked and (asked[2] or asked[1] in values):
            return int(asked[2] or values[asked[1]])
    return None
