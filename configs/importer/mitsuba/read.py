"""A Mitsuba scene of version 0.5, 0.6 or 3 as a scene of the importer's."""

from __future__ import annotations

from pathlib import Path

from importer.mitsuba.camera import read_camera
from importer.mitsuba.clipping import note_clipped
from importer.mitsuba.integrator import read_max_bounces
from importer.mitsuba.lights import read_light
from importer.mitsuba.materials import MaterialReader
from importer.mitsuba.parts import PartReader, check_count
from importer.mitsuba.plugin import Plugin
from importer.mitsuba.shapes import ShapeReader
from importer.mitsuba.textures import TextureReader
from importer.mitsuba.xml_tree import SceneTree
from importer.problems import ImportProblem, Notes
from importer.scene import Scene

# Of a scene, what its shapes and sensors refer to, and what does not change what light does.
_SHARED = ("bsdf", "texture", "sampler", "phase", "volume", "film", "rfilter", "subsurface")


def read_mitsuba(path: Path, notes: Notes, parameters: dict[str, str]) -> Scene:
    """`parameters` are values for the scene's $names, as `mitsuba -D name=value` has them."""
    tree = SceneTree(path, notes, parameters)
    root = tree.read(path)
    sensor = _sensor(root, notes)
    scene = Scene(path.stem, read_camera(sensor, notes))
    scene.source_version = tree.version
    scene.max_bounces = read_max_bounces(_integrator(root), notes)
    for emitter in root.all_of("emitter"):
        if emitter.type != "area" or not emitter.id:  # an area light with an id is there for shapes to refer to
            read_light(emitter, scene, tree.folder, notes)
    parts = PartReader(ShapeReader(tree.folder, notes), MaterialReader(TextureReader(tree.folder, notes), notes), notes)
    shapes = root.all_of("shape")
    check_count(shapes)
    for shape in shapes:
        parts.add(shape)
    scene.parts = parts.parts
    note_clipped(sensor, scene.camera, scene.parts, notes)
    root.all_of(*_SHARED)
    _refuse_media(root, notes)
    root.note_rest(notes)
    if not scene.parts:
        raise ImportProblem(f"{path.name}: has no shape that is seen; a <scene> with at least one <shape> is right")
    return scene


def _sensor(root: Plugin, notes: Notes) -> Plugin:
    """The first, as Mitsuba renders it."""
    sensors = root.all_of("sensor")
    if not sensors:
        raise ImportProblem(f"{root.where}: has no <sensor>; one with a <film> is needed")
    for other in sensors[1:]:
        notes.left_out("all sensors but the first", other.where)
    return sensors[0]


def _integrator(root: Plugin) -> Plugin | None:
    return root.only("integrator")


def _refuse_media(root: Plugin, notes: Notes) -> None:
    """A medium that no shape holds fills the space about the camera, or is there to be referred to."""
    for medium in root.all_of("medium"):
        if not medium.id:
            notes.refuse("a medium", medium.where)
