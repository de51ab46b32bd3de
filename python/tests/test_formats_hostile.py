"""Damaged files: an answer or one line, in bounded time and memory. Seeds are fixed."""

import json
import math
import random
import resource
import subprocess
import sys
import time

import crashrank
import format_scenes as scenes
import pytest
from conftest import DATA
from crashrank import formats

FILES = {
    "crossing.xml": (formats.read_commonroad, "lxml"),
    "crossing.xosc": (formats.read_openscenario, "lxml"),
    "crossing.osi": (formats.read_osi, "osi3"),
    "crossing_esmini.csv": (formats.read_esmini_csv, None),
    "crossing_poses.csv": (formats.read_poses_csv, None),
}
WORDS = (
    b"nan", b"inf", b"-1e999", b"1e308", b"-0", b"", b"1_0", b"0x10", b"99999999999999999999",
    b"\x00", b"\xff\xfe", b"<", b">", b"</", b"&amp;", b"&x;", b'"', b",", b"\n", b"${", b"$Ego",
    "é".encode(), b"1;2", b"<!--", b"]]>",
)  # fmt: skip


def mutated(data, generate):
    """Return damaged data: bytes flipped, cut, doubled or moved, numbers replaced."""
    data = bytearray(data)
    for _ in range(generate.choice((1, 1, 1, 2, 5, 20))):
        at = generate.randrange(len(data) or 1)
        to = min(len(data), at + generate.choice((1, 2, 4, 20, 200)))
        what = generate.randrange(7)
        if what == 0 and data:
            data[at] ^= 1 << generate.randrange(8)
        elif what == 1:
            del data[at:to]
        elif what == 2:
            data[at:at] = data[at:to]
        elif what == 3:
            data[at:to] = generate.choice(WORDS)
        elif what == 4:
            data[at:at] = generate.choice(WORDS)
        elif what == 5:
            other = generate.randrange(len(data) or 1)
            data[at:to] = data[other : other + (to - at)]
        else:
            replace_number(data, generate)
    return bytes(data)


def replace_number(data, generate):
    """Replace a run of digits."""
    starts = [
        i for i in range(1, len(data)) if data[i] in b"0123456789" and data[i - 1] in b'>",= '
    ]
    if not starts:
        return
    at = to = generate.choice(starts)
    while to < len(data) and data[to] in b"0123456789.+-e":
        to += 1
    data[at:to] = generate.choice((*WORDS[:9], b"-5", b"0", b"1e-9", b"1e6", b"3.5e4"))


def check(reader, path):
    """Read a file: it is a scenario that crashrank accepts, or one line."""
    try:
        found = reader(path, ego="1") if path.suffix == ".osi" else reader(path)
    except crashrank.Error as error:
        assert error.code in ("bad_input", "limit_exceeded", "usage", "not_found"), error
        assert error.reason
        assert error.remedy
        assert len(str(error).splitlines()) == 1
        assert str(error).isprintable()
        assert len(str(error)) < 1500
        return False
    text = json.dumps(found.scenario, allow_nan=False)
    assert all(line.splitlines() == [line] for line in found.report.lines() if line.isprintable())
    accepted(json.loads(text))
    return True


def accepted(document):
    """Check that the scenario itself is accepted; its models stay unread."""
    for model in document["models"].values():
        assert all(0.02 <= side <= 100 for side in model.pop("box"))
        model["mesh"] = "box.obj"
    crashrank.Scenario(document)


@pytest.mark.parametrize("name", FILES)
def test_damaged_files(name, tmp_path):
    reader, module = FILES[name]
    if module:
        pytest.importorskip(module)
    data = (DATA / "formats" / name).read_bytes()
    generate = random.Random(name)
    path = tmp_path / name
    read = 0
    for _ in range(600):
        path.write_bytes(mutated(data, generate))
        started = time.monotonic()
        read += check(reader, path)
        assert time.monotonic() - started < 20
    assert read > 5  # mutations that still say something


