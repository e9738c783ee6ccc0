"""FreeCAD: its post-processor file, and the template of a job.

What the file makes of a path is tried with stand-ins of FreeCAD's objects; whole jobs are made by a script in FreeCAD
itself, without a screen (``freecadcmd``), and their programs read by ``post verify`` and by LinuxCNC's interpreter. Where
one of the two is not to be had its tests are skipped and say so.
"""

import importlib.util
import json
import math
import os
import random
import re
import shutil
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from conftest import CHECKOUT, COMMAND

HERE = CHECKOUT / "editors/freecad"
MACHINES = CHECKOUT / "machines"
REAL = CHECKOUT.parent / "shared/linuxcnc"

Commands = Sequence[tuple[str, dict[str, float]]]


@pytest.fixture(scope="module")
def processor() -> ModuleType:
    """The file as FreeCAD loads it, without FreeCAD."""
    described = importlib.util.spec_from_file_location("post_cl_post", HERE / "post_cl_post.py")
    assert described is not None and described.loader is not None
    module = importlib.util.module_from_spec(described)
    described.loader.exec_module(module)
    return module


def item(label: str, commands: Commands, rows: Sequence[float] | None = None, **more: object) -> SimpleNamespace:
    """An object of a job with a path; `rows` are the 16 numbers of its placement."""
    path = SimpleNamespace(Commands=[SimpleNamespace(Name=name, Parameters=words) for name, words in commands])
    if rows is not None:
        more["Placement"] = SimpleNamespace(toMatrix=lambda: SimpleNamespace(A=tuple(rows)))
    return SimpleNamespace(Label=label, Path=path, **more)


def controller(number: int = 1, diameter: float = 6.0, shape: str = "endmill") -> SimpleNamespace:
    tool = SimpleNamespace(Label="Mill", Diameter=SimpleNamespace(Value=diameter), ShapeName=shape)
    commands: Commands = [("M6", {"T": float(number)}), ("M3", {"S": 3000.0})]
    return item("TC", commands, ToolNumber=number, Tool=tool)


def course(processor: ModuleType, *objects: SimpleNamespace, arguments: str = "") -> list[str]:
    text: str = processor.export(list(objects), "-", f"--cl-only {arguments}")
    return text.splitlines()


START: Commands = [("G0", {"Z": 10.0}), ("G0", {"X": 1.0, "Y": 2.0}), ("G1", {"Z": -1.0, "F": 2.0})]
# The plane of a face that looks to X: its X is Y of the part, its Y is Z, its Z is X; its origin is at (30, 0, 5).
SIDE = (0, 0, 1, 30, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 0, 1)


def test_a_path_becomes_points_feeds_and_arcs(processor: ModuleType) -> None:
    arcs: Commands = [
        ("G2", {"X": 3.0, "Y": 2.0, "I": 1.0, "J": 0.0, "K": 0.0, "F": 5.0}),
        ("G3", {"X": 1.0, "Y": 2.0, "Z": -2.0, "I": -1.0, "J": 0.0}),
    ]
    lines = course(processor, controller(2), item("Pocket: 1/2", [*START, *arcs], CoolantMode="Mist"))
    assert lines == [
        "PARTNO/JOB",
        "UNITS/MM",
        "CUTTER/6",
        "LOADTL/2",
        "SPINDL/RPM,3000,CLW",
        "TOOL PATH/Pocket 1 2,TOOL,Mill",
        "COOLNT/MIST",
        "RAPID",
        "GOTO/1,2,10",
        "FEDRAT/120,MMPM",
        "GOTO/1,2,-1",
        "FEDRAT/300,MMPM",
        "CIRCLE/2,2,-1,0.000000000,0.000000000,-1.000000000,1",
        "GOTO/3,2,-1",
        "CIRCLE/2,2,-1,0.000000000,0.000000000,1.000000000,1",
        "GOTO/1,2,-2",
        "COOLNT/OFF",
        "END-OF-PATH",
        "FINI",
    ]


