"""<sensor> and its <film>. Mitsuba's cameras look along +z with +y up and thus +x to the *left*."""

from __future__ import annotations

import re

import numpy as np

from importer.mitsuba.plugin import Plugin
from importer.problems import ImportProblem, Notes
from importer.scene import Camera

# Turns glTF's camera, which looks along -z with +x to the right, about +y into Mitsuba's.
_MITSUBA_FROM_GLTF = np.diag([-1.0, 1.0, -1.0, 1.0])
_MAX_SIZE = 32768
SENSORS = {
    "perspective": "with its field of view on any axis",
    "thinlens": "as a pinhole: without depth of field",
    "orthographic": "",
}
_FILMS = {"hdrfilm", "ldrfilm", "mfilm", "specfilm"}
# Of cameras and films, without an effect on what a picture shows.
_SENSOR_PLAIN = ("focus_distance", "shutter_open", "shutter_close")
_FILM_PLAIN = ("file_format", "pixel_format", "component_format", "high_quality_edges", "attach_log", "banner", "compensate",
               "sample_border", "filename", "variable", "digits")


def read_camera(sensor: Plugin, notes: Notes) -> Camera:
    if sensor.type not in SENSORS:
        raise ImportProblem(f"{sensor.where}: a sensor of type \"{sensor.type}\" has no counterpart here; known are "
                            f"{', '.join(SENSORS)}")
    film = sensor.only("film")
    size, crop = _film_size(film) if film else ((768, 576), (0, 0, 768, 576))
    sensor.ignore(*_SENSOR_PLAIN, "near_clip", "far_clip")  # of which clipping.py says more
    sensor.all_of("sampler")
    _refuse_extras(sensor, notes)
    if film:
        _note_film(film, notes)
    else:
        _note_filter(sensor, None, notes)
    to_world = sensor.transform("to_world")
    lengths = np.linalg.norm(to_world[:3, :3], axis=0)
    if not abs(np.linalg.det(to_world[:3, :3])) > 1e-6 * np.prod(lengths) > 0:
        raise ImportProblem(f"{sensor.where}: its to_world is flat; one that turns and moves is right")
    crop = _usable_crop(size, crop, sensor, notes)
    aspect = size[0] / size[1]
    of_whole = crop[1] / size[1]  # the share of the film's height that is rendered
    camera = Camera(to_world @ _MITSUBA_FROM_GLTF, width=crop[0], height=crop[1])
    if sensor.type == "orthographic":
        camera.half_height = _half_height(to_world, aspect, sensor, notes) * of_whole
    else:
        tangent = np.tan(np.radians(_horizontal_fov(sensor, aspect)) / 2) / aspect * of_whole
        camera.vertical_fov = float(2 * np.degrees(np.arctan(tangent)))
    sensor.note_rest(notes)
    return camera


def _horizontal_fov(sensor: Plugin, aspect: float) -> float:
    """In degrees, of the whole film (parse_fov in Mitsuba 3's render/sensor.cpp, PerspectiveCamera in 0.6's)."""
    if sensor.has("fov") and sensor.has("focal_length"):
        raise ImportProblem(f"{sensor.where}: has both \"fov\" and \"focal_length\"; one of them is right")
    if sensor.has("fov"):
        fov = np.radians(sensor.number("fov", 50.0))
        axis = sensor.string("fov_axis", "x").lower()
    else:  # of a film of 36 mm x 24 mm
        fov = 2 * np.arctan(np.hypot(36.0, 24.0) / (2 * _focal_length(sensor)))
        axis = "diagonal"
        sensor.ignore("fov_axis")
    if not 0 < fov < np.pi:
        raise ImportProblem(f"{sensor.where}: a field of view of {np.degrees(fov):g} degrees; between 0 and 180 is right")
    axis = {"smaller": "y" if aspect > 1 else "x", "larger": "x" if aspect > 1 else "y"}.get(axis, axis)
    tangent = np.tan(fov / 2)
    if axis == "y":
        tangent *= aspect
    elif axis == "diagonal":
        tangent /= np.sqrt(1 + 1 / aspect**2)
    elif axis != "x":
        raise ImportProblem(f"{sensor.where}: the \"fov_axis\" is \"{axis}\"; x, y, diagonal, smaller and larger are known")
    return float(2 * np.degrees(np.arctan(tangent)))


