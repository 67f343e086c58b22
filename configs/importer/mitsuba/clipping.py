"""What Mitsuba's cameras do not see because of their clipping planes, and here is seen."""

from __future__ import annotations

import numpy as np

from importer.mitsuba.plugin import Plugin
from importer.problems import Notes
from importer.scene import Camera, Part


def note_clipped(sensor: Plugin, camera: Camera, parts: list[Part], notes: Notes) -> None:
    """Names a clipping plane if a part of the scene may lie beyond it within the picture."""
    near, far = sensor.number("near_clip", 1e-2), sensor.number("far_clip", 1e4)
    for name, low, high in (("nearer than the near", 0.0, near), ("farther than the far", far, np.inf)):
        if any(_meets(part, camera, low, high) for part in parts):
            limit = near if high == near else far
            notes.left_out(f"a clipping plane: what lies {name} one, at {limit:g}, is seen here", sensor.where)


def _meets(part: Part, camera: Camera, low: float, high: float) -> bool:
    """Bounds first, since most parts are nowhere near; then whether there is a triangle that no plane of the region
    separates from it, which near its edges may be one that misses it."""
    to_camera = np.linalg.inv(_without_scale(camera.to_world)) @ part.to_world
    positions = part.mesh.positions
    corners = np.array(np.meshgrid(*np.stack([positions.min(axis=0), positions.max(axis=0)], axis=1))).reshape(3, -1).T
    if not _is_inside(_moved(corners, to_camera)[None], camera, low, high).any():
        return False
    return bool(_is_inside(_moved(positions, to_camera)[part.mesh.triangles], camera, low, high).any())


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
