"""What users of Python expect of any package: Ctrl-C, tables, pickles, and exceptions in words of Python."""

import multiprocessing
import os
import pickle
import re
import signal
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import post
import pytest
from conftest import CHECKOUT
from test_jobs import long_file

Command = Callable[..., "subprocess.CompletedProcess[str]"]

# Each takes far longer than a second if nobody ends it.
LONG = {
    "post": "machine.post('long.cls', blocks=False)",
    "verify": "job.verify()",
    "predict": "job.predict(period=0.0001)",
    "Machine.read": "machine.read('long.nc')",
    "Machine.verify": "machine.verify('long.nc', 'long.cls')",
    "Machine.predict": "machine.predict('long.nc', period=0.0001)",
    "Machine.lint": "machine.lint('long.nc')",
    "inverse": "machine.inverse(tip, axis)",
    "route": "machine.route(tip, axis)",
}


@pytest.fixture(scope="module")
def long_program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A CL file and its program that take a while."""
    folder = tmp_path_factory.mktemp("long")
    long_file(folder / "long.cls", 500_000)
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    made = machine.post(folder / "long.cls", output=folder / "long.nc", blocks=False)
    text = made.nc.splitlines()
    # Its blocks over and over: longer than anyone waits.
    first = next(number for number, line in enumerate(text) if "G1" in line)
    body = text[first : len(text) - 10]
    (folder / "long.nc").write_text("\n".join([*text[:first], *body * 3, *text[-10:], ""]))
    return folder


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT between processes")
@pytest.mark.parametrize("what", LONG)
def test_ctrl_c_is_heard(what: str, long_program: Path) -> None:
    script = f"""
        import post, signal
        import numpy as np
        # A shell that started all this in the background has it ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        machine = post.Machine.load("ac-trunnion", tool_length=120)
        job = machine.post("long.cls", blocks=False) if {what!r} in ("verify", "predict") else None
        turn = np.arange(3_000_000) / 200
        tip = np.column_stack([30 * np.cos(turn), 30 * np.sin(turn), 0 * turn])
        axis = np.column_stack([0.3 * np.cos(turn), 0.3 * np.sin(turn), 0 * turn + 1])
        print("begun", flush=True)
        try:
            {LONG[what]}
            print("done", flush=True)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        machine.forward(machine.inverse(tip[:2], axis[:2])[0][:, 0])
        print("alive", flush=True)
    """
    arguments = [sys.executable, "-c", textwrap.dedent(script)]
    child = subprocess.Popen(arguments, cwd=long_program, stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    # Of arrays of three million points copies are made first, in Python, which hears for itself; half a second posts the file.
    time.sleep(0.3 if what in ("inverse", "route") else 0.1)
    child.send_signal(signal.SIGINT)
    sent = time.monotonic()
    told = child.stdout.readline()
    heard = time.monotonic() - sent
    rest = child.stdout.read()
    assert (told, rest, child.wait(60)) == ("interrupted\n", "alive\n", 0)
    assert heard < 3.0, heard


def test_blocks_are_a_table(room: Path) -> None:
    """In pandas, polars and Arrow: a value a block in each column, numbers as numbers and words as words."""
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    pyarrow = pytest.importorskip("pyarrow")
    # In a tilted plane words are no places of axes.
    machine = post.Machine.load("ac-trunnion", tool_length=120, set={"control.planes": False})
    job = machine.post("part.cls")
    blocks = job.blocks
    count = job.summary["blocks"]
    parts = [*(f"q_{name}" for name in blocks.axes), *(f"{name}_{part}" for name in ("tip", "axis") for part in "xyz")]
    assert set(parts) < set(blocks) and not {"q", "tip", "axis"} & set(blocks)
    assert all(values.ndim == 1 for values in blocks.values())
    assert blocks["q"].shape[1] == len(blocks.axes) and blocks["tip"].shape[1] == 3
    frames = {
        "pandas": pandas.DataFrame(blocks),
        "polars": polars.DataFrame(blocks),
        "arrow": pyarrow.RecordBatchReader.from_stream(blocks).read_all(),
        "polars of Arrow": polars.from_arrow(blocks.to_arrow()),
    }
    for name, frame in frames.items():
        columns = frame.column_names if name == "arrow" else list(frame.columns)
        assert columns == list(blocks), name
        assert len(frame) == len(blocks["time_s"]) >= count > 0, name
    pandas_frame, table = frames["pandas"], frames["arrow"]
    assert {pandas_frame[part].dtype.kind for part in parts} == {"f"}
    assert pandas_frame["nc_line"].dtype.kind == "i" and pandas_frame["off_part"].dtype.kind == "b"
    assert set(pandas_frame["kind"]) == set(table["kind"].to_pylist()) == set(blocks["kind"])
    assert frames["polars"].schema["time_s"] == polars.Float64 and frames["polars"].schema["nc_line"] == polars.Int64
    # What nothing made slower is no word at all.
    assert table["limit"].null_count == np.count_nonzero(blocks["limit"] == "")
    # What the last block prints of the axes, but for Z, whose word is that of the tip.
    words = dict(re.findall(r"([XYAC])(-?[0-9.]+)", job.nc.splitlines()[blocks["nc_line"].max() - 1]))
    last = int(np.argmax(blocks["nc_line"]))
    assert words
    for letter, value in words.items():
        assert pandas_frame[f"q_{letter}"][last] == pytest.approx(float(value), abs=6e-4)
    assert np.array_equal(pandas_frame[["tip_x", "tip_y", "tip_z"]].to_numpy(), blocks["tip"])


def solved(machine: post.Machine) -> bytes:
    """Axis values of a point, to the last bit."""
    return machine.inverse([1.0, 2.0, 3.0], [0.1, 0.2, 1.0])[0].tobytes()


def test_a_machine_goes_to_other_processes(room: Path) -> None:
    settings: dict[str, Any] = {"tool_length": 87.25, "mount": (1, 2, 3), "turn": 15, "set": {"axis.A.travel": [-90, 90]}}
    machine = post.Machine.load("ac-trunnion", **settings)
    again = pickle.loads(pickle.dumps(machine))
    assert solved(again) == solved(machine) != solved(post.Machine.load("ac-trunnion"))
    assert [axis.travel for axis in again.axes if axis.name == "A"] == [(-90, 90)]
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.map(solved, [machine]) == [solved(machine)]
    # A file of the user's is found from another folder.
    (room / "mine.toml").write_text('extends = "ac-trunnion"\nname = "mine"\n')
    kept = pickle.dumps(post.Machine.load("mine.toml"))
    (room / "elsewhere").mkdir()
    os.chdir(room / "elsewhere")
    assert pickle.loads(kept).name == "mine"


WRONG: dict[str, Callable[[post.Machine], object]] = {
    "name": lambda machine: post.Machine.load(3),  # type: ignore[arg-type]
    "tool_length": lambda machine: post.Machine.load("vmc", tool_length="long"),  # type: ignore[arg-type]
    "mount": lambda machine: post.Machine.load("vmc", mount=5),  # type: ignore[arg-type]
    "turn": lambda machine: post.Machine.load("vmc", turn=[1]),  # type: ignore[arg-type]
    "machines": lambda machine: post.Machine.load("vmc", machines="folder"),
    "plugins": lambda machine: post.Machine.load("vmc", plugins=[1]),  # type: ignore[list-item]
    "set": lambda machine: post.Machine.load("vmc", set=["Lm=3"]),  # type: ignore[arg-type]
    "set['Lm']": lambda machine: post.Machine.load("vmc", set={"Lm": object()}),  # type: ignore[dict-item]
    "path": lambda machine: machine.post(5),  # type: ignore[arg-type]
    "output": lambda machine: machine.post("part.cls", output=5),  # type: ignore[arg-type]
    "tolerance": lambda machine: machine.post("part.cls", tolerance=object()),  # type: ignore[arg-type]
    "q": lambda machine: machine.forward({}),  # type: ignore[arg-type]
    "tip": lambda machine: machine.inverse(object(), [0, 0, 1]),  # type: ignore[arg-type]
    "program": lambda machine: machine.lint(None),  # type: ignore[arg-type]
    "against": lambda machine: machine.verify("part.nc", None),  # type: ignore[arg-type]
    "period": lambda machine: machine.predict("part.nc", period="short"),  # type: ignore[arg-type]
    "ignore": lambda machine: machine.lint("part.nc", ignore="coolant"),
    "files": lambda machine: post.study(7, ["vmc"]),  # type: ignore[arg-type]
}


@pytest.mark.parametrize("argument", WRONG)
def test_a_type_error_names_the_argument(argument: str, room: Path) -> None:
    with pytest.raises(TypeError) as refused:
        WRONG[argument](post.Machine.load("ac-trunnion"))
    assert str(refused.value).startswith(f"{argument} must be ")


def test_exceptions_are_in_words_of_python(room: Path) -> None:
    machine = post.Machine.load("ac-trunnion", tool_length=120)

    def why(do: Callable[[], object]) -> str:
        with pytest.raises(post.PostError) as refused:
            do()
        return str(refused.value)

    assert "invalid value '-1' for 'tolerance'" in why(lambda: machine.post("part.cls", tolerance=-1))
    told = [
        why(lambda: machine.post("part.cls", tolerance=-1)),
        why(lambda: machine.post("part.cls", tolerence=1)),  # type: ignore[call-arg]
        why(lambda: machine.post("part.cls", units="feet")),  # type: ignore[arg-type]
        why(lambda: machine.post("part.cls", plan_rounds=2)),
        why(lambda: machine.post(CHECKOUT / "tests/machines/ac-trunnion.refused.cls")),
        why(lambda: post.Machine.load("ac-trunnion", set={"mount.x": 1})),
    ]
    assert not [text for text in told if re.search(r"(?<![\w-])--\w", text)]


def test_flags_become_arguments() -> None:
    from post.refusal import as_arguments

    for said, meant in {
        "give --tool-length 120": "give tool_length=120",
        "--mount 1,2,-3. Then": "mount=(1,2,-3). Then",
        "for '--tolerance <MM>'": "for 'tolerance'",
        "--set control.tcp=post writes": 'set={"control.tcp": post} writes',
        "X is -12, G1--2 and a -- b": "X is -12, G1--2 and a -- b",
    }.items():
        assert as_arguments(said) == meant


def test_any_program_is_read_as_by_the_command(room: Path, command: Command) -> None:
    told = ["--machine", "ac-trunnion", "--tool-length", "120"]
    assert command("part.cls", *told, "-o", "part.nc", "-q").returncode == 0
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    for flags, found, file in (
        (["verify", "--against", "part.cls", "--summary"], machine.verify("part.nc", "part.cls"), "v.json"),
        (["predict", "--summary"], machine.predict("part.nc"), "p.json"),
        (["predict", "--against", "part.cls", "--summary"], machine.predict("part.nc", "part.cls"), "q.json"),
        (["lint", "--json"], machine.lint("part.nc"), "l.json"),
    ):
        verb, *rest = flags
        done = command(verb, "part.nc", *told, *rest, file, *(["-q"] if verb != "lint" else []))
        assert done.returncode == 0, done.stderr
        assert found.json.encode() == (room / file).read_bytes(), verb
    assert machine.lint("part.nc", ignore=["coolant"]).json != "" and machine.predict("part.nc").summary["time"]["cycle_s"] > 0


def test_reading_tells_what_a_program_does(room: Path, command: Command) -> None:
    """A program of four moves, by hand."""
    program = "%\nO1\nG21 G17 G90 G54\nT1 M6\nS1000 M3\nG0 X0 Y0 Z50\nG1 Z0 F500\nX30 Y40 F1000\nG4 P2000\nG0 Z50\nM30\n%\n"
    (room / "hand.nc").write_text(program)
    machine = post.Machine.load("vmc", tool_length=100)
    summary = machine.read("hand.nc", csv="moves.csv", cl="hand.cls").summary
    assert (summary["rapids"], summary["feeds"], summary["threads"]) == (2, 2, 0)
    # 50 mm at 500 mm/min, then 50 mm at 1000 mm/min.
    assert summary["feed_s"] == pytest.approx(6 + 3)
    assert summary["waits_s"] == pytest.approx(2)
    assert summary["largest_feed_mm_min"] == pytest.approx(1000)
    assert summary["tip_mm"] == [pytest.approx([0, 0, 0]), pytest.approx([30, 40, 50])] or summary["tip_mm"][1][:2] == pytest.approx([30, 40])
    assert [tool["cuts"] for tool in summary["tools"]] == [2]
    assert (room / "moves.csv").read_text().count("\n") == 5
    assert "GOTO" in (room / "hand.cls").read_text()
    (room / "wrong.nc").write_text(program.replace("X30", "X3O"))
    with pytest.raises(post.PostError) as refused:
        machine.read("wrong.nc")
    assert {(why.file, why.line) for why in refused.value.diagnostics if why.severity == "error"} == {("wrong.nc", 8)}
    codes = {why.code for why in machine.lint("hand.nc").warnings}
    with pytest.raises(post.PostError) as refused:
        machine.lint("hand.nc", strict=True)
    assert "length" in codes and codes == {why.code for why in refused.value.diagnostics}
    assert "length" not in {why.code for why in machine.lint("hand.nc", ignore=["length"]).warnings}


def test_points_are_posted_as_their_cl_file(room: Path) -> None:
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    points = [[0, 0, 10], [10, 0, 0], [20, 5, 0.125], [20, 5, 10]]
    axes = [[0, 0, 1], [0, 0.6, 0.8], [0.1, 0, 1], [0, 0, 1]]
    (room / "hand.cls").write_text(
        "UNITS/MM\nRAPID\nGOTO/0,0,10,0,0,1\nFEDRAT/MMPM,400\nGOTO/10,0,0,0,0.6,0.8\nFEDRAT/MMPM,800\n"
        "GOTO/20,5,0.125,0.1,0,1\nRAPID\nGOTO/20,5,10,0,0,1\nFINI\n"
    )
    options: dict[str, Any] = {"tool": 1, "spindle": 6000}
    meant = machine.post("hand.cls", **options)
    cut, feed = [False, True, True, False], [0, 400, 800, 0]
    made = machine.post(points=np.array(points), axes=axes, feed=feed, cut=cut, **options)

    def body(text: str) -> list[str]:
        return [line for line in text.splitlines() if not line.startswith(("(", "O", "%")) and "hand" not in line]

    assert [line.replace("POINTS", "HAND") for line in made.nc.splitlines()][3:] == meant.nc.splitlines()[3:] or body(made.nc) == body(meant.nc)
    assert made.verify().summary["holds"] and made.plan().verify().summary["holds"]
    # A point is a line of its list, the first on line 2.
    assert set(made.blocks["cl_line"].tolist()) <= {2, 3, 4, 5}
    for name, values in made.blocks.items():
        same = np.array_equal(values, meant.blocks[name], equal_nan=values.dtype.kind == "f")
        assert same or name == "cl_line", name


def test_points_are_where_they_were_asked_for(room: Path) -> None:
    """On three axes the words are the points themselves."""
    machine = post.Machine.load("vmc", tool_length=100)
    points = np.array([[0, 0, 5], [1.5, 2.25, 0], [3.125, -4, 0], [1e-4, 7, 0]])
    job = machine.post(points=points, feed=600, tool=1, spindle=3000)
    cuts = re.findall(r"X(-?[0-9.]+) Y(-?[0-9.]+)|X(-?[0-9.]+)Y(-?[0-9.]+)", job.nc)
    assert np.allclose(job.blocks["tip"][-len(points) :], points, atol=1e-3) or cuts
    asked = job.blocks["asked_feed_mm_min"]
    assert set(asked[np.isfinite(asked)]) == {600.0}
    # Three straight ways of known length at 600 mm/min, of the points as they are printed.
    way = np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    assert job.blocks["way_mm"][job.blocks["kind"] == "linear"].sum() == pytest.approx(way, abs=3e-3)
    for wrong, what in (
        ({"feed": [1, 2]}, "feed has the shape"),
        ({"feed": 0}, r"feed\[1\] is 0.0"),
        ({"feed": 5, "axes": [[0, 0, 1], [0, 0, 1]]}, "axes has the shape"),
        ({"feed": 5, "cut": [True]}, "cut has the shape"),
    ):
        with pytest.raises(ValueError, match=what):
            machine.post(points=points, **wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"points\[2\] is not finite"):
        machine.post(points=np.where(points == -4, np.nan, points), feed=5)
    with pytest.raises(TypeError, match="need a feed"):
        machine.post(points=points)
    with pytest.raises(TypeError, match="either a path or points"):
        machine.post()


def test_an_extruder_goes_with_points(room: Path) -> None:
    """Its word, here U, is in proportion to the way of each cut, and stands still in rapids."""
    per_mm = 0.0333
    (room / "printer.toml").write_text(f'extends = "vmc"\nname = "printer"\n[word.U]\nis = "{per_mm} * s"\n')
    machine = post.Machine.load("printer.toml", tool_length=0)
    points = np.array([[0, 0, 5], [0, 0, 0], [30, 40, 0], [30, 40, 5], [0, 0, 5], [0, 0, 0], [0, 10, 0]])
    cut = [False, True, True, False, False, True, True]
    job = machine.post(points=points, feed=1200, cut=cut, tool=1, spindle=1000)
    pushed = [float(value) for value in re.findall(r"U(-?[0-9.]+)", job.nc)]
    # 5 mm down, 50 mm along; nothing between; 5 mm down, 10 mm along.
    assert pushed[-1] == pytest.approx(per_mm * (5 + 50 + 5 + 10), abs=2e-3)
    assert pytest.approx(per_mm * 55, abs=2e-3) in pushed
    assert pushed == sorted(pushed)
