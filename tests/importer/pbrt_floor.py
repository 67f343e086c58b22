"""A matt floor under a light of pbrt, and the irradiance that lights have in closed form (lights.cpp; pbr-book, chapter 12).

The camera is nearer to the floor than the lamps, so that it does not see them."""

from __future__ import annotations

import math
from typing import Callable

import numpy as np

from pbrt_rendering import film, numbers, quad, scene
from rendering import Source

SIZE = 12
RHO = np.array([0.8, 0.5, 0.25])
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear sRGB (IEC 61966-2-1)
CHORDS = 1.5e-3  # relative: round lamps are triangles, whose area is smaller by up to 5e-4, and a pixel is 4 x 4 points
Irradiance = Callable[[np.ndarray], np.ndarray]  # of points on the floor, (..., 2); (..., 3)


def floor_under(world: str, version: int = 4, more_film: str = "", more_camera: str = "", bounces: int = 1,
                is_mirrored: bool = False) -> Source:
    """`is_mirrored`: as pbrt has it without Scale -1 1 1, so that x runs to the left."""
    kind, role = ("diffuse", "reflectance") if version == 4 else ("matte", "Kd")
    floor = f'Material "{kind}" "rgb {role}" [{numbers(RHO)}]\n' + quad(((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)))
    black = f'Material "{kind}" "rgb {role}" [0 0 0]\n'
    before = (("" if is_mirrored else "Scale -1 1 1\n") + "LookAt 0 0 .1  0 0 0  0 1 0\n"
              f'Camera "orthographic" {more_camera}\n' + film(SIZE, SIZE, version, more_film))
    return Source(scene(before, floor + black + world, bounces, version))


def floor_points() -> np.ndarray:
    """(height, width, 16, 2): points of each pixel."""
    at = (np.arange(4 * SIZE) + 0.5) / (2 * SIZE) - 1
    x, y = np.meshgrid(at, -at)
    points = np.stack([x, y], axis=2).reshape(SIZE, 4, SIZE, 4, 2)
    return points.transpose(0, 2, 1, 3, 4).reshape(SIZE, SIZE, 16, 2)


def seen(irradiance: Irradiance) -> np.ndarray:
    return RHO / math.pi * irradiance(floor_points()).mean(axis=2)


def _to(points: np.ndarray, place: object) -> tuple[np.ndarray, np.ndarray]:
    """Distance squared from the floor to a place, and the cosine at the floor."""
    apart = np.asarray(place, float) - np.concatenate([points, np.zeros_like(points[..., :1])], axis=-1)
    squared = (apart ** 2).sum(axis=-1)
    return squared, apart[..., 2] / np.sqrt(squared)


def point(place: object, intensity: object) -> Irradiance:
    def irradiance(points: np.ndarray) -> np.ndarray:
        squared, cosine = _to(points, place)
        return (cosine / squared)[..., None] * np.asarray(intensity, float)
    return irradiance


def evenly(values: object) -> Irradiance:
    return lambda points: np.broadcast_to(np.asarray(values, float), (*points.shape[:-1], 3))


def ball(centre: object, radius: float, radiance: object) -> Irradiance:
    """pi L sin^2 cos of what is wholly above the horizon."""
    def irradiance(points: np.ndarray) -> np.ndarray:
        squared, cosine = _to(points, centre)
        return (math.pi * radius ** 2 / squared * cosine)[..., None] * np.asarray(radiance, float)
    return irradiance


def polygon(corners: object, radiance: object) -> Irradiance:
    """Lambert's formula: half the sum over edges of their angle times the cosine of the normal of edge and point."""
    corners = np.asarray(corners, float)

    def irradiance(points: np.ndarray) -> np.ndarray:
        from_floor = np.concatenate([points, np.zeros_like(points[..., :1])], axis=-1)
        rays = [corner - from_floor for corner in corners]
        rays = [ray / np.linalg.norm(ray, axis=-1, keepdims=True) for ray in rays]
        total = np.zeros(points.shape[:-1])
        for here, there in zip(rays, rays[1:] + rays[:1]):
            across = np.cross(here, there)
            length = np.linalg.norm(across, axis=-1)
            total += np.arctan2(length, (here * there).sum(axis=-1)) * across[..., 2] / length
        return (np.abs(total) / 2)[..., None] * np.asarray(radiance, float)
    return irradiance


def tube(centre: object, radius: float, half_length: float, radiance: object) -> Irradiance:
    """By quadrature; along x, seen from outside."""
    angle = 2 * math.pi * (np.arange(128) + 0.5) / 128
    along = half_length * ((np.arange(32) + 0.5) / 16 - 1)
    normals = np.stack([np.zeros_like(angle), np.cos(angle), np.sin(angle)], axis=1)
    area = 2 * half_length / 32 * 2 * math.pi * radius / 128

    def irradiance(points: np.ndarray) -> np.ndarray:
        total = np.zeros(points.shape[:-1])
        for normal in normals:
            for x in along:
                place = np.asarray(centre, float) + radius * normal + (x, 0, 0)
                squared, cosine = _to(points, place)
                there = ((points[..., 1] - place[1]) * normal[1] - place[2] * normal[2]) / np.sqrt(squared)
                total += np.maximum(there, 0) * cosine / squared * area
        return total[..., None] * np.asarray(radiance, float)
    return irradiance
