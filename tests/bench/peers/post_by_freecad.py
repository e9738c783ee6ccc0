"""Posts the moves of a program by one of FreeCAD's posts, and prints how many and how long that took.

    PEER_PROGRAM=wave.ngc PEER_POST=linuxcnc_post PEER_MOVES=20000 PEER_OUTPUT=out.ngc freecadcmd post_by_freecad.py

A line `posted MOVES SECONDS`: seconds of the processor in the post alone, from FreeCAD's commands in memory to the
written file. What FreeCAD takes to start and to take the moves over is not counted.
"""

import os
import re
import time
from importlib import import_module

import FreeCAD
import Path

WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")


def moves(lines, most):
    """G0 and G1 with all words in force, which FreeCAD's own operations give too."""
    name, words, found = "G0", {}, []
    for line in lines:
        block = WORD.findall(line)
        if not block or any(letter not in "GXYZABCF" for letter, _ in block):
            continue
        codes = [value for letter, value in block if letter == "G"]
        if any(code not in ("0", "1", "00", "01") for code in codes):
            continue
        if codes:
            name = f"G{int(codes[0])}"
        for letter, value in block:
            if letter != "G":
                # A feed is in mm/s.
                words[letter] = float(value) / (60.0 if letter == "F" else 1.0)
        found.append(Path.Command(name, words))
        if len(found) == most:
            break
    return found


class Operation:
    """As much of an operation as a post asks for."""

    Label = Name = "Wave"
    Active = True


with open(os.environ["PEER_PROGRAM"], encoding="utf-8") as program:
    found = moves(program, int(os.environ["PEER_MOVES"]))
operation = Operation()
operation.Path = Path.Path(found)
post = import_module("PathScripts.post." + os.environ["PEER_POST"])
begin = time.process_time()
post.export([operation], os.environ["PEER_OUTPUT"], "--no-show-editor --no-comments")
print("posted", len(found), time.process_time() - begin, flush=True)