def test_the_first_way_of_two_commands_goes_over_its_place(processor: ModuleType) -> None:
    """FreeCAD says the height first; until all three are known the path has said no place."""
    lines = course(processor, item("Face", START))
    assert lines.count("RAPID") == 1 and "GOTO/1,2,10" in lines


def test_a_work_plane_turns_points_axes_and_arcs(processor: ModuleType) -> None:
    arc: Commands = [("G3", {"X": 1.0, "Y": 4.0, "I": 0.0, "J": 1.0})]
    lines = course(processor, controller(), item("Side", [*START, *arc], SIDE), item("Top", START))
    tilted = "1.000000000,0.000000000,0.000000000"
    assert f"GOTO/40,1,7,{tilted}" in lines
    assert f"GOTO/29,1,7,{tilted}" in lines
    assert f"CIRCLE/29,1,8,{tilted},1" in lines and f"GOTO/29,1,9,{tilted}" in lines
    # Of the next operation, on the table again, nothing is taken over from the plane, and the tool is retracted before.
    assert (
        lines[lines.index("TOOL PATH/Top,TOOL,Mill") :][1:3] == ["RAPID", "GOTO/1,2,10"] and lines.count("GOHOME") == 1
    )


def test_arcs_of_the_other_planes(processor: ModuleType) -> None:
    """G18: from Z to X is the sense of G3, as in G-code; about Y it is right-handed."""
    for plane, words, axis in (
        ("G18", {"I": 0.0, "K": 1.0}, "0.000000000,1.000000000,0.000000000"),
        ("G19", {"J": 1.0}, "1.000000000,0.000000000,0.000000000"),
    ):
        lines = course(processor, item("Arc", [*START, (plane, {}), ("G3", {"X": 1.0, "Y": 2.0, "Z": -1.0, **words})]))
        assert any(line.startswith("CIRCLE/") and axis in line for line in lines)


def hole(x: float, name: str = "G81", **words: float) -> tuple[str, dict[str, float]]:
    return name, {"X": x, "Y": 0.0, "Z": -8.0, "R": 2.0, "F": 2.5, **words}


def over(x: float) -> Commands:
    """What FreeCAD writes before each hole."""
    return [("G0", {"X": x, "Y": 0.0}), ("G0", {"Z": 5.0})]


def test_holes_become_one_cycle(processor: ModuleType) -> None:
    path: Commands = [
        ("G0", {"Z": 9.0}),
        ("G98", {}),
        *over(1),
        hole(1),
        *over(2),
        hole(2),
        ("G80", {}),
        ("G0", {"Z": 9.0}),
    ]
    lines = course(processor, item("Drill", path))
    at = lines.index("CYCLE/DRILL,RAPTO,0,FEDTO,10,RTRCTO,3,MMPM,150")
    assert lines[at + 1 :] == ["GOTO/1,0,2", "GOTO/2,0,2", "CYCLE/OFF", "RAPID", "GOTO/2,0,9", "END-OF-PATH", "FINI"]


def test_a_rapid_between_holes_that_is_more_than_the_cycles_own_stays(processor: ModuleType) -> None:
    path: Commands = [("G0", {"Z": 9.0}), ("G99", {}), *over(1), hole(1), *over(2), hole(2), ("G80", {})]
    lines = course(processor, item("Drill", path))
    assert lines.count("CYCLE/OFF") == 2 and lines.count("GOTO/2,0,5") == 1
    assert lines.count("CYCLE/DRILL,RAPTO,0,FEDTO,10,RTRCTO,0,MMPM,150") == 2


@pytest.mark.parametrize(
    ("name", "words", "said"),
    [
        ("G82", {"P": 0.5}, "CYCLE/DRILL,RAPTO,0,FEDTO,10,RTRCTO,3,MMPM,150,DWELL,0.5"),
        ("G83", {"Q": 3.0}, "CYCLE/DEEP,RAPTO,0,FEDTO,10,RTRCTO,3,MMPM,150,STEP,3"),
        ("G73", {"Q": 3.0}, "CYCLE/BRKCHP,RAPTO,0,FEDTO,10,RTRCTO,3,MMPM,150,STEP,3"),
        ("G84", {"S": 500.0, "F": 1.25}, "CYCLE/TAP,RAPTO,0,FEDTO,10,RTRCTO,3,MMPR,1.25"),
    ],
)
def test_each_cycle(name: str, words: dict[str, float], said: str, processor: ModuleType) -> None:
    assert said in course(processor, item("Drill", [("G0", {"Z": 9.0}), *over(1), hole(1, name, **words)]))


