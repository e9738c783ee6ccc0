"""What tests of faults and of sameness share: every verb that writes, with all that it can write, and what stands there."""

import hashlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from conftest import CHECKOUT, COMMAND

Stand = dict[str, "str | None"]

# A machine that tilts, so that points are put in, and a CL file of it with cuts and rapids.
MACHINE = "ac-trunnion"
CL = CHECKOUT / "tests/machines/ac-trunnion.cls"


@dataclass(frozen=True)
class Verb:
    """A command line, and the files that it writes; of folders what is in them."""

    name: str
    arguments: tuple[str, ...]
    written: tuple[str, ...]

    @property
    def failed(self) -> int:
        """The exit code of a run that could not do its work: `lint` has 1 for what it finds."""
        return 2 if self.name == "lint" else 1


def _verb(name: str, line: str, *written: str) -> Verb:
    return Verb(name, tuple(line.split()), written)


VERBS = [
    _verb(
        "post",
        f"part.cls -m {MACHINE} -o part.nc --summary part.json --report part.html --setup-sheet sheet.html "
        "--predict=predicted.json --verify",
        "part.nc",
        "part.json",
        "part.html",
        "sheet.html",
        "predicted.json",
    ),
    _verb("split", f"two.cls -m {MACHINE} -o part.nc --split tools --caller", "part.nc", "part-1.nc", "part-2.nc"),
    _verb(
        "verify",
        f"verify given.nc -m {MACHINE} --against part.cls --map map.json --summary part.json --report part.html",
        "map.json",
        "part.json",
        "part.html",
    ),
    _verb("lint", f"lint given.nc -m {MACHINE} --json part.json --sarif part.sarif", "part.json", "part.sarif"),
    _verb("read", f"read given.nc -m {MACHINE} --csv rows.csv", "rows.csv"),
    _verb(
        "predict",
        f"predict given.nc -m {MACHINE} --against part.cls --csv rows.csv --summary part.json --report part.html",
        "rows.csv",
        "part.json",
        "part.html",
    ),
    _verb("convert", f"convert given.nc --from {MACHINE} --to ac-trunnion-840d -o part.mpf --cl back.cls", "part.mpf", "back.cls"),
    _verb(
        "diff",
        f"diff given.nc given.nc -m {MACHINE} --json part.json --report part.html",
        "part.json",
        "part.html",
    ),
    _verb("place", f"place part.cls -m {MACHINE} --svg place.svg", "place.svg"),
    _verb("batch", f"batch part.cls two.cls -m {MACHINE} -m dmu50 -o rows.csv", "rows.csv"),
]


def prepared(folder: Path) -> Path:
    """A folder with all that the verbs read."""
    folder.mkdir(exist_ok=True)
    text = CL.read_text()
    (folder / "part.cls").write_text(text)
    # A second tool, for what is split.
    assert text.count("LOAD/TOOL,") == 1, "the sample has another form"
    body = text[: text.index("END-OF-PATH")]
    again = body[body.index("LOAD/TOOL,") :].replace("LOAD/TOOL,1", "LOAD/TOOL,2")
    (folder / "two.cls").write_text(body + again + text[text.index("END-OF-PATH") :])
    made = run(folder, "part.cls", "-m", MACHINE, "-o", "given.nc", "-q")
    assert made.returncode == 0, made.stderr
    return folder


def run(
    folder: Path, *arguments: str, before: list[str] | None = None, **more: object
) -> "subprocess.CompletedProcess[str]":
    """The command in a folder, behind `before`; its temporary files are in the folder `waiting` beside it."""
    waiting = folder.parent / "waiting"
    waiting.mkdir(exist_ok=True)
    given = more.pop("environment", None)
    environment = {**os.environ, "TMPDIR": str(waiting), **(given if isinstance(given, dict) else {})}
    for name in ("POST_MACHINES", "POST_PLUGINS"):
        environment.pop(name, None)
    line = [*(before or []), COMMAND, *arguments]
    return subprocess.run(  # type: ignore[call-overload,no-any-return]
        line, cwd=folder, env=environment, capture_output=True, text=True, timeout=120, errors="replace", **more
    )


def left(folder: Path) -> list[str]:
    """Temporary files and second names, in the folder and where texts wait."""
    both = (folder, folder.parent / "waiting")
    return sorted(path.name for place in both if place.is_dir() for path in place.glob(".post-*"))


def stand(folder: Path, names: tuple[str, ...]) -> Stand:
    """What stands at each name: a hash of it, None if nothing does."""

    def one(path: Path) -> str | None:
        return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else None

    return {name: one(folder / name) for name in names}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with what the verbs read."""
    return prepared(tmp_path / "work")


def news(verb: Verb, folder: Path) -> Stand:
    """What the verb writes where nothing is in its way."""
    made = run(folder, *verb.arguments)
    assert made.returncode == 0, made.stderr
    return stand(folder, verb.written)


def tell_old(folder: Path, names: tuple[str, ...]) -> Stand:
    """Puts files of another run at the names."""
    for name in names:
        (folder / name).write_text(f"what stood at {name} before\n" * 3)
    return stand(folder, names)


def traced(
    folder: Path, verb: Verb, calls: str, inject: str | None = None
) -> "tuple[subprocess.CompletedProcess[str], list[str]]":
    """The verb under `strace`, which puts in a fault or a signal; and these calls as it made them."""
    strace = tool("strace")
    if strace is None:
        pytest.skip("there is no strace")
    log = folder.parent / "calls"
    before = [strace, "-f", "-qq", "-o", str(log), "-e", f"trace={calls}"]
    if inject:
        before += ["-e", f"inject={inject}"]
    one_thread = () if verb.name == "read" else ("-j", "1")
    made = run(folder, *verb.arguments, *one_thread, before=before)
    if "ptrace" in made.stderr:
        pytest.skip("strace may not trace here")
    return made, log.read_text(errors="replace").splitlines()


def places(calls: list[str], call: str) -> Iterator[tuple[int, str]]:
    """The number of each such call of the thread that works, from the first file of the run's own on, and its line."""
    thread = calls[0].split()[0]
    own, count = False, 0
    for line in calls:
        if line.split()[0] != thread:
            continue
        own = own or ".post-" in line or "part.cls" in line or "given.nc" in line
        if f" {call}(" in line:
            count += 1
            if own:
                yield count, line


def often(few: int, many: int) -> int:
    """So many times in a usual run; of a long one (POST_ROUNDS) `many`, times its number."""
    times = os.environ.get("POST_ROUNDS")
    return many * int(times) if times else few


def tool(name: str) -> str | None:
    """A program of the system."""
    return shutil.which(name)


def preloaded(folder: Path, source: str) -> Path:
    """A library of a few lines of C, to be loaded ahead of the system's."""
    compiler = tool("cc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    made = folder / "preloaded.so"
    (folder / "preloaded.c").write_text(source)
    line = [compiler, "-shared", "-fPIC", "-O1", "-o", str(made), str(folder / "preloaded.c"), "-ldl", "-lm"]
    subprocess.run(line, check=True)
    return made
