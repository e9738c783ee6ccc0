"""What is refused, and why."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

Told = tuple[str, str, str, str | None, str | None, int | None, str | None]


@dataclass(frozen=True)
class Diagnostic:
    """A warning, or a reason to refuse."""

    severity: Literal["warning", "error"]
    code: str
    """A stable name for programs to read, as ``post`` prints it in brackets."""
    message: str
    """What, with the value and the limit."""
    help: str | None = None
    """What would help."""
    file: str | None = None
    line: int | None = None
    """Line of that file, counted from 1."""
    text: str | None = None
    """The line."""

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}: " if self.file is not None else ""
        help = f" ({self.help})" if self.help is not None else ""
        return f"{place}{self.severity}[{self.code}]: {self.message}{help}"


_SET = re.compile(r"(?<![\w-])--set '?([\w.]+)=([^\s',;)]+)'?")
_FLAG = re.compile(r"(?<![\w-])--([a-z][a-z0-9]*(?:-[a-z0-9]+)*)(?:\[?=?<[^>]*>\]?| <[^>]*>)?(?: (-?[0-9][0-9.]*(?:,-?[0-9][0-9.]*)*))?")


def as_arguments(text: str) -> str:
    """What is said of flags of the command said of arguments: ``--tool-length 120`` is ``tool_length=120``."""
    text = _SET.sub(r'set={"\1": \2}', text)

    def argument(flag: re.Match[str]) -> str:
        name, value = flag[1].replace("-", "_"), flag[2]
        if value is None:
            return name
        # A sentence may end behind a number.
        number = value.rstrip(".,")
        return f"{name}={f'({number})' if ',' in number else number}{value[len(number):]}"

    return _FLAG.sub(argument, text)


def diagnostics(told: Iterable[Told]) -> tuple[Diagnostic, ...]:
    """Findings as Rust tells them, in words of Python."""

    def finding(fields: Told) -> Diagnostic:
        severity, code, message, help, file, *place = fields
        help = None if help is None else as_arguments(help)
        # What is set over the machine file is a text of its own.
        file = "set" if file == "--set" else file
        return Diagnostic(severity, code, as_arguments(message), help, file, *place)  # type: ignore[arg-type]

    return tuple(finding(fields) for fields in told)


class PostError(Exception):
    """What was asked for is refused: ``diagnostics`` says why, warnings that came before it included."""

    diagnostics: tuple[Diagnostic, ...]

    def __init__(self, diagnostics: Iterable[Diagnostic] = ()) -> None:
        self.diagnostics = tuple(diagnostics)
        super().__init__(self.diagnostics)

    @classmethod
    def of(cls, told: Iterable[Told]) -> PostError:
        """Of findings as Rust tells them."""
        return cls(diagnostics(told))

    def __str__(self) -> str:
        errors = [one for one in self.diagnostics if one.severity == "error"]
        return "\n".join(str(one) for one in errors or self.diagnostics)
