"""Joints behind the words of parallel machines, and an arm by the parameters that its maker publishes.

Laws are those of the papers and firmware named with each, written from joints and vectors: where the platform's
middle stands in the frame, and which way the tool leaves it.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from sixty_one.kinematics import Floats, Joint, Vector

Law = Callable[[Floats, Floats], float]
"""From the platform's middle, mm, and the tool's axis, to where the drive stands, mm."""


def belt(sign: int) -> Law:
    """A belt of a core-XY printer (corexy.com): X + Y and X - Y."""
    return lambda middle, _: float(middle[0] + sign * middle[1])


def carriage(degrees: float, radius: float, rod: float) -> Law:
    """The carriage of a linear delta (Marlin's delta.cpp): as high over the platform as its rod reaches up."""
    tower = radius * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
    return lambda middle, _: float(middle[2] + math.sqrt(rod**2 - float(np.sum((tower - middle[:2]) ** 2))))


def leaned(axis: Floats) -> Floats:
    """The platform's own directions, by columns, where it is turned by A about X and then by B about Y."""
    a = math.asin(-axis[1])
    b = math.atan2(axis[0], axis[2])
    about_x = np.array([[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]])
    about_y = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]])
    return np.asarray(about_y @ about_x)


def ring(radius: float, degrees: float) -> Floats:
    """A point of a circle about Z."""
    return radius * np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])


def hexapod(frame: float, platform: float) -> tuple[tuple[str, Law], ...]:
    """Six struts between pairs of joints: 12 degrees to each side of 90, 210 and 330 in the frame, 46 of them on the
    platform."""

    def strut(above: float, below: float) -> Law:
        return lambda middle, axis: float(
            np.linalg.norm(middle + leaned(axis) @ ring(platform, below) - ring(frame, above))
        )

    ends = [(78, 44), (102, 136), (198, 164), (222, 256), (318, 284), (342, 376)]
    return tuple((f"L{number}", strut(*one)) for number, one in enumerate(ends, 1))


def tricept(frame: float, platform: float, wrist: float) -> tuple[tuple[str, Law], ...]:
    """A tube in a universal joint, turned about X of the frame first and then about its own Y, no twist (Siciliano
    1999)."""

    def strut(degrees: float) -> Law:
        def length(middle: Floats, _: Floats) -> float:
            along = -middle / np.linalg.norm(middle)
            # Of a tube turned by a about X, then by b about its own Y: along = (sin b, -sin a cos b, cos a cos b).
            own_y = np.array([0.0, along[2], -along[1]]) / math.hypot(along[1], along[2])
            own = np.stack([np.cross(own_y, along), own_y, along], axis=1)
            joint = middle + wrist * along + own @ ring(platform, degrees)
            return float(np.linalg.norm(joint - ring(frame, degrees)))

        return length

    return tuple((f"L{number}", strut(degrees)) for number, degrees in enumerate((0, 120, 240), 1))


def exechon(sides: float, third: float, outer: float, inner: float, depth: float) -> tuple[tuple[str, Law], ...]:
    """Legs A and C in one plane that turns about the frame's Y, leg B across it (Zoppi, Zlatanov, Molfino 2010),
    found from what the joints leave: the platform's Y lies in the plane of A and C, and leg B in the platform's plane
    of X and Z."""

    def law(name: str) -> Law:
        def length(middle: Floats, _: Floats) -> float:
            alpha = math.atan2(middle[0], -middle[2])
            outwards = np.array([math.sin(alpha), 0.0, -math.cos(alpha)])
            across = np.array([math.cos(alpha), 0.0, math.sin(alpha)])
            b = np.array([third, 0.0, 0.0])
            # The platform turns about `across` until the joint of B lies in its plane square to its own Y.
            low, high = -1.2, 1.2

            def off(beta: float) -> float:
                own_y = np.array([0, math.cos(beta), 0]) - math.sin(beta) * outwards
                return float((b - middle) @ own_y)

            for _step in range(80):
                half = (low + high) / 2
                low, high = (half, high) if off(low) * off(half) > 0 else (low, half)
            own_y = np.array([0, math.cos(low), 0]) - math.sin(low) * outwards
            own_down = np.cross(own_y, across)
            own_down = own_down if own_down @ outwards > 0 else -own_down
            origin = middle - depth * own_down
            joints = {
                "qA": (np.array([0, -sides, 0.0]), origin - outer * own_y),
                "qC": (np.array([0, sides, 0.0]), origin + outer * own_y),
                "qB": (b, origin + inner * across),
            }
            above, below = joints[name]
            return float(np.linalg.norm(below - above))

        return length

    return tuple((name, law(name)) for name in ("qA", "qB", "qC"))


def sprint(platform: float, carriages: float, rod: float) -> tuple[tuple[str, Law], ...]:
    """A 3-PRS head (Bonev 2002): each joint of the platform stays in an upright plane through the head's axis, so
    that it leans without twist and goes a little aside, which the portal takes out."""

    def law(degrees: float) -> Law:
        def slide(middle: Floats, axis: Floats) -> float:
            # A lean without twist turns about the line across Z and the tool: azimuth and lean alone.
            around, lean = math.atan2(axis[1], axis[0]), math.acos(min(1.0, float(axis[2])))
            line = np.array([-math.sin(around), math.cos(around), 0.0])
            cross = np.array([[0, -line[2], line[1]], [line[2], 0, -line[0]], [-line[1], line[0], 0]])
            turn = np.eye(3) + math.sin(lean) * cross + (1 - math.cos(lean)) * cross @ cross
            legs = (0.0, 120.0, 240.0)
            arms = [turn @ ring(platform, one) for one in legs]
            sides = [ring(1.0, one + 90.0)[:2] for one in legs]
            # Where the middle goes so that each joint stays in its plane.
            aside, *_ = np.linalg.lstsq(
                np.array(sides), [-arm[:2] @ side for arm, side in zip(arms, sides)], rcond=None
            )
            place = legs.index(degrees)
            joint = arms[place] + np.append(aside, middle[2])
            out = carriages - float(joint @ ring(1.0, degrees))
            return float(joint[2] + math.sqrt(rod**2 - out**2))

        return slide

    return tuple((f"S{number}", law(degrees)) for number, degrees in enumerate((0.0, 120.0, 240.0), 1))


def universal(d1: float, a2: float, a3: float, d4: float, d5: float) -> tuple[Joint, ...]:
    """The six joints of an arm of Universal Robots from its published Denavit-Hartenberg parameters, mm."""
    rows = [(d1, 0.0, 90.0), (0.0, a2, 0.0), (0.0, a3, 0.0), (d4, 0.0, 90.0), (d5, 0.0, -90.0)]
    place, joints = np.eye(4), []
    for letter, row in zip("ABCUVW", [*rows, None]):
        way: Vector = (float(place[0, 2]), float(place[1, 2]), float(place[2, 2]))
        point: Vector = (float(place[0, 3]), float(place[1, 3]), float(place[2, 3]))
        joints.append(Joint(letter, True, way, point))
        if row:
            d, a, alpha = row
            c, s = math.cos(math.radians(alpha)), math.sin(math.radians(alpha))
            place = place @ np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1]])
    return tuple(joints)
