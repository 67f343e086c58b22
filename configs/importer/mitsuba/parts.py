"""Shapes with their materials and lamps as parts of the scene; groups of shapes and their instances."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from importer.materials import models
from importer.materials.normal_maps import NormalMaps
from importer.materials.parameters import scaled
from importer.mitsuba.colours import Use
from importer.mitsuba.materials import MaterialReader
from importer.mitsuba.media import read_absorption
from importer.mitsuba.plugin import Plugin
from importer.mitsuba.shapes import ANALYTIC, FILES, NO_COUNTERPART, Geometry, ShapeReader
from importer.mitsuba.transforms import mirrors
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, Colour, Material, Part, Texture

GROUPS = ("shapegroup", "instance", "merge")
_MAX_PARTS = 1_000_000  # with all instances


def check_count(shapes: list[Plugin]) -> None:
    """Before any is read: merges of merges double what there is at each step."""
    counts: dict[int, int] = {}
    total = 0
    for shape in shapes:
        total += _count(shape, counts) if shape.type != "shapegroup" else 0  # which instances show
        if total > _MAX_PARTS:
            raise ImportProblem(f"{shape.where}: is one of more than {_MAX_PARTS} shapes with all instances, the most that "
                                "are read")


def _count(shape: Plugin, counts: dict[int, int]) -> int:
    """Of a shape and those that it holds; each object is counted once, however many refer to it."""
    if shape.key not in counts:
        inner = [child for child in shape.children if child.kind == "shape"] if shape.type in GROUPS else []
        counts[shape.key] = sum(_count(child, counts) for child in inner) if inner else 1
    return counts[shape.key]


@dataclass
class PartReader:
    shapes: ShapeReader
    materials: MaterialReader
    notes: Notes
    parts: list[Part] = field(default_factory=list)
    _read: dict[int, tuple[Geometry, Material]] = field(default_factory=dict)  # of shapes, which instances share
    _normal_maps: NormalMaps = field(default_factory=NormalMaps)

    def add(self, shape: Plugin, outer: np.ndarray | None = None) -> None:
        """A shape of the scene, or with `outer` one of an instance's group."""
        if shape.type == "instance":
            self._instance(shape, outer)
        elif shape.type == "merge":
            for child in shape.all_of("shape"):
                self.add(child, outer)
        elif shape.type in (*FILES, *ANALYTIC):
            self._single(shape, np.eye(4) if outer is None else outer)
        elif shape.type in NO_COUNTERPART:
            self.notes.refuse(f"a shape of type \"{shape.type}\"", shape.where)
            return
        elif shape.type != "shapegroup":  # which shows nothing but through its instances
            known = ", ".join((*FILES, *ANALYTIC, *GROUPS))
            raise ImportProblem(f"{shape.where}: is no shape of Mitsuba's; known are {known}")
        if shape.type != "shapegroup":
            shape.note_rest(self.notes)

    def _instance(self, shape: Plugin, outer: np.ndarray | None) -> None:
        if outer is not None:
            raise ImportProblem(f"{shape.where}: is an instance within a group, which Mitsuba does not allow")
        to_world = shape.transform("to_world")
        groups = shape.all_of("shape")
        if len(groups) != 1 or groups[0].type != "shapegroup":
            raise ImportProblem(f"{shape.where}: needs one <ref> to a <shape type=\"shapegroup\">")
        for child in groups[0].all_of("shape"):
            self.add(child, to_world)

    def _single(self, shape: Plugin, outer: np.ndarray) -> None:
        if shape.key not in self._read:
            self._read[shape.key] = self._geometry_and_material(shape)
        geometry, material = self._read[shape.key]
        if material.opacity == 0.0:
            self.notes.left_out("surfaces that nothing sees (null)", shape.where)
            return
        to_world = outer @ geometry.to_world
        material = self._normal_maps.suited(material, geometry.mesh, mirrors(to_world))
        self.parts.append(Part(shape.id or geometry.mesh.name or shape.type, geometry.mesh, material, to_world))

    def _geometry_and_material(self, shape: Plugin) -> tuple[Geometry, Material]:
        geometry, material = self.shapes.read(shape), self._material(shape)
        return (self.shapes.inside_out(geometry) if models.is_inward(material) else geometry), material

    def _material(self, shape: Plugin) -> Material:
        emitter = shape.only("emitter")
        media = shape.all_of("medium")
        if shape.all_of("subsurface"):
            self.notes.refuse("light that scatters below a surface (subsurface)", shape.where)
        if shape.all_of("sensor"):
            self.notes.left_out("a sensor on a shape", shape.where)
        bsdf = self._bsdf(shape)
        if bsdf:
            material = self.materials.read(bsdf)
        elif media and not emitter:
            material = models.null("null")
        else:  # Shape::configure of 0.6, Shape::Shape of 3
            grey = 0.0 if emitter else 0.5
            material = models.diffuse("default", (grey, grey, grey), self.notes, shape.where)
        if media:
            material = self._filled(material, media, shape)
        return self._lit(material, emitter, shape) if emitter else material

    def _filled(self, material: Material, media: list[Plugin], shape: Plugin) -> Material:
        """Glass that takes up light says so itself."""
        if models.can_absorb(material) and [medium.name for medium in media] == ["interior"]:
            absorption = read_absorption(media[0], self.notes)
            if absorption is not None:
                return models.absorbing(material, absorption, media[0].where)
        self.notes.refuse("a medium that scatters light, or is not within glass", shape.where)
        return material

    def _bsdf(self, shape: Plugin) -> Plugin | None:
        """0.6 takes several for the groups of an .obj, by their names there, and those of the .obj's .mtl file."""
        if not (shape.is_old and shape.type == "obj"):
            return shape.only("bsdf")
        bsdfs = shape.all_of("bsdf")
        if len(bsdfs) > 1:
            self.notes.refuse("materials for single groups of an .obj (several <bsdf>)", shape.where)
        if not bsdfs:
            self.notes.approximated("an .obj without a <bsdf>, for which Mitsuba 0.6 reads its .mtl file, as a grey one",
                                    shape.where)
        return bsdfs[0] if bsdfs else None

    def _masked_lamp(self, material: Material, radiance: Colour, emitter: Plugin) -> tuple[Material, Colour]:
        """Mitsuba's masks pass light but do not dim that of a lamp (Mask::eval concerns scattering alone); here a surface
        emits as often as it is there."""
        if isinstance(material.opacity, Texture):
            self.notes.approximated("a lamp with a textured mask, which dims its light here", emitter.where)
        elif material.opacity == 0.0:
            self.notes.approximated("a lamp that light passes through (null) as a black one", emitter.where)
            material = models.diffuse(material.name, BLACK, self.notes, emitter.where)
        elif material.opacity < 1.0:
            radiance = scaled(radiance, 1.0 / material.opacity)
        return material, radiance

    def _lit(self, material: Material, emitter: Plugin, shape: Plugin) -> Material:
        """One-sided, as all of Mitsuba's area lights are."""
        if emitter.type != "area":
            self.notes.refuse(f"an emitter of type \"{emitter.type}\" on a shape", emitter.where)
            return material
        emitter.ignore("sampling_weight")
        radiance = self.materials.textures.colour(emitter, "radiance", 1.0, Use.EMISSION)
        emitter.note_rest(self.notes)
        material, radiance = self._masked_lamp(material, radiance, emitter)
        lamp = models.lamp(material, radiance, False, self.notes, emitter.where)
        return replace(lamp, name=f"{material.name} of {shape.id or shape.type}")
