"""Random machines, their words and limits, posted; what is written is read back by kinematics that post knows nothing
of (``oracle``), and held against the CL file.

Numbers are drawn anew each time: ``POST_SEED=N`` draws those of an earlier run again, ``POST_ROUNDS=N`` takes 2,000N
machines.
"""

import json
import math
import os
import re
import shutil
import subprocess
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from conftest import COMMAND, drawn

pytest.importorskip("tomllib", reason="Python 3.11 reads machine files")

from oracle.machine import Machine  # noqa: E402
from oracle.program import Motion, Reader  # noqa: E402
from oracle.ways import SPARE, Search  # noqa: E402
from oracle.worlds import KINDS, Maker  # noqa: E402

SHARES = np.linspace(0, 1, 9)
TOLERANCE, LEAN = 0.005, 0.05
"""What the machine file allows, mm and degrees."""
ABOVE = 20.0
"""From where the tool comes to a cut, mm along it."""
DIGIT = 0.5e-3
"""Half of the last digit of a word, mm or degrees."""

Floats = np.ndarray


@dataclass
class Words:
    """Words of the program as multiples of slides and sums of rotary axes: ``matrix`` @ what axes show."""

    letters: list[str]
    matrix: Floats

    def said(self) -> list[str]:
        """The tables of the machine file; words that are the axis itself need none."""
        lines = []
        for letter, row in zip(self.letters, self.matrix):
            if np.array_equal(row, np.eye(len(row))[self.letters.index(letter)]):
                continue
            terms = [f"{factor:+.4f} * {name}" for name, factor in zip(self.letters, row) if factor]
            lines += [f"[word.{letter}]", f'is = "{" ".join(terms).removeprefix("+")}"']
        return lines


class WordReader(Reader):
    """A reader of programs whose words are ``Words``."""

    def __init__(self, machine: Machine, lengths: dict[int, float], words: Words) -> None:
        super().__init__(machine, lengths)
        self.words, self.back = words, np.linalg.inv(words.matrix)
        # A slide that is not quite along the tool takes the tip aside by its length: the program is for this tool.
        slides = [machine.axes[slide] for slide in machine.slides()]
        directions = np.stack([slide.direction for slide in slides], axis=1)
        values = np.linalg.solve(directions, machine.mount - machine.tip(lengths[1]))
        self.zero |= {slide.name: float(slide.shown(value)) for slide, value in zip(slides, values)}
        self.zero[self.along] -= lengths[1]

    def move(
        self, line: int, axes: dict[str, float], mode: int, others: dict[str, float], machine_words: bool
    ) -> Motion | None:
        letters, matrix = self.words.letters, self.words.matrix
        slides = [letter for letter in letters if letter in "XYZ"]
        told = {
            letter: value / matrix[letters.index(letter), letters.index(letter)]
            for letter, value in axes.items()
            if letter in slides
        }
        if set(axes) - set(slides):
            shown = np.array([0.0 if letter in slides else self.shown[letter] for letter in letters])
            spoken = matrix @ shown
            for letter in set(axes) - set(slides):
                spoken[letters.index(letter)] = axes[letter]
            for letter, value in zip(letters, self.back @ spoken):
                if letter not in slides:
                    told[letter] = float(value)
        return super().move(line, told, mode, others, machine_words)


@dataclass
class Limit:
    """``slide`` stays on one side of a value that depends on ``turned``."""

    slide: str
    turned: str
    level: float
    slope: float
    above: bool

    def said(self) -> list[str]:
        sign = ">" if self.above else "<"
        return ["[[limit]]", f'keep = "{self.slide} {sign} {self.level} {self.slope:+} * abs({self.turned})"']

    def passed(self, machine: Machine, q: Floats) -> Floats:
        """By how much, at each pose."""
        names = [axis.name for axis in machine.axes]
        slide, turned = (
            machine.axes[names.index(name)].shown(q[:, names.index(name)]) for name in (self.slide, self.turned)
        )
        room = slide - (self.level + self.slope * np.abs(turned))
        return -room if self.above else room


