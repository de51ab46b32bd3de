"""The published schema against the scenarios that the C++ tests give to the parser: it is a valid
schema, accepts what the parser accepts, and refuses what it refuses as far as a schema can say it
(names that refer to other names, and times that rise, are beyond it)."""

import copy
import json
import os
import sys
import unittest

import jsonschema

SCHEMA, SAMPLE, VARIANTS = sys.argv[1:4]
SHIPPED = sys.argv[4:]


def patched(document, operations):
    document = copy.deepcopy(document)
    for operation in operations:
        *steps, last = operation["path"].split("/")[1:]
        target = document
        for step in steps:
            target = target[int(step) if isinstance(target, list) else step]
        key = int(last) if isinstance(target, list) else last
        if operation["op"] == "remove":
            del target[key]
        else:
            target[key] = operation["value"]
    return document


def load(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


class Schema(unittest.TestCase):
    def setUp(self):
        self.schema = load(SCHEMA)
        self.validator = jsonschema.Draft202012Validator(self.schema)

    def test_is_a_schema(self):
        jsonschema.Draft202012Validator.check_schema(self.schema)

    def test_agrees_with_the_parser(self):
        sample = load(SAMPLE)
        variants = load(VARIANTS)
        self.assertGreater(len(variants), 50)
        for variant in variants:
            expected = "place" not in variant or not variant.get("schema", True)
            with self.subTest(variant["why"]):
                document = patched(sample, variant["patch"])
                self.assertEqual(self.validator.is_valid(document), expected)

    def test_profiles_say_what_scenarios_say(self):
        folder = os.path.dirname(SCHEMA)
        profile = load(os.path.join(folder, "profile.schema.json"))
        jsonschema.Draft202012Validator.check_schema(profile)
        for name, member in self.schema["$defs"]["harm"]["properties"].items():
            self.assertEqual(profile["properties"][name], member)
        for name in os.listdir(os.path.join(folder, "profiles")):
            if name.endswith(".json"):
                shipped = load(os.path.join(folder, "profiles", name))
                self.assertEqual(
                    list(jsonschema.Draft202012Validator(profile).iter_errors(shipped)), [])

    def test_accepts_what_is_shipped(self):
        for path in SHIPPED:
            with self.subTest(path):
                self.assertEqual(list(self.validator.iter_errors(load(path))), [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
