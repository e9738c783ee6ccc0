"""AXIS, the screen of LinuxCNC, opens CL files: on a display without a monitor, in namespaces of its own.

LinuxCNC's script ends processes by name and knows one machine at a time, so it gets its own processes, network, shared
memory and ``/tmp``. That takes root, Xvfb and the user that ``../shared/linuxcnc/install`` makes; without them it is skipped
and says so.
"""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from conftest import CHECKOUT, COMMAND

CONFIGURATION = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim/axis/axis_mm.ini")
USER = "lcnc"  # LinuxCNC refuses root

# As root, the room bound to a place that does not hang on /tmp.
AROUND = """\
mount --bind "$1" /mnt && mount -t tmpfs -o mode=1777 tmpfs /tmp || exit 3
ip link set lo up 2>/dev/null
Xvfb :77 -screen 0 1024x768x24 >/mnt/xvfb.log 2>&1 &
exec su {user} -s /bin/bash -c 'bash /mnt/opens'
"""
# As the user: a file that is posted, then one that is refused. What LinuxCNC has open is written after each.
OPENS = """\
export HOME=/mnt/home DISPLAY=:77 LIBGL_ALWAYS_SOFTWARE=1 PYTHONDONTWRITEBYTECODE=1
export PATH=/mnt/commands:/usr/local/bin:/usr/bin:/bin
cd /mnt/machine
post-from-ini mill.ini >/mnt/from-ini.log 2>&1 || exit 4
rm /mnt/ended  # of post check
linuxcnc mill.ini >/mnt/linuxcnc.log 2>&1 &
opened() {
    /usr/bin/python3 -c 'import linuxcnc; s = linuxcnc.stat(); s.poll(); print("OPEN", s.file)' | grep '^OPEN'
}
for each in $(seq 90); do axis-remote --ping >/dev/null 2>&1 && break; sleep 1; done
axis-remote --ping >/dev/null 2>&1 || exit 5
axis-remote /mnt/good.cls
for each in $(seq 60); do opened | grep -q good.cls && break; sleep 1; done
opened >/mnt/first
cp "$(cut -d' ' -f2 /mnt/first)" /mnt/program
# The screen waits for a click on what it tells: the call does not come back.
axis-remote /mnt/bad.cls &
for each in $(seq 60); do [ -s /mnt/ended ] && [ "$(wc -l </mnt/ended)" -ge 2 ] && break; sleep 1; done
sleep 3
opened >/mnt/second
"""
# The command, which tells how it ended.
TELLS = '#!/bin/sh\n/mnt/commands/post-itself "$@"\ncode=$?\necho $code >>/mnt/ended\nexit $code\n'

GOOD = """\
UNITS/MM
CUTTER/10
LOADTL/1
SPINDL/RPM,3000,CLW
RAPID
GOTO/20,10,50
FEDRAT/600,MMPM
GOTO/20,10,15
GOTO/60,10,15
RAPID
GOTO/60,10,50
END
FINI
"""


def laid(room: Path) -> None:
    """What the room has: the command, the two programs, a machine of LinuxCNC, two CL files."""
    commands = room / "commands"
    shutil.copytree(CHECKOUT / "editors/linuxcnc", commands)
    shutil.copy(COMMAND, commands / "post-itself")
    (commands / "post").write_text(TELLS)
    (commands / "post").chmod(0o755)
    (room / "home").mkdir()
    (room / "machine").mkdir()
    ini = CONFIGURATION.read_text().replace("INTRO_TIME = 5", "INTRO_TIME = 0")
    for name in ("core_sim", "sim_spindle_encoder", "axis_manualtoolchange", "simulated_home"):
        ini = ini.replace(f"HALFILE = {name}.hal", f"HALFILE = LIB:{name}.hal")
    ini = ini.replace("py = python", "py = python\nPROGRAM_EXTENSION = .cls,.apt,.ncl CL file\ncls = post-filter")
    (room / "machine/mill.ini").write_text(f"{ini}\n[POST]\nMOUNT = G54\n")
    (room / "machine/sim_mm.tbl").write_text("T1 P1 Z40 D10 ;MILL\n")
    (room / "good.cls").write_text(GOOD)
    (room / "bad.cls").write_text(GOOD.replace("60,10", "360,10"))
    (room / "opens").write_text(OPENS)
    subprocess.run(["chmod", "-R", "a+rwX", room], check=True)


def test_axis_opens_a_cl_file_and_keeps_its_program_where_one_is_refused(tmp_path: Path) -> None:
    for tool in ("Xvfb", "linuxcnc", "axis-remote", "unshare", "su"):
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not here: AXIS is not opened")
    if os.geteuid() != 0 or subprocess.run(["id", USER], capture_output=True).returncode != 0:
        pytest.skip(f"AXIS is opened by root for the user {USER}, which ../shared/linuxcnc/install makes")
    if not CONFIGURATION.is_file():
        pytest.skip(f"{CONFIGURATION} is not here")
    room = tmp_path / "room"
    room.mkdir()
    laid(room)
    namespaces = ["unshare", "--pid", "--fork", "--mount", "--mount-proc", "--ipc", "--net"]
    inside = ["bash", "-c", AROUND.format(user=USER), "axis", str(room)]
    run = subprocess.run([*namespaces, *inside], capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)
    if run.returncode == 3 or "unshare failed" in run.stderr:
        pytest.skip(f"no namespaces here: {run.stderr.strip()}")
    if run.returncode == 5:
        told = (room / "linuxcnc.log").read_text(errors="replace")[-500:]
        pytest.skip(f"AXIS does not come up here: {told}")
    logs = "".join(path.read_text(errors="replace") for path in room.glob("*.log"))
    assert (room / "program").is_file(), run.stderr + logs
    posted = subprocess.run(
        [COMMAND, "good.cls", "-m", "machine/mill.toml", "--mount", "0,0,0", "-q", "-o", "-"],
        cwd=room,
        capture_output=True,
        text=True,
    )
    assert (room / "program").read_text() == posted.stdout and "X60.0000" in posted.stdout
    # 0 and 1 are how the command ended; what is open is still the first.
    assert (room / "ended").read_text().split() == ["0", "1"], run.stderr + logs
    assert (room / "second").read_text() == (room / "first").read_text() and "good.cls" in (room / "first").read_text()
