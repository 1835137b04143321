"""The scripts of the page for Python run as they stand."""

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[1] / "examples"
PAGES = Path(__file__).resolve().parents[3] / "docs"


def test_the_figure_of_the_paper_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "bogie.png"
    command = [sys.executable, str(SCRIPTS / "bogie_figure.py"), str(picture)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert picture.stat().st_size > 10_000
    assert "0.5248 ft" in done.stdout


def test_influence_coefficients_make_the_round_trip():
    pytest.importorskip("skfem")
    done = subprocess.run([sys.executable, str(SCRIPTS / "round_trip.py")], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("page", ["python.md", "library.md"])
def test_the_python_of_the_pages_runs(page, tmp_path, monkeypatch):
    """All blocks of a page are one program, in the folder of the repository."""
    monkeypatch.chdir(PAGES.parent)
    text = (PAGES / page).read_text()
    blocks = [block.split("\n", 1)[1] for block in text.split("```")[1::2] if block.startswith("python\n")]
    assert blocks
    program = "\n".join(blocks).replace('"out/', f'"{tmp_path.as_posix()}/')
    exec(compile(program, page, "exec"), {"__name__": page})
