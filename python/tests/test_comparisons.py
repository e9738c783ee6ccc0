"""The book's page of comparisons: quick rows come out as the page has them, and what a row measures."""

import math
import os
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import CHECKOUT, COMMAND

pytest.importorskip("tomllib", reason="Python 3.11 reads the rows")


def comparisons(*words: str) -> "subprocess.CompletedProcess[str]":
    # The script takes python3 as PATH has it.
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "POST_COMMAND": COMMAND, "PATH": path}
    return subprocess.run([CHECKOUT / "docs/comparisons", *words], env=environment, capture_output=True, text=True)


def test_quick_rows_come_out_as_the_page_has_them() -> None:
    run = comparisons("--check")
    print(run.stdout)
    assert run.returncode == 0, run.stderr


def test_a_row_that_something_is_missing_for_has_no_figure() -> None:
    if (CHECKOUT.parent / "MultiAxis_3DP_MotionPlanning").exists():
        pytest.skip("the authors' repository is beside the checkout")
    run = comparisons("ral-published")
    assert run.returncode == 0, run.stderr
    cells = [cell.strip() for cell in run.stdout.split(" | ")]
    assert cells[2].startswith("not run here (") and cells[3].startswith("not run here: the authors' repository")


def pole(*words: str | Path) -> "subprocess.CompletedProcess[str]":
    environment = {**os.environ, "PATH": f"{Path(COMMAND).parent}{os.pathsep}{os.environ['PATH']}"}
    command = [sys.executable, CHECKOUT / "docs/comparing/pole.py", *words]
    return subprocess.run(command, env=environment, capture_output=True, text=True)


def test_a_published_program_is_read_beside_its_waypoints(tmp_path: Path) -> None:
    """By hand: B stands at -10°, C goes from 0° to 90° in steps of 45° and back at once in the next pass; one block tilts
    by 3° more than its waypoint."""
    waypoints = tmp_path / "DataSet/Sorce/made/waypoint"
    waypoints.mkdir(parents=True)
    lines = ["G90", "G28 X0.000 Y0.000 Z230.000 B0.000 C0.000 F5250"]
    for number, turns in enumerate(([0.0, 45.0, 90.0], [90.0, 45.0, 0.0])):
        rows = []
        lines.append("G0 Z50.000 F4750")
        for turn in turns:
            b, c = math.radians(-10), math.radians(turn)
            axis = (-math.cos(c) * math.sin(b), math.sin(c) * math.sin(b), math.cos(b))
            rows.append(f"{turn / 10:.6f} {number} 0 " + " ".join(f"{value:.9f}" for value in axis))
            tilted = -13.0 if (number, turn) == (1, 45.0) else -10.0
            lines.append(f"G1 X0.000 Y0.000 Z0.000 B{tilted:.3f} C{turn:.3f} E1.000")
        (waypoints / f"{number}.txt").write_text("\n".join(rows) + "\n")
    (tmp_path / "DataSet/Gcode").mkdir()
    program = tmp_path / "DataSet/Gcode/made_Gcode.txt"
    program.write_text("\n".join(lines) + "\n")
    run = pole(tmp_path, "--model", "made")
    assert run.returncode == 0, run.stderr
    said = run.stdout.splitlines()
    assert said[0] == "waypoints: 6 in 2 passes, made"
    assert said[1] == "published program: C 180°, at most 45.0° a block, axis off 3.00°"
    # Its places are all the crossing of the axes, the last waypoint of a pass the farthest from there.
    assert said[2] == f"its places are within {math.hypot(9, 1, 40.5):.3f} mm of the waypoints"
    # Points are put in, so that a step of ours is smaller; the way is the same where every point is met.
    assert said[3].startswith("post, met exactly: C 180°, at most ")
    # A program with another number of cuts is not that of these waypoints.
    program.write_text("\n".join(lines[:-1]) + "\n")
    run = pole(tmp_path, "--model", "made")
    assert run.returncode == 3 and "5 cuts, and there are 6 waypoints" in run.stderr
