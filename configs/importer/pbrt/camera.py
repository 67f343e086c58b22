"""Cameras (pbrt-v4: cameras.cpp; pbrt-v3: cameras/perspective.cpp, orthographic.cpp).

pbrt's camera looks along +z with +y up and +x to the right, glTF's along -z: mirrored against it, unless the scene's
own transformation mirrors."""

from __future__ import annotations

import math

import numpy as np

from importer.pbrt.film import Film
from importer.pbrt.parameters import Parameters
from importer.problems import ImportProblem, Notes
from importer.scene import Camera

_FROM_GLTF = np.diag([1.0, 1.0, -1.0, 1.0])
_REFUSED = {"realistic": "a camera with lenses", "spherical": "a camera that looks all around",
            "environment": "a camera that looks all around"}
_OF_THE_SHUTTER = ("shutteropen", "shutterclose")


def read_camera(kind: str, parameters: Parameters, to_world: np.ndarray, film: Film, notes: Notes) -> Camera:
    """A camera and its exposure, which goes into `film`."""
    where = str(parameters.place)
    if kind in _REFUSED:
        notes.refuse(f'the camera "{kind}", {_REFUSED[kind]}', where)
        return Camera(to_world @ _FROM_GLTF, 60.0, 1.0, film.width, film.height)
    if kind not in ("perspective", "orthographic"):
        raise ImportProblem(f'{where}: there is no camera "{kind}"; it must be perspective or orthographic')
    # Lengths along the camera's axes, which the camera of glTF does not have: they widen or narrow its picture.
    across, up, ahead = np.linalg.norm(to_world[:3, :3], axis=0)
    half_height = _half_screen(parameters, film, across / up, notes) * up
    if kind == "perspective":
        half_height *= math.tan(math.radians(_field_of_view(parameters)) / 2) / ahead
    camera = Camera(to_world @ _FROM_GLTF, None, half_height, film.width, film.height)
    if film.crop is not None:
        _crop(camera, film, notes, where)
    if kind == "perspective":
        camera.vertical_fov = math.degrees(2 * math.atan(camera.half_height))
        camera.half_height = 1.0
    _lens(parameters, notes)
    parameters.finish(notes)
    return camera


def exposure_time(parameters: Parameters, version: int) -> float:
    """v4's sensor gathers light while the shutter is open, 1 by default (cpu/render.cpp: exposureTime)."""
    opened, closed = parameters.number("shutteropen", 0.0), parameters.number("shutterclose", 1.0)
    if version == 3:
        return 1.0
    if closed <= opened:
        raise ImportProblem(f"{parameters.place}: the shutter closes before it opens; shutterclose must be greater")
    return closed - opened


def _field_of_view(parameters: Parameters) -> float:
    """Degrees, across the shorter side of the picture. "halffov" is v3's, and wins."""
    half = parameters.number("halffov", -1.0)
    degrees = parameters.number("fov", 90.0) if half <= 0 else 2 * half
    if not 0 < degrees < 180:
        raise ImportProblem(f"{parameters.place}: the camera's field of view is {degrees:g} degrees; it must be between"
                            " 0 and 180")
    return degrees


def _half_screen(parameters: Parameters, film: Film, widened: float, notes: Notes) -> float:
    """Half the screen window's height, which is 1 along the shorter side where the file says nothing."""
    where = str(parameters.place)
    aspect = parameters.number("frameaspectratio", film.width / film.height)
    if aspect <= 0:
        raise ImportProblem(f"{where}: the camera's frameaspectratio is {aspect:g}; it must be above 0")
    half_width, half_height = (aspect, 1.0) if aspect > 1 else (1.0, 1 / aspect)
    window = parameters.numbers("screenwindow", "float", count=4)
    if window is not None:
        left, right, bottom, top = window
        if left >= right or bottom >= top:
            raise ImportProblem(f"{where}: the camera's screenwindow is empty; it must be xmin xmax ymin ymax")
        half_width, half_height = (right - left) / 2, (top - bottom) / 2
        if abs(left + right) > 1e-4 * half_width or abs(bottom + top) > 1e-4 * half_height:
            notes.refuse("a screen window off the camera's axis", where)
    if abs(half_width * widened * film.height / (half_height * film.width) - 1) > 0.005:
        notes.approximated("pixels that are not square as square ones: what is seen across differs", where)
    return float(half_height)


def _crop(camera: Camera, film: Film, notes: Notes, where: str) -> None:
    """A crop about the picture's middle is a smaller picture; any other has no counterpart in glTF."""
    assert film.crop is not None
    left, right, top, bottom = film.crop
    if abs(left + right - film.width) > 1 or abs(top + bottom - film.height) > 1:
        notes.left_out("the film's crop window, which is off the middle: the whole picture is rendered", where)
        return
    camera.width, camera.height = right - left, bottom - top
    camera.half_height *= camera.height / film.height


def _lens(parameters: Parameters, notes: Notes) -> None:
    if parameters.number("lensradius", 0.0) > 0:
        notes.approximated("a lens as a pinhole, without depth of field", str(parameters.place))
    parameters.without_effect("focaldistance", *_OF_THE_SHUTTER)
