"""`post schema`, judged by a validator of others: every machine file is in order, and slips are found."""

import json
import subprocess
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from conftest import CHECKOUT, COMMAND

Faults = Callable[[str], list[str]]


@pytest.fixture(scope="module")
def schema() -> dict[str, Any]:
    run = subprocess.run([COMMAND, "schema"], capture_output=True, text=True, check=True)
    assert run.stderr == ""
    return json.loads(run.stdout)  # type: ignore[no-any-return]


@pytest.fixture(scope="module")
def faults(schema: dict[str, Any]) -> Faults:
    """What the validator has against the text of a machine file, each with its place."""
    validator = jsonschema.validators.validator_for(schema)(schema)

    def find(text: str) -> list[str]:
        found = validator.iter_errors(tomllib.loads(text))
        return ["".join(f"/{step}" for step in fault.absolute_path) + f": {fault.message}" for fault in found]

    return find


def test_it_is_a_schema(schema: dict[str, Any]) -> None:
    jsonschema.validators.validator_for(schema).check_schema(schema)


def test_every_machine_file_is_in_order(faults: Faults) -> None:
    files = sorted((CHECKOUT / "machines").glob("*.toml"))
    assert len(files) >= 39
    assert {file.name: found for file in files if (found := faults(file.read_text()))} == {}


def test_every_table_is_closed_and_every_key_explained(schema: dict[str, Any]) -> None:
    """So that a misspelt key is found."""
    tables = {name: table for name, table in schema["definitions"].items() if table.get("type") == "object"}
    for name, table in (tables | {"the file": schema}).items():
        rest = table["additionalProperties"]
        # Sub-tables hold the options of plugins, and those of the stock are stocks of a name.
        assert rest is False or rest.get("type") == "object" or rest == {"$ref": "#/definitions/BodyFile"}, name
        for key, value in table.get("properties", {}).items():
            assert isinstance(value.get("description"), str), f"{name}.{key}"


# A line of the AC trunnion's file, what stands there instead, and where the fault is found.
SLIPS = [
    ('name  = "AC trunnion"', 'nane = "AC trunnion"', ""),
    ('name  = "AC trunnion"', "", ""),
    ("chain = \"[w C' A' b Y X Z (S) t]\"", "chain = 5", "/chain"),
    ("gauge = [0, 0, 400]", "gauge = [0, 400]", "/tool/gauge"),
    ("gauge = [0, 0, 400]", "", "/tool"),
    ("gauge = [0, 0, 400]", "gauge = [0, 0, true]", "/tool/gauge/2"),
    ("travel    = [-120, 30]", "travle = [-120, 30]", "/axis/A"),
    ("travel    = [-120, 30]", "travel = 30", "/axis/A/travel"),
    ("rotary    = [1, 0, 0]", "", "/axis/A"),
    ("rotary    = [1, 0, 0]", "rotary = [1, 0, 0]\nlinear = [1, 0, 0]", "/axis/A"),
    ("cyclic    = true", 'cyclic = "yes"', "/axis/C/cyclic"),
    ("max_feed  = 5400", "max_feed = -5400", "/axis/A/max_feed"),
    ('tcp     = "post"', 'tcp = "both"', "/control/tcp"),
    ('tcp     = "post"', 'tpc = "post"', "/control/tpc"),
    ('dialect = "fanuc"', "", "/control"),
    ("tolerance       = 0.005", "tolerance = [0.005]", "/accuracy/tolerance"),
    ("[accuracy]", '[solution]\nrule = "fastest"\n[accuracy]', "/solution/rule"),
    ("[accuracy]", '[solution]\nprefer = { A = "down" }\n[accuracy]', "/solution/prefer/A"),
    ("[accuracy]", "[rewind]\nlength = 50\n[accuracy]", "/rewind"),
    ("[accuracy]", '[head.2]\nwrod = "M62"\n[accuracy]', "/head/2"),
    ("[accuracy]", "[control.fanuc]\ndecimals = [3]\n[accuracy]", "/control/fanuc/decimals"),
]


@pytest.mark.parametrize(("line", "slip", "place"), SLIPS)
def test_slips_are_found(
    line: str,
    slip: str,
    place: str,
    faults: Faults,
    command: Callable[..., subprocess.CompletedProcess[str]],
    room: Path,
) -> None:
    text = (CHECKOUT / "machines/ac-trunnion.toml").read_text()
    assert line in text
    text = text.replace(line, slip, 1)
    found = faults(text)
    # A key that two forms exclude is told at the table that holds it.
    assert any(fault.startswith(f"{place}: ") for fault in found), found
    # The command finds them too.
    (room / "slip.toml").write_text(text)
    run = command("-m", "slip.toml", str(CHECKOUT / "tests/samples/plate.ncl"), "-o", "-")
    assert (run.returncode, run.stdout) == (1, "")


@pytest.mark.parametrize(
    "text",
    [
        'extends = "vmc"',
        'extends = "vmc"\n[axis.X]\ntravel = [-100, "2 * reach"]\n[parameters]\nreach = 80',
        'extends = "vmc"\n[control]\nunits = "inch"\n[control.fanuc]\ndecimals = 4\ntrailing_zeros = true',
        'extends = "vmc"\n[accuracy]\nmodel = "sampled"\n[accuracy.sampled]\nsamples = 5',
        'extends = "vmc"\n[head.2]\nword = "M62"\n[head.2.tool]\ngauge = [0, 0, 1]\n[head.2.axis.C]\nindexed = 0',
        'extends = "vmc"\n[tools]\n1 = 120.5\n[solution]\nstart = { C = 90 }\nexclusive = [["A", "C"]]',
    ],
)
def test_what_is_right_passes(text: str, faults: Faults) -> None:
    """Though it is rare."""
    assert faults(text) == []


def test_a_misspelt_table_does_not_pass(faults: Faults) -> None:
    assert faults('extends = "vmc"\nchains = ""') != []


def test_options_of_dialects_are_in_it(faults: Faults) -> None:
    """The options of a dialect that is built in are known to an editor, with what they take."""

    def file(options: str) -> str:
        return f'extends = "vmc"\n[control.fanuc]\n{options}\n'

    good = 'block_numbers = "tools"\nprogram_number = 12\nretract = ["G91 G28 Z0.", "G90"]'
    assert faults(file(good)) == []
    for bad in ("program_numbr = 12", "program_number = 12345678", "block_numbers = true", "retract = 3"):
        assert len(faults(file(bad))) == 1, bad
