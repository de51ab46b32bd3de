"""The benchmark's scenes with crashrank, CriMe and TUM's formula; scripts/comparison runs it.

    comparison_scenes.py FOLDER [--scenes N]

Writes FOLDER/comparison.csv, a row for each candidate, and FOLDER/comparison-tools.csv, a row for
each tool's choice rule, and prints the second as a table in Markdown.

All see the same candidates. crashrank finds the first contact of each: its time and the other body
are handed to the others, which have no search of their own over bodies. CriMe gets the state at
the last whole step before that contact. TUM's formula gets the closing speed and the sides that
face each other (chooser_rules). Scenes with several futures are left out: a CommonRoad scenario
has one.
"""

from __future__ import annotations

import argparse
import csv
import math
import pathlib
import sys
import time
from collections.abc import Iterable, Sequence
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from typing import Any, NamedTuple

import crime_scenario as crime
import numpy as np
from chooser_rules import (
    FIXED,
    LR1S,
    LR4S,
    PERSON,
    UNPROTECTED,
    Candidate,
    Impact,
    delta_v_pair,
    logistic,
    tum_harm,
)
from commonroad_crime.measure.time.ttc_star import TTCStar
from commonroad_crime.measure.velocity.delta_v import DeltaV
from crashrank import Ranking
from crashrank.benchmark import load
from crashrank.benchmark._data import data_folder, written
from crashrank.benchmark._rank import models_folder, rank_scene
from scipy.stats import spearmanr

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "build/release/bin/crashrank"


class Seen(NamedTuple):
    """What the tools say of a candidate: speeds in m/s, times in s, risks of MAIS3+ as shares.

    Of the other body: nan where nothing moves it, or where nobody is in it.
    """

    scene: str
    candidate: str
    other: str
    contact_s: float
    harm_persons: float
    dv_ego: float
    dv_other: float
    risk_ego: float
    risk_other: float
    crime_contact_s: float
    crime_dv_ego: float
    crime_dv_other: float
    tum_dv_ego: float
    tum_dv_other: float
    tum_risk_ego: float
    tum_risk_other: float
    tum_harm_persons: float


class Times(NamedTuple):
    """Time that each tool took for the candidates of a scene, s, and how many they are."""

    crashrank: float
    crime: float
    crime_contact: float
    tum: float
    candidates: int


def choosers_module() -> Any:
    """Return scripts/choosers, which has no ending, as a module."""
    loader = SourceFileLoader("choosers", str(ROOT / "scripts/choosers"))
    spec = spec_from_loader("choosers", loader)
    assert spec is not None
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def tum_risks(impact: Impact) -> tuple[float, float]:
    """Return TUM's P(MAIS3+) of a person in the ego and of one in the other body."""
    ego_v, other_v = delta_v_pair(impact)
    if impact.other.kind in FIXED:
        return logistic(LR1S, ego_v), math.nan
    if impact.other.kind in UNPROTECTED:
        return logistic(LR1S, ego_v), logistic(PERSON, other_v)
    curve = LR4S if impact.ego_side and impact.other_side else LR1S
    return (logistic(curve, ego_v, impact.ego_side), logistic(curve, other_v, impact.other_side))


def crime_answers(ranking: Ranking, index: int, impact: Impact
                  ) -> tuple[float, float, float, float, float]:
    """Return CriMe's time to collision, both delta-v, and the seconds of the first and the others.

    The scenario is built beforehand and does not count. Beside the configuration's masses all
    settings are CriMe's defaults.
    """
    ranked = ranking._ranked
    row = ranking[index]
    times = crime.steps_until(ranked.horizon_s)
    ego = crime.moving(crime.EGO_ID, "car", *crime.boxed(
        ranked.outline(-1), ranked.candidate_paths(times)[index]))
    others, place = [], 0
    for i, (body, path) in enumerate(zip(ranking.actors, ranked.actor_paths(times), strict=True)):
        shape, moved = crime.boxed(ranked.outline(i), path)
        others.append(crime.moving(crime.EGO_ID + 1 + i, body.kind, shape, moved))
        place = i if body.name == impact.other.name else place
    scenario = crime.scenario_of(ego, others)
    masses = [crime.FIXED_KG if math.isinf(body.mass_kg) else body.mass_kg
              for body in (impact.ego, impact.other)]
    own, other = crime.EGO_ID, crime.EGO_ID + 1 + place
    step = int((row.time_of_impact_s or 0.0) / crime.STEP_S + 1e-9)

    began = time.perf_counter()
    config = crime.configured(scenario, own, *masses)
    collision_s = float(TTCStar(config).compute(0, verbose=False))
    found = time.perf_counter()
    dv_ego = float(DeltaV(config).compute(step, other, verbose=False))
    dv_other = math.nan
    if impact.other.kind not in FIXED:
        config = crime.configured(scenario, other, *reversed(masses))
        dv_other = float(DeltaV(config).compute(step, own, verbose=False))
    return collision_s, dv_ego, dv_other, found - began, time.perf_counter() - found


