"""What the tests share: the checkout's machines and CL files, and the command."""

import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

# A shell that runs all this in the background has them ignored, and what is run here would inherit that.
for ignored, handler in ((signal.SIGINT, signal.default_int_handler), (signal.SIGTERM, signal.SIG_DFL)):
    if signal.getsignal(ignored) == signal.SIG_IGN:
        signal.signal(ignored, handler)

CHECKOUT = Path(__file__).parents[2]
COMMAND = os.environ.get("POST_COMMAND", str(CHECKOUT / "target/debug/post"))


def rounds(count: int) -> int:
    """A third of them, or POST_ROUNDS times as many."""
    times = os.environ.get("POST_ROUNDS")
    return count * int(times) if times else (count + 2) // 3


def drawn(own: int) -> np.random.Generator:
    """The numbers of a test's own seed and of that of the run."""
    seed = int(os.environ.get("POST_SEED", time.time_ns() % 2**31))
    print(f"random numbers of seed {own}; again with POST_SEED={seed}")
    return np.random.default_rng([own, seed])


def built(library: str) -> Path:
    """A plugin's library as cargo has built it last: beside the command, or where tests have it."""
    folder = Path(COMMAND).parent
    found = [path for path in (folder / library, folder / "deps" / library) if path.is_file()]
    assert found, f"{library} is not built"
    return max(found, key=lambda path: path.stat().st_mtime)


@pytest.fixture
def room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a CL file in it."""
    monkeypatch.chdir(tmp_path)
    for name in ("POST_MACHINES", "POST_PLUGINS"):
        monkeypatch.delenv(name, raising=False)
    cl = (CHECKOUT / "tests/machines/ac-trunnion.cls").read_bytes()
    (tmp_path / "part.cls").write_bytes(cl)
    return tmp_path


@pytest.fixture
def command(room: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Runs the command in that folder."""

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run([COMMAND, *arguments], cwd=room, capture_output=True, text=True)

    return run