@pytest.mark.parametrize(
    ("commands", "told"),
    [
        ([("G1", {"X": 1.0})], "Op, command 1, G1: a cut before the path has said where"),
        ([*START, ("G2", {"X": 3.0})], "G2 without a centre"),
        ([*START, ("G41", {"D": 1.0})], "G41 D1 cannot be said in a CL file"),
        ([*START, ("G91", {})], "G91 cannot be said"),
        ([*START, ("G1", {"X": 3.0, "A": 90.0})], "--rotary part or --rotary iso"),
        ([*START, ("G1", {"U": 3.0})], "the path moves U"),
        ([*START, hole(1, "G83")], "without Q"),
        ([*START, hole(1, L=2.0)], "more than once"),
        ([*START, ("G81", {"X": 1.0, "Y": 0.0, "Z": 3.0, "R": 2.0, "F": 1.0})], "is not below R"),
        ([*START, hole(1, F=0.0)], "vertical feed is 0"),
        ([("M3", {})], "without a speed"),
        ([("M3", {"S": 900.0}), *START, hole(1, "G84", S=500.0, F=1.0)], "and the spindle turns at 900 rev/min"),
        ([*START, ("G1", {"X": 4.0, "S": 900.0})], "Op, command 4, G1: S900 cannot be said"),
        *(([*START, ("G1", {"X": 4.0, word: 5.0})], f"command 4, G1: {word}5 cannot be said") for word in "EDQHIJKPRT"),
        ([*START, ("G1", {"X": 4.0, "F": 0.0})], "F0 is no feed"),
        ([*START, ("G3", {"X": 1.0, "Z": -4.0, "I": 5.0, "P": 2.0})], "command 4, G3: P2 cannot be said"),
        ([*START, ("G2", {"X": 3.0, "I": 1.0, "K": -3.0})], "command 4, G2: K-3 cannot be said"),
        ([*START, ("G2", {"X": 3.0, "Z": -3.0, "I": 1.0, "K": -2.5})], "command 4, G2: K-2.5 cannot be said"),
        ([*START, ("G18", {}), ("G2", {"X": 3.0, "I": 1.0, "J": 1.0})], "command 5, G2: J1 cannot be said"),
        ([*START, ("G19", {}), hole(1)], "command 5, G81: G81 in another plane than G17"),
        ([*START, hole(1, Q=3.0)], "command 4, G81: Q3 cannot be said"),
        ([*START, hole(1, L=0.0)], "or never"),
        ([("M6", {"T": 1.0}), ("G43", {"H": 3.0})], "command 2, G43: H3 is not the number of the tool"),
        ([("M6", {"T": 1.0}), ("G43", {"Z": 3.0})], "command 2, G43: Z3 cannot be said"),
        ([("M6", {"T": 1.5})], "command 1, M6: M6 without T"),
        ([("M6", {})], "command 1, M6: M6 without T"),
        ([("G4", {"X": 2.0})], "command 1, G4: X2 cannot be said"),
        ([("G4", {})], "command 1, G4: G4 without P"),
        *(([(name, {"X": 2.0})], f"command 1, {name}: X2 cannot be said") for name in ("G90", "G40", "G54", "M5", "M30")),
    ],
)
def test_what_cannot_be_said_is_refused_by_its_place(commands: Commands, told: str, processor: ModuleType) -> None:
    with pytest.raises(processor.Refused, match=re.escape(told)):
        course(processor, item("Op", commands))


