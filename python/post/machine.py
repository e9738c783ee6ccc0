"""A machine: where its tool goes, how its axes get there, and what it makes of a CL file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from post import _native
from post.made import Job

if TYPE_CHECKING:
    from typing_extensions import Unpack

Floats = NDArray[np.float64]
Path = str | os.PathLike[str]
Value = str | bool | int | float | np.integer[Any] | np.floating[Any] | Sequence[float]
"""What a setting can be: as in a machine file; a text may be an expression."""


class Options(TypedDict, total=False):
    """Options of a job, those of the command: ``post --help`` tells what they mean."""

    then: Sequence[str] | None
    operations: Sequence[str | int] | None
    units: Literal["mm", "inch"] | None
    msys: Literal["keep", "apply"] | None
    unknown: Literal["error", "known", "warn", "pass"] | None
    allow: Sequence[str] | None
    tool: int | None
    tool_from_cutter: bool
    spindle: float | Literal["off"] | None
    feed: float | None
    tolerance: float | None
    tcp: Literal["control", "post"] | None
    dialect: str | None
    tools: str | None
    reduce: bool
    fit_arcs: bool
    number: int | None
    compensate_servo: bool
    plan: bool
    plan_rounds: int | None
    jobs: int | None
    trust_model: bool


@dataclass(frozen=True)
class Axis:
    """One axis of a machine."""

    name: str
    rotary: bool
    carries_part: bool
    """It carries the workpiece; else the tool."""
    unit: Literal["mm", "deg"]
    travel: tuple[float, float] | None
    """Least and largest value; none for an axis without ends."""


class Machine:
    """A machine with its settings and a tool in it; :meth:`load` makes one. It never changes, and threads may share it."""

    def __init__(self, native: _native.Machine) -> None:
        self._native = native
        self._axes = tuple(
            Axis(name, rotary, carries_part, unit, travel)
            for name, rotary, carries_part, unit, travel in native.axes()
        )

    @classmethod
    def load(
        cls,
        name: Path,
        *,
        set: Mapping[str, Value] | None = None,
        tool_length: float | None = None,
        mount: Sequence[float] | None = None,
        turn: float | None = None,
        machines: Iterable[Path] = (),
        plugins: Iterable[Path] = (),
    ) -> Machine:
        """Loads a machine: a TOML file, or the name of one in a machine folder or built in.

        ``set`` sets parameters (``{"Lm": 312}``) or any keys (``{"accuracy.tolerance": 0.001}``) over the file;
        ``tool_length`` is that of every tool from the gauge point to the tip, mm; ``mount`` where the part origin sits, all
        axes at zero, machine frame, mm; ``turn`` how the part is turned about its Z, degrees: CL files are turned
        by it as they are posted, and tips and tool axes here and in ``blocks`` are those of the turned part. ``machines`` and
        ``plugins`` are further folders, beside those of ``POST_MACHINES`` and ``POST_PLUGINS``.

        Raises :class:`PostError` where the command would refuse.
        """
        if tool_length is not None and not 0 <= tool_length < float("inf"):
            raise ValueError(f"tool_length is {tool_length}, not a length from 0 up")
        return cls(
            _native.Machine(
                os.fspath(name),
                [(key, written(value)) for key, value in (set or {}).items()],
                None if tool_length is None else float(tool_length),
                None if mount is None else point(mount),
                None if turn is None else float(turn),
                [os.fspath(folder) for folder in machines],
                [os.fspath(folder) for folder in plugins],
            )
        )

    @property
    def name(self) -> str:
        """Its name, as its file gives it."""
        return self._native.name

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Its axes, from the workpiece to the tool: the order of all axis values."""
        return self._axes

    def __repr__(self) -> str:
        return f"<post.Machine {self.name!r}, axes {' '.join(axis.name for axis in self.axes)}>"

    def forward(self, q: ArrayLike) -> tuple[Floats, Floats]:
        """Where tip and tool axis stand for axis values ``q`` (n, k): tips (n, 3), mm, and unit vectors (n, 3)."""
        return self._native.forward(self._values("q", q))

    def inverse(
        self,
        tip: ArrayLike,
        axis: ArrayLike,
        *,
        edge: ArrayLike | None = None,
        near: ArrayLike | None = None,
        within_travel: bool = False,
    ) -> tuple[Floats, NDArray[np.int64]]:
        """All axis values that bring the tool to ``tip`` (n, 3) along ``axis`` (n, 3): ``q`` (n, s, k), with nan where a
        point has fewer than s solutions, and how many each has (n,); 0 where it cannot be reached.

        Every solution is held against the forward product. Axes that a point leaves free stand as in ``near`` (k,).
        Angles are within half a turn of the zero of the machine's drawing; with ``within_travel`` on the turn nearest to
        ``near``, and solutions outside travel are left out. A machine with fewer than two rotary axes points the tool
        within ``accuracy.axis_tolerance``. ``edge`` (n, 3) is the leading edge, for machines whose tool has one.
        """
        tip, axis, edge = self._poses(tip, axis, edge)
        rest = self._native.start() if near is None else near
        stands = np.array(rest, dtype=np.float64, order="C", copy=True)
        if stands.shape != (len(self.axes),):
            raise ValueError(f"near has the shape {stands.shape}, not ({len(self.axes)},)")
        return self._native.inverse(tip, axis, edge, stands, within_travel)

    def route(
        self,
        tip: ArrayLike,
        axis: ArrayLike,
        cut: ArrayLike | bool = True,
        *,
        edge: ArrayLike | None = None,
    ) -> Floats:
        """Axis values (n, k) for a path, chosen over the whole of it as posting does. ``cut`` (n,) says of each point
        whether the tool comes to it cutting, or in a rapid.

        Raises :class:`PostError` where a point cannot be reached or a cut cannot go on; points are counted from 0.
        """
        tip, axis, edge = self._poses(tip, axis, edge)
        cuts = np.array(np.broadcast_to(np.asarray(cut, dtype=np.bool_), tip.shape[:1]), order="C", copy=True)
        return self._native.route(tip, axis, edge, cuts)

    def deviation(self, q0: ArrayLike, q1: ArrayLike, t: ArrayLike = 0.5) -> tuple[Floats, Floats]:
        """How far the tool strays at shares ``t`` (m,) of moves that take all axes linearly from ``q0`` to ``q1``
        (n, k): of the tip from the straight line between its ends (n, m, 3), mm, of the tool axis from its great circle
        (n, m), degrees.
        """
        begin, end = self._values("q0", q0), self._values("q1", q1)
        if begin.shape != end.shape:
            raise ValueError(f"q0 has the shape {begin.shape}, q1 {end.shape}")
        shares = np.array(np.atleast_1d(np.asarray(t, dtype=np.float64)), order="C", copy=True)
        if shares.ndim != 1:
            raise ValueError(f"t has the shape {shares.shape}, not (m,)")
        return self._native.deviation(begin, end, shares)

    def post(
        self,
        path: Path,
        *,
        output: Path | None = None,
        blocks: bool = True,
        **options: Unpack[Options],
    ) -> Job:
        """Posts a CL file as the command does: the same program, letter for letter.

        ``output`` writes the program there, whole or not at all; without it nothing is written. ``blocks=False`` keeps no
        columns of the blocks, some 250 bytes each. Options are those of the command, underscores for hyphens:
        ``tolerance=0.005``, ``allow=["OFSETL"]``, ``plan=True``.

        Raises :class:`PostError` where the command would refuse.
        """
        where = None if output is None else os.fspath(output)
        native = self._native.post(os.fspath(path), where, told(options), blocks)

        def planned(rounds: int | None) -> Job:
            more: Options = {**options, "plan": True, "plan_rounds": rounds}
            return self.post(path, blocks=blocks, **more)

        return Job(native, planned)

    def _values(self, name: str, q: ArrayLike) -> Floats:
        return rows(name, q, len(self.axes))

    def _poses(
        self, tip: ArrayLike, axis: ArrayLike, edge: ArrayLike | None
    ) -> tuple[Floats, Floats, Floats | None]:
        tips = rows("tip", tip, 3)
        axes = along("axis", axis, tips)
        return tips, axes, None if edge is None else along("edge", edge, tips)


