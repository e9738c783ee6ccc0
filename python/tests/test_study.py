"""``study``: the same rows from threads, from Ray and from the command."""

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import post

Command = Callable[..., subprocess.CompletedProcess[str]]

GRID = {"accuracy.placement": ["bisect", "fewest"], "tool_length": [0, 120], "mount": [(0, 0, 0), (0, 0, 0.5)]}
MACHINES = ["ac-trunnion", "dmu50", "vmc", "nobody"]


@pytest.fixture
def plain(room: Path) -> post.Study:
    return post.study(["part.cls", "missing.cls"], MACHINES, GRID, verify=True, progress=False)


def test_the_table_is_that_of_the_command(room: Path, plain: post.Study, command: Command) -> None:
    done = command(
        *("batch", "part.cls", "missing.cls", "--verify", "-o", "command.parquet"),
        *(word for machine in MACHINES for word in ("-m", machine)),
        *("--set", "accuracy.placement=bisect,fewest", "--tool-length", "0,120"),
        *("--mount", "0,0,0", "--mount", "0,0,0.5"),
    )
    assert done.returncode == 0, done.stderr
    plain.to_parquet("python.parquet")
    assert (room / "python.parquet").read_bytes() == (room / "command.parquet").read_bytes()
    with pytest.raises(ValueError):
        plain.to_parquet("python.csv")
    plain.write("python.csv")
    assert (room / "python.csv").read_text().startswith("job,file,machine,accuracy.placement,")
    with pytest.raises(post.PostError):
        plain.write("part.cls")


def test_columns_are_arrays_and_failures_are_rows(plain: post.Study) -> None:
    columns = plain.columns
    assert len(plain) == 64
    assert columns["job"].dtype == np.int64 and list(columns["job"]) == list(range(64))
    assert columns["cycle_time_s"].dtype == np.float64
    written = columns["state"] == "written"
    assert written.any() and np.isfinite(columns["cycle_time_s"][written]).all()
    assert np.isnan(columns["cycle_time_s"][~written]).all()
    assert set(columns["mount_z_mm"]) == {0.0, 0.5}
    failures = plain.failures
    assert len(failures) == 64 - written.sum()
    codes = {failure["machine"]: failure["codes"] for failure in failures if failure["file"] == "part.cls"}
    assert codes["nobody"] == "machine" and "out-of-reach" in codes["vmc"]
    assert all(failure["codes"] == "input" for failure in failures if failure["file"] == "missing.cls")
    assert all("message" in failure and "cycle_time_s" not in failure for failure in failures)


def test_a_study_is_resumed(room: Path, plain: post.Study) -> None:
    told: list[tuple[int, int, int]] = []
    files = ["part.cls", "missing.cls"]
    first = post.study(files, MACHINES, GRID, verify=True, resume="done.jsonl", progress=lambda *now: told.append(now))
    assert told[-1][:2] == (64, 64)
    # What has a key is written down; the rest is refused at once.
    kept = (room / "done.jsonl").read_text().splitlines()
    assert len(kept) == 24
    again = post.study(files, MACHINES, GRID, verify=True, resume="done.jsonl", progress=False)
    assert (room / "done.jsonl").read_text().splitlines() == kept
    assert first._native.bytes("parquet") == again._native.bytes("parquet") == plain._native.bytes("parquet")


def test_jobs_may_be_told_one_by_one(room: Path) -> None:
    jobs = [{"file": "part.cls", "machine": "ac-trunnion", "set": {"accuracy.tolerance": 0.02}, "turn": 10}]
    done = post.study([], [], {"tool_length": 50, "turn": [0, 90]}, jobs=jobs, progress=False)
    assert len(done) == 1 and done.columns["turn_deg"][0] == 10
    assert done.columns["accuracy.tolerance"][0] == 0.02 and done.columns["tool_length_mm"][0] == 50
    with pytest.raises(ValueError):
        post.study([], jobs=[{"file": "part.cls", "speed": 1}])
    with pytest.raises(post.PostError) as refused:
        post.study("part.cls", progress=False)
    assert "no machine" in str(refused.value) or "machine" in refused.value.diagnostics[0].code


def test_an_interrupt_ends_it_and_keeps_what_is_done(room: Path) -> None:
    script = """
import post
grid = {"accuracy.tolerance": [0.001 + i * 1e-6 for i in range(4000)], "tool_length": 0}
post.study("part.cls", "ac-trunnion", grid, resume="done.jsonl", progress=lambda *now: now[0] > 2 and print("go", flush=True))
"""
    child = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "go\n"
    child.send_signal(signal.SIGINT)
    _, told = child.communicate(timeout=30)
    assert "KeyboardInterrupt" in told and child.returncode != 0
    assert 0 < len((room / "done.jsonl").read_text().splitlines()) < 4000


def test_arrow(plain: post.Study) -> None:
    pytest.importorskip("pyarrow")
    table = plain.to_arrow()
    assert table.num_rows == 64
    for name, values in plain.columns.items():
        there = table.column(name).to_pylist()
        for one, other in zip(values, there):
            assert one == other or (other is None and (one is None or np.isnan(one))), name


def test_ray_gives_the_same_bytes(room: Path, plain: post.Study) -> None:
    ray = pytest.importorskip("ray")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, configure_logging=False)
    try:
        files = ["part.cls", "missing.cls"]
        # No node may need the machine files: the study has them read before its tasks begin.
        done = post.study(files, MACHINES, GRID, engine="ray", verify=True, resume="ray.jsonl", progress=False)
        assert done._native.bytes("parquet") == plain._native.bytes("parquet")
        kept = (room / "ray.jsonl").read_text().splitlines()
        assert len(kept) == 24
        again = post.study(files, MACHINES, GRID, engine="ray", verify=True, resume="ray.jsonl", progress=False)
        assert again._native.bytes("parquet") == plain._native.bytes("parquet")
    finally:
        ray.shutdown()


def test_the_example_runs(room: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (Path(__file__).parents[1] / "README.md").read_text()
    example = text.split("```python\n")[-1].split("```")[0]
    exec(compile(example, "README.md", "exec"), {})
    assert "out-of-reach" in capsys.readouterr().out
    assert (room / "part.parquet").read_bytes().startswith(b"PAR1")
