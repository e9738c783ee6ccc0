"""Signals at any moment, `kill -9`, inputs that change, clocks that jump: old or new, whole, and nothing left."""

import json
import os
import signal
import subprocess
import time
from collections import Counter
from pathlib import Path

import pytest

from conftest import COMMAND, drawn
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
    preloaded,
    run,
    stand,
    tell_old,
    traced,
)

__all__ = ["folder"]  # a fixture

BY_NAME = {verb.name: verb for verb in VERBS}
PAIR = ("part.nc", "part.json", "part.html")


# Calls at which a run comes to or goes from the disk.
MOMENTS = ("openat", "write", "fsync", "flock", "linkat", "renameat", "unlink", "close", "read")


@pytest.mark.parametrize("name", ["post", "predict"])
@pytest.mark.parametrize("sent", ["SIGTERM", "SIGINT", "SIGHUP"])
def test_a_signal_at_any_call_leaves_old_or_new(name: str, sent: str, folder: Path) -> None:
    if (name, sent) not in (("post", "SIGTERM"), ("predict", "SIGHUP")) and not os.environ.get("POST_ROUNDS"):
        pytest.skip("in long runs alone")
    verb = BY_NAME[name]
    new = news(verb, folder)
    tell_old(folder, verb.written)
    _, calls = traced(folder, verb, ",".join(MOMENTS))
    moments = [(call, number) for call in MOMENTS for number, _ in places(calls, call)]
    # Of each kind of call the last ones are those of the moment in which files take their names.
    step = max(1, len(moments) // often(8, len(moments)))
    chosen = [moment for moment in moments if moment[0] in ("linkat", "renameat")] + moments[::step]
    seen: Counter[tuple[int, str]] = Counter()
    for call, number in chosen:
        old = tell_old(folder, verb.written)
        made, _ = traced(folder, verb, call, f"{call}:signal={sent}:when={number}")
        where = (call, number, made.returncode, made.stderr)
        found = stand(folder, verb.written)
        assert found in (old, new), where
        # strace ends as the command does that it runs: by 128 and the signal's number, told by exit.
        assert made.returncode in (0, 128 + signal.Signals[sent]), where
        if made.returncode == 0:
            assert found == new, where
        assert not left(folder), (left(folder), *where)
        seen[made.returncode, "new" if found == new else "old"] += 1
    print(dict(seen))
    assert seen[128 + signal.Signals[sent], "old"], seen


def test_a_kill_at_any_call_leaves_each_text_whole_and_no_temporary_file_to_the_next_run(folder: Path) -> None:
    verb = BY_NAME["post"]
    new = news(verb, folder)
    tell_old(folder, verb.written)
    _, calls = traced(folder, verb, ",".join(MOMENTS))
    moments = [(call, number) for call in MOMENTS for number, _ in places(calls, call)]
    step = max(1, len(moments) // often(8, len(moments)))
    chosen = [moment for moment in moments if moment[0] in ("linkat", "renameat")] + moments[::step]
    mixed: set[str] = set()
    kept = 0
    for call, number in chosen:
        old = tell_old(folder, verb.written)
        traced(folder, verb, call, f"{call}:signal=SIGKILL:when={number}")
        found = stand(folder, verb.written)
        for name, hashed in found.items():
            assert hashed in (old[name], new[name]), (call, number, name)
        if found not in (old, new):
            mixed.add("".join("n" if found[name] == new[name] else "o" for name in verb.written))
            # Between names nothing but the moment of the names is torn.
            assert call in ("linkat", "renameat", "unlink", "close", "openat", "write", "flock", "fsync"), call
        # What stood there before has a name as long as not all have their new ones.
        olds = [path for path in folder.glob(".post-*.old")]
        kept += len(olds)
        for path in olds:
            assert path.read_text().startswith("what stood at "), path
        # The next run takes what this one has left away, and leaves nothing.
        assert news(verb, folder) == new
        assert not left(folder), (call, number, left(folder))
    print(f"{len(chosen)} moments; torn as {sorted(mixed)}; {kept} former files kept")


def test_a_pair_that_is_torn_tells_that_it_is_none(folder: Path) -> None:
    first = run(folder, "part.cls", "-m", MACHINE, "-o", "part.nc", "--summary", "part.json", "-q")
    assert first.returncode == 0, first.stderr
    program = json.loads((folder / "part.json").read_text())["program"]
    assert program["bytes"] == (folder / "part.nc").stat().st_size and len(program["hash"]) == 64


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGKILL])
def test_a_signal_at_any_moment(sent: signal.Signals, folder: Path) -> None:
    """Runs of two CL files write the same names in turn, and are interrupted."""
    moment = drawn(int(sent))
    text = (folder / "two.cls").read_text()
    begins, ends = text.index("LOAD/TOOL,1"), text.index("END-OF-PATH")
    (folder / "long.cls").write_text(text[:ends] + text[begins:ends] * 6 + text[ends:])
    lines = [
        [name, "-m", MACHINE, "-o", "part.nc", "--summary", "part.json", "--report", "part.html", "-q"]
        for name in ("part.cls", "long.cls")
    ]
    whole, times = [], []
    for line in lines:
        begun = time.perf_counter()
        made = run(folder, *line)
        times.append(time.perf_counter() - begun)
        assert made.returncode == 0, made.stderr
        whole.append(stand(folder, PAIR))
    assert whole[0] != whole[1]
    environment = {**os.environ, "TMPDIR": str(folder.parent / "waiting")}
    seen: Counter[tuple[int, str]] = Counter()
    count = often(8, 500 if sent == signal.SIGKILL else 200)
    before = whole[1]
    for round_ in range(count):
        line, new, least = lines[round_ % 2], whole[round_ % 2], times[round_ % 2]
        child = subprocess.Popen([COMMAND, *line], cwd=folder, env=environment, stderr=subprocess.PIPE, text=True)
        time.sleep(float(moment.uniform(0.0, 1.1 * least)))
        child.send_signal(sent)
        _, said = child.communicate(timeout=60)
        code = child.returncode
        found = stand(folder, PAIR)
        if sent == signal.SIGKILL:
            for name in PAIR:
                assert found[name] in (whole[0][name], whole[1][name]), (round_, name)
            if found not in whole:
                seen[code, "torn"] += 1
            # Each run takes away what those before it have left, but for what stood there before.
            assert len([name for name in left(folder) if name.endswith(".tmp")]) < 20, left(folder)
            texts = {hashed for one in whole for hashed in one.values()}
            assert set(stand(folder, tuple(path.name for path in folder.glob(".post-*.old"))).values()) <= texts
        else:
            assert found in (before, new), (round_, code)
            assert not left(folder), (round_, code, left(folder))
            # Before the handlers are there a signal ends the command as ever.
            assert code in (0, 128 + sent, -sent), code
            if code == 128 + sent and before != new:
                told = "no file was written" if found == before else "3 files were written, and are whole"
                assert said.endswith(f"interrupted; {told}\n"), (said, found == before)
        seen[code, "new" if found == new else "before"] += 1
        before = found
    print(sent.name, dict(seen), f"{len(left(folder))} files left")
    assert run(folder, *lines[0]).returncode == 0 and stand(folder, PAIR) == whole[0]
    assert not left(folder)


