"""A machine: where its tool goes, how its axes get there, and what it makes of a CL file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from post import _native, arguments
from post.arguments import (
    Floats,
    Path,
    Value,
    along,
    floats,
    number_if_any,
    path,
    path_if_any,
    paths,
    point,
    rows,
    settings,
    texts,
    told,
)
from post.made import Found, Job, found
from post.points import PointFile

if TYPE_CHECKING:
    from typing_extensions import Unpack

Loading = tuple[
    str,
    list[tuple[str, str]],
    float | None,
    tuple[float, float, float] | None,
    float | None,
    list[str],
    list[str],
]
"""What a machine is loaded by: arguments of :meth:`Machine.load`."""


class MakingOptions(TypedDict, total=False):
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


class Options(MakingOptions, total=False):
    """The same with the feed of a CL file that names none."""

    feed: float | None


class ReadOptions(TypedDict, total=False):
    """Options of what reads an NC program, those of the command: ``post read --help`` tells what they mean."""

    offsets: Path | None
    tools: Path | None
    dialect: str | None
    most_blocks: int | None


class AgainstOptions(Options, total=False):
    """Options of what holds an NC program against a CL file: ``post verify --help`` tells what they mean."""

    offsets: Path | None


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
    """A machine with its settings and a tool in it; :meth:`load` makes one. It never changes, and threads may share it.
    Pickled it is what it was loaded by: another process loads it again, from the file of that name."""

    def __init__(self, native: _native.Machine, loading: Loading) -> None:
        self._native = native
        self._loading = loading
        self._axes = tuple(
            Axis(name, rotary, carries_part, unit, None if travel is None else (travel[0], travel[1]))
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
        length = number_if_any("tool_length", tool_length)
        if length is not None and not 0 <= length < float("inf"):
            raise ValueError(f"tool_length is {tool_length}, not a length from 0 up")
        return cls._loaded(
            path("name", name),
            settings("set", set),
            length,
            None if mount is None else point("mount", mount),
            number_if_any("turn", turn),
            paths("machines", machines),
            paths("plugins", plugins),
        )

    @classmethod
    def _loaded(cls, *loading: Unpack[Loading]) -> Machine:
        return cls(_native.Machine(*loading), loading)

    def __reduce__(self) -> tuple[Callable[..., Machine], tuple[object, ...]]:
        name, *more = self._loading
        # Another process may stand in another folder.
        name = os.path.abspath(name) if os.path.isfile(name) else name
        folders = [[os.path.abspath(folder) for folder in given] for given in self._loading[-2:]]
        return Machine._loaded, (name, *more[:-2], *folders)

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
        shares = np.atleast_1d(floats("t", t))
        if shares.ndim != 1:
            raise ValueError(f"t has the shape {shares.shape}, not (m,)")
        return self._native.deviation(begin, end, shares)

    def post(
        self,
        path: Path | None = None,
        *,
        points: ArrayLike | None = None,
        axes: ArrayLike = (0, 0, 1),
        feed: ArrayLike | None = None,
        cut: ArrayLike | None = None,
        output: Path | None = None,
        blocks: bool = True,
        **options: Unpack[MakingOptions],
    ) -> Job:
        """Posts a CL file as the command does: the same program, letter for letter.

        In the place of the file ``points`` (n, 3) are tips, mm, part frame, with their tool ``axes`` (n, 3) or one for all,
        and ``feed`` (n,), mm/min, by which the tool comes to each, or one for all. ``cut`` (n,) says of each whether it comes
        cutting, or in a rapid; without it only the first is come to in a rapid. They become a list of points
        in CSV, to the last digit, which is kept as long as the job is: in messages the first point is on line 2. ``tool=1, spindle=6000`` say
        the rest.

        ``output`` writes the program there, whole or not at all; without it nothing is written. ``blocks=False`` keeps no
        columns of the blocks, some 250 bytes each. Options are those of the command, underscores for hyphens:
        ``tolerance=0.005``, ``allow=["OFSETL"]``, ``plan=True``.

        Raises :class:`PostError` where the command would refuse.
        """
        if (path is None) == (points is None):
            raise TypeError("post takes either a path or points")
        listed = None if points is None else PointFile(points, axes, feed, cut)
        all_options: dict[str, object] = {**options}
        if listed is None:
            all_options["feed"] = feed
        name = listed.path if listed else arguments.path("path", path)
        where = path_if_any("output", output)
        native = self._native.post(name, where, told(all_options), blocks)

        def planned(rounds: int | None) -> Job:
            more = {**all_options, "plan": True, "plan_rounds": rounds}
            return Job(self._native.post(name, None, told(more), blocks), planned, listed)

        return Job(native, planned, listed)

    def read(
        self,
        program: Path,
        *,
        csv: Path | None = None,
        cl: Path | None = None,
        **options: Unpack[ReadOptions],
    ) -> Found:
        """Reads any NC program as its control does, as ``post read``: ``found.summary`` has blocks, motions, times, the least
        and largest value of each axis, tools, and words that are not known. ``csv`` writes the table of its motions there,
        ``cl`` its path as a CL file.

        Raises :class:`PostError` if a block is not understood, or an axis leaves its travel.
        """
        csv, cl = path_if_any("csv", csv), path_if_any("cl", cl)
        return found(self._native.read(path("program", program), csv, cl, told(options)))

    def verify(
        self,
        program: Path,
        against: Path,
        *,
        axis_tolerance: float | None = None,
        posted: bool = False,
        planned: bool = False,
        clearance: bool = False,
        **options: Unpack[AgainstOptions],
    ) -> Found:
        """Holds any NC program against the CL file ``against``, as ``post verify``. ``axis_tolerance`` is how far the tool
        axis may stray in a cut, degrees; ``posted`` says that the program was posted for this machine file, ``planned``
        that its feed was planned, and ``clearance`` proves besides that nothing hits anything.

        Raises :class:`PostError` if it does not do what the CL file asks for.
        """
        return found(
            self._native.verify(
                path("program", program),
                path("against", against),
                number_if_any("axis_tolerance", axis_tolerance),
                bool(posted),
                bool(planned),
                bool(clearance),
                told(options),
            )
        )

    def predict(
        self,
        program: Path,
        against: Path | None = None,
        *,
        period: float | None = None,
        **options: Unpack[AgainstOptions],
    ) -> Found:
        """Predicts what any NC program does on this machine, as ``post predict``: cycle time, true feed, and how far the tool
        strays; ``against`` is the CL file that it was made from, ``period`` the time between set-points, s, over that of
        the machine file.

        Raises :class:`PostError` if a block is not understood.
        """
        against = path_if_any("against", against)
        seconds = number_if_any("period", period)
        return found(self._native.predict(path("program", program), against, seconds, told(options)))

    def lint(
        self,
        program: Path,
        *,
        ignore: Iterable[str] = (),
        strict: bool = False,
        **options: Unpack[ReadOptions],
    ) -> Found:
        """Looks over any NC program, as ``post lint``: ``found.warnings`` are what may be wrong. Findings of the codes in
        ``ignore`` are only counted.

        Raises :class:`PostError` if something is wrong, or, where ``strict``, may be; its ``diagnostics`` are all findings.
        """
        codes = texts("ignore", ignore)
        return found(self._native.lint(path("program", program), codes, bool(strict), told(options)))

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
    name = arguments.path("path", path)
    natives = _native.job(name, write, told(options), blocks)

    def planning(number: int) -> Callable[[int | None], Job]:
        def planned(rounds: int | None) -> Job:
            more: Options = {**options, "plan": True, "plan_rounds": rounds}
            return job(name, blocks=blocks, **more)[number]

        return planned

    return [Job(native, planning(number)) for number, native in enumerate(natives)]
