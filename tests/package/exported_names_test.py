"""What the shared library exports is what public headers mark with CRASHRANK_API, and nothing else:
no template instance of another library, no internal helper. And the C interface is there whole."""

import pathlib
import re
import subprocess
import sys
import unittest

NM, LIBRARY, INCLUDE = sys.argv[1:4]
OURS = re.compile(r"^(?:typeinfo (?:name )?for |vtable for )?crashrank::")


def exported():
    lines = subprocess.run([NM, "-DC", "--defined-only", LIBRARY], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    return [line.split(" ", 2)[2] for line in lines]


def headers():
    return "\n".join(path.read_text(encoding="utf-8")
                     for path in sorted(pathlib.Path(INCLUDE).rglob("*.h*")))


def words(name):
    """Names of a demangled function or class: what stands before its arguments."""
    plain = re.sub(r"\[abi:[a-z0-9]+\]", "", name.split("(")[0])
    return re.findall(r"~?[A-Za-z_]\w*", OURS.sub("", plain))


class ExportedNames(unittest.TestCase):
    def test_the_list_is_not_empty(self):
        self.assertGreater(len(exported()), 100)

    def test_only_the_projects_names_are_exported(self):
        foreign = [name for name in exported()
                   if not OURS.match(name) and not name.startswith("crashrank_")]
        self.assertEqual(foreign, [])

    def test_nothing_internal_is_exported(self):
        self.assertEqual([name for name in exported() if re.match(r"crashrank::(?:c|detail)::", name)],
                         [])

    def test_every_name_stands_in_a_public_header(self):
        known = set(re.findall(r"[A-Za-z_]\w*", headers()))
        strangers = [name for name in exported() if OURS.match(name) and
                     words(name) and words(name)[0].lstrip("~") not in known]
        self.assertEqual(strangers, [])

    def test_the_c_interface_is_whole(self):
        text = (pathlib.Path(INCLUDE) / "crashrank/crashrank.h").read_text(encoding="utf-8")
        library, importer = text.split("// ---- Mesh files", 1)
        declared = set(re.findall(r"CRASHRANK_API [^;()]*?(crashrank_\w+)\(", library))
        self.assertGreater(len(declared), 20)
        self.assertEqual(declared, {name for name in exported() if name.startswith("crashrank_")})
        self.assertIn("crashrank_models_import(", importer)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
