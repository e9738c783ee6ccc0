"""Machines of FreeCAD's machine editor and machine files of `post`, there and back."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from conftest import CHECKOUT, COMMAND

HERE = CHECKOUT / "editors/freecad"
MACHINES = CHECKOUT / "machines"


def converted(source: Path, to: Path, *more: str) -> "subprocess.CompletedProcess[str]":
    command = [sys.executable, HERE / "post-fcm", source, "-o", to, "--post", COMMAND, *more]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.mark.skipif(sys.version_info < (3, 11), reason="tomllib is of Python 3.11")
@pytest.mark.parametrize(
    "name",
    [
        *("vmc", "umc-750", "xyzac-trt", "head-head", "dmu50", "bc-fork", "linuxcnc-5axis", "head-table-bc"),
        *("ac-trunnion", "grbl-router", "osp-mill"),
    ],
)
def test_a_machine_comes_back_from_freecads_file(name: str, tmp_path: Path) -> None:
    """The law, travels and speeds, to the last digit that `post check` compares."""
    there, back = tmp_path / f"{name}.fcm", tmp_path / f"{name}.toml"
    run = converted(MACHINES / f"{name}.toml", there)
    assert run.returncode == 0, run.stderr
    run = converted(there, back)  # as the page types it: the remarks name the dialect
    assert run.returncode == 0, run.stderr
    compared = subprocess.run(
        [COMMAND, "check", back, "--nominal", MACHINES / f"{name}.toml"], capture_output=True, text=True
    )
    assert compared.returncode == 0, compared.stderr
    assert (
        "tip deviation     at most 0.00000 mm" in compared.stdout
        and "axis deviation    at most 0.000000°" in compared.stdout
    )

    def axes(machine: Path) -> list[tuple[object, ...]]:
        told = tmp_path / "check.json"
        subprocess.run([COMMAND, "check", machine, "--json", told], capture_output=True, check=True)
        found = json.loads(told.read_text())["class"]["axes"]
        return sorted((each["name"], tuple(each["travel"] or (-36000, 36000)), each["max_feed"]) for each in found)

    assert axes(back) == axes(MACHINES / f"{name}.toml")


def freecad_machine(**changes: object) -> dict[str, object]:
    """A mill with a table C on a trunnion A, in the form that FreeCAD 1.2 writes."""

    def axis(
        kind: str, role: str, vector: list[float], least: float, most: float, parent: str | None = None
    ) -> dict[str, object]:
        return {
            "type": kind,
            "role": role,
            "parent": parent,
            "sequence": 0,
            "joint": [[0, 0, 0], vector],
            "limits": {"min": least, "max": most},
            "max_velocity": 600,
        }

    axes = {
        "X": axis("linear", "table_linear", [1, 0, 0], 0, 20),
        "Y": axis("linear", "table_linear", [0, 1, 0], 0, 14),
        "Z": axis("linear", "head_linear", [0, 0, 1], 0, 16),
        "C": axis("rotary", "table_rotary", [0, 0, 1], -360, 360),
        "A": axis("rotary", "table_rotary", [-1, 0, 0], -120, 30, "C"),
    }
    machine: dict[str, object] = {
        "name": "MCV",
        "manufacturer": "Dah",
        "units": "imperial",
        "axes": axes,
        "toolheads": [{"name": "Spindle", "max_rpm": 6000}],
    }
    machine.update(changes)
    return {"machine": machine, "postprocessor": {"file_name": "fanuc"}, "version": 1}


def test_units_senses_and_the_order_of_a_table(tmp_path: Path) -> None:
    """FreeCAD turns about Z first and tilts then, whichever it calls the parent; its table angles are against ISO 841."""
    (tmp_path / "mcv.fcm").write_text(json.dumps(freecad_machine()))
    run = converted(tmp_path / "mcv.fcm", tmp_path / "mcv.toml", "--gauge", "0,0,500")
    assert run.returncode == 0, run.stderr
    text = (tmp_path / "mcv.toml").read_text()
    assert "chain = \"[w C' A' Y' X' b Z (S) t]\"" in text and 'name  = "Dah MCV"' in text
    assert "travel   = [0, 508]" in text and "max_feed = 15240" in text and "max_speed = 6000" in text
    table = dict(part.split("\n\n")[0].split("]\n", 1) for part in text.split("[axis.")[1:])
    assert "reversed = true" in table["C"] and "reversed" not in table["A"]
    assert 'dialect = "fanuc"' in text and 'tcp     = "post"' in text and "gauge = [0, 0, 500]" in text


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        (("axes", "X", "joint"), [[0, 0, 0], [0, 0, 0]], "has no length"),
        (("axes", "X", "limits"), {"min": 5, "max": 5}, "no travel"),
        (("axes", "A", "parent"), "Q", "its parent Q is not there"),
        (("axes", "X", "parent"), "C", "a linear axis on a rotary one"),
        (("toolheads",), [{"name": "Laser", "toolhead_type": "laser"}], "no spindle"),
        (("kinematics",), {"base_frame": {"origin": [1, 0, 0]}}, "base_frame"),
        (("units",), "cubits", "metric or imperial"),
        (("axes",), {}, "no axes"),
        (("axes",), ["X"], "no JSON object"),
        (("axes", "C", "role"), "foo", "its role 'foo' is not table_rotary or head_rotary"),
        (("axes", "C", "role"), "head_linear", "its role 'head_linear' is not"),
        (("axes", "A", "role"), "head_rotary", "but C, table_rotary, carries it"),
        (("axes", "X", "limits"), {"min": float("nan"), "max": 5}, "limits.min: nan"),
        (("axes", "X", "limits"), {"min": 0, "max": 1e300}, "limits.max: 1e+300"),
        (("axes", "X", "max_velocity"), "fast", "max_velocity: 'fast' is no number"),
        (("axes", "X", "max_velocity"), -5, "max_velocity -5 is negative"),
        (("axes", "X", "joint"), [[0, 0], [1, 0, 0]], "[0, 0] are not three numbers"),
        (("name",), "M\nCV", "cannot be printed"),
        (("name",), 5, "not both are texts"),
        (("kinematics",), [], "no JSON object"),
        (("toolheads",), [{"max_rpm": "a"}], "max_rpm: 'a' is no number"),
        (("toolheads",), "one", "no list"),
    ],
)
def test_what_freecads_file_leaves_open_is_refused(
    path: tuple[str, ...], value: object, told: str, tmp_path: Path
) -> None:
    data = freecad_machine()
    at = data["machine"]
    for key in path[:-1]:
        assert isinstance(at, dict)
        at = at[key]
    assert isinstance(at, dict)
    at[path[-1]] = value
    (tmp_path / "mcv.fcm").write_text(json.dumps(data))
    run = converted(tmp_path / "mcv.fcm", tmp_path / "mcv.toml")
    assert run.returncode == 1 and told in run.stderr
    assert sorted(each.name for each in tmp_path.iterdir()) == ["mcv.fcm"]


@pytest.mark.parametrize(
    ("dialect", "line"),
    [
        ("grbl", "retract = { Z = 404.4 }"),  # 2 mm below the upper end of 16 in
        ("okuma", "retract = { Z = 406.4 }"),
        ("klipper", "retract = {}"),
        ("marlin", "retract = {}"),
        ("brother", 'unit_system = "mm"'),
    ],
)
def test_a_control_that_is_told_more_gets_what_post_new_writes(
    dialect: str, line: str, tmp_path: Path
) -> None:
    (tmp_path / "mcv.fcm").write_text(json.dumps(mill()))
    run = converted(tmp_path / "mcv.fcm", tmp_path / "mcv.toml", "--dialect", dialect)
    assert run.returncode == 0, run.stderr
    assert line in (tmp_path / "mcv.toml").read_text()


def mill() -> dict[str, object]:
    """The one with three axes."""
    data = freecad_machine()
    machine = data["machine"]
    assert isinstance(machine, dict)
    for letter in "AC":
        del machine["axes"][letter]
    return data


def test_a_machine_that_post_check_refuses_is_not_written(tmp_path: Path) -> None:
    """The one that stood there stays, byte by byte, and nothing beside it."""
    (tmp_path / "mcv.fcm").write_text(json.dumps(freecad_machine()))
    (tmp_path / "mcv.toml").write_text("# the good one\n")
    run = converted(tmp_path / "mcv.fcm", tmp_path / "mcv.toml", "--dialect", "klingon")
    assert run.returncode == 1 and "nothing was written" in run.stderr and "mcv.toml" in run.stderr
    assert ".mcv." not in run.stderr  # the name under which it was checked is nobody's concern
    assert (tmp_path / "mcv.toml").read_text() == "# the good one\n"
    assert sorted(each.name for each in tmp_path.iterdir()) == ["mcv.fcm", "mcv.toml"]


@pytest.mark.parametrize("mark", [b"", b"\xef\xbb\xbf"])
def test_a_byte_order_mark_is_taken_and_a_speed_of_zero_told(mark: bytes, tmp_path: Path) -> None:
    data = freecad_machine()
    machine = data["machine"]
    assert isinstance(machine, dict)
    machine["axes"]["Y"]["max_velocity"] = 0
    (tmp_path / "mcv.fcm").write_bytes(mark + json.dumps(data).encode())
    run = converted(tmp_path / "mcv.fcm", tmp_path / "mcv.toml")
    assert run.returncode == 0 and "axis Y: its max_velocity is 0" in run.stderr
    assert (tmp_path / "mcv.toml").read_text().count("max_feed") == 4


@pytest.mark.skipif(sys.version_info < (3, 11), reason="tomllib is of Python 3.11")
@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("lathe-xzc-radial", "[tool] axis = [1, 0, 0]"),
        ("lathe-xz", "[word]"),
        ("linear-delta", "[leg]"),
        ("tricept", "[formulas], [drive]"),
        ("head-change", "[head]"),
        ("hmc-b-pallet", "axis B"),
    ],
)
def test_a_law_that_freecads_file_cannot_hold_is_refused(name: str, told: str, tmp_path: Path) -> None:
    run = converted(MACHINES / f"{name}.toml", tmp_path / "out.fcm")
    assert run.returncode == 1 and told in run.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.version_info < (3, 11), reason="tomllib is of Python 3.11")
def test_a_table_whose_c_carries_another_axis_is_refused(tmp_path: Path) -> None:
    """FreeCAD turns about Z first: the part would stand elsewhere, at the same angles."""
    text = (MACHINES / "ac-trunnion.toml").read_text()
    (tmp_path / "ca.toml").write_text(text.replace("C' A'", "A' C'"))
    assert "A' C'" in (tmp_path / "ca.toml").read_text()
    run = converted(tmp_path / "ca.toml", tmp_path / "ca.fcm")
    assert run.returncode == 1 and "turns a table about Z first" in run.stderr
    assert not (tmp_path / "ca.fcm").exists()


@pytest.mark.skipif(sys.version_info < (3, 11), reason="tomllib is of Python 3.11")
def test_what_else_is_lost_is_told_by_its_name(tmp_path: Path) -> None:
    run = converted(MACHINES / "vmc-a.toml", tmp_path / "vmc-a.fcm")
    assert run.returncode == 0
    told = next(line for line in run.stderr.splitlines() if "not in FreeCAD's file" in line)
    for lost in ("[workpiece]", "[accuracy]", "[axis.A] cyclic", "[axis.A] range", "[axis.X] max_accel"):
        assert lost in told
    assert "max_feed" not in told and "gauge" not in told
