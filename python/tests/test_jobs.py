"""Jobs: the same bytes as the command's."""

import json
import os
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import post
import pytest
from conftest import built

CHECKOUT = Path(__file__).parents[2]
LIBRARY = CHECKOUT / "tests/machines"
Command = Callable[..., "subprocess.CompletedProcess[str]"]

# Machines of every class: table, head, both, inverse time, the control keeps the tip, cycles and turning.
JOBS = [
    "ac-trunnion.cls",
    "ac-trunnion-840d.cls",
    "bc-fork.apt",
    "dmu50.ncl",
    "head-head.cls",
    "nutating-head-45.ncl",
    "mill-turn.cls",
    "hmc-b-pallet.cls",
]


def long_file(path: Path, points: int) -> None:
    """A CL file that takes a while."""
    along = np.arange(points)
    lean = 0.3 + 0.2 * np.sin(along / 50.0)
    turn = along / 200.0
    rows = np.column_stack(
        [
            30 * np.cos(turn),
            30 * np.sin(turn),
            0 * along,
            np.sin(lean) * np.cos(turn),
            np.sin(lean) * np.sin(turn),
            np.cos(lean),
        ]
    )
    lines = ["LOAD/TOOL,1", "SPINDL/RPM,6000,CLW", "FEDRAT/MMPM,1000.0"]
    lines += ["GOTO/" + ",".join(f"{value:.6f}" for value in row) for row in rows]
    path.write_text("\n".join([*lines, "FINI", ""]))


@pytest.mark.parametrize("name", JOBS)
def test_a_job_is_that_of_the_command(name: str, room: Path, command: Command) -> None:
    stem = name.rsplit(".", 1)[0]
    cl = str(LIBRARY / name)
    told = ["--machine", stem, "--tool-length", "120"]
    made = command(cl, *told, "-o", "out.nc", "--summary", "out.json", "--quiet")
    machine = post.Machine.load(stem, tool_length=120)
    assert made.returncode == 0, made.stderr
    program = (room / "out.nc").read_bytes()
    (room / "out.nc").unlink()
    named = machine.post(cl, output="out.nc")
    assert (room / "out.nc").read_bytes() == named.nc.encode() == program
    assert named.json.encode() == (room / "out.json").read_bytes()

    checked = command("verify", "out.nc", *told, "--against", cl, "--summary", "verified.json", "-q")
    assert checked.returncode == 0, checked.stderr
    assert named.verify().json.encode() == (room / "verified.json").read_bytes()
    predicted = command("predict", "out.nc", *told, "--against", cl, "--summary", "predicted.json", "-q")
    assert predicted.returncode == 0, predicted.stderr
    assert named.predict().json.encode() == (room / "predicted.json").read_bytes()

    told_more = ["--verify", "--predict", "--report", "out.html", "-o", "out.nc", "--quiet"]
    shown = command(cl, *told, *told_more)
    assert shown.returncode == 0, shown.stderr
    named.report("again.html", verify=True, predict=True)
    assert (room / "again.html").read_bytes() == (room / "out.html").read_bytes()


def test_a_plan_is_that_of_the_command(room: Path, command: Command) -> None:
    told = ["part.cls", "--machine", "ac-trunnion", "--tool-length", "120", "--plan"]
    made = command(*told, "--summary", "part.json", "--report", "out.html", "--quiet")
    assert made.returncode == 0, made.stderr
    job = post.Machine.load("ac-trunnion", tool_length=120).post("part.cls").plan()
    assert job.nc.encode() == (room / "part.nc").read_bytes()
    assert job.json.encode() == (room / "part.json").read_bytes()
    assert "plan" in job.summary
    job.report("again.html")
    assert (room / "again.html").read_bytes() == (room / "out.html").read_bytes()
    job.verify()


