"""Ranks a shipped scenario and holds the answer against what its README says: every candidate ends
in a crash, the measures disagree about the order, and each order follows from its own scores. The
other measures' scores are computed here from the first answer's contacts."""

import json
import subprocess
import sys
import unittest

CRASHRANK, SCENARIO = sys.argv[1:3]
CANDIDATES, ACTORS = int(sys.argv[3]), int(sys.argv[4])


def order(ranking, score):
    return [row["candidate"] for row in sorted(ranking, key=score)]


class Scenario(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        run = subprocess.run([CRASHRANK, "rank", SCENARIO, "--json", "--measure", "polygons"],
                             capture_output=True, text=True, timeout=500, check=False)
        assert run.returncode == 0, run.stderr
        cls.answer = json.loads(run.stdout)
        cls.ranking = cls.answer["ranking"]
        with open(SCENARIO, encoding="utf-8") as file:
            cls.scenario = json.load(file)

    def masses(self):
        models = self.scenario["models"]
        of = {actor["name"]: models[actor["model"]].get("mass_kg")
              for actor in self.scenario["actors"]}
        return {**of, "ego": models[self.scenario["ego"]["model"]]["mass_kg"]}

    def energy(self, row):
        """Closing energy of the first contact of every pair of bodies."""
        mass = self.masses()
        met = set()
        total = 0.0
        for contact in row["contacts"]:
            a, b = (mass[name] for name in contact["bodies"])
            pair = tuple(sorted(contact["bodies"]))
            if pair in met:
                continue
            met.add(pair)
            reduced = (a or b) if a is None or b is None else a * b / (a + b)
            total += 0.5 * reduced * contact["closing_speed_mps"] ** 2
        return total

    def test_size_is_as_described(self):
        self.assertEqual(len(self.ranking), CANDIDATES)
        self.assertEqual(len(self.scenario["actors"]), ACTORS)
        self.assertTrue(self.answer["complete"])

    def test_every_candidate_crashes(self):
        for row in self.ranking:
            self.assertTrue(row["collides"], row["candidate"])
            self.assertGreater(row["score"], 0.0)
            self.assertTrue(row["damaged_parts"]["ego"], row["candidate"])

    def test_scores_are_the_damaged_triangles_and_rise(self):
        scores = [row["score"] for row in self.ranking]
        self.assertEqual(scores, sorted(scores))
        for row in self.ranking:
            if len(row["contacts"]) == 1:
                damaged = row["damaged_triangles"]
                self.assertEqual(row["score"], damaged["ego"] + damaged["other"])

    def test_two_measures_disagree(self):
        by_polygons = order(self.ranking, lambda row: row["score"])
        by_energy = order(self.ranking, self.energy)
        self.assertNotEqual(by_polygons, by_energy)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
