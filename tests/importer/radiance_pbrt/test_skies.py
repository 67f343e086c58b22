"""pbrt's infinite lights with images, direction by direction: what a camera sees of each, and what they make of a floor.

In both versions a direction w of the world is taken to the light's own space. There v3 looks its image up at
(phi / 2 pi, theta / pi), theta from +z and phi from +x to +y (InfiniteAreaLight::Le), and v4 in the octahedral square of
equal areas (ImageInfiniteLight::Le; pbr-book, 3.8.3). Row 0 of the file is at 0 in both."""

from __future__ import annotations

import math
import sys
import unittest
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from pbrt_rendering import View, attributes, film, look_at, numbers, quad, scene, tangent
from rendering import RadianceTest, Source

_SIZE, _FOV = 20, 100.0
_BLOCKS, _TEXELS = (4, 8), 16  # of an image of v3, in rows and columns, and texels along their sides; v4 has 4 x 4
# Within it of a block's border, as a share of the block, neighbouring texels are blended: by the tracer, and in v4 by the
# importer, which turns the square into latitudes and longitudes.
_BLENDED = 0.12
_RNG = np.random.default_rng(3)
_VALUES = _RNG.uniform(0.1, 4, (*_BLOCKS, 3)).round(2)


def _pfm(pixels: np.ndarray) -> bytes:
    """Rows from the bottom, as the format has them."""
    return f"PF\n{pixels.shape[1]} {pixels.shape[0]}\n-1.0\n".encode() + pixels[::-1].astype("<f4").tobytes()


def _blocks(version: int) -> np.ndarray:
    return _VALUES if version == 3 else _VALUES[:, :4]


def _image(version: int) -> bytes:
    return _pfm(np.kron(_blocks(version), np.ones((_TEXELS, _TEXELS, 1))))


def _square(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The octahedral map: r = sqrt(1 - |z|) from the pole, shared by the angle between |x| and |y|; the lower half is folded
    over the diagonals."""
    r = np.sqrt(np.maximum(0.0, 1 - np.abs(w[..., 2])))
    share = np.arctan2(np.abs(w[..., 1]), np.abs(w[..., 0])) / (math.pi / 2)
    x, y = r * (1 - share), r * share
    x, y = np.where(w[..., 2] < 0, 1 - y, x), np.where(w[..., 2] < 0, 1 - x, y)
    return (np.copysign(x, w[..., 0]) + 1) / 2, (np.copysign(y, w[..., 1]) + 1) / 2


def _angles(w: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    turn = np.arctan2(w[..., 1], w[..., 0]) % (2 * math.pi)
    return turn / (2 * math.pi), np.arccos(np.clip(w[..., 2], -1, 1)) / math.pi


def _seen(directions: np.ndarray, version: int) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of blocks, row by row, and whether directions are well within them."""
    rows, columns = _blocks(version).shape[:2]
    s, t = (_square if version == 4 else _angles)(directions / np.linalg.norm(directions, axis=-1, keepdims=True))
    row, column = np.minimum((t * rows).astype(int), rows - 1), np.minimum((s * columns).astype(int), columns - 1)
    inside = np.maximum(np.abs(t * rows - row - 0.5), np.abs(s * columns - column - 0.5)) < 0.5 - _BLENDED
    return row * columns + column, inside


@dataclass(frozen=True)
class Sky:
    """Statements before the light and before the camera; `from_world`: rows take a direction to the light's space."""

    version: int
    place: tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]
    turn: str = ""
    from_world: tuple[tuple[float, ...], ...] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
    is_mirrored: bool = False  # the camera, by Scale -1 1 1
    scale: float = 1.0

    @property
    def view(self) -> View:
        half = tangent(_FOV / 2)
        seen = look_at(*self.place, half, half, _SIZE, _SIZE)
        return replace(seen, right=-np.asarray(seen.right)) if self.is_mirrored else seen


_UP_Z, _UP_Y = (0, 0, 1), (0, 1, 0)
_COS, _SIN = math.cos(math.radians(40)), math.sin(math.radians(40))


def _cases() -> dict[str, Sky]:
    ahead = {"x": ((0, 0, 0), (1, 0, 0), _UP_Z), "back": ((0, 0, 0), (-1, -1, 0.3), _UP_Z),
             "up": ((0, 0, 0), (0, 0, 1), _UP_Y), "down": ((0, 0, 0), (0.1, 0, -1), _UP_Y)}
    cases = {f"v{version}-{name}": Sky(version, place) for version in (3, 4) for name, place in ahead.items()}
    for version in (3, 4):
        cases |= {
            f"v{version}-mirrored-camera": Sky(version, ahead["back"], is_mirrored=True),
            # The light's +z points along +y, as scenes with y up have it: Rotate takes (x, y, z) to (x, z, -y).
            f"v{version}-y-up": Sky(version, ((0, 0, 0), (1, 0.4, -1), _UP_Y), "Rotate -90 1 0 0",
                                    ((1, 0, 0), (0, 0, -1), (0, 1, 0)), scale=0.5),
            f"v{version}-turned": Sky(version, ahead["x"], "Rotate 40 0 0 1", ((_COS, _SIN, 0), (-_SIN, _COS, 0), (0, 0, 1)),
                                      is_mirrored=True),
            f"v{version}-mirrored": Sky(version, ahead["x"], "Scale 1 -1 1", ((1, 0, 0), (0, -1, 0), (0, 0, 1))),
            # First turned about x (the last statement), then about z.
            f"v{version}-tilted": Sky(version, ahead["x"], "Rotate 40 0 0 1\nRotate 90 1 0 0",
                                      ((_COS, _SIN, 0), (0, 0, 1), (_SIN, -_COS, 0))),
        }
    return cases


