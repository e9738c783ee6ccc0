"""The least time along a curve by TOPPRA and by `papers plan`: the same path, the same limits of velocity and acceleration.

    docs/comparing/path_time.py CURVE [--samples N]      needs the Python packages toppra and scipy

The path is worked out here from the control points of the curve file, apart from `papers`: of X and Y alone, or on a dual
rotary table AC whose axes meet in the part origin. Limits of feed, jerk, chord and contour error are left out on both
sides. TOPPRA keeps limits at its samples and, by its interpolation scheme, at the next one; `papers plan` between them too.
"""

import argparse
import json
import tempfile
from pathlib import Path
from typing import Any

from measuring import absent, command, run

try:
    import numpy as np
    import toppra
    import toppra.algorithm
    import toppra.constraint
    from scipy.interpolate import BSpline
except ModuleNotFoundError as missing:
    absent(f"the Python package {missing.name} is not installed")

FREE = "1000000"
"""A feed that is no limit, mm/min."""


def axes_along(curve: dict[str, Any], at: "np.ndarray[Any, Any]") -> "np.ndarray[Any, Any]":
    """Axis values at these parameters, a row each: mm, and radians of A and C."""
    if "weights" in curve:
        absent("a curve with weights is no polynomial B-spline")
    knots, degree = np.array(curve["knots"], float), int(curve["degree"])

    def spline(points: list[list[float]]) -> "np.ndarray[Any, Any]":
        return BSpline(knots, np.array(points, float), degree)(at)

    tip = spline(curve.get("control_points_mm") or curve["P_tool_tip"])
    if "H_second_point_on_axis" not in curve:
        return tip
    axis = spline(curve["H_second_point_on_axis"]) - tip
    a = np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])
    c = np.unwrap(np.arctan2(axis[:, 0], axis[:, 1]))
    # The part is turned by C about Z, then by A about X.
    x = np.cos(c) * tip[:, 0] - np.sin(c) * tip[:, 1]
    y = np.sin(c) * tip[:, 0] + np.cos(c) * tip[:, 1]
    return np.column_stack([x, np.cos(a) * y - np.sin(a) * tip[:, 2], np.sin(a) * y + np.cos(a) * tip[:, 2], a, c])


def bounds(curve: dict[str, Any], count: int, name: str) -> "np.ndarray[Any, Any]":
    """The limits of the axes in their order, `v` or `a`: mm and radians."""
    limits = curve["limits"]
    if count == 2:
        return np.full(2, float(limits["XY"][name]))
    return np.array([limits["XYZ"][name]] * 3 + [limits[letter][name] for letter in "AC"], float)


def by_toppra(curve: dict[str, Any], samples: int) -> tuple[float, float]:
    """Seconds, and by what share its motion passes a limit of acceleration between its samples at most."""
    at = np.linspace(0.0, 1.0, samples)
    rows = axes_along(curve, at)
    velocity, acceleration = (bounds(curve, rows.shape[1], name) for name in "va")
    kept = [
        toppra.constraint.JointVelocityConstraint(np.column_stack([-velocity, velocity])),
        toppra.constraint.JointAccelerationConstraint(
            np.column_stack([-acceleration, acceleration]),
            discretization_scheme=toppra.constraint.DiscretizationType.Interpolation,
        ),
    ]
    path = toppra.SplineInterpolator(at, rows)
    planner = toppra.algorithm.TOPPRA(kept, path, gridpoints=at, solver_wrapper="seidel",
        parametrizer="ParametrizeConstAccel")
    planned = planner.compute_trajectory(0.0, 0.0)
    if planned is None:
        absent("TOPPRA finds no plan")
    times = np.linspace(0.0, planned.duration, 20 * samples)
    passed = np.max(np.abs(planned(times, 2)) / acceleration) - 1.0
    return float(planned.duration), float(max(0.0, passed))


def by_papers(file: Path, curve: dict[str, Any], samples: int) -> tuple[float, float]:
    """Seconds, and the largest share of a limit that is taken anywhere, between samples too."""
    limits = {name: dict(limit) for name, limit in curve["limits"].items() if name in ("XY", "XYZ", "A", "C")}
    for limit in limits.values():
        limit.pop("j", None)
    with tempfile.TemporaryDirectory() as room:
        bare, plan = Path(room) / file.name, Path(room) / "plan.json"
        bare.write_text(json.dumps({**curve, "limits": limits}))
        spans = len(set(curve["knots"])) - 1
        each = max(1, samples // spans)
        run(command("papers"), "plan", bare, "--samples", str(each * spans), "--feed", FREE, "-q", "-o", plan)
        found = json.loads(plan.read_text())
        return float(found["seconds"]), max(limit["largest_share"] for limit in found["limits"] if limit["kept"])


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("curve", type=Path)
    asked.add_argument("--samples", type=int, default=20001)
    given = asked.parse_args()
    if not given.curve.is_file():
        absent(f"{given.curve} is not here")
    curve = json.loads(given.curve.read_text())
    theirs, passed = by_toppra(curve, given.samples)
    ours, share = by_papers(given.curve, curve, given.samples)
    print(f"TOPPRA {theirs:.4f} s, papers plan {ours:.4f} s, {100 * (ours / theirs - 1):+.3f} %")
    print(f"TOPPRA passes a limit of acceleration between its samples by up to {100 * passed:.2f} %")
    print(f"papers plan takes at most {100 * share:.2f} % of a limit")


if __name__ == "__main__":
    main()
