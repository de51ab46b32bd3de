"""The package around the engine: types, the console script, documents."""

import importlib.metadata
import inspect
import os
import pathlib
import re
import subprocess
import sys

import crashrank
import pytest
from conftest import DATA, ROOT, program

PACKAGE = pathlib.Path(crashrank.__file__).parent


def test_types_are_checked_in_strict_mode(tmp_path):
    pytest.importorskip("mypy")
    user = tmp_path / "user.py"
    user.write_text(
        "import crashrank\n"
        "import numpy as np\n"
        "model: crashrank.Model = crashrank.load_model('a.obj', scale=0.001)\n"
        "pairs = crashrank.collide(model, model, np.eye(4))\n"
        "reveal_type(pairs)\n"
        "ranking = crashrank.rank('s.json', workers=2)\n"
        "best: str = ranking.best.candidate\n"
        "for each in ranking:\n"
        "    reveal_type(each.score)\n"
        "crashrank.rank('s.json', workers='two')\n"
    )
    path = os.pathsep.join([str(PACKAGE.parent), os.environ.get("MYPYPATH", "")])
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", "--cache-dir",
         str(tmp_path / "cache"), str(user)],
        capture_output=True, text=True, check=False, cwd=tmp_path,
        env={**os.environ, "MYPYPATH": path} if "site-packages" not in path else os.environ,
    )  # fmt: skip
    assert ("ndarray" in done.stdout and "int32" in done.stdout) or "signedinteger" in done.stdout
    assert 'Revealed type is "float | None"' in done.stdout
    errors = [
        line
        for line in done.stdout.splitlines()
        if line.startswith("user.py:") and ": error:" in line
    ]
    assert len(errors) == 1, done.stdout + done.stderr
    assert 'incompatible type "str"' in errors[0]


def test_the_package_itself_passes_mypy(tmp_path):
    pytest.importorskip("mypy")
    if "site-packages" in str(PACKAGE):
        pytest.skip("checked in the build folder")
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"),
         "--cache-dir", str(tmp_path / "cache"), "-p", "crashrank"],
        capture_output=True, text=True, check=False, cwd=PACKAGE.parent,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_style_is_kept():
    pytest.importorskip("ruff")
    for words in (["check"], ["format", "--check"]):
        done = subprocess.run(
            [sys.executable, "-m", "ruff", *words, "--no-cache", str(ROOT / "python")],
            capture_output=True, text=True, check=False, cwd=ROOT,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout


def test_stubs_and_marker_are_there():
    assert (PACKAGE / "py.typed").is_file()
    stub = (PACKAGE / "_core.pyi").read_text()
    assert "def collide_any(" in stub
    assert "Any" not in re.sub(r"#.*", "", stub)


def test_public_names_alone_are_listed():
    assert dir(crashrank) == sorted(crashrank.__all__)


def test_public_names_are_documented():
    for name in crashrank.__all__:
        value = getattr(crashrank, name)
        if name.startswith("__"):
            continue
        assert inspect.getdoc(value), name
        if inspect.isclass(value):
            for member, what in vars(value).items():
                if not member.startswith("_") and (callable(what) or isinstance(what, property)):
                    assert inspect.getdoc(what), f"{name}.{member}"


def run_script(*words):
    code = "import sys; from crashrank._program import main; sys.exit(main())"
    return subprocess.run(
        [sys.executable, "-c", code, *words], capture_output=True, text=True, check=False,
        env={**os.environ, "CRASHRANK_PROGRAM": os.environ.get("CRASHRANK_PROGRAM", "")},
    )  # fmt: skip


def test_the_console_script_offers_every_subcommand():
    text = run_script("--help").stdout
    commands = "inspect compile collide rank new check sweep validate completion"
    for command in commands.split():
        assert re.search(rf"^\s+{command}\b", text, re.MULTILINE)
    assert run_script("--version").stdout == f"crashrank {crashrank.__version__}\n"
    done = run_script("rank", str(DATA / "scenarios/oncoming_truck.json"))
    assert done.returncode == 0
    assert "coast into the barrier" in done.stdout
    assert run_script("nonsense").returncode == 2
    assert program()


def test_import_names_its_readers():
    done = run_script("import", "--help")
    assert done.returncode == 0
    assert "commonroad" in done.stdout
    done = run_script("import", "commonroad", "x.xml", "-o", "y.json")
    assert done.returncode == 3
    assert "x.xml" in done.stderr or "lxml" in done.stderr


def test_versions_agree():
    header = (ROOT / "include/crashrank/base/version.hpp").read_text()
    assert f'"{crashrank.__version__}"' in header
    try:
        installed = importlib.metadata.version("crashrank")
    except importlib.metadata.PackageNotFoundError:
        return
    assert installed == crashrank.__version__


def python_blocks(page):
    """Return the Python code of a page as one program: later blocks use earlier names."""
    text = (ROOT / page).read_text(encoding="utf-8")
    return "\n".join(re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL))


@pytest.mark.parametrize("page", ["README.md", "docs/guide/python.md"])
def test_code_of_the_documents_runs(page, tmp_path):
    (tmp_path / "data").symlink_to(DATA)
    done = subprocess.run(
        [sys.executable, "-c", python_blocks(page)],
        capture_output=True, text=True, check=False, cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "coast into the barrier" in done.stdout