@dataclass
class Case:
    """A machine, a CL file's cuts (tips and tool axes in the frame of the part) and what the machine says of words and
    limits."""

    folder: Path
    machine: Machine
    words: Words
    limits: list[Limit]
    travel: dict[str, tuple[float, float]]
    passes: list[tuple[Floats, Floats]]
    length: float
    cuts: set[int]


def paths(rng: np.random.Generator, machine: Machine, length: float, travel: dict) -> list[tuple[Floats, Floats]]:
    """Cuts that the machine can make: what its own axes do on smooth ways."""
    found = []
    for _ in range(3):
        count = int(rng.integers(4, 16))
        share = np.linspace(0, 1, count)[:, None]
        tips = rng.uniform(-60, 60, 3) + rng.uniform(5, 40, 3) * np.sin(rng.uniform(0.5, 3, 3) * share * 2)
        q = np.zeros((count, len(machine.axes)))
        for place, axis in enumerate(machine.axes):
            if axis.rotary:
                # A tool that leans far is not led away from the part by Z.
                most = 170.0 if axis.carries_part else 85.0
                low, high = (max(-most, travel[axis.name][0]), min(most, travel[axis.name][1]))
                middle, way = rng.uniform(low, high), rng.uniform(0, 0.25) * (high - low)
                turned = middle + way * np.sin(rng.uniform(0.5, 2) * share[:, 0] * 2)
                q[:, place] = axis.value(np.clip(turned, low, high))
        led, _ = machine.place(len(machine.axes), q)
        held, _ = machine.place(0, q)
        axes = np.einsum("nji,nj->ni", held, led @ machine.tool_axis)
        found.append((tips.round(6), axes.round(9)))
    return found


def write_cl(path: Path, passes: list[tuple[Floats, Floats]]) -> set[int]:
    """A CL file: above each cut at rapid, along it at feed, and away. Returns the lines of its cuts."""
    cuts = set[int]()
    lines = ["PARTNO/CHAINS", "UNITS/MM", "LOADTL/1", "SPINDL/5000,CLW"]

    def goto(tip: Floats, axis: Floats) -> str:
        return "GOTO/" + ",".join(f"{value:.9f}" for value in [*tip, *axis])

    for tips, axes in passes:
        lines += ["RAPID", goto(tips[0] + ABOVE * axes[0], axes[0]), "FEDRAT/800,MMPM"]
        cuts |= set(range(len(lines) + 1, len(lines) + 1 + len(tips)))
        lines += [goto(tip, axis) for tip, axis in zip(tips, axes)]
        lines += ["RAPID", goto(tips[-1] + ABOVE * axes[-1], axes[-1])]
    path.write_text("\n".join([*lines, "SPINDL/OFF", "FINI", ""]))
    return cuts


