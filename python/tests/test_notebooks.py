"""The notebooks run from their first cell to their last, in the packages that they are about; without these they are skipped."""

from __future__ import annotations

import json
import pathlib
from typing import Any

import pytest

BOOKS = sorted((pathlib.Path(__file__).parent.parent / "notebooks").glob("*.ipynb"))


def cells(book: pathlib.Path) -> list[str]:
    """The text of the cells that are run."""
    told = json.loads(book.read_text(encoding="utf-8"))
    return ["".join(cell["source"]) for cell in told["cells"] if cell["cell_type"] == "code"]


@pytest.mark.parametrize("book", BOOKS, ids=lambda book: book.stem)
def test_a_notebook_runs(book: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip(book.stem, reason=f"{book.stem} is not installed")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "__main__"}
    for place, cell in enumerate(cells(book)):
        exec(compile(cell, f"{book.name}, cell {place + 1}", "exec"), names)
    assert names["found"].summary["holds"]


def test_there_are_notebooks_without_output() -> None:
    assert [book.stem for book in BOOKS] == ["compas", "opencamlib"]
    for book in BOOKS:
        told = json.loads(book.read_text(encoding="utf-8"))
        assert all(not cell.get("outputs") for cell in told["cells"]), book.name
