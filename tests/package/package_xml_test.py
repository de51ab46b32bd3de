"""package.xml is what REP 149 asks of format 3, and tells the version of the headers."""

import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(sys.argv[1])
DEPENDS = {"buildtool_depend", "build_depend", "build_export_depend", "exec_depend", "depend",
           "test_depend", "doc_depend"}


class PackageXml(unittest.TestCase):
    def setUp(self):
        self.package = xml.parse(ROOT / "package.xml").getroot()

    def text(self, path):
        return self.package.findtext(path, "").strip()

    def test_required_elements_stand_there_in_order(self):
        self.assertEqual((self.package.tag, self.package.get("format")), ("package", "3"))
        self.assertRegex(self.text("name"), r"^[a-z][a-z0-9_]*$")
        self.assertTrue(self.text("description"))
        self.assertRegex(self.package.find("maintainer").get("email"), r"^[^@\s]+@[^@\s]+\.[a-z]+$")
        self.assertTrue((ROOT / self.package.find("license").get("file")).is_file())
        known = {"name", "version", "description", "maintainer", "license", "export"} | DEPENDS
        self.assertEqual([e.tag for e in self.package if e.tag not in known], [])
        tags = [e.tag for e in self.package]
        self.assertEqual(tags[:5], ["name", "version", "description", "maintainer", "license"])
        self.assertEqual(tags[-1], "export")

    def test_it_is_built_with_cmake(self):
        self.assertEqual(self.text("export/build_type"), "cmake")
        self.assertIn("cmake", [e.text for e in self.package.iter("buildtool_depend")])

    def test_its_version_is_the_headers(self):
        header = (ROOT / "include/crashrank/base/version.hpp").read_text(encoding="utf-8")
        version = re.search(r'CRASHRANK_VERSION_STRING "([^"]+)"', header).group(1)
        self.assertEqual(self.text("version"), version)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
