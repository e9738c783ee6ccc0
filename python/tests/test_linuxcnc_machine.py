"""LinuxCNC: the machine file from an INI file, and the law of each kinematics module.

The laws are held against LinuxCNC's own modules, which are called in this process; where they are not to be had the tests
are skipped and say so. Numbers are drawn anew each time: ``POST_SEED=N`` draws those of an earlier run again.
"""

import csv
import ctypes
import math
import os
import random
import re
import shutil
from pathlib import Path

import pytest

from conftest import CHECKOUT
from linuxcnc_parts import (
    CONFIGURATIONS,
    VISMACH,
    Module,
    configuration,
    from_ini,
    mill,
    post,
    seed,
    stub,
    written,
)

__all__ = ["seed", "stub"]  # fixtures


# Signals of the dual table that its HAL files give no value.
STANDS = [word for axis in "xyz" for word in ("--set", f"xyzab_tdr_kins.{axis}-rot-point=0")]
# The demonstration configurations that become a machine, what is said beside them, and the chain.
ACCEPTED = {
    "axis/axis_mm": ([], "[w b X Y Z (S) t]"),
    "qtvcp_screens/woodpecker/woodpecker_xyza": (["--table", "A=0,0,-40"], "[w A' b X Y Z (S) t]"),
    "axis/gantry/gantry_jjog": ([], "[w b X Y Z (S) t]"),
    f"{VISMACH}/max5/max5triv": (["--table", "C=0,0,0", "--head", "B=0,0,60"], "[w C' b X Y Z B (S) t]"),
    f"{VISMACH}/table-rotary-tilting/xyzac-trt": ([], "[w C' A' X' Y' b Z (S) t]"),
    f"{VISMACH}/table-rotary-tilting/xyzbc-trt": ([], "[w C' B' X' Y' b Z (S) t]"),
    f"{VISMACH}/table-dual-rotary/xyzab-tdr": (STANDS, "[w A' B' b X Y Z (S) t]"),
    f"{VISMACH}/bridgemill/5axis": ([], "[w b X Y Z C B (S) t]"),
    "axis/corexy/corexy_by_kins": ([], "[w b X Y Z (S) t]"),
}


# Those that do not, and what is told.
REFUSED = {
    "qtvcp_screens/woodpecker/woodpecker_xyza": "--table A=X,Y,Z",
    f"{VISMACH}/max5/max5kins": "maxkins: it cannot be switched off",
    "axis/vismach/scara/scara": "scarakins",
    "axis/vismach/puma/puma560": "genserkins",
    "axis/vismach/puma/puma": "pumakins",
    "axis/vismach/hexapod-sim/hexapod": "genhexkins",
    "axis/lathe": "has no Y",
    "gmoccapy/non_trivial_kinematics/table-rotary-tilting/xyzac-trt": "motion.switchkins-type",
}


@pytest.mark.parametrize("name", ACCEPTED)
def test_a_demonstration_becomes_a_machine(name: str, tmp_path: Path) -> None:
    said, chain = ACCEPTED[name]
    # Tables of tools that post itself refuses (a tool twice, columns below heads) are not what this is about.
    to = written(configuration(name), tmp_path / "machine.toml", *said, "--no-tools")
    assert f'chain = "{chain}"' in to.read_text()
    run = post("check", to)
    assert run.returncode == 0, run.stderr


@pytest.mark.parametrize("name", REFUSED)
def test_what_an_ini_file_cannot_say_is_refused_by_name(name: str, tmp_path: Path) -> None:
    run = from_ini(configuration(name), "-o", tmp_path / "machine.toml")
    assert run.returncode == 1
    assert REFUSED[name] in run.stderr and "nothing was written" in run.stderr
    assert not (tmp_path / "machine.toml").exists()