def test_words_that_change_nothing_are_taken(processor: ModuleType) -> None:
    """FreeCAD's own: a helix's K is half its way (``PathGeom.cmdsForEdge``), and a rapid has a feed."""
    helix = ("G2", {"X": 3.0, "Y": 2.0, "Z": -4.0, "I": 1.0, "J": 0.0, "K": -1.5, "P": 1.0})
    said: Commands = [("G43", {"H": 2.0}), *START, helix, ("G0", {"Z": 9.0, "F": 0.0}), ("G1", {"Z": 5.0, "S": 3000.0})]
    bare: Commands = [*START, (helix[0], {**helix[1], "K": 0.0}), ("G0", {"Z": 9.0}), ("G1", {"Z": 5.0, "N": 9.0})]
    assert course(processor, controller(2), item("Op", said)) == course(processor, controller(2), item("Op", bare))
    other: Commands = [("G43", {"H": 3.0}), *START]
    assert course(processor, item("Op", other), arguments="--leave-out G43") == course(processor, item("Op", START))


def test_a_dressing_up_of_a_work_plane_without_the_plane_is_refused(processor: ModuleType) -> None:
    base = item("Op", START, SIDE)
    with pytest.raises(processor.Refused, match="dresses up an operation on a work plane"):
        course(processor, item("Dressup", START, Base=base))


@pytest.mark.parametrize("state", ["Touched", "Invalid"])
def test_a_path_that_is_not_that_of_its_operation_is_refused(state: str, processor: ModuleType) -> None:
    with pytest.raises(processor.Refused, match=f"Op: .*{state}.*recompute"):
        course(processor, item("Op", START, State=[state]))


def test_words_of_rotary_axes(processor: ModuleType) -> None:
    """A quarter turn of A: what was up looks to Y, by FreeCAD's own count; ISO 841 has it the other way."""
    path: Commands = [("G0", {"A": 90.0}), ("G0", {"X": 0.0, "Y": 0.0, "Z": 10.0}), ("G1", {"Z": 4.0, "F": 1.0})]
    assert "GOTO/0,4,0,0.000000000,1.000000000,0.000000000" in course(
        processor, item("Op", path), arguments="--rotary part"
    )
    assert "GOTO/0,-4,0,0.000000000,-1.000000000,0.000000000" in course(
        processor, item("Op", path), arguments="--rotary iso"
    )
    # Between two indexed cuts the tool is retracted: the path does not say where it is safe.
    index: Commands = [*path, ("G0", {"A": 0.0}), ("G0", {"Z": 10.0}), ("G1", {"Z": 4.0})]
    lines = course(processor, item("Op", index), arguments="--rotary part")
    at = lines.index("GOHOME")
    assert lines[at + 1 : at + 3] == ["RAPID", "GOTO/0,0,10,0.000000000,0.000000000,1.000000000"]
    # A cut in which A turns is taken apart: the tip goes round.
    round_cut: Commands = [("G0", {"X": 0.0, "Y": 0.0, "Z": 10.0}), ("G1", {"A": 90.0, "F": 1.0})]
    lines = [
        line for line in course(processor, item("Op", round_cut), arguments="--rotary part") if line.startswith("GOTO")
    ]
    assert len(lines) > 45 and lines[-1] == "GOTO/0,10,0,0.000000000,1.000000000,0.000000000"


def test_switched_off_operations_and_unknown_systems(processor: ModuleType) -> None:
    lines = course(processor, item("Off", START, Active=False), item("On", START))
    assert not any("Off" in line for line in lines)
    fixtures = [item("G54", [("G54", {}), ("G0", {"Z": 30.0})]), item("G55", [("G55", {}), ("G0", {"Z": 30.0})])]
    assert [line for line in course(processor, *fixtures) if "OFSETL" in line] == ["SET/OFSETL,1", "SET/OFSETL,2"]
    assert not [line for line in course(processor, fixtures[0]) if "OFSETL" in line]


