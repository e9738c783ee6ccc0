"""LinuxCNC: the filter of its screens, and limits under TCP.

Programs are held against its interpreter and against the real LinuxCNC, without a screen, in ``../shared/linuxcnc``; where
it is not to be had the tests are skipped and say so.
"""

import csv
import math
import re
from pathlib import Path

import pytest

from conftest import CHECKOUT
from linuxcnc_parts import filtered, mill, post, real, trunnion, written

__all__ = ["trunnion"]  # a fixture


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