def case(rng: np.random.Generator, folder: Path) -> Case:
    """A machine with random words and limits in ``folder``, and a CL file for it."""
    maker = Maker(rng, folder, {**{kind: 0.9 * share for kind, share in KINDS.items()}, "three": 0.1})
    maker.register = 1
    maker.chain()
    text = "\n".join(maker.lines)
    letters = re.findall(r"\[axis\.(.)\]", text)
    travel = {letter: (-100000.0, 100000.0) for letter in letters}
    for letter in letters:
        if letter in "ABC" and maker.chance(0.5):
            travel[letter] = (-round(float(rng.uniform(40, 360)), 1), round(float(rng.uniform(40, 360)), 1))
            text = re.sub(rf"(\[axis\.{letter}\](?:\n.+)*?\ntravel = ).*", rf"\g<1>{list(travel[letter])}", text)
        elif letter in "ABC":
            travel[letter] = (-400.0, 400.0)
    matrix = np.eye(len(letters))
    turned = [letter for letter in letters if letter in "ABC"]
    for letter in letters:
        # The control's length of the tool goes along Z, and its words of a tip are no words of axes.
        if letter in "XY" and not maker.tcp and maker.chance(0.4):
            matrix[letters.index(letter), letters.index(letter)] = maker.pick([2, 0.5, 2.5])
        if letter in turned and maker.chance(0.3):
            matrix[letters.index(letter), letters.index(letter)] = maker.pick([1, 2, 0.5])
            for other in turned:
                if other != letter and other < letter:
                    matrix[letters.index(letter), letters.index(other)] = maker.pick([1, -1, 0.5, 0.25])
    words = Words(letters, matrix)
    limits = []
    if turned and maker.chance(0.5):
        # Z goes to the end of its travel after each cut.
        slide = str(maker.pick(list("XYZ")))
        above = slide == "Z" or maker.chance(0.5)
        reach = float(rng.uniform(200, 1500)) * (-1 if above else 1)
        slope = round(float(rng.uniform(0.2, 3)), 2) * (1 if above else -1)
        limits.append(Limit(slide, str(maker.pick(turned)), round(reach, 1), slope, above))
    if limits or maker.chance(0.5):
        # Not to the end of a travel that is longer than any: limits would be passed there.
        text = text.replace("[control]\n", f'[control]\nleave = {{ along = "tool", distance = {ABOVE + 20} }}\n')
    lines = [text, *words.said(), *(line for limit in limits for line in limit.said())]
    lines += ["[clearance]", 'rapid_axes = "together"', "[tools.1]", f"length = {maker.length}", ""]
    (folder / "m.toml").write_text("\n".join(lines))
    machine = Machine.read(folder / "m.toml", folder)
    passes = paths(rng, machine, maker.length, travel)
    cuts = write_cl(folder / "p.cls", passes)
    return Case(folder, machine, words, limits, travel, passes, maker.length, cuts)


def poses(machine: Machine, q: Floats, length: float) -> tuple[Floats, Floats]:
    """Tips and tool axes in the frame of the part."""
    led, _ = machine.place(len(machine.axes), q)
    held, _ = machine.place(0, q)
    return machine.tip_in_part(q, length), np.einsum("nji,nj->ni", held, led @ machine.tool_axis)


def angle(one: Floats, other: Floats) -> Floats:
    """Between unit vectors, degrees."""
    return np.degrees(2 * np.arcsin(np.clip(np.linalg.norm(one - other, axis=-1) / 2, 0, 1)))


def slacks(found: Case, q: Floats, led: Floats) -> tuple[Floats, Floats]:
    """What the digits of all words can do to tip and tool axis at each pose, mm and degrees."""
    machine, back = found.machine, np.abs(np.linalg.inv(found.words.matrix))
    tip, axis = poses(machine, q, found.length)
    off, leant = np.where(led, math.sqrt(3) * DIGIT, 0.0), np.zeros(len(q))
    for place, one in enumerate(machine.axes):
        step = 1e-4
        turned = q.copy()
        turned[:, place] += step
        tip2, axis2 = poses(machine, turned, found.length)
        share = DIGIT * float(back[found.words.letters.index(one.name)].sum())
        share = (math.radians(share) if one.rotary else share) / step
        off += np.where(led, 0.0, np.linalg.norm(tip2 - tip, axis=1) * share)
        leant += angle(axis2, axis) * share
    return off + 2e-6, leant + 2e-6


