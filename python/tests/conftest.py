"""What the tests share: the checkout's machines and CL files, and the command."""

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

CHECKOUT = Path(__file__).parents[2]
COMMAND = os.environ.get("POST_COMMAND", str(CHECKOUT / "target/debug/post"))


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
