"""Many CL files on many machines with many settings: a row each."""

from __future__ import annotations

import itertools
import json
import os
import sys
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from post import _native
from post.arguments import Path, path, path_if_any, paths, settings, told, written
from post.refusal import Diagnostic, PostError

if TYPE_CHECKING:
    import pyarrow

Options = list[tuple[str, bool | int | float | str | list[str]]]
"""Options of all jobs, by their names."""

Progress = Callable[[int, int, int], None]
"""Is told how many jobs are done, of how many, and how many of them are not written."""

GROUP_SECONDS = 0.25
"""So long a task of Ray shall compute: handing one over costs about a millisecond, so 50 ms are the least worth it."""

IN_FLIGHT = 3
"""Tasks that wait or run, for each processor."""

# In the order of `post batch`, after the keys of the machine file: grid key, key of a job.
_SETTINGS = ("mount", "turn", "tool_length", "tolerance", "tcp", "dialect")


class Study:
    """What came of a study, a row a job, in the order of the jobs."""

    def __init__(self, native: _native.Study) -> None:
        self._native = native

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns by their names: numbers as float64 (nan where there is none), counts as int64 (float64 with nan if one
        is missing), texts as arrays of ``str`` and None."""
        return {
            name: values if isinstance(values, np.ndarray) else _texts(values)
            for name, values in self._native.columns()
        }

    @property
    def failures(self) -> list[dict[str, Any]]:
        """The rows that are not written, as dictionaries of what has a value: ``codes`` and ``message`` say why."""
        columns = self.columns
        rows = np.flatnonzero(columns["state"] != "written")
        return [
            {name: values[row] for name, values in columns.items() if _there(values[row])}
            for row in rows
        ]

    def __len__(self) -> int:
        return self._native.count()

    def __repr__(self) -> str:
        states, counts = np.unique(self.columns["state"].astype(str), return_counts=True)
        told = ", ".join(f"{count} {state}" for state, count in zip(states, counts))
        return f"<post.Study of {len(self)} jobs: {told}>"

    def to_arrow(self) -> pyarrow.Table:
        """The table for pyarrow, which the extra ``nc-post[arrow]`` installs."""
        import pyarrow
        import pyarrow.parquet

        return pyarrow.parquet.read_table(pyarrow.BufferReader(self._native.bytes("parquet")))

    def to_parquet(self, path: Path) -> None:
        """Writes the table as Parquet; the bytes are those of ``post batch`` for the same jobs."""
        name = os.fspath(path)
        if not name.lower().endswith(".parquet"):
            raise ValueError(f"{name} does not end in .parquet")
        self._native.write(name)

    def write(self, path: Path) -> None:
        """Writes the table as its name ends: ``.parquet``, ``.csv`` or ``.jsonl``."""
        self._native.write(os.fspath(path))


def study(
    files: Path | Iterable[Path],
    machines: Path | Iterable[Path] = (),
    grid: Mapping[str, Any] | None = None,
    *,
    jobs: Iterable[Mapping[str, Any]] = (),
    engine: Literal["threads", "ray"] = "threads",
    workers: int | None = None,
    resume: Path | None = None,
    verify: bool = False,
    clearance: bool = False,
    predict: bool = False,
    plan: bool = False,
    trust_model: bool = False,
    timings: bool = False,
    units: Literal["mm", "inch"] | None = None,
    msys: Literal["keep", "apply"] | None = None,
    unknown: Literal["error", "known", "warn", "pass"] | None = None,
    allow: Iterable[str] = (),
    tool: int | None = None,
    tool_from_cutter: bool = False,
    spindle: float | Literal["off"] | None = None,
    feed: float | None = None,
    machine_folders: Iterable[Path] = (),
    plugins: Iterable[Path] = (),
    progress: Progress | bool = True,
) -> Study:
    """Posts every file on every machine with every combination of the values in ``grid``.

    ``grid`` has for each key a value or a list of them: ``mount`` (points, mm), ``turn`` (degrees), ``tool_length``,
    ``tolerance`` (mm), ``tcp``, ``dialect``; any other key is a parameter of the machine (``Lm``) or a key of its file
    (``accuracy.placement``). ``jobs`` are further ones, as dictionaries with ``file``, ``machine``, ``set`` and those keys,
    over which the grid is laid where they say nothing.

    ``engine="threads"`` works on ``workers`` threads of this process. ``engine="ray"`` works on the Ray cluster that is
    connected, or on a local one with ``workers`` processors: CL files and machine files go there by content, so that no node
    needs a folder of them (libraries of ``plugins``, and with ``clearance`` STL files of bodies, must be on every node, under the same path). The results are the
    same, to the byte.

    A job that is refused is a row. ``resume`` names a file that keeps what is done, by content: what is in it is not done
    again. An interrupt (Ctrl-C) ends the study; what was done until then is in ``resume``.
    """
    seeds: list[dict[str, Any]] = [{"file": file} for file in _paths("files", files)]
    names = _paths("machines", machines)
    seeds += [_job(job) for job in jobs]
    told_jobs = [job for seed in seeds for job in _laid(seed, names, grid or {})]
    for job in told_jobs:
        if "machine" not in job:
            message = f"no machine is named for {job['file']}"
            raise PostError([Diagnostic("error", "machine", message, "machines names some for all jobs")])
    lines = "".join(json.dumps(job) + "\n" for job in told_jobs)
    options = told(
        {
            "verify": verify,
            "clearance": clearance,
            "predict": predict,
            "plan": plan,
            "trust_model": trust_model,
            "timings": timings,
            "tool_from_cutter": tool_from_cutter,
            "units": units,
            "msys": msys,
            "unknown": unknown,
            "tool": tool,
            "spindle": spindle,
            "feed": feed,
            "allow": allow,
            "machines": paths("machine_folders", machine_folders),
            "plugins": paths("plugins", plugins),
        }
    )
    native = _native.Study(lines, options, path_if_any("resume", resume))
    shown = _Told(native, progress)
    try:
        if engine == "threads":
            native.run(workers, shown)
        elif engine == "ray":
            _on_ray(native, options, workers, shown)
        else:
            raise ValueError(f"engine is {engine!r}, neither 'threads' nor 'ray'")
    finally:
        shown.end()
    return Study(native)


def _paths(name: str, given: Path | Iterable[Path]) -> list[str]:
    """One file or folder, or several."""
    return [path(name, given)] if isinstance(given, (str, os.PathLike)) else paths(name, given)


def _job(job: Mapping[str, Any]) -> dict[str, Any]:
    """A job as its line has it: paths as texts, numbers with their digits."""
    told: dict[str, Any] = {}
    for key, value in job.items():
        if key in ("file", "machine"):
            told[key] = path(key, value)
        elif key == "set":
            told[key] = dict(settings(key, value))
        elif key in _SETTINGS:
            told[key] = _setting(key, value)
        else:
            raise ValueError(f"a job has no {key!r}: keys of the machine file go under 'set'")
    return told


def _setting(key: str, value: Any) -> Any:
    if key == "mount":
        x, y, z = value
        return [written(key, part) for part in (x, y, z)]
    return written(key, value)


def _laid(seed: dict[str, Any], machines: Sequence[str], grid: Mapping[str, Any]) -> Iterable[dict[str, Any]]:
    """The jobs of a file with every value of the grid, in the order of `post batch`."""
    ways: list[list[tuple[str, str | None, Any]]] = []
    if machines and "machine" not in seed:
        ways.append([("machine", None, machine) for machine in machines])
    said = seed.get("set", {})
    for key, values in grid.items():
        if key not in _SETTINGS and key not in said:
            ways.append([("set", key, written(f"grid[{key!r}]", value)) for value in _values(values)])
    for key in _SETTINGS:
        if key in grid and key not in seed:
            values = grid[key]
            if key == "mount" and len(values) == 3 and not np.ndim(values[0]):
                values = [values]
            ways.append([(key, None, _setting(key, value)) for value in _values(values)])
    for chosen in itertools.product(*ways):
        job = {**seed, "set": dict(said)}
        for place, name, value in chosen:
            if name is None:
                job[place] = value
            else:
                job["set"][name] = value
        yield job


def _values(values: Any) -> list[Any]:
    """The values of a key: a text or a number is one."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        return [values]
    return list(values)


