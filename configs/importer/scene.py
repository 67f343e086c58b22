"""A scene as both formats are read into it and as the .glb is written from it. Conventions are those of glTF 2.0:
right-handed, linear sRGB colours, texture rows from the top; lengths in the source's unit."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Sequence

import numpy as np

Rgb = tuple[float, float, float]
WHITE: Rgb = (1.0, 1.0, 1.0)
BLACK: Rgb = (0.0, 0.0, 0.0)


@dataclass(eq=False)
class Mesh:
    """Triangles in the object's own space. The front of a triangle, where its light leaves it, is where its corners
    run counter-clockwise; a mirroring `Part.to_world` does not change which side that is (glTF 2.0, 3.7.4)."""

    positions: np.ndarray  # (n, 3) float64
    triangles: np.ndarray  # (m, 3) int64
    normals: np.ndarray | None = None  # (n, 3) float64, unit; None: flat triangles
    uvs: np.ndarray | None = None  # (n, 2) float64, v downwards: row 0 of an image is at v = 0
    name: str = ""


class Wrap(Enum):
    REPEAT = 10497
    MIRRORED = 33648
    CLAMP = 33071


@dataclass(eq=False)
class Image:
    """Pixels and, where a file can go into the .glb as it is, that file's bytes."""

    name: str
    pixels: np.ndarray  # (height, width, 3 or 4) uint8 in sRGB, or floats in linear colours, all in [0, 1]
    encoded: bytes | None = None  # the PNG or JPEG that `pixels` were read from, unchanged
    mime_type: str = "image/png"  # of `encoded`


@dataclass(frozen=True, eq=False)
class Texture:
    """Times `scale`; alpha is used by `Material.opacity` alone, which reads the mean of R, G and B of its own texture."""

    image: Image
    image_from_uv: np.ndarray = field(default_factory=lambda: np.eye(3)[:2])  # (2, 3) on (u, v, 1), v downwards
    wrap: tuple[Wrap, Wrap] = (Wrap.REPEAT, Wrap.REPEAT)
    is_nearest: bool = False
    scale: Rgb = WHITE


Colour = Rgb | Texture
Number = float | Texture  # of a texture: the mean of its R, G and B, linear


@dataclass(eq=False)
class Material:
    """What glTF 2.0 says with its extensions; `configs/importer/materials` makes them of the sources' models."""

    name: str
    base_colour: Colour = (0.5, 0.5, 0.5)
    metallic: float = 0.0
    roughness: Number = 1.0  # the square root of the microfacets' alpha; below 0.005 a mirror
    specular: Number = 0.0  # strength of the dielectric lobe, its F90; 0: Lambert
    specular_colour: Colour = WHITE  # times F0 of the index
    ior: float = 1.5  # 1 or more, or 0: F0 of 1 times specular_colour
    transmission: Number = 0.0
    is_thin: bool = True  # what passes goes on straight; else the closed mesh bounds a volume of this index
    attenuation_colour: Rgb = WHITE  # what is left of white after `attenuation_distance` in the volume
    attenuation_distance: float | None = None
    clearcoat: Number = 0.0
    clearcoat_roughness: float = 0.0
    opacity: Number = 1.0  # below 1: alphaMode BLEND
    radiance: Colour = BLACK  # a texture's `scale` may be above 1
    emits_both_sides: bool = False
    normal_map: Texture | None = None  # tangent space, glTF's: +y of the normal along -v of the image


@dataclass(eq=False)
class Part:
    name: str
    mesh: Mesh  # may be shared by parts
    material: Material
    to_world: np.ndarray = field(default_factory=lambda: np.eye(4))  # (4, 4), affine


@dataclass
class Camera:
    """At the origin it looks along -z with +y up and +x to the right. Where `to_world` mirrors (as the left-handed
    scenes of pbrt have it), the writer mirrors the world and not the camera."""

    to_world: np.ndarray  # (4, 4); scales are taken out by the writer
    vertical_fov: float | None = None  # degrees, of the whole picture; None: orthographic
    half_height: float = 1.0  # of an orthographic picture
    width: int = 512
    height: int = 512


class LightKind(Enum):
    POINT = "point"
    SPOT = "spot"
    DIRECTIONAL = "directional"


@dataclass
class Light:
    """Without a surface. Intensity per steradian of points and spots, irradiance of what faces it of directional ones."""

    name: str
    kind: LightKind
    intensity: Rgb
    position: Sequence[float] = (0.0, 0.0, 0.0)  # world
    direction: Sequence[float] = (0.0, 0.0, -1.0)  # world, along which it shines
    inner_cone: float = 0.0  # radians from the axis
    outer_cone: float = np.pi / 4


@dataclass(eq=False)
class Sky:
    """Light from outside: of one radiance, or an image in latitude and longitude. At `to_world` = 1 the image's top is
    +y, its middle -z and its right half +x (engine/scene/lights.h)."""

    radiance: Rgb = BLACK  # where there is no image
    image: np.ndarray | None = None  # (height, width, 3) float32, times scale
    scale: Rgb = WHITE
    to_world: np.ndarray = field(default_factory=lambda: np.eye(3))  # orthogonal; may mirror


@dataclass
class Scene:
    name: str
    camera: Camera
    parts: list[Part] = field(default_factory=list)
    lights: list[Light] = field(default_factory=list)
    sky: Sky = field(default_factory=Sky)
    max_bounces: int | None = None  # None: the source sets no limit
    source_version: str = ""  # of the format, as "0.6.0" or "4"
