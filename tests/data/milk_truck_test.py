"""Ranks data/scenarios/testmodels/milk_truck.json with real files from Debian's assimp-testmodels
beside it, as its README says, and holds the answer against what the scene allows."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

CRASHRANK, SCENARIO, MODELS = sys.argv[1:4]
FILES = [
    "glTF/CesiumMilkTruck/CesiumMilkTruck.gltf",
    "glTF/CesiumMilkTruck/CesiumMilkTruck.bin",
    "glTF/BoxTextured-glTF-Embedded/BoxTextured.gltf",
    "Collada/duck.dae",
]


class MilkTruck(unittest.TestCase):
    def rank(self, *arguments):
        with tempfile.TemporaryDirectory() as folder:
            for file in [SCENARIO] + [os.path.join(MODELS, name) for name in FILES]:
                shutil.copy(file, folder)
            scenario = os.path.join(folder, os.path.basename(SCENARIO))
            run = subprocess.run([CRASHRANK, "rank", scenario, "--json", *arguments],
                                 capture_output=True, text=True, timeout=60, check=False)
            self.assertEqual(run.returncode, 0, run.stderr)
            return json.loads(run.stdout)["ranking"]

    def test_each_manoeuvre_hits_what_it_is_named_after(self):
        first = {row["candidate"]: row["contacts"][0]["other"] for row in self.rank()}
        self.assertEqual(first["right into the crate"], "crate")
        self.assertEqual(first["left into the duck"], "duck")
        self.assertEqual(first["brake straight ahead"], "oncoming milk truck")
        self.assertEqual(first["keep going"], "oncoming milk truck")

    def test_measures_disagree_but_braking_beats_going_on(self):
        orders = {}
        for measure in ("polygons", "area", "closing-energy", "energy", "delta-v"):
            orders[measure] = [row["candidate"] for row in self.rank("--measure", measure)]
            self.assertLess(orders[measure].index("brake straight ahead"),
                            orders[measure].index("keep going"), measure)
        self.assertGreater(len({tuple(order) for order in orders.values()}), 1)


if __name__ == "__main__":
    if not os.path.exists(os.path.join(MODELS, FILES[0])):
        print("assimp-testmodels is not installed: its models are what this test ranks")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1])