def _texts(values: list[str | None]) -> NDArray[Any]:
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array


def _there(value: Any) -> bool:
    return value is not None and value == value


class _Told:
    """How far a study has come, for whoever is told."""

    def __init__(self, native: _native.Study, progress: Progress | bool) -> None:
        self.count = native.count()
        self.known = self.count - len(native.open())
        self.progress = progress
        self.shown = False
        self.last = 0.0

    def __call__(self, done: int, refused: int) -> None:
        done += self.known
        if callable(self.progress):
            self.progress(done, self.count, refused)
            return
        now = time.monotonic()
        if not self.progress or not sys.stderr.isatty() or now - self.last < 0.2:
            return
        self.last = now
        self.shown = True
        print(f"\r{done} of {self.count} jobs, {refused} refused", end="", file=sys.stderr, flush=True)

    def end(self) -> None:
        if self.shown:
            print(f"\r{'':60}\r", end="", file=sys.stderr, flush=True)


def _part(lines: str, options: Options, machines: str, names: list[str], *files: bytes) -> tuple[float, list[str]]:
    """What a worker of Ray does: some jobs, and how long they took."""
    begun = time.perf_counter()
    outcomes = _native.run_part(lines, options, list(zip(names, files)), machines, 1)
    return time.perf_counter() - begun, outcomes


