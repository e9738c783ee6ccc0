"""Makes the page of comparisons: `docs/comparisons` calls it, and says how."""

import os
import re
import subprocess
import sys
import tomllib
from dataclasses import dataclass, field
from pathlib import Path

from measuring import ABSENT, CHECKOUT

ROWS = Path(__file__).with_name("rows.toml")
HEAD = Path(__file__).with_name("head.md")
PAGE = CHECKOUT / "docs/src/reference/comparisons.md"
NOT_RUN = "not run here"
HEADER = "| | what | there | here |"


@dataclass(frozen=True)
class Row:
    """One comparison: what somebody else has published, and the command that tells what comes out here.

    `finds` are patterns of what the command prints; their groups fill in `shows`, and `there` where it runs both.
    """

    name: str
    what: str
    there: str
    source: str
    command: str
    finds: list[str]
    shows: str
    alike: str
    needs: list[str] = field(default_factory=list)
    slow: bool = False


@dataclass(frozen=True)
class Section:
    title: str
    text: str
    row: list[Row]


@dataclass(frozen=True)
class Figures:
    """What stands in the two columns."""

    there: str
    here: str


@dataclass(frozen=True)
class Absent:
    """Why a row cannot be run here."""

    why: str


def sections() -> list[Section]:
    table = tomllib.loads(ROWS.read_text())
    return [
        Section(part["title"], part["text"].strip(), [Row(**row) for row in part["row"]]) for part in table["section"]
    ]


class Runs:
    """The commands, each run once however many rows have it."""

    def __init__(self) -> None:
        given = os.environ.get("POST_COMMAND")
        folders = [Path(given).resolve().parent] if given else [CHECKOUT / f"target/{kind}" for kind in ("release", "debug")]
        folder = next((path for path in folders if (path / "post").is_file()), None)
        if folder is None:
            sys.exit("post is not built: cargo build --workspace, or POST_COMMAND names it")
        # python3 is the one that runs this.
        path = os.pathsep.join([str(folder), str(Path(sys.executable).parent), os.environ["PATH"]])
        self.environment = {**os.environ, "PATH": path, "PYTHONDONTWRITEBYTECODE": "1"}
        self.folder = folder
        self.said: dict[str, str | Absent] = {}

    def output(self, row: Row) -> str | Absent:
        for path in row.needs:
            if not (CHECKOUT / path).exists():
                return Absent(f"{path} is not there")
        if row.command.startswith("papers ") and not (self.folder / "papers").is_file():
            return Absent("papers is not built (cargo build -p post-papers)")
        if row.command not in self.said:
            print(f"$ {row.command}", file=sys.stderr, flush=True)
            done = subprocess.run(
                ["bash", "-c", row.command], cwd=CHECKOUT, env=self.environment, capture_output=True, text=True
            )
            if done.returncode == ABSENT:
                self.said[row.command] = Absent(done.stderr.strip().splitlines()[-1])
            elif done.returncode:
                sys.exit(f"{row.name}: {row.command}: {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
            else:
                self.said[row.command] = done.stdout
        return self.said[row.command]

    def figures(self, row: Row) -> Figures | Absent:
        said = self.output(row)
        if isinstance(said, Absent):
            return said
        groups: list[str] = []
        for pattern in row.finds:
            found = re.search(pattern, said, re.MULTILINE)
            if found is None:
                sys.exit(f"{row.name}: {pattern} is not in what {row.command} prints:\n{said}")
            groups += [(group or "").strip() for group in found.groups()]
        return Figures(row.there.format(*groups), row.shows.format(*groups))


def line(number: int, row: Row, made: Figures | Absent) -> str:
    """The row of the table, with the number that it has below it."""
    if isinstance(made, Absent):
        made = Figures(NOT_RUN if "{" in row.there else row.there, f"{NOT_RUN}: {made.why}")
    return f"| {number} | {row.what} | {made.there} ({row.source}) | {made.here} |"


def below(number: int, row: Row) -> str:
    """What stands below the table: what is like for like, and the command."""
    return f"{number}. {row.alike}\n\n   ```text\n   {row.command}\n   ```\n"


def page(parts: list[Section], runs: Runs) -> str:
    text = [HEAD.read_text().rstrip(), ""]
    for part in parts:
        text += [f"## {part.title}", "", part.text, "", HEADER, "|---|---|---|---|"]
        text += [line(number, row, runs.figures(row)) for number, row in enumerate(part.row, 1)] + [""]
        text += [below(number, row) for number, row in enumerate(part.row, 1)]
    return "\n".join(text)


def check(parts: list[Section], asked: list[str], runs: Runs) -> list[str]:
    """What of the committed page is not what comes out; of rows that are not asked or cannot be run, all but the figures."""
    text = PAGE.read_text()
    lines = text.splitlines()
    wrong = [] if text.startswith(HEAD.read_text()) else ["the page has another head than head.md"]
    for part in parts:
        if f"## {part.title}\n\n{part.text}\n" not in text:
            wrong.append(f"the page has another text than {part.title}")
        for number, row in enumerate(part.row, 1):
            made = runs.figures(row) if row.name in asked else Absent("not asked")
            if isinstance(made, Absent):
                if row.name in asked:
                    print(f"{row.name}: {NOT_RUN}: {made.why}")
                ends = line(number, row, Figures("\0", "\0")).split("\0")
                held = any(each.startswith(ends[0]) and ends[1] in each and each.endswith(ends[2]) for each in lines)
            else:
                held = line(number, row, made) in lines
            if not held or below(number, row) not in text:
                wrong.append(f"{row.name}: the page has another row than\n{line(number, row, made)}")
    tables = sum(1 for each in lines if re.match(r"\| \d", each))
    if tables != (count := sum(len(part.row) for part in parts)):
        wrong.append(f"the page has {tables} rows, rows.toml has {count}")
    return wrong


def main() -> None:
    words = sys.argv[1:]
    parts, runs = sections(), Runs()
    rows = [row for part in parts for row in part.row]
    names = [word for word in words if not word.startswith("-")]
    for name in names:
        if name not in {row.name for row in rows}:
            sys.exit(f"there is no row {name}: {', '.join(row.name for row in rows)}")
    if "--check" in words:
        wrong = check(parts, names or [row.name for row in rows if not row.slow], runs)
        sys.exit("\n".join(["docs/comparisons writes the page anew", *wrong]) if wrong else 0)
    if names:
        for part in parts:
            for number, row in enumerate(part.row, 1):
                if row.name in names:
                    print(line(number, row, runs.figures(row)))
        return
    text = page(parts, runs)
    PAGE.write_text(text)
    print(f"{PAGE.relative_to(CHECKOUT)} is written; rows not run here: {text.count(f'| {NOT_RUN}: ')}")


if __name__ == "__main__":
    main()
