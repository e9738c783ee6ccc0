"""Faults of the disk, by injection: what stands at the targets is old or new, all of it, and the exit code says which.

What needs root, a mount, `strace` or a C compiler is skipped without it, and says so.
"""

import contextlib
import os
import re
import resource
import shutil
import subprocess
import threading
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import COMMAND
from fault_parts import (
    MACHINE,
    VERBS,
    Stand,
    Verb,
    folder,
    left,
    news,
    often,
    places,
    prepared,
    run,
    stand,
    tell_old,
    tool,
    traced,
)

__all__ = ["folder"]  # a fixture

BY_NAME = {verb.name: verb for verb in VERBS}


def judged(verb: Verb, folder: Path, old: Stand, new: Stand, made: "subprocess.CompletedProcess[str]") -> str:
    """`old` or `new`: nothing else may stand there, and the exit code says which."""
    found = stand(folder, verb.written)
    assert not left(folder), (verb.name, left(folder), made.stderr)
    if made.returncode == 0:
        assert found == new, (verb.name, made.stderr)
        return "new"
    assert made.returncode == verb.failed, (verb.name, made.returncode, made.stderr)
    assert found == old, (verb.name, found, made.stderr)
    return "old"


@contextlib.contextmanager
def mounted(at: Path, *options: str) -> Iterator[Path]:
    """A disk in the memory, of its own size."""
    at.mkdir(exist_ok=True)
    if os.geteuid() != 0 or tool("mount") is None:
        pytest.skip("a disk can be mounted by root alone")
    made = subprocess.run(["mount", "-t", "tmpfs", *options, "none", str(at)], capture_output=True, text=True)
    if made.returncode != 0:
        pytest.skip(f"no disk can be mounted here: {made.stderr.strip()}")
    try:
        yield at
    finally:
        subprocess.run(["umount", "-l", str(at)], check=True)


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)
def test_a_full_disk_leaves_old_or_new(verb: Verb, folder: Path, tmp_path: Path) -> None:
    new = news(verb, folder)
    with mounted(tmp_path / "disk", "-o", "size=64m") as disk:
        room = prepared(disk / "work")
        tell_old(room, verb.written)
        free = os.statvfs(room)
        seen: Counter[str] = Counter()
        steps = often(6, 64)
        # From no free block at all to as many as it needs.
        need = 2 * sum((folder / name).stat().st_size for name in verb.written) // free.f_bsize + 16
        for step in range(steps):
            old = tell_old(room, verb.written)
            blocks = os.statvfs(room).f_bavail - need * step // (steps - 1)
            (disk / "filler").write_bytes(b"\0" * max(blocks, 0) * free.f_bsize)
            made = run(room, *verb.arguments)
            seen[judged(verb, room, old, new, made)] += 1
            if made.returncode:
                assert re.search("[Nn]o space left|disk is full|storage", made.stderr), made.stderr
            (disk / "filler").unlink()
            for more in room.glob("*.journal"):
                more.unlink()
        assert seen["new"] and seen["old"], seen


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)
def test_a_limit_of_the_size_of_files_leaves_old_or_new(verb: Verb, folder: Path) -> None:
    new = news(verb, folder)
    largest = max((folder / name).stat().st_size for name in verb.written)
    seen: Counter[str] = Counter()
    steps = often(5, 100)
    for step in range(steps):
        most = largest * 3 * step // (2 * (steps - 1))
        old = tell_old(folder, verb.written)
        for more in folder.glob("*.journal"):
            more.unlink()

        def limited(most: int = most) -> None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))

        seen[judged(verb, folder, old, new, run(folder, *verb.arguments, preexec_fn=limited))] += 1
    assert seen["old"], seen
    # Where rows wait in files of their own those are larger than what is written.
    assert seen["new"] or verb.name in ("post", "verify", "predict", "diff"), seen


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)
def test_a_folder_that_is_read_only_is_told_and_left(verb: Verb, folder: Path, tmp_path: Path) -> None:
    with mounted(tmp_path / "disk") as disk:
        room = prepared(disk / "work")
        old = tell_old(room, verb.written)
        subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
        made = run(room, *verb.arguments)
        assert made.returncode == verb.failed and "Read-only file system" in made.stderr, made.stderr
        assert stand(room, verb.written) == old and not left(room)


def test_a_folder_without_the_right_to_write_is_told_and_left(folder: Path, tmp_path: Path) -> None:
    if os.geteuid() == 0:
        pytest.skip("root may write everywhere: the read-only disk is held instead")
    verb = BY_NAME["post"]
    old = tell_old(folder, verb.written)
    folder.chmod(0o555)
    try:
        made = run(folder, *verb.arguments)
        assert made.returncode == 1 and "ermission denied" in made.stderr
        assert stand(folder, verb.written) == old
    finally:
        folder.chmod(0o755)


