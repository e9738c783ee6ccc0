"""A program that was made, and what can be asked of it."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from post import _native, arguments
from post.arguments import Path
from post.refusal import Diagnostic, Told, diagnostics

if TYPE_CHECKING:
    import pyarrow

    from post.points import PointFile

Summary = dict[str, Any]
"""What JSON of the command tells; its keys are in the command's README."""

_WORDS = ("kind", "reason", "limit")
"""Columns that are words: numbers of which come from Rust, -1 for none."""


class Blocks(dict[str, NDArray[Any]]):
    """The blocks of a program as columns of one value a block: ``pandas.DataFrame(blocks)``, ``polars.DataFrame(blocks)``,
    :meth:`to_arrow`, and whatever else takes an Arrow stream. Coordinates and axis values are columns of their own,
    ``q_X``, ``tip_x``, ``axis_z``; ``blocks["q"]``, ``blocks["tip"]`` and ``blocks["axis"]`` are these side by side.

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
        self._words = {name: tuple(told.pop(f"{name}s")) for name in _WORDS}
        self._places = {name: told[name] for name in _WORDS}
        self._sets: dict[str, NDArray[Any]] = {}
        super().__init__()
        for name, values in told.items():
            if name in _WORDS:
                # The last stands for none: numpy counts -1 from the end.
                self[name] = np.array([*self._words[name], ""])[values]
            elif values.ndim == 1:
                self[name] = values
            else:
                self._sets[name] = values
                parts = self.axes if name == "q" else ("x", "y", "z")
                self.update({f"{name}_{part}": values[:, place] for place, part in enumerate(parts)})

    def __missing__(self, name: str) -> NDArray[Any]:
        return self._sets[name]

    def to_arrow(self) -> pyarrow.Table:
        """The table for pyarrow, which the extra ``nc-post[arrow]`` installs; words are dictionaries, and none is null."""
        import pyarrow

        def column(name: str, values: NDArray[Any]) -> Any:
            if name not in _WORDS:
                return pyarrow.array(np.ascontiguousarray(values))
            places = self._places[name].astype(np.int32)
            places = pyarrow.array(places, mask=places < 0)
            words = pyarrow.array(self._words[name], pyarrow.string())
            return pyarrow.DictionaryArray.from_arrays(places, words)

        return pyarrow.table({name: column(name, values) for name, values in self.items()})

    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object:
        """The table for whatever takes Arrow (its PyCapsule interface); pyarrow makes it."""
        return self.to_arrow().__arrow_c_stream__(requested_schema)

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

    def __init__(
        self, native: _native.Job, planned: Callable[[int | None], Job], listed: PointFile | None = None
    ) -> None:
        self._native = native
        # Its CL file is there as long as the job.
        self._listed = listed
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
        return found(self._native.predict(arguments.number_if_any("period", period)))

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
        self._native.report(arguments.path("path", path), verify, clearance, predict, max_mb)


def found(told: tuple[str, list[Told]]) -> Found:
    """What Rust tells."""
    text, warnings = told
    return Found(text, diagnostics(warnings))