def job(
    path: Path,
    *,
    write: bool = False,
    blocks: bool = True,
    **options: Unpack[Options],
) -> list[Job]:
    """Posts the programs of a job file as ``post part.job.toml`` does, in their order.

    With ``write`` each is written where the job file says, or beside its CL file, whole or not at all; without it nothing is
    written. Options go before what the job file says; a program that is made with some has no hash of the job in its head,
    as that of the command.

    Raises :class:`PostError` with the first program that the command would refuse.
    """
    name = os.fspath(path)
    natives = _native.job(name, write, told(options), blocks)

    def planning(number: int) -> Callable[[int | None], Job]:
        def planned(rounds: int | None) -> Job:
            more: Options = {**options, "plan": True, "plan_rounds": rounds}
            return job(name, blocks=blocks, **more)[number]

        return planned

    return [Job(native, planning(number)) for number, native in enumerate(natives)]


def rows(name: str, values: ArrayLike, width: int) -> Floats:
    """An array of float64 in one piece, one row a point; a single row is one point."""
    # Copied: another thread may write to the caller's while Rust reads.
    array = np.array(values, dtype=np.float64, order="C", copy=True)
    if array.ndim == 1 and array.shape == (width,):
        array = array.reshape(1, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} has the shape {np.shape(values)}, not (n, {width})")
    return array


def along(name: str, values: ArrayLike, tips: Floats) -> Floats:
    """Directions of points; a single one is that of all."""
    array = rows(name, values, 3)
    if len(array) == 1 and len(tips) != 1:
        array = np.ascontiguousarray(np.broadcast_to(array, tips.shape))
    if array.shape != tips.shape:
        raise ValueError(f"{name} has the shape {array.shape}, tip {tips.shape}")
    return array


def point(values: Sequence[float]) -> tuple[float, float, float]:
    """Three coordinates."""
    x, y, z = (float(value) for value in values)
    return x, y, z


def written(value: Value) -> str:
    """A value as a machine file has it."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    return f"[{', '.join(written(item) for item in value)}]"


def told(options: Mapping[str, object]) -> list[tuple[str, bool | int | float | str | list[str]]]:
    """Options by their names, as values of Python's own; what is none or false is left out."""
    return [
        (name, plain(name, value)) for name, value in options.items() if value is not None and value is not False
    ]


def plain(name: str, value: object) -> bool | int | float | str | list[str]:
    """A value of an option: numbers of NumPy are numbers, and what can be gone over is a list of texts."""
    if isinstance(value, (np.integer, np.floating)):
        return value.item()
    if isinstance(value, (bool, str, int, float)):
        return value
    if isinstance(value, Iterable):
        return [str(item) for item in value]
    raise TypeError(f"{name} cannot be {value!r}")
