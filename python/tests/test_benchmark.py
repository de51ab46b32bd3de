"""The stored scenes against their generator and the engine; the command that scores choosers."""

from __future__ import annotations

import csv
import hashlib
import importlib
import json
import signal
import subprocess
import sys
import time

import crashrank
import pytest
from conftest import DATA, ROOT
from crashrank import benchmark
from crashrank.benchmark._rank import answers_of, rank_scene
from crashrank.benchmark._score import summary_csv

STORED = benchmark.load()
FOLDER = DATA / "benchmark"


def run(*words, cwd=None, timeout=60):
    return subprocess.run(
        [sys.executable, "-m", "crashrank", "benchmark", *map(str, words)],
        capture_output=True, text=True, check=False, cwd=cwd, timeout=timeout,
    )  # fmt: skip


def test_stored_scenes_are_what_the_generator_writes(monkeypatch) -> None:
    monkeypatch.syspath_prepend(FOLDER)
    situations = importlib.import_module("situations")
    seen, lines = set(), []
    for scene in STORED.scenes:
        situation, number = scene["name"].split()
        seen.add(situation)
        lines.append(
            json.dumps(situations.draw(situation, int(number)), separators=(",", ":")) + "\n"
        )
    text = "".join(lines).encode()
    assert text == (FOLDER / "scenes.jsonl").read_bytes()
    assert hashlib.sha256(text).hexdigest() == STORED.sha256
    assert seen == set(situations.SITUATIONS)


def test_a_hundred_scenes_of_bounded_size() -> None:
    assert len(STORED.lines) == len(set(STORED.lines)) == 100
    assert max(map(len, STORED.lines)) <= 4000
    assert len((FOLDER / "scenes.jsonl").read_bytes()) <= 400_000
    for scene, answers in zip(STORED.scenes, STORED.answers, strict=True):
        assert 5 <= len(answers) <= 12
        assert scene["candidates"]["listed"][0]["name"] == "brake hard in lane"
        assert min(a.best_place for a in answers) == 1
        for answer in answers:
            assert STORED.floor_persons <= answer.harm_persons
            assert answer.lowest <= answer.harm_persons <= answer.highest


def test_every_scene_is_accepted() -> None:
    for scene in STORED.scenes:
        crashrank.Scenario(scene, base=FOLDER)


@pytest.mark.parametrize("index", [0, 3, 6, 12, 13])
def test_ranking_again_gives_the_stored_answers(index) -> None:
    ranking = rank_scene(STORED.scenes[index], DATA / "models")
    stored = [answer[:7] for answer in STORED.answers[index]]
    assert [answer[:7] for answer in answers_of(STORED.scenes[index], ranking)] == stored
    for row in ranking:
        assert row.feasible
        assert all(future.collides for future in row.futures)
        assert min(future.score for future in row.futures) >= STORED.floor_persons


def test_scores_of_choices() -> None:
    def best(scene):
        answers = next(a for a in STORED.answers if a[0].scene == scene["name"])
        harm = [answer.harm_persons for answer in answers]
        scene.clear()  # it is the chooser's own
        return harm.index(min(harm))

    rows = benchmark.score(best)
    assert len(rows) == 100
    assert all(row.regret_persons == 0 and row.best == 1 for row in rows)
    braking = benchmark.score(lambda _: "brake hard in lane", scenes=14)
    stored = [r for r in benchmark.stored_rows() if r.chooser == "full braking in lane"][:14]
    assert [row[2:] for row in braking] == [row[2:] for row in stored]
    found = benchmark.summary(benchmark.stored_rows())
    assert list(found) == [*STORED.choosers, "at random"]
    for figures in found.values():
        assert 0 <= figures["mean_regret_persons"] <= figures["worst_regret_persons"]
        assert figures["best_share"] < 1


def test_the_published_table_is_the_stored_one(tmp_path) -> None:
    done = run("-o", tmp_path / "out.csv")
    assert done.returncode == 0, done.stderr
    assert STORED.sha256 in done.stdout
    published = ROOT / "docs/evidence/benchmark.csv"
    assert (tmp_path / "out.csv").read_bytes() == published.read_bytes()
    table = (ROOT / "docs/evidence/benchmark-choosers.csv").read_text(encoding="utf-8")
    assert table == summary_csv(benchmark.stored_rows())


