"""Shapes side by side before one camera, and what Mitsuba shows of them."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy as np

import mitsuba_rays
import mitsuba_xml as xml
from mitsuba_rays import Hits, Rays, Step, steps_matrix, steps_xml

SIDE, SIZE, FOV, DISTANCE = 4, 96, 40.0, 9.0  # exhibits in a row, pixels, degrees
_SPACING = 1.55
_PER_SIDE, _SPREAD = 3, 0.5  # rays of a pixel, of which the middle one goes through its centre
Colour = Callable[[np.ndarray], np.ndarray]  # of u and v: what is seen there, and not a number where nothing is
_CORNERS = ((-1, -1), (1, -1), (1, 1), (-1, 1))


@dataclass(frozen=True)
class Exhibit:
    """A shape about the origin, no larger than 0.7, and hits of a unit shape that `own` and then `steps` move."""

    name: str
    text: str  # with {transform} and {inside}
    steps: Sequence[Step]
    hits: Callable[[Rays], Hits]
    colour: Colour
    inside: str = ""  # the shape's material or lamp
    own: np.ndarray | None = None
    sign: int = 1  # -1: light leaves where the normal does not point

    def place(self, index: int) -> Sequence[Step]:
        row, column = divmod(index, SIDE)
        middle = (SIDE - 1) / 2
        return *self.steps, ("translate", ((column - middle) * _SPACING, (middle - row) * _SPACING, 0.0))

    def to_xml(self, index: int) -> str:
        return self.text.format(transform=steps_xml(self.place(index)), inside=self.inside)

    def matrix(self, index: int) -> np.ndarray:
        matrix = steps_matrix(self.place(index))
        return matrix if self.own is None else matrix @ self.own


def shape(kind: str, parameters: str = "") -> str:
    return f'<shape type="{kind}">{parameters}{{transform}}{{inside}}</shape>'


def camera(from_behind: bool = False) -> Step:
    return "lookat", (0, 0, -DISTANCE if from_behind else DISTANCE, 0, 0, 0, 0, 1, 0)


def scene(exhibits: Sequence[Exhibit], version: str, from_behind: bool = False, also: str = "") -> str:
    shapes = "".join(exhibit.to_xml(index) for index, exhibit in enumerate(exhibits))
    sensor = xml.sensor("perspective", [camera(from_behind)], SIZE, SIZE, xml.number("fov", FOV))
    return xml.scene(version, f'<emitter type="constant"/>{sensor}{also}{shapes}')


@dataclass(frozen=True)
class View:
    """Of each pixel: which exhibit is seen (-1: none), its colour, the side, and where; and whether all of a pixel's rays
    say the same."""

    index: np.ndarray
    colour: np.ndarray
    is_front: np.ndarray
    position: np.ndarray
    normal: np.ndarray
    is_even: np.ndarray


def view(exhibits: Sequence[Exhibit], from_behind: bool = False) -> View:
    rays = mitsuba_rays.perspective(steps_matrix([camera(from_behind)]), FOV, SIZE, SIZE, _PER_SIDE,
                                   _SPREAD)
    nearest = np.full(rays.origins.shape[:-1], np.inf)
    index = np.full(nearest.shape, -1)
    colour, normal = np.zeros(rays.origins.shape), np.zeros(rays.origins.shape)
    for number, exhibit in enumerate(exhibits):
        matrix = exhibit.matrix(number)
        inverse = np.linalg.inv(matrix)
        hits = exhibit.hits(rays.moved(inverse))
        colours = exhibit.colour(hits.uv)
        is_nearer = (hits.distance < nearest) & ~np.isnan(colours[..., 0])
        nearest[is_nearer], index[is_nearer] = hits.distance[is_nearer], number
        colour[is_nearer] = colours[is_nearer]
        normal[is_nearer] = exhibit.sign * (hits.normal @ inverse[:3, :3])[is_nearer]
    is_front = (normal * rays.directions).sum(-1) < 0
    with np.errstate(invalid="ignore"):
        position = np.where(index[..., None] >= 0, rays.origins + nearest[..., None] * rays.directions, 0)
    middle = _PER_SIDE**2 // 2
    is_even = np.ones(index.shape[:2], bool)
    for values in (index, colour[..., 0], colour[..., 1], is_front):
        is_even &= (values == values[..., :1]).all(axis=-1)
    normal /= np.maximum(np.linalg.norm(normal, axis=-1, keepdims=True), 1e-30)
    return View(index[..., middle], colour[..., middle, :], is_front[..., middle], position[..., middle, :],
                normal[..., middle, :], is_even)


def obj_square(with_normals: float = 0.0, is_reversed: bool = False) -> str:
    """From -1 to 1, with texture coordinates from 0 to 1; normals along z times `with_normals` where that is not 0."""
    lines = [f"v {x} {y} 0" for x, y in _CORNERS] + [f"vt {(x + 1) / 2} {(y + 1) / 2}" for x, y in _CORNERS]
    normal = "/1" if with_normals else ""
    lines += [f"vn 0 0 {with_normals}"] if with_normals else []
    order = (4, 3, 2, 1) if is_reversed else (1, 2, 3, 4)
    return "\n".join([*lines, "f " + " ".join(f"{i}/{i}{normal}" for i in order), ""])


def ply_square() -> str:
    properties = "".join(f"property float {name}\n" for name in ("x", "y", "z", "u", "v"))
    rows = "".join(f"{x} {y} 0 {(x + 1) / 2} {(y + 1) / 2}\n" for x, y in _CORNERS)
    return (f"ply\nformat ascii 1.0\nelement vertex 4\n{properties}element face 1\n"
            f"property list uchar int vertex_indices\nend_header\n{rows}4 0 1 2 3\n")


def serialized_square() -> bytes:
    """One mesh of version 4, in single precision and with texture coordinates (its documentation, section "serialized")."""
    positions = np.array([(x, y, 0) for x, y in _CORNERS], "<f4")
    uvs = ((np.array(_CORNERS) + 1) / 2).astype("<f4")
    body = (struct.pack("<I", 0x1002) + b"square\0" + struct.pack("<QQ", 4, 2) + positions.tobytes() + uvs.tobytes()
            + np.array([(0, 1, 2), (0, 2, 3)], "<u4").tobytes())
    packed = struct.pack("<HH", 0x041C, 4) + zlib.compress(body)
    return packed + struct.pack("<QI", 0, 1)