def wrongs(found: Case, text: str) -> Iterator[str]:
    """What of a program is not as the CL file and the machine have it."""
    reader = WordReader(found.machine, {1: found.length}, found.words)
    motions = [(motion, motion.at(SHARES)) for motion in reader.motions(text)]
    for motion, q in motions:
        for place, axis in enumerate(found.machine.axes):
            low, high = found.travel[axis.name]
            shown = axis.shown(q[:, place])
            # The way to the first place begins where nobody has said.
            if motion is not motions[0][0] and (shown.min() < low - 2e-3 or shown.max() > high + 2e-3):
                yield f"{motion.line}: {axis.name} at {shown.min():.3f} to {shown.max():.3f}, travel {low} to {high}"
        for limit in found.limits:
            by = float(np.max(limit.passed(found.machine, q[-1:] if motion.rapid else q)))
            if motion is not motions[0][0] and by > 0.01:
                yield f"{motion.line}: a limit is passed by {by:.3f}"
    cutting = [(motion, q) for motion, q in motions if not motion.rapid]
    cuts = []
    if cutting:
        all_poses = np.stack([q for _, q in cutting])
        tip, axis = poses(found.machine, all_poses.reshape(-1, all_poses.shape[2]), found.length)
        led = np.array([motion.keeps_tip for motion, _ in cutting])
        off, leant = slacks(found, all_poses[:, -1], led)
        places = (len(cutting), len(SHARES), 3)
        lines = [motion.line for motion, _ in cutting]
        cuts = list(zip(lines, tip.reshape(places), axis.reshape(places), off, leant, strict=True))
    at = 0
    for tips, axes in found.passes:
        for place, (goal, lean) in enumerate(zip(tips, axes)):
            for number in range(at, len(cuts)):
                _, tip, axis, off, leant = cuts[number]
                # Beside a pole the tool may lean as far as the file allows.
                if np.linalg.norm(tip[-1] - goal) <= off + 1e-4 and angle(axis[-1], lean) <= LEAN + leant:
                    break
            else:
                yield f"point {place} of a cut at {goal} is not met behind line {cuts[at][0] if cuts else 0}"
                return
            # Between the points before and this one, the ways there.
            for line, tip, axis, off, leant in cuts[at : number + 1] if place else []:
                start, way = tips[place - 1], goal - tips[place - 1]
                share = np.clip((tip - start) @ way / max(float(way @ way), 1e-12), 0, 1)
                aside = np.linalg.norm(tip - start - share[:, None] * way, axis=1).max()
                if aside > TOLERANCE + off:
                    yield f"{line}: the tip strays by {aside:.4f}, {TOLERANCE + off:.4f} are allowed"
                normal = np.cross(axes[place - 1], lean)
                size = float(np.linalg.norm(normal))
                if size > 1e-4:
                    tilt = np.degrees(np.arcsin(np.clip(np.abs(axis @ normal) / size, 0, 1))).max()
                    if tilt > LEAN + leant:
                        yield f"{line}: the tool leaves its plane by {tilt:.4f} degrees"
            at = number + 1


def posted(found: Case) -> tuple[str | None, str]:
    """The program, if there is one, and what is said."""
    words = [COMMAND, "-m", "m.toml", "p.cls", "-o", "p.nc"]
    run = subprocess.run(words, cwd=found.folder, capture_output=True, text=True)
    assert run.returncode in (0, 1), run.stderr
    return (found.folder / "p.nc").read_text() if run.returncode == 0 else None, run.stderr


def spoilt(rng: np.random.Generator, text: str) -> str:
    """The program with one word of a cut put off by 0.05 mm or 0.2 degrees."""
    lines = text.splitlines()
    cutting, places = False, []
    for number, line in enumerate(lines):
        codes = re.findall(r"G0*(\d+)(?![\d.])", line)
        cutting = "1" in codes or (cutting and "0" not in codes)
        places += [(number, found) for found in re.finditer(r"([XYZABC])(-?\d+\.\d+)", line)] if cutting else []
    number, found = places[int(rng.integers(len(places)))]
    off = 0.05 if found[1] in "XYZ" else 0.2
    word = f"{found[1]}{float(found[2]) + off:.3f}"
    lines[number] = lines[number][: found.start()] + word + lines[number][found.end() :]
    return "\n".join(lines)


