"""Ranks a shipped scenario whose actors have predictions: the best choice against the likeliest
future is the worst by expectation, text and report say so, and the scores are the weighted sums of
those of the single futures, which are written as scenarios of their own here."""

import copy
import json
import os
import subprocess
import sys
import tempfile
import unittest

CRASHRANK, SCENARIO = sys.argv[1:3]
PLAIN = {"env": {**os.environ, "NO_COLOR": "1"}}


def run(*arguments):
    return subprocess.run([CRASHRANK, *arguments], capture_output=True, text=True, timeout=300,
                          check=False, **PLAIN)


def ranking(path, *options):
    answer = run("rank", path, "--json", *options)
    assert answer.returncode == 0, answer.stderr
    return json.loads(answer.stdout)


def scores(answer):
    return {row["candidate"]: row["score"] for row in answer["ranking"]}


class Futures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with open(SCENARIO, encoding="utf-8") as file:
            cls.scenario = json.load(file)
        cls.answer = ranking(SCENARIO)

    def singles(self):
        """Probability and scores of each prediction of the one uncertain actor."""
        uncertain = [a for a in self.scenario["actors"] if "predictions" in a]
        self.assertEqual(len(uncertain), 1)
        for prediction in uncertain[0]["predictions"]:
            single = copy.deepcopy(self.scenario)
            actor = next(a for a in single["actors"] if a["name"] == uncertain[0]["name"])
            del actor["predictions"]
            actor.update({k: v for k, v in prediction.items() if k != "probability"})
            folder = os.path.dirname(SCENARIO)
            with tempfile.NamedTemporaryFile("w", suffix=".json", dir=folder,
                                             encoding="utf-8") as file:
                json.dump(single, file)
                file.flush()
                yield prediction["probability"], scores(ranking(file.name))

    def test_expectation_is_the_weighted_sum_of_the_single_futures(self):
        expected = dict.fromkeys(scores(self.answer), 0.0)
        worst = dict.fromkeys(expected, 0.0)
        for probability, single in self.singles():
            for name, score in single.items():
                expected[name] += probability * score
                worst[name] = max(worst[name], score)
        for name, score in scores(self.answer).items():
            self.assertAlmostEqual(score, expected[name], delta=1e-12, msg=name)
        for name, score in scores(ranking(SCENARIO, "--risk", "worst")).items():
            self.assertEqual(score, worst[name], name)

    def test_best_against_the_likeliest_future_is_worst_by_expectation(self):
        def likeliest(row):
            return next(f["score"] for f in row["futures"] if f["likeliest"])

        rows = self.answer["ranking"]
        best = min(rows, key=likeliest)
        self.assertEqual(best["candidate"], rows[-1]["candidate"])
        self.assertLess(best["collision_probability"], 0.5)
        text = run("rank", SCENARIO).stdout
        said = (f"Against the likeliest future alone “{best['candidate']}” would be first")
        self.assertIn(said, text)
        self.assertIn("in the last place", text)
        with tempfile.TemporaryDirectory() as folder:
            report = os.path.join(folder, "report.html")
            self.assertEqual(run("rank", SCENARIO, "--report", report).returncode, 0)
            with open(report, encoding="utf-8") as file:
                self.assertIn(said, file.read())

    def test_a_deadline_answers_with_sound_intervals(self):
        known = scores(self.answer)
        for budget in ("1", "100000", "1000000"):
            answer = run("rank", SCENARIO, "--json", "--work-budget", budget)
            self.assertIn(answer.returncode, (0, 4), answer.stderr)
            for row in json.loads(answer.stdout)["ranking"]:
                low, high = row["score_interval"]
                self.assertLessEqual(low, known[row["candidate"]])
                self.assertGreaterEqual(high, known[row["candidate"]])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