def test_options_are_those_of_the_command(room: Path, command: Command) -> None:
    told = ["--machine", "dmu50", "--tool-length", "110.5", "--mount", "1,2,3.25", "--turn", "5"]
    told += ["--tolerance", "0.002", "--allow", "CUTTER", "--allow", "INSERT", "--units", "mm"]
    told += ["--spindle", "4000", "--tcp", "post", "--dialect", "fanuc", "--number", "77"]
    told += ["--reduce", "--fit-arcs"]
    cl = str(LIBRARY / "dmu50.ncl")
    made = command(cl, *told, "-o", "out.nc", "--quiet")
    assert made.returncode == 0, made.stderr
    machine = post.Machine.load("dmu50", tool_length=110.5, mount=(1, 2, 3.25), turn=5)
    options = {"tolerance": 0.002, "allow": ["CUTTER", "INSERT"], "units": "mm", "spindle": 4000}
    options |= {"tcp": "post", "dialect": "fanuc", "number": 77, "reduce": True, "fit_arcs": True}
    program = (room / "out.nc").read_text()
    assert "O77" in program or "O0077" in program
    assert machine.post(cl, output="out.nc", **options).nc == program


def test_blocks_tell_what_the_summary_tells(room: Path) -> None:
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    job = machine.post("part.cls")
    blocks, summary = job.blocks, job.summary
    count = len(blocks["time_s"])
    assert all(len(blocks[column]) == count for column in blocks)
    assert blocks.axes == tuple(axis.name for axis in machine.axes)
    assert blocks["q"].shape == (count, 5) and blocks["tip"].shape == (count, 3)
    cuts = ~blocks["off_part"]
    worst = np.argmax(np.where(cuts, blocks["tip_deviation_mm"], 0))
    assert blocks["tip_deviation_mm"][worst] == pytest.approx(summary["tip_deviation_mm"]["value"])
    lines = job.nc.splitlines()
    moving = blocks["nc_line"] > 0
    assert (np.diff(blocks["nc_line"][moving]) >= 0).all()
    assert blocks["nc_line"].max() <= summary["nc_lines"] == len(lines)
    cl = (room / "part.cls").read_text().splitlines()
    assert all("GOTO" in cl[line - 1] for line in blocks["cl_line"][blocks["reason"] == "point"])
    assert set(blocks["kind"]) <= {"position", "reference", "rapid", "linear", "hole"}
    # The axis values stand behind the tips.
    tip, axis = machine.forward(blocks["q"])
    np.testing.assert_allclose(tip, blocks["tip"], atol=1e-6)
    np.testing.assert_allclose(axis, blocks["axis"], atol=1e-9)
    assert summary["time_s"] <= blocks["time_s"][-1] + 1e-6
    assert np.isnan(blocks["asked_feed_mm_min"][blocks["kind"] == "rapid"]).all()
    with pytest.raises(AttributeError, match="blocks=True"):
        machine.post("part.cls", blocks=False).blocks  # noqa: B018


def test_warnings_come_back_and_nothing_is_printed(room: Path, capfd: pytest.CaptureFixture[str]) -> None:
    job = post.Machine.load("ac-trunnion").post("part.cls", dialect="siemens")
    codes = [warning.code for warning in job.warnings]
    # What the command prints before it begins is among them.
    assert "dialect" in codes and "tool-length" in " ".join(codes)
    assert all(warning.severity == "warning" for warning in job.warnings)
    assert capfd.readouterr() == ("", "")
    assert sorted(path.name for path in room.iterdir()) == ["part.cls"]


def test_refusals_tell_all(room: Path) -> None:
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    with pytest.raises(post.PostError) as refused:
        machine.post(LIBRARY / "ac-trunnion.refused.cls", output="out.nc")
    errors = [why for why in refused.value.diagnostics if why.severity == "error"]
    assert errors and errors[0].file == str(LIBRARY / "ac-trunnion.refused.cls")
    assert errors[0].line is not None and errors[0].text
    assert str(errors[0]) in str(refused.value)
    assert not (room / "out.nc").exists()
    again = pickle.loads(pickle.dumps(refused.value))
    assert again.diagnostics == refused.value.diagnostics

    def why(**options: object) -> post.Diagnostic:
        with pytest.raises(post.PostError) as refused:
            machine.post("part.cls", **options)
        return refused.value.diagnostics[-1]

    assert "invalid value '-1'" in why(tolerance=-1).message
    assert "tolerence" in why(tolerence=1).message
    assert why(tolerence=1).help == "a similar argument exists: 'tolerance'"
    assert "there is no folder" in why(output="nowhere/out.nc").message
    with pytest.raises(post.PostError, match="missing.cls"):
        machine.post("missing.cls")
    # A file that is read is not written over.
    assert "part.cls" in why(output="part.cls").message
    assert (room / "part.cls").read_bytes() == (LIBRARY / "ac-trunnion.cls").read_bytes()


