"""The table as a page of the book."""

from __future__ import annotations

import re
import tempfile
import tomllib
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from sixty_one.table import ROWS, Machine
from sixty_one.verdict import CHANNELS, CHECKOUT, HERE, Verdict, judged, posted

PAGE = CHECKOUT / "docs/src/reference/sixty-one.md"
HEAD = """<!-- Written by `PYTHONPATH=python/tests python3 -m sixty_one --table`: edit python/tests/sixty_one -->

# Sixty-one machines

How far "any machine in a TOML file" goes. {count} machines of the trade were written from what their data sheets \
say: a machine file each, `python/tests/sixty_one/NAME.toml`, and beside it, written apart, what who stands at the \
machine sees when a word counts up (`table.py`: tables that turn, heads that swing, by directions and points). Data \
sheets are quoted from memory, as each file says; what no sheet has (where lines cross, how far a pivot is from the \
nose) is assumed. None of these files is fit to run a machine with.

Each machine gets a CL file that fits its freedoms: a dome over which the tool leans, grooves and holes around a bar, \
faces of a column, a contour on a lathe, ways of a knife. `post` writes the program. A reader of words that shares \
nothing with it takes what the program says, a product of matrices that moves bodies (of parallel machines and arms \
what papers and makers publish) takes tip, tool axis and edge from these words, and all points and the ways between \
them are held against the CL file, within what the machine file allows. Where axes and drives went is held against \
the summary. Not looked at: feeds, the ways between cuts, what a control makes of a program.

- **works**: all of it. **in part**: the CL file is met, and what is not is told below. **wrong**: a deviation beyond \
the tolerance; a test fails then (`python/tests/test_sixty_one.py`). It fails as well when this page is not what \
comes out.
- **June**: what was said of the kind when 61 other machines were tried in June 2026: 38 worked, 7 took a detour, 15 \
could not be said, 1 was wrong. The list of them is not kept: "worked" are the kinds of which the report on them says \
so, "missing" is what it named as such.
- Deviations are the largest over all points and ways: of the tip from the CL file's way, mm; of tool axis and edge, \
degrees; of joints from the summary, mm or degrees.

"""
COLUMNS = "| | machine | kind | chain | dialect | words | June | now | points | tip | axis | edge | joints |"


def chain(machine: Machine) -> str:
    """As its file has it."""
    name = f"{machine.name}-{CHANNELS[0][0]}" if machine.second else machine.name
    return str(tomllib.loads((HERE / f"{name}.toml").read_text())["chain"])


def row(number: int, machine: Machine, verdict: Verdict) -> str:
    """A line of the table."""
    edge = "" if verdict.edge is None else f"{verdict.edge:.4f}"
    cells = [
        str(number), machine.model, machine.kind, f"`{chain(machine)}`", machine.dialect, machine.told, machine.before,
        f"**{verdict.says}**" if verdict.says != "works" else verdict.says, str(verdict.points), f"{verdict.tip:.4f}",
        f"{verdict.axis:.4f}", edge, f"{verdict.joints:.4f}",
    ]  # fmt: skip
    return "| " + " | ".join(cells) + " |"


def counted(verdicts: list[str]) -> str:
    """How many of each, in words."""
    counts = Counter(verdicts)
    order = {"works": "work", "in part": "work in part", "refused": "are refused", "wrong": "are wrong"}
    return ", ".join(f"{counts[says]} {word}" for says, word in order.items() if counts[says])


def verdicts() -> list[Verdict]:
    """All of them, posted at once."""

    def one(machine: Machine) -> Verdict:
        with tempfile.TemporaryDirectory() as room:
            return judged(machine, posted(machine, Path(room)))

    with ThreadPoolExecutor() as pool:
        return list(pool.map(one, ROWS))


def text(found: list[Verdict]) -> str:
    """The whole page."""
    lines = [COLUMNS, "|---" * COLUMNS.count(" |") + "|"]
    lines += [row(number, *both) for number, both in enumerate(zip(ROWS, found), 1)]
    short = [f"- {machine.model}: {verdict.why}." for machine, verdict in zip(ROWS, found) if verdict.says != "works"]
    sums = f"Of {len(ROWS)} machines: {counted([verdict.says for verdict in found])}.\n\n"
    tail = ["", "What does not work of those that do not work whole:", "", *short, ""] if short else [""]
    return HEAD.format(count=len(ROWS)) + sums + "\n".join([*lines, *tail])


NUMBER = re.compile(r"\d+\.\d{4}")


def same(one: str, other: str) -> bool:
    """Whether two lines say the same, but for the last two digits of a deviation."""
    if NUMBER.sub("", one) != NUMBER.sub("", other):
        return False
    return all(abs(float(a) - float(b)) < 2e-3 for a, b in zip(NUMBER.findall(one), NUMBER.findall(other)))
