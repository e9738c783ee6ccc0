"""What is refused, and why."""

from __future__ import annotations

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


def diagnostics(told: Iterable[Told]) -> tuple[Diagnostic, ...]:
    """Findings as Rust tells them."""
    return tuple(Diagnostic(*fields) for fields in told)  # type: ignore[arg-type]


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
