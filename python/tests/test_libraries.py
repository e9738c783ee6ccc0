"""Every fault of the hostile dialect (``plugins/host/tests/c/hostile.c``), from the command line: what comes of a library
in a process of its own is a refusal that names it, or the program that it writes without the fault; and nothing else."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import CHECKOUT, COMMAND

SOURCE = CHECKOUT / "plugins/host/tests/c/hostile.c"
FAULTS = sorted(set(re.findall(r"FAULT_([A-Z][A-Z_0-9]*)", SOURCE.read_text())))
WRITES_OTHERWISE = {"CRLF", "CR_CR", "LATE_EXIT"}
"""What they write has other ends of lines, or more of it; it is a program all the same."""

pytestmark = pytest.mark.skipif(os.name == "nt" or not shutil.which("cc"), reason="there is no C compiler")


def posted(folder: Path, fault: str) -> subprocess.CompletedProcess[str]:
    """The sample, posted in the dialect with a fault; calls that never return are given a second."""
    plugins = folder / "plugins"
    plugins.mkdir()
    made = ["cc", "-O1", "-w", "-shared", "-fPIC", f"-DFAULT_{fault}", "-I", CHECKOUT / "plugins/api/include", SOURCE]
    subprocess.run([*made, "-o", plugins / "libpost_hostile.so", "-lm", "-pthread"], check=True)
    room = folder / "room"
    room.mkdir()
    shutil.copy(CHECKOUT / "tests/samples/blade.cls", room)
    words = [COMMAND, "-m", "ac-trunnion", "blade.cls", "--dialect", "hostile", "--plugins", plugins]
    words += ["-o", "part.nc", "--plugin-seconds", "1", "--plugin-memory", "512"]
    environment = {**os.environ, "TMPDIR": str(room)}
    return subprocess.run(words, cwd=room, env=environment, capture_output=True, text=True, errors="replace", timeout=60)


@pytest.fixture(scope="session")
def plain(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The program of the dialect without a fault."""
    folder = tmp_path_factory.mktemp("plain")
    assert posted(folder, "NONE_AT_ALL").returncode == 0
    return (folder / "room/part.nc").read_bytes()


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_told_by_name_or_does_no_harm(fault: str, plain: bytes, tmp_path: Path) -> None:
    run = posted(tmp_path, fault)
    room = tmp_path / "room"
    left = sorted(path.name for path in room.iterdir())
    if run.returncode == 0:
        assert left == ["blade.cls", "part.nc"]
        assert (room / "part.nc").read_bytes() == plain or fault in WRITES_OTHERWISE
        return
    assert run.returncode == 1 and left == ["blade.cls"], (run.returncode, left, run.stderr)
    assert re.search(r"^error\[(plugin|dialect)\]: .*hostile", run.stderr, re.M), run.stderr


def test_all_faults_are_there() -> None:
    assert len(FAULTS) > 80