@pytest.mark.parametrize("sent", [signal.SIGTERM, signal.SIGKILL])
def test_a_batch_that_was_ended_goes_on_to_the_same_table(sent: signal.Signals, folder: Path) -> None:
    """Whatever the journal holds by then, half a line among it; several times in one batch."""
    line = ["batch", "part.cls", "two.cls", "-m", MACHINE, "--mount", "0,0,-60:60:15", "-o", "rows.csv", "-q"]
    begun = time.perf_counter()
    assert run(folder, *line).returncode == 0
    took = time.perf_counter() - begun
    whole = (folder / "rows.csv").read_text()
    assert len(whole.splitlines()) == 19, "nine places for two files"
    environment = {**os.environ, "TMPDIR": str(folder.parent / "waiting")}
    moment = drawn(100 + int(sent))
    journal = folder / "rows.csv.journal"
    lines: Counter[int] = Counter()
    for _ in range(often(2, 60)):
        for path in (folder / "rows.csv", journal):
            path.unlink(missing_ok=True)
        for _ in range(3):
            child = subprocess.Popen(
                [COMMAND, *line, "--resume"],
                cwd=folder,
                env=environment,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.PIPE,
            )
            time.sleep(float(moment.uniform(0.0, took)))
            child.send_signal(sent)
            _, told = child.communicate(timeout=60)
            assert child.returncode in (0, -sent, 128 + sent), told
            assert not (folder / "rows.csv").exists() or (folder / "rows.csv").read_text() == whole
        # A machine that is switched off may leave half a line besides.
        if journal.is_file() and moment.random() < 0.5:
            os.truncate(journal, int(moment.integers(0, journal.stat().st_size + 1)))
        lines[journal.read_bytes().count(b"\n") if journal.is_file() else 0] += 1
        resumed = run(folder, *line, "--resume")
        assert resumed.returncode == 0, resumed.stderr
        assert (folder / "rows.csv").read_text() == whole
        assert not left(folder)
    print(f"lines of the journal when it was gone on with: {dict(lines)}")


LONG = 20_000


def _long(folder: Path) -> Path:
    """A CL file of some megabytes, of which a run has not read all when it begins."""
    rows = (f"GOTO/{place % 200 * 0.1:.6f},{place // 200 * 0.1:.6f},5.000000\n" for place in range(LONG))
    path = folder / "long.cls"
    begins = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/MMPM,500\nRAPID\nGOTO/0,0,50\n"
    path.write_text(begins + "".join(rows) + "RAPID\nGOTO/0,0,50\nFINI\n")
    return path


