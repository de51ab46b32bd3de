"""Every code block of the guide and the README is part of a file that is compiled or read by a test,
named in a comment before the block; every command line runs; every link to a file leads somewhere."""

import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import textwrap
import unittest

PROGRAM, ROOT = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs/guide").glob("*.md"))]
BLOCK = re.compile(r"(?:^<!-- (?P<file>[^\n]*?) -->\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```$",
                   re.MULTILINE | re.DOTALL)
COMPILED = {"c", "cpp", "cmake", "json"}


def blocks():
    for page in PAGES:
        for match in BLOCK.finditer(page.read_text(encoding="utf-8")):
            yield page, match


def lines(text):
    """Lines without what indentation alone tells."""
    return [line.strip() for line in textwrap.dedent(text).strip().splitlines()]


def contains(whole, part):
    return any(whole[i:i + len(part)] == part for i in range(len(whole) - len(part) + 1))


class Guide(unittest.TestCase):
    def test_there_are_blocks_to_look_at(self):
        self.assertGreater(sum(m["language"] in COMPILED for _, m in blocks()), 5)

    def test_code_is_that_of_the_named_file(self):
        for page, block in blocks():
            if block["language"] not in COMPILED:
                continue
            with self.subTest(page=page.name, block=block["text"][:60]):
                self.assertIsNotNone(block["file"], "no file is named before the block")
                source = (ROOT / block["file"]).read_text(encoding="utf-8")
                self.assertTrue(contains(lines(source), lines(block["text"])),
                                f"{block['file']} does not contain it")

    def test_commands_run(self):
        commands = [(page.name, line) for page, block in blocks() if block["language"] == "sh"
                    for line in block["text"].splitlines() if line.startswith("crashrank ")]
        self.assertGreater(len(commands), 2)
        with tempfile.TemporaryDirectory() as place:
            (pathlib.Path(place) / "data").symlink_to(ROOT / "data")
            for page, line in commands:
                with self.subTest(page=page, line=line):
                    words = shlex.split(line, comments=True)
                    done = subprocess.run([PROGRAM, *words[1:]], cwd=place, check=False,
                                          capture_output=True, text=True,
                                          env={**os.environ, "NO_COLOR": "1"})
                    self.assertEqual(done.returncode, 0, done.stderr)

    def test_links_lead_somewhere(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text("utf-8")):
                if "://" not in target:
                    with self.subTest(page=page.name, target=target):
                        self.assertTrue((page.parent / target).exists())

    def test_pages_are_listed(self):
        index = (ROOT / "docs/guide/README.md").read_text(encoding="utf-8")
        for page in PAGES[1:]:
            if page.name != "README.md":
                self.assertIn(f"({page.name})", index)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
