"""The notebooks run to their end, and are stored without outputs that could grow old."""

import os

import pytest
from conftest import ROOT

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")
pytest.importorskip("ipykernel")
pytest.importorskip("matplotlib")
pytest.importorskip("pandas")

FOLDER = ROOT / "docs/notebooks"
# What an output has to hold.
SHOWN = {
    "decision_curve": ["hits pedestrian 2 at 2.1", "last_halvable: 0.", "False"],
    "first_ranking": ["1 coast into the barrier", "sandbox=", "score_lowest", "14.0 m/s: "],
    "planner_loop": ["0.7 s  brake", "score_highest"],
    "scene_database": ["12 of 12 scenes", "; 0 ranked in", "broken", "_summary.html"],
}


def test_every_notebook_is_here():
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(SHOWN)


def texts_of(cells):
    """Return everything that the cells show as one text."""
    shown = []
    for cell in cells:
        for output in cell.get("outputs", []):
            shown.append(output.get("text", ""))
            shown.extend(str(data) for data in output.get("data", {}).values())
    return "\n".join(shown)


@pytest.mark.parametrize("name", SHOWN)
def test_notebooks_run(name, tmp_path, monkeypatch):
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path / "runtime"))
    monkeypatch.setenv("MPLCONFIGDIR", os.environ.get("MPLCONFIGDIR", str(tmp_path / "matplotlib")))
    notebook = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert code
    assert all(cell.outputs == [] and cell.execution_count is None for cell in code)
    client = nbclient.NotebookClient(
        notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(FOLDER)}}
    )
    client.execute()
    shown = texts_of(code)
    for text in SHOWN[name]:
        assert text in shown
    figures = [o for cell in code for o in cell.outputs if "image/png" in o.get("data", {})]
    assert bool(figures) == (name in ("decision_curve", "first_ranking"))