def test_a_device_that_is_full_is_told(folder: Path) -> None:
    verb = BY_NAME["post"]
    old = tell_old(folder, verb.written)
    line = list(verb.arguments)
    line[line.index("part.nc")] = "/dev/full"
    made = run(folder, *line)
    assert made.returncode == 1 and "No space left" in made.stderr
    found = stand(folder, verb.written)
    # The program did not get there: what goes with it is not written either.
    assert found == old and not left(folder)
    with open("/dev/full", "w") as full:
        for line in (["part.cls", "-m", MACHINE, "-o", "-"], ["read", "given.nc", "-m", MACHINE, "--csv", "-"]):
            made = subprocess.run([COMMAND, *line], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True)
            assert made.returncode == 1, made.stderr
    with open("/dev/full", "w") as full:
        line = ["part.cls", "-m", MACHINE, "-o", "part.nc"]
        made = subprocess.run([COMMAND, *line], cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True)
        assert made.returncode != 0 and "written" in made.stderr.splitlines()[-1], made.stderr


# What reaches the disk, and what it may answer: full, quota used up, broken, read-only.
CALLS = {
    "openat": ("ENOSPC", "EDQUOT", "EIO", "EROFS", "EMFILE"),
    "write": ("ENOSPC", "EDQUOT", "EIO"),
    "fsync": ("ENOSPC", "EDQUOT", "EIO"),
    "linkat": ("ENOSPC", "EDQUOT", "EIO", "EMLINK"),
    "renameat": ("ENOSPC", "EDQUOT", "EIO"),
    "fchmod": ("EIO", "EPERM"),
    "fchown": ("EPERM",),
    "flock": ("ENOLCK",),
    "unlink": ("EIO",),
    "statx": ("EIO",),
    "newfstatat": ("EIO",),
}


