"""The machine file of `post` that an INI file of LinuxCNC amounts to."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from . import Refused, hal, kinematics
from .ini import Ini
from .kinematics import DIRECTIONS, LINEAR, Law, Module, RotaryAxis, Said

# The key of the machine file that --set takes besides the pins of HAL, as post's own messages name it.
REFERENCE = "tools.reference"

UNLIMITED = 1e9  # LinuxCNC takes 1e99 where no limit is said


@dataclass
class Scale:
    """A letter's limits over its joints, in units of `post`: mm or degrees, a minute, a second squared."""

    least: float
    most: float
    feed: float | None
    acceleration: float | None
    home: float | None
    places: str  # where the limits stand


def number(value: float) -> str:
    return f"{value + 0:.10g}"  # + 0: no -0


def triple(values: tuple[float, ...], scale: float) -> str:
    return "[" + ", ".join(number(value * scale) for value in values) + "]"


def _limits(ini: Ini, kins: Module, letter: str, *, joints: bool = True) -> Scale:
    """The narrowest of what the sections of an axis and of its joints allow: LinuxCNC holds programs to both."""
    unit = ini.millimetres() if letter in LINEAR else ini.degrees()
    sections = [f"AXIS_{letter}"]
    if joints:
        sections += [f"JOINT_{joint}" for joint in kins.joints(letter)]

    def all_of(key: str) -> list[float]:
        found = [ini.number(section, key) for section in sections]
        return [value * unit for value in found if value is not None]

    def positive(key: str) -> list[float]:
        for entry in (ini.first(section, key) for section in sections):
            if entry and entry.number() <= 0:
                raise Refused(f"{entry.place} = {entry.text}: {letter} cannot move so: say a number above 0")
        return all_of(key)

    def places() -> str:
        """Where limits stand, with their values, else the sections that have none."""
        entries = (ini.first(section, key) for section in sections for key in ("MIN_LIMIT", "MAX_LIMIT"))
        found = [f"{entry.place} = {entry.text}" for entry in entries if entry]
        return ", ".join(found) or ini.at(next((each for each in sections if each in ini.heads), sections[0]), "MIN_LIMIT")

    speeds, accelerations = positive("MAX_VELOCITY"), positive("MAX_ACCELERATION")
    homes = [ini.number(section, "HOME") for section in sections[1:]]
    return Scale(
        least=max(all_of("MIN_LIMIT"), default=-UNLIMITED * 10),
        most=min(all_of("MAX_LIMIT"), default=UNLIMITED * 10),
        feed=min(speeds) * 60 if speeds else None,
        acceleration=min(accelerations, default=None),
        home=homes[0] * unit if homes and homes[0] is not None else None,
        places=places(),
    )


def _axis(ini: Ini, kins: Module, letter: str, turned: RotaryAxis | None, belt: bool) -> list[str]:
    """The table of an axis."""
    scale = _limits(ini, kins, letter, joints=not belt or letter == "Z")
    lines = [f"[axis.{letter}]"]
    kind = "rotary" if turned else "linear"
    lines.append(f"{kind:<9} = [{', '.join(map(str, DIRECTIONS[letter]))}]")
    if turned:
        lines.append(f"point     = {triple(turned.point, ini.millimetres())}")
        wrapped = ini.first(f"AXIS_{letter}", "WRAPPED_ROTARY")
        if wrapped and wrapped.text != "0":
            raise Refused(
                f"{wrapped.place}: words of a wrapped axis go from 359 to 1 and tell its sense by their sign; programs of `post` "
                "count whole turns: take WRAPPED_ROTARY out"
            )
    for joint in kins.joints(letter):
        locking = ini.first(f"JOINT_{joint}", "LOCKING_INDEXER")
        if locking and locking.text != "0":
            raise Refused(
                f"{locking.place}: an indexer that locks: describe {letter} by hand with `indexed` and `step`"
            )
    if scale.least > -UNLIMITED and scale.most < UNLIMITED:
        if scale.least >= scale.most:
            raise Refused(
                f"{scale.places}: {letter} may go from {number(scale.least)} to {number(scale.most)}: no travel: let MIN_LIMIT be "
                "below MAX_LIMIT"
            )
        travel = f"travel    = [{number(scale.least)}, {number(scale.most)}]"
        lines.append(travel if scale.home is None else f"{travel:<40}# homes at {number(scale.home)}")
    elif turned:
        lines.append("cyclic    = true")
    else:
        raise Refused(
            f"{scale.places}: {letter} has no travel: say MIN_LIMIT and MAX_LIMIT in [AXIS_{letter}] or [JOINT_N] of it"
        )
    if turned and turned.reversed:
        lines.append("reversed  = true")
    feed, acceleration = scale.feed, scale.acceleration
    if belt and letter in "XY":
        feed, acceleration = _belt(ini, feed, 60), _belt(ini, acceleration, 1)
    if feed is not None:
        lines.append(f"max_feed  = {number(feed)}")
    if acceleration is not None:
        lines.append(f"max_accel = {number(acceleration)}")
    return lines


def _belt(ini: Ini, value: float | None, unit: float) -> float | None:
    """A speed (unit 60) or acceleration (1) of X and Y with which no belt passes its own: they add up there."""
    key = "MAX_VELOCITY" if unit == 60 else "MAX_ACCELERATION"
    found = [ini.number(f"JOINT_{joint}", key) for joint in (0, 1)]
    halves = [each * ini.millimetres() * unit / 2 for each in found if each is not None]
    return min([*halves, *([] if value is None else [value])], default=None)


