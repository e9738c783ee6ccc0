"""Arguments as Rust takes them; what cannot be one is refused by its name."""

from __future__ import annotations

import numbers
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Path = str | os.PathLike[str]
Value = str | bool | int | float | np.integer[Any] | np.floating[Any] | Sequence[float]
"""What a setting can be: as in a machine file; a text may be an expression."""


def refuse(name: str, what: str, value: object) -> NoReturn:
    """Says of which argument another kind is wanted."""
    raise TypeError(f"{name} must be {what}, not {type(value).__name__}")


def path(name: str, value: object) -> str:
    """A file or folder by its name."""
    if not isinstance(value, (str, os.PathLike)):
        refuse(name, "a path", value)
    return os.fsdecode(value)


def path_if_any(name: str, value: object) -> str | None:
    """A file or folder by its name, if there is one."""
    return None if value is None else path(name, value)


def several(name: str, what: str, values: object) -> list[object]:
    """What a list has in it; a single text is none."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        refuse(name, f"a list of {what}", values)
    return list(values)


def paths(name: str, values: object) -> list[str]:
    """Files or folders by their names."""
    return [path(name, value) for value in several(name, "paths", values)]


def texts(name: str, values: object) -> list[str]:
    """Texts."""
    return [value if isinstance(value, str) else refuse(name, "a list of texts", value) for value in several(name, "texts", values)]


def number(name: str, value: object) -> float:
    """A number."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Real, np.integer, np.floating)):
        refuse(name, "a number", value)
    return float(value)


def number_if_any(name: str, value: object) -> float | None:
    """A number, if there is one."""
    return None if value is None else number(name, value)


def point(name: str, values: object) -> tuple[float, float, float]:
    """Three coordinates."""
    numbers_of = [number(name, value) for value in several(name, "three numbers", values)]
    if len(numbers_of) != 3:
        raise ValueError(f"{name} has {len(numbers_of)} numbers, not three")
    x, y, z = numbers_of
    return x, y, z


def floats(name: str, values: ArrayLike) -> Floats:
    """An array of float64 in one piece."""
    try:
        # Copied: another thread may write to the caller's while Rust reads.
        return np.array(values, dtype=np.float64, order="C", copy=True)
    except TypeError:
        refuse(name, "an array of numbers", values)
    except ValueError as fault:
        raise ValueError(f"{name} is no array of numbers: {fault}") from None


def rows(name: str, values: ArrayLike, width: int) -> Floats:
    """An array of float64 in one piece, one row a point; a single row is one point."""
    array = floats(name, values)
    if array.ndim == 1 and array.shape == (width,):
        array = array.reshape(1, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} has the shape {array.shape}, not (n, {width})")
    return array


def along(name: str, values: ArrayLike, tips: Floats) -> Floats:
    """Directions of points; a single one is that of all."""
    array = rows(name, values, 3)
    if len(array) == 1 and len(tips) != 1:
        array = np.ascontiguousarray(np.broadcast_to(array, tips.shape))
    if array.shape != tips.shape:
        raise ValueError(f"{name} has the shape {array.shape}, tip {tips.shape}")
    return array


def settings(name: str, values: object) -> list[tuple[str, str]]:
    """Keys of a machine file and their values, as it has them."""
    if values is None:
        return []
    if not isinstance(values, Mapping):
        refuse(name, "a mapping of keys", values)
    return [(str(key), written(f"{name}[{key!r}]", value)) for key, value in values.items()]


def written(name: str, value: object) -> str:
    """A value as a machine file has it."""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, Iterable) and not isinstance(value, (bytes, Mapping)):
        return f"[{', '.join(written(name, item) for item in value)}]"
    refuse(name, "a text, a number, yes or no, or a list", value)


def told(options: Mapping[str, object]) -> list[tuple[str, bool | int | float | str | list[str]]]:
    """Options by their names, as values of Python's own; what is none or false is left out."""
    return [
        (name, plain(name, value)) for name, value in options.items() if value is not None and value is not False
    ]


def plain(name: str, value: object) -> bool | int | float | str | list[str]:
    """A value of an option: numbers of NumPy are numbers, and what can be gone over is a list of texts."""
    if isinstance(value, (np.bool_, np.integer, np.floating)):
        item: bool | int | float = value.item()
        return item
    if isinstance(value, (bool, str, int, float)):
        return value
    if isinstance(value, os.PathLike):
        return path(name, value)
    if isinstance(value, Iterable) and not isinstance(value, bytes):
        return [str(item) for item in value]
    refuse(name, "a text, a number, yes or no, or a list", value)
