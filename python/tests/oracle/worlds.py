"""Random machines with bodies, and random programs for them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from oracle.machine import Machine, Toml

UNITS = {letter: np.eye(3)["XYZ".index(along)] for letter, along in zip("ABCXYZ", "XYZXYZ")}

ROTARY = {
    "tables": [("CA", ""), ("CB", ""), ("BA", ""), ("AB", "")],
    "heads": [("", "CA"), ("", "CB"), ("", "AB")],
    "both": [("C", "B"), ("C", "A"), ("A", "B")],
    "one": [("A", ""), ("B", ""), ("C", ""), ("", "A"), ("", "B")],
    "none": [("", "")],
    "three": [("CA", "B"), ("BC", "A"), ("C", "AB"), ("A", "CB"), ("", "CBA")],
}
"""Rotary axes that carry the part and the tool, by the class of machine."""

KINDS = {"tables": 0.35, "heads": 0.15, "both": 0.25, "one": 0.15, "none": 0.1}
"""How often each class is drawn."""


@dataclass
class World:
    """A machine and its program, in files of a folder: a tool of ``length`` that the control leads by the ``lengths``
    of its registers. ``keep`` and ``rapid`` are the distances to be kept, mm."""

    folder: Path
    machine: Machine
    text: str
    length: float
    lengths: dict[int, float]
    keep: float
    rapid: float


def numbers(values: np.ndarray) -> str:
    """Numbers of a machine file."""
    return str(np.round(np.asarray(values, float), 6).tolist())


def star(rng: np.random.Generator, centre: np.ndarray, size: float) -> tuple[np.ndarray, np.ndarray]:
    """A closed mesh about its middle, with dents."""
    rings, sides = int(rng.integers(3, 8)), int(rng.integers(5, 14))
    tilt = np.pi * np.arange(1, rings + 1) / (rings + 1)
    round_ = 2 * np.pi * np.arange(sides) / sides
    tilt, round_ = (grid.ravel() for grid in np.meshgrid(tilt, round_, indexing="ij"))
    points = np.stack([np.sin(tilt) * np.cos(round_), np.sin(tilt) * np.sin(round_), np.cos(tilt)], axis=1)
    points = np.vstack([[[0, 0, 1]], points, [[0, 0, -1]]])
    points = points * rng.uniform(0.5 * size, size, (len(points), 1)) * rng.uniform(0.3, 1, 3) + centre
    last, faces = len(points) - 1, []
    for side in range(sides):
        beside = (side + 1) % sides
        faces.append([0, 1 + side, 1 + beside])
        for ring in range(1, (rings - 1) * sides, sides):
            a, b = ring + side, ring + beside
            faces += [[a, a + sides, b], [b, a + sides, b + sides]]
        faces.append([last, last - sides + beside, last - sides + side])
    return points, np.array(faces)


def write_stl(path: Path, points: np.ndarray, faces: np.ndarray) -> None:
    """A binary STL file."""
    kind = np.dtype([("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    data = np.zeros(len(faces), kind)
    data["v"] = points[faces]
    path.write_bytes(bytes(80) + len(faces).to_bytes(4, "little") + data.tobytes())


class Maker:
    """Makes the machine file line by line."""

    def __init__(self, rng: np.random.Generator, folder: Path, kinds: dict[str, float] = KINDS) -> None:
        self.kinds = kinds
        self.rng, self.folder, self.lines, self.fixtures = rng, folder, list[str](), 0
        self.part, self.tool, self.tcp = "", "", False
        self.mount = rng.uniform(-20, 20, 3).round(3)
        self.gauge = np.array([*rng.uniform(-5, 5, 2), rng.uniform(250, 450)]).round(3)
        self.length = round(float(rng.uniform(60, 200)), 2)
        # By what the control leads the tool: another's length, now and then.
        self.register = 2 if self.chance(0.15) else 1
        self.lengths = {1: self.length}
        if self.register == 2:
            self.lengths[2] = round(max(30.0, self.length + float(rng.uniform(-40, 60))), 2)

    def chance(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def pick(self, choices: list) -> object:
        return choices[int(self.rng.integers(len(choices)))]

    def chain(self) -> None:
        """The axes: what carries the part and what the tool, where, and which way."""
        kind = str(self.rng.choice(list(self.kinds), p=list(self.kinds.values())))
        held, led = self.pick(ROTARY[kind])  # type: ignore[misc]
        slides = self.rng.permutation(list("XYZ"))
        below = "".join(slide for slide in slides if self.chance(0.3))
        self.part = below[:1] + held + below[1:] if self.chance(0.2) else held + below
        self.tool = "".join(slide for slide in slides if slide not in below) + led
        self.tcp = kind != "none" and self.chance(0.55)
        words = [f"{letter}'" for letter in self.part] + ["b", *self.tool, "(S)", "t"]
        self.lines += ['name = "random"', f'chain = "[w {" ".join(words)}]"']
        self.lines += ["[workpiece]", f"mount = {numbers(self.mount)}", "[tool]", f"gauge = {numbers(self.gauge)}"]
        for letter in self.part + self.tool:
            self.axis(letter, led)
        self.lines += ["[control]", 'dialect = "fanuc"', "[accuracy]", "tolerance = 0.005"]
        if kind != "none":
            self.lines.insert(-2, f'tcp = "{"control" if self.tcp else "post"}"')

    def axis(self, letter: str, led: str) -> None:
        """A direction that may be another than drawn, a point far from the others."""
        direction = UNITS[letter].copy()
        self.lines.append(f"[axis.{letter}]")
        if letter in "XYZ":
            if self.chance(0.03):
                direction += self.rng.normal(0, 0.003, 3)
            self.lines += [f"linear = {numbers(direction)}", "travel = [-100000, 100000]"]
            return
        if self.chance(0.15):
            lean = self.rng.uniform(0.3, 0.9)
            direction = direction * math.cos(lean) + UNITS["B" if letter == "C" else "C"] * math.sin(lean)
        if self.chance(0.3):
            direction += self.rng.normal(0, 0.004, 3)
        point = self.rng.uniform(-1, 1, 3) * self.pick([1, 40, 120])
        if letter in led:
            point[2] += self.gauge[2] + self.rng.uniform(0, 200)
        self.lines += [f"rotary = {numbers(direction)}", f"point = {numbers(point)}", "travel = [-400, 400]"]
        if self.chance(0.25):
            self.lines.append("reversed = true")

    def body(self, near: np.ndarray, size: float, on: str) -> None:
        """A box, a cylinder or a mesh of one or two parts."""
        rng, name = self.rng, f"f{self.fixtures}"
        self.fixtures += 1
        self.lines += [f"[fixture.{name}]", f'on = "{on}"']
        centre, kind = near + rng.uniform(-1, 1, 3) * [90, 90, 60], int(rng.integers(3))
        if kind == 0:
            half = rng.uniform(0.2, 1, 3) * size
            self.lines.append(f"block = [{numbers(centre - half)}, {numbers(centre + half)}]")
        elif kind == 1:
            along = rng.normal(size=3) if self.chance(0.5) else np.eye(3)[int(rng.integers(3))]
            end = centre + along / np.linalg.norm(along) * size * rng.uniform(0.5, 3)
            self.lines.append(f"cylinder = [{numbers(centre)}, {numbers(end)}]")
            self.lines.append(f"radius = {size * rng.uniform(0.2, 0.8):.3f}")
        else:
            points, faces = star(rng, centre, size)
            if self.chance(0.3):
                more, others = star(rng, centre + rng.uniform(-2, 2, 3) * size, size / 2)
                points, faces = np.vstack([points, more]), np.vstack([faces, others + len(points)])
            write_stl(self.folder / f"{name}.stl", points, faces)
            self.lines.append(f'file = "{name}.stl"')

    def bodies(self) -> None:
        """What holds the part, what stands about, the stock, and the tool."""
        rng = self.rng
        low = self.mount + [0, 0, rng.uniform(-60, 20)]
        nose = self.gauge + [0, 0, rng.uniform(20, 120)]
        for _ in range(int(rng.integers(1, 4))):
            self.body(low, rng.uniform(5, 50), "w")
        for letter in self.part:
            if self.chance(0.5):
                self.body(low - [0, 0, 40], rng.uniform(10, 60), letter)
        if self.chance(0.4):
            self.body(low + [0, 0, 40] + rng.uniform(-150, 150, 3), rng.uniform(10, 60), "b")
        for letter in self.tool + "t":
            if self.chance(0.4):
                self.body(nose, rng.uniform(10, 60), letter)
        if self.chance(0.7):
            x, y, z = rng.uniform(5, 40, 3).round(2)
            corners = f"block = [[{-x}, {-y}, {-z}], [{x}, {y}, {z}]]"
            turned = f"cylinder = [[0, 0, {-z}], [0, 0, {y}]]\nradius = {x}"
            shape = corners if self.chance(0.6) else turned
            self.lines += ["[stock]", shape] if self.chance(0.5) else ["[stock.one]", shape]
            if self.lines[-2] == "[stock.one]":
                # Another one beside it, as a fixture has it.
                at = low + rng.uniform(-60, 60, 3)
                corners = numbers(np.array([at, at + rng.uniform(5, 60, 3)]))
                letter = str(self.pick([*self.part, "w", "b"]))
                self.lines += ["[stock.other]", f'on = "{letter}"', f"block = {corners}"]
        if self.chance(0.3):
            letter = str(self.pick(list(self.part + self.tool)))
            near = low if letter in self.part else nose
            write_stl(self.folder / "solid.stl", *star(rng, near, rng.uniform(20, 60)))
            self.lines += ["[solids]", f'{letter} = "solid.stl"']
        self.lines += ["[tools.1]", f"length = {self.length}"]
        if self.chance(0.9):
            z = np.cumsum(rng.uniform(5, 25, 4))
            z *= min(1, 0.7 * self.length / z[-1])
            r = np.sort(rng.uniform(8, 35, 4))[::-1]
            profile = [[0, r[0]], [z[0], r[0]], [z[0], r[1]], [z[1], r[1]], [z[2], r[2]], [z[3], r[3]]]
            self.lines.append(f"holder = {numbers(np.array(profile))}")
        r, high = rng.uniform(2, 12), rng.uniform(15, 0.5 * self.length)
        ball = [[r - r * math.cos(angle), r * math.sin(angle)] for angle in np.linspace(0, math.pi / 2, 8)]
        wheel = [[0, 1.8 * r], [4, 1.8 * r], [4, r], [high, r]]
        profile = self.pick([[[0, r], [high, r]], [*ball, [high + r, r]], wheel])  # type: ignore[assignment]
        drawn = numbers(np.array(profile))
        if self.chance(0.3):
            r = round(r, 3)
            bull, barrel = round(0.4 * r, 3), round(high, 3)
            ends = [f"[[0, 0], [{r}, {r}, {{ arc = {r} }}], [{high + r}, {r}]]"]
            ends.append(f"[[0, 0], [0, {r - bull}], [{bull}, {r}, {{ arc = {bull} }}], [{high + r}, {r}]]")
            ends.append(f"[[0, {r}], [{barrel}, {r}, {{ arc = {3 * barrel} }}]]")
            ends.append(f"[[0, {r}], [{barrel}, {r}, {{ arc = {-9 * barrel} }}]]")
            drawn = str(self.pick(ends))
        self.lines.append(f"cutter = {drawn}")
        if self.register == 2:
            self.lines += ["[tools.2]", f"length = {self.lengths[2]}"]

    def rules(self) -> tuple[float, float]:
        """The distances to be kept, at feed and at rapid."""
        keep = round(float(self.pick([0, 0, 1, 5, 15]) * self.rng.uniform(0.5, 1)), 3)  # type: ignore[operator]
        rapid = round(float(self.rng.uniform(0, 10)), 3) if self.chance(0.3) else keep
        self.lines += ["[clearance]", f"keep = {keep}", f"rapid = {rapid}"]
        if self.chance(0.85):
            self.lines.append('rapid_axes = "together"')
        return keep, rapid


class Writer:
    """Writes a program block by block: ``tip``, where the control has it in the frame of the part, and ``turned`` are
    where it stands."""

    def __init__(self, rng: np.random.Generator, machine: Machine, maker: Maker) -> None:
        self.rng, self.machine, self.tcp = rng, machine, maker.tcp
        self.register, self.length = maker.register, maker.lengths[maker.register]
        self.zero = {**{axis.name: 0.0 for axis in machine.axes}, **machine.work_zero()}
        self.zero["Z"] += self.length
        self.tip = rng.uniform([-60, -60, 40], [60, 60, 150])
        self.turned = {axis.name: float(rng.uniform(-40, 40)) for axis in machine.axes if axis.rotary}
        self.can_change = self.tcp
        start = self.positions(self.tip + [0, 0, 300], self.turned)
        self.lines = ["%", "O1", "G21 G17 G40 G80 G90 G94", self.block("G53 G0", start), "T1 M6", "G54"]
        self.lines.append(self.block(self.length_on(), self.words(self.tip, self.turned)))

    @staticmethod
    def block(code: str, words: dict[str, float]) -> str:
        return " ".join([code, *(f"{letter}{value:.3f}" for letter, value in words.items())])

    def length_on(self) -> str:
        return f"{'G43.4' if self.tcp else 'G43'} H{self.register} G0"

    def positions(self, tip: np.ndarray, turned: dict[str, float]) -> dict[str, float]:
        """What the control shows where the tip is there."""
        axes = self.machine.axes
        q = np.array([[float(axis.value(turned.get(axis.name, 0.0))) for axis in axes]])
        q = self.machine.with_tip(tip[None], q, self.length)
        return {axis.name: float(axis.shown(value)) for axis, value in zip(axes, q[0])}

    def words(self, tip: np.ndarray, turned: dict[str, float]) -> dict[str, float]:
        if self.tcp:
            return {**dict(zip("XYZ", tip)), **turned}
        shown = self.positions(tip, turned)
        return {letter: value - self.zero[letter] for letter, value in shown.items()}

    def stand(self, words: dict[str, float]) -> None:
        """Where the words of a block lead."""
        self.turned = {letter: words[letter] for letter in self.turned}
        if self.tcp:
            self.tip = np.array([words[letter] for letter in "XYZ"])
            return
        q = [float(axis.value(words[axis.name] + self.zero[axis.name])) for axis in self.machine.axes]
        self.tip = self.machine.tip_in_part(np.array([q]), self.length)[0]

    def step(self) -> None:
        """A block: a cut, a rapid, an arc, or another way of leading the tip."""
        rng = self.rng
        way, angle = rng.choice([0.3, 3, 20, 80]), rng.choice([0, 0.5, 5, 30])
        tip = np.clip(self.tip + rng.normal(size=3) * way, [-120, -120, -20], [120, 120, 200])
        turned = {
            letter: float(np.clip(value + rng.normal() * angle, -170, 170)) if rng.random() < 0.8 else value
            for letter, value in self.turned.items()
        }
        kind = rng.random()
        if 0.75 <= kind < 0.97:
            self.arc(turned)
            return
        if kind >= 0.97 and self.can_change:
            self.lines.append("G49")
            self.tcp = not self.tcp
        if 0.55 <= kind < 0.75 and rng.random() < 0.3:
            # Out along the tool.
            q = [float(axis.value(self.positions(self.tip, self.turned)[axis.name])) for axis in self.machine.axes]
            held, _ = self.machine.place(0, np.array([q]))
            led, _ = self.machine.place(len(q), np.array([q]))
            tip = self.tip + held[0].T @ led[0] @ self.machine.tool_axis * rng.uniform(5, 100)
            turned = self.turned
        words = self.words(tip, turned)
        if kind < 0.55 and rng.random() < 0.1 and turned:
            words = {**self.words(self.tip, self.turned), **turned}
        code = self.length_on() if kind >= 0.97 else "G0" if kind >= 0.55 else "G1 F1000."
        self.lines.append(self.block(code, words))
        self.stand(words)

    def arc(self, turned: dict[str, float]) -> None:
        """An arc or a helix in one of the planes; of a tip that the control leads rotary axes turn along with it."""
        rng = self.rng
        plane, one, other, across = [(17, *"XYZ"), (18, *"ZXY"), (19, *"YZX")][rng.choice(3, p=[0.6, 0.2, 0.2])]
        start = {letter: round(value, 3) for letter, value in self.words(self.tip, self.turned).items()}
        radius, begin = float(rng.choice([1, 10, 60]) * rng.uniform(0.5, 1)), rng.uniform(0, 2 * np.pi)
        sweep = float(rng.uniform(0.2, 6) * rng.choice([-1, 1]))
        arm = radius * np.array([math.cos(begin), math.sin(begin)])
        centre = np.array([start[one], start[other]]) - arm
        end = centre + radius * np.array([math.cos(begin + sweep), math.sin(begin + sweep)])
        whole = rng.random() < 0.1
        to = dict(start) if whole else {**start, one: float(end[0]), other: float(end[1])}
        words = {one: to[one], other: to[other]}
        if rng.random() < 0.4:
            to[across] = words[across] = start[across] + float(rng.uniform(-20, 20))
        if self.tcp and rng.random() < 0.4:
            to |= turned
            words |= turned
        if rng.random() < 0.25 and not whole and abs(sweep) < 5 and radius > 2:
            words["R"] = math.copysign(radius + 0.001, math.pi - abs(sweep))
        else:
            words |= {"IJK"["XYZ".index(one)]: -arm[0], "IJK"["XYZ".index(other)]: -arm[1]}
        self.lines.append(self.block(f"G{plane} {'G3' if sweep > 0 else 'G2'} F1000.", words))
        self.stand(to)


def world(rng: np.random.Generator, folder: Path, library: Path) -> World:
    """A machine with bodies and a program in ``folder``, as m.toml and p.nc."""
    maker = Maker(rng, folder)
    maker.chain()
    maker.bodies()
    keep, rapid = maker.rules()
    (folder / "m.toml").write_text("\n".join(maker.lines) + "\n")
    machine = Machine.read(folder / "m.toml", library)
    writer = Writer(rng, machine, maker)
    for _ in range(int(rng.choice([3, 10, 30]))):
        writer.step()
    text = "\n".join([*writer.lines, "M30", "%", ""])
    (folder / "p.nc").write_text(text)
    return World(folder, machine, text, maker.length, maker.lengths, keep, rapid)


def shown(machine: Machine, q: np.ndarray) -> Toml:
    """What the control shows of axis values."""
    return {axis.name: float(axis.shown(value)) for axis, value in zip(machine.axes, q)}