def test_program_cl_file_and_report_stand_beside_one_another(processor: ModuleType, tmp_path: Path) -> None:
    program = tmp_path / "part.ngc"
    arguments = f"--machine {MACHINES / 'vmc.toml'} --command {COMMAND} --dialect linuxcnc --tool-length 100"
    text = processor.export([controller(), item("Face", START)], str(program), arguments)
    assert text == program.read_text() and "G1 Z-1.0000 F120." in text
    assert sorted(path.name for path in tmp_path.iterdir()) == ["part.cls", "part.html", "part.ngc"]
    # FreeCAD 1.0 and newer write the program themselves.
    again = processor.export([controller(), item("Face", START)], "-", arguments)
    assert again == text.replace("(PART)", "(JOB)")


def test_a_tap_goes_by_its_pitch(processor: ModuleType, tmp_path: Path) -> None:
    """1.25 mm a turn: FreeCAD's F of a tap is no feed."""
    tap: Commands = [
        ("G0", {"Z": 9.0}),
        *over(1),
        ("G84", {"X": 1.0, "Y": 0.0, "Z": -8.0, "R": 2.0, "S": 3000.0, "F": 1.25}),
    ]
    arguments = f"--machine {MACHINES / 'vmc.toml'} --command {COMMAND} --tool-length 100 --mount 0,0,0"
    text = processor.export([controller(), item("Tap", [*tap, ("G80", {})])], str(tmp_path / "tap.nc"), arguments)
    assert re.search(r"G84 .*F3750", text), text
    arguments += " --dialect linuxcnc"
    text = processor.export([controller(), item("Tap", [*tap, ("G80", {})])], str(tmp_path / "tap.ngc"), arguments)
    assert re.search(r"G33\.1 .*K1\.25", text), text


def test_a_refused_job_leaves_the_files_of_the_one_before(processor: ModuleType, tmp_path: Path) -> None:
    """Program, CL file and report belong together: a new CL file beside an old program would be another part's."""
    far: Commands = [("G0", {"X": 5000.0, "Y": 0.0, "Z": 10.0}), ("G1", {"Z": -1.0, "F": 2.0})]
    arguments = f"--machine {MACHINES / 'vmc.toml'} --command {COMMAND} --tool-length 100 --mount 0,0,0"

    def files() -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    with pytest.raises(processor.Refused, match="over-travel"):
        processor.export([controller(), item("Far", far)], str(tmp_path / "part.nc"), arguments)
    assert files() == {}
    processor.export([controller(), item("Face", START)], str(tmp_path / "part.nc"), arguments)
    before = files()
    assert sorted(before) == ["part.cls", "part.html", "part.nc"]
    with pytest.raises(processor.Refused, match="over-travel"):
        processor.export([controller(), item("Far", far)], str(tmp_path / "part.nc"), arguments)
    assert files() == before


def test_a_refusal_of_post_is_the_refusal_of_the_job(processor: ModuleType, tmp_path: Path) -> None:
    far: Commands = [("G0", {"X": 5000.0, "Y": 0.0, "Z": 10.0}), ("G1", {"Z": -1.0, "F": 2.0})]
    arguments = f"--machine {MACHINES / 'vmc.toml'} --command {COMMAND} --tool-length 100 --mount 0,0,0"
    with pytest.raises(processor.Refused, match="over-travel"):
        processor.export([controller(), item("Face", far)], str(tmp_path / "part.nc"), arguments)
    assert not (tmp_path / "part.nc").exists()
    for wrong, told in (
        ("", "--machine NAME"),
        ("--machine vmc --command /no/post", "--command names it"),
        ("--rotary left", "--rotary"),
    ):
        with pytest.raises(processor.Refused, match=re.escape(told)):
            processor.export([controller(), item("Face", START)], str(tmp_path / "part.nc"), wrong)


# ---------------------------------------------------------------- FreeCAD itself


