"""pbrt's transformations as 4 x 4 matrices on column vectors (pbrt-v4: util/transform.cpp; fileformat-v4)."""

from __future__ import annotations

import numpy as np

from importer.pbrt.source import Place
from importer.problems import ImportProblem


def scaling(factors: np.ndarray, place: Place) -> np.ndarray:
    if (factors == 0).any():
        raise ImportProblem(f"{place}: Scale has a factor of 0; factors must not be 0")
    return np.diag([*factors, 1.0])


def look_at(numbers: np.ndarray, place: Place) -> np.ndarray:
    """From world to camera: the camera looks along +z with +y up, and +x is to its right, which is left-handed
    in a right-handed world (pbrt-v4: LookAt in util/transform.cpp; pbr-book, 3.9.7)."""
    eye, target, up = numbers.reshape(3, 3)
    forward = unit(target - eye)
    right = None if forward is None else unit(np.cross(up, forward))
    if forward is None or right is None:
        raise ImportProblem(f"{place}: LookAt looks at where it stands, or along its up vector; these must differ")
    to_world = np.eye(4)
    to_world[:3, :3] = np.column_stack([right, np.cross(forward, right), forward])
    to_world[:3, 3] = eye
    return np.linalg.inv(to_world)


def from_file(numbers: np.ndarray, place: Place) -> np.ndarray:
    """A matrix as Transform and ConcatTransform have it: column by column. What it may be depends on what it is used for,
    as in pbrt: scenes have flat ones that no shape uses, and projective ones for skies."""
    return numbers.reshape(4, 4).T.copy()


def check_finite(matrix: np.ndarray, place: Place) -> None:
    if not np.isfinite(matrix).all():
        raise ImportProblem(f"{place}: the transformation's numbers grow beyond 64 bits; they must be finite")


def check_usable(matrix: np.ndarray, place: Place) -> None:
    """For what has a place in the world: an affine map that has an inverse."""
    check_finite(matrix, place)
    *projective, one = matrix[3].tolist()
    if max(map(abs, projective)) > 1e-6 * max(1.0, abs(one)) or abs(one - 1.0) > 1e-6 * max(1.0, abs(one)):
        raise ImportProblem(f"{place}: the transformation that holds here is no affine map; its fourth row must be 0 0 0 1")
    scale = float(np.abs(matrix[:3, :3]).max()) or 1.0
    # Written out, since numpy's determinant takes ten times as long and large scenes have 100 thousand statements.
    a, b, c, d, e, f, g, h, i = (matrix[:3, :3] / scale).ravel().tolist()
    if abs(a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)) < 1e-12:
        raise ImportProblem(f"{place}: the transformation that holds here has no inverse; it must not flatten what it"
                            " transforms")


def of_directions(matrix: np.ndarray, place: Place) -> np.ndarray:
    """(3, 3): what takes a sky's directions to the world, the inverse of how pbrt takes those of the world to the sky
    (ImageInfiniteLight::Le by ApplyInverse of a vector), for which a translation and a projective part mean nothing."""
    check_finite(matrix, place)
    try:
        return np.linalg.inv(np.linalg.inv(matrix)[:3, :3])
    except np.linalg.LinAlgError as error:
        raise ImportProblem(f"{place}: the transformation of the sky has no inverse; it must be a rotation") from error


def unit(vector: np.ndarray) -> np.ndarray | None:
    """Of length one; None for a vector without a direction."""
    length = np.linalg.norm(vector)
    return vector / length if length > 0 and np.isfinite(length) else None


def orthogonal_part(matrix: np.ndarray) -> tuple[np.ndarray, bool]:
    """The nearest orthogonal map, which may mirror, and whether the matrix is a multiple of it."""
    left, sizes, right = np.linalg.svd(matrix[:3, :3])
    return left @ right, bool(sizes[2] > (1 - 1e-4) * sizes[0])
