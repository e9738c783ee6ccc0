"""Files of strangers that are made to take all memory, all time or the whole stack: refused by name, and cheaply."""

import os
import resource
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from conftest import CHECKOUT, COMMAND
from fault_parts import often, prepared

MIB = 1 << 20
# What the address space of the command may be: a few texts of a megabyte each, whatever the files are like.
MOST = 512 * MIB

BEGUN = "UNITS/MM\nLOADTL/1\nSPINDL/RPM,3000,CLW\nFEDRAT/MMPM,500\nRAPID\nGOTO/0,0,50\n"
VMC = (CHECKOUT / "machines/vmc.toml").read_text()


def _cl(text: Callable[[int], str]) -> Callable[[Path, int], list[str]]:
    def made(folder: Path, size: int) -> list[str]:
        (folder / "strange.cls").write_text(text(size))
        return ["strange.cls", "-m", "vmc", "-o", "out.nc"]

    return made


def _nc(text: Callable[[int], str], machine: str = "vmc") -> Callable[[Path, int], list[str]]:
    def made(folder: Path, size: int) -> list[str]:
        (folder / "strange.nc").write_text(text(size))
        return ["read", "strange.nc", "-m", machine]

    return made


def _machine(text: Callable[[int], str]) -> Callable[[Path, int], list[str]]:
    def made(folder: Path, size: int) -> list[str]:
        (folder / "strange.toml").write_text(text(size))
        return ["check", "strange.toml"]

    return made


def _tools(name: str, text: Callable[[int], str]) -> Callable[[Path, int], list[str]]:
    def made(folder: Path, size: int) -> list[str]:
        (folder / name).write_text(text(size))
        return ["tools", name]

    return made


CASES: list[tuple[str, str, Callable[[Path, int], list[str]]]] = [
    ("a line without an end", "a record of more than", _cl(lambda size: "GOTO/" + "1" * size)),
    ("a record that goes on and on", "a record of more than", _cl(lambda size: "GOTO/1,$\n" * (size // 9))),
    ("nothing but NUL", "a record of more than", _cl(lambda size: "\0" * size)),
    ("a remark without an end", "a record of more than", _cl(lambda size: BEGUN + "PPRINT " + "x" * size + "\nFINI\n")),
    ("unknown words", "QUUX", _cl(lambda size: "QUUX/1\n" * (size // 7))),
    ("brackets in brackets", "syntax", _cl(lambda size: BEGUN + "GOTO/" + "(" * min(size, MIB // 2))),
    ("places beyond the world", "none is larger than", _cl(lambda size: BEGUN + "GOTO/1e300,0,0\nFINI\n")),
    ("a block without an end", "a block of more than", _nc(lambda size: "G1 X" + "1" * size)),
    ("expressions in expressions", "syntax", _nc(lambda size: "#1=" + "[" * 8000 + "\n")),
    ("a machine file too long", "no machine file is", _machine(lambda size: "#" * (2 * MIB))),
    ("lists in lists", "recurse", _machine(lambda size: "a=" + "[" * (MIB // 2))),
    ("a machine that extends itself", "circle", _machine(lambda size: 'extends = "strange.toml"\n' + VMC)),
    ("objects in objects", "tools", _tools("t.json", lambda size: '{"a":' * (size // 5))),
    ("a row without an end", "tools", _tools("t.tbl", lambda size: "BEGIN TOOL.T MM\nT NAME L R\n1 " + "x" * size)),
]


def bounded(folder: Path, line: list[str], most: int = MOST) -> "subprocess.CompletedProcess[str]":
    """The command with an address space of so many bytes."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (most, most))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return subprocess.run(
        [COMMAND, *line], cwd=folder, capture_output=True, text=True, timeout=60, preexec_fn=limit, errors="replace"
    )


@pytest.mark.parametrize("name, told, make", CASES, ids=[case[0] for case in CASES])
def test_a_file_of_a_stranger_is_refused(
    name: str, told: str, make: Callable[[Path, int], list[str]], tmp_path: Path
) -> None:
    folder = prepared(tmp_path / "work")
    # Longer ones may not take more than shorter ones do.
    made = bounded(folder, make(folder, often(20, 200) * MIB))
    assert made.returncode == 1, (name, made.returncode, made.stderr[-400:])
    assert told in made.stderr and len(made.stderr) < 20_000, (name, made.stderr[-400:])
    assert not (folder / "out.nc").exists()


def test_a_loop_without_an_end_is_given_up(tmp_path: Path) -> None:
    if not os.environ.get("POST_ROUNDS"):
        pytest.skip("two million blocks are read: in long runs alone")
    folder = prepared(tmp_path / "work")
    text = "%\nO1\nWHILE[1EQ1]DO1\nG1X1F100\nEND1\nM30\n%\n"
    (folder / "loop.nc").write_text(text)
    made = bounded(folder, ["read", "loop.nc", "-m", "ac-trunnion"])
    assert made.returncode == 1 and "a loop may never end" in made.stderr, made.stderr[-400:]