def made(room: Path, kind: str, arguments: str) -> dict[str, object]:
    """A job that FreeCAD makes and posts; the file lies in its macro folder, as a user lays it."""
    freecad = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if freecad is None:
        pytest.skip("FreeCAD is not here (package freecad-python3)")
    macros = room / "home/.local/share/FreeCAD/Macro"
    macros.mkdir(parents=True)
    shutil.copy(HERE / "post_cl_post.py", macros)
    asked = {
        "kind": kind,
        "template": str(HERE / "job_post.json"),
        "arguments": f"--command {COMMAND} {arguments}",
        "output": str(room / "part.ngc"),
        "told": str(room / "told.json"),
    }
    environment = {
        **os.environ,
        "HOME": str(room / "home"),
        "POST_JOB": json.dumps(asked),
        "QT_QPA_PLATFORM": "offscreen",
    }
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME"):
        environment.pop(name, None)
    job = Path(__file__).with_name("freecad_job.py")
    run = subprocess.run([freecad, job], env=environment, capture_output=True, text=True, timeout=300)
    if not (room / "told.json").is_file() and "No module named 'PathScripts" in run.stdout + run.stderr:
        pytest.skip("this FreeCAD keeps its CAM elsewhere: the script of this test is for 0.20")
    assert (room / "told.json").is_file(), run.stdout[-3000:] + run.stderr[-3000:]
    told: dict[str, object] = json.loads((room / "told.json").read_text())
    return told


def cut_points(cl_file: Path) -> list[list[float]]:
    """The ends of the cuts of a CL file."""
    points, rapid, cycle = [], False, False
    for line in cl_file.read_text().splitlines():
        word, _, rest = line.partition("/")
        if word == "CYCLE":
            cycle = rest != "OFF"
        elif word == "GOTO":
            if not rapid and not cycle:
                points.append([float(each) for each in rest.split(",")[:3]])
            rapid = False
        rapid = rapid or word == "RAPID"
    return points


def close(one: Sequence[Sequence[float]], other: Sequence[Sequence[float]], within: float) -> bool:
    return len(one) == len(other) and all(
        abs(a - b) <= within
        for first, second in zip(one, other, strict=True)
        for a, b in zip(first, second, strict=True)
    )


def interpreted(program: Path) -> list[list[float]]:
    """Where the cuts of a program end, by LinuxCNC's interpreter."""
    if not (REAL / "interpret").is_file():
        pytest.skip(f"{REAL / 'interpret'} is not here: LinuxCNC's interpreter is not asked")
    run = subprocess.run([REAL / "interpret", program, "--tool", "1=100", "--metric"], capture_output=True, text=True)
    if run.returncode == 3:
        pytest.skip(f"LinuxCNC's interpreter is not to be had: {run.stderr.strip()}")
    assert run.returncode == 0, run.stderr
    ends = []
    at = [0.0, 0.0, 0.0]
    for line in run.stdout.splitlines():
        found = re.search(r"(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED)\(([^)]*)\)", line)
        if not found:
            continue
        numbers = [float(each) for each in found[2].split(",")]
        at = [numbers[0], numbers[1], numbers[5]] if found[1] == "ARC_FEED" else numbers[:3]
        if found[1] != "STRAIGHT_TRAVERSE":
            ends.append(at)
    return ends