def _light(sky: Sky) -> str:
    if sky.version == 4:
        return f'LightSource "infinite" "string filename" "sky.pfm" "float scale" {sky.scale}'
    return f'LightSource "infinite" "string mapname" "sky.pfm" "rgb scale" [{numbers([sky.scale] * 3)}]'


def _source(sky: Sky) -> Source:
    before = (("Scale -1 1 1\n" if sky.is_mirrored else "") + f"LookAt {numbers(sky.place)}\n"
              f'Camera "perspective" "float fov" {_FOV}\n' + film(_SIZE, _SIZE, sky.version))
    behind = np.asarray(sky.view.eye) - 50 * np.asarray(sky.view.ahead)  # a scene has a surface
    card = quad([behind, behind + sky.view.right, behind + np.add(sky.view.right, sky.view.up), behind + sky.view.up])
    return Source(scene(before, attributes(sky.turn, _light(sky)) + card, 0, sky.version), {"sky.pfm": _image(sky.version)})


class Skies(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 4}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {name: _source(sky) for name, sky in _cases().items()}

    def test_each_direction_has_its_radiance(self) -> None:
        at = np.arange(_SIZE)[:, None] + (0, 0.5, 1)
        for name, sky in _cases().items():
            rays = sky.view.direction(at[None, :, None, :], at[:, None, :, None]).reshape(-1, 9, 3)
            blocks, inside = _seen(rays @ np.array(sky.from_world).T, sky.version)
            where = inside.all(axis=1) & (np.ptp(blocks, axis=1) == 0)
            expected = sky.scale * _blocks(sky.version).reshape(-1, 3)[blocks[where, 0]]
            with self.subTest(name):
                self.assertGreater(len(set(blocks[where, 0])), 3)
                self.assertGreater(where.sum(), 40)
                seen = self.pictures[name].radiance.reshape(-1, 3)[where]
                self.assert_near(seen, expected, 5e-3 * expected, name)


class Floors(RadianceTest):
    """A white floor that faces +z: the sum over the image of radiance, cosine and solid angle. In v4 each pixel has 4 pi / n
    steradians; in v3 a row has the difference of its cosines."""

    EXTENSION = ".pbrt"
    KEYS = {"frames": 256}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        def floor(light: str, version: int) -> Source:
            kind, role = ("diffuse", "reflectance") if version == 4 else ("matte", "Kd")
            before = 'Scale -1 1 1\nLookAt 0 0 1  0 0 0  0 1 0\nCamera "orthographic"\n' + film(8, 8, version)
            world = (light + f'\nMaterial "{kind}" "rgb {role}" [1 1 1]\n'
                     + quad(((-2, -2, 0), (2, -2, 0), (2, 2, 0), (-2, 2, 0))))
            return Source(scene(before, world, 1, version), {"sky.pfm": _image(version)})
        return {"v3": floor('LightSource "infinite" "string mapname" "sky.pfm"', 3),
                "v4": floor('LightSource "infinite" "string filename" "sky.pfm"', 4),
                "v4-lux": floor('LightSource "infinite" "string filename" "sky.pfm" "float illuminance" 7', 4)}

    def _check(self, name: str, irradiance: np.ndarray, allowed: float) -> None:
        expected = irradiance / math.pi
        self.assert_radiance(self.pictures[name], expected, allowed * expected, name)

    @staticmethod
    def _of_version_4() -> np.ndarray:
        """The centre of a pixel of the upper half is 1 - r^2 high, r being |x| + |y| from the square's middle."""
        pixels = np.kron(_blocks(4), np.ones((_TEXELS, _TEXELS, 1)))
        side = np.abs((np.arange(pixels.shape[0]) + 0.5) / pixels.shape[0] * 2 - 1)
        r = side[:, None] + side
        height = np.where(r < 1, 1 - r ** 2, 0)
        return (pixels * height[..., None]).sum(axis=(0, 1)) * 4 * math.pi / height.size

    def test_version_3(self) -> None:
        edges = np.cos(np.arange(3) * math.pi / 4)
        projected = (edges[:-1] ** 2 - edges[1:] ** 2) / 2 * 2 * math.pi / 8  # the integral of cos sin over a block
        self._check("v3", (_VALUES[:2] * projected[:, None, None]).sum(axis=(0, 1)), 0.01)

    def test_version_4(self) -> None:
        self._check("v4", self._of_version_4(), 0.01)

    def test_illuminance_of_version_4(self) -> None:
        """The light's scale is 7 over the image's own, by luminance (ImageInfiniteLight in Light::Create)."""
        own = self._of_version_4()
        self._check("v4-lux", own * 7 / (own @ (0.2126, 0.7152, 0.0722)), 0.01)


if __name__ == "__main__":
    unittest.main()
