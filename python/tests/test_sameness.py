"""The same bytes of every verb that writes, whatever the machine, the shell and the folder are like."""

import os
import shlex
import subprocess
from pathlib import Path

import pytest

from conftest import COMMAND
from fault_parts import VERBS, Stand, Verb, folder, often, preloaded, prepared, run, stand, tool

__all__ = ["folder"]  # a fixture


def cleared(folder: Path, verb: Verb) -> None:
    """Nothing that an earlier run has written."""
    for path in (*(folder / name for name in verb.written), *folder.glob("*.journal")):
        path.unlink(missing_ok=True)


def made(folder: Path, verb: Verb, *more: str, **how: object) -> Stand:
    """What the verb writes, run so, and what it prints for people."""
    cleared(folder, verb)
    told = run(folder, *verb.arguments, *more, **how)
    assert told.returncode == 0, told.stderr
    found = stand(folder, verb.written)
    assert all(found.values()), found
    return {**found, "printed": told.stdout}


EACH = pytest.mark.parametrize("verb", VERBS, ids=lambda verb: verb.name)


@EACH
def test_threads(verb: Verb, folder: Path) -> None:
    first = made(folder, verb)
    if tool("taskset"):
        assert made(folder, verb, before=["taskset", "-c", "0"]) == first
    if verb.name not in ("read", "convert", "diff", "lint"):
        for count in ("1", "2", "7"):
            assert made(folder, verb, "-j", count) == first, count


@EACH
def test_runs(verb: Verb, folder: Path) -> None:
    """Hash tables are seeded anew in each run, and addresses are drawn."""
    first = made(folder, verb)
    for count in range(often(2, 30)):
        assert made(folder, verb, environment={"FILLER": "x" * (count * 3337)}) == first
    if tool("setarch"):
        assert made(folder, verb, before=["setarch", "-R"]) == first


@EACH
def test_time_zone_umask_and_environment(verb: Verb, folder: Path) -> None:
    first = made(folder, verb)
    for zone in ("Asia/Kathmandu", "XYZ+14:37", "UTC", "Pacific/Kiritimati")[: often(2, 4)]:
        assert made(folder, verb, environment={"TZ": zone}) == first, zone
    for umask in (0, 0o277, 0o077)[: often(2, 3)]:
        assert made(folder, verb, umask=umask) == first, oct(umask)
    told = {"COLUMNS": "17", "TERM": "dumb", "NO_COLOR": "1", "HOME": "/nowhere", "RUST_BACKTRACE": "full"}
    assert made(folder, verb, environment=told) == first
    emptied = made(folder, verb, before=["env", "-i", f"TMPDIR={folder.parent / 'waiting'}"])
    assert emptied == first


@EACH
def test_folder(verb: Verb, folder: Path, tmp_path: Path) -> None:
    first = made(folder, verb)
    assert made(prepared(tmp_path / "ein längerer Ordner, with ' and spaces"), verb) == first
    (tmp_path / "link").symlink_to(folder)
    assert made(tmp_path / "link", verb) == first


