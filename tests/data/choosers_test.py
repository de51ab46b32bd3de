"""Holds the rules of scripts/choosers against closed forms, and its answers for shipped scenes
against what the rules promise: no choice has less harm than crashrank's, and the poses that the
rules read meet the point of the first contact."""

import importlib.util
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from typing import Any

PROGRAM, ROOT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
FOLDER = ROOT / "data/scenarios/choosers"
SCRIPT = ROOT / "scripts/choosers"
RANKED = ("child_run_out", "lorry_rear", "roundabout_entry")

sys.dont_write_bytecode = True
sys.path.insert(0, str(SCRIPT.parent))
LOADER = SourceFileLoader("choosers", str(SCRIPT))
SPEC = importlib.util.spec_from_file_location("choosers", SCRIPT, loader=LOADER)
assert SPEC is not None
choosers: Any = importlib.util.module_from_spec(SPEC)
LOADER.exec_module(choosers)
rules: Any = sys.modules["chooser_rules"]

EGO = rules.Body("ego", "car", 1200.0, 1.0)
POLE = rules.Body("pole", "pole", math.inf, 0.0)
PERSON = rules.Body("person", "pedestrian", 75.0, 1.0)
SALOON = rules.Body("saloon", "car", 1800.0, 2.0)
EMPTY = rules.Body("empty", "car", 400.0, 0.0)


def impact(other: Any, closing: float, time: float = 1.0, probability: float = 1.0,
           sides: tuple[str | None, str | None] = (None, None),
           normal: float | None = None) -> Any:
    return rules.Impact(probability, time, closing, EGO, other, *sides, normal)


def candidate(name: str, place: int, *impacts: Any) -> Any:
    return rules.Candidate(name, (0, place, ""), 0.0, 1, impacts, {})


def rule(title: str) -> Any:
    return next(r for r in rules.RULES if r.title == title)


def names(found: list[Any]) -> list[str]:
    return [c.name for c in found]


class Rules(unittest.TestCase):
    def test_mass_ratio_delta_v_conserves_momentum(self) -> None:
        ego, other = rules.delta_v_pair(impact(SALOON, 10.0))
        self.assertAlmostEqual(ego, 6.0)
        self.assertAlmostEqual(other, 4.0)
        self.assertEqual(rules.delta_v_pair(impact(POLE, 10.0)), (10.0, 0.0))

    def test_worse_side_counts_bodies_with_people_only(self) -> None:
        self.assertAlmostEqual(rules.worse_delta_v(impact(PERSON, 10.0)), 12000 / 1275)
        self.assertAlmostEqual(rules.worse_delta_v(impact(EMPTY, 10.0)), 2.5)

    def test_rules_of_masses(self) -> None:
        # 1200 and 1800 kg: a reduced mass of 720 kg; a pole: the whole 1200 kg.
        self.assertAlmostEqual(rules.closing_energy(impact(SALOON, 10.0)), 36000.0)
        self.assertAlmostEqual(rules.closing_energy(impact(POLE, 10.0)), 60000.0)
        light = candidate("light", 1, impact(PERSON, 9.0))
        heavy = candidate("heavy", 0, impact(SALOON, 1.0))
        fixed = candidate("fixed", 2, impact(POLE, 1.0, probability=0.5))
        partner = next(r for r in rules.BENCHMARK_RULES if r.title == "lightest partner")
        self.assertEqual(names(rules.choose(partner, [fixed, heavy, light])), ["light"])
        self.assertEqual(names(rules.choose(partner, [fixed])), ["fixed"])

    def test_tum_curves_at_known_points(self) -> None:
        self.assertAlmostEqual(rules.logistic(rules.LR1S, 0.0), 0.0100408690, places=9)
        self.assertAlmostEqual(rules.logistic(rules.LR1S, 4.591 / 0.185), 0.5)
        self.assertAlmostEqual(rules.logistic(rules.PERSON, 3.164 / 0.288), 0.5)
        self.assertAlmostEqual(rules.logistic(rules.LR4S, 8.0, "side"), 0.0574865057, places=9)
        self.assertAlmostEqual(rules.logistic(rules.LR4S, 8.0, "rear"), 0.0301195019, places=9)

    def test_tum_harm_adds_both_sides(self) -> None:
        self.assertAlmostEqual(rules.tum_harm(impact(PERSON, 10.0)),
                               0.0111823149 + 0.3885498953, places=9)
        # A pole stops the ego: its delta-v is the closing speed, and nobody else is hurt.
        self.assertAlmostEqual(rules.tum_harm(impact(POLE, 4.591 / 0.185)), 0.5)
        # 20 m/s: 12 m/s for the ego, 8 m/s for the saloon with two people.
        ego = rules.logistic(rules.LR4S, 12.0, "front")
        self.assertAlmostEqual(rules.tum_harm(impact(SALOON, 20.0, sides=("front", "side"))),
                               ego + 2 * 0.0574865057, places=9)

    def test_each_rule_takes_its_own_least(self) -> None:
        slow = candidate("slow", 0, impact(PERSON, 6.0, time=0.5, normal=6.0))
        fast = candidate("fast", 1, impact(POLE, 9.0, time=0.9, normal=1.0))
        for title, first in (("delta-v of the ego", "slow"), ("delta-v, worse side", "slow"),
                             ("closing speed", "slow"), ("normal speed", "fast"),
                             ("time to collision", "fast"), ("TUM harm", "fast")):
            with self.subTest(title):
                self.assertEqual(names(rules.choose(rule(title), [slow, fast])), [first])

    def test_no_contact_is_best_and_ties_keep_the_order(self) -> None:
        hit = candidate("hit", 0, impact(POLE, 0.5, time=9.0))
        free = [candidate("b", 2), candidate("a", 1)]
        for each in rules.RULES:
            self.assertEqual(names(rules.choose(each, [hit, *free])), ["a", "b"], each.title)

    def test_futures_are_weighted_by_probability(self) -> None:
        maybe = candidate("maybe", 0, impact(POLE, 20.0, probability=0.25))
        self.assertAlmostEqual(rules.expected(rule("closing speed"), maybe), 5.0)
        self.assertAlmostEqual(rules.expected(rule("time to collision"), maybe), 0.25)

    def test_sides_are_quadrants(self) -> None:
        for degrees, side in ((0, "front"), (44, "front"), (-46, "side"), (134, "side"),
                              (136, "rear"), (180, "rear"), (-226, "side"), (320, "front")):
            self.assertEqual(rules.side_of(math.radians(degrees)), side, degrees)

    def test_poses_follow_closed_forms(self) -> None:
        braking = {"pose": {"x_m": 1.0}, "speed_mps": 10.0, "acceleration_mps2": -5.0}
        for t, x in ((1.0, 8.5), (2.0, 11.0), (5.0, 11.0)):
            self.assertAlmostEqual(rules.pose_at(braking, t, 0.0)[0], x, places=6)
        # A quarter of a circle of 10 m to the left, by curvature and by yaw rate.
        quarter = math.pi / 2
        for motion, curvature in (({"speed_mps": 10.0}, 0.1),
                                  ({"speed_mps": 10.0, "yaw_rate_dps": math.degrees(1.0)}, None)):
            pose = rules.pose_at(motion, quarter, curvature)
            for value, expected in zip(pose, (10.0, 10.0, quarter), strict=True):
                self.assertAlmostEqual(value, expected, places=4)
        # Braking to standstill within 10 m of that circle.
        curved = {"speed_mps": 10.0, "acceleration_mps2": -5.0}
        pose = rules.pose_at(curved, 3.0, 0.1)
        for value, expected in zip(pose, (10 * math.sin(1), 10 - 10 * math.cos(1), 1.0),
                                   strict=True):
            self.assertAlmostEqual(value, expected, places=4)
        timed = {"poses": [{"t_s": 0}, {"t_s": 2, "x_m": 4, "yaw_deg": 90}]}
        self.assertEqual(rules.pose_at(timed, 0.5), (1.0, 0.0, math.radians(22.5)))
        self.assertEqual(rules.pose_at(timed, 3.0), (4.0, 0.0, math.radians(90.0)))


