"""Mitsuba's transforms, cameras and shapes as its documents and sources define them, ray by ray: what pictures of imported
scenes are compared with. Nothing here is the importer's."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Callable, Sequence

import numpy as np

# "translate" and "scale" with x, y, z; "rotate" with an axis and degrees; "lookat" with origin, target and up.
Step = tuple[str, tuple[float, ...]]


def steps_matrix(steps: Sequence[Step]) -> np.ndarray:
    """The first step is applied first."""
    matrix = np.eye(4)
    for name, numbers in steps:
        matrix = _MATRICES[name](*numbers) @ matrix
    return matrix


def steps_xml(steps: Sequence[Step], name: str = "to_world") -> str:
    return f'<transform name="{name}">' + "".join(_XML[kind](*numbers) for kind, numbers in steps) + "</transform>"


def _translate(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def _rotate(x: float, y: float, z: float, degrees: float) -> np.ndarray:
    """Rodrigues' formula, counter-clockwise seen from where the axis points."""
    cross = np.cross(np.eye(3), np.array([x, y, z]) / np.linalg.norm((x, y, z)))
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


def _lookat(*numbers: float) -> np.ndarray:
    """Columns: to the left, up, along the view, and where the camera stands (Transform::look_at)."""
    origin, target, up = np.array(numbers).reshape(3, 3)
    forward = (target - origin) / np.linalg.norm(target - origin)
    left = np.cross(up, forward) / np.linalg.norm(np.cross(up, forward))
    matrix = np.eye(4)
    matrix[:3] = np.stack([left, np.cross(forward, left), forward, origin], axis=1)
    return matrix


def _xyz(x: float, y: float, z: float) -> str:
    return f'x="{x}" y="{y}" z="{z}"'


_MATRICES: dict[str, Callable[..., np.ndarray]] = {
    "translate": _translate, "scale": lambda x, y, z: np.diag([x, y, z, 1.0]), "rotate": _rotate, "lookat": _lookat}
_XML: dict[str, Callable[..., str]] = {
    "translate": lambda *xyz: f"<translate {_xyz(*xyz)}/>", "scale": lambda *xyz: f"<scale {_xyz(*xyz)}/>",
    "rotate": lambda x, y, z, degrees: f'<rotate {_xyz(x, y, z)} angle="{degrees}"/>',
    "lookat": lambda *n: '<lookat origin="{}, {}, {}" target="{}, {}, {}" up="{}, {}, {}"/>'.format(*n)}


@dataclass(frozen=True)
class Rays:
    """Of pixels: (height, width, 3) each, or with several a pixel (height, width, several, 3). Directions are unit."""

    origins: np.ndarray
    directions: np.ndarray

    def moved(self, matrix: np.ndarray) -> Rays:
        """Directions change their length, so that distances along the rays stay."""
        return Rays(self.origins @ matrix[:3, :3].T + matrix[:3, 3], self.directions @ matrix[:3, :3].T)


def _film(width: int, height: int, per_side: int, spread: float) -> tuple[np.ndarray, np.ndarray]:
    """Places from 0 to 1 on the film, from the left and from the top; (height, width, per_side squared). They fill a pixel's
    square, or with `spread` < 1 as much of it about its middle."""
    part = 0.5 + spread * ((np.arange(per_side) + 0.5) / per_side - 0.5)
    inner_y, inner_x = (grid.ravel() for grid in np.meshgrid(part, part, indexing="ij"))
    y, x = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
    return (x[..., None] + inner_x) / width, (y[..., None] + inner_y) / height


def perspective(to_world: np.ndarray, fov_x: float, width: int, height: int, per_side: int = 1,
                spread: float = 1.0) -> Rays:
    """Along +z with +x to the left; `fov_x` in degrees (perspective_projection)."""
    x, y = _film(width, height, per_side, spread)
    tangent = np.tan(np.radians(fov_x) / 2)
    local = np.stack([tangent * (1 - 2 * x), tangent * height / width * (1 - 2 * y), np.ones_like(x)], axis=-1)
    directions = local @ to_world[:3, :3].T
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    return _squeezed(Rays(np.broadcast_to(to_world[:3, 3], directions.shape), directions), per_side)


def orthographic(to_world: np.ndarray, width: int, height: int, per_side: int = 1,
                 spread: float = 1.0) -> Rays:
    """The film spans -1 to 1 along x, before to_world (orthographic_projection)."""
    x, y = _film(width, height, per_side, spread)
    local = np.stack([1 - 2 * x, height / width * (1 - 2 * y), np.zeros_like(x)], axis=-1)
    forward = to_world[:3, 2] / np.linalg.norm(to_world[:3, 2])
    origins = local @ to_world[:3, :3].T + to_world[:3, 3]
    return _squeezed(Rays(origins, np.broadcast_to(forward, origins.shape)), per_side)


def _squeezed(rays: Rays, per_side: int) -> Rays:
    return Rays(rays.origins[:, :, 0], rays.directions[:, :, 0]) if per_side == 1 else rays


