"""What Mitsuba's cameras do not see because of their clipping planes, and here is seen."""

from __future__ import annotations

import itertools

import numpy as np

from importer.mitsuba.plugin import Plugin
from importer.problems import Notes
from importer.scene import Camera, Part


def note_clipped(sensor: Plugin, camera: Camera, parts: list[Part], notes: Notes) -> None:
    """Names a clipping plane if a part of the scene may lie beyond it within the picture."""
    if not parts:
        return
    near, far = sensor.number("near_clip", 1e-2), sensor.number("far_clip", 1e4)
    from_world = np.linalg.inv(_without_scale(camera.to_world))
    corners = _corners(parts, from_world)
    for name, low, high in (("nearer than the near", 0.0, near), ("farther than the far", far, np.inf)):
        may_meet = np.flatnonzero(_is_inside(corners, camera, low, high))
        if any(_meets(parts[index], from_world, camera, low, high) for index in may_meet):
            limit = near if high == near else far
            notes.left_out(f"a clipping plane: what lies {name} one, at {limit:g}, is seen here", sensor.where)


def _corners(parts: list[Part], from_world: np.ndarray) -> np.ndarray:
    """(n, 8, 3): of all parts' bounds at once, since there may be thousands, and most are nowhere near."""
    boxes: dict[int, np.ndarray] = {}
    for mesh in (part.mesh for part in parts):
        if id(mesh) not in boxes:
            bounds = zip(mesh.positions.min(axis=0), mesh.positions.max(axis=0))
            boxes[id(mesh)] = np.array(list(itertools.product(*bounds)))
    matrices = from_world @ np.stack([part.to_world for part in parts])
    local = np.stack([boxes[id(part.mesh)] for part in parts])
    return local @ matrices[:, :3, :3].transpose(0, 2, 1) + matrices[:, None, :3, 3]


def _meets(part: Part, from_world: np.ndarray, camera: Camera, low: float, high: float) -> bool:
    """Whether there is a triangle that no plane of the region separates from it, which near its edges may be one that
    misses it."""
    positions = _moved(part.mesh.positions, from_world @ part.to_world)
    return bool(_is_inside(positions[part.mesh.triangles], camera, low, high).any())


def _moved(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def _without_scale(matrix: np.ndarray) -> np.ndarray:
    result = matrix.copy()
    result[:3, :3] /= np.linalg.norm(matrix[:3, :3], axis=0)
    return result


def _is_inside(sets: np.ndarray, camera: Camera, low: float, high: float) -> np.ndarray:
    """(n, k, 3) points of the camera's space: whether no plane has all k of a set on its outer side."""
    x, y, depth = sets[..., 0], sets[..., 1], -sets[..., 2]
    aspect = camera.width / camera.height
    half = camera.half_height if camera.vertical_fov is None else depth * np.tan(np.radians(camera.vertical_fov) / 2)
    outer = [depth <= low, depth >= high, x > half * aspect, -x > half * aspect, y > half, -y > half]
    return ~np.any([side.all(axis=-1) for side in outer], axis=0)