def test_reports_go_where_files_were_before(room: Path) -> None:
    """Of one job to the next nothing is remembered: a name that was read before may be written now."""
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    (room / "other.cls").write_bytes((room / "part.cls").read_bytes())
    machine.post("other.cls")
    job = machine.post("part.cls")
    job.report("other.cls")
    assert (room / "other.cls").read_bytes().startswith(b"<!doctype html>")


def test_a_plugin_of_ones_own_is_found(room: Path, command: Command) -> None:
    """A dialect from a library, by option and by the environment."""
    folder = room / "plugins"
    folder.mkdir(mode=0o755)
    library = "libpost_grbl.so"
    (folder / library).write_bytes(built(library).read_bytes())
    cl = str(LIBRARY / "grbl-router.ncl")
    made = command(cl, "-m", "grbl-router", "--mount", "0,0,55", "--plugins", "plugins", "-o", "out.nc", "--summary", "out.json", "-q")
    assert made.returncode == 0, made.stderr
    job = post.Machine.load("grbl-router", mount=(0, 0, 55), plugins=["plugins"]).post(cl, output="out.nc")
    assert job.summary["plugins"][0]["path"] == f"plugins/{library}"
    assert job.json.encode() == (room / "out.json").read_bytes()
    os.environ["POST_PLUGINS"] = str(folder)
    try:
        job = post.Machine.load("grbl-router", mount=(0, 0, 55)).post(cl)
    finally:
        del os.environ["POST_PLUGINS"]
    assert job.summary["plugins"][0]["path"] == str(folder / library)
    # What Python prints still goes where it went.
    script = f"""
        import post
        job = post.Machine.load("grbl-router", mount=(0, 0, 55), plugins=["plugins"]).post({cl!r})
        print("printed", flush=True)
    """
    ran = subprocess.run([sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "printed\n", "")


def test_other_threads_run_while_a_job_is_done(room: Path) -> None:
    long_file(room / "long.cls", 20_000)
    machine = post.Machine.load("ac-trunnion", tool_length=120)
    counted, over = [], threading.Event()

    def count() -> None:
        while not over.is_set():
            counted.append(time.perf_counter())
            time.sleep(0.001)

    counter = threading.Thread(target=count)
    counter.start()
    began = time.perf_counter()
    machine.post("long.cls")
    ended = time.perf_counter()
    over.set()
    counter.join()
    inside = [at for at in counted if began < at < ended]
    assert len(inside) > 20 * (ended - began)


def test_threads_post_side_by_side(room: Path) -> None:
    whole = {name: post.Machine.load(name.split(".")[0], tool_length=120) for name in JOBS[:4]}
    alone = {name: machine.post(LIBRARY / name).json for name, machine in whole.items()}
    together: dict[str, list[str]] = {name: [] for name in whole}

    def work(name: str) -> None:
        for _ in range(3):
            together[name].append(whole[name].post(LIBRARY / name).json)

    threads = [threading.Thread(target=work, args=(name,)) for name in whole]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert together == {name: [json] * 3 for name, json in alone.items()}


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT between processes")
def test_ctrl_c_ends_a_job_and_not_the_interpreter(room: Path) -> None:
    long_file(room / "long.cls", 400_000)
    script = """
        import post, signal
        # A shell that started all this in the background has it ignored.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        machine = post.Machine.load("ac-trunnion", tool_length=120)
        print("begun", flush=True)
        try:
            machine.post("long.cls", output="long.nc")
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        machine.post("part.cls")
        print("alive", flush=True)
    """
    child = subprocess.Popen(
        [sys.executable, "-c", textwrap.dedent(script)], stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "begun\n"
    time.sleep(0.3)
    child.send_signal(signal.SIGINT)
    told, _ = child.communicate(timeout=60)
    assert told == "interrupted\nalive\n"
    assert child.returncode == 0
    assert sorted(path.name for path in room.iterdir()) == ["long.cls", "part.cls"]


def test_a_fault_of_our_own_is_told() -> None:
    from post import _native

    with pytest.raises(post.PostError) as refused:
        _native.fail()
    (why,) = refused.value.diagnostics
    assert why.code == "internal" and "asked for" in why.message


def test_the_readme_runs(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (CHECKOUT / "python/README.md").read_text()
    examples = [example.split("```")[0] for example in text.split("```python\n")[1:]]
    # The last is a study of three machines, which tests of its own have.
    for example in examples[:-1]:
        exec(compile(example, "README.md", "exec"), {})
    told = capsys.readouterr().out
    assert "C deg" in told and "invalid value" in told
    assert (room / "part.html").stat().st_size > 10_000


JOB_FILE = """
machine = "ac-trunnion"
tool_length = 120
[set]
accuracy.placement = "fewest"
[[program]]
cl = "blade.cls"
output = "a.nc"
verify = true
[[program]]
cl = "plate.ncl"
output = "b.nc"
machine = "vmc"
"""


def test_a_job_file_makes_the_programs_of_the_command(room: Path, command: Command) -> None:
    for name in ("blade.cls", "plate.ncl"):
        (room / name).write_bytes((CHECKOUT / "tests/samples" / name).read_bytes())
    path = room / "part.job.toml"
    path.write_text(JOB_FILE)
    made = post.job(path)
    assert not (room / "a.nc").exists()
    done = command(str(path), "-q")
    assert done.returncode == 0, done.stderr
    written = [(room / name).read_text() for name in ("a.nc", "b.nc")]
    assert [job.nc for job in made] == written
    assert "JOB " in made[0].nc
    for name in ("a.nc", "b.nc"):
        (room / name).unlink()
    post.job(path, write=True)
    assert [(room / name).read_text() for name in ("a.nc", "b.nc")] == written
    # Made in another way, it is not what the file says.
    coarse = post.job(path, tolerance=0.02)
    assert coarse[0].summary["tolerance_mm"] == 0.02
    assert "JOB " not in coarse[0].nc
    made[0].verify()
    path.write_text(JOB_FILE.replace("tool_length", "tool_lenght"))
    with pytest.raises(post.PostError) as refused:
        post.job(path)
    assert refused.value.diagnostics[0].code == "job-file"


def test_clearance_is_that_of_the_command(tmp_path: Path, command: Command) -> None:
    """Nothing hits anything, pair by pair; and where something does, that is why."""
    machine = tmp_path / "vise.toml"
    text = """extends = "ac-trunnion"
name = "with a jaw"
[stock]
block = [[-50, -30, 0], [50, 30, 28]]
[tools.3]
length = 100
holder = [[0, 32], [20, 32], [20, 20], [60, 18]]
cutter = [[0, 5], [40, 5]]
[fixture.jaw]
block = [[60, -60, 0], [90, 60, 40]]
"""
    machine.write_text(text)
    blade = CHECKOUT / "tests/samples/blade.cls"
    job = post.Machine.load(machine).post(blade)
    pairs = job.clearance().summary["pairs"]
    summary = tmp_path / "s.json"
    done = command("-q", "-m", str(machine), str(blade), "-o", str(tmp_path / "b.nc"), "--clearance", "--summary", str(summary))
    assert done.returncode == 0, done.stderr
    assert pairs == json.loads(summary.read_text())["clearance"]["pairs"]
    assert {"jaw", "holder T3"} in [set(pair["bodies"]) for pair in pairs]
    with pytest.raises(post.PostError) as refused:
        post.Machine.load(machine, set={"clearance.keep": 5}).post(blade).clearance()
    (why,) = [one for one in refused.value.diagnostics if one.severity == "error"]
    assert why.code == "clearance"
    assert "jaw comes within" in why.message