def _focal_length(sensor: Plugin) -> float:
    text = sensor.string("focal_length", "50mm")
    match = re.match(r"\s*(\d+\.?\d*|\.\d+)\s*(mm)?\s*\Z", text)
    if not match or float(match[1]) == 0:
        raise ImportProblem(f"{sensor.where}: the \"focal_length\" is \"{text[:40]}\"; a length such as \"50mm\" is right")
    return float(match[1])


def _half_height(to_world: np.ndarray, aspect: float, sensor: Plugin, notes: Notes) -> float:
    """The film spans x from -1 to 1 and y from -1/aspect to 1/aspect, scaled by `to_world` (orthographic.cpp)."""
    scale_x, scale_y = np.linalg.norm(to_world[:3, :2], axis=0)
    if abs(scale_x - scale_y) > 1e-4 * scale_x:
        notes.refuse("an orthographic sensor with different scales along x and y", sensor.where)
    return float(scale_y / aspect)


def _film_size(film: Plugin) -> tuple[tuple[int, int], tuple[int, int, int, int]]:
    """Width and height, and the crop window's offset and size."""
    if film.type not in _FILMS:
        raise ImportProblem(f"{film.where}: a film of type \"{film.type}\" is not known; {', '.join(sorted(_FILMS))} are")
    # 0.6's mfilm, for matrices of a few pixels, is the only one with a size of its own.
    default = (1, 1) if film.type == "mfilm" else (768, 576)
    width, height = film.integer("width", default[0]), film.integer("height", default[1])
    if not (1 <= width <= _MAX_SIZE and 1 <= height <= _MAX_SIZE):
        raise ImportProblem(f"{film.where}: is {width} x {height} pixels large; from 1 to {_MAX_SIZE} each is right")
    crop = (film.integer("crop_offset_x", 0), film.integer("crop_offset_y", 0),
            film.integer("crop_width", width), film.integer("crop_height", height))
    if min(crop[:2]) < 0 or min(crop[2:]) < 1 or crop[0] + crop[2] > width or crop[1] + crop[3] > height:
        raise ImportProblem(f"{film.where}: its crop window lies outside of its {width} x {height} pixels")
    return (width, height), crop


def _usable_crop(size: tuple[int, int], crop: tuple[int, int, int, int], sensor: Plugin, notes: Notes) -> tuple[int, int]:
    """The size of what is rendered: glTF's cameras look through their picture's middle, thus only a crop there is one."""
    is_centred = all(2 * crop[i] + crop[2 + i] == size[i] for i in (0, 1))
    if is_centred:
        return crop[2], crop[3]
    notes.approximated(f"a crop window away from the picture's middle ({crop[2]} x {crop[3]} pixels from "
                       f"{crop[0]}, {crop[1]} on) as the whole picture, pixel for pixel", sensor.where)
    return size


def _refuse_extras(sensor: Plugin, notes: Notes) -> None:
    for name in ("principal_point_offset_x", "principal_point_offset_y"):
        if sensor.number(name, 0.0) != 0.0:
            notes.refuse("a shifted camera (principal_point_offset)", sensor.where)
    if sensor.number("aperture_radius", 0.0) > 0.0 and sensor.type == "thinlens":
        notes.left_out("depth of field (thinlens): rendered as a pinhole", sensor.where)
    if sensor.all_of("medium"):
        notes.refuse("a camera within a medium", sensor.where)


def _note_film(film: Plugin, notes: Notes) -> None:
    film.ignore(*_FILM_PLAIN)
    _note_filter(film, film.only("rfilter"), notes)
    if film.type == "specfilm":
        notes.approximated("a spectral film's channels as RGB", film.where)
        film.all_of("texture")
    for name in ("gamma", "exposure", "tonemap_method", "key", "burn"):
        if film.has(name):
            film.ignore(name)
            notes.left_out(f"how the picture is shown ({name} of the film); radiance is written", film.where)
    film.note_rest(notes)


def _note_filter(at: Plugin, rfilter: Plugin | None, notes: Notes) -> None:
    """Mitsuba's default is a Gaussian of a standard deviation of half a pixel."""
    name = rfilter.type if rfilter else "gaussian"
    if name != "box":
        notes.approximated(f"the pixel filter ({name}) as a box of one pixel", (rfilter or at).where)
