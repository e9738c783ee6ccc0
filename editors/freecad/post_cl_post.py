"""A post-processor of FreeCAD (0.20 or newer) that hands the job to `post`.

To be laid into FreeCAD's macro folder; FreeCAD then lists it as `post_cl`. The paths of a job become a CL file (APT) in the
part's frame, with arcs, drilling cycles, tools and work planes, `post` makes the program of it, reads it back and holds it
against the CL file. A path that cannot be said in the CL file is refused by operation and command; nothing is written then.

What a path holds is told by FreeCAD's sources: `Path scripting` of its documentation (commands are G-code of its own,
lengths in mm, F in mm/s), `Generators/drill_generator.py`, `tapping.py` (F of G84 is the pitch), `TiltedWorkPlane.py` (an
operation on a work plane has its path in the plane's frame, and the plane as its Placement).
"""

import argparse
import math
import os
import re
import shlex
import subprocess
import tempfile

TOOLTIP = (
    "Hands the job to the command `post`: a program of a machine that is described in a file, read back and proven."
)
UNITS = "G21"  # what a path holds

NEAR = 1e-6  # mm; FreeCAD's paths have six decimals
STEP = 2.0  # deg, the most that a rotary axis turns between two points of the CL file
CHORD = 0.001  # mm, the most that the tool strays between two such points
AXES = "XYZ"
PLANES = {"G17": 2, "G18": 1, "G19": 0}  # by the axis that stands on it
SYSTEMS = ["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"]
CYCLES = {"G81": "DRILL", "G82": "DRILL", "G83": "DEEP", "G73": "BRKCHP", "G84": "TAP", "G85": "REAM"}
COOLANT = {"M7": "MIST", "M8": "FLOOD", "M9": "OFF"}
# They say what is so in every path, or what `post` says by itself.
SILENT = {"G21", "G40", "G49", "G80", "G90", "G94", "M2", "M30"}
MOVE = "XYZABCUVWF"
# The words of each command that are looked at; with any other it is refused.
WORDS = {
    **dict.fromkeys([*SILENT, *PLANES, *SYSTEMS, *COOLANT, "G98", "G99", "M0", "M1", "M5"], ""),
    **dict.fromkeys(["G0", "G1"], MOVE),
    **dict.fromkeys(["G2", "G3"], MOVE + "IJKRP"),
    **dict.fromkeys(CYCLES, MOVE + "RLP"),
    **dict.fromkeys(["G83", "G73"], MOVE + "RLPQ"),
    **{"G84": MOVE + "RLPS", "G4": "P", "M3": "S", "M4": "S", "M6": "T", "G43": "H"},
}


class Refused(Exception):
    """What cannot be posted, with its place and what would help."""


class Arguments(argparse.ArgumentParser):
    """An error goes to FreeCAD's report view, and FreeCAD lives on."""

    def error(self, message):
        raise Refused("the job's arguments: " + message + "\n" + self.format_usage())

    def exit(self, status=0, message=None):
        raise Refused(message or self.format_help())


def arguments():
    parser = Arguments(
        prog="post_cl", description=TOOLTIP, epilog="All others are options of `post`.", allow_abbrev=False
    )
    parser.add_argument("-m", "--machine", help="a machine file, or the name of a machine that post knows")
    parser.add_argument("--command", default="post", help="the command [post]")
    parser.add_argument("--cl-only", action="store_true", help="the CL file in the place of the program")
    parser.add_argument("--no-report", action="store_true", help="no report beside the program")
    parser.add_argument("--no-verify", action="store_true", help="the program is not read back")
    parser.add_argument(
        "--rotary",
        choices=["part", "iso"],
        help="what A, B and C of a path mean, whose lines go through the job's origin: part, the part turns right-handed by "
        "them (FreeCAD's rotation generator); iso, as ISO 841 has it, the tool turns so against the part",
    )
    parser.add_argument(
        "--leave-out", action="append", default=[], metavar="G64", help="a command of paths to leave out"
    )
    return parser


TOOLTIP_ARGS = arguments().format_help()


# ---------------------------------------------------------------- frames: 3 rows of 4 numbers


IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0))


def turned(frame, vector):
    """A direction of the frame, in that of the part."""
    return tuple(sum(row[each] * vector[each] for each in range(3)) for row in frame)


def placed(frame, point):
    """A point of the frame, in that of the part."""
    return tuple(value + row[3] for value, row in zip(turned(frame, point), frame))


