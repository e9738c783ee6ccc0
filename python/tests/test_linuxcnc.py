"""LinuxCNC: the machine file from an INI file, the filter of its screens, and the law of each kinematics module.

The laws are held against LinuxCNC's own modules, which are called in this process, and programs against its interpreter
and against the real LinuxCNC, without a screen, in ``../shared/linuxcnc``; where one is not to be had its tests are skipped
and say so. Numbers are drawn anew each time: ``POST_SEED=N`` draws those of an earlier run again.
"""

import csv
import ctypes
import math
import os
import random
import re
import shutil
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import pytest
from conftest import CHECKOUT, COMMAND

HERE = CHECKOUT / "editors/linuxcnc"
CONFIGURATIONS = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")
MODULES = Path("/usr/lib/linuxcnc/modules")
REAL = CHECKOUT.parent / "shared/linuxcnc"
VISMACH = "axis/vismach/5axis"

# The demonstration configurations that become a machine, what is said beside them, and the chain.
ACCEPTED = {
    "axis/axis_mm": ([], "[w b X Y Z (S) t]"),
    "qtvcp_screens/woodpecker/woodpecker_xyza": (["--table", "A=0,0,-40"], "[w A' b X Y Z (S) t]"),
    "axis/gantry/gantry_jjog": ([], "[w b X Y Z (S) t]"),
    f"{VISMACH}/max5/max5triv": (["--table", "C=0,0,0", "--head", "B=0,0,60"], "[w C' b X Y Z B (S) t]"),
    f"{VISMACH}/table-rotary-tilting/xyzac-trt": ([], "[w C' A' X' Y' b Z (S) t]"),
    f"{VISMACH}/table-rotary-tilting/xyzbc-trt": ([], "[w C' B' X' Y' b Z (S) t]"),
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

MILL = """
    [EMC]
    MACHINE = Small "mill"
    [TRAJ]
    COORDINATES = X Y Z
    LINEAR_UNITS = inch
    [KINS]
    KINEMATICS = trivkins coordinates=XYYZ
    JOINTS = 4
    [EMCIO]
    TOOL_TABLE = tool.tbl
    [RS274NGC]
    PARAMETER_FILE = mill.var
    [SPINDLE_0]
    MAX_FORWARD_VELOCITY = 6000
    [AXIS_X]
    MIN_LIMIT = -10
    MAX_LIMIT = 10
    MAX_VELOCITY = 2
    [JOINT_0]
    MIN_LIMIT = -9
    MAX_VELOCITY = 3
    MAX_ACCELERATION = 20
    #INCLUDE rest.inc
    [AXIS_Z]
    MIN_LIMIT = -5
    MAX_LIMIT = 0.5
    MAX_VELOCITY = 1
    [POST]
    MACHINE = mill.toml
    MOUNT = G55
    """
REST = """
    [AXIS_Y]
    MIN_LIMIT = -4
    MAX_LIMIT = 4
    MAX_VELOCITY = 2
    [JOINT_2]
    MAX_LIMIT = 3.5
    """


@pytest.fixture
def seed() -> int:
    seed = int(os.environ.get("POST_SEED", time.time_ns() % 2**31))
    print(f"again with POST_SEED={seed}")
    return seed


def configuration(name: str) -> Path:
    path = CONFIGURATIONS / f"{name}.ini"
    if not path.is_file():
        pytest.skip(f"LinuxCNC's demonstration {name} is not here (package linuxcnc-uspace)")
    return path


def from_ini(*arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, HERE / "post-from-ini", "--post", COMMAND, *arguments]
    return subprocess.run(command, capture_output=True, text=True)


def written(ini: Path, to: Path, *said: str) -> Path:
    """The machine file of an INI file."""
    run = from_ini(ini, "-o", to, *said)
    assert to.is_file(), run.stderr
    return to


def post(*arguments: str | Path, folder: Path | None = None) -> "subprocess.CompletedProcess[str]":
    return subprocess.run([COMMAND, *arguments], capture_output=True, text=True, cwd=folder)


def mill(room: Path) -> Path:
    """A mill in inches whose Y has two joints, its table of tools and its offsets."""
    (room / "mill.ini").write_text(textwrap.dedent(MILL))
    (room / "rest.inc").write_text(textwrap.dedent(REST))
    (room / "tool.tbl").write_text("T1 P1 Z2 D0.394 ;END MILL\n")
    (room / "mill.var").write_text("5210 0\n5211 0\n5220 1\n5241 1.5\n5242 -0.5\n5243 -4\n5250 0\n")
    return room / "mill.ini"


def filtered(ini: Path, cl_file: Path) -> "subprocess.CompletedProcess[str]":
    """What a screen gets that opens a file, called as AXIS calls a filter."""
    commands = ini.parent / "commands"
    commands.mkdir(exist_ok=True)
    for name, target in (("post", COMMAND), ("post-filter", HERE / "post-filter")):
        if not (commands / name).exists():
            (commands / name).symlink_to(target)
    environment = {**os.environ, "INI_FILE_NAME": str(ini), "PATH": f"{commands}:{os.environ['PATH']}"}
    call = ["sh", "-c", f"post-filter '{cl_file}'"]
    return subprocess.run(call, capture_output=True, text=True, env=environment, cwd=ini.parent)


@pytest.mark.parametrize("name", ACCEPTED)
def test_a_demonstration_becomes_a_machine(name: str, tmp_path: Path) -> None:
    said, chain = ACCEPTED[name]
    to = written(configuration(name), tmp_path / "machine.toml", *said)
    text = to.read_text()
    assert f'chain = "{chain}"' in text
    # Tables of tools that post itself refuses (a tool twice, columns below heads) are not what this is about.
    to.write_text(
        "".join(
            line for line in text.splitlines(True) if not line.startswith(("[tools]", "file ", "format", "units  "))
        )
    )
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
    assert 'units   = "inch"' in text and 'units  = "inch"' in text and "max_speed = 6000" in text


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (("MIN_LIMIT = -5\n", ""), "Z has no travel"),
        (("LINEAR_UNITS = inch", ""), "LINEAR_UNITS is missing"),
        (("COORDINATES = X Y Z", "COORDINATES = X Y Z W"), "--leave-out W"),
        (("MAX_LIMIT = 0.5", "MAX_LIMIT = top"), "'top' is not a number"),
        (("trivkins coordinates=XYYZ", "mykins"), "mykins is not known here"),
        (("MIN_LIMIT = -5\n", "MIN_LIMIT = 5\n"), "no travel"),
    ],
)
def test_a_fault_of_an_ini_file_is_told(change: tuple[str, str], told: str, tmp_path: Path) -> None:
    ini = mill(tmp_path)
    before = ini.read_text()
    assert change[0] in before
    ini.write_text(before.replace(*change))
    run = from_ini(ini)
    assert run.returncode == 1 and told in run.stderr
    assert not (tmp_path / "mill.toml").exists()


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


