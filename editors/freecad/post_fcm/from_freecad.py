"""The machine file that a .fcm file amounts to."""

import json

from . import Refused
from .chain import Axis, chain_of
from .words import DIALECT, GAUGE, finite, gauge, number, part_of, triple

# Post-processors of FreeCAD, and the dialect that speaks to the same control.
DIALECTS = {
    "linuxcnc": "linuxcnc",
    "fanuc": "fanuc",
    "grbl": "grbl",
    "heidenhain": "heidenhain",
    "hass_next_generation": "haas",
}

# Of controls that are told where Z stands clear, how far below the end of its travel (as `post new` writes it), and why.
STANDS_CLEAR = {
    "okuma": (0, "where Z stands clear, from the zero of G16 H0: read it off the machine"),
    "grbl": (2, "Z at its end is on the homing switch: minus the pull-off ($27), or lower"),
}
# Firmware without machine coordinates.
NO_POSITIONS = ("klipper", "marlin")
# Of controls whose unit system no word of a program chooses, what it is by the units of the program.
UNIT_SYSTEM = {
    "okuma": {"metric": "1 mm", "imperial": "1 inch"},
    "brother": {"metric": "mm", "imperial": "inch"},
}


def retract(dialect, axes):
    """Where a control is to be told it: how the tool is retracted."""
    if dialect in NO_POSITIONS:
        return ["retract = {}  # nothing retracts: there are no machine coordinates", "change  = {}"]
    if dialect not in STANDS_CLEAR or "Z" not in axes:
        return []
    below, why = STANDS_CLEAR[dialect]
    least, most = axes["Z"].travel  # it counts away from the part: `post check` refuses another
    return [f"retract = {{ Z = {number(max(least, most - below))} }}  # {why}"]


def from_freecad(path, asked):
    try:
        data = json.loads(path.read_text(encoding="utf-8-sig"))  # with or without a byte order mark
    except (ValueError, RecursionError) as fault:
        raise Refused(f"no JSON: {fault}") from None
    if not isinstance(data, dict):
        raise Refused("it is no JSON object")
    machine = part_of(data, "machine", "machine") if "machine" in data else data
    listed = part_of(machine, "axes", "axes")
    if not listed:
        raise Refused("it has no axes")
    units = machine.get("units", "metric")
    if units not in ("metric", "imperial"):
        raise Refused(f"units {units!r}: metric or imperial")
    unit = 25.4 if units == "imperial" else 1.0
    kinematics = part_of(machine, "kinematics", "kinematics")
    base = part_of(kinematics, "base_frame", "kinematics.base_frame")
    turned = base.get("orientation_quaternion", [0, 0, 0, 1])
    if base.get("origin", [0, 0, 0]) != [0, 0, 0] or not isinstance(turned, list) or turned[:3] != [0, 0, 0]:
        raise Refused("kinematics.base_frame is not that of the machine: what it moves FreeCAD does not say")
    heads = machine.get("toolheads", machine.get("spindles", []))
    if not isinstance(heads, list) or not all(isinstance(head, dict) for head in heads):
        raise Refused(f"toolheads: {heads!r} is no list of JSON objects")
    if any(head.get("toolhead_type", head.get("spindle_type", "rotary")) != "rotary" for head in heads):
        raise Refused("a toolhead that is no spindle: post cuts with spindles")
    axes = {name: Axis(name, each, unit) for name, each in listed.items()}
    chosen = str(part_of(data, "postprocessor", "postprocessor").get("file_name", "")).replace("_legacy", "")
    notes = str(kinematics.get("notes", ""))
    noted = DIALECT.search(notes)
    dialect = asked.dialect or DIALECTS.get(chosen) or (noted and noted[1])
    if dialect is None:
        raise Refused(
            f"which dialect its control speaks is not known from the post-processor {chosen!r}: --dialect NAME"
        )
    rotary = any(axis.rotary for axis in axes.values())
    kept = GAUGE.search(notes)
    gauge_point = asked.gauge or gauge(",".join(kept.groups()) if kept else "0,0,0")
    names = [machine.get("manufacturer") or "", machine.get("name") or path.stem]
    if not all(isinstance(each, str) for each in names):
        raise Refused(f"manufacturer and name {names}: not both are texts")
    name = " ".join(filter(None, names))
    if not name.isprintable():
        raise Refused(f"name {name!r}: a character of it cannot be printed")
    lines = [
        f"# Written by post-fcm from {path.name}. FreeCAD does not say where the gauge line is, nor accelerations;",
        "# every sign is to be checked on the machine before a program runs (`post check`).",
        "",
        f"name  = {json.dumps(name, ensure_ascii=False)}",
        f'chain = "{chain_of(axes)}"',
        "",
        "[tool]",
        f"gauge = {triple(gauge_point)}",
        "axis  = [0, 0, 1]",
    ]
    for axis in axes.values():
        lines += ["", *axis.table()]
    lines += [
        "",
        "[control]",
        f"dialect = {json.dumps(dialect, ensure_ascii=False)}",
        f'tcp     = "{"control" if rotary and kinematics.get("tcp_supported") else "post"}"',
        *retract(dialect, axes),
    ]
    written = "metric" if part_of(data, "output", "output").get("units", "metric") == "metric" else "imperial"
    if written == "imperial":
        lines.append('units   = "inch"')
    if dialect in UNIT_SYSTEM:
        system = json.dumps(UNIT_SYSTEM[dialect][written])
        lines += ["", f"[control.{dialect}]", f"unit_system = {system}  # a parameter of the control: compare"]
    speeds = (
        [
            (key, finite(heads[0].get(name, 0), f"toolhead: {name}"))
            for key, name in (("min_speed", "min_rpm"), ("max_speed", "max_rpm"))
        ]
        if heads
        else []
    )
    if any(value for _, value in speeds):
        lines += ["", "[spindle]", *[f"{key} = {number(value)}" for key, value in speeds if value]]
    return "\n".join([*lines, "", "[accuracy]", "tolerance = 0.005"]) + "\n"
