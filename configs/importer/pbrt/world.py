"""Shapes with their materials and emission, and the objects that instances are made of (pbrt-v4: scene.cpp)."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np

from importer.materials import colours, models
from importer.materials import parameters as arithmetic
from importer.materials.normal_maps import NormalMaps
from importer.meshes import orient
from importer.pbrt.lights import emission
from importer.pbrt.materials import Materials
from importer.pbrt.materials_v3 import OVERRIDES
from importer.pbrt.media import Media
from importer.pbrt.parameters import Parameters
from importer.pbrt.shapes import Shapes, power_area, with_default_uvs
from importer.pbrt.source import Place
from importer.pbrt.spectra import Spectra
from importer.pbrt.state import Definition, State
from importer.pbrt.statements import Statement
from importer.pbrt.textures import Textures
from importer.pbrt.transforms import check_usable
from importer.problems import ImportProblem, Notes
from importer.scene import Colour, Material, Mesh, Part, Texture

MOST_PARTS = 1_000_000


class World:
    """Collects the parts of one scene."""

    def __init__(self, shapes: Shapes, materials: Materials, textures: Textures, spectra: Spectra, notes: Notes,
                 version: int) -> None:
        self.parts: list[Part] = []
        self._shapes = shapes
        self._materials = materials
        self._textures = textures
        self._spectra = spectra
        self._notes = notes
        self._version = version
        self._objects: dict[str, list[Part]] = {}
        self._object: tuple[str, list[Part]] | None = None
        self._variants: dict[tuple[Mesh, str], Mesh] = {}
        self._normal_maps = NormalMaps()
        self.media = Media(spectra, notes)
        self._radiances: dict[Definition, Colour] = {}

    def begin_object(self, statement: Statement) -> None:
        if self._object is not None:
            raise ImportProblem(f"{statement.place}: ObjectBegin within an object; objects must not hold others")
        self._object = (statement.strings[0], [])

    def end_object(self, place: Place) -> None:
        if self._object is None:
            raise ImportProblem(f"{place}: ObjectEnd without ObjectBegin; each needs its beginning")
        name, parts = self._object
        self._objects[name] = parts
        self._object = None

    def add_instance(self, statement: Statement, to_world: np.ndarray) -> None:
        """An object's parts once more, all of it moved by the transformation that holds here."""
        name = statement.strings[0]
        if self._object is not None:
            raise ImportProblem(f"{statement.place}: ObjectInstance within an object; objects must not hold others")
        if name not in self._objects:
            raise ImportProblem(f'{statement.place}: there is no object "{name}"; ObjectBegin must define it before')
        check_usable(to_world, statement.place)
        for part in self._objects[name]:
            moved = Part(part.name, part.mesh, part.material, to_world @ part.to_world)
            self._add(self.parts, self._with_suited_normals(moved), statement.place)

    def add_shape(self, kind: str, parameters: Parameters, state: State) -> None:
        check_usable(state.to_world, parameters.place)
        material, is_invisible = self._material(parameters, state)
        light = self._lamp_of(state, material, parameters)
        meshes = [] if is_invisible else self._shapes.read(kind, parameters, state.is_reversed)
        if material is None and light is None:
            parameters.without_effect(*(parameter.name for parameter in parameters.own))
            return
        for mesh in meshes:
            made = material if light is None else self._shining(material, light, kind, parameters, mesh, state)
            assert made is not None
            name = mesh.name if kind == "plymesh" else f"{kind} of line {parameters.place.line}"
            part = Part(name, self._fitting(mesh, made), made, state.to_world)
            if self._object is None:
                self._add(self.parts, self._with_suited_normals(part), parameters.place)
            else:
                self._add(self._object[1], part, parameters.place)
        parameters.finish(self._notes)

    def _material(self, parameters: Parameters, state: State) -> tuple[Material | None, bool]:
        """The material, if the shape has one, and whether its alpha is 0, so that nothing of it is there."""
        definition = state.material
        overrides = {parameter.name for parameter in parameters.own} & set(OVERRIDES) if self._version == 3 else set()
        if definition is not None and overrides:
            material = self._materials.overridden(definition, parameters, overrides)
            parameters.without_effect(*overrides)
        else:
            material = self._materials.of(definition)
        if material is None:
            parameters.without_effect("alpha", "shadowalpha")
            self._notes.left_out("surfaces without a material, which nothing sees", str(parameters.place))
            return None, False
        if state.medium:
            material = self.media.filled(material, state.medium, parameters.place)
        masked = self._materials.masked(material, parameters, state)
        if masked is None and state.area_light is not None and self._version == 4:
            # pbrt-v4 keeps such a lamp's light and lets no ray meet it (DiffuseAreaLight, constant alpha of 0).
            self._notes.approximated("a lamp that is not seen, by its alpha of 0, as one that is", str(parameters.place))
            return material, False
        return masked, masked is None

    def _lamp_of(self, state: State, material: Material | None, parameters: Parameters) -> Definition | None:
        """The area light that the shape has, if any."""
        light = state.area_light
        if light is None:
            return None
        where = str(parameters.place)
        if self._object is not None:
            self._notes.left_out("the light of an object's shapes, which pbrt leaves out of instances", where)
            return None
        if material is None and self._version == 4:
            self._notes.left_out("the light of a surface without a material, which pbrt-v4 leaves out", where)
            return None
        return light

    def _shining(self, material: Material | None, light: Definition, kind: str, parameters: Parameters, mesh: Mesh,
                 state: State) -> Material:
        lamp = light.parameters
        both_sides = lamp.flag("twosided", False)
        radiance = self._radiance(light)
        power = lamp.number("power", -1.0) if self._version == 4 else -1.0
        if power > 0:
            area, count, are_alike = power_area(kind, parameters, mesh, state.to_world)
            if not are_alike:
                self._notes.approximated('the "power" of a mesh, which each of its triangles has, as evenly spread',
                                         str(parameters.place))
            if area <= 0:
                raise ImportProblem(f"{parameters.place}: {parameters.what} has no area to which a power could be given")
            sides = 2 if both_sides else 1
            radiance = arithmetic.scaled(radiance, count * power / (math.pi * area * sides * self._luminance_of(lamp)))
        lamp.without_effect("nsamples", "samples")
        lamp.finish(self._notes)
        return self._materials.lamp(material, radiance, both_sides, str(lamp.place))

    def _radiance(self, light: Definition) -> Colour:
        """In v4 of an image, where there is one, times "scale"."""
        lamp = light.parameters
        if light not in self._radiances:
            radiance: Colour = emission(self._spectra, lamp, "L", light.state.colour_space, self._version)
            name = lamp.string("filename", "") if self._version == 4 else ""
            if name and lamp.has("L"):
                raise ImportProblem(f'{lamp.place}: an area light has both "L" and "filename"; it must have one of them')
            if name:
                assert not isinstance(radiance, Texture)
                radiance = arithmetic.scaled(self._textures.emission(name, str(lamp.place)), radiance)
            self._radiances[light] = radiance
        return self._radiances[light]

    def _luminance_of(self, lamp: Parameters) -> float:
        """By which pbrt-v4 divides a "power" besides the area: an image's; 1 for a colour, whose own is left out of
        account (DiffuseAreaLight::Create, k_e)."""
        name = lamp.string("filename", "")
        if not name:
            return 1.0
        mean = colours.luminance(arithmetic.mean_rgb(self._textures.emission(name, str(lamp.place))))
        return mean if mean > 0 else 1.0

    def _with_suited_normals(self, part: Part) -> Part:
        """A normal map in glTF's frame, which depends on whether the whole transformation mirrors."""
        if part.material.normal_map is None:
            return part
        is_mirrored = bool(np.linalg.det(part.to_world[:3, :3]) < 0)
        return replace(part, material=self._normal_maps.suited(part.material, part.mesh, is_mirrored))

    def _fitting(self, mesh: Mesh, material: Material) -> Mesh:
        """The mesh as the material needs it: with texture coordinates, and turned inside out for a bubble in glass."""
        if models.is_inward(material):
            mesh = self._variant(mesh, "flipped")
        if mesh.uvs is None and any(isinstance(getattr(material, field.name), Texture) for field in fields(material)):
            mesh = self._variant(mesh, "uvs")
        return mesh

    def _variant(self, mesh: Mesh, which: str) -> Mesh:
        if (mesh, which) not in self._variants:
            self._variants[mesh, which] = orient.flipped(mesh) if which == "flipped" else with_default_uvs(mesh)
        return self._variants[mesh, which]

    def _add(self, parts: list[Part], part: Part, place: Place) -> None:
        if len(parts) >= MOST_PARTS:
            raise ImportProblem(f"{place}: the scene has more than {MOST_PARTS} parts; it must have fewer instances")
        parts.append(part)