@pytest.mark.parametrize("name", FILES)
def test_files_that_end_early(name, tmp_path):
    reader, module = FILES[name]
    if module:
        pytest.importorskip(module)
    data = (DATA / "formats" / name).read_bytes()
    path = tmp_path / name
    for size in range(0, len(data), max(len(data) // 60, 1)):
        path.write_bytes(data[:size])
        check(reader, path)


def test_damaged_bags(tmp_path):
    pytest.importorskip("rosbags")
    folder = scenes.write_bag(tmp_path / "bag")
    files = sorted(folder.iterdir())
    originals = {file: file.read_bytes() for file in files}
    generate = random.Random(7)
    for _ in range(150):
        file = generate.choice(files)
        file.write_bytes(mutated(originals[file], generate))
        try:
            formats.read_bag(folder)
        except crashrank.Error as error:
            assert error.code in ("bad_input", "limit_exceeded", "usage", "not_found"), error
            assert len(str(error).splitlines()) == 1
        file.write_bytes(originals[file])
    formats.read_bag(folder)


def test_damaged_mcap(tmp_path):
    pytest.importorskip("osi3")
    pytest.importorskip("mcap")
    path = tmp_path / "a.mcap"
    scenes.write_osi_mcap(path)
    data = path.read_bytes()
    generate = random.Random(3)
    for _ in range(200):
        path.write_bytes(mutated(data, generate))
        check(formats.read_osi, path)


XML = {
    "entities": '<!DOCTYPE a [<!ENTITY b "cccc">]><commonRoad commonRoadVersion="2020a"/>',
    "external": '<!DOCTYPE a SYSTEM "file:///etc/passwd"><commonRoad/>',
    "lower case": "<!doctype a><commonRoad/>",
    "parameter": '<!DOCTYPE a [<!ENTITY % b SYSTEM "http://127.0.0.1:9/x">%b;]><commonRoad/>',
}


@pytest.mark.parametrize("name", XML)
def test_document_types_are_refused(name, tmp_path):
    pytest.importorskip("lxml")
    path = tmp_path / "a.xml"
    for encoding in ("utf-8", "utf-16", "utf-7"):
        head = f"<?xml version='1.0' encoding='{encoding}'?>\n"
        path.write_bytes((head + XML[name]).encode(encoding))
        with pytest.raises(crashrank.BadInputError) as caught:
            formats.read_commonroad(path)
        if encoding == "utf-8":
            assert "document type" in caught.value.reason


def test_deep_and_wide_files_are_refused(tmp_path):
    pytest.importorskip("lxml")
    path = tmp_path / "a.xml"
    path.write_text("<commonRoad>" * 100_000)
    with pytest.raises(crashrank.BadInputError):
        formats.read_commonroad(path)
    path.write_bytes(b"<commonRoad>" + b"<a/>" * 5_000_000 + b"</commonRoad>")
    with pytest.raises(crashrank.LimitError):
        formats.read_commonroad(path)


def test_sizes_are_checked_before_reading(tmp_path):
    for name, reader, size in (
        ("a.xml", formats.read_commonroad, 2**26),
        ("a.csv", formats.read_poses_csv, 2**30),
        ("a.osi", formats.read_osi, 2**31),
    ):
        if name != "a.csv":
            pytest.importorskip("lxml" if name == "a.xml" else "osi3")
        with open(tmp_path / name, "wb") as file:
            file.truncate(size)
        with pytest.raises(crashrank.LimitError):
            reader(tmp_path / name)


def test_what_is_no_file_is_refused(tmp_path):
    import os

    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", tmp_path / "none", "a\0b", "", 3, None):
        with pytest.raises(crashrank.Error):
            formats.read_poses_csv(path)


def test_arguments_are_checked():
    file = DATA / "formats/crossing_poses.csv"
    for more in (
        {"time_s": "now"}, {"time_s": math.nan}, {"horizon_s": -1}, {"horizon_s": 1e9},
        {"ego": 1.5}, {"ego": True}, {"ego": "nobody"},
    ):  # fmt: skip
        with pytest.raises(crashrank.UsageError):
            formats.read_poses_csv(file, **more)


LIMITED = """
import resource, sys
import crashrank
from crashrank import formats
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
try:
    getattr(formats, sys.argv[1])(sys.argv[2])
except crashrank.Error as error:
    print(error.code)
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before)
"""


def memory_of(reader, path):
    """Return what a reader in a process of its own needs, bytes."""
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, reader, str(path)],
        capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    return int(done.stdout.split()[-1]) * 1024


def test_stated_sizes_take_no_memory(tmp_path):
    pytest.importorskip("osi3")
    path = tmp_path / "a.osi"
    path.write_bytes(b"\xff\xff\xff\x03" + b"\0" * 64)
    assert memory_of("read_osi", path) < 300e6
    path.write_bytes(b"\xff\xff\xff\xff" + b"\0" * 64)
    assert memory_of("read_osi", path) < 200e6
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss > 0


def test_large_xml_takes_bounded_memory(tmp_path):
    pytest.importorskip("lxml")
    path = tmp_path / "a.xml"
    text = scenes.commonroad()
    path.write_text(text.replace("</commonRoad>", "<a>1</a>" * 1_900_000 + "</commonRoad>"))
    assert memory_of("read_commonroad", path) < 1.5e9