class Drawn:
    """A path of random commands as FreeCAD writes it: cuts, arcs and helices in three planes, holes."""

    def __init__(self, seed: int) -> None:
        self.draw = random.Random(seed)
        self.at = [0.0, 0.0, 20.0]
        self.path: list[tuple[str, dict[str, float]]] = [("G0", {"Z": 20.0}), ("G0", {"X": 0.0, "Y": 0.0})]

    def number(self, least: float, most: float) -> float:
        return round(self.draw.uniform(least, most), 3)

    def feed(self) -> dict[str, float]:
        return {"F": self.draw.randint(1, 20) / 2} if self.draw.random() < 0.3 else {}

    def cut(self) -> None:
        letters = self.draw.sample("XYZ", self.draw.randint(1, 3))
        words = {letter: self.number(-40, 40) if letter != "Z" else self.number(1, 19) for letter in letters}
        self.path.append(("G1", {**words, **self.feed()}))
        self.at = [words.get(letter, before) for letter, before in zip("XYZ", self.at, strict=True)]

    def arc(self) -> None:
        normal = self.draw.randrange(3)
        u, v = (normal + 1) % 3, (normal + 2) % 3  # right-handed about the normal
        self.path.append((("G19", "G18", "G17")[normal], {}))
        radius = self.number(1, 8)
        start = self.draw.uniform(0, 2 * math.pi)
        turn = self.draw.uniform(0.2, 6) * self.draw.choice((1, -1))
        centre = list(self.at)
        centre[u] -= radius * math.cos(start)
        centre[v] -= radius * math.sin(start)
        end = list(self.at)
        end[u] = round(centre[u] + radius * math.cos(start + turn), 6)
        end[v] = round(centre[v] + radius * math.sin(start + turn), 6)
        if self.draw.random() < 0.3:
            # Gentle: a steep one may become moves.
            end[normal] = round(end[normal] + self.number(-0.1, 0.1) * radius * abs(turn), 3)
        offset = {"IJK"[each]: round(centre[each] - self.at[each], 6) for each in (u, v)}
        words = dict(zip("XYZ", end, strict=True))
        self.path.append(("G3" if turn > 0 else "G2", {**words, **offset, **self.feed()}))
        self.at = end

    def holes(self) -> None:
        name = self.draw.choice(("G81", "G82", "G83", "G73", "G85"))
        top, depth = self.number(3, 8), self.number(1, 12)
        words = {"Z": round(top - depth, 3), "R": top, "F": self.draw.randint(1, 10) / 2}
        words.update({"G82": {"P": 0.5}, "G83": {"Q": 2.5}, "G73": {"Q": 2.5}}.get(name, {}))
        self.path += [("G0", {"Z": 20.0}), ("G17", {}), (self.draw.choice(("G98", "G99")), {})]
        start = self.number(top, 19)
        for _ in range(self.draw.randint(1, 4)):
            x, y = self.number(-40, 40), self.number(-40, 40)
            self.path += [("G0", {"X": x, "Y": y}), ("G0", {"Z": start}), (name, {"X": x, "Y": y, **words})]
        self.path += [("G80", {}), ("G0", {"Z": 20.0})]
        self.at = [x, y, 20.0]

    def commands(self, count: int) -> Commands:
        for _ in range(count):
            self.draw.choice((self.cut, self.cut, self.arc, self.arc, self.holes))()
        return self.path


def canonical(program: Path) -> list[tuple[str, list[float]]]:
    """The cuts that LinuxCNC's interpreter makes of a program: plane, feed, ends, centres and sense."""
    if not (REAL / "interpret").is_file():
        pytest.skip(f"{REAL / 'interpret'} is not here: LinuxCNC's interpreter is not asked")
    run = subprocess.run([REAL / "interpret", program, "--tool", "1=0", "--metric"], capture_output=True, text=True)
    if run.returncode == 3:
        pytest.skip(f"LinuxCNC's interpreter is not to be had: {run.stderr.strip()}")
    assert run.returncode == 0, run.stderr
    cuts, plane, feed = [], "", 0.0
    at: list[float] = []
    for word, inside in re.findall(r"(\w+)\(([^)]*)\)", run.stdout):
        if word == "SELECT_PLANE":
            plane = inside
        elif word == "SET_FEED_RATE":
            feed = float(inside)
        elif word in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED"):
            numbers = [float(each) for each in inside.split(",")]
            # A way of no length is none.
            if word == "STRAIGHT_FEED" and numbers != at:
                cuts.append((word, [feed, *numbers]))
            elif word == "ARC_FEED":
                cuts.append((word + plane, [feed, *numbers]))
            at = numbers
        elif word == "DWELL":
            cuts.append((word, [float(inside)]))
    return cuts


