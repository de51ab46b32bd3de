"""Ranks a shipped scenario in which nothing has to be hit: the order follows from what is told of
each manoeuvre, and a plan that no car can follow stands where --infeasible says."""

import json
import subprocess
import sys
import unittest

CRASHRANK, SCENARIO = sys.argv[1:3]


def ranking(*options):
    run = subprocess.run([CRASHRANK, "rank", SCENARIO, "--json", *options], capture_output=True,
                         text=True, timeout=100, check=False)
    assert run.returncode == 0, run.stderr
    return json.loads(run.stdout)


def names(answer):
    return [row["candidate"] for row in answer["ranking"]]


class Manoeuvres(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.answer = ranking()
        cls.rows = {row["candidate"]: row for row in cls.answer["ranking"]}

    def test_order(self):
        self.assertEqual(names(self.answer), ["brake in lane", "pass on the left",
                                              "pass over the grass", "stop at once"])
        self.assertEqual([row["rank"] for row in self.answer["ranking"]], [1, 2, 3, 4])
        for row in self.answer["ranking"]:
            self.assertEqual(row["score"], 0)
            self.assertFalse(row["collides"])

    def test_braking_stops_where_its_deceleration_says(self):
        at_horizon = self.rows["brake in lane"]["at_horizon"]
        self.assertEqual(at_horizon["speed_mps"], 0)
        self.assertAlmostEqual(at_horizon["position_m"][0], 20**2 / (2 * 7), places=9)
        self.assertAlmostEqual(self.rows["pass on the left"]["at_horizon"]["speed_mps"], 20,
                               delta=0.1)

    def test_only_the_grass_is_beside_the_road(self):
        for name, row in self.rows.items():
            self.assertEqual(row["leaves_road"] is not None, name == "pass over the grass", name)
        leaving = self.rows["pass over the grass"]["leaves_road"]
        self.assertAlmostEqual(leaving["point_m"][1], -2.65, places=6)
        self.assertAlmostEqual(leaving["speed_mps"], 20, delta=0.1)

    def test_what_no_car_can_follow(self):
        for name, row in self.rows.items():
            self.assertEqual(row["feasible"], name != "stop at once", name)
            self.assertEqual(row["grip_demand"], row["demand"]["grip"])
        self.assertGreater(self.rows["stop at once"]["grip_demand"], 2)
        self.assertTrue(any("stop at once" in text for text in self.answer["warnings"]))
        kept = ranking("--infeasible", "keep")
        # Both stand more than 5 m from everybody at the horizon: nothing tells them apart.
        self.assertEqual(names(kept)[:2], ["brake in lane", "stop at once"])
        self.assertEqual([row["rank"] for row in kept["ranking"]], [1, 1, 3, 4])
        dropped = ranking("--infeasible", "drop")
        self.assertEqual(names(dropped), names(self.answer)[:3])
        self.assertEqual(dropped["dropped"], ["stop at once"])

    def test_a_deadline_that_is_met_gives_the_same_order(self):
        self.assertEqual(names(ranking("--deadline-ms", "60000")), names(self.answer))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
