"""The source's world in the .glb's: one rotation or mirroring of all there is, so that the picture stays the same.

Neither a camera of glTF nor one here can mirror, and a sky can turn about +y alone. Both are met without loss: the world is
mirrored where the camera was, as the left-handed scenes of pbrt have it, and turned until the sky's pole is +y."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from importer.problems import ImportProblem
from importer.scene import Camera, Scene, Sky

_MIRROR = np.diag([-1.0, 1.0, 1.0])
_UP = np.array([0.0, 1.0, 0.0])
FLOAT_MAX = float(np.finfo(np.float32).max)  # what reads the .glb counts in single precision
_ROUNDING = 1e-6  # of products of a few rotations that a text file gives to seven digits


@dataclass
class World:
    """`turn`: (3, 3), orthogonal; from the source's world to the file's. The rest says how the sky lies in the latter."""

    turn: np.ndarray
    sky_degrees: float  # about +y, as the config's key `rotation`
    is_sky_flipped: bool  # its columns run the other way

    def place(self, to_world: np.ndarray) -> np.ndarray:
        whole = np.eye(4)
        whole[:3, :3] = self.turn
        return whole @ to_world


def _turned_upright(pole: np.ndarray) -> np.ndarray:
    """The shortest rotation of a unit vector to +y (Moller and Hughes 1999); a half turn about z of one along -y."""
    cosine = float(pole @ _UP)
    if cosine < -1 + 1e-12:
        return np.diag([-1.0, -1.0, 1.0])
    axis = np.cross(pole, _UP)
    skew = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + skew + skew @ skew / (1 + cosine)


def check_single(values: np.ndarray, what: str) -> None:
    greatest = float(np.abs(values).max(initial=0))
    if not greatest <= FLOAT_MAX:  # of NaN, too
        raise ImportProblem(f"{what} reaches {greatest:g}; numbers that single precision holds would be right")


def check_affine(matrix: np.ndarray, where: str) -> None:
    if not np.isfinite(matrix).all():
        raise ImportProblem(f"{where}: its transform holds no finite numbers; finite ones would be right")
    check_single(matrix, f"{where}: its transform")
    if (np.abs(matrix[3] - (0, 0, 0, 1)) > (1e-9, 1e-9, 1e-9, 1e-5)).any():
        raise ImportProblem(f"{where}: its transform's last row is {matrix[3].tolist()}; 0 0 0 1 would be right")


def _is_mirroring(camera: Camera) -> bool:
    check_affine(camera.to_world, "camera")
    volume = float(np.linalg.det(camera.to_world[:3, :3]))
    if volume == 0:
        raise ImportProblem("camera: its transform is singular; one with an inverse would be right")
    return volume < 0


def _checked(sky: Sky) -> np.ndarray:
    """A scale is no part of a direction."""
    turn = np.asarray(sky.to_world, float)
    scale = np.linalg.norm(turn, axis=0).mean()
    turn = turn / scale if 0 < scale < np.inf else turn
    if not np.allclose(turn @ turn.T, np.eye(3), atol=1e-4):
        raise ImportProblem("environment light: its transform shears or stretches; a rotation would be right")
    return turn


def world_of(scene: Scene) -> World:
    turn = _MIRROR if _is_mirroring(scene.camera) else np.eye(3)
    if scene.sky.image is None:
        return World(turn, 0.0, False)
    sky = turn @ _checked(scene.sky)
    is_flipped = bool(np.linalg.det(sky) < 0)
    if is_flipped:
        sky = sky @ _MIRROR
    if np.abs(sky @ _UP - _UP).max() > _ROUNDING:
        upright = _turned_upright(sky @ _UP)
        turn, sky = upright @ turn, upright @ sky
    return World(turn, math.degrees(math.atan2(sky[0, 2], sky[2, 2])), is_flipped)