@pytest.mark.parametrize("round_", range(4))
def test_the_program_does_what_the_path_says_read_as_g_code(processor: ModuleType, round_: int, tmp_path: Path) -> None:
    """FreeCAD's commands are G-code with feeds a second: LinuxCNC's interpreter reads both, path and program."""
    seed = int(os.environ.get("POST_SEED", time.time_ns() % 2**31)) + round_
    print(f"again with POST_SEED={seed}")
    path = Drawn(seed).commands(40)
    lines = ["G21 G90 G17 G40 G49 G94 G91.1"]
    for name, words in path:
        scaled = {letter: value * 60 if letter == "F" else value for letter, value in words.items()}
        lines.append(" ".join([name, *(f"{letter}{value:.6f}" for letter, value in scaled.items())]))
    # A path has its feed from the start: FreeCAD gives one to every cut.
    first = next(at for at, (name, _) in enumerate(path, 1) if name in ("G1", "G2", "G3") or name in processor.CYCLES)
    lines.insert(first, "F120")
    given = [(name, {"F": 2.0, **words}) if at == first else (name, words) for at, (name, words) in enumerate(path, 1)]
    (tmp_path / "path.ngc").write_text("\n".join([*lines, "M2", ""]))
    arguments = f"--machine {MACHINES / 'vmc.toml'} --command {COMMAND} --dialect linuxcnc --tool-length 100 --mount 0,0,0 --no-report --no-verify"
    processor.export([controller(), item("Path", given)], str(tmp_path / "part.ngc"), arguments)
    wanted, found = canonical(tmp_path / "path.ngc"), canonical(tmp_path / "part.ngc")
    assert [word for word, _ in found] == [word for word, _ in wanted]
    for (word, ours), (_, theirs) in zip(found, wanted, strict=True):
        assert ours == pytest.approx(theirs, abs=2e-4), word


def test_a_plate_of_freecad_is_the_plate_that_linuxcnc_reads(tmp_path: Path) -> None:
    """Every cut of FreeCAD's path ends where LinuxCNC's interpreter ends it; the template names the post-processor."""
    machine = MACHINES / "vmc.toml"
    told = made(tmp_path, "plate", f"--machine {machine} --dialect linuxcnc --tool-length 100 --mount 0,0,0")
    assert told["post"] == "post_cl" and not told["failed"]
    program = tmp_path / "part.ngc"
    assert program.read_text() == told["program"] and (tmp_path / "part.html").is_file()
    points = told["points"]
    assert isinstance(points, list) and len(points) > 40 and close(cut_points(tmp_path / "part.cls"), points, 1e-6)
    text = program.read_text()
    assert text.count("G81") == 1 and text.count("G2 ") + text.count("G3 ") >= 20
    verify = [
        COMMAND,
        "verify",
        program,
        "-m",
        machine,
        "--against",
        tmp_path / "part.cls",
        "--tool-length",
        "100",
        "--mount",
        "0,0,0",
        "--dialect",
        "linuxcnc",
    ]
    run = subprocess.run(verify, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    # The interpreter tells the moves of the holes too: to their bottoms.
    ends = interpreted(program)
    assert close([end for end in ends if end[2] != 0], points, 1e-4)
    assert [end[:2] for end in ends if end[2] == 0] == [[15, 20], [30, 10], [45, 20]]


def test_an_indexed_job_of_freecad_on_a_table_of_linuxcnc(tmp_path: Path) -> None:
    """What FreeCAD declares and refuses: every coordinate about the machine's own lines."""
    machine = MACHINES / "xyzac-trt.toml"
    told = made(tmp_path, "indexed", f"--machine {machine} --tool-length 60")
    points = told["points"]
    assert isinstance(points, list) and close(cut_points(tmp_path / "part.cls"), points, 2e-6)
    run = subprocess.run(
        [
            COMMAND,
            "verify",
            tmp_path / "part.ngc",
            "-m",
            machine,
            "--against",
            tmp_path / "part.cls",
            "--tool-length",
            "60",
        ],
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr
    text = (tmp_path / "part.ngc").read_text()
    assert re.search(r"G0 A-?35\.0000", text), text
    interpreted(tmp_path / "part.ngc")


def test_an_indexed_job_of_freecad_in_planes_of_the_control(tmp_path: Path) -> None:
    machine = MACHINES / "dmu50.toml"
    made(tmp_path, "indexed", f"--machine {machine} --tool-length 60")
    text = (tmp_path / "part.ngc").read_text()
    assert "PLANE SPATIAL" in text and "CYCL DEF" in text
