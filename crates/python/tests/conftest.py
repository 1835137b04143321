"""Places of the repository that the tests use."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
EXAMPLES = ROOT / "examples"


@pytest.fixture(scope="session")
def examples() -> Path:
    return EXAMPLES


@pytest.fixture(scope="session")
def girderway() -> str:
    """The command line of the same checkout; its tests are skipped without it."""
    given = os.environ.get("GIRDERWAY")
    candidates = [given, str(ROOT / "target/release/girderway"), shutil.which("girderway")]
    for candidate in candidates:
        if candidate and Path(candidate).exists():
            return candidate
    pytest.skip("no command line: set GIRDERWAY to the path of the program")


@pytest.fixture(scope="session")
def command_line(girderway: str, tmp_path_factory: pytest.TempPathFactory):
    """Runs the command line and returns its output folder."""

    def run(command: str, file: Path, name: str) -> Path:
        folder = tmp_path_factory.mktemp("out") / name
        subprocess.run([girderway, command, str(file), "-o", str(folder), "--quiet"], check=True)
        return folder

    return run
