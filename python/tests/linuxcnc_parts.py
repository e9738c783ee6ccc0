"""What the tests of LinuxCNC share: its configurations, a small mill, and how its programs are called."""

import ctypes
import functools
import os
import shutil
import subprocess
import sys
import tempfile
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
    TOOL_CHANGE_POSITION = 0 0 0.4
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


def real(program: str, *arguments: str | Path) -> "subprocess.CompletedProcess[str]":
    """LinuxCNC itself, without a screen (`run`), or its interpreter alone (`interpret`)."""
    if not (REAL / program).is_file():
        pytest.skip(f"{REAL / program} is not here: the real LinuxCNC is not asked")
    run = subprocess.run([REAL / program, *arguments], capture_output=True, text=True)
    if run.returncode == 3:
        pytest.skip(f"the real LinuxCNC is not to be had: {run.stderr.strip()}")
    return run


class Module:
    """A kinematics module of LinuxCNC, called in this process."""

    def __init__(self, stub: ctypes.CDLL, name: str, coordinates: str | None = None, folder: Path = MODULES) -> None:
        self.stub = stub
        self.name = name
        self.none, self.branch = ctypes.c_ulong(), ctypes.c_ulong()  # flags: none, and which of several solutions
        self.library = ctypes.CDLL(str(folder / f"{name}.so"), mode=os.RTLD_NOW)
        if coordinates is not None:
            place = ctypes.c_void_p.in_dll(self.library, "rtapi_info_address_coordinates").value
            self.coordinates = ctypes.create_string_buffer(coordinates.encode())
            assert place is not None
            ctypes.c_void_p.from_address(place).value = ctypes.addressof(self.coordinates)
        assert self.library.rtapi_app_main() == 0
        if name == "xyzab_tdr_kins":  # it makes its pins as it is asked for its type, and begins without TCP
            self.library.kinematicsType()
            assert self.library.kinematicsSwitch(1) == 0

    def pin(self, name: str) -> "ctypes._Pointer[ctypes.c_double]":
        """The place of a pin's value."""
        self.stub.stub_pin.restype = ctypes.POINTER(ctypes.c_double)
        found: ctypes._Pointer[ctypes.c_double] = self.stub.stub_pin(f"{self.name}.{name}".encode())
        assert found, f"{self.name} has no pin {name}"
        return found

    def set(self, pin: str, value: float) -> None:
        self.pin(pin)[0] = value

    def tip(self, joints: list[float]) -> list[float]:
        """X, Y and Z of the world."""
        return self.forward(joints)[:3]

    def forward(self, joints: list[float], near: list[float] | None = None) -> list[float]:
        """X, Y, Z, A, B and C of the world; `near` is where a module begins that goes there by steps."""
        given = (ctypes.c_double * 16)(*joints)
        pose = (ctypes.c_double * 9)(*(near or []))
        assert self.library.kinematicsForward(given, pose, ctypes.byref(self.none), ctypes.byref(self.branch)) == 0
        return list(pose)[:6]

    def inverse(self, pose: list[float], count: int) -> list[float]:
        """The joints, `count` of them, on the branch of the `forward` before."""
        given = (ctypes.c_double * 9)(*pose)
        joints = (ctypes.c_double * 16)()
        assert self.library.kinematicsInverse(given, joints, ctypes.byref(self.branch), ctypes.byref(self.none)) == 0
        self.none.value = 0
        return list(joints)[:count]


@functools.cache
def hal() -> ctypes.CDLL:
    """The stand-in for HAL, once in a process: all modules are bound to the first that is there."""
    with tempfile.TemporaryDirectory() as room:
        library = Path(room) / "hal.so"
        source = CHECKOUT / "python/tests/hal_stub.c"
        subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, source], check=True)
        return ctypes.CDLL(str(library), mode=os.RTLD_GLOBAL | os.RTLD_NOW)


@pytest.fixture
def stub() -> ctypes.CDLL:
    if not MODULES.is_dir():
        pytest.skip("LinuxCNC's modules are not here (package linuxcnc-uspace)")
    if not shutil.which("cc"):
        pytest.skip("no C compiler: LinuxCNC's modules cannot be called")
    return hal()


@pytest.fixture
def trunnion(tmp_path: Path) -> Path:
    """The demonstration xyzac-trt with its machine file and a tool of 30 mm."""
    source = configuration(f"{VISMACH}/table-rotary-tilting/xyzac-trt")
    shutil.copytree(source.parent, tmp_path / "trt")
    ini = tmp_path / "trt/xyzac-trt.ini"
    (ini.parent / "xyzac-trt.tbl").write_text("T1 P1 Z30 D8 ;BALL\n")
    written(ini, ini.with_suffix(".toml"))
    return ini
