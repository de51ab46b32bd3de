"""Real answers of the program against the published schemas, which refuse keys that they do not
describe."""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

import jsonschema

PROGRAM, DATA = sys.argv[1], pathlib.Path(sys.argv[2])
SCHEMAS = DATA / "schemas"

BOX = """o box
v -1 -0.9 0
v 4 -0.9 0
v -1 0.9 0
v 4 0.9 0
v -1 -0.9 1.5
v 4 -0.9 1.5
v -1 0.9 1.5
v 4 0.9 1.5
f 1 3 2
f 2 3 4
f 5 6 7
f 6 8 7
f 1 2 5
f 2 6 5
f 3 7 4
f 4 7 8
f 1 5 3
f 3 5 7
f 2 4 6
f 4 8 6
"""

SCENARIO = {
    "scenario_version": 1,
    "models": {"car": {"mesh": "box.obj", "kind": "car"},
               "post": {"mesh": "box.obj", "kind": "pole", "scale": 0.2},
               "child": {"mesh": "box.obj", "kind": "pedestrian", "scale": 0.3}},
    "ego": {"model": "car", "speed_mps": 12},
    "actors": [
        {"name": "saloon", "model": "car", "pose": {"x_m": 14}},
        {"name": "ahead", "model": "car", "pose": {"x_m": 19.2}},
        {"name": "post", "model": "post", "pose": {"x_m": 12, "y_m": 3.5}},
        {"name": "child", "model": "child", "pose": {"x_m": 12, "y_m": -3}}],
    "candidates": {"listed": [
        {"name": "straight", "acceleration_mps2": 0, "steering_deg": 0},
        {"name": "left", "acceleration_mps2": 0, "steering_deg": 8},
        {"name": "stop", "acceleration_mps2": -11, "steering_deg": 0}], "grid": False},
}

POSES = "1 0 0 0.5 0 1 0 0.1 0 0 1 0.2 0 0 0 1\n1 0 0 90 0 1 0 0 0 0 1 0 0 0 0 1\n"

ROWS = """id,length_m,width_m,height_m,wheelbase_m,mass_kg,izz_kgm2,barrier,radius_m,overlap,speed_mps
one,4.5,1.8,1.45,2.7,1500,,wall,0.15,0.25,15
"""


def schema_of(command):
    with open(SCHEMAS / f"{command}.schema.json", encoding="utf-8") as file:
        return json.load(file)


class Answers(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        place = pathlib.Path(cls.folder.name)
        (place / "box.obj").write_text(BOX, encoding="utf-8")
        (place / "scenario.json").write_text(json.dumps(SCENARIO), encoding="utf-8")
        (place / "poses.txt").write_text(POSES, encoding="utf-8")
        (place / "rows.csv").write_text(ROWS, encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def answer(self, *arguments, codes=(0,)):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder.name, check=False,
                              capture_output=True, text=True)
        self.assertIn(done.returncode, codes, done.stderr)
        return json.loads(done.stdout)

    def check(self, *arguments, codes=(0,)):
        document = self.answer(*arguments, "--json", codes=codes)
        validator = jsonschema.Draft202012Validator(schema_of(arguments[0]))
        problems = [f"{'/'.join(map(str, e.absolute_path))}: {e.message}"
                    for e in validator.iter_errors(document)]
        self.assertEqual(problems, [])
        return document

    def test_schemas_are_schemas(self):
        paths = sorted(SCHEMAS.glob("*.schema.json"))
        self.assertGreaterEqual(len(paths), 5)
        for path in paths:
            jsonschema.Draft202012Validator.check_schema(schema_of(path.name.split(".")[0]))

    def test_every_answering_command_has_a_schema(self):
        text = subprocess.run([PROGRAM, "--help"], check=True, capture_output=True,
                              text=True).stdout
        listed = text.split("Subcommands:\n", 1)[1].split("\n\n", 1)[0]
        for line in listed.splitlines():
            command = line.split()[0]
            usage = subprocess.run([PROGRAM, command, "--help"], check=True, capture_output=True,
                                   text=True).stdout
            if "--json" in usage:
                self.assertTrue((SCHEMAS / f"{command}.schema.json").is_file(), command)

    def test_a_schema_refuses_what_it_does_not_know(self):
        document = self.answer("inspect", "box.obj", "--json")
        document["files"][0]["colour"] = "red"
        self.assertFalse(jsonschema.Draft202012Validator(schema_of("inspect")).is_valid(document))

    def test_inspect(self):
        self.check("inspect", "box.obj", "box.obj")
        self.check("inspect", "missing.obj", "box.obj", codes=(3,))

    def test_compile(self):
        self.check("compile", "box.obj", "-o", "box.crm", "--mass-kg", "1400",
                   "--center-of-mass-m", "1.5,0", "--yaw-inertia-kgm2", "2500")
        again = self.check("compile", "box.crm", "-o", "again.crm", "--mass-kg", "1500")
        self.assertEqual(again["kept"],
                         {"center_of_mass_m": [1.5, 0, 0.75], "yaw_inertia_kgm2": 2500})
        document = self.check("inspect", "box.crm", "box.obj")
        self.assertIn("model", document["files"][0])
        self.check("collide", "box.crm", "box.obj")

    def test_collide(self):
        self.check("collide", "box.obj", "box.obj", "--poses", "poses.txt")
        self.check("collide", "box.obj", "box.obj", "--any", "--split", "paper")
        self.check("collide", "box.obj", "box.obj", "--workers", "2", "--frame", "gaussian")

    def test_sweep(self):
        self.check("sweep", "box.obj", "box.obj", "--poses", "poses.txt", "--depths", "1:2",
                   "--workers", "2", "--policies", "all")
        self.check("sweep", "box.obj", "box.obj", "--poses", "poses.txt", "--depths", "2",
                   "--workers", "2", "--memory", "1")

    def test_rank(self):
        for measure in ("polygons", "closing-energy", "delta-v", "harm"):
            document = self.check("rank", "scenario.json", "--measure", measure)
            contacts = [c for entry in document["ranking"] for c in entry["contacts"]]
            self.assertTrue(any("other" in c for c in contacts))
            self.assertTrue(any("other" not in c for c in contacts))
            for entry in document["ranking"]:
                times = [c["time_of_impact_s"] for c in entry["contacts"]]
                self.assertEqual(times, sorted(times))
                for c in entry["contacts"]:
                    self.assertEqual("ego" in c["bodies"], "other" in c)

    def test_check(self):
        self.assertEqual(self.check("check", "scenario.json")["errors"], [])
        wrong = {**SCENARIO, "grip": 9, "horizon": 3}
        (pathlib.Path(self.folder.name) / "wrong.json").write_text(json.dumps(wrong),
                                                                   encoding="utf-8")
        self.assertEqual(len(self.check("check", "wrong.json", codes=(3,))["errors"]), 2)

    def test_validate(self):
        car = str(DATA / "models" / "sedan.obj")
        self.check("validate", "rows.csv", "--boxes", "--car", car)
        self.check("validate", str(DATA / "validation" / "car_to_car.csv"), "--car", car)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
