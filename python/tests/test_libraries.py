"""Every fault of the hostile dialect (``plugins/host/tests/c/hostile.c``), from the command line: what comes of a library
in a process of its own is a refusal that names it, or the program that it writes without the fault; and nothing else.

Run as a command, it writes the page of the book that has them all, in a process of their own and in that of the command.
"""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

import pytest
from conftest import CHECKOUT, COMMAND

SOURCE = CHECKOUT / "plugins/host/tests/c/hostile.c"
FAULTS = sorted(set(re.findall(r"FAULT_([A-Z][A-Z_0-9]*)", SOURCE.read_text())))
WRITES_OTHERWISE = {"CRLF", "CR_CR", "LATE_EXIT", "LONG_LINE"}
"""What they write has other ends of lines, or more of it, or blanks alone; it is a program all the same."""

HANGS = 8
"""Seconds after which a run without limits of its own is taken to hang."""
UNTRIED = {"EATS": "not run: takes all memory", "FORKS_AGAIN": "not run: twice as many processes at each event"}
"""What in the process of the command harms the system."""
PAGE = CHECKOUT / "docs/src/reference/hostile-plugins.md"

pytestmark = pytest.mark.skipif(os.name == "nt" or not shutil.which("cc"), reason="there is no C compiler")


def posted(folder: Path, fault: str, *more: str) -> subprocess.CompletedProcess[str]:
    """The sample, posted in the dialect with a fault; calls that never return are given a second."""
    plugins = folder / "plugins"
    plugins.mkdir()
    made = ["cc", "-O1", "-w", "-shared", "-fPIC", f"-DFAULT_{fault}", "-I", CHECKOUT / "plugins/api/include", SOURCE]
    subprocess.run([*made, "-o", plugins / "libpost_hostile.so", "-lm", "-pthread"], check=True)
    room = folder / "room"
    room.mkdir()
    shutil.copy(CHECKOUT / "tests/samples/blade.cls", room)
    words = [COMMAND, "-m", "ac-trunnion", "blade.cls", "--dialect", "hostile", "--plugins", plugins]
    words += ["-o", "part.nc", *(more or ("--plugin-seconds", "1", "--plugin-memory", "512"))]
    environment = {**os.environ, "TMPDIR": str(room)}
    # What is given up is ended with all that it has started; its output may be held by them, and goes to a file.
    with (folder / "said").open("w+b") as said:
        child = subprocess.Popen(
            words, cwd=room, env=environment, stdout=subprocess.DEVNULL, stderr=said, start_new_session=True
        )
        try:
            code = child.wait(timeout=HANGS if more else 60)
        finally:
            if child.poll() is None:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()
        said.seek(0)
        return subprocess.CompletedProcess(words, code, "", said.read().decode(errors="replace"))


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
    assert all(f"| `{fault}` |" in PAGE.read_text() for fault in FAULTS), "python python/tests/test_libraries.py"


def outcome(fault: str, whole: bytes, *more: str) -> str:
    """What came of a fault, in the words of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        try:
            run = posted(folder, fault, *more)
        except subprocess.TimeoutExpired:
            return "hangs"
        room = folder / "room"
        left = sorted(path.name for path in room.iterdir() if path.name not in ("blade.cls", "part.nc"))
        program = (room / "part.nc").read_bytes() if (room / "part.nc").exists() else None
    told = re.search(r"^error\[(?:plugin|dialect)\]: (.*hostile.*)", run.stderr, re.M)
    also = ", a temporary file is left" if left else ""
    if run.returncode == 0 and program is None:
        return "**success without a program**" + also
    if run.returncode == 0 and (program == whole or fault in WRITES_OTHERWISE):
        warned = re.search(r"^warning\[plugin\]", run.stderr, re.M)
        return ("the program, with a warning" if warned else "the program") + also
    if run.returncode == 0:
        return "**another program**" + also
    if run.returncode < 0:
        return f"**ended by {signal.Signals(-run.returncode).name}**" + also
    if told is None or program is not None:
        return f"exit code {run.returncode}, not told by name" + also
    sentence = re.sub(r"\b[0-9a-f]{16}\b", "…", re.sub(r"/\S*/", "", told[1]))
    sentence = re.sub(r"[^ -~\u2013-\u201d]", "?", sentence).replace("|", "\\|")
    return (sentence if len(sentence) <= 160 else sentence[:157] + "…") + also


def page() -> str:
    """The table of all faults."""
    with tempfile.TemporaryDirectory() as name:
        assert posted(Path(name), "NONE_AT_ALL").returncode == 0
        whole = (Path(name) / "room/part.nc").read_bytes()
    rows, counts = list[str](), {"told": 0, "harmless": 0}
    for fault in FAULTS:
        own = outcome(fault, whole)
        counts["harmless" if own.startswith("the program") else "told"] += 1
        one = UNTRIED.get(fault) or outcome(fault, whole, "--no-isolate")
        rows.append(f"| `{fault}` | {one} | {'the same' if one == own else own} |\n")
    return (
        "# Libraries that mean no good\n\n"
        "Written by `python python/tests/test_libraries.py`, which posts `tests/samples/blade.cls` by the dialect of "
        "`plugins/host/tests/c/hostile.c`, one fault at a time (`-DFAULT_…`): in the process of the command "
        "(`--no-isolate`, as all libraries were once) and in a process of its own, as it is by default, with "
        "`--plugin-seconds 1 --plugin-memory 512`. A sentence is the error that the command gives, with exit code 1, "
        "no program and no temporary file.\n\n"
        f"Of {len(FAULTS)} faults, in a process of their own, {counts['told']} are told by name and "
        f"{counts['harmless']} leave the program as it is without them.\n\n"
        "| fault | `--no-isolate` | in a process of its own |\n|---|---|---|\n" + "".join(rows)
    )


if __name__ == "__main__":
    PAGE.write_text(page())
