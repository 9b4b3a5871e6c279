"""Every block of shell, TOML and Python in the documents runs.

Commands of a block run in a fresh folder with the `examples` and the drive files of the page: a block that begins with
`# name.toml` is saved under that name. Fragments of drive files are put into the built-in drive. `HIHNA` is the program.
"""

import json
import math
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

import hihna
import pytest

ROOT = pathlib.Path(__file__).parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs" / "src").rglob("*.md"))]
BLOCK = re.compile(r"^```(\w+)[^\n]*\n(.*?)^```", re.MULTILINE | re.DOTALL)

# What a page shows but its test does not do, all of it: building and installing, benchmarks and studies of many minutes, and what
# other tests run.
ELSEWHERE = {
    "./check",
    "cargo bench -p ancf",
    "pip install ./crates/hihna-py",
    "cargo build --release && python3 benches/element_kinds.py",
    "cargo build --release && python3 docs/limit_study.py",
    "hihna validate",
    "cargo run --release -- validate --markdown > docs/src/validation.md",
}


def blocks(page):
    return BLOCK.findall(page.read_text(encoding="utf-8"))


def shell(text, page_folder, number):
    folder = page_folder / f"block_{number}"
    folder.mkdir()
    shutil.copytree(ROOT / "examples", folder / "examples")
    for file in page_folder.glob("*.toml"):
        shutil.copy(file, folder)
    for line in text.splitlines():
        command = line.split(" #")[0].strip()
        if not command or command.startswith("#") or command in ELSEWHERE:
            continue
        if command.startswith("cargo run --release -- "):
            command = command.replace("cargo run --release --", "hihna")
        words = shlex.split(command)
        if words[:2] == ["python3", "docs/plot_history.py"]:
            # Its picture stays here, not among those of the guide.
            words = [sys.executable, str(ROOT / words[1]), *words[2:], "picture.svg"]
        else:
            assert words[0] == "hihna", f"`{command}` is neither run nor known to run elsewhere"
            words[0] = os.environ["HIHNA"]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"`{command}`: {done.stderr}"


def drive(text, folder):
    name = re.match(r"# (\w+\.toml)\n", text)
    if name:
        (folder / name[1]).write_text(text, encoding="utf-8")
    fields = toml(text)
    base = hihna.Drive.built_in().to_dict()
    if "belt" in fields and "pulley" in fields:
        hihna.Drive.from_toml(text)
        return
    for name, value in fields.items():
        if name in ("friction", "back_friction", "surface"):
            base["contact"][name] = value
        elif name in ("speed", "irregularity"):
            base["pulley"][0][name] = value
        elif name in ("load", "torque"):
            base["pulley"][1][name] = value
        elif name == "pulley":
            base = in_an_example(value)
        elif isinstance(value, dict):
            base[name] = {**base.get(name, {}), **value}
        else:
            base[name] = value
    hihna.Drive.from_dict(base)


def in_an_example(pulleys):
    """The example that has pulleys of these names, with these in their place."""
    names = {pulley["name"] for pulley in pulleys}
    for file in sorted((ROOT / "examples").glob("*.toml")):
        base = hihna.Drive.load(file).to_dict()
        if names <= {pulley["name"] for pulley in base["pulley"]}:
            stated = {pulley["name"]: pulley for pulley in pulleys}
            base["pulley"] = [stated.get(pulley["name"], pulley) for pulley in base["pulley"]]
            return base
    raise AssertionError(f"no example has pulleys {names}")


def toml(text):
    try:
        import tomllib
    except ModuleNotFoundError:  # Python 3.10
        tomllib = pytest.importorskip("tomli")
    return tomllib.loads(text)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_blocks_run(page, tmp_path, monkeypatch):
    shutil.copy(ROOT / "examples" / "two_pulley.toml", tmp_path / "my_drive.toml")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "Agg")
    names = {}
    for number, (language, text) in enumerate(blocks(page)):
        if language == "sh":
            shell(text, tmp_path, number)
        elif language == "toml":
            drive(text, tmp_path)
        elif language == "python":
            exec(compile(text, str(page), "exec"), names)
        else:
            assert language in ("text", "rust"), f"nothing runs blocks of {language}"


def test_every_page_is_in_the_summary():
    source = ROOT / "docs" / "src"
    summary = (source / "SUMMARY.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"\]\(([^)]+\.md)\)", summary))
    there = {str(page.relative_to(source)) for page in source.rglob("*.md")} - {"SUMMARY.md"}
    assert listed == there


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        if "://" not in target:
            assert (page.parent / target).exists(), target


