"""OpenSCENARIO: entities, inline or of catalogues in the scenario's folder or below."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass

from .._errors import Error
from ._parameters import Parameters, assignments
from ._refusals import input_error, refuse
from ._scene import Report, completed_size, kind_by_size
from ._xml import Node, read_xml

MAX_CATALOGUES = 200
MAX_FOLDERS = 1_000
MAX_DEPTH = 4
MAX_ENTITIES = 1_000
_OBJECTS = ("Vehicle", "Pedestrian", "MiscObject")
_VEHICLES = {
    "car": "car",
    "van": "car",
    "truck": "truck",
    "trailer": "truck",
    "semitrailer": "truck",
    "train": "truck",
    "tram": "bus",
    "bus": "bus",
    "motorbike": "motorcycle",
    "bicycle": "bicycle",
}
_OTHERS = {
    "barrier": "barrier",
    "guardrail": "barrier",
    "soundbarrier": "barrier",
    "railing": "barrier",
    "parkedvehicle": "car",
    "pole": "pole",
    "streetlamp": "pole",
    "tree": "pole",
    "building": "building",
}


@dataclass
class Entity:
    """An object of a scenario: its box, and where the box's middle lies from its origin."""

    name: str
    node: Node
    kind: str
    size_m: tuple[float, float, float]
    centre_m: tuple[float, float]
    mass_kg: float | None = None
    wheelbase_m: float | None = None


def read_entities(root: Node, parameters: Parameters, report: Report) -> dict[str, Entity]:
    """Return the entities of a scenario by name."""
    found: dict[str, Entity] = {}
    catalogues = _Catalogues(root, parameters, report)
    for node in root.need("Entities").children("ScenarioObject"):
        name = parameters.text(node, "name")
        if len(found) == MAX_ENTITIES:
            refuse(node.file, node.place, "is one entity too many", "leave some out")
        reference = node.child("CatalogReference")
        if reference is not None:
            stated, scope = catalogues.find(reference, parameters)
        else:
            inline = node.children(*_OBJECTS)
            if not inline:
                what = next((child.tag for child in node.children()), "nothing")
                refuse(
                    node.file, node.place, f"is {what}, which states no box",
                    f"give it one of {', '.join(_OBJECTS)}",
                )  # fmt: skip
            stated = inline[0]
            scope = parameters.declared(stated.child("ParameterDeclarations"))
        found[name] = _entity(name, stated, scope, report)
    if root.need("Entities").children("EntitySelection"):
        report.leave_out("selections of entities")
    return found


def _entity(name: str, node: Node, scope: Parameters, report: Report) -> Entity:
    box = node.child("BoundingBox")
    if box is None:
        report.assume("it has no BoundingBox, so its size is that of its kind", name)
        sides, centre = (0.0, 0.0, 0.0), (0.0, 0.0)
    else:
        dimensions, middle = box.need("Dimensions"), box.need("Center")
        length, width, height = (
            scope.number(dimensions, side, low=0, high=500)
            for side in ("length", "width", "height")
        )
        sides = (length, width, height)
        centre = (
            scope.number(middle, "x", low=-200, high=200),
            scope.number(middle, "y", low=-200, high=200),
        )
    kind = _kind(name, node, scope, sides, report)
    size = completed_size(kind, *sides, report, name)
    mass = scope.number(node, "mass", 0.0, 0, 1e6)
    return Entity(
        name, node, kind, size, centre, mass if mass >= 1.0 else None, _wheelbase(node, scope)
    )


def _kind(
    name: str, node: Node, scope: Parameters, sides: tuple[float, float, float], report: Report
) -> str:
    if node.tag == "Pedestrian":
        if scope.text(node, "pedestrianCategory", "") == "animal":
            report.assume("animals are persons", name)
        return "pedestrian"
    if node.tag == "Vehicle":
        found = _VEHICLES.get(scope.text(node, "vehicleCategory", "car").lower())
        if found is None:
            found = kind_by_size(sides) if sides[0] and sides[1] else "car"
            report.assume(f"its category is not known, so it is a {found}", name)
        return found
    category = scope.text(node, "miscObjectCategory", "").lower()
    found = _OTHERS.get(category, "building")
    if category not in _OTHERS:
        report.assume("its category is not known, so it is a building", name)
    return found


