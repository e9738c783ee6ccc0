from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

class Machine:
    def __new__(
        cls,
        name: str,
        set: list[tuple[str, str]],
        tool_length: float | None,
        mount: tuple[float, float, float] | None,
        turn: float | None,
        machines: list[str],
        plugins: list[str],
    ) -> Machine: ...
    @property
    def name(self) -> str: ...
    @property
    def has_edge(self) -> bool: ...
    def axes(
        self,
    ) -> list[tuple[str, bool, bool, Literal["mm", "deg"], tuple[float, float] | None]]: ...
    def start(self) -> list[float]: ...
    def forward(self, q: Floats) -> tuple[Floats, Floats]: ...
    def inverse(
        self,
        tip: Floats,
        axis: Floats,
        edge: Floats | None,
        near: Floats,
        within_travel: bool,
    ) -> tuple[Floats, NDArray[np.int64]]: ...
    def route(
        self,
        tip: Floats,
        axis: Floats,
        edge: Floats | None,
        cut: NDArray[np.bool_],
    ) -> Floats: ...
    def deviation(self, q0: Floats, q1: Floats, shares: Floats) -> tuple[Floats, Floats]: ...