def scene_rows(scene: dict[str, Any], choosers: Any, models: pathlib.Path
               ) -> tuple[list[Seen], Times]:
    """Return what all tools say of a scene's candidates, in its order, and their times."""
    began = time.perf_counter()
    ranking = rank_scene(scene, models)
    rank_s = time.perf_counter() - began
    seen = choosers.Scene(PROGRAM, data_folder() / "scenes.jsonl", (scene, ranking.to_dict()))
    places = {row.candidate: i for i, row in enumerate(ranking)}
    rows, contact_s, crime_s, tum_s = [], 0.0, 0.0, 0.0
    candidates: list[Candidate] = sorted(seen.candidates, key=lambda each: each.order)
    for candidate in candidates:
        impact = candidate.impacts[0]
        index = places[candidate.name]
        row = ranking[index]
        risks = {each.body: each.probability for each in row.people}
        collision_s, dv_ego, dv_other, searched, spent = crime_answers(
            ranking, index, impact)
        contact_s += searched
        crime_s += spent
        began = time.perf_counter()
        tum = tum_harm(impact)
        tum_s += time.perf_counter() - began
        tum_ego, tum_other = delta_v_pair(impact)
        fixed = impact.other.kind in FIXED
        nobody = impact.other.people == 0
        assert row.delta_v_mps is not None
        rows.append(Seen(
            scene["name"], candidate.name, impact.other.name, impact.time_s, candidate.harm,
            row.delta_v_mps.ego, math.nan if fixed else row.delta_v_mps.other,
            risks.get("ego", 0.0),
            math.nan if fixed or nobody else risks.get(impact.other.name, 0.0),
            collision_s, dv_ego, dv_other, tum_ego, math.nan if fixed else tum_other,
            *(tum_risks(impact) if not nobody else (tum_risks(impact)[0], math.nan)), tum))
    return rows, Times(rank_s, crime_s, contact_s, tum_s, len(rows))


def larger(a: float, b: float) -> float:
    """Return the larger of two numbers, one of which may be nan."""
    return a if math.isnan(b) else max(a, b)


# Title, cost of a candidate (the least is chosen), and the tool whose time it takes.
RULES = (
    ("crashrank, harm", lambda s: s.harm_persons, "crashrank"),
    ("crashrank, delta-v of the ego", lambda s: s.dv_ego, "crashrank"),
    ("crashrank, larger delta-v", lambda s: larger(s.dv_ego, s.dv_other), "crashrank"),
    ("CriMe, delta-v of the ego", lambda s: s.crime_dv_ego, "crime"),
    ("CriMe, larger delta-v", lambda s: larger(s.crime_dv_ego, s.crime_dv_other), "crime"),
    ("CriMe, time to collision", lambda s: -s.crime_contact_s, "crime_contact"),
    ("TUM, larger delta-v", lambda s: larger(s.tum_dv_ego, s.tum_dv_other), "tum"),
    ("TUM, harm", lambda s: s.tum_harm_persons, "tum"),
)


def correlation(a: Sequence[float], b: Sequence[float]) -> float:
    """Return Spearman's rank correlation; 0 where one side ranks nothing."""
    if len(set(a)) < 2 or len(set(b)) < 2:
        return 0.0
    return float(spearmanr(a, b).statistic)


