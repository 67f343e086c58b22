"""Translations and rotations as 4 x 4 matrices on column vectors, as both formats have them."""

from __future__ import annotations

import numpy as np

from importer.problems import ImportProblem


def translation(offset: np.ndarray) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def rotation(axis: np.ndarray, degrees: float, where: str) -> np.ndarray:
    """About an axis by the right-hand rule, by Rodrigues' formula."""
    length = float(np.linalg.norm(axis))
    if length == 0:
        raise ImportProblem(f"{where}: the axis of a rotation is 0 0 0; it must have a length")
    x, y, z = axis / length
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross
    return matrix