@pytest.fixture(scope="session")
def locales(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Locales with a decimal comma, one of them with an i that has no dot; and a library that asks for the user's."""
    localedef = tool("localedef")
    if localedef is None:
        pytest.skip("there is no localedef")
    at = tmp_path_factory.mktemp("locales")
    for name in LOCALES:
        line = [localedef, "-i", name, "-f", "UTF-8", str(at / f"{name}.UTF-8")]
        generated = subprocess.run(line, capture_output=True, text=True)
        if not (at / f"{name}.UTF-8/LC_NUMERIC").is_file():
            pytest.skip(f"the locale {name} cannot be made: {generated.stderr.strip()}")
    preloaded(at, LOCALE)
    return at


LOCALES = ("de_DE", "tr_TR")


@EACH
def test_locale(verb: Verb, folder: Path, locales: Path) -> None:
    first = made(folder, verb)
    for name in LOCALES:
        told = {"LOCPATH": str(locales), "LC_ALL": f"{name}.UTF-8", "LANG": f"{name}.UTF-8"}
        assert made(folder, verb, environment=told) == first, name
        asked = {**told, "LD_PRELOAD": str(locales / "preloaded.so")}
        assert made(folder, verb, environment=asked) == first, name


# As a library does that is opened: the whole process has the user's locale then.
LOCALE = r"""
#include <locale.h>
#include <stdlib.h>
#include <string.h>
__attribute__((constructor)) static void begin(void) {
    if (getenv("LC_ALL") && (!setlocale(LC_ALL, "") || strcmp(localeconv()->decimal_point, ","))) abort();
}
"""

# As a library does that is linked with -ffast-math, or sets a rounding mode and does not put it back.
ROUNDING = r"""
#include <fenv.h>
#include <stdlib.h>
#if defined(__x86_64__)
#include <xmmintrin.h>
#endif
__attribute__((constructor)) static void begin(void) {
    const char *mode = getenv("ROUNDING");
    if (!mode) return;
    if (mode[0] == 'u') fesetround(FE_UPWARD);
    if (mode[0] == 'd') fesetround(FE_DOWNWARD);
    if (mode[0] == 'z') fesetround(FE_TOWARDZERO);
#if defined(__x86_64__)
    if (mode[0] == 'f') _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}
"""


@pytest.mark.parametrize("mode", ["flush", "up", "down", "zero"])
def test_rounding_mode(mode: str, folder: Path, tmp_path: Path) -> None:
    """The same bytes, or a refusal that says what is wrong."""
    library = preloaded(tmp_path, ROUNDING)
    wrong = []
    for verb in VERBS:
        first = made(folder, verb)
        cleared(folder, verb)
        told = run(folder, *verb.arguments, environment={"LD_PRELOAD": str(library), "ROUNDING": mode})
        same = told.returncode == 0 and {**stand(folder, verb.written), "printed": told.stdout} == first
        refused = told.returncode == 1 and "rounding" in told.stderr and not any(stand(folder, verb.written).values())
        if not (same or refused):
            wrong.append((verb.name, told.returncode, told.stderr[-300:]))
    assert not wrong, wrong


@EACH
def test_another_build(verb: Verb, folder: Path) -> None:
    """A build of the same sources that POST_OTHER_COMMAND names (that beside this one may be of another day): release
    beside debug, or one for another processor with what it is started by, `qemu-aarch64 -L /usr/aarch64-linux-gnu …/post`."""
    there = shlex.split(os.environ.get("POST_OTHER_COMMAND", ""))
    if not there:
        pytest.skip("no other build is named")
    first = made(folder, verb)
    rows = folder / "rows.csv"
    own = rows.read_text() if verb.name == "batch" else ""
    cleared(folder, verb)
    other = subprocess.run([*there, *verb.arguments], cwd=folder, capture_output=True, text=True)
    assert other.returncode == 0, other.stderr
    found = {**stand(folder, verb.written), "printed": other.stdout}
    if verb.name == "batch":
        # The last column tells the sources apart, which builds of different days do not share.
        assert [line.rsplit(",", 1)[0] for line in rows.read_text().splitlines()] == [
            line.rsplit(",", 1)[0] for line in own.splitlines()
        ]
        found["rows.csv"] = first["rows.csv"]
    assert found == first


# Processors with vectors of 128 bits, with wider ones, and with fused multiplications besides.
PROCESSORS = ["qemu64", "Nehalem", "SandyBridge", "Haswell", "max"]
FUSED = ("Haswell", "max")


def emulator() -> str:
    """Runs the command on processors that this machine does not have."""
    found = tool("qemu-x86_64")
    if found is None:
        pytest.skip("there is no qemu-x86_64 (qemu-user)")
    return found


@EACH
@pytest.mark.parametrize("processor", PROCESSORS)
def test_processor(verb: Verb, processor: str, folder: Path) -> None:
    """Vectors are as wide as the processor has them; the bytes are those of any other."""
    usual = verb.name in ("split", "verify", "predict") and processor in ("qemu64", "Haswell")
    if not usual and not os.environ.get("POST_ROUNDS"):
        pytest.skip("in long runs alone")
    first = made(folder, verb)
    same = made(folder, verb, before=[emulator(), "-cpu", processor]) == first
    if not same and verb.name in ("post", "predict") and processor not in FUSED:
        pytest.xfail("servos are worked out by fused multiplications where the processor has them: digits 11 to 17")
    assert same


@pytest.mark.parametrize("processor", ["qemu64", "Haswell"])
@pytest.mark.parametrize(
    "how",
    [
        "--plan",
        "--plan --plan-rounds 3 --set plan.contour_error=0.005",
        "--compensate-servo --set accuracy.servo_compensation=0.02",
        "--reduce --fit-arcs",
    ],
)
def test_a_program_does_not_hang_on_the_processor(how: str, processor: str, folder: Path) -> None:
    """Nor where its feeds or its points come from a prediction."""
    if (how != "--plan" or processor != "qemu64") and not os.environ.get("POST_ROUNDS"):
        pytest.skip("in long runs alone")
    line = ["part.cls", "-m", "ac-trunnion", "-o", "part.nc", "-q", *how.split()]
    assert run(folder, *line).returncode == 0
    first = (folder / "part.nc").read_bytes()
    assert run(folder, *line, before=[emulator(), "-cpu", processor]).returncode == 0
    assert (folder / "part.nc").read_bytes() == first
