"""``crashrank-batch`` on this machine: the same results, what is made anew, the summary."""

import html.parser
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import crashrank
import pytest
from batch_scenes import (
    command,
    make_models,
    parts,
    results,
    run_batch,
    running,
    scene,
    write_scene,
)
from crashrank.batch import result_hash

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")


def broken(folder):
    """Add a scenario that is no JSON, one without a model, and one that is no text."""
    write_scene(folder, "broken", "{")
    write_scene(
        folder, "no-model", scene(0, models={"car": {"mesh": "gone.obj", "kind": "car"}}, actors=[])
    )
    (folder / "binary.json").write_bytes(b"\xff\xfe\x00")


def test_every_way_to_run_has_the_same_results(scenes, tmp_path):
    broken(scenes)
    out = [tmp_path / f"out-{i}" for i in range(3)]
    first = run_batch(scenes, "-o", out[0], "--sequential", "--rows-per-part", 4)
    second = run_batch(scenes, "-o", out[1], "--workers", 2)
    third = run_batch(scenes, "-o", out[2], "--workers", 1, "--rows-per-part", 100)
    assert first["results"] == second["results"] == third["results"]
    assert results(out[0]) == results(out[1]) == results(out[2])
    assert (first["rows"], first["errors"], first["complete"]) == (15, 3, True)
    assert (len(parts(out[0])), len(parts(out[1])), len(parts(out[2]))) == (4, 15, 1)
    rows = {row["id"]: row for row in pq.read_table(out[1]).to_pylist()}
    for i in (0, 7):
        answer = crashrank.rank(scenes / f"scene-{i:02}.json").to_dict()
        assert rows[f"scene-{i:02}.json"]["result_hash"] == result_hash(answer)
    assert rows["no-model.json"]["error_code"] == "not_found"
    assert "gone.obj" in rows["no-model.json"]["error"]
    assert str(scenes / "broken.json") in rows["broken.json"]["error"]
    assert "UTF-8" in rows["binary.json"]["error"]


def test_a_second_run_ranks_nothing(scenes, tmp_path):
    out = tmp_path / "out"
    first = run_batch(scenes, "-o", out, "--workers", 2, "--rows-per-part", 5)
    before = parts(out)
    second = run_batch(scenes, "-o", out, "--workers", 1)
    assert parts(out) == before
    assert (first["found_rows"], second["found_rows"]) == (0, 12)
    assert second["results"] == first["results"]


CHANGES = {
    "input": lambda folder: write_scene(folder, "scene-03", scene(30)) and (),
    "model": lambda folder: make_pole_of("truck.obj", folder) or (),
    "setting": lambda _: ("--measure", "energy"),
    "damage": lambda _: (),
}


def make_pole_of(mesh, folder):
    from conftest import DATA

    pole = folder / "models/pole.crm"
    crashrank.load_model(DATA / "models" / mesh).save(pole, overwrite=True)


@pytest.mark.parametrize(("what", "made"), [("input", 1), ("model", 3), ("setting", 3)])
def test_what_has_changed_is_made_anew(scenes, tmp_path, what, made):
    out = tmp_path / "out"
    words = (scenes, "-o", out, "--sequential", "--rows-per-part", 4)
    first = run_batch(*words)
    before = parts(out)
    more = CHANGES[what](scenes)
    second = run_batch(*words, *more)
    assert second["rows"] - second["found_rows"] == 4 * made
    assert second["results"] != first["results"]
    assert len(parts(out)) == 3
    assert len(set(parts(out).items()) - set(before.items())) == made
    assert not (out / "_stale").exists()
    fresh = run_batch(scenes, "-o", tmp_path / "fresh", "--sequential", *more)
    assert fresh["results"] == second["results"]
    assert run_batch(*words, *more)["found_rows"] == 12


def test_another_engine_makes_everything_anew(scenes, tmp_path, monkeypatch):
    from crashrank.batch import _parts, _worker

    out = tmp_path / "out"
    words = (scenes, "-o", out, "--sequential", "--rows-per-part", 6)
    run_batch(*words)
    before = parts(out)
    run_batch(*words)
    assert parts(out) == before
    monkeypatch.setattr(_worker, "engine_hash", lambda: "another build")
    run_batch(*words)
    built = parts(out)
    assert not set(built) & set(before)

    class Version:
        version = "99.0.0"

    monkeypatch.setattr(_parts, "_core", Version)
    run_batch(*words)
    assert not set(parts(out)) & set(built)


@pytest.mark.parametrize("how", ["cut", "flipped", "emptied", "foreign"])
def test_a_damaged_part_is_made_anew(scenes, tmp_path, how):
    out = tmp_path / "out"
    words = (scenes, "-o", out, "--sequential", "--rows-per-part", 6)
    first = run_batch(*words)
    victim, other = sorted(out.glob("part-*.parquet"))
    data = victim.read_bytes()
    if how == "flipped":
        at = data.index(b"result_hash") if b"result_hash" in data[:200] else 40
        data = data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]
    victim.write_bytes(
        {"cut": data[:-100], "flipped": data, "emptied": b"", "foreign": other.read_bytes()}[how]
    )
    second = run_batch(*words)
    assert second["found_rows"] == 6
    assert second["results"] == first["results"]
    assert len(results(out)) == 12