def test_units_gantries_includes_and_the_narrower_limit(tmp_path: Path) -> None:
    text = written(mill(tmp_path), tmp_path / "mill.toml").read_text()
    assert "name  = \"Small 'mill'\"" in text
    x = text.partition("[axis.X]")[2].partition("[axis.Y]")[0]
    assert "travel    = [-228.6, 254]" in x  # -9 in of the joint, 10 in of the axis
    assert "max_feed  = 3048" in x and "max_accel = 508" in x  # 2 in/s of the axis, 20 in/s² of the joint
    y = text.partition("[axis.Y]")[2].partition("[axis.Z]")[0]
    assert "travel    = [-101.6, 88.9]" in y  # 3.5 in of its second joint
    assert "# M6 goes to [EMCIO] TOOL_CHANGE_POSITION 0 0 0.4 by itself" in text
    assert 'units   = "inch"' in text and 'units  = "inch"' in text and "max_speed = 6000" in text


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("MIN_LIMIT = -5\n", ""), "[AXIS_Z] MAX_LIMIT = 0.5: Z has no travel"),
        (("LINEAR_UNITS = inch", ""), "[TRAJ]: LINEAR_UNITS is missing"),
        (("KINEMATICS = trivkins coordinates=XYYZ", ""), "[KINS]: KINEMATICS is missing"),
        (("COORDINATES = X Y Z", "COORDINATES = X Y Z W"), "[TRAJ] COORDINATES = X Y Z W: trivkins gives W no place"),
        (("COORDINATES = X Y Z", "COORDINATES = X Z"), "[TRAJ] COORDINATES = X Z: has no Y"),
        (("MAX_LIMIT = 0.5", "MAX_LIMIT = top"), "[AXIS_Z] MAX_LIMIT: 'top' is not a number"),
        (("trivkins coordinates=XYYZ", "mykins"), "[KINS] KINEMATICS = mykins: mykins is not known here"),
        (("MIN_LIMIT = -5\n", "MIN_LIMIT = 5\n"), "Z may go from 127 to 12.7: no travel"),
        (("#INCLUDE rest.inc", "#INCLUDE gone.inc"), "#INCLUDE gone.inc: "),
    ],
)
def test_a_fault_of_an_ini_file_is_told(change: tuple[str, str], told: str, tmp_path: Path) -> None:
    ini = mill(tmp_path)
    before = ini.read_text()
    assert change[0] in before
    ini.write_text(before.replace(*change))
    run = from_ini(ini)
    assert run.returncode == 1 and told in run.stderr
    assert re.search(rf"error: {re.escape(str(ini))}:\d+: ", run.stderr), run.stderr
    assert not (tmp_path / "mill.toml").exists()


def test_what_is_written_of_each_demonstration_is_accepted(tmp_path: Path) -> None:
    """Nineteen were written that `post check` refuses, all for their tool tables."""
    if not CONFIGURATIONS.is_dir():
        pytest.skip("LinuxCNC's demonstrations are not here (package linuxcnc-uspace)")
    tables = ["axis/gantry/gantry_mm", "axis/random_tc", "gmoccapy/gmoccapy", "qtvcp_screens/woodpecker/woodpecker"]
    for name in tables:
        ini, to = configuration(name), tmp_path / "machine.toml"
        run = from_ini(ini, "-o", to)
        assert run.returncode == 1 and not to.exists(), run.stderr
        assert re.search(rf"error: {re.escape(str(ini))}:\d+: \[EMCIO\] TOOL_TABLE = \S+: post check refuses", run.stderr)
        assert "--no-tools" in run.stderr and "is written" not in run.stderr
        assert from_ini(ini, "-o", "-").stdout == ""
        plain = written(ini, to, "--no-tools")
        assert post("check", plain).returncode == 0
        to.unlink()