def stands_against(found: Case) -> str | None:
    """Why there is no way to make a cut inside travel and limits, as far as a search of the test's own sees; none if each
    cut has one."""

    def inside(q: Floats) -> Floats:
        kept = np.ones(len(q), bool)
        for limit in found.limits:
            kept &= limit.passed(found.machine, q) <= -SPARE
        return kept

    search = Search(found.machine, found.travel, inside, found.length, math.radians(LEAN))
    for number, (tips, axes) in enumerate(found.passes):
        why = search.way(tips, axes, ABOVE)
        if why:
            return f"cut {number}: {why}"
    return None


def cases() -> int:
    """Few in a usual run; in a long one 2,000, or so many times as many."""
    return 2000 * int(os.environ.get("POST_ROUNDS", 0)) or 20


@dataclass
class Verdict:
    """What came of a case: its counts, why it was refused and what speaks against that, and what is wrong."""

    counts: Counter[str]
    reasons: Counter[str]
    against: Counter[str]
    needless: str = ""
    wrong: str = ""


def judged(folder: Path, seed: int, number: int) -> Verdict:
    """Case ``number`` of a seed, in a folder of its own."""
    rng = np.random.default_rng([7, seed, number])
    room = folder / str(number)
    room.mkdir()
    found = case(rng, room)
    counts = Counter({f"{len(found.machine.axes)} axes": 1, "paths": len(found.passes)})
    verdict = Verdict(counts, Counter(), Counter())
    text, said = posted(found)
    if text is None:
        verdict.reasons.update(set(re.findall(r"error\[([a-z-]+)\]", said)))
        assert verdict.reasons, said
        counts["refused"] = 1
        if {int(line) for line in re.findall(r"--> p\.cls:(\d+):", said)} & found.cuts:
            why = stands_against(found)
            verdict.against[re.sub(r"cut \d: ", "", why) if why else "nothing"] += 1
            verdict.needless = "" if why else f"case {number}: {said}"
        else:
            verdict.against[f"off the part, not searched: {', '.join(sorted(verdict.reasons))}"] += 1
        return verdict
    verdict.wrong = next((f"case {number}: {wrong}" for wrong in wrongs(found, text)), "")
    counts.update({"posted": 1, "with words": bool(found.words.said()), "with limits": bool(found.limits)})
    if number % 4 == 0:
        counts.update({"spoilt": 1, "seen": next(wrongs(found, spoilt(rng, text)), None) is not None})
    shutil.rmtree(room)
    return verdict


def test_random_chains_words_limits(tmp_path: Path) -> None:
    """Chains x words x limits. Of what is posted each point is met within the digits, each way within the tolerance,
    travels and limits are kept; a word that is put off is seen. Of a cut that is refused no way is found inside travel and
    limits either."""
    seed = int(drawn(7).integers(2**31))
    with ProcessPoolExecutor(os.cpu_count() if "POST_ROUNDS" in os.environ else 1) as pool:
        verdicts = list(pool.map(partial(judged, tmp_path, seed), range(cases()), chunksize=5))
    counts, reasons, against = (
        sum((getattr(verdict, name) for verdict in verdicts), Counter[str]())
        for name in ("counts", "reasons", "against")
    )
    told = {"refused because": dict(reasons), "what the search has against those": dict(against)}
    print(json.dumps(dict(sorted(counts.items())) | told))
    wrong = [verdict.wrong for verdict in verdicts if verdict.wrong]
    needless = [verdict.needless for verdict in verdicts if verdict.needless]
    print("\n".join([*wrong, *needless]))
    assert not wrong, f"{tmp_path}: {wrong[:3]}"
    assert counts["posted"] >= 2 * counts["refused"], reasons
    # Nine of ten, less what so many draws may lack of it by chance (three standard deviations).
    assert counts["seen"] >= 0.9 * counts["spoilt"] - 3.0 * (0.09 * counts["spoilt"]) ** 0.5
    # One in a thousand, where the post's ways among more axes than a pose needs are fewer than those of the search.
    assert len(needless) <= cases() / 1000, f"{tmp_path}: {needless[:3]}"
