"""Numbers and objects of a .fcm file, which are what they should be or are refused by name."""

import argparse
import re
import sys

from . import Refused

# Where FreeCAD has no place for the gauge point and the dialect its remarks keep them.
GAUGE = re.compile(r"gauge point ([-+.e\d]+),([-+.e\d]+),([-+.e\d]+) mm")
DIALECT = re.compile(r"dialect (\S+)")
CANONICAL = {"X": (1, 0, 0), "Y": (0, 1, 0), "Z": (0, 0, 1), "A": (1, 0, 0), "B": (0, 1, 0), "C": (0, 0, 1)}


def number(value):
    return f"{value + 0:.10g}"


def finite(value, what):
    """A number of a .fcm file, which has to be one."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < 1e9:
        raise Refused(f"{what}: {value!r} is no number below 1e9")
    return value


def three(values, what):
    if not isinstance(values, list) or len(values) != 3:
        raise Refused(f"{what}: {values!r} are not three numbers")
    return [finite(value, what) for value in values]


def part_of(data, key, what):
    """The object `key` of a .fcm file, empty where it is not there."""
    value = data.get(key)
    if not isinstance(value, (dict, type(None))):
        raise Refused(f"{what}: {value!r} is no JSON object")
    return value or {}


def told(message):
    print(f"warning: {message}", file=sys.stderr)


def triple(values):
    return "[" + ", ".join(map(number, values)) + "]"


def gauge(text):
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != 3 or not all(abs(each) < 1e9 for each in numbers):
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z")
    return numbers
