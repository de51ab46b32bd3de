#!/usr/bin/env python3
"""Prints the product's sources for clang-tidy, one a line, each after a key.

Without arguments all sources. With paths those that are among them, and for every header among them up to
four sources that include it: the source of the header's name first, then those that include it directly,
then those that do so through other headers. The key is a hash of the rules, the source and all headers of
the project that it includes: what passed with a key passes with it again.
"""

from __future__ import annotations

import collections
import hashlib
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
INCLUDE = re.compile(rb'^[ \t]*#[ \t]*include[ \t]*["<]([^">\n]+)[">]', re.MULTILINE)
FOLDERS = ("include", "src", "apps")
SOURCES_OF_A_HEADER = 4


def tracked_files() -> list[str]:
    """Headers and sources of the product, as they are in the working tree."""
    names = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *FOLDERS],
        cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    return sorted({name for name in names
                   if name.endswith((".hpp", ".h", ".cpp")) and (ROOT / name).is_file()})


def include_graph(files: list[str]) -> dict[str, list[str]]:
    """For each file the files of the project that it includes directly."""
    known = set(files)
    graph = {}
    for name in files:
        folder = name.rpartition("/")[0]
        graph[name] = []
        for raw in INCLUDE.findall((ROOT / name).read_bytes()):
            written = raw.decode()
            places = (f"{place}/{written}" for place in (folder, *FOLDERS))
            found = next((place for place in places if place in known), None)
            if found:
                graph[name].append(found)
    return graph


def reachable(graph: dict[str, list[str]], start: str) -> list[str]:
    """All that a file leads to, nearest first, without the file itself."""
    seen = {start: None}
    waiting = collections.deque([start])
    while waiting:
        for other in graph.get(waiting.popleft(), []):
            if other not in seen:
                seen[other] = None
                waiting.append(other)
    return list(seen)[1:]


def sources_of_header(header: str, included_by: dict[str, list[str]]) -> list[str]:
    """Some sources that include a header."""
    sources = [name for name in reachable(included_by, header) if name.endswith(".cpp")]
    stem = pathlib.PurePath(header).stem
    sources.sort(key=lambda name: pathlib.PurePath(name).stem != stem)
    return sources[:SOURCES_OF_A_HEADER]


def main() -> None:
    files = tracked_files()
    graph = include_graph(files)
    wanted = {name for name in files if name.endswith(".cpp")}
    if len(sys.argv) > 1:
        included_by = collections.defaultdict(list)
        for name, includes in graph.items():
            for header in includes:
                included_by[header].append(name)
        changed = set(sys.argv[1:])
        headers = [name for name in sorted(changed & set(files)) if not name.endswith(".cpp")]
        wanted &= changed.union(*(sources_of_header(name, included_by) for name in headers))
    hashes = {name: hashlib.sha256((ROOT / name).read_bytes()).digest() for name in files}
    rules = hashlib.sha256((ROOT / ".clang-tidy").read_bytes()).digest()
    for name in sorted(wanted):
        parts = [rules, hashes[name], *(hashes[other] for other in sorted(reachable(graph, name)))]
        print(hashlib.sha256(b"".join(parts)).hexdigest()[:32], name)


if __name__ == "__main__":
    main()
