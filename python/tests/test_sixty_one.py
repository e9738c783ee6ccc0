"""Sixty-one machines of the trade: each is what the table says of it (``sixty_one``), and the book has the table."""

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from conftest import CHECKOUT

if sys.version_info < (3, 11):
    pytest.skip("Python 3.11 reads machine files", allow_module_level=True)

from sixty_one import page, table, verdict  # noqa: E402
from sixty_one.kinematics import Joint  # noqa: E402
from sixty_one.table import ROWS, Machine  # noqa: E402

NUMBERED = [pytest.param(number, machine, id=machine.name) for number, machine in enumerate(ROWS, 1)]


def asked(machine: Machine) -> None:
    """Skips a robot's language whose library is not built."""
    if machine.dialect in verdict.ROBOTS and not verdict.library(machine.dialect).is_file():
        pytest.skip(f"the library of {machine.dialect} is not built")


@pytest.mark.parametrize(("number", "machine"), NUMBERED)
def test_a_machine_is_what_the_table_says(number: int, machine: Machine, tmp_path: Path) -> None:
    """Posted, read, moved and compared; and so it stands in the book."""
    asked(machine)
    program = verdict.posted(machine, tmp_path)
    found = verdict.judged(machine, program)
    assert found.says == machine.after, found.why
    told = page.PAGE.read_text().splitlines()
    line = page.row(number, machine, found)
    assert any(page.same(line, one) for one in told), f"the page is stale: {page.HEAD.splitlines()[0]}\n{line}"
    # A joint that goes the wrong way is seen, whichever moves at all.
    for joint in machine.bodies.part + machine.bodies.tool:
        if joint.word not in machine.idle:
            wrong = verdict.judged(reversed_(machine, joint), program)
            assert wrong.says == "wrong", f"{joint.word} may go either way"
    if machine.lacks:
        lacking = replace(machine, work=machine.lacks.work, options=machine.lacks.options)
        refused = verdict.judged(lacking, verdict.posted(lacking, tmp_path))
        assert refused.says == "refused" and machine.lacks.why in refused.why, refused


def reversed_(machine: Machine, joint: Joint) -> Machine:
    """The machine with one joint that goes the other way."""

    def turned(joints: tuple[Joint, ...]) -> tuple[Joint, ...]:
        return tuple(replace(one, way=table.down(one.way)) if one is joint else one for one in joints)

    bodies = machine.bodies
    return replace(machine, bodies=replace(bodies, part=turned(bodies.part), tool=turned(bodies.tool)))


def test_they_are_sixty_one_of_all_kinds_and_none_is_of_the_library() -> None:
    """56 at least work, in part at the least, and none is wrong."""
    assert len({machine.name for machine in ROWS}) == len({machine.model for machine in ROWS}) == 61
    says = [machine.after for machine in ROWS]
    assert says.count("works") + says.count("in part") >= 56 and "wrong" not in says
    files = {path.stem for path in verdict.HERE.glob("*.toml")}
    second = {f"{machine.name}-{name}" for machine in ROWS if machine.second for name, _ in verdict.CHANNELS}
    assert files == {machine.name for machine in ROWS if not machine.second} | second
    library = {path.read_text().split("chain", 1)[-1] for path in (CHECKOUT / "machines").glob("*.toml")}
    for path in verdict.HERE.glob("*.toml"):
        said = path.read_text()
        assert said.startswith("# ") and "extends" not in said, path
        assert said.split("chain", 1)[1] not in library, path


def test_the_page_is_that_of_the_table() -> None:
    """All but the rows, which are looked at one by one."""
    found = [verdict.Verdict(machine.after, machine.but) for machine in ROWS]
    expected = [line for line in page.text(found).splitlines() if not line.startswith("| ") or line == page.COLUMNS]
    written = [line for line in page.PAGE.read_text().splitlines() if not line.startswith("| ") or line == page.COLUMNS]
    assert written == expected, f"the page is stale: {page.HEAD.splitlines()[0]}"
    assert sum(line.startswith("| ") for line in page.PAGE.read_text().splitlines()) == len(ROWS) + 1
