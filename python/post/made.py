"""A program that was made, and what can be asked of it."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from post import _native
from post.refusal import Diagnostic, Told, diagnostics

if TYPE_CHECKING:
    from post.machine import Floats, Path

Summary = dict[str, Any]
"""What JSON of the command tells; its keys are in the command's README."""


class Blocks(Mapping[str, NDArray[Any]]):
    """The blocks of a program as columns: ``blocks["time_s"]``, one row a block; ``dict(blocks)`` has them all.

    ======================= =========================================================================================
    ``nc_line``             line of the program; 0 of a block that prints nothing
    ``cl_line``             line of the CL file
    ``kind``                how the tool comes to its end: position, reference, rapid, linear, arc, spline or hole
    ``reason``              why it is there: point, eased, put_in, leave, stage, rewind, feed, above or at_once
    ``limit``               what made it slower than asked; empty where nothing did
    ``off_part``            the tolerance of a rapid was enough for it
    ``q``                   axis values at its end, as printed: (n, k), mm and degrees, in the order of :attr:`axes`
    ``tip``                 where the tip comes to stand: (n, 3), mm, part frame
    ``axis``                the tool axis there: (n, 3)
    ``time_s``              when it ends; dwells counted in
    ``way_mm``              way of the tip
    ``tip_deviation_mm``    certified: how far the tip strays from the CL path at most
    ``axis_deviation_deg``  certified: how far the tool axis strays at most
    ``feed_mm_min``         feed of the tip; nan where the block has none
    ``asked_feed_mm_min``   the feed that the CL file asks for; nan in a rapid
    ======================= =========================================================================================
    """

    axes: tuple[str, ...]
    """Names of the axes of all heads: the columns of ``q``."""

    def __init__(self, told: dict[str, Any]) -> None:
        self.axes = tuple(told.pop("axes"))
        for column, names in (("kind", "kinds"), ("reason", "reasons")):
            told[column] = np.array(told.pop(names))[told[column]]
        # The last stands for none: numpy counts -1 from the end.
        told["limit"] = np.array([*told["limits"], ""])[told["limit"]]
        del told["limits"]
        self._columns: dict[str, NDArray[Any]] = told

    def __getitem__(self, column: str) -> NDArray[Any]:
        return self._columns[column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """How many columns there are; ``len(blocks["time_s"])`` is how many blocks."""
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<post.Blocks {len(self['time_s'])} blocks, {', '.join(self)}>"


@dataclass(frozen=True)
class Found:
    """What reading a program back, or predicting it, has found."""

    json: str
    """The bytes that ``--summary`` of ``post verify`` or ``post predict`` writes; of clearance what that of ``post
    --clearance`` has under that key."""
    warnings: tuple[Diagnostic, ...]

    @cached_property
    def summary(self) -> Summary:
        """The same as values."""
        summary: Summary = json.loads(self.json)
        return summary


class Job:
    """A CL file that was posted; :meth:`post.Machine.post` makes one. The CL file and the machine file must still be as
    they were when more is asked of it."""

    def __init__(self, native: _native.Job, planned: Callable[[int | None], Job]) -> None:
        self._native = native
        self._planned = planned

    def __repr__(self) -> str:
        return f"<post.Job {self.name!r}, {self.summary['blocks']} blocks>"

    @property
    def name(self) -> str:
        """Where the program is, or would be, written."""
        return self._native.name()

    @cached_property
    def nc(self) -> str:
        """The text of the program."""
        return self._native.nc()

    @property
    def json(self) -> str:
        """The summary, the bytes that ``--summary`` writes."""
        return self._native.summary()

    @cached_property
    def summary(self) -> Summary:
        """The summary as values."""
        summary: Summary = json.loads(self.json)
        return summary

    @cached_property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What the user should know before the program runs."""
        return diagnostics(self._native.warnings())

    @cached_property
    def blocks(self) -> Blocks:
        """Its blocks as columns."""
        told = self._native.blocks()
        if told is None:
            raise AttributeError("the blocks were not kept: post with blocks=True")
        return Blocks(told)

    def verify(self) -> Found:
        """Reads the program back, runs it as the control does, and holds it against the CL file, as ``post verify``.

        Raises :class:`PostError` if it does not do what the CL file asks for.
        """
        return found(self._native.verify())

    def clearance(self) -> Found:
        """Proves that nothing hits anything while the program runs, as ``post clearance --cl`` with the CL file: the bodies
        of the machine file are held against one another along all motions. ``found.summary["pairs"]`` has of each pair
        what it is proven to be apart.

        Raises :class:`PostError` if something is not clear.
        """
        return found(self._native.clearance())

    def predict(self, period: float | None = None) -> Found:
        """Predicts what the program does on its machine, as ``post predict --against`` the CL file: cycle time, true feed,
        and how far the tool strays. ``period`` is the time between set-points, s, over that of the machine file.
        """
        return found(self._native.predict(period))

    def plan(self, rounds: int | None = None) -> Job:
        """The same job with its feed planned (``--plan``, ``--plan-rounds``)."""
        return self._planned(rounds)

    def report(
        self,
        path: Path,
        *,
        verify: bool = False,
        clearance: bool = False,
        predict: bool = False,
        max_mb: int = 64,
    ) -> None:
        """Writes a page to look at, one HTML file that any browser shows from the disk, as ``--report``; with what
        ``--verify``, ``--clearance`` and ``--predict`` find, if they are asked for. The program is made once more for it.
        """
        self._native.report(os.fspath(path), verify, clearance, predict, max_mb)


def found(told: tuple[str, list[Told]]) -> Found:
    """What Rust tells."""
    text, warnings = told
    return Found(text, diagnostics(warnings))
