"""What HAL files set of the pins that kinematics take their lengths from.

Nothing is run: `setp`, `sets`, `net`, `loadrt`, `loadusr` and `source` of HAL files and of the INI's HALCMD lines are
read in their order. A pin whose value is computed by what is not known here is refused by its name.
"""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from . import Refused
from .ini import Ini

LIBRARY = Path("/usr/share/linuxcnc/hallib")  # what `LIB:` names
TOOL = "motion.tooloffset.z"
ARROWS = {"=>", "<=", "<=>"}
# What a simulated machine's picture gives where it is started without a value (bridgemill's 5axisgui).
OUTPUTS = {"5axisgui.pivot_len": 250.0}


@dataclass
class Length:
    """A pin's value: a constant, and the share of the tool's length in it."""

    constant: float = 0.0
    tool: float = 0.0


@dataclass
class Hal:
    ini: Ini
    pins: dict[str, str] = field(default_factory=dict)
    signals: dict[str, str] = field(default_factory=dict)
    nets: dict[str, list[str]] = field(default_factory=dict)
    loaded: dict[str, str] = field(default_factory=dict)
    given: dict[str, float] = field(default_factory=dict)
    running: bool = False
    unread: list[str] = field(default_factory=list)  # files and lines of Tcl that were not read
    places: dict[str, str] = field(default_factory=dict)  # where a pin was set or connected last
    asked: set[str] = field(default_factory=set)  # pins whose value was looked for

    def run(self, line: str, place: str) -> None:
        """One line of a HAL file, which stands at `place`."""
        words = self._substituted(line.partition("#")[0]).split()
        if not words:
            return
        verb, rest = words[0], words[1:]
        self.places.update(dict.fromkeys((word.partition("=")[0] for word in words if word not in ARROWS), place))
        if verb == "setp" and len(rest) >= 2:
            self.pins[rest[0]] = rest[1]
        elif "=" in verb and len(words) == 1:  # `pin=value` is short for setp
            name, _, value = verb.partition("=")
            self.pins[name] = value
        elif verb == "sets" and len(rest) >= 2:
            self.signals[rest[0]] = rest[1]
        elif verb == "net" and rest:
            self.nets.setdefault(rest[0], []).extend(word for word in rest[1:] if word not in ARROWS)
        elif verb in ("linksp", "linkps") and len(rest) >= 2:
            arguments = [word for word in rest if word not in ARROWS]
            signal, pin = arguments if verb == "linksp" else reversed(arguments)
            self.nets.setdefault(signal, []).append(pin)
        elif verb in ("loadrt", "loadusr"):
            named = [word for word in rest if not word.startswith("-")]
            if named:
                self.loaded[Path(named[0]).name] = " ".join(named[1:])
        elif verb == "source" and rest:
            self.read(rest[0])

    def read(self, name: str) -> None:
        """A HAL file; of one in Tcl only its plain lines."""
        words = name.split()
        if not words:
            return
        path = LIBRARY / words[0][len("LIB:") :] if words[0].startswith("LIB:") else self.ini.beside(words[0])
        try:
            text = path.read_text(encoding="utf-8", errors="replace")
        except OSError:
            self.unread.append(f"{path}: cannot be read")
            return
        for number, line in _joined(text):
            if path.suffix != ".tcl" or not re.search(r"[$\[{]", line):
                self.run(line, f"{path}:{number}")
            else:
                self.unread.append(f"{path}:{number}: {line.strip()}")

    def length(self, pin: str, default: float) -> Length:
        """The value of a pin that kinematics read."""
        self.asked.add(pin)
        if pin in self.given:
            return Length(self.given[pin])
        signal = next((name for name, pins in self.nets.items() if pin in pins), None)
        if signal is None:
            return self._number(self.pins[pin], pin) if pin in self.pins else self._default(pin, default)
        if signal in self.signals:
            return self._number(self.signals[signal], pin)
        for writer in self.nets[signal]:
            if writer != pin and (value := self._output(writer)) is not None:
                return value
        raise Refused(
            f"{self.places.get(pin, self.ini.path)}: {pin} is on the signal {signal}, and what it is worth is not in the HAL files: say "
            f"--set {pin}=VALUE, or --running while the machine runs"
        )

    def _default(self, pin: str, default: float) -> Length:
        """What a pin is worth that nothing sets, if that is sure."""
        component = pin.partition(".")[0]
        for place in self.unread:
            if component in place or place.endswith("cannot be read"):
                raise Refused(
                    f"{place}: it may set {pin}: say --set {pin}=VALUE (it is {default:g} if nothing sets it)"
                )
        return Length(default)

    def _output(self, pin: str) -> Length | None:
        """What an output is worth, where that is known."""
        if pin == TOOL:
            return Length(tool=1.0)
        self.asked.add(pin)
        component, _, name = pin.rpartition(".")
        names = re.search(r"names=([\w.,-]+)", self.loaded.get("sum2", ""))
        if name == "out" and names and component in names[1].split(","):
            total = self.length(f"{component}.offset", 0.0)
            for each in ("0", "1"):
                gain = self.length(f"{component}.gain{each}", 1.0)
                value = self.length(f"{component}.in{each}", 0.0)
                total.constant += gain.constant * value.constant
                total.tool += gain.constant * value.tool
            return total
        if pin in self.given:
            return Length(self.given[pin])
        if self.running and (value := _running(pin)) is not None:
            return Length(value)
        if pin in OUTPUTS:
            said = re.search(rf"{name}=([-+.\d]+)", self.loaded.get(component, ""))
            return Length(float(said[1]) if said else OUTPUTS[pin])
        return None

    def _number(self, text: str, pin: str) -> Length:
        try:
            return Length(float(text))
        except ValueError:
            raise Refused(f"{self.places.get(pin, self.ini.path)}: {pin} is set to {text!r}, which is not a number") from None

    def _substituted(self, line: str) -> str:
        """A line with what it takes from the INI file: `[SECTION]KEY` or `[SECTION](KEY)`."""
        return re.sub(r"\[(\w+)\]\(?(\w+)\)?", lambda found: self.ini.text(found[1], found[2], found[0]), line)


def _joined(text: str) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; one that ends in a backslash goes on in the next."""
    begun, first = "", 0
    for number, line in enumerate(text.splitlines(), 1):
        first = first if begun else number
        begun += line.removesuffix("\\") + " " * line.endswith("\\")
        if not line.endswith("\\"):
            yield first, begun
            begun = ""
    if begun:
        yield first, begun


def _running(pin: str) -> float | None:
    """The value of a pin of the LinuxCNC that runs here."""
    try:
        answer = subprocess.run(["halcmd", "getp", pin], capture_output=True, text=True, timeout=10)
        return float(answer.stdout)
    except (OSError, ValueError, subprocess.TimeoutExpired):
        return None


def read(ini: Ini, given: dict[str, float], running: bool) -> Hal:
    """All HAL files and HALCMD lines of a machine, in the order in which LinuxCNC takes them."""
    hal = Hal(ini, given=given, running=running)
    for entry in ini.entries("HAL", "HALFILE"):
        hal.read(entry.text)
    for entry in ini.entries("HAL", "HALCMD"):
        hal.run(entry.text, entry.place)
    for entry in ini.entries("HAL", "POSTGUI_HALFILE"):
        hal.read(entry.text)
    return hal