def test_results_of_other_settings_come_back_after_a_mistake(scenes, tmp_path):
    out = tmp_path / "out"
    words = (scenes, "-o", out, "--rows-per-part", 2)
    run_batch(*words, "--sequential")
    before = parts(out)
    with running(*words, "--measure", "harm", "--sequential") as mistake:
        end = time.monotonic() + 60
        while len(list(out.glob("_stale/*"))) < 2:
            assert mistake.poll() is None, mistake.communicate()
            assert time.monotonic() < end
            time.sleep(0.01)
        mistake.send_signal(signal.SIGINT)
        assert mistake.wait(30) == 4
    assert run_batch(*words, "--sequential")["found_rows"] == 12
    assert parts(out) == before
    assert not (out / "_stale").exists()


def test_fewer_rows_leave_no_part_behind(scenes, tmp_path):
    out = tmp_path / "out"
    run_batch(scenes, "-o", out, "--sequential", "--rows-per-part", 2)
    for i in range(6, 12):
        (scenes / f"scene-{i:02}.json").unlink()
    assert run_batch(scenes, "-o", out, "--sequential")["found_rows"] == 6
    assert len(results(out)) == 6
    assert len(parts(out)) == 3


class Page(html.parser.HTMLParser):
    """Names of elements, links and text of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.links, self.words = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        for name, value in attributes:
            assert not name.startswith("on")
            if name in ("href", "src"):
                self.links.append(value)

    def handle_data(self, data):
        self.words.append(data)


def test_the_summary_is_offline_and_escaped(tmp_path):
    folder = tmp_path / "scenes"
    make_models(folder)
    evil = "<script>alert(1)</script>&\"'"
    for i in range(4):
        document = scene(i, measure="harm" if i % 2 else "delta-v")
        document["candidates"]["listed"] = [{"name": evil, "acceleration_mps2": -7}]
        write_scene(folder, f"{i}<b>&", document)
    write_scene(folder, "bad<i>", f'{{"{evil}')
    write_scene(folder, "odd", scene(0, evil=1) | {evil: 1})
    out = tmp_path / "out"
    run_batch(folder, "-o", out, "--sequential", "--reports", 1)
    page = Page((out / "_summary.html").read_text(encoding="utf-8"))
    assert not {"script", "b", "i", "img", "link", "iframe"} & set(page.tags)
    words = " ".join(page.words)
    assert evil in words
    assert "bad<i>.json" in words
    assert "4 scenes ranked, 2 with an error" in words
    assert "harm [persons]" in words
    assert "delta-v [m/s]" in words
    assert len(page.links) == 2
    for link in page.links:
        report = out / link
        assert report.is_file()
        assert "<script>alert(1)</script>" not in report.read_text(encoding="utf-8")
    # Fewer reports, and those of other settings, leave none behind.
    run_batch(folder, "-o", out, "--sequential", "--reports", 0)
    assert not list((out / "_reports").glob("*"))


def test_worst_scenes_come_first(scenes, tmp_path):
    out = tmp_path / "out"
    run_batch(scenes, "-o", out, "--sequential", "--reports", 3)
    table = pq.read_table(out, columns=["id", "best_score"]).to_pylist()
    worst = sorted(table, key=lambda row: (-row["best_score"], row["id"]))[:3]
    words = Page((out / "_summary.html").read_text(encoding="utf-8")).words
    shown = [word for word in words if word.startswith("scene-")]
    assert {row["best_score"] for row in worst} == {
        row["best_score"] for row in table if row["id"] in shown
    }
    assert len(shown) == len(list((out / "_reports").glob("*.html"))) == 3


def test_bins_hold_every_score():
    from crashrank.batch._page import bins

    for scores in ([0.0], [0.0, 0.0, 3.0], [5.0], [1e-9, 1e6], [0.1 * i for i in range(100)]):
        found = bins(sorted(scores))
        assert sum(count for _, count in found) == len(scores)
        assert found[0] == ("0", sum(score <= 0 for score in scores))


def test_progress_draws_on_terminals_only():
    import io

    from crashrank.batch._progress import Progress, duration

    class Terminal(io.StringIO):
        def isatty(self):
            return True

    for stream, drawn in ((io.StringIO(), False), (Terminal(), True)):
        progress = Progress(1000, stream)
        progress.add(500, 0, was_there=True)
        time.sleep(0.3)
        progress.add(100, 2, was_there=False)
        assert ("600 of 1000 scenes, 2 with an error" in stream.getvalue()) == drawn
        if drawn:
            assert " a second, " in stream.getvalue()
            assert stream.getvalue().rstrip().endswith("left")
        # 100 were ranked now: the 400 that are left take four times as long.
        assert progress.rate == pytest.approx(100 / progress.seconds, rel=0.2)
    assert [duration(s) for s in (12, 185, 3720)] == ["12 s", "3 min 05 s", "1 h 02 min"]


def test_the_program_is_a_console_script():
    named = shutil.which("crashrank-batch", path=str(pathlib.Path(sys.executable).parent))
    words = [named] if named and "site-packages" in crashrank.__file__ else command()
    done = subprocess.run([*words, "--version"], capture_output=True, text=True, check=True)
    assert done.stdout == f"crashrank-batch {crashrank.__version__}\n"