def _wheelbase(node: Node, scope: Parameters) -> float | None:
    front, rear = node.at("Axles", "FrontAxle"), node.at("Axles", "RearAxle")
    if front is None or rear is None:
        return None
    found = scope.number(front, "positionX", 0.0) - scope.number(rear, "positionX", 0.0)
    return found if 0.5 < found < 30.0 else None


class _Catalogues:
    """Catalogues by name, of the directories of CatalogLocations, else of the folder and below.

    Nothing outside of the folder is read.
    """

    def __init__(self, root: Node, parameters: Parameters, report: Report) -> None:
        self._base = os.path.realpath(os.path.dirname(root.file) or ".")
        places = root.child("CatalogLocations")
        tags = [f"{each}Catalog" for each in _OBJECTS]
        kinds = [] if places is None else places.children(*tags)
        self._stated = [node for kind in kinds for node in kind.children("Directory")]
        self._parameters = parameters
        self._report = report
        self._known: dict[str, dict[str, Node]] | None = None  # by name and file
        self._problems: list[tuple[str, str]] = []

    def find(self, reference: Node, parameters: Parameters) -> tuple[Node, Parameters]:
        """Return the entry that a `CatalogReference` names, and its parameters."""
        catalogue = parameters.text(reference, "catalogName")
        entry = parameters.text(reference, "entryName")
        if self._known is None:
            self._known = {}
            for node in self._read():
                self._known.setdefault(node.get("name") or "", {})[node.file] = node
        found = list(self._known.get(catalogue, {}).values())
        if len(found) != 1:
            where = "the directories of CatalogLocations" if self._stated else "the folder"
            reason, remedy = (
                f"which is not in {where} of the file",
                "put it there; paths that lead out of the folder are not followed",
            )
            if found:
                first, second = (os.path.relpath(node.file, self._base) for node in found[:2])
                reason = f"which both {first} and {second} have"
                remedy = "name the Directory of one in CatalogLocations, or rename the other"
            elif self._problems:
                reason, remedy = self._problems[0]
            refuse(
                reference.file, reference.place, f"names the catalogue {catalogue!r}, {reason}",
                remedy,
            )  # fmt: skip
        for each in found[0].children(*_OBJECTS):
            if each.get("name") == entry:
                given = assignments(reference.child("ParameterAssignments"), parameters)
                scope = Parameters().declared(each.child("ParameterDeclarations"), given)
                return each, scope
        name = os.path.relpath(found[0].file, self._base)
        raise input_error(
            reference.file, reference.place, f"names {entry!r}, which {name} does not have",
            "correct the name",
        )  # fmt: skip

    def _folders(self) -> Iterator[tuple[str, list[str]]]:
        """Return the folders that may hold catalogues, and their files."""
        for node in self._stated:
            path = self._parameters.text(node, "path")
            at = os.path.realpath(os.path.join(self._base, path))
            if os.path.commonpath((self._base, at)) != self._base:
                self._problems.append((
                    f"but {node.place} leads out of the folder of the file: {path}",
                    "copy that folder into the one of the file, and name it there",
                ))  # fmt: skip
            elif not os.path.isdir(at):
                self._problems.append((
                    f"but {node.place} names {path}, which is no folder",
                    "correct the path, which is relative to the file, or create the folder",
                ))  # fmt: skip
            else:
                yield at, next(os.walk(at), (at, [], []))[2]
        if self._stated:
            return
        for visited, (at, folders, files) in enumerate(os.walk(self._base)):
            if visited >= MAX_FOLDERS:
                self._report.warn(f"only {MAX_FOLDERS} folders were searched for catalogues")
                return
            if os.path.relpath(at, self._base).count(os.sep) >= MAX_DEPTH:
                folders.clear()
            folders.sort()
            yield at, files

    def _read(self) -> Iterator[Node]:
        """Return the catalogues; files that are none are passed over, those no XML noted."""
        paths = (os.path.join(at, name) for at, files in self._folders() for name in sorted(files))
        ours = (path for path in paths if path.lower().endswith(".xosc"))
        for count, path in enumerate(path for path in ours if not os.path.islink(path)):
            if count == MAX_CATALOGUES:
                self._report.warn(f"only {MAX_CATALOGUES} files were searched for catalogues")
                return
            try:
                found = read_xml(path, "OpenSCENARIO", "OpenSCENARIO file").child("Catalog")
            except Error as error:
                name = os.path.relpath(path, self._base)
                place = f"{name}, {error.place}," if error.place else name
                self._problems.append((f"but {place} {error.reason}", error.remedy))
                continue
            if found is not None:
                yield found