class Scenes(unittest.TestCase):
    def test_all_scenes_rank_without_a_warning(self) -> None:
        paths = sorted(FOLDER.glob("*.json"))
        self.assertEqual(len(paths), 10)
        for path in paths:
            with self.subTest(path.name):
                answer = choosers.call(PROGRAM, "rank", str(path), "--first-place")
                self.assertEqual(answer["warnings"], [])
                self.assertTrue(answer["proved"])
                for row in answer["ranking"]:
                    self.assertIsNot(row["collides"], False, row["candidate"])

    def test_regret_is_never_negative(self) -> None:
        for name in RANKED:
            scene = choosers.Scene(PROGRAM, FOLDER / f"{name}.json")
            for each in rules.RULES:
                choice = rules.choose(each, scene.candidates)[0]
                self.assertGreaterEqual(choice.harm, scene.first.harm, (name, each.title))

    def test_poses_meet_the_point_of_first_contact(self) -> None:
        """Both bodies' middles lie within half a diagonal of it: 2.8 m for the largest car."""
        for name in RANKED:
            scene = choosers.Scene(PROGRAM, FOLDER / f"{name}.json")
            for each in scene.candidates:
                first = each.row["contacts"][0]
                stated = scene.listed[each.name][1]
                motion = {**scene.scenario["ego"], **stated}
                pose = rules.pose_at(motion, first["time_of_impact_s"],
                                     each.row["curvature_per_m"])
                x, y, _ = scene.middle(pose, scene.scenario["ego"]["model"])
                away = math.hypot(first["point_m"][0] - x, first["point_m"][1] - y)
                self.assertLess(away, 2.8, (name, each.name))
                self.assertGreater(away, 0.8, (name, each.name))

    def test_the_table_has_a_row_for_each_scene(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "table.md"
            files = [str(FOLDER / f"{name}.json") for name in RANKED]
            done = subprocess.run([sys.executable, "-B", SCRIPT, "--crashrank", PROGRAM, "-o",
                                   output, *files], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertEqual(len(done.stderr.splitlines()), len(files))
            text = output.read_text(encoding="utf-8")
        for name in files:
            with open(name, encoding="utf-8") as file:
                self.assertIn(f"| {json.load(file)['name']} (", text)

    def test_errors_name_file_and_remedy(self) -> None:
        for program, file, remedy in (("/nonexistent/crashrank", FOLDER / "lorry_rear.json",
                                       "--crashrank"), (PROGRAM, "missing.json", "name a")):
            done = subprocess.run([sys.executable, "-B", SCRIPT, "--crashrank", program, file],
                                  capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 3)
            self.assertIn(remedy, done.stderr.splitlines()[-1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
