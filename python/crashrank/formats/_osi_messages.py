"""ASAM OSI: the messages of a trace, one by one, within limits."""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from typing import Any

from ._refusals import guarded_parse, guarded_read, refuse, refuse_size, required_module

MAX_MESSAGE = 64 * 2**20
MAX_CHUNK = 256 * 2**20
MAX_MESSAGES = 1_000_000
_MAGIC = b"\x89MCAP0\r\n"


def trace_messages(file: str) -> Iterator[tuple[str, Any]]:
    """Return the places and ground truths of a trace, as they are read."""
    found = _mcap(file) if file.lower().endswith(".mcap") else _prefixed(file)
    return guarded_iteration(file, found)


def guarded_iteration(file: str, messages: Iterator[Any]) -> Iterator[Any]:
    """Return what an iterator of another package yields; what it raises is one refusal."""
    end = object()
    while (found := guarded_parse(file, "OSI trace", lambda: next(messages, end))) is not end:
        yield found


def _prefixed(file: str) -> Iterator[tuple[str, Any]]:
    """Return the messages of a trace: a length of four bytes, little-endian, before each."""
    from osi3 import osi_groundtruth_pb2, osi_sensorview_pb2

    is_view = "_sv_" in os.path.basename(file).lower()
    with guarded_read(file, lambda: open(file, "rb")) as stream:
        for i in range(MAX_MESSAGES + 1):
            place = f"message {i + 1}"
            head = stream.read(4)
            if not head:
                return
            size = struct.unpack("<I", head)[0] if len(head) == 4 else -1
            if size > MAX_MESSAGE:
                refuse_size(
                    file, place, f"has {size} bytes, at most {MAX_MESSAGE} are read",
                    "check that it is a trace of length-prefixed messages",
                )  # fmt: skip
            data = stream.read(max(size, 0))
            if len(data) != size:
                refuse(file, place, "is cut off", "write the trace again")
            message = (
                osi_sensorview_pb2.SensorView() if is_view else osi_groundtruth_pb2.GroundTruth()
            )
            _parse(file, place, message, data)
            yield place, message.global_ground_truth if is_view else message
    refuse_size(file, "", f"has more than {MAX_MESSAGES} messages", "cut out what matters")


def _mcap(file: str) -> Iterator[tuple[str, Any]]:
    """Return the messages of the first topic of ground truth, chunk by chunk."""
    from osi3 import osi_groundtruth_pb2, osi_sensorview_pb2

    makers = {
        "osi3.GroundTruth": osi_groundtruth_pb2.GroundTruth,
        "osi3.SensorView": osi_sensorview_pb2.SensorView,
    }
    schemas: dict[int, str] = {}
    topics: dict[int, tuple[str, str]] = {}
    chosen, found = "", 0
    with guarded_read(file, lambda: open(file, "rb")) as stream:
        _check_ends(file, stream)
        for record in _records(file, stream):
            what = type(record).__name__
            if what == "Schema":
                schemas[record.id] = record.name
            elif what == "Channel":
                topics[record.id] = (record.topic, schemas.get(record.schema_id, ""))
            elif what == "Message":
                topic, schema = topics.get(record.channel_id, ("", ""))
                if schema not in makers or (chosen and topic != chosen):
                    continue
                chosen, found = topic, found + 1
                place = f"message {found} of {topic}"
                if found > MAX_MESSAGES:
                    refuse_size(file, place, "is one too many", "cut out what matters")
                message = makers[schema]()
                _parse(file, place, message, record.data)
                yield place, message.global_ground_truth if schema.endswith("View") else message
    if not found:
        refuse(file, "", "has no OSI ground truth", f"name one with {' or '.join(makers)}")


def _check_ends(file: str, stream: Any) -> None:
    """Refuse a file that does not begin and end as MCAP does; the stream is at its start again."""
    if stream.read(len(_MAGIC)) != _MAGIC:
        refuse(file, "", "is no MCAP file", "name one, or an .osi trace")
    stream.seek(-len(_MAGIC), os.SEEK_END)
    if stream.read() != _MAGIC:
        refuse(file, "", "is cut off", "write the trace again")
    stream.seek(0)


def _records(file: str, stream: Any) -> Iterator[Any]:
    """Return the records of an MCAP file; a chunk is unpacked once its stated size is accepted."""
    reader = required_module("mcap.stream_reader", "mcap", "osi")
    for record in reader.StreamReader(
        stream, emit_chunks=True, record_size_limit=MAX_MESSAGE
    ).records:
        if type(record).__name__ != "Chunk":
            yield record
            continue
        if record.uncompressed_size > MAX_CHUNK or record.compression not in ("", "zstd"):
            refuse_size(
                file, "chunk", f"has {record.uncompressed_size} bytes ({record.compression})",
                f"write chunks of at most {MAX_CHUNK} bytes, plain or with zstd",
            )  # fmt: skip
        yield from reader.breakup_chunk(record)


def _parse(file: str, place: str, message: Any, data: bytes) -> None:
    from google.protobuf.message import DecodeError

    try:
        message.ParseFromString(data)
    except (DecodeError, ValueError):
        refuse(file, place, "is no OSI ground truth", "write the trace again")
