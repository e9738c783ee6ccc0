"""What the measurements share: the commands that are built, and how one says that it cannot be made here."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NoReturn

CHECKOUT = Path(__file__).parents[2]
ABSENT = 3
"""The exit code of a measurement that cannot be made here; its last line on standard error says what is missing."""


def absent(what: str) -> NoReturn:
    print(what, file=sys.stderr)
    sys.exit(ABSENT)


def command(name: str) -> str:
    """`post` or `papers`, as PATH has it."""
    found = shutil.which(name)
    if found is None:
        absent(f"{name} is not on PATH")
    return found


def run(*words: str | Path, accepted: tuple[int, ...] = (0,), **more: str) -> "subprocess.CompletedProcess[str]":
    """Runs a command in the checkout; any other exit code than these ends the measurement."""
    environment = {**os.environ, **more}
    done = subprocess.run(words, cwd=CHECKOUT, env=environment, capture_output=True, text=True)
    if done.returncode not in accepted:
        sys.exit(f"{' '.join(map(str, words))}: {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return done


def cuts(program: str) -> Iterator[list[dict[str, float]]]:
    """The runs of cuts between two rapids, of a plain program in axis positions (no loops, no arcs): of each cut all words
    in force, G as it was said last."""
    words: dict[str, float] = {}
    pending: list[dict[str, float]] = []
    for line in program.splitlines():
        block = re.findall(r"([A-Z])\s*([-+]?[0-9]*\.?[0-9]+)", re.sub(r"\(.*?\)|;.*", "", line))
        for letter, value in block:
            if letter != "G" or float(value) in (0, 1):
                words[letter] = float(value)
        if not any(letter in "XYZABC" for letter, _ in block):
            continue
        if words.get("G") == 1:
            pending.append(dict(words))
        elif pending:
            yield pending
            pending = []
    if pending:
        yield pending