def _grows(path: Path) -> None:
    with path.open("a") as file:
        file.write("UNITS/MM\nGOTO/1,1,1\nFINI\n" * 50)


def _shrinks(path: Path) -> None:
    os.truncate(path, path.stat().st_size // 2)


def _is_emptied(path: Path) -> None:
    os.truncate(path, 0)


def _vanishes(path: Path) -> None:
    path.unlink()


def _is_another(path: Path) -> None:
    text = path.read_text().replace(",5.000000", ",6.000000")
    path.with_suffix(".new").write_text(text)
    path.with_suffix(".new").replace(path)


def _is_changed_in_place(path: Path) -> None:
    size = path.stat().st_size
    with path.open("r+") as file:
        file.seek(size - size // 4)
        file.write("GOTO/1.000000,1.000000,-90.00\n" * 1000)


@pytest.mark.parametrize("change", [_grows, _shrinks, _is_emptied, _vanishes, _is_another, _is_changed_in_place])
@pytest.mark.parametrize("more", ["", "--verify", "--report part.html"])
def test_an_input_that_changes_while_it_is_read(change: object, more: str, folder: Path) -> None:
    """Written is the program of the file as it was or as it became, and nothing that is a mixture of both."""
    assert callable(change)
    path = _long(folder)
    line = [path.name, "-m", "vmc", "-o", "part.nc", "-q", *more.split()]
    begun = time.perf_counter()
    first = run(folder, *line)
    took = time.perf_counter() - begun
    assert first.returncode == 0, first.stderr
    old = (folder / "part.nc").read_bytes()
    text = path.read_text()
    change(path)
    second = run(folder, *line)
    new = (folder / "part.nc").read_bytes() if second.returncode == 0 else None
    seen: Counter[str] = Counter()
    moment = drawn(77)
    for _ in range(often(2, 60)):
        path.write_text(text)
        (folder / "part.nc").write_text("before\n")
        child = subprocess.Popen([COMMAND, *line], cwd=folder, stderr=subprocess.PIPE, text=True)
        time.sleep(float(moment.uniform(0.0, took)))
        change(path)
        _, told = child.communicate(timeout=60)
        found = (folder / "part.nc").read_bytes()
        if child.returncode == 0:
            assert found in (old, new), (len(found), len(old), told[-600:])
            seen["old" if found == old else "new"] += 1
        else:
            assert child.returncode == 1 and found == b"before\n", (child.returncode, told[-600:])
            assert "panicked" not in told
            seen["refused"] += 1
        assert not left(folder)
    print(dict(seen))


CLOCK = r"""
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <sys/time.h>
#include <time.h>

/* A clock of the day that jumps by years, back and forth, and one that stands or leaps by a minute. */
static unsigned calls;
int clock_gettime(clockid_t clock, struct timespec *at) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = (int (*)(clockid_t, struct timespec *))dlsym(RTLD_NEXT, "clock_gettime");
    int code = real(clock, at);
    unsigned call = __atomic_add_fetch(&calls, 1, __ATOMIC_RELAXED);
    if (clock == CLOCK_REALTIME) at->tv_sec += (call % 3 - 1) * 1000000000L;
    else if (clock == CLOCK_MONOTONIC && getenv("LEAPS")) at->tv_sec += call % 2 ? 60 : 0;
    return code;
}
time_t time(time_t *out) {
    struct timespec at;
    clock_gettime(CLOCK_REALTIME, &at);
    if (out) *out = at.tv_sec;
    return at.tv_sec;
}
int gettimeofday(struct timeval *restrict out, void *restrict zone) {
    struct timespec at;
    (void)zone;
    clock_gettime(CLOCK_REALTIME, &at);
    out->tv_sec = at.tv_sec;
    out->tv_usec = at.tv_nsec / 1000;
    return 0;
}
"""


@pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)
@pytest.mark.parametrize("leaps", [False, True])
def test_a_clock_that_jumps_changes_no_byte(verb: Verb, leaps: bool, folder: Path) -> None:
    if leaps and verb.name not in ("post", "batch") and not os.environ.get("POST_ROUNDS"):
        pytest.skip("in long runs alone")
    new = news(verb, folder)
    library = preloaded(folder.parent, CLOCK)
    environment = {"LD_PRELOAD": str(library), **({"LEAPS": "1"} if leaps else {})}
    for _ in range(often(1, 10)):
        for path in (*(folder / name for name in verb.written), *folder.glob("*.journal")):
            path.unlink(missing_ok=True)
        made = run(folder, *verb.arguments, environment=environment)
        assert made.returncode == 0, made.stderr
        assert stand(folder, verb.written) == new
