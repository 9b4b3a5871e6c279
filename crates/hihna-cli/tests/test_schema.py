"""The JSON schema of drive files says what the program says: it accepts what that reads, and refuses plain mistakes.

Needs jsonschema; `HIHNA` is the program. The test command provides both.
"""

import copy
import json
import os
import pathlib
import subprocess

import hihna
import jsonschema
import pytest

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    tomllib = pytest.importorskip("tomli")

EXAMPLES = sorted((pathlib.Path(__file__).parents[3] / "examples").glob("*.toml"))
TWO_PULLEYS = tomllib.loads(next(file for file in EXAMPLES if file.stem == "two_pulley").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def schema():
    done = subprocess.run([os.environ["HIHNA"], "schema"], capture_output=True, check=True)
    schema = json.loads(done.stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_examples_are_valid_as_written_and_with_their_defaults(schema, file):
    schema.validate(tomllib.loads(file.read_text(encoding="utf-8")))
    schema.validate(hihna.Drive.load(file).to_dict())


def changed(path, value):
    drive = copy.deepcopy(TWO_PULLEYS)
    at = drive
    for step in path[:-1]:
        at = at[step]
    at[path[-1]] = value
    return drive


# What stands in a field, and whether it is right.
TEXTS = [
    ("10 mm", True), ("10mm", True), ("+1.5e-2 m", True), (".5 in", True), ("1.e1 mm", True), (" 1 cm ", True), ("1e1mm", True),
    ("much", False), ("", False), ("12", False), ("1e5", False), ("-", False), ("mm", False), ("1.2.3", False),
]  # fmt: skip


@pytest.mark.parametrize(("text", "right"), TEXTS)
def test_text_is_judged_as_by_the_program(schema, text, right):
    drive = changed(["belt", "width"], text)
    assert schema.is_valid(drive) == right
    try:
        hihna.Drive.from_dict(drive)
        accepted = True
    except hihna.InputError:
        accepted = False
    assert accepted == right


def test_units_that_begin_with_a_digit_or_an_e_are_no_mistakes(schema):
    for path, text in [(["pulley", 0, "speed"], "720 1/min"), (["belt", "length"], "1.2727 m"), (["belt", "length"], "1e-18 Em")]:
        drive = changed(path, text)
        schema.validate(drive)
        assert text == "1e-18 Em" or hihna.Drive.from_dict(drive)


MISTAKES = [
    (["pulley"], TWO_PULLEYS["pulley"][:1]),
    (["pulley", 0, "speed"], {"kind": "table", "time": [0.0], "value": []}),
    (["pulley", 1, "load"], {"law": "table", "speed": [], "torque": []}),
    (["pulley", 1, "radius"], -0.1),
    (["pulley", 1, "center"], [0.0]),
    (["belt", "elements"], 2),
    (["belt", "elemnts"], 20),
    (["belt", "strain"], 0.01),
    (["belt", "element"], "rope"),
    (["contact", "friction"], {"law": "creep-rate", "coefficient": 1.2}),
    (["run", "step"], "slow"),
]


@pytest.mark.parametrize(("path", "value"), MISTAKES, ids=lambda part: json.dumps(part)[:40])
def test_mistakes_are_refused_by_both(schema, path, value):
    drive = changed(path, value)
    assert not schema.is_valid(drive)
    with pytest.raises(hihna.InputError):
        hihna.Drive.from_dict(drive)
