"""<emitter>s that no shape has: points, spots, directions, and what shines from all around."""

from __future__ import annotations

from typing import Callable

import numpy as np

from importer.images.load import load_radiance
from importer.mitsuba.colours import SPECTRA, Use, rgb_of_plugin, rgb_of_property
from importer.mitsuba.files import SceneFolder
from importer.mitsuba.plugin import Plugin
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, Light, LightKind, Rgb, Scene, Sky

# scene.Sky's picture has its middle at -z and its right half at +x; Mitsuba's, whose u is atan2(x, -z) / 2 pi, its middle
# at +z and its right half at -x (envmap.cpp of 0.6, direction_to_uv of 3): half a turn about +y.
_MITSUBA_FROM_SKY = np.diag([-1.0, 1.0, -1.0])
_PLAIN = ("sampling_weight", "mis_compensation", "cache")
_NO_COUNTERPART = {"sun", "sky", "sunsky", "timed_sunsky", "avg_sunsky", "projector", "collimated", "directionalarea",
                   "volumelight"}
EMITTERS = ("area", "point", "spot", "directional", "constant", "envmap")


def read_light(emitter: Plugin, scene: Scene, folder: SceneFolder, notes: Notes) -> None:
    """Adds a light to the scene."""
    emitter.ignore(*_PLAIN)
    if emitter.all_of("medium"):
        notes.refuse("a light within a medium", emitter.where)
    readers: dict[str, Callable[[Plugin, Notes], Light]] = {"point": _point, "spot": _spot, "directional": _directional}
    if emitter.type in readers:
        scene.lights.append(readers[emitter.type](emitter, notes))
    elif emitter.type in ("constant", "envmap"):
        if scene.sky.image is not None or scene.sky.radiance != BLACK:
            raise ImportProblem(f"{emitter.where}: is a second environment; one is right")
        scene.sky = _constant(emitter) if emitter.type == "constant" else _environment_map(emitter, folder, notes)
    elif emitter.type == "area":
        raise ImportProblem(f"{emitter.where}: an area light belongs into a <shape>")
    elif emitter.type in _NO_COUNTERPART:
        notes.refuse(f"an emitter of type \"{emitter.type}\"", emitter.where)
        return
    else:
        raise ImportProblem(f"{emitter.where}: is no emitter of Mitsuba's; known are {', '.join(EMITTERS)}")
    emitter.note_rest(notes)


def emitted(emitter: Plugin, name: str) -> Rgb:
    """A light's colour, the same all over; 1 where it has none (Texture::D65(1))."""
    if found := emitter.get(name):
        return rgb_of_property(found, Use.EMISSION, emitter.is_old)
    child = emitter.child(name)
    if child is None:
        return 1.0, 1.0, 1.0
    if child.type not in SPECTRA:
        raise ImportProblem(f"{child.where}: a texture cannot be the \"{name}\" of this emitter")
    return rgb_of_plugin(child, Use.EMISSION)


def _name(emitter: Plugin) -> str:
    return emitter.id or emitter.type


def _point(emitter: Plugin, notes: Notes) -> Light:
    position = _given_or_of_transform("position", 3, emitter)
    return Light(_name(emitter), LightKind.POINT, emitted(emitter, "intensity"), tuple(position))


def _spot(emitter: Plugin, notes: Notes) -> Light:
    """Mitsuba fades linearly in the angle between the cones (falloff_curve), glTF by the square of a term that is
    linear in the cosine (KHR_lights_punctual)."""
    to_world = emitter.transform("to_world")
    outer = np.radians(emitter.number("cutoff_angle", 20.0))
    inner = np.radians(emitter.number("beam_width", float(np.degrees(outer)) * 3 / 4))
    if not 0 <= inner <= outer <= np.pi or outer == 0:
        raise ImportProblem(f"{emitter.where}: its beam of {np.degrees(inner):g} degrees must lie within its cutoff of "
                            f"{np.degrees(outer):g} degrees")
    if emitter.child("texture"):
        notes.refuse("a spot light's texture", emitter.where)
    if inner < outer:
        notes.approximated("a spot light's fading, linear in the angle, as glTF's", emitter.where)
    return Light(_name(emitter), LightKind.SPOT, emitted(emitter, "intensity"), tuple(to_world[:3, 3]),
                 tuple(_direction(to_world[:3, 2], emitter)), float(inner), float(outer))


def _directional(emitter: Plugin, notes: Notes) -> Light:
    direction = _given_or_of_transform("direction", 2, emitter)
    return Light(_name(emitter), LightKind.DIRECTIONAL, emitted(emitter, "irradiance"),
                 direction=tuple(_direction(direction, emitter)))


def _given_or_of_transform(name: str, column: int, emitter: Plugin) -> np.ndarray:
    """A parameter that says in three numbers what a column of to_world says otherwise."""
    if not emitter.has(name):
        return emitter.transform("to_world")[:3, column]
    if emitter.has("to_world"):
        raise ImportProblem(f"{emitter.where}: has both \"{name}\" and \"to_world\"; one of them is right")
    return emitter.vector(name, (0.0, 0.0, 0.0))


def _direction(vector: np.ndarray, emitter: Plugin) -> np.ndarray:
    length = np.linalg.norm(vector)
    if length < 1e-12:
        raise ImportProblem(f"{emitter.where}: its direction is zero")
    return vector / length


def _constant(emitter: Plugin) -> Sky:
    emitter.ignore("to_world")
    return Sky(radiance=emitted(emitter, "radiance"))


def _environment_map(emitter: Plugin, folder: SceneFolder, notes: Notes) -> Sky:
    path = folder.find(emitter.string("filename"), emitter.folders, emitter.where)
    if emitter.number("gamma", 0.0) not in (0.0, 1.0):
        notes.left_out("the gamma of an environment map: its type decides", emitter.where)
    if not emitter.is_old:
        notes.approximated("the rows of an environment map, which Mitsuba 3 spreads from pole to pole, by at most half a "
                           "row towards the poles", emitter.where)
    scale = emitter.number("scale", 1.0)
    if scale < 0:
        raise ImportProblem(f"{emitter.where}: its scale is {scale:g}; a light cannot be negative")
    with folder.reading(emitter.where):
        image = load_radiance(path)
    return Sky(image=image, scale=(scale, scale, scale), to_world=_rotation(emitter) @ _MITSUBA_FROM_SKY)


def _rotation(emitter: Plugin) -> np.ndarray:
    """The linear part of to_world without a scale, which has no meaning for directions."""
    linear = emitter.transform("to_world")[:3, :3]
    scale = np.cbrt(abs(np.linalg.det(linear)))
    if scale < 1e-12 or np.abs(linear.T @ linear / scale**2 - np.eye(3)).max() > 1e-3:
        raise ImportProblem(f"{emitter.where}: its to_world must be a rotation, without shear or different scales")
    u, _, v = np.linalg.svd(linear)
    return u @ v