def _belts(ini: Ini) -> list[str]:
    """The travel of the belts of a CoreXY, which are the sum and the difference of X and Y."""
    lines = []
    for joint, sum_of in ((0, "X + Y"), (1, "X - Y")):
        for key, sign in (("MIN_LIMIT", ">="), ("MAX_LIMIT", "<=")):
            bound = ini.number(f"JOINT_{joint}", key)
            if bound is not None and abs(bound) < UNLIMITED:
                lines += [
                    "",
                    "[[limit]]",
                    f'keep = "{sum_of} {sign} {number(bound * ini.millimetres())}"    # JOINT_{joint}',
                ]
    return lines


@dataclass
class Tools:
    """What the user says of the tool table."""

    left_out: bool = False
    reference: float | None = None  # mm: the length of the tool that touched-off offsets count from


def table_place(ini: Ini) -> str:
    """Where the INI file names the tool table."""
    return ini.at("EMCIO", "TOOL_TABLE")


def _tools(ini: Ini, folder: Path, said: Tools) -> list[str]:
    """The tool table that the machine and `post` share."""
    name = ini.text("EMCIO", "TOOL_TABLE")
    if said.reference is not None and (said.left_out or not name):
        why = "--no-tools leaves it out" if said.left_out else f"{table_place(ini)} names none"
        raise Refused(f"--set {REFERENCE}={number(said.reference)}: there is no tool table that it would be of: {why}")
    if said.left_out:
        return ["# [EMCIO] TOOL_TABLE is left out (--no-tools): lengths come from --tools or --tool-length."]
    if not name:
        return ["# [EMCIO] names no TOOL_TABLE: lengths come from --tools or --tool-length."]
    path = ini.beside(name)
    unit = "inch" if ini.millimetres() == 25.4 else "mm"
    lines = ["[tools]                                # the table that LinuxCNC itself has"]
    lines += [f'file   = "{os.path.relpath(path, folder.resolve())}"', 'format = "linuxcnc"', f'units  = "{unit}"']
    if said.reference is not None:
        lines.append(f"reference = {number(said.reference)}")
    if not path.is_file():  # LinuxCNC makes one at its first start
        return [f"# {line}" for line in lines]
    return lines


def _control(ini: Ini, law: Law) -> list[str]:
    lines = ["[control]", 'dialect = "linuxcnc"']
    lines.append(f'tcp     = "{"control" if law.tcp else "post"}"')
    if ini.millimetres() == 25.4:
        lines.append('units   = "inch"')
    if law.tcp:
        lines += ["", "[control.linuxcnc]", f'tcp_on  = "{law.tcp_on}"', f'tcp_off = "{law.tcp_off}"']
    lines += [
        "",
        "[motion]                               # of LinuxCNC 2.9, as it was recorded",
        'limits = "programmed"                  # X Y Z of the tip, whatever its kinematics make of them',
        'blend  = "overlap"',
        'rapids = "among-rapids"',
    ]
    return lines


def _spindle(ini: Ini) -> list[str]:
    bounds = (("min_speed", "MIN_FORWARD_VELOCITY"), ("max_speed", "MAX_FORWARD_VELOCITY"))
    found = [(key, ini.number("SPINDLE_0", name)) for key, name in bounds]
    lines = [f"{key} = {number(value)}" for key, value in found if value]
    return ["", "[spindle]", *lines] if lines else []


def machine_file(
    ini: Ini,
    said: Said,
    pins: dict[str, float],
    folder: Path,
    *,
    running: bool = False,
    tools: Tools | None = None,
) -> str:
    """The text of the machine file, to stand in `folder`; refuses what the INI file and HAL files do not say."""
    kins = kinematics.module(ini)
    read = hal.read(ini, pins, running)
    law = kinematics.law(ini, kins, read, said)
    if needless := [pin for pin in pins if pin not in read.asked]:
        asked = ", ".join(sorted(read.asked)) or "none"
        raise Refused(
            *(
                f"--set {pin}={number(pins[pin])}: {kins.place} takes no length from this pin; "
                f"those that it takes: {asked}; and {REFERENCE} of the tool table"
                for pin in needless
            )
        )
    name = " ".join(ini.text("EMC", "MACHINE", ini.path.stem).replace('"', "'").replace("\\", "/").split())
    lines = [
        f"# Written by post-from-ini from {ini.path.name}: kinematics {kins.entry.text}.",
        "# Every sign is to be checked on the machine before a program runs (`post check`).",
    ]
    if law.tcp:
        lines.append(
            "# Travel is that of the joints. In TCP LinuxCNC holds [AXIS_...] against the words of the program besides."
        )
    if change := ini.text("EMCIO", "TOOL_CHANGE_POSITION"):
        lines.append(f"# M6 goes to [EMCIO] TOOL_CHANGE_POSITION {change} by itself, which no program of post tells.")
    lines += [f"# {remark}." for remark in law.remarks]
    lines += ["", f'name  = "{name}"', f'chain = "{law.chain}"', ""]
    lines += [
        "[tool]",
        "gauge = [0, 0, 0]                      # the frame is that of machine coordinates",
        "axis  = [0, 0, 1]",
    ]
    faults: list[str] = []
    for letter, turned in [(axis.letter, axis) for axis in law.rotary] + [(letter, None) for letter in law.linear]:
        try:
            lines += ["", *_axis(ini, kins, letter, turned, law.belt)]
        except Refused as refused:
            faults += refused.faults
    if faults:
        raise Refused(*faults)
    if law.belt:
        lines += _belts(ini)
    lines += ["", *_tools(ini, folder, tools or Tools()), *_spindle(ini), "", *_control(ini, law)]
    lines += ["", "[accuracy]", "tolerance = 0.005"]
    return "\n".join(lines) + "\n"