@pytest.mark.parametrize("name", ["post", "read", "verify"])
def test_a_call_that_fails_leaves_old_or_new(name: str, folder: Path) -> None:
    verb = BY_NAME[name]
    new = news(verb, folder)
    tell_old(folder, verb.written)
    made, calls = traced(folder, verb, ",".join(CALLS))
    assert made.returncode == 0 and stand(folder, verb.written) == new, made.stderr
    cases = [
        (call, number, error, line)
        for call, errors in CALLS.items()
        for number, line in places(calls, call)
        for error in errors
    ]
    assert len(cases) > 50
    most = often(15, len(cases))
    seen: Counter[tuple[str, str]] = Counter()
    # The moment in which files take their names, and each so many of all.
    chosen = [case for case in cases if case[0] == "renameat"] + cases[:: max(1, len(cases) // most)]
    for call, number, error, line in chosen:
        old = tell_old(folder, verb.written)
        made, _ = traced(folder, verb, call, f"{call}:error={error}:when={number}")
        where = (call, number, error, line, made.returncode, made.stderr)
        found = stand(folder, verb.written)
        assert made.returncode in (0, verb.failed), where
        if call != "unlink":
            assert not left(folder), (left(folder), *where)
        assert found in (old, new), where
        if made.returncode:
            assert "error" in made.stderr and "panicked" not in made.stderr, where
            # What failed may come after all files have their names: the table for standard output. The last line knows.
            last = made.stderr.strip().splitlines()[-1]
            told = all(name in last for name in verb.written) and "written" in last
            assert ("nothing was written" in last or "as before" in last) if found == old else told, where
        else:
            assert found == new, where
        seen[call, "old" if found == old else "new"] += 1
        for path in (folder, folder.parent / "waiting"):
            for file in path.glob(".post-*"):
                file.unlink()
    print(dict(seen))
    assert seen["write", "old"] and seen["renameat", "old"]


@pytest.mark.parametrize("name", ["read", "post", "verify"])
def test_an_input_that_cannot_be_read_is_told(name: str, folder: Path) -> None:
    verb = BY_NAME[name]
    new = news(verb, folder)
    _, calls = traced(folder, verb, "openat,read")
    for number, line in places(calls, "read"):
        tell_old(folder, verb.written)
        made, _ = traced(folder, verb, "read", f"read:error=EIO:when={number}")
        assert made.returncode in (0, verb.failed) and not left(folder), (number, line, made.stderr)
        if made.returncode:
            assert "Input/output error" in made.stderr, (number, line, made.stderr)
        else:
            assert stand(folder, verb.written) == new, (number, line, made.stderr)


def test_a_page_is_of_the_cl_file_that_the_program_is_of(folder: Path) -> None:
    """The file is replaced by another before it is read for the page: that is told, or the page is of the first one."""
    line = ("part.cls", "-m", MACHINE, "-o", "part.nc", "--report", "part.html", "-q")
    verb = Verb("post", line, ("part.nc", "part.html"))
    new = news(verb, folder)
    _, calls = traced(folder, verb, "openat")
    last = [number for number, line in places(calls, "openat") if "part.cls" in line][-1]
    text = (folder / "part.cls").read_text()
    (folder / "other.cls").write_text(re.sub("GOTO/(-?)", r"GOTO/\g<1>9", text))

    def replace() -> None:
        (folder / "other.cls").replace(folder / "part.cls")

    # Well behind the moment in which posting has opened it, and ahead of the last time.
    timer = threading.Timer(1.0, replace)
    timer.start()
    made, _ = traced(folder, verb, "openat", f"openat:delay_enter=2500000:when={last}")
    timer.join()
    assert made.returncode == verb.failed or stand(folder, verb.written) == new


def writing(folder: Path, *arguments: str) -> "tuple[subprocess.Popen[str], list[str]]":
    """A run that waits for the second half of its CL file, its temporary file made; and that half."""
    line = [COMMAND, "-", "-m", "vmc", *arguments]
    begun = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/MMPM,500\nRAPID\nGOTO/0,0,50\n"
    child = subprocess.Popen(
        line, cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdin
    child.stdin.write(begun)
    child.stdin.flush()
    done = threading.Event()
    for _ in range(2000):
        if list(folder.resolve().rglob(".post-*")):
            return child, ["GOTO/10,0,50\n", "END-OF-PATH\n", "FINI\n"]
        done.wait(0.005)
    raise AssertionError("no temporary file is made")


def _as_it_is(folder: Path) -> None:
    del folder


def _another_file(folder: Path) -> None:
    (folder / "newer").write_text("of somebody else\n")
    (folder / "newer").replace(folder / "part.nc")


def _a_link(folder: Path) -> None:
    (folder / "part.nc").unlink()
    (folder / "part.nc").symlink_to("precious")


def _a_link_to_what_is_not(folder: Path) -> None:
    (folder / "part.nc").unlink()
    (folder / "part.nc").symlink_to("nowhere")


def _a_hard_link(folder: Path) -> None:
    (folder / "part.nc").unlink()
    os.link(folder / "precious", folder / "part.nc")


def _nothing(folder: Path) -> None:
    (folder / "part.nc").unlink()


def _a_folder(folder: Path) -> None:
    (folder / "part.nc").unlink()
    (folder / "part.nc").mkdir()


def _a_folder_with_files(folder: Path) -> None:
    _a_folder(folder)
    (folder / "part.nc/precious").write_text("precious\n")


def _a_pipe(folder: Path) -> None:
    (folder / "part.nc").unlink()
    os.mkfifo(folder / "part.nc")


@pytest.mark.parametrize(
    "becomes",
    [
        _as_it_is,
        _another_file,
        _a_link,
        _a_link_to_what_is_not,
        _a_hard_link,
        _nothing,
        _a_folder,
        _a_folder_with_files,
        _a_pipe,
    ],
)
def test_a_target_that_changes_while_it_is_written(folder: Path, becomes: "object") -> None:
    assert callable(becomes)
    (folder / "part.nc").write_text("old\n")
    (folder / "part.json").write_text("old\n")
    (folder / "precious").write_text("precious\n")
    child, rest = writing(folder, "-o", "part.nc", "--summary", "part.json", "-q")
    becomes(folder)
    _, told = child.communicate("".join(rest), timeout=60)
    # What another name has, or a link leads to, is never touched.
    assert (folder / "precious").read_text() == "precious\n"
    assert not (folder / "nowhere").exists()
    assert not left(folder), told
    if child.returncode == 0:
        assert (folder / "part.nc").read_text().startswith("%") and "old" not in (folder / "part.json").read_text()
    else:
        assert child.returncode == 1 and "part.nc" in told, told
        assert (folder / "part.json").read_text() == "old\n"
    # A folder is not replaced, and what is in it stays.
    if becomes in (_a_folder, _a_folder_with_files):
        assert child.returncode == 1 and (folder / "part.nc").is_dir()
    if becomes is _a_folder_with_files:
        assert (folder / "part.nc/precious").read_text() == "precious\n"


def test_a_folder_that_goes_away_while_it_is_written_to(folder: Path) -> None:
    (folder / "sub").mkdir()
    child, rest = writing(folder, "-o", "sub/part.nc", "--summary", "part.json", "-q")
    shutil.rmtree(folder / "sub")
    _, told = child.communicate("".join(rest), timeout=60)
    assert child.returncode == 1 and "part.nc" in told and "nothing was written" in told, told
    assert not (folder / "part.json").exists() and not left(folder)


def test_a_folder_that_takes_another_name_while_it_is_written_to(folder: Path) -> None:
    (folder / "sub").mkdir()
    (folder / "sub/part.nc").write_text("old\n")
    (folder / "other").mkdir()
    (folder / "other/part.nc").write_text("precious\n")
    child, rest = writing(folder, "-o", "sub/part.nc", "--summary", "part.json", "-q")
    (folder / "sub").rename(folder / "away")
    (folder / "sub").symlink_to("other")
    _, told = child.communicate("".join(rest), timeout=60)
    assert child.returncode == 1 and (folder / "other/part.nc").read_text() == "precious\n", told
    assert (folder / "away/part.nc").read_text() == "old\n" and not (folder / "part.json").exists()