def _on_ray(native: _native.Study, options: Options, workers: int | None, told: _Told) -> None:
    """Hands the jobs out to a cluster, in groups that take long enough, until all are back."""
    import ray

    if not ray.is_initialized():
        ray.init(num_cpus=workers, log_to_driver=False, include_dashboard=False)
    part = ray.remote(max_retries=0)(_part)
    machines = ray.put(native.machines())
    waiting = deque((number, file, line) for number, (file, line) in _numbered(native))
    contents: dict[str, Any] = {}
    flying: dict[Any, list[tuple[int, str, str]]] = {}
    size = 1
    done = refused = 0
    try:
        while waiting or flying:
            resources = ray.cluster_resources()  # type: ignore[no-untyped-call, unused-ignore]
            at_once = IN_FLIGHT * max(1, int(resources.get("CPU", 1)))
            while waiting and len(flying) < at_once:
                # Towards the end smaller groups, so that none waits for the last.
                fair = max(1, len(waiting) // at_once)
                group = [waiting.popleft() for _ in range(min(size, fair, len(waiting)))]
                flying[_sent(part, machines, options, contents, group)] = group
            ready, _ = ray.wait(list(flying), timeout=0.2)
            for task in ready:
                group = flying.pop(task)
                numbers = [number for number, _, _ in group]
                try:
                    seconds, outcomes = ray.get(task)
                except ray.exceptions.RayTaskError:
                    raise
                except ray.exceptions.RayError as fault:
                    # The process ended under its jobs: one of them did it.
                    if len(group) > 1:
                        flying.update((_sent(part, machines, options, contents, [job]), [job]) for job in group)
                        continue
                    message = f"the process that did this job ended: {type(fault).__name__}"
                    native.lost(numbers[0], "worker", message)
                    refused += 1
                else:
                    refused += native.take(numbers, outcomes)
                    each = max(seconds / len(group), 1e-6)
                    size = max(1, min(int(GROUP_SECONDS / each), 2 * size, 1000))
                done += len(group)
            told(done, refused)
    finally:
        for task in flying:
            ray.cancel(task, force=True)


def _sent(part: Any, machines: Any, options: Options, contents: dict[str, Any], group: list[tuple[int, str, str]]) -> Any:
    """A task for a group of jobs; their CL files are in the object store, each once."""
    import ray

    names = list(dict.fromkeys(file for _, file, _ in group))
    there = []
    for name in names:
        if name not in contents:
            try:
                with open(name, "rb") as file:
                    contents[name] = ray.put(file.read())
            except OSError:
                # The worker looks for it by itself, and says what is wrong as threads do.
                contents[name] = None
        if contents[name] is not None:
            there.append(name)
    lines = "".join(line + "\n" for _, _, line in group)
    return part.remote(lines, options, machines, there, *(contents[name] for name in there))


def _numbered(native: _native.Study) -> Iterable[tuple[int, tuple[str, str]]]:
    open_jobs = native.open()
    return zip(open_jobs, native.lines(open_jobs))
