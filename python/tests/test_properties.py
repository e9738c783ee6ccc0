"""Random machines x programs x options x dialects: what is posted does what the CL file asks for, as an interpreter of
the tests has it (``oracle.controls``) and as ``post verify`` has it, and a word that is put off is seen by both; what is
refused says why, and leaves no file.

Numbers are drawn anew each time: ``POST_SEED=N`` draws those of an earlier run again, ``POST_ROUNDS=N`` takes 120N cases. A
case that fails is made small and printed with the command that shows it; ``POST_KEEP=FOLDER`` keeps it there, and all others
that fail after it.
"""

from __future__ import annotations

import functools
import json
import math
import os
import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from conftest import COMMAND, drawn, rounds

pytest.importorskip("tomllib", reason="Python 3.11 reads machine files")

from oracle.controls import Cut, groups  # noqa: E402
from oracle.jobs import Floats, Job, Leg, Operation, operation  # noqa: E402
from oracle.machine import Machine  # noqa: E402
from oracle.program import MEASURED, Reader, Unread  # noqa: E402
from oracle.worlds import Maker  # noqa: E402

TOLERANCE, LEAN, DIGIT = 0.005, 0.05, 0.5e-3
"""What the machine file allows, mm and degrees; half of the last digit of a word."""
FEED = 0.02
"""A share by which the time of an operation may be off."""
DIALECTS = {
    "fanuc": [],
    "haas": [],
    "mazak": [],
    "mitsubishi": [],
    "syntec": [],
    "fagor": ['coolant_mist = "M7"'],
    "isg": [],
    "linuxcnc": [],
    "siemens": [],
    "heidenhain": [],
    "hurco": ['tcp_on = "M128"', 'tcp_off = "M129"'],
    "brother": ['unit_system = "mm"'],
    "okuma": ['unit_system = "1 mm"'],
    "grbl": ["hal = true"],
}
"""What each must be told to write anything."""
NO_TCP = {"okuma", "grbl", "brother"}
REASONS = re.compile(r"error\[([a-z-]+)\]")
KNOWN: dict[str, Callable[[Job, str, str], bool]] = {
    "a rapid beside an earlier cut": lambda job, said, text: (
        set(REASONS.findall(said)) == {"rapid"} and "of what is cut" in said
    ),
    "at the end of travel": lambda job, said, text: (
        set(REASONS.findall(said)) <= {"over-travel", "register"} and "would be at" in said and "100000.0" in said
    ),
}
"""Faults that are known, by what ``verify`` says of them."""


