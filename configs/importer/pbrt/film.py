"""The film: resolution, crop, exposure and what of it has no counterpart (pbrt-v4: film.cpp; pbrt-v3: core/film.cpp)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from importer.pbrt.parameters import Parameters
from importer.problems import ImportProblem, Notes

FILMS = {3: ("image",), 4: ("rgb", "gbuffer", "spectral")}
MOST_PIXELS = 1 << 28
_OF_THE_FILE = ("filename", "savefp16", "coordinatesystem", "nbuckets", "lambdamin", "lambdamax", "diagonal")


@dataclass
class Film:
    width: int = 1280
    height: int = 720
    crop: tuple[int, int, int, int] | None = None  # first and last-but-one pixel in x and in y
    exposure: float = 1.0  # what a pixel is of the radiance


def read_film(kind: str, parameters: Parameters, notes: Notes, version: int) -> Film:
    """Of a statement `Film`; `Film()` is what holds without one."""
    if kind not in FILMS[version]:
        raise ImportProblem(f'{parameters.place}: there is no film "{kind}" in pbrt-v{version}; it must be'
                            f' {" or ".join(FILMS[version])}')
    film = Film(parameters.integer("xresolution", 1280), parameters.integer("yresolution", 720))
    if film.width < 1 or film.height < 1 or film.width * film.height > MOST_PIXELS:
        raise ImportProblem(f"{parameters.place}: the film has {film.width} x {film.height} pixels; it must have at least"
                            f" one and at most {MOST_PIXELS}")
    film.crop = _crop(film, parameters)
    film.exposure = _exposure(parameters, notes, version)
    if math.isfinite(parameters.number("maxcomponentvalue" if version == 4 else "maxsampleluminance", math.inf)):
        notes.left_out("the limit on a sample's brightness, which darkens what is rare and bright", str(parameters.place))
    parameters.without_effect(*_OF_THE_FILE)
    parameters.finish(notes)
    return film


def _crop(film: Film, parameters: Parameters) -> tuple[int, int, int, int] | None:
    """In pixels; the crop window wins over the pixel bounds, as FilmBaseParameters has it."""
    sizes = (film.width, film.width, film.height, film.height)
    window = parameters.numbers("cropwindow", "float", count=4)
    bounds = parameters.numbers("pixelbounds", "integer", count=4)
    if window is not None:
        x, y = sorted(window[:2].clip(0, 1)), sorted(window[2:].clip(0, 1))
        crop = tuple(math.ceil(size * at) for size, at in zip(sizes, (*x, *y)))
    elif bounds is not None:
        crop = tuple(int(min(max(at, 0), size)) for size, at in zip(sizes, bounds))
    else:
        return None
    if crop[0] >= crop[1] or crop[2] >= crop[3]:
        raise ImportProblem(f"{parameters.place}: the film's crop window holds no pixel; it must hold one at least")
    return None if crop == (0, film.width, 0, film.height) else (crop[0], crop[1], crop[2], crop[3])


def _exposure(parameters: Parameters, notes: Notes, version: int) -> float:
    """v4: the sensor's imaging ratio without the exposure time, ISO / 100 (PixelSensor::Create); v3: "scale"."""
    where = str(parameters.place)
    if version == 3:
        return parameters.number("scale", 1.0)
    sensor = parameters.string("sensor", "cie1931")
    if sensor != "cie1931":
        notes.approximated(f'the sensor "{sensor}" as one that sees colours as the standard observer', where)
    if parameters.number("whitebalance", 0.0) != 0:
        notes.left_out("the film's white balance", where)
    return parameters.number("iso", 100.0) / 100.0
