"""Points as a list of points: what posts files posts them too."""

from __future__ import annotations

import os
import tempfile

import numpy as np
from numpy.typing import ArrayLike, NDArray

from post.arguments import along, floats, rows


class PointFile:
    """The list of points, in a folder of its own that goes with it."""

    def __init__(self, points: ArrayLike, axes: ArrayLike, feed: ArrayLike | None, cut: ArrayLike | None) -> None:
        text = list_text(points, axes, feed, cut)
        self._folder = tempfile.TemporaryDirectory(prefix="post-")
        self.path = os.path.join(self._folder.name, "points.csv")
        """Its name."""
        with open(self.path, "w", encoding="ascii") as file:
            file.write(text)


def list_text(points: ArrayLike, axes: ArrayLike, feed: ArrayLike | None, cut: ArrayLike | None) -> str:
    """The lines of a list: a header, then a line for each point in their order."""
    tips = rows("points", points, 3)
    directions = along("axes", axes, tips)
    for name, values in (("points", tips), ("axes", directions)):
        wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))
        if len(wrong):
            raise ValueError(f"{name}[{wrong[0]}] is not finite")
    cuts = np.arange(len(tips)) > 0 if cut is None else each("cut", cut, len(tips)) != 0
    if feed is None and cuts.any():
        raise TypeError("points that are cut to need a feed, mm/min")
    feeds = each("feed", np.inf if feed is None else feed, len(tips))
    wrong = np.flatnonzero(cuts & ~((feeds > 0) & np.isfinite(feeds)))
    if len(wrong):
        raise ValueError(f"feed[{wrong[0]}] is {feeds[wrong[0]]}, not a feed above 0 mm/min")
    lines = ["x,y,z,i,j,k,cut,feed"]
    for tip, direction, rate, is_cut in zip(tips.tolist(), directions.tolist(), feeds.tolist(), cuts.tolist(), strict=True):
        place = ",".join(decimal(value) for value in (*tip, *direction))
        lines.append(f"{place},1,{decimal(rate)}" if is_cut else f"{place},0,")
    return "\n".join([*lines, ""])


def each(name: str, values: ArrayLike, count: int) -> NDArray[np.float64]:
    """A number of each point; a single one is that of all."""
    array = floats(name, values)
    if array.ndim == 0:
        return np.full(count, float(array))
    if array.shape != (count,):
        raise ValueError(f"{name} has the shape {array.shape}, not ({count},)")
    return array


def decimal(value: float) -> str:
    """A number to its last digit, without an exponent."""
    return np.format_float_positional(value, trim="0")
