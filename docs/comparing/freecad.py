"""A job of FreeCAD, posted by FreeCAD's own post for LinuxCNC and by `post`; both programs are held against its path.

    docs/comparing/freecad.py plate        a contour and three holes, three axes
    docs/comparing/freecad.py indexed      two slots, the second in a plane that leans by 35°

The path is the CL file that editors/freecad writes of the job. Needs freecadcmd of FreeCAD 0.20.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from measuring import CHECKOUT, absent, command, run

JOB = CHECKOUT / "python/tests/freecad_job.py"
EDITOR = CHECKOUT / "editors/freecad"


@dataclass(frozen=True)
class Kind:
    """What the job goes to, and what `post` is told of it."""

    machine: str
    said: tuple[str, ...]


KINDS = {
    "plate": Kind("vmc", ("--dialect", "linuxcnc", "--tool-length", "100", "--mount", "0,0,0")),
    "indexed": Kind("xyzac-trt", ("--tool-length", "60")),
}


def made(room: Path, kind: str, post: str, arguments: str) -> Path:
    """The program."""
    freecad = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if freecad is None:
        absent("FreeCAD is not installed (freecadcmd)")
    home, program, told = room / "home", room / f"{post}.ngc", room / f"{post}.json"
    macros = home / ".local/share/FreeCAD/Macro"
    macros.mkdir(parents=True, exist_ok=True)
    shutil.copy(EDITOR / "post_cl_post.py", macros)
    asked = {
        "kind": kind,
        "template": str(EDITOR / "job_post.json"),
        "post": post,
        "arguments": arguments,
        "output": str(program),
        "told": str(told),
    }
    environment = {**os.environ, "HOME": str(home), "POST_JOB": json.dumps(asked), "QT_QPA_PLATFORM": "offscreen"}
    for name in ("XDG_DATA_HOME", "XDG_CONFIG_HOME"):
        environment.pop(name, None)
    done = subprocess.run([freecad, JOB], env=environment, capture_output=True, text=True)
    if not told.is_file():
        if "No module named 'PathScripts" in done.stdout + done.stderr:
            absent("this FreeCAD keeps its CAM elsewhere: the job is for 0.20")
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])
    text = json.loads(told.read_text())["program"]
    if text:
        program.write_text(text)
    return program


def verdict(program: Path, part: Path, kind: Kind) -> str:
    summary = program.with_suffix(".verified.json")
    words = ["--against", part, *kind.said, "--summary", summary, "-q"]
    done = run(command("post"), "verify", program, "-m", kind.machine, *words, accepted=(0, 1))
    written = [line for line in program.read_text().splitlines() if line.strip() and not line.startswith("(")]
    turning = sum(1 for line in written if re.search(r"[ABC]-?[0-9]", line))
    size = f"{len(written)} lines, {turning} of them with a rotary axis"
    found = json.loads(summary.read_text())
    off = f"tip {1000 * found['tip']['value']:.2f} µm off the path at most"
    if found["holds"]:
        return f"{size}; holds, {off}"
    # The message at its first place.
    first = re.search(r"error\[[a-z-]+\]: (.*)\n\s*--> .*?:(\d+):", done.stderr)
    reasons = len(found["refused"])
    told = f"; the first, line {first[2]}: {first[1]}" if first else ""
    return f"{size}; refused for {reasons} reason{'s' if reasons > 1 else ''}, {off}{told}"


def main() -> None:
    name = sys.argv[1]
    kind = KINDS[name]
    with tempfile.TemporaryDirectory() as folder:
        room = Path(folder)
        words = f"--command {command('post')} --machine {CHECKOUT / 'machines' / kind.machine}.toml {' '.join(kind.said)}"
        ours = made(room, name, "post_cl", words)
        theirs = made(room, name, "linuxcnc", "--no-show-editor --no-header --no-comments")
        part = ours.with_suffix(".cls")
        print("post:", verdict(ours, part, kind))
        print("FreeCAD:", verdict(theirs, part, kind))


if __name__ == "__main__":
    main()