@dataclass
class Hits:
    """In the space of the shape: distances along the rays (inf: none), u and v, and the normal's side where light leaves."""

    distance: np.ndarray
    uv: np.ndarray
    normal: np.ndarray


def _nothing(shape: tuple[int, ...]) -> Hits:
    return Hits(np.full(shape[:-1], np.inf), np.zeros((*shape[:-1], 2)), np.zeros(shape))


def _turn(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The share of a whole turn from x towards y."""
    return np.arctan2(y, x) / (2 * np.pi) % 1.0


def _nearer(a: Hits, b: Hits) -> Hits:
    is_a = a.distance <= b.distance
    return Hits(np.minimum(a.distance, b.distance), np.where(is_a[..., None], a.uv, b.uv),
                np.where(is_a[..., None], a.normal, b.normal))


def _plane(rays: Rays, inside: Callable[[np.ndarray, np.ndarray], np.ndarray],
           uv: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]) -> Hits:
    """z = 0, whose front is +z."""
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = -rays.origins[..., 2] / rays.directions[..., 2]
    distance = np.where(np.isfinite(distance) & (distance > 0), distance, 0)
    at = rays.origins + distance[..., None] * rays.directions
    is_hit = (distance > 0) & inside(at[..., 0], at[..., 1])
    return Hits(np.where(is_hit, distance, np.inf), np.stack(uv(at[..., 0], at[..., 1]), axis=-1),
                np.broadcast_to((0.0, 0.0, 1.0), at.shape))


def rectangle(rays: Rays) -> Hits:
    """From -1 to 1; u and v from 0 to 1 along x and y (rectangle.cpp)."""
    return _plane(rays, lambda x, y: (abs(x) <= 1) & (abs(y) <= 1), lambda x, y: ((x + 1) / 2, (y + 1) / 2))


def disk(rays: Rays) -> Hits:
    """u is the distance from the middle, v the angle from x (disk.cpp)."""
    return _plane(rays, lambda x, y: np.hypot(x, y) <= 1, lambda x, y: (np.hypot(x, y), _turn(x, y)))


def _roots(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    inside = b**2 - 4 * a * c
    root = np.sqrt(np.maximum(inside, 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        near, far = (-b - root) / (2 * a), (-b + root) / (2 * a)
    return tuple(np.where((inside > 0) & (t > 1e-9), t, np.inf) for t in (near, far))


def sphere(rays: Rays) -> Hits:
    """Radius 1: u is the angle about z from x, v that from +z (sphere.cpp)."""
    o, d = rays.origins, rays.directions
    near, far = _roots((d * d).sum(-1), 2 * (o * d).sum(-1), (o * o).sum(-1) - 1)
    distance = np.minimum(near, far)
    at = o + np.where(np.isfinite(distance), distance, 0)[..., None] * d
    uv = np.stack([_turn(at[..., 0], at[..., 1]), np.arccos(np.clip(at[..., 2], -1, 1)) / np.pi], axis=-1)
    return Hits(distance, uv, at)


def cylinder(rays: Rays) -> Hits:
    """Radius 1 about z from 0 to 1, without caps: u is the angle from x, v is z (cylinder.cpp)."""
    o, d = rays.origins, rays.directions
    found = _nothing(o.shape)
    for distance in _roots((d[..., :2] ** 2).sum(-1), 2 * (o[..., :2] * d[..., :2]).sum(-1), (o[..., :2] ** 2).sum(-1) - 1):
        at = o + np.where(np.isfinite(distance), distance, 0)[..., None] * d
        distance = np.where((at[..., 2] >= 0) & (at[..., 2] <= 1), distance, np.inf)
        uv = np.stack([_turn(at[..., 0], at[..., 1]), at[..., 2]], axis=-1)
        found = _nearer(found, Hits(distance, uv, at * (1, 1, 0)))
    return found


def cube(rays: Rays) -> Hits:
    """From -1 to 1: each face is a rectangle whose u and v run along two edges (the table in cube.cpp)."""
    found = _nothing(rays.origins.shape)
    for corner, along_u, along_v in _CUBE:
        corner, along_u, along_v = (np.array(v, float) for v in (corner, along_u, along_v))
        normal = corner + (along_u + along_v) / 2
        frame = np.eye(4)
        frame[:3] = np.stack([along_u / 2, along_v / 2, normal, normal], axis=1)
        hits = rectangle(rays.moved(np.linalg.inv(frame)))
        found = _nearer(found, Hits(hits.distance, hits.uv, np.broadcast_to(normal, rays.origins.shape)))
    return found


# Where u = v = 0, and the edges along which u and v run to 1: corners 3, 2 and 0 of each face in the source's table, whose
# u and v are (0, 0), (1, 0) and (0, 1).
_CUBE = (((-1, -1, -1), (0, 0, 2), (2, 0, 0)), ((1, 1, 1), (-2, 0, 0), (0, 0, -2)), ((1, -1, 1), (0, 2, 0), (0, 0, -2)),
         ((-1, -1, 1), (0, 2, 0), (2, 0, 0)), ((-1, -1, -1), (0, 2, 0), (0, 0, 2)), ((-1, 1, -1), (0, -2, 0), (2, 0, 0)))