def summary(scenes: Sequence[Sequence[Seen]], times: Sequence[Times]) -> list[dict[str, Any]]:
    """Return a row for each rule."""
    found = []
    for title, cost, tool in RULES:
        regrets, ranks = [], []
        for rows in scenes:
            costs = [cost(row) for row in rows]
            harms = [row.harm_persons for row in rows]
            regrets.append(harms[costs.index(min(costs))] - min(harms))
            ranks.append(correlation(costs, harms))
        per_candidate = sum(getattr(t, tool) for t in times) / sum(t.candidates for t in times)
        worst = int(np.argmax(regrets))
        found.append({
            "rule": title, "scenes": len(scenes),
            "same_choice": sum(regret <= 0 for regret in regrets),
            "mean_regret_persons": float(np.mean(regrets)), "worst_regret_persons": regrets[worst],
            "worst_scene": scenes[worst][0].scene, "mean_rank_correlation": float(np.mean(ranks)),
            "milliseconds_per_candidate": 1000 * per_candidate})
    return found


def agreement(rows: Sequence[Seen]) -> list[dict[str, Any]]:
    """Return how delta-v and P(MAIS3+) of each body agree with crashrank's over all candidates."""
    found = []
    for title, mine, theirs in (
            ("CriMe, delta-v of the ego, m/s", "dv_ego", "crime_dv_ego"),
            ("CriMe, delta-v of the other, m/s", "dv_other", "crime_dv_other"),
            ("TUM, delta-v of the ego, m/s", "dv_ego", "tum_dv_ego"),
            ("TUM, delta-v of the other, m/s", "dv_other", "tum_dv_other"),
            ("TUM, P(MAIS3+) in the ego", "risk_ego", "tum_risk_ego"),
            ("TUM, P(MAIS3+) in the other", "risk_other", "tum_risk_other"),
            ("CriMe, time of contact, s", "contact_s", "crime_contact_s")):
        pairs = np.array([(getattr(row, mine), getattr(row, theirs)) for row in rows])
        pairs = pairs[np.isfinite(pairs).all(axis=1)]
        found.append({
            "quantity": title, "candidates": len(pairs), "crashrank_median": np.median(pairs[:, 0]),
            "tool_median": np.median(pairs[:, 1]),
            "median_difference": np.median(np.abs(pairs[:, 1] - pairs[:, 0])),
            "rank_correlation": correlation(list(pairs[:, 0]), list(pairs[:, 1]))})
    return found


def shown(value: object) -> object:
    """Return a number with the benchmark's digits; empty for nan."""
    if isinstance(value, float):
        return "" if math.isnan(value) else written(float(value))
    return value


def save(path: pathlib.Path, head: Iterable[str], rows: Iterable[Iterable[object]]) -> None:
    """Write a table."""
    with path.open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(head)
        out.writerows([shown(value) for value in row] for row in rows)


def markdown(rows: Sequence[dict[str, Any]]) -> str:
    """Return rows as a table in Markdown, numbers with two digits."""
    lines = [f"| {' | '.join(rows[0])} |", "|" + "---|" * len(rows[0])]
    for row in rows:
        cells = (f"{x:.2g}" if isinstance(x, float) else str(x) for x in row.values())
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


def main() -> None:
    """Compare the tools, write the tables."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--scenes", type=int, default=1000, help="the first alone")
    options = parser.parse_args()
    choosers, models = choosers_module(), models_folder(None)
    certain = [scene for scene in load().scenes
               if not any("predictions" in actor for actor in scene["actors"])]
    scenes, times = [], []
    for scene in certain[: options.scenes]:
        rows, spent = scene_rows(scene, choosers, models)
        scenes.append(rows)
        times.append(spent)
        print(f"{len(scenes)}: {scene['name']}", file=sys.stderr)
    every = [row for rows in scenes for row in rows]
    rules, agreed = summary(scenes, times), agreement(every)
    save(options.folder / "comparison.csv", Seen._fields, every)
    save(options.folder / "comparison-tools.csv", rules[0], (row.values() for row in rules))
    save(options.folder / "comparison-quantities.csv", agreed[0],
         (row.values() for row in agreed))
    print(f"{len(every)} candidates in {len(scenes)} scenes\n\n{markdown(rules)}\n\n"
          f"{markdown(agreed)}\n")


if __name__ == "__main__":
    main()
