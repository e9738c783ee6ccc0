"""The axes of a .fcm file and the chain that they make."""

import math

from . import Refused
from .words import CANONICAL, finite, number, part_of, three, told, triple

ROLES = ("table_linear", "table_rotary", "head_linear", "head_rotary")


class Axis:
    """An axis of a .fcm file; lengths in mm."""

    def __init__(self, name, data, unit):
        if name not in CANONICAL:
            raise Refused(f"axis {name!r}: not one of {', '.join(CANONICAL)}")
        if not isinstance(data, dict):
            raise Refused(f"axis {name}: {data!r} is no JSON object")
        self.name = name
        if data.get("type", "linear") not in ("linear", "rotary", "angular"):
            raise Refused(f"axis {name}: its type {data['type']!r} is neither linear nor rotary")
        self.rotary = data.get("type", "linear") != "linear"
        self.parent = data.get("parent")
        if not isinstance(self.parent, (str, type(None))):
            raise Refused(f"axis {name}: its parent {self.parent!r} is no name")
        kind = "rotary" if self.rotary else "linear"
        self.role = data.get("role", f"table_{kind}")
        if self.role not in ROLES or not self.role.endswith(kind):
            raise Refused(f"axis {name}: its role {self.role!r} is not table_{kind} or head_{kind}")
        joint = data.get("joint")
        if isinstance(joint, dict):
            origin, vector = joint.get("origin"), joint.get("axis")
        elif isinstance(joint, list) and len(joint) == 2:
            origin, vector = joint
        else:
            raise Refused(f"axis {name}: no joint: an origin and a direction")
        vector, origin = three(vector, f"axis {name}: its direction"), three(origin, f"axis {name}: its origin")
        length = math.hypot(*vector)
        if length < 1e-9:
            raise Refused(f"axis {name}: its direction {vector} has no length (FreeCAD would take another in silence)")
        self.vector = [value / length for value in vector]
        self.origin = [value * unit for value in origin]
        limits = part_of(data, "limits", f"axis {name}: limits")
        least, most = (finite(limits.get(end), f"axis {name}: limits.{end}") for end in ("min", "max"))
        if least >= most:
            raise Refused(f"axis {name}: limits from {least} to {most} are no travel")
        scale = 1 if self.rotary else unit
        self.travel = [least * scale, most * scale]
        self.speed = finite(data.get("max_velocity", 0), f"axis {name}: max_velocity") * scale
        if self.speed < 0:
            raise Refused(f"axis {name}: max_velocity {data['max_velocity']} is negative")
        if self.speed == 0:
            told(f"axis {name}: its max_velocity is 0 or not there: the machine file gets no max_feed for it")
        self.on_table = self.role.startswith("table")

    def table(self):
        lines = [f"[axis.{self.name}]"]
        canonical = CANONICAL.get(self.name)
        along = sum(a * b for a, b in zip(self.vector, canonical)) if canonical else 1
        if not self.rotary:
            lines.append(f"linear   = {triple(self.vector)}")
        else:
            # ISO 841 counts a table the other way: the tool turns against the part.
            sense = -1 if self.on_table else 1
            vector = [value * sense for value in self.vector]
            against = sense * along < 0
            lines.append(f"rotary   = {triple([-value for value in vector] if against else vector)}")
            lines.append(f"point    = {triple(self.origin)}")
        lines.append(f"travel   = {triple(self.travel)}")
        if self.rotary and against:
            lines.append("reversed = true")
        if self.speed > 0:
            lines.append(f"max_feed = {number(self.speed)}")
        return lines


def ancestors(axes, axis):
    """The axes that carry this one, the nearest first."""
    found, at = [], axis.parent
    while at is not None:
        if at not in axes:
            raise Refused(f"axis {axis.name}: its parent {at} is not there")
        if axes[at] in found or axes[at] is axis:
            raise Refused(f"axis {axis.name}: carries itself, over {at}")
        found.append(axes[at])
        at = axes[at].parent
    return found


def ordered(axes, rotary):
    """Rotary axes of one side, the one nearest to the bed first."""
    if len(rotary) < 2:
        return rotary
    if rotary[0].on_table:
        # FreeCAD turns about Z first and tilts then, whichever of the two is the parent.
        azimuth = [axis for axis in rotary if abs(axis.vector[2]) > 0.999]
        if len(azimuth) == 1:
            return [axis for axis in rotary if axis is not azimuth[0]] + azimuth
    by_depth = sorted(rotary, key=lambda axis: len([each for each in ancestors(axes, axis) if each in rotary]))
    depths = [len([each for each in ancestors(axes, axis) if each in rotary]) for axis in by_depth]
    if depths != list(range(len(rotary))):
        raise Refused(
            f"which of {' and '.join(axis.name for axis in rotary)} carries the other is not said: give one a parent"
        )
    return by_depth


def chain_of(axes):
    for axis in axes.values():
        carriers = ancestors(axes, axis)  # refuses what is not there
        if not axis.rotary and any(each.rotary for each in carriers):
            raise Refused(f"axis {axis.name}: a linear axis on a rotary one: describe the machine by hand")
        other = next((each for each in carriers if axis.rotary and each.on_table != axis.on_table), None)
        if other:
            raise Refused(f"axis {axis.name}: its role is {axis.role}, but {other.name}, {other.role}, carries it")
    sides = {}
    for on_table in (True, False):
        side = [axis for axis in axes.values() if axis.on_table == on_table]
        linear = [axis for axis in side if not axis.rotary]
        sides[on_table] = linear + ordered(axes, [axis for axis in side if axis.rotary])
    table = [f"{axis.name}'" for axis in reversed(sides[True])]
    head = [axis.name for axis in sides[False]]
    return "[" + " ".join(["w", *table, "b", *head, "(S)", "t"]) + "]"