CUT = """\
UNITS/INCHES
CUTTER/0.394
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/1,0.5,1
FEDRAT/20,IPM
GOTO/1,0.5,-0.1
GOTO/{},0.5,-0.1
RAPID
GOTO/{},0.5,1
END
FINI
"""


def test_a_screen_that_opens_a_cl_file_gets_its_program(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    part = tmp_path / "it's a part.cls"
    part.write_text(CUT.format(2, 2))
    run = filtered(ini, Path(str(part).replace("'", "'\\''")))
    assert run.returncode == 0, run.stderr
    own = post(part, "-m", "mill.toml", "--mount", "38.1,-12.7,-101.6", "--verify", "-q", "-o", "-", folder=tmp_path)
    assert own.returncode == 0 and run.stdout == own.stdout and "G20" in run.stdout
    assert run.stderr.splitlines()[-1] == "FILTER_PROGRESS=100"


def test_a_screen_shows_why_a_cl_file_is_refused(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    part = tmp_path / "part.cls"
    part.write_text(CUT.format(9, 9))  # 9 in and 1.5 in of G55 pass 10 in
    run = filtered(ini, part)
    assert run.returncode == 1 and run.stdout == ""
    assert "X would be 266.700 mm, its limit is 254.000 mm" in run.stderr and "part.cls:9:1" in run.stderr
    # The place is that of the offset: at G55 X0 it fits.
    variables = tmp_path / "mill.var"
    variables.write_text(variables.read_text().replace("5241 1.5", "5241 0"))
    assert filtered(ini, part).returncode == 0


STAT = """\
print("tool mmap not available")
class stat:
    g5x_index, g5x_offset, g92_offset, rotation_xy = 2, (0.0, 0.0, -4.0), (0.0,) * 9, 0.0
    def poll(self):
        pass
"""


def test_the_machine_that_runs_knows_its_offset_better_than_its_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its module talks on standard output, and none of that gets into the program."""
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    part = tmp_path / "part.cls"
    part.write_text(CUT.format(9, 9))  # inside at G55 X0, outside at the X1.5 of the file
    assert filtered(ini, part).returncode == 1
    (tmp_path / "linuxcnc.py").write_text(STAT)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")  # the stand-in changes within a second
    run = filtered(ini, part)
    assert run.returncode == 0 and "mmap" not in run.stdout and run.stdout.startswith("(PART)")
    (tmp_path / "linuxcnc.py").write_text(STAT.replace("(0.0,) * 9, 0.0", "(1.0,) * 9, 0.0"))
    assert "G92.1 takes it off" in filtered(ini, part).stderr


def test_warnings_of_a_good_program_stand_in_its_head(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    (tmp_path / "tool.tbl").write_text("T1 P1 Z2 D0.25 ;END MILL (SHORT)\n")
    part = tmp_path / "part.cls"
    part.write_text(CUT.format(2, 2))
    for more in ("", "ARGUMENTS = --set control.linuxcnc.percent=true\n"):
        if more:
            ini.write_text(ini.read_text() + more)
        run = filtered(ini, part)
        assert run.returncode == 0, run.stderr
        lines = run.stdout.splitlines()
        if more:
            assert lines.pop(0) == "%"
        assert lines[0].startswith("(post: warning[tool-differs]: tool 1 is")
        told = [line for line in lines if line.startswith("(post:")]
        assert all(line.endswith(")") and line.count("(") == 1 == line.count(")") for line in told)


@pytest.mark.parametrize(
    ("file", "change", "told"),
    [
        ("mill.ini", ("MACHINE = mill.toml", "MACHINE = other.toml"), "post-from-ini"),
        ("mill.ini", ("MOUNT = G55", "MOUNT = G53"), "one of G54"),
        ("mill.ini", ("MOUNT = G55", "MOUNT = G55\nCOMMAND = /no/such/post"), "[POST] COMMAND"),
        ("mill.ini", ("MOUNT = G55", "MOUNT = G55\nARGUMENTS = 'open"), "No closing quotation"),
        ("mill.var", ("5250 0", "5250 30"), "it is turned (R)"),
        ("mill.var", ("5210 0\n5211 0", "5210 1\n5211 2"), "G92.1 takes it off"),
    ],
)
def test_a_filter_that_is_not_set_up_says_what_helps(
    file: str, change: tuple[str, str], told: str, tmp_path: Path
) -> None:
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    path = tmp_path / file
    assert change[0] in path.read_text()
    path.write_text(path.read_text().replace(*change))
    part = tmp_path / "part.cls"
    part.write_text(CUT.format(2, 2))
    run = filtered(ini, part)
    assert run.returncode == 1 and run.stdout == "" and told in run.stderr


class Module:
    """A kinematics module of LinuxCNC, called in this process."""

    def __init__(self, stub: ctypes.CDLL, name: str, coordinates: str | None) -> None:
        self.stub = stub
        self.name = name
        self.library = ctypes.CDLL(str(MODULES / f"{name}.so"), mode=os.RTLD_NOW)
        if coordinates is not None:
            place = ctypes.c_void_p.in_dll(self.library, "rtapi_info_address_coordinates").value
            self.coordinates = ctypes.create_string_buffer(coordinates.encode())
            assert place is not None
            ctypes.c_void_p.from_address(place).value = ctypes.addressof(self.coordinates)
        assert self.library.rtapi_app_main() == 0

    def set(self, pin: str, value: float) -> None:
        self.stub.stub_pin.restype = ctypes.POINTER(ctypes.c_double)
        found = self.stub.stub_pin(f"{self.name}.{pin}".encode())
        assert found, f"{self.name} has no pin {pin}"
        found[0] = value

    def tip(self, joints: list[float]) -> list[float]:
        """X, Y and Z of the world."""
        given = (ctypes.c_double * 16)(*joints)
        pose = (ctypes.c_double * 9)()
        flags = (ctypes.c_ulong * 2)()
        of = ctypes.byref
        assert self.library.kinematicsForward(given, pose, of(flags), of(flags, ctypes.sizeof(ctypes.c_ulong))) == 0
        return list(pose)[:3]


@pytest.fixture(scope="module")
def stub(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    if not MODULES.is_dir():
        pytest.skip("LinuxCNC's modules are not here (package linuxcnc-uspace)")
    if not shutil.which("cc"):
        pytest.skip("no C compiler: LinuxCNC's modules cannot be called")
    library = tmp_path_factory.mktemp("stub") / "hal.so"
    source = CHECKOUT / "python/tests/hal_stub.c"
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, source], check=True)
    return ctypes.CDLL(str(library), mode=os.RTLD_GLOBAL | os.RTLD_NOW)


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
    f"{VISMACH}/bridgemill/5axis": ("5axiskins", "XYZBC", {"pivot-length": 250}),
    "axis/corexy/corexy_by_kins": ("corexykins", "XYZ", {}),
}


@pytest.mark.parametrize("name", LAWS)
def test_the_law_is_that_of_the_module(name: str, stub: ctypes.CDLL, seed: int, tmp_path: Path) -> None:
    module_name, letters, pins = LAWS[name]
    machine = written(configuration(name), tmp_path / "machine.toml")
    coordinates = None if module_name == "corexykins" else letters.lower() + ("w" if module_name == "5axiskins" else "")
    module = Module(stub, module_name, coordinates)
    draw = random.Random(seed)
    spans = {"X": 90, "Y": 90, "Z": 90, "A": 49, "B": 49, "C": 350}
    poses = [[round(draw.uniform(-spans[letter], spans[letter]), 6) for letter in letters] for _ in range(200)]
    rows = read_back(machine, tmp_path, letters, poses)
    assert len(rows) == len(poses)
    tool = 80.0
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
                module.set("tool-offset", tool)
            longer = module.tip(joints)
            longer[2] -= tool
            axis = [(short - long) / tool for short, long in zip(tip, longer, strict=True)]
            if module_name != "5axiskins":
                module.set("tool-offset", 0)
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


def real(program: str, *arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    """LinuxCNC itself, without a screen (`run`), or its interpreter alone (`interpret`)."""
    if not (REAL / program).is_file():
        pytest.skip(f"{REAL / program} is not here: the real LinuxCNC is not asked")
    run = subprocess.run([REAL / program, *arguments], capture_output=True, text=True)
    if run.returncode == 3:
        pytest.skip(f"the real LinuxCNC is not to be had: {run.stderr.strip()}")
    return run


@pytest.fixture
def trunnion(tmp_path: Path) -> Path:
    """The demonstration xyzac-trt with its machine file and a tool of 30 mm."""
    source = configuration(f"{VISMACH}/table-rotary-tilting/xyzac-trt")
    shutil.copytree(source.parent, tmp_path / "trt")
    ini = tmp_path / "trt/xyzac-trt.ini"
    (ini.parent / "xyzac-trt.tbl").write_text("T1 P1 Z30 D8 ;BALL\n")
    written(ini, ini.with_suffix(".toml"))
    return ini


def test_the_interpreter_reads_what_the_filter_hands_it(trunnion: Path) -> None:
    run = filtered(trunnion, CHECKOUT / "tests/machines/xyzac-trt.cls")
    assert run.returncode == 0, run.stderr
    program = trunnion.parent / "part.ngc"
    program.write_text(run.stdout)
    read = real("interpret", program, "--tool", "1=30", "--metric")
    assert read.returncode == 0, read.stderr
    assert read.stdout.count("STRAIGHT_FEED") >= 18


# The tip at Y 120, the table tilted by 60°: Y of the machine stands at 70 mm.
HIGH_CL = """\
UNITS/MM
CUTTER/8
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/0,102.680,20,0,-0.866025404,0.5
FEDRAT/400,MMPM
GOTO/0,120,10,0,-0.866025404,0.5
GOTO/5,120,10,0,-0.866025404,0.5
END
FINI
"""


def test_words_that_pass_the_limits_of_the_axes_under_tcp(trunnion: Path) -> None:
    """Joints that are inside are not all: LinuxCNC holds the tip to the axes' limits as it reads the block."""
    part = trunnion.parent / "high.cls"
    part.write_text(HIGH_CL)
    posted = filtered(trunnion, part)
    assert posted.returncode == 0, posted.stderr
    with trunnion.open("a") as ini:
        ini.write("\n[POST]\nMOUNT = G54\n")
    (trunnion.parent / "xyzac.var").write_text("5221 0\n5222 0\n5223 0\n")
    run = filtered(trunnion, part)
    assert run.returncode == 1 and run.stdout == ""
    assert "Y would be at 102.68 mm" in run.stderr and "[AXIS_Y] MAX_LIMIT is 100 mm" in run.stderr
    # The joints have limits of their own.
    ini = trunnion.read_text()
    trunnion.write_text(re.sub(r"(\[AXIS_Y\][^\[]*MAX_LIMIT =) +100", r"\1 150", ini))
    assert filtered(trunnion, part).returncode == 0

    program = trunnion.parent / "high.ngc"
    program.write_text(posted.stdout)
    ran = real("run", program, "--machine", "xyzac-trt", "--tool", "1=30", "-o", trunnion.parent / "joints.csv")
    assert ran.returncode == 1 and "exceed Y's positive limit" in ran.stderr


SHORT_CL = """\
UNITS/MM
CUTTER/8
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/20,0,30,0.5,0,0.866025404
FEDRAT/1000,MMPM
GOTO/15,0,5,0.5,0,0.866025404
GOTO/10.6066,10.6066,5,0.49245,0.49245,0.71761
GOTO/0,15,5,0,0.766044,0.642788
END
FINI
"""


def test_a_program_of_the_filter_runs_in_the_real_linuxcnc(trunnion: Path) -> None:
    """To its end, every joint inside the limits of the INI file, the tip over the points of the CL file."""
    part = trunnion.parent / "short.cls"
    part.write_text(SHORT_CL)
    run = filtered(trunnion, part)
    assert run.returncode == 0, run.stderr
    program = trunnion.parent / "short.ngc"
    program.write_text(run.stdout)
    log = trunnion.parent / "joints.csv"
    ran = real("run", program, "--machine", "xyzac-trt", "--tool", "1=30", "--start", "Z=100", "-o", log)
    assert ran.returncode == 0, ran.stderr
    limits = {"X": 200, "Y": 100, "Z": 120, "A": 100, "C": 36000}
    nearest = [math.inf] * 3
    wanted = [(15, 0, 5), (10.6066, 10.6066, 5), (0, 15, 5)]
    with log.open() as rows:
        for row in csv.DictReader(rows):
            joint = {letter: float(row[letter]) for letter in limits}
            assert all(abs(joint[letter]) <= limits[letter] for letter in limits)
            tip = tip_of(joint, float(row["tool_z"]))
            nearest = [min(least, math.dist(tip, point)) for least, point in zip(nearest, wanted, strict=True)]
    assert max(nearest) < 0.05, nearest


def tip_of(joint: dict[str, float], tool: float) -> list[float]:
    """The law of xyzac-trt-kins as LinuxCNC's own tests were read: the A axis 20 mm and 10 mm off the C axis."""
    a, c = math.radians(-joint["A"]), math.radians(-joint["C"])
    x, y, z = joint["X"], joint["Y"] - 20, joint["Z"] - tool - 10
    y, z = y * math.cos(a) - z * math.sin(a) + 20, y * math.sin(a) + z * math.cos(a) + 10
    return [x * math.cos(c) - y * math.sin(c), x * math.sin(c) + y * math.cos(c), z]


SLOW = """\
#!/usr/bin/env python3
import sys, time
name = next(each for each in sys.argv if each.endswith(".cls"))
with open(name, "rb", buffering=0) as file:
    file.read(500)
    time.sleep(0.5)
print("M2")
"""


def test_the_bar_shows_how_much_has_been_read(tmp_path: Path) -> None:
    ini = mill(tmp_path)
    written(ini, tmp_path / "mill.toml")
    (tmp_path / "slow").write_text(SLOW)
    (tmp_path / "slow").chmod(0o755)
    ini.write_text(ini.read_text() + f"COMMAND = {tmp_path / 'slow'}\n")
    part = tmp_path / "part.cls"
    part.write_text("x" * 1000)
    run = filtered(ini, part)
    assert run.returncode == 0 and run.stdout == "M2\n"
    assert run.stderr.splitlines() == ["FILTER_PROGRESS=49", "FILTER_PROGRESS=100"]


# From one end to the other A turns by 80°, the tip stays where it is, and Y of the machine swings out to 110 mm between
# them, where 100 mm are its travel; both ends are inside, at 89 mm.
SWING = """\
G21 G17 G40 G49 G90 G94
T1 M6
G0 A-85
G43 H1
M428
G1 X0 Y83.640 Z73.640 F1000
G1 A-5
M429
M2
"""
# The same as a CL file.
SWING_CL = """\
UNITS/MM
CUTTER/8
LOADTL/1
SPINDL/RPM,3000,CLW
MULTAX/ON
RAPID
GOTO/0,83.640,83.640,0,{first}
FEDRAT/100,MMPM
GOTO/0,83.640,73.640,0,{first}
GOTO/0,83.640,73.640,0,{last}
END
FINI
"""


def test_a_joint_that_swings_out_between_two_ends(trunnion: Path) -> None:
    """LinuxCNC stops in the cut (its issue 97); `post` refuses the CL file, and tells it of the program."""
    machine = trunnion.with_suffix(".toml")
    axes = {
        key: f"{-math.sin(math.radians(a)):.9f},{math.cos(math.radians(a)):.9f}"
        for key, a in (("first", 85), ("last", 5))
    }
    part = trunnion.parent / "swing.cls"
    part.write_text(SWING_CL.format(**axes))
    run = filtered(trunnion, part)
    assert run.returncode == 1 and "swing.cls:10:1" in run.stderr

    program = trunnion.parent / "swing.ngc"
    program.write_text(SWING)
    read = post("read", program, "-m", machine, folder=trunnion.parent)
    assert read.returncode == 1 and "Y would be at 110.00" in read.stderr and "swing.ngc:7" in read.stderr
    ran = real("run", program, "--machine", "xyzac-trt", "--tool", "1=30", "-o", trunnion.parent / "joints.csv")
    assert ran.returncode == 1 and "soft limit (100.00000) on joint 1 (moving in line 7)" in ran.stderr
