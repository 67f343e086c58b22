"""Cameras and lights without a surface as glTF's nodes."""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np

from importer.output.world import FLOAT_MAX, World, check_single
from importer.problems import ImportProblem
from importer.scene import Camera, Light, LightKind

_MOST_INTENSITY = 1e12  # of the reader (engine/gltf/light.cpp)
_SHARP = 0.999  # of the outer cone: where a source has a sharp edge, glTF wants the inner cone to be smaller


def matrix_json(matrix: np.ndarray) -> dict[str, list[float]]:
    """A node's property, column by column; none where it is the default."""
    if np.array_equal(matrix, np.eye(4)):
        return {}
    return {"matrix": [float(x) + 0.0 for x in matrix.T.ravel()]}


def _frame(back: np.ndarray, up: np.ndarray) -> np.ndarray:
    """(3, 3): x to the right, y up, z back, of unit length and at right angles."""
    back = back / np.linalg.norm(back)
    right = np.cross(up, back)
    right = right / np.linalg.norm(right)
    return np.stack([right, np.cross(back, right), back], axis=1)


def _lens(camera: Camera, far: float) -> dict[str, Any]:
    """The file must say where the picture starts, and qtrace warns of what is nearer; so it starts at next to nothing."""
    aspect = camera.width / camera.height
    if camera.vertical_fov is not None:
        if not 0 < camera.vertical_fov < 180:
            raise ImportProblem(f"camera: its vertical field of view is {camera.vertical_fov:g} degrees; "
                                f"an angle between 0 and 180 would be right")
        return {"type": "perspective", "perspective": {
            "aspectRatio": aspect, "yfov": math.radians(camera.vertical_fov), "znear": 1e-6 * far}}
    if not 0 < camera.half_height * max(aspect, 1.0) <= FLOAT_MAX:
        raise ImportProblem(f"camera: half its picture's height is {camera.half_height:g}; a length above 0 would be right")
    return {"type": "orthographic", "orthographic": {
        "xmag": aspect * camera.half_height, "ymag": camera.half_height, "znear": 0.0, "zfar": far}}


def camera_json(camera: Camera, world: World, corners: np.ndarray) -> tuple[dict[str, Any], dict[str, Any]]:
    """The camera and its node; `corners`: (n, 3), around all there is in the file's world."""
    if not (camera.width >= 1 and camera.height >= 1):
        raise ImportProblem(f"camera: its picture is {camera.width} x {camera.height}; 1 x 1 or more would be right")
    to_world = world.place(camera.to_world)
    frame = np.eye(4)
    frame[:3, :3] = _frame(to_world[:3, 2], to_world[:3, 1])
    frame[:3, 3] = to_world[:3, 3]
    far = 2 * float(np.linalg.norm(corners - frame[:3, 3], axis=1).max()) if len(corners) else 1.0
    return {"name": "camera", **_lens(camera, far or 1.0)}, {"name": "camera", **matrix_json(frame), "camera": 0}


def _vector(light: Light, what: str, values: Sequence[float]) -> np.ndarray:
    vector = np.asarray(values, float)
    if vector.shape != (3,) or not np.isfinite(vector).all():
        raise ImportProblem(f"light {light.name}: its {what} is {list(values)}; three finite numbers would be right")
    return vector


def _node(light: Light, world: World, index: int) -> dict[str, Any]:
    node: dict[str, Any] = {"name": light.name, "extensions": {"KHR_lights_punctual": {"light": index}}}
    matrix = np.eye(4)
    if light.kind is not LightKind.DIRECTIONAL:
        matrix[:3, 3] = world.turn @ _vector(light, "position", light.position)
        check_single(matrix, f"light {light.name}: its position")
    if light.kind is not LightKind.POINT:
        back = -world.turn @ _vector(light, "direction", light.direction)
        if not back.any():
            raise ImportProblem(f"light {light.name}: its direction is (0, 0, 0); one with a length would be right")
        back = back / np.abs(back).max()  # whose length may be more than numbers hold
        matrix[:3, :3] = _frame(back, np.eye(3)[int(np.argmin(np.abs(back)))])
    return {**node, **matrix_json(matrix)}


def lights_json(lights: Sequence[Light], world: World) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Those that shine, and their nodes."""
    said, nodes = [], []
    for light in lights:
        intensity = _vector(light, "intensity", light.intensity)
        most = float(intensity.max())
        if intensity.min() < 0 or most > _MOST_INTENSITY:
            raise ImportProblem(f"light {light.name}: its intensity is {intensity.tolist()}; "
                                f"numbers from 0 to {_MOST_INTENSITY:g} would be right")
        if most == 0:
            continue
        entry: dict[str, Any] = {"name": light.name, "type": light.kind.value, "color": (intensity / most).tolist(),
                                 "intensity": most}
        if light.kind is LightKind.SPOT:
            entry["spot"] = _cones(light)
        nodes.append(_node(light, world, len(said)))
        said.append(entry)
    return said, nodes


def _cones(light: Light) -> dict[str, float]:
    if not 0 < light.outer_cone <= math.pi / 2 + 1e-6 or light.inner_cone < 0:
        raise ImportProblem(f"light {light.name}: its cones are {light.inner_cone:g} and {light.outer_cone:g}; "
                            f"an inner one from 0 and an outer one up to pi / 2 would be right")
    outer = min(light.outer_cone, math.pi / 2)
    return {"innerConeAngle": min(light.inner_cone, _SHARP * outer), "outerConeAngle": outer}