def test_offsets_that_were_touched_off_count_from_the_tool_that_is_said(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    (tmp_path / "tool.tbl").write_text("T1 P1 Z-2 D0.394 ;END MILL\n")
    run = from_ini(ini)
    assert run.returncode == 1 and "--set tools.reference=MM" in run.stderr
    text = written(ini, tmp_path / "mill.toml", "--set", "tools.reference=150").read_text()
    assert "reference = 150" in text
    for said in (["--no-tools"], []):
        (tmp_path / "mill.toml").unlink(missing_ok=True)
        if not said:
            ini.write_text(ini.read_text().replace("TOOL_TABLE = tool.tbl", ""))
        run = from_ini(ini, "--set", "tools.reference=150", *said)
        assert run.returncode == 1 and "--set tools.reference=150: there is no tool table" in run.stderr
        assert not (tmp_path / "mill.toml").exists()


def test_a_pin_that_nothing_reads_is_refused(tmp_path: Path) -> None:
    """It was taken in silence, so that a slip of the name left the length as it was."""
    for pin in ("tool.reference=150", "xyzac-trt-kins.y-offset=12"):
        run = from_ini(mill(tmp_path), "--set", pin)
        assert run.returncode == 1 and f"--set {pin}: " in run.stderr, run.stderr
        assert re.search(r"mill\.ini:\d+: \[KINS\] KINEMATICS = trivkins coordinates=XYYZ takes no length", run.stderr)
        assert not (tmp_path / "mill.toml").exists()


def test_letters_may_be_said_together_or_one_by_one(tmp_path: Path) -> None:
    name = f"{VISMACH}/max5/max5triv"
    said = ACCEPTED[name][0]
    said = [*said, "--no-tools"]
    together = written(configuration(name), tmp_path / "one.toml", *said, "--reversed", "BC").read_text()
    apart = written(configuration(name), tmp_path / "two.toml", *said, "--reversed", "B", "--reversed", "C").read_text()
    assert together == apart and apart.count("reversed  = true") == 2


def test_an_axis_turns_the_part_or_the_tool(tmp_path: Path) -> None:
    """The machine file had two tables of one name."""
    run = from_ini(mill(tmp_path), "-o", tmp_path / "mill.toml", "--table", "A=0,0,1", "--head", "A=0,0,1")
    assert run.returncode == 1 and "name A more than once" in run.stderr
    assert not (tmp_path / "mill.toml").exists()


@pytest.mark.parametrize("value", ["0", "-5", "nan"])
@pytest.mark.parametrize("key", ["MAX_VELOCITY", "MAX_ACCELERATION"])
def test_a_speed_that_moves_nothing_is_refused_by_its_line(key: str, value: str, tmp_path: Path) -> None:
    ini = mill(tmp_path)
    text = re.sub(rf"(\[AXIS_X\][^\[]*?{key} *= *)\S+", rf"\g<1>{value}", ini.read_text(), count=1)
    if text == ini.read_text():
        text += f"\n[AXIS_X]\n{key} = {value}\n"
    ini.write_text(text)
    run = from_ini(ini, "-o", tmp_path / "mill.toml")
    assert run.returncode == 1 and re.search(rf"mill\.ini:\d+: \[AXIS_X\] {key}", run.stderr), run.stderr
    assert not (tmp_path / "mill.toml").exists()


def test_a_byte_order_mark_hides_no_section(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    plain = written(ini, tmp_path / "plain.toml").read_text()
    ini.write_bytes(b"\xef\xbb\xbf" + ini.read_bytes().lstrip())
    assert written(ini, tmp_path / "marked.toml").read_text() == plain


def test_a_hal_file_without_a_name_is_none(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    ini.write_text(ini.read_text() + "\n[HAL]\nHALFILE =\n")
    assert "[axis.X]" in written(ini, tmp_path / "mill.toml").read_text()


# A line of a configuration that is other, and what comes of it: a part of the machine file, or of what is told.
TRT = f"{VISMACH}/table-rotary-tilting/xyzac-trt"


BRIDGE = f"{VISMACH}/bridgemill/5axis"


PARAMETERS = [
    (TRT, "xyzac-trt.ini", "sets :y-offset     20", "sets :y-offset 12.5", [], "point     = [0, 12.5, 10]"),
    (TRT, "xyzac-trt.ini", "y-rot-point 0", "y-rot-point 3", [], "point     = [0, 23, 10]"),
    (TRT, "xyzac-trt.ini", "sparm=identityfirst", "", [], 'tcp_on  = "M429"'),
    (TRT, "remap_subs/428remap.ngc", "= 1 ", "= 2 ", [], "no REMAP of [RS274NGC] sets the kinematics to 1"),
    (
        TRT,
        "xyzac-trt.ini",
        "net  :tool-offset  motion.tooloffset.z",
        "sets :tool-offset 0",
        [],
        "does not hold the tool's length",
    ),
    (
        TRT,
        "xyzac-trt.ini",
        "setp xyzac-trt-kins.x-rot-point 0",
        "setp xyzac-trt-kins.new-pin 1",
        [],
        "new-pin, which is not known here",
    ),
    (
        TRT,
        "xyzac-trt.ini",
        "setp xyzac-trt-kins.x-rot-point 0",
        "setp xyzac-trt-kins.x-offset 1",
        [],
        "x-offset is set, and",
    ),
    (
        BRIDGE,
        "5axisgui.hal",
        "loadusr -W 5axisgui\n",
        "loadusr -W 5axisgui pivot_len=300\n",
        [],
        "point     = [0, 0, 300]",
    ),
    (BRIDGE, "5axisgui.hal", "5axisgui.pivot_len\n", "hm2.analog.0\n", [], "--set pivotsum.in0=VALUE"),
    (
        BRIDGE,
        "5axisgui.hal",
        "5axisgui.pivot_len\n",
        "hm2.analog.0\n",
        ["--set", "hm2.analog.0=280"],
        "point     = [0, 0, 280]",
    ),
    (BRIDGE, "5axisgui.hal", "5axisgui.pivot_len\n", "hm2.analog.0\n", ["--running"], "point     = [0, 0, 333]"),
    (BRIDGE, "5axis.ini", "HALFILE = 5axisgui.hal", "HALFILE = gone.hal", [], "gone.hal: cannot be read"),
]


@pytest.mark.parametrize(("name", "file", "before", "after", "said", "wanted"), PARAMETERS)
def test_lengths_and_switches_come_from_the_hal_files(
    name: str,
    file: str,
    before: str,
    after: str,
    said: list[str],
    wanted: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    source = configuration(name)
    shutil.copytree(source.parent, tmp_path / "machine")
    changed = tmp_path / "machine" / file
    text = changed.read_text()
    assert before in text
    changed.write_text(text.replace(before, after))
    # A machine that runs, and has such a pin.
    (tmp_path / "halcmd").write_text("#!/bin/sh\n[ \"$*\" = 'getp hm2.analog.0' ] && echo 333\n")
    (tmp_path / "halcmd").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    run = from_ini(tmp_path / "machine" / source.name, "-o", "-", *said)
    assert wanted in run.stdout + run.stderr
    assert (run.returncode == 0) == (wanted in run.stdout)


def read_back(machine: Path, folder: Path, letters: str, poses: list[list[float]]) -> list[dict[str, str]]:
    """Tips and tool axes of `post` at positions of the axes: the kinematics switched off, no tool."""
    off = ["M429"] if "tcp_off" in machine.read_text() else []
    words = [" ".join(f"{letter}{value:.6f}" for letter, value in zip(letters, pose, strict=True)) for pose in poses]
    program = folder / "poses.ngc"
    program.write_text("\n".join(["G21 G90 G17 G94", *off, *[f"G1 {line} F1000" for line in words], "M2", ""]))
    run = post("read", program, "-m", machine, "--csv", folder / "poses.csv", folder=folder)
    assert run.returncode == 0, run.stderr
    with (folder / "poses.csv").open() as rows:
        return list(csv.DictReader(rows))


# The three that the library has by hand.
LIBRARY = {
    "xyzac-trt": (f"{VISMACH}/table-rotary-tilting/xyzac-trt", "XYZAC"),
    "xyzbc-trt": (f"{VISMACH}/table-rotary-tilting/xyzbc-trt", "XYZBC"),
    "linuxcnc-5axis": (f"{VISMACH}/bridgemill/5axis", "XYZBC"),
}


@pytest.mark.parametrize("ours", LIBRARY)
def test_the_machine_is_that_of_the_library(ours: str, seed: int, tmp_path: Path) -> None:
    theirs, letters = LIBRARY[ours]
    machine = written(configuration(theirs), tmp_path / "machine.toml")
    by_hand = CHECKOUT / f"machines/{ours}.toml"
    draw = random.Random(seed)
    poses = [[draw.uniform(-49, 49) for _ in letters] for _ in range(20)]
    assert read_back(machine, tmp_path, letters, poses) == read_back(by_hand, tmp_path, letters, poses)

    def limits(text: str) -> list[str]:
        """Travel, speed, acceleration and sense of each axis, without remarks."""
        tables = (table.partition("]") for table in text.split("[axis.")[1:])
        keys = ("travel", "max_feed", "max_accel", "reversed")
        lines = (
            (letter, line.partition("#")[0].split())
            for letter, _, table in tables
            for line in table.split("\n[")[0].splitlines()
        )
        return sorted(f"{letter} {' '.join(words)}" for letter, words in lines if words and words[0] in keys)

    assert limits(machine.read_text()) == limits(by_hand.read_text())


# Each law: the configuration, the module with its coordinates, its pins, and which joint each letter is.
LAWS = {
    f"{VISMACH}/table-rotary-tilting/xyzac-trt": ("xyzac-trt-kins", "XYZAC", {"y-offset": 20, "z-offset": 10}),
    f"{VISMACH}/table-rotary-tilting/xyzbc-trt": ("xyzbc-trt-kins", "XYZBC", {"x-offset": -20, "z-offset": -15}),
    f"{VISMACH}/table-dual-rotary/xyzab-tdr": ("xyzab_tdr_kins", "XYZAB", {"x-offset": -20, "z-offset": -10}),
    f"{VISMACH}/bridgemill/5axis": ("5axiskins", "XYZBC", {"pivot-length": 250}),
    "axis/corexy/corexy_by_kins": ("corexykins", "XYZ", {}),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_law_is_that_of_the_module(name: str, stub: ctypes.CDLL, seed: int, tmp_path: Path) -> None:
    module_name, letters, pins = LAWS[name]
    machine = written(configuration(name), tmp_path / "machine.toml", *ACCEPTED[name][0], "--no-tools")
    fixed = module_name in ("corexykins", "xyzab_tdr_kins")
    coordinates = None if fixed else letters.lower() + ("w" if module_name == "5axiskins" else "")
    module = Module(stub, module_name, coordinates)
    draw = random.Random(seed)
    spans = {"X": 90, "Y": 90, "Z": 90, "A": 49, "B": 49, "C": 350}
    poses = [[round(draw.uniform(-spans[letter], spans[letter]), 6) for letter in letters] for _ in range(200)]
    rows = read_back(machine, tmp_path, letters, poses)
    assert len(rows) == len(poses)
    tool, tool_pin = 80.0, "tool-offset-z" if module_name == "xyzab_tdr_kins" else "tool-offset"
    for pose, row in zip(poses, rows, strict=True):
        # The words of a CoreXY are X and Y, its joints their sum and difference.
        joints = [pose[0] + pose[1], pose[0] - pose[1], pose[2]] if module_name == "corexykins" else pose
        for pin, value in pins.items():
            module.set(pin, value)
        tip = module.tip(joints)
        assert tip == pytest.approx([float(row[f"tip_{each}"]) for each in "xyz"], abs=2e-6)
        axis = [0.0, 0.0, 1.0]
        if module_name != "corexykins":
            # A longer tool: the tip goes back along the tool axis. The world has the tool's length in Z.
            if module_name == "5axiskins":
                module.set("pivot-length", pins["pivot-length"] + tool)
            else:
                module.set(tool_pin, tool)
            longer = module.tip(joints)
            longer[2] -= tool
            axis = [(short - long) / tool for short, long in zip(tip, longer, strict=True)]
            if module_name != "5axiskins":
                module.set(tool_pin, 0)
        assert axis == pytest.approx([float(row[f"axis_{each}"]) for each in "ijk"], abs=2e-6)
        assert math.isclose(math.hypot(*axis), 1, abs_tol=1e-9)


def test_why_maxkins_is_refused(stub: ctypes.CDLL) -> None:
    """Up to 2.9 the head's swing is not turned with the table: no machine with C in the table goes so."""
    module = Module(stub, "maxkins", None)
    module.set("pivot-length", 100)
    straight = module.tip([0, 0, 0, 0, 30, 0])
    turned = module.tip([0, 0, 0, 0, 30, 90])
    if math.hypot(straight[0] - turned[0], straight[1] - turned[1]) > 1:
        pytest.skip("this maxkins turns the swing with the table: only that it cannot be switched off is left")
    assert abs(straight[0]) == pytest.approx(50)


def test_words_of_rotatekins_are_those_of_the_part(stub: ctypes.CDLL) -> None:
    """Why C may be left out: where C stands, X and Y are those of the turned table."""
    module = Module(stub, "rotatekins", None)
    for turn in (0.0, 40.0):
        x, y, z = module.tip([10, 5, 3, 0, 0, turn])
        c, s = math.cos(math.radians(-turn)), math.sin(math.radians(-turn))
        assert [x, y, z] == pytest.approx([10 * c - 5 * s, 10 * s + 5 * c, 3])