def world(rng: np.random.Generator, folder: Path) -> tuple[Machine, Job]:
    """A machine file in ``folder`` and a job for it."""
    dialect = str(rng.choice(list(DIALECTS)))
    maker = Maker(rng, folder)
    maker.chain()
    text = "\n".join(maker.lines)
    if dialect in NO_TCP:
        text = text.replace('tcp = "control"', 'tcp = "post"')
    retract = "" if dialect not in ("okuma", "grbl") else "\nretract = { Z = 90000.0 }"
    own = "".join(f"\n{line}" for line in [f"[control.{dialect}]", *DIALECTS[dialect]])
    text = text.replace('dialect = "fanuc"', f'dialect = "{dialect}"{retract}')
    lengths = {1: maker.length, 2: round(float(rng.uniform(40, 180)), 3)}
    tools = "".join(f"\n[tools.{number}]\nlength = {length}" for number, length in lengths.items())
    (folder / "m.toml").write_text(text + (own if DIALECTS[dialect] else "") + tools + "\n")
    machine = Machine.read(folder / "m.toml", folder)
    many = tuple(operation(rng, machine) for _ in range(int(rng.integers(1, 5))))
    choices = [("--reduce",), ("--fit-arcs",), ("--set", "control.planes=false"), ("--set", "control.cycles=moves")]
    choices += [("--set", "control.feed=inverse-time"), ("--set", "control.arcs.keep=false"), ("--tolerance", "0.02")]
    options = tuple(word for choice in choices if rng.random() < 0.15 for word in (*choice, "")[:2])
    return machine, Job(many, bool(rng.random() < 0.2), options, dialect, lengths)


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command in that folder."""
    return subprocess.run([COMMAND, *arguments], cwd=folder, capture_output=True, text=True, timeout=120)


def flags(job: Job) -> list[str]:
    return [word for word in job.options if word]


def slack(machine: Machine, cut: Cut, length: float) -> float:
    """What the digits of all words do to the tip, mm."""
    q = cut.q[-1:]
    tip, off = machine.tip_in_part(q, length), (math.sqrt(3) * DIGIT if cut.led else 0.0)
    for place, axis in enumerate(machine.axes):
        moved = q.copy()
        moved[:, place] += 1e-4
        share = (math.radians(DIGIT) if axis.rotary else DIGIT) / 1e-4
        off += 0.0 if cut.led else float(np.linalg.norm(machine.tip_in_part(moved, length) - tip)) * share
    return off + 1e-4


def aside(points: Floats, way: Floats) -> tuple[Floats, Floats]:
    """How far points are from a line of chords, and which chord is nearest."""
    begin, along = way[:-1], np.diff(way, axis=0)
    size = np.maximum(np.einsum("mi,mi->m", along, along), 1e-18)
    off = points[:, None] - begin
    share = np.clip(np.einsum("nmi,mi->nm", off, along) / size, 0, 1)
    off -= share[:, :, None] * along
    squares = np.einsum("nmi,nmi->nm", off, off)
    nearest = squares.argmin(axis=1)
    return np.sqrt(squares[np.arange(len(points)), nearest]), nearest


def angle(one: Floats, other: Floats) -> Floats:
    """Between unit vectors, degrees."""
    return np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(one - other, axis=-1) / 2, 0, 1)))


def wanted(operation: Operation) -> list[tuple[Floats, list[Floats], list[Floats], float]]:
    """Each group of cuts: its way in chords, its corners, their tool axes, and its length."""
    if operation.cycle:
        found = []
        for leg in operation.legs:
            tip, axis = leg.points[-1], leg.axes[-1]
            way = np.array([tip + 3 * axis, tip - operation.depth * axis])
            found.append((way, list(way), [axis, axis], 3 + operation.depth))
        return found
    legs: tuple[Leg, ...] = operation.legs
    way = np.vstack([legs[0].points[:1], *(leg.points[1:] for leg in legs)])
    corners = [legs[0].points[0], *(leg.points[-1] for leg in legs)]
    return [(way, corners, [legs[0].axes[0], *(leg.axes[-1] for leg in legs)], sum(leg.length for leg in legs))]


def wrongs(machine: Machine, job: Job, text: str) -> Iterator[str]:
    """What of a program is not as the CL file has it."""
    cuts = groups(machine, text, job.lengths, job.dialect)
    at, dwelt, allowed = 0, 0.0, 0.02 if "--tolerance" in job.options else TOLERANCE
    for number, one in enumerate(job.operations):
        dwelt += one.dwell
        for way, corners, axes, length in wanted(one):
            if at >= len(cuts):
                yield f"operation {number}: nothing cuts it"
                return
            group, at = list(cuts[at]), at + 1
            bottom = corners[-1]
            while one.cycle and np.linalg.norm(group[-1].tips[-1] - bottom) > 0.05 and at < len(cuts):
                group, at = [*group, *cuts[at]], at + 1
            # A last peck may be divided once more: it ends where the one before did.
            while one.cycle and at < len(cuts) and np.linalg.norm(cuts[at][-1].tips[-1] - bottom) < 0.05:
                group, at = [*group, *cuts[at]], at + 1
            off = slack(machine, group[-1], job.lengths[one.tool]) + allowed
            where = f"operation {number}, line {group[0].line}"
            for cut in group:
                far, _ = aside(cut.tips, way)
                if far.max() > off:
                    yield f"{where}: line {cut.line}: the tip strays by {far.max():.4f} of {off:.4f}"
                told = (cut.tool, cut.spindle, cut.coolant, round(cut.dwelt, 3))
                wet = frozenset({"FLOOD": {8}, "MIST": {7}}.get(one.coolant, set()))
                asked = (one.tool, one.spindle, wet, round(dwelt, 3))
                if told != asked:
                    yield f"{where}: line {cut.line}: {told} is on, {asked} is asked for"
            tips = np.vstack([cut.tips for cut in group])
            leans = np.vstack([cut.axes for cut in group])
            begin = 0
            for place, (corner, axis) in enumerate(zip(corners, axes)):
                close = (np.linalg.norm(tips[begin:] - corner, axis=1) < off) & (
                    angle(leans[begin:], axis) < LEAN + 0.01
                )
                if not close.any():
                    chords, _ = aside(corner[None], tips[begin:]) if len(tips) - begin > 1 else (np.array([9.0]), None)
                    if not flags(job) or chords[0] > off:
                        yield f"{where}: corner {place} at {corner} is not met, nearest {chords[0]:.4f}"
                    break
                begin += int(close.argmax())
            times = [cut.minutes for cut in group]
            # G93 ends at the control's largest F.
            held = "F9999.99" in text and job.dialect != "heidenhain"
            if None not in times and not one.cycle:
                took, should = sum(time for time in times if time is not None), length / one.feed_a_minute()
                late = took > should and held
                if not late and abs(took - should) > FEED * should + 1e-5 * len(group):
                    yield f"{where}: it lasts {60 * took:.4f} s, {60 * should:.4f} s are asked for"
    if at < len(cuts):
        yield f"line {cuts[at][0].line}: a cut that nobody asked for"


def spoilt(rng: np.random.Generator, job: Job, machine: Machine, text: str) -> str | None:
    """The program with one word of a cut put off by 0.1 mm; none where there is no such word."""
    lines = text.splitlines()
    numbers = {cut.line for group in groups(machine, text, job.lengths, job.dialect) for cut in group}
    if job.dialect == "heidenhain" and "~" in text:
        return None
    places = [
        (number, found)
        for number in numbers
        for found in re.finditer(r"(?<![A-Z\d])([XYZ])([-+]?\d+\.\d+)", lines[number - 1])
        if not re.search(r"G8\d|G73", lines[number - 1])
    ]
    if not places:
        return None
    number, found = places[int(rng.integers(len(places)))]
    sign = "+" if found[2][0] in "+" else ""
    value = float(found[2]) + 0.1
    word = f"{found[1]}{'' if value < 0 else sign}{value:.3f}"
    block = lines[number - 1]
    lines[number - 1] = block[: found.start()] + word + block[found.end() :]
    return "\n".join([*lines, ""])


def judged(
    folder: Path, machine: Machine, job: Job, rng: np.random.Generator | None, tally: Counter[str]
) -> str | None:
    """What is wrong with a case, if anything."""
    program = folder / "p.nc"
    program.unlink(missing_ok=True)
    (folder / "p.cls").write_text(job.text())
    post = run(folder, "-m", "m.toml", "p.cls", "-o", "p.nc", "-q", *flags(job))
    if "panicked" in post.stderr or post.returncode not in (0, 1):
        return f"crash {post.returncode}: {post.stderr[-500:]}"
    if post.returncode:
        codes = set(REASONS.findall(post.stderr))
        tally["refused"] += 1
        tally.update(f"refused: {code}" for code in codes)
        if not codes:
            return f"refused without a reason: {post.stderr}"
        if "-->" not in post.stderr and "= help:" not in post.stderr:
            return f"refused without a place or a remedy: {post.stderr}"
        if "internal" in post.stderr:
            return f"refused as its own fault: {post.stderr}"
        left = {path.name for path in folder.iterdir()} - {"m.toml", "p.cls"}
        return f"files are left: {left}" if left else None
    tally["posted"] += 1
    text = program.read_text()
    check = ["-m", "m.toml", "--against", "p.cls", "-q", *flags(job)]
    verify = run(folder, "verify", "p.nc", *check, "--posted")
    if verify.returncode:
        known = [name for name, is_it in KNOWN.items() if is_it(job, verify.stderr, text)]
        if known:
            tally[f"known: {known[0]}"] += 1
            return None
        return f"verify: {verify.stderr[:600]}"
    try:
        wrong = next(wrongs(machine, job, text), None)
    except Unread as unread:
        tally["not read by the tests"] += 1
        tally[f"not read: {job.dialect}"] += 1
        del unread
        return None
    if wrong:
        return f"interpreter: {wrong}"
    tally["judged by both"] += 1
    tally[f"judged: {job.dialect}"] += 1
    if rng is not None and rng.random() < 0.3:
        bad = spoilt(rng, job, machine, text)
        if bad:
            tally["spoilt"] += 1
            try:
                ours = next(wrongs(machine, job, bad), None) is not None
            except (ValueError, Unread):
                ours = True
            (folder / "bad.nc").write_text(bad)
            theirs = run(folder, "verify", "bad.nc", *check).returncode != 0
            tally["seen by the tests"] += ours
            tally["seen by verify"] += theirs
            if ours and not theirs:
                return "verify does not see the fault in bad.nc"
            (folder / "bad.nc").unlink()
    return None


def fails_so(folder: Path, machine: Machine, kind: str, job: Job) -> bool:
    """Whether a job fails, and in that way."""
    found = judged(folder, machine, job, None, Counter())
    return found is not None and found.split(":")[0] == kind


def small(job: Job, fails: Callable[[Job], bool]) -> Job:
    """The job with all left out that it can be without and still fail."""
    smaller = True
    while smaller:
        smaller = False
        for other in job.smaller():
            if fails(other):
                job, smaller = other, True
                break
    return job


def test_random_programs_do_what_is_asked(tmp_path: Path) -> None:
    """Machine x program x options x dialect: two readers that share no line agree with the CL file."""
    # What is drawn anew finds what is known to be left: long runs do, and a usual one tells whether something is new.
    rng = drawn(33) if os.environ.get("POST_ROUNDS") else np.random.default_rng(11)
    tally, failed = Counter[str](), list[str]()
    keep = os.environ.get("POST_KEEP")
    for number in range(rounds(120)):
        folder = tmp_path / str(number)
        folder.mkdir()
        machine, job = world(rng, folder)
        if Reader(machine, job.lengths).leans >= MEASURED:
            tally["leaning slides"] += 1
            shutil.rmtree(folder)
            continue
        wrong = judged(folder, machine, job, rng, tally)
        if wrong and "bad.nc" not in wrong:
            kind = wrong.split(":")[0]

            job = small(job, functools.partial(fails_so, folder, machine, kind))
            wrong = judged(folder, machine, job, None, Counter())
        if wrong:
            machine_file, cl = (folder / "m.toml").read_text(), (folder / "p.cls").read_text()
            command = " ".join([COMMAND, "-m m.toml p.cls -o p.nc", *flags(job)])
            failed.append(f"{wrong}\n{command}\n--- m.toml\n{machine_file}--- p.cls\n{cl}")
            if not keep:
                break
            shutil.copytree(folder, Path(keep) / f"{job.dialect}-{number}", dirs_exist_ok=True)
            (Path(keep) / f"{job.dialect}-{number}" / "why").write_text(f"{wrong}\n{command}\n")
        shutil.rmtree(folder)
    print(json.dumps(tally, indent=1))
    assert not failed, failed[0]
    assert tally["judged by both"] * 3 >= tally["posted"], tally
    assert tally["seen by the tests"] >= 0.9 * tally["spoilt"] - 3.0 * (0.09 * tally["spoilt"]) ** 0.5, tally


def test_a_case_is_made_small() -> None:
    """Of what fails for one operation alone only that is left."""
    one = Operation(np.zeros(3), np.eye(3)[2], (Leg(np.zeros((2, 3)), np.tile(np.eye(3)[2], (2, 1))),) * 6)
    job = Job((one, replace(one, coolant="MIST"), one), True, ("--reduce", ""))
    least = small(job, lambda other: any(operation.coolant for operation in other.operations))
    assert len(least.operations) == 1 and len(least.operations[0].legs) == 1
    assert not least.inch and not least.options and least.operations[0].coolant == "MIST"
