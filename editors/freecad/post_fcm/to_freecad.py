"""The .fcm file that a machine file amounts to."""

import json
import math
import re

from . import Refused
from .chain import Axis, chain_of
from .machine_file import checked, tables_of, value_of
from .words import CANONICAL, number, told, triple

ENDLESS = 36000.0  # deg; FreeCAD has no axis without end
# Tables of a machine file without which the tool is elsewhere: FreeCAD has no place for them.
LAW = ("leg", "formulas", "head", "word", "drive")
# Keys that FreeCAD's file holds, by table; of the others each is told by its name.
HELD = {
    "axis": {"linear", "rotary", "point", "travel", "reversed", "max_feed", "zero", "indexed"},
    "tool": {"gauge", "axis"},
    "control": {"dialect", "tcp"},
    "spindle": {"min_speed", "max_speed"},
}
# How FreeCAD leads an operation on a work plane, by dialect: its strategy and its plane command.
STRATEGIES = {
    "haas": ("dwo", "g268"),
    "heidenhain": ("twp", "plane_spatial"),
    **dict.fromkeys(("fanuc", "mazak", "mitsubishi", "brother", "syntec"), ("twp", "g68.2")),
}


def lost_of(file):
    """What FreeCAD's file has no place for, by the names of the machine file."""
    lost = []
    for key, value in file.items():
        if key in ("name", "chain", "extends", "parameters"):
            continue
        if key not in HELD:
            lost.append(f"[{key}]" if isinstance(value, (dict, list)) else key)
        elif key == "axis":
            for name, table in value.items():
                lost += [f"[axis.{name}] {each}" for each in table if each not in HELD["axis"]]
        else:
            lost += [f"[{key}] {each}" for each in value if each not in HELD[key]]
    return lost


def to_freecad(path, asked):
    derived = checked(asked.post, path)
    file = tables_of(path)
    parameters = file.get("parameters", {})
    law = [key for key in LAW if file.get(key)]
    if law:
        raise Refused(
            f"FreeCAD has no place for {', '.join(f'[{key}]' for key in law)}, and the tool is elsewhere without"
        )
    tool = file.get("tool", {})
    along = [value_of(each, parameters) for each in tool.get("axis", [0, 0, 1])]
    if math.hypot(along[0], along[1]) > 1e-9 * math.hypot(*along) or along[2] <= 0:
        raise Refused(f"[tool] axis = {triple(along)}: FreeCAD's tools lie along Z, [0, 0, 1]")
    lost = lost_of(file)
    axes, last = {}, {True: None, False: None}
    # From the bed outward on either side: each is carried by the one before.
    listed = derived["class"]["axes"]
    outward = [axis for axis in reversed(listed) if axis["carries_part"]] + [
        axis for axis in listed if not axis["carries_part"]
    ]
    for place, axis in enumerate(outward):
        name, on_table = axis["name"], axis["carries_part"]
        table = file.get("axis", {}).get(name, {})
        if name not in CANONICAL or axis["indexed"] is not None or value_of(table.get("zero", 0), parameters) != 0:
            raise Refused(
                f"axis {name}: FreeCAD has X, Y, Z, A, B and C, none that is indexed or counts from a zero of its own"
            )
        sense = -1 if table.get("reversed", False) else 1
        if axis["rotary"] and on_table:
            sense = -sense  # FreeCAD's angles turn the part right-handed
        travel = axis["travel"] or [-ENDLESS, ENDLESS]
        point = table.get("point", [0, 0, 0]) if axis["rotary"] else [0, 0, 0]
        given = table.get("rotary" if axis["rotary"] else "linear")
        if given is None:
            raise Refused(f"axis {name}: the file says no direction of it")
        vector = [value_of(each, parameters) for each in given]
        axes[name] = {
            "type": "rotary" if axis["rotary"] else "linear",
            "role": ("table" if on_table else "head") + ("_rotary" if axis["rotary"] else "_linear"),
            "parent": last[on_table],
            "sequence": place,
            "joint": {
                "origin": [value_of(each, parameters) for each in point],
                "axis": [value * sense / math.hypot(*vector) + 0 for value in vector],
            },
            "limits": {"min": travel[0], "max": travel[1]},
            "max_velocity": axis["max_feed"] or (36000 if axis["rotary"] else 10000),
        }
        last[on_table] = name
    back = chain_of({name: Axis(name, each, 1.0) for name, each in axes.items()})
    turning = [axis["name"] for axis in listed if axis["rotary"]]
    if [name for name in re.findall(r"\b[ABC]\b", back) if name in turning] != turning:
        raise Refused(f"FreeCAD turns a table about Z first: its order of {' and '.join(turning)} is another, {back}")
    if lost:
        told(f"{path}: not in FreeCAD's file: {', '.join(lost)}")
    dialect = file.get("control", {}).get("dialect", "")
    rotary = any(axis["rotary"] for axis in listed)
    strategy, plane = STRATEGIES.get(dialect, ("post_transform", "g68.2")) if rotary else ("none", "g68.2")
    spindle = file.get("spindle", {})
    gauge_point = [value_of(each, parameters) for each in tool.get("gauge", [0, 0, 0])]
    machine = {
        "name": derived["machine"],
        "manufacturer": "",
        "description": f"Written by post-fcm from {path.name}",
        "units": "metric",
        "kinematics": {
            "base_frame": {"origin": [0, 0, 0], "orientation_quaternion": [0, 0, 0, 1]},
            "tcp_supported": file.get("control", {}).get("tcp") == "control",
            "dwo_supported": strategy == "dwo",
            "rotation_strategy": strategy,
            "plane_command": plane,
            "control_positions_rotaries": True,
            "index_retract_z": 0.0,
            "notes": f"gauge point {','.join(map(number, gauge_point))} mm"
            + (f"; dialect {dialect}" if dialect else ""),
        },
        "axes": axes,
        "toolheads": [
            {
                "id": "toolhead1",
                "name": "Spindle",
                "toolhead_type": "rotary",
                "tool_change": "automatic",
                "max_rpm": value_of(spindle.get("max_speed", 0), parameters),
                "min_rpm": value_of(spindle.get("min_speed", 0), parameters),
            }
        ],
    }
    post = {"file_name": "post_cl", "args": f"--machine {path.resolve()}", "properties": {}}
    data = {"freecad_version": "1.2.0", "machine": machine, "postprocessor": post, "version": 1}
    return json.dumps(data, indent=4, ensure_ascii=False) + "\n"
