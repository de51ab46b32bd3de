"""XML without entities, document types and network, bounded before it is parsed."""

from __future__ import annotations

import re
from typing import Any

from ._refusals import decoded, number, read_bytes, refuse, refuse_size, required_module

MAX_BYTES = 32 * 2**20
MAX_TAGS = 2_000_000

_DECLARATION = re.compile(
    rb"""^\s*<\?xml[^>]{0,200}?encoding\s*=\s*["']([A-Za-z0-9._-]{1,40})["']"""
)
_FORBIDDEN = re.compile(rb"<!(DOCTYPE|ENTITY|ELEMENT|ATTLIST|NOTATION)", re.IGNORECASE)
_ENCODINGS = {"utf-8": "", "utf8": "", "us-ascii": "", "ascii": ""} | dict.fromkeys(
    ("iso-8859-1", "latin1", "windows-1252"), "cp1252"
)


class Node:
    """An element, its place in the file, and checked access to what is in it."""

    __slots__ = ("element", "file")

    def __init__(self, element: Any, file: str) -> None:
        self.element = element
        self.file = file

    @property
    def tag(self) -> str:
        """Name of the element without its namespace."""
        tag = self.element.tag
        return tag.rpartition("}")[2] if isinstance(tag, str) else ""

    @property
    def place(self) -> str:
        """Name, id or name attribute, and line: `dynamicObstacle 31 (line 812)`."""
        identity = self.element.get("id") or self.element.get("name") or ""
        words = f"{self.tag} {identity}".strip()
        return f"{words} (line {self.element.sourceline})"

    def children(self, *tags: str) -> list[Node]:
        """Return the elements in it, of these names or all."""
        found = (Node(child, self.file) for child in self.element)
        return [node for node in found if node.tag and (not tags or node.tag in tags)]

    def child(self, tag: str) -> Node | None:
        """Return the first element in it of that name."""
        return next(iter(self.children(tag)), None)

    def at(self, *tags: str) -> Node | None:
        """Return the element at a path of names, None where there is none."""
        node: Node | None = self
        for tag in tags:
            node = node.child(tag) if node is not None else None
        return node

    def need(self, *tags: str) -> Node:
        """Return the element at a path of names; refuse the file where there is none."""
        node = self.at(*tags)
        if node is None:
            refuse(self.file, self.place, f"has no {'/'.join(tags)}", "add the element")
        return node

    def walk(self) -> list[Node]:
        """Return all elements below it, in the order of the file."""
        found = (Node(child, self.file) for child in self.element.iterdescendants())
        return [node for node in found if node.tag]

    def descendants(self, *tags: str) -> list[Node]:
        """Return all elements of these names below it, in the order of the file."""
        return [node for node in self.walk() if node.tag in tags]

    def text(self) -> str:
        """Return the text in it."""
        return (self.element.text or "").strip()

    def number(self, low: float = -1e9, high: float = 1e9) -> float:
        """Return the number in it; refuse what is none."""
        return number(self.text(), self.file, self.place, low, high)

    def get(self, name: str) -> str | None:
        """Return an attribute, None where there is none."""
        value = self.element.get(name)
        return None if value is None else str(value)

    def attribute(self, name: str) -> str:
        """Return an attribute; refuse the file where there is none."""
        value = self.get(name)
        if value is None:
            refuse(self.file, self.place, f"has no {name}", "add the attribute")
        return value


def read_xml(path: object, root: str, what: str) -> Node:
    """Return the root element of a file.

    At most `MAX_BYTES` and `MAX_TAGS`, nested at most 256 deep, in UTF-8, ASCII or Latin-1. The
    encoding is fixed before parsing, so that no document type can hide in another one.

    Parameters
    ----------
    root : str
        Name that the root element has to have.
    what : str
        Name of the format, for messages.
    """
    etree = required_module("lxml.etree", "lxml", "formats")
    file, data = read_bytes(path, MAX_BYTES)
    if data[:2] in (b"\xff\xfe", b"\xfe\xff") or b"\0" in data[:64]:
        refuse(file, "", "is not UTF-8", "save the file in UTF-8")
    declared = _DECLARATION.match(data[:400].removeprefix(b"\xef\xbb\xbf"))
    encoding = _ENCODINGS.get(declared[1].decode().lower() if declared else "utf-8")
    if encoding is None:
        refuse(file, "line 1", "has another encoding than UTF-8", "save the file in UTF-8")
    if encoding:
        data = data.decode(encoding, "replace").encode()
    else:
        decoded(file, data)
    forbidden = _FORBIDDEN.search(data)
    if forbidden:
        line = data.count(b"\n", 0, forbidden.start()) + 1
        refuse(
            file, f"line {line}", "has a document type or an entity", f"remove it: {what} has none"
        )
    if data.count(b"<") > 2 * MAX_TAGS:
        refuse_size(file, "", f"has more than {MAX_TAGS} elements", "cut out what matters")
    parser = etree.XMLParser(
        encoding="utf-8", resolve_entities=False, no_network=True, load_dtd=False,
        dtd_validation=False, huge_tree=False, remove_comments=True, remove_pis=True,
    )  # fmt: skip
    try:
        element = etree.fromstring(data, parser)
    except etree.XMLSyntaxError as error:
        line, reason = error.lineno, (error.msg or "is damaged").split(", line")[0]
        refuse(file, f"line {line}", f"is no XML: {reason}", "write the file again")
    node = Node(element, file)
    if node.tag != root:
        refuse(file, node.place, f"is no {what}: its root is not {root}", "name a file of it")
    return node