def product(first, second):
    """The frame `second` as it stands in `first`."""
    columns = [turned(first, [row[each] for row in second]) for each in range(3)] + [
        placed(first, [row[3] for row in second])
    ]
    return tuple(zip(*columns))


def rotation(axis, degrees):
    """Right-handed about X (0), Y (1) or Z (2)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    rows = [[0.0] * 4 for _ in range(3)]
    u, v = (axis + 1) % 3, (axis + 2) % 3
    rows[axis][axis] = 1.0
    rows[u][u], rows[u][v], rows[v][u], rows[v][v] = c, -s, s, c
    return tuple(map(tuple, rows))


def placement_of(item):
    """Where the path of an operation stands in the part."""
    placement = getattr(item, "Placement", None)
    if placement is None:
        return IDENTITY
    numbers = placement.toMatrix().A
    return (tuple(numbers[0:4]), tuple(numbers[4:8]), tuple(numbers[8:12]))


def is_near(one, other):
    return all(abs(a - b) < NEAR for a, b in zip(one, other))


# ---------------------------------------------------------------- texts


def number(value):
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def numbers(values):
    return ",".join(map(number, values))


def clean(text):
    """A name that a CL file can hold: it has marks of its own."""
    return " ".join(re.sub(r"[^\w .+()#-]", " ", str(text)).split()) or "UNNAMED"


def plain(name):
    """`G01` as `G1`, `G59.10` never: FreeCAD writes both forms."""
    found = re.match(r"^([GM])0*(\d+(?:\.\d+)?)$", name.strip().upper())
    return found[1] + found[2] if found else name.strip()


# ---------------------------------------------------------------- the CL file


class Cycle:
    """A drilling cycle in force: its statement, and the level that it returns to (of the path's frame)."""

    def __init__(self, statement, level):
        self.statement = statement
        self.level = level


class Course:
    """The CL file of a job, command by command."""

    def __init__(self, asked, systems):
        self.asked = asked
        self.lines = []
        self.systems = systems
        self.frame = IDENTITY
        self.at = [None, None, None]  # in the frame of the operation, mm
        self.rotary = {}  # A, B and C, deg
        self.has_moved = False
        self.leans = False  # the tool axis of the CL file is not Z
        self.plane = 2
        self.feed = None  # as written, mm/min
        self.path_feed = 0.0  # as the path last said, mm/s
        self.speed = None  # of the spindle, rev/min
        self.tool = None  # the number of the one in the spindle
        self.returns_high = True  # G98
        self.cycle = None
        self.waiting = []  # rapids behind a hole, which a next hole may make needless
        self.place = ""

    def refuse(self, text):
        raise Refused(f"{self.place}: {text}")

    def refuse_word(self, letter, value):
        self.refuse(f"{letter}{number(value)} cannot be said in a CL file: take the word out of the job")

    def write(self, line):
        self.lines.append(line)

    # frames

    def frame_at(self, rotary):
        """The frame of the path's numbers in the part, the rotary axes where they are."""
        if not any(rotary.values()):
            return self.frame
        if self.asked.rotary is None:
            self.refuse(
                "the path has A, B or C, and neither FreeCAD nor this file knows how they count: --rotary part or --rotary iso"
            )
        # The part is turned by C, then B, then A (the rotation generator's order); back go the numbers.
        sign = -1.0 if self.asked.rotary == "part" else 1.0
        back = IDENTITY
        for letter in "CBA":
            back = product(back, rotation("ABC".index(letter), sign * rotary.get(letter, 0.0)))
        return product(back, self.frame)

    def goto(self, frame, point):
        self.has_moved = True
        axis = turned(frame, (0.0, 0.0, 1.0))
        tip = placed(frame, point)
        upright = is_near(axis, (0.0, 0.0, 1.0))
        # The axis of six numbers holds on: once it has leant it is said with every point.
        self.write(f"GOTO/{numbers(tip)}" + ("" if upright and not self.leans else f",{numbers_of_axis(axis)}"))
        self.leans = self.leans or not upright

    # operations

    def begin(self, item):
        """A new object of the job."""
        self.place = clean(getattr(item, "Label", "?"))
        stale = [state for state in getattr(item, "State", []) if state in ("Invalid", "Touched")]
        if stale:
            self.refuse(f"its path is not that of the operation as it stands ({stale[-1]}): recompute the document")
        frame = placement_of(item)
        base = getattr(item, "Base", None)
        # A dressing-up of an operation on a work plane that does not say the plane itself.
        if frame == IDENTITY and hasattr(base, "Path") and placement_of(base) != IDENTITY:
            self.refuse(
                "it dresses up an operation on a work plane and has no plane itself: where its path stands is not known"
            )
        self.end_cycle()
        if frame != self.frame:
            # A clearance height is one of its own plane; where the tool is safe while the axes turn only the machine knows.
            if self.has_moved and not is_near(turned(frame, (0.0, 0.0, 1.0)), turned(self.frame, (0.0, 0.0, 1.0))):
                self.write("GOHOME")
            self.frame, self.at = frame, [None, None, None]
        self.plane, self.returns_high = 2, True

    def operation(self, name, tool):
        """The head of an operation; the tool axis is Z again behind it."""
        self.write(f"TOOL PATH/{clean(name)},TOOL,{tool or 'UNNAMED'}")
        self.leans = False

    def end_cycle(self):
        if self.cycle is not None:
            self.write("CYCLE/OFF")
            self.cycle, self.feed = None, None
        waiting, self.waiting = self.waiting, []
        for target, rotary in waiting:
            self.rapid(target, rotary)

    def command(self, name, words):
        """One command of a path."""
        name = plain(name)
        if name.startswith("("):
            return
        if name == "G80":
            self.end_cycle()
        if name in self.asked.leave_out:
            return
        for letter, value in sorted(words.items()) if name in WORDS else ():
            # A line number says nothing of the cut, and nothing is changed by the speed that there is.
            if letter not in WORDS[name] + "N" and (letter != "S" or value != self.speed):
                self.refuse_word(letter, value)
        if name in SILENT:
            return
        if name == "G0":
            self.move_rapid(words)
            return
        if name in CYCLES:
            self.hole(name, words)
            return
        self.end_cycle()
        if name == "G1":
            self.cut(words)
        elif name in ("G2", "G3"):
            self.arc(name, words)
        else:
            self.switch(name, words)

    def switch(self, name, words):
        """What moves nothing."""
        if name in PLANES:
            self.plane = PLANES[name]
        elif name in ("G98", "G99"):
            self.returns_high = name == "G98"
        elif name in SYSTEMS:
            if self.systems != ["G54"]:
                self.write(f"SET/OFSETL,{SYSTEMS.index(name) + 1}")
        elif name == "G4":
            if "P" not in words:
                self.refuse("G4 without P, its seconds")
            self.write(f"DELAY/{number(words['P'])}")
        elif name in ("M0", "M1"):
            self.write("STOP" if name == "M0" else "OPSTOP")
        elif name in ("M3", "M4"):
            if not words.get("S"):
                self.refuse(f"{name} without a speed: give the tool controller one")
            self.speed = words["S"]
            self.write(f"SPINDL/RPM,{number(words['S'])},{'CLW' if name == 'M3' else 'CCLW'}")
        elif name == "M5":
            self.write("SPINDL/OFF")
        elif name in COOLANT:
            self.write(f"COOLNT/{COOLANT[name]}")
        elif name == "M6":
            if not float(words.get("T", math.nan)).is_integer():
                self.refuse("M6 without T, a tool's number")
            self.tool = words["T"]
            self.write(f"LOADTL/{int(self.tool)}")
            self.feed = None
        elif name == "G43":
            # `post` writes it with every tool, and takes the length of that tool.
            if words.get("H", self.tool) != self.tool:
                self.refuse(
                    f"H{number(words['H'])} is not the number of the tool in the spindle, whose length post takes: "
                    "--leave-out G43"
                )
        else:
            told = " ".join([name, *(f"{letter}{number(value)}" for letter, value in sorted(words.items()))])
            self.refuse(f"{told} cannot be said in a CL file: take it out of the job, or --leave-out {name}")

    # motions

    def target(self, words):
        """Where a command goes to, and where its rotary axes stand then."""
        at = [words.get(letter, before) for letter, before in zip(AXES, self.at)]
        rotary = {**self.rotary, **{letter: words[letter] for letter in "ABC" if letter in words}}
        other = [letter for letter in "UVW" if letter in words]
        if other:
            self.refuse(f"the path moves {other[0]}: only X, Y, Z, A, B and C are known")
        return at, rotary

    def move_rapid(self, words):
        at, rotary = self.target(words)
        if rotary != self.rotary and not any(letter in words for letter in AXES):
            # An index move: where the tool is safe meanwhile, the path does not say.
            self.end_cycle()
            if self.has_moved:
                self.write("GOHOME")
            self.rotary = rotary
            return
        if self.cycle is not None:
            self.waiting.append((at, rotary))
            self.at, self.rotary = at, rotary
            return
        self.rapid(at, rotary)

    def rapid(self, at, rotary):
        before = (self.at, self.rotary)
        self.at, self.rotary = at, rotary
        if None in at or (self.lines[-2:-1] == ["RAPID"] and before == (at, rotary)):
            return
        frame = self.frame_at(rotary)
        self.write("RAPID")
        self.goto(frame, at)

    def cut(self, words):
        at, rotary = self.target(words)
        if None in self.at or None in at:
            self.refuse("a cut before the path has said where in X, Y and Z it begins")
        self.set_feed(words)
        start, start_rotary = self.at, self.rotary
        for share in self.shares(start, at, start_rotary, rotary):
            between = [a + (b - a) * share for a, b in zip(start, at)]
            turn = {
                letter: start_rotary.get(letter, 0.0) * (1 - share) + rotary.get(letter, 0.0) * share
                for letter in rotary
            }
            self.goto(self.frame_at(turn), between)
        self.at, self.rotary = at, rotary

    def shares(self, start, end, before, after):
        """Where a cut is divided: rotary axes that turn lead the tip on a curve, and the CL file goes straight."""
        turn = max((abs(after.get(letter, 0.0) - before.get(letter, 0.0)) for letter in after), default=0.0)
        if turn == 0:
            return [1.0]
        radius = max(math.hypot(*start), math.hypot(*end), 1.0)
        step = min(STEP, math.degrees(2 * math.acos(max(0.0, 1 - CHORD / radius))))
        pieces = math.ceil(turn / step)
        return [each / pieces for each in range(1, pieces + 1)]

    def arc(self, name, words):
        at, rotary = self.target(words)
        if None in self.at or None in at:
            self.refuse("an arc before the path has said where in X, Y and Z it begins")
        if rotary != self.rotary:
            self.refuse(f"{name} turns a rotary axis besides")
        if words.get("P", 1) != 1:
            self.refuse_word("P", words["P"])
        offset = [words.get(letter, 0.0) for letter in "IJK"]
        # Along its axis an arc has no centre: FreeCAD names a height between its ends, half the way of a helix.
        low, high = sorted((0.0, at[self.plane] - self.at[self.plane]))
        if not low - NEAR <= offset[self.plane] <= high + NEAR:
            self.refuse_word("IJK"[self.plane], offset[self.plane])
        offset[self.plane] = 0.0
        radius = math.hypot(*offset)
        if radius < NEAR or "R" in words:
            self.refuse(f"{name} without a centre in I, J and K")
        self.set_feed(words)
        frame = self.frame_at(rotary)
        centre = [value + by for value, by in zip(self.at, offset)]
        axis = [0.0, 0.0, 0.0]
        axis[self.plane] = 1.0 if name == "G3" else -1.0  # an arc of the CL file goes right-handed about its axis
        self.write(f"CIRCLE/{numbers(placed(frame, centre))},{numbers_of_axis(turned(frame, axis))},{number(radius)}")
        self.goto(frame, at)
        self.at = at

    def set_feed(self, words):
        """F of a path is mm/s and modal; FEDRAT is mm/min. Where a path has none `post` says so."""
        if words.get("F", 1.0) <= 0:
            self.refuse(f"F{number(words['F'])} is no feed: give the tool controller one")
        self.path_feed = words.get("F", self.path_feed)
        feed = self.path_feed * 60
        if feed > 0 and feed != self.feed:
            self.write(f"FEDRAT/{number(feed)},MMPM")
            self.feed = feed

    # holes

    def hole(self, name, words):
        at, rotary = self.target({letter: value for letter, value in words.items() if letter not in "Z"})
        for letter in "ZR":
            if letter not in words:
                self.refuse(f"{name} without {letter}")
        if words.get("L", 1) != 1:
            self.refuse(f"{name} L{words['L']:g}: a hole that is not drilled once, but more than once or never")
        if self.plane != 2:
            self.refuse(f"{name} in another plane than G17")
        if None in at:
            self.refuse(f"{name} before the path has said where in X, Y and Z it begins")
        top = words["R"]
        level = self.cycle.level if self.cycle is not None and not self.waiting else self.at[2]
        level = max(level, top) if self.returns_high else top
        statement = self.statement(name, words, top, level)
        hole = [at[0], at[1], top]
        same = self.cycle is not None and self.cycle.statement == statement
        # Rapids at the level of return, which the cycle makes by itself.
        needless = all(abs(each[2] - level) < NEAR and turn == rotary for each, turn in self.waiting) and (
            not self.waiting or is_near(self.waiting[-1][0][:2], at[:2])
        )
        if same and needless:
            self.waiting = []
        else:
            self.end_cycle()
            self.write(statement)
            self.cycle = Cycle(statement, level)
        self.goto(self.frame_at(rotary), hole)
        self.at, self.rotary = [at[0], at[1], level], rotary

    def statement(self, name, words, top, level):
        """The CYCLE of a hole whose point is the level R: rapid there, at feed to Z."""
        depth = top - words["Z"]
        if depth <= 0:
            self.refuse(f"{name}: Z {number(words['Z'])} is not below R {number(top)}")
        parts = [f"CYCLE/{CYCLES[name]}", "RAPTO,0", f"FEDTO,{number(depth)}", f"RTRCTO,{number(level - top)}"]
        if name == "G84":
            if not words.get("F") or "S" not in words:
                self.refuse("G84 without S and F, its speed and its pitch")
            if self.speed is not None and words["S"] != self.speed:
                self.refuse(f"G84 S{number(words['S'])}, and the spindle turns at {number(self.speed)} rev/min")
            parts.append(f"MMPR,{number(words['F'])}")  # FreeCAD's F of a tap is its pitch
        else:
            self.path_feed = words.get("F", self.path_feed)
            parts.append(f"MMPM,{number(self.path_feed * 60)}")
        if name != "G84" and self.path_feed <= 0:
            self.refuse(f"{name} without a feed: the tool controller's vertical feed is 0")
        if name in ("G83", "G73"):
            if words.get("Q", 0.0) <= 0:
                self.refuse(f"{name} without Q, the depth of its pecks")
            parts.append(f"STEP,{number(words['Q'])}")
        if words.get("P"):
            parts.append(f"DWELL,{number(words['P'])}")
        return ",".join(parts)


def numbers_of_axis(axis):
    return ",".join(f"{value + 0.0:.9f}" for value in axis)


# ---------------------------------------------------------------- the objects of a job


def value_of(item, name):
    """A property as a number; lengths of FreeCAD carry their unit."""
    found = getattr(item, name, None)
    found = getattr(found, "Value", found)
    try:
        return float(found)
    except (TypeError, ValueError):
        return 0.0


def cutter(controller):
    """`CUTTER` of a tool controller: diameter, and corner radius of ball and bull nose."""
    tool = getattr(controller, "Tool", None)
    diameter = value_of(tool, "Diameter")
    if diameter <= 0:
        return []
    shape = str(getattr(tool, "ShapeName", getattr(tool, "ShapeType", ""))).lower()
    corner = diameter / 2 if "ball" in shape else value_of(tool, "CornerRadius") or value_of(tool, "FlatRadius")
    return [f"CUTTER/{number(diameter)}" + (f",{number(corner)}" if corner > 0 else "")]


def leaves(objects):
    """The objects with paths, groups taken apart, those that are switched off left out."""
    for item in objects:
        base = getattr(item, "Base", None)
        if getattr(item, "Active", True) is False or getattr(base, "Active", True) is False:
            continue
        if hasattr(item, "Group"):
            yield from leaves(item.Group)
        elif hasattr(item, "Path"):
            yield item


def coolant_of(item):
    """What the operation asks for, itself or through what it dresses up."""
    mode = getattr(item, "CoolantMode", None) or getattr(getattr(item, "Base", None), "CoolantMode", "None")
    return {"Flood": "FLOOD", "Mist": "MIST"}.get(str(mode))


def cl_text(objects, asked, name):
    """The CL file of the objects of a job."""
    items = list(leaves(objects))
    commands = [[(each.Name, each.Parameters) for each in item.Path.Commands] for item in items]
    systems = [plain(each) for path in commands for each, _ in path if plain(each) in SYSTEMS]
    course = Course(asked, sorted(set(systems)) or ["G54"])
    course.write(f"PARTNO/{clean(name)}")
    course.write("UNITS/MM")
    tool = ""
    for item, path in zip(items, commands):
        course.begin(item)
        is_controller = hasattr(item, "ToolNumber")
        is_operation = any(plain(each) in CYCLES or plain(each) in ("G1", "G2", "G3") for each, _ in path)
        if is_controller:
            tool = clean(getattr(getattr(item, "Tool", None), "Label", None) or item.Label)
            course.lines += cutter(item)
        if is_operation:
            course.operation(item.Label, tool)
        coolant = coolant_of(item) if is_operation else None
        if coolant:
            course.write(f"COOLNT/{coolant}")
        for at, (each, words) in enumerate(path, 1):
            course.place = f"{clean(getattr(item, 'Label', '?'))}, command {at}, {plain(each)}"
            course.command(each, words)
        course.end_cycle()
        if coolant:
            course.write("COOLNT/OFF")
        if is_operation:
            course.write("END-OF-PATH")
    course.write("FINI")
    return "\n".join(course.lines) + "\n"


# ---------------------------------------------------------------- what FreeCAD calls


def job_name(objects):
    """The document, for names of files and the head of the program, and its folder."""
    for item in objects:
        document = getattr(item, "Document", None)
        if document is None:
            continue
        folder = os.path.dirname(getattr(document, "FileName", "") or "")
        is_split = any(getattr(each, "SplitOutput", False) for each in getattr(document, "Objects", []))
        # Of a job in several programs FreeCAD 1.0 does not say which one this is.
        return (f"{document.Label}-{objects[-1].Label}" if is_split else document.Label), folder
    return "JOB", ""


def posted(asked, others, cl_file, program, report):
    """Runs `post`; the messages of a refusal are those of the exception."""
    command = [asked.command, "--machine", asked.machine, cl_file, "-o", program]
    command += [] if asked.no_verify else ["--verify"]
    command += ["--report", report] if report else []
    try:
        run = subprocess.run(command + others, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    except OSError as fault:
        raise Refused(f"{asked.command}: cannot be run ({fault.strerror}): --command names it") from None
    if run.returncode != 0:
        raise Refused(run.stderr or f"{asked.command} ended with {run.returncode}")
    print(run.stdout + run.stderr)


class Beside:
    """The CL file beside a program: that of a job which is refused goes, and the one of before comes back."""

    def __init__(self, path, text):
        self.path, self.text, self.before = path, text, None

    def __enter__(self):
        if os.path.exists(self.path):
            with open(self.path, "rb") as file:
                self.before = file.read()
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(self.text)

    def __exit__(self, kind, fault, trace):
        if kind is None:
            return
        if self.before is None:
            os.remove(self.path)
        else:
            with open(self.path, "wb") as file:
                file.write(self.before)


def told(text):
    """A refusal in a window of its own, where there are windows."""
    try:
        import FreeCAD

        if FreeCAD.GuiUp:
            from PySide import QtGui

            QtGui.QMessageBox.critical(None, "post", text)
    except ImportError:
        pass


def export(objectslist, filename, argstring):
    """Writes program, CL file and report, and returns the program: FreeCAD 1.0 asks for it by `-` and writes it itself."""
    try:
        return exported(objectslist, filename, argstring)
    except Refused as refused:
        told(str(refused))
        raise


def exported(objectslist, filename, argstring):
    asked, others = arguments().parse_known_args(shlex.split(argstring or ""))
    name, folder = job_name(objectslist)
    text = cl_text(objectslist, asked, name)
    if asked.cl_only:
        if filename != "-":
            with open(filename, "w", encoding="utf-8") as file:
                file.write(text)
        return text
    if not asked.machine:
        raise Refused("the job's arguments name no machine: --machine NAME, or --machine FILE.toml")
    with tempfile.TemporaryDirectory() as scratch:
        if filename != "-":
            base, program = os.path.splitext(filename)[0], filename
        else:
            base, program = os.path.join(folder or scratch, clean(name)), os.path.join(scratch, clean(name) + ".nc")
        if os.path.splitext(filename)[1] == ".cls":
            raise Refused(f"{filename}: the program would be written over its CL file: give it another ending")
        cl_file = base + ".cls"
        with Beside(cl_file, text):
            posted(asked, others, cl_file, program, None if asked.no_report else base + ".html")
        with open(program, encoding="utf-8", errors="surrogateescape", newline="") as file:
            return file.read()