def test_a_chooser_of_a_module_beside_the_caller(tmp_path) -> None:
    (tmp_path / "planner.py").write_text(
        "def choose(scene):\n    return len(scene['candidates']['listed']) - 1\n"
    )
    done = run("--chooser", "planner:choose", "--scenes", 5, "-o", "out.csv", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "planner:choose" in done.stdout
    with open(tmp_path / "out.csv", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["chooser"] == "planner:choose"]
    assert [row["choice"] for row in rows] == [a[-1].candidate for a in STORED.answers[:5]]


@pytest.mark.parametrize(
    ("chooser", "body", "code", "text"),
    [
        ("planner", "", 2, "write MODULE:FUNCTION"),
        ("missing_module:f", "", 2, "No module named"),
        ("planner:missing", "", 2, "no attribute 'missing'"),
        ("planner:f", "f = 3", 2, "is no function"),
        ("planner:f", "def f(:", 2, "SyntaxError"),
        ("planner:f", "def f(scene): return 'jump'", 3, "returned 'jump'; return one of 'brake"),
        ("planner:f", "def f(scene): return -1", 3, "returned -1"),
        ("planner:f", "def f(scene): return True", 3, "returned True"),
        ("planner:f", "def f(scene): return None", 3, "returned None"),
        ("planner:f", "def f(scene): raise ValueError('a\\nb')", 3, "raised ValueError: a b;"),
        ("planner:f", "import sys\ndef f(scene): sys.exit(0)", 3, "raised SystemExit"),
    ],
)
def test_refusals(tmp_path, chooser, body, code, text) -> None:
    (tmp_path / "planner.py").write_text(body)
    done = run("--chooser", chooser, cwd=tmp_path)
    assert done.returncode == code
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert done.stderr.startswith("crashrank: ")
    assert text in done.stderr


def test_other_refusals(tmp_path) -> None:
    done = run("--scenes", 0)
    assert done.returncode == 2
    assert "not from 1 to 100" in done.stderr
    done = run("-o", tmp_path / "missing/out.csv")
    assert done.returncode == 1
    assert "cannot be written" in done.stderr
    done = run("--rank", "--models", tmp_path)
    assert done.returncode == 3
    assert "name the folder data/models" in done.stderr


def test_ranking_anew() -> None:
    done = run("--rank", "--scenes", 2, "--models", DATA / "models")
    assert done.returncode == 0, done.stderr
    assert "answers ranked anew: all as stored" in done.stdout


def test_differences_are_said(monkeypatch, capsys) -> None:
    from crashrank.benchmark import _command

    first = STORED.first(1)
    changed = first.answers[0][1]._replace(harm_persons=9.0)
    answers = ((first.answers[0][0], changed, *first.answers[0][2:]),)
    monkeypatch.setattr(_command, "load", lambda: benchmark.Benchmark(
        1, first.sha256, 0.001, first.choosers, first.lines, answers))  # fmt: skip
    assert _command.main(["--rank", "--models", str(DATA / "models")]) == 3
    printed = capsys.readouterr()
    assert f"{changed.scene}, {changed.candidate}: 9 (" in printed.out
    assert f"1 of {len(answers[0])} answers differ" in printed.err


def test_interrupt_ends_it(tmp_path) -> None:
    (tmp_path / "slow.py").write_text(
        "import time\ndef f(scene):\n    open('begun', 'w').close()\n    time.sleep(60)\n"
    )
    started = subprocess.Popen(
        [sys.executable, "-m", "crashrank", "benchmark", "--chooser", "slow:f"],
        cwd=tmp_path, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    while not (tmp_path / "begun").exists():
        time.sleep(0.02)
    started.send_signal(signal.SIGINT)
    assert started.communicate(timeout=20)[1] == "crashrank: interrupted\n"
    assert started.returncode == 4