def test_the_tutorial_prints_what_its_commands_print(tmp_path):
    page = (ROOT / "docs" / "src" / "tutorial.md").read_text(encoding="utf-8")
    words = " ".join(page.split())
    drive = next(text for language, text in BLOCK.findall(page) if language == "toml")
    (tmp_path / "my_drive.toml").write_text(drive, encoding="utf-8")
    for tension in (150, 100, 60):
        arguments = ["run", "my_drive.toml", "--set", f"belt.tension={tension}", "--out", str(tension), "--json", "--quiet"]
        done = subprocess.run([os.environ["HIHNA"], *arguments], cwd=tmp_path, capture_output=True, check=True)
        steady = json.loads(done.stdout)["steady"]
        motor, fan = steady["pulley"]["motor"], steady["pulley"]["fan"]
        slip, contact = (math.degrees(motor[name]) for name in ("slip_angle", "contact_angle"))
        tight, slack = sorted((span["tension"] for span in steady["span"].values()), reverse=True)
        hub = max(math.hypot(*pulley["hub_force"]) for pulley in (motor, fan))
        loss = 100 * fan["speed_loss"]
        row = f"| {tension} N | {loss:.2f} % | {slip:.1f}° of {contact:.0f}° | {tight:.0f} / {slack:.0f} N | {hub:.0f} N |"
        assert row in page
        if tension == 150:
            assert f"loses {loss:.1f} % of its speed to slip, the tight span carries {tight:.0f} N" in words
            assert f"the power lost is {steady['power_lost']:.1f} W of {steady['power_in']:.0f} W" in words
            grip = 100 * max(pulley["slip_angle"] / pulley["contact_angle"] for pulley in (motor, fan))
            assert f"*Grip used* is {grip:.1f} %" in words


def test_the_reference_of_the_program_has_every_option():
    page = (ROOT / "docs" / "src" / "guide" / "cli.md").read_text(encoding="utf-8")
    help_of = lambda *command: subprocess.run(
        [os.environ["HIHNA"], *command, "--help"], capture_output=True, text=True, check=True
    ).stdout
    commands = re.findall(r"^  (\w+)  ", help_of().split("Commands:")[1].split("Options:")[0], re.MULTILINE)
    assert {"run", "steady", "validate"} <= set(commands)
    for command in set(commands) - {"help"}:
        section = page.split(f"## `hihna {command}`")[1].split("\n## ")[0]
        everywhere = page.split("## Options of all commands")[1].split("\n## ")[0]
        options = re.findall(r"^ +(?:-\w, )?(--[\w-]+)", help_of(command), re.MULTILINE)
        assert "--help" in options
        missing = [option for option in options if f"`{option}" not in section + everywhere]
        assert not missing, f"{command}: {missing}"


def test_the_reference_of_the_package_has_every_name():
    page = (ROOT / "docs" / "src" / "guide" / "python.md").read_text(encoding="utf-8")
    code = " ".join(re.findall(r"`([^`]+)`", re.sub(r"^```.*?^```", "", page, flags=re.MULTILINE | re.DOTALL)))
    words = set(re.findall(r"\w+", code))
    of = lambda thing: {name for name in vars(thing) if not name.startswith("_")}
    names = {name for name in hihna.__all__ if not name.startswith("_")} | set(hihna.ancf.__all__) - {"Motion", "Structure"}
    for kind in (hihna.Drive, hihna.Results, *(getattr(hihna.ancf, name) for name in hihna.ancf.__all__)):
        if isinstance(kind, type):
            names |= of(kind) | set(getattr(kind, "__dataclass_fields__", ()))
    # What sections and materials are made of stands in their own words.
    names -= {field for kind in (hihna.ancf.Section, hihna.ancf.SpatialSection) for field in kind.__dataclass_fields__}
    assert not names - words


def fields(node, path=()):
    """Paths of all fields of a JSON schema."""
    if isinstance(node, dict):
        for name, below in node.get("properties", {}).items():
            yield (*path, name)
            yield from fields(below, (*path, name))
        for name, below in node.items():
            if name != "properties":
                yield from fields(below, path)
    elif isinstance(node, list):
        for below in node:
            yield from fields(below, path)


def test_every_field_of_drive_files_is_documented():
    schema = subprocess.run([os.environ["HIHNA"], "schema"], capture_output=True, text=True, check=True).stdout
    source = ROOT / "docs" / "src"
    guide = (source / "guide" / "drive_file.md").read_text(encoding="utf-8")
    items = "\n".join(page.read_text(encoding="utf-8") for page in (source / "items").glob("*.md"))
    all_fields = set(fields(json.loads(schema)))
    assert len(all_fields) > 100
    for path in all_fields:
        name = re.compile(rf"`(?:\[+)?(?:[\w.]+\.)?\.?{path[-1]}(?:\]+)?(?: = [^`]*)?`")
        assert name.search(guide), f"{'.'.join(path)} is not in the guide"
        assert name.search(items), f"{'.'.join(path)} has no page of its object"
