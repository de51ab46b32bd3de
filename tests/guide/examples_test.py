"""The example programs run, and say what they have to."""

import json
import pathlib
import subprocess
import sys
import unittest

PROGRAM, BIN, ROOT = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
SCENARIO = str(ROOT / "data/scenarios/crossing_traffic.json")


def run(*command, code=0):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True,
                          text=True)
    assert done.returncode == code, done.stderr
    return done.stdout


class Examples(unittest.TestCase):
    def ranking(self, *options, code=0):
        return json.loads(run(PROGRAM, "rank", SCENARIO, "--json", *options, code=code))["ranking"]

    def test_first_choice(self):
        first = self.ranking()[0]["candidate"] + "\n"
        self.assertEqual(run(BIN / "example_first_choice", SCENARIO), first)
        self.assertEqual(run(BIN / "example_first_choice_c", SCENARIO), first)

    def test_frames(self):
        expected = (ROOT / "apps/examples/frames.expected").read_text(encoding="utf-8")
        self.assertEqual(run(BIN / "example_frames"), expected)

    def test_ten_hertz(self):
        names = {entry["candidate"] for entry in self.ranking("--work-budget", "0", code=4)}
        lines = run(BIN / "example_ten_hertz", SCENARIO).splitlines()
        self.assertEqual(len(lines), 5)
        for line in lines:
            self.assertIn(line.split(": ")[1].split(", harm")[0], names)

    def test_own_harm(self):
        rows = [line.rsplit(maxsplit=4) for line in run(BIN / "example_own_harm",
                                                        SCENARIO).splitlines()]
        # The same sum over the documents of the command.
        outside = {"motorcycle"}
        mine = {}
        for entry in self.ranking("--measure", "harm"):
            harm = 0.0
            for contact in entry["contacts"]:
                if "other" not in contact:
                    continue
                harm += contact["severity"]["ego"]["delta_v_mps"] / 20
                if contact["other"] in outside:
                    harm += 5 * (contact["closing_speed_mps"] / 10) ** 2
                elif contact["other"] != "lamp pole":
                    harm += contact["severity"]["other"]["delta_v_mps"] / 20
            mine[entry["candidate"]] = harm
        self.assertEqual({row[0] for row in rows}, set(mine))
        told = [float(row[2]) for row in rows]
        self.assertEqual(told, sorted(told))
        for row in rows:
            self.assertAlmostEqual(float(row[2]), mine[row[0]], delta=6e-4)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
