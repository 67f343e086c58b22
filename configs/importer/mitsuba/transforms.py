"""<transform> as a 4x4 matrix: what comes later in the file is applied later, thus multiplied from the left."""

from __future__ import annotations

import numpy as np

from importer.mitsuba.values import numbers, number, vector
from importer.moves import rotation, translation
from importer.problems import ImportProblem

_ATTRIBUTES = {
    "translate": {"x", "y", "z", "value"},
    "rotate": {"x", "y", "z", "value", "angle"},
    "scale": {"x", "y", "z", "value"},
    "lookat": {"origin", "target", "up"},
    "matrix": {"value"},
}


def step(tag: str, attributes: dict[str, str], is_old: bool, where: str) -> np.ndarray:
    """One element inside of <transform>."""
    if tag not in _ATTRIBUTES:
        raise ImportProblem(f"{where}: does not belong into a <transform>; known are {', '.join(sorted(_ATTRIBUTES))}")
    if unknown := sorted(set(attributes) - _ATTRIBUTES[tag]):
        raise ImportProblem(f"{where}: has no attribute \"{unknown[0]}\"")
    if tag == "translate":
        return translation(vector(attributes, where, 0.0))
    if tag == "scale":
        return np.diag([*vector(attributes, where, 1.0), 1.0])
    if tag == "rotate":
        return rotation(vector(attributes, where, 0.0), number(_needed(attributes, "angle", where), where), where)
    if tag == "lookat":
        return _look_at_step(attributes, is_old, where)
    return _matrix(_needed(attributes, "value", where), where)


def look_at(origin: np.ndarray, target: np.ndarray, up: np.ndarray, where: str) -> np.ndarray:
    """+z to the target, +x to the *left* of it where `up` is up (Transform::lookAt, Transform::look_at)."""
    direction = _unit(target - origin, f"{where}: origin and target are the same point")
    left = _unit(np.cross(up, direction), f"{where}: up is parallel to the direction of sight")
    matrix = np.eye(4)
    matrix[:3] = np.stack([left, np.cross(direction, left), direction, origin], axis=1)
    return matrix


def mirrors(matrix: np.ndarray) -> bool:
    return bool(np.linalg.det(matrix[:3, :3]) < 0.0)


def affine(matrix: np.ndarray, where: str) -> np.ndarray:
    """The matrix, if it keeps parallels parallel, scaled so that its last row is 0 0 0 1."""
    if matrix[3, 3] == 0.0 or np.abs(matrix[3, :3]).max() > 1e-9 * abs(matrix[3, 3]):
        raise ImportProblem(f"{where}: the last row of its matrix must be 0 0 0 1")
    return matrix / matrix[3, 3]


def _look_at_step(attributes: dict[str, str], is_old: bool, where: str) -> np.ndarray:
    points = {}
    for name in ("origin", "target", "up"):
        text = attributes.get(name, "") if name == "up" else _needed(attributes, name, where)
        values = numbers(text, where)
        if len(values) != 3 and not (name == "up" and not values):
            raise ImportProblem(f"{where}: \"{name}\" has {len(values)} numbers; three are right")
        points[name] = np.array(values or [0.0, 0.0, 0.0])
    if not points["up"].any():
        direction = _unit(points["target"] - points["origin"], f"{where}: origin and target are the same point")
        points["up"] = _any_up_old(direction) if is_old else _any_up(direction)
    return look_at(points["origin"], points["target"], points["up"], where)


def _any_up(n: np.ndarray) -> np.ndarray:
    """The first vector of Mitsuba 3's coordinate_system (Duff et al. 2017, "Building an Orthonormal Basis")."""
    sign = np.copysign(1.0, n[2])
    a = -1.0 / (sign + n[2])
    return np.array([1.0 + sign * n[0] * n[0] * a, sign * n[0] * n[1] * a, -sign * n[0]])


def _any_up_old(a: np.ndarray) -> np.ndarray:
    """The first vector of Mitsuba 0.6's coordinateSystem (librender/util.cpp)."""
    if abs(a[0]) > abs(a[1]):
        c = np.array([a[2], 0.0, -a[0]]) / np.hypot(a[0], a[2])
    else:
        c = np.array([0.0, a[2], -a[1]]) / np.hypot(a[1], a[2])
    return np.cross(c, a)


def _matrix(text: str, where: str) -> np.ndarray:
    """Row after row; nine numbers are the linear part."""
    values = numbers(text, where)
    if len(values) == 16:
        return np.array(values).reshape(4, 4)
    if len(values) != 9:
        raise ImportProblem(f"{where}: a matrix has 9 or 16 numbers, not {len(values)}")
    matrix = np.eye(4)
    matrix[:3, :3] = np.array(values).reshape(3, 3)
    return matrix


def _needed(attributes: dict[str, str], name: str, where: str) -> str:
    if name not in attributes:
        raise ImportProblem(f"{where}: \"{name}\" is needed")
    return attributes[name]


def _unit(v: np.ndarray, problem: str) -> np.ndarray:
    length = float(np.linalg.norm(v))
    if length < 1e-12:
        raise ImportProblem(problem)
    return v / length
