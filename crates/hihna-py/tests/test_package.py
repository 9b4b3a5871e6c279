"""What the package says of itself. That it installs is seen by hand (CONTRIBUTING): its build takes minutes."""

import pathlib
import subprocess
import sys

import hihna

FOLDER = pathlib.Path(__file__).parents[1]


def test_metadata(tmp_path):
    command = [sys.executable, "-m", "maturin", "pep517", "write-dist-info", "--metadata-directory", str(tmp_path)]
    subprocess.run(command, cwd=FOLDER, check=True, capture_output=True)
    (place,) = tmp_path.glob("hihna-*.dist-info")
    fields, _, text = (place / "METADATA").read_text(encoding="utf-8").partition("\n\n")
    lines = fields.splitlines()
    assert f"Version: {hihna.__version__}" in lines and "Name: hihna" in lines
    assert "Requires-Python: >=3.10" in lines and "Requires-Dist: numpy>=1.24" in lines
    assert text.strip() == (FOLDER / "README.md").read_text(encoding="utf-8").strip()
