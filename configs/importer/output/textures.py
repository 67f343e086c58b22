"""Images, samplers and textures of a .glb, each once, and how a material refers to them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from importer.output.pixels import Channels, encoded
from importer.scene import Image, Texture
from scenes.glb_file import Buffer

_NEAREST, _LINEAR, _LINEAR_MIPMAP_LINEAR = 9728, 9729, 9987
_IDENTITY = np.eye(3)[:2]


def is_sheared(matrix: np.ndarray) -> bool:
    """Whether KHR_texture_transform, which turns what it has scaled, cannot say it: columns not at right angles."""
    u, v = matrix[:, 0], matrix[:, 1]
    return bool(abs(u @ v) > 1e-6 * np.linalg.norm(u) * np.linalg.norm(v))


def transform_of(matrix: np.ndarray) -> dict[str, Any]:
    """KHR_texture_transform of a matrix that does not shear; the negative sense of its angle is that of the extension's
    words and of viewers (github.com/KhronosGroup/glTF/issues/1563): columns x (c, -s) and y (s, c)."""
    u, v = matrix[:, 0], matrix[:, 1]
    along_u, along_v = np.linalg.norm(u), np.linalg.norm(v)
    cosine, sine = (u[0], -u[1]) / along_u if along_u > 0 else (v[1], v[0]) / along_v if along_v > 0 else (1.0, 0.0)
    angle, scale = math.atan2(sine, cosine), [float(along_u), float(v @ (sine, cosine))]
    if abs(abs(angle) - math.pi) < 1e-12:  # a half turn is two mirrorings, which one reads more easily
        angle, scale = 0.0, [-scale[0], -scale[1]]
    said: dict[str, Any] = {}
    if matrix[:, 2].any():
        said["offset"] = [float(x) for x in matrix[:, 2]]
    if abs(angle) > 1e-12:
        said["rotation"] = angle
    if scale != [1.0, 1.0]:
        said["scale"] = scale
    return said


@dataclass
class Textures:
    """Those of the file so far."""

    buffer: Buffer
    images: list[dict[str, Any]] = field(default_factory=list)
    samplers: list[dict[str, Any]] = field(default_factory=list)
    textures: list[dict[str, int]] = field(default_factory=list)
    uses_transforms: bool = False
    _by_image: dict[tuple[int, Channels], int] = field(default_factory=dict)
    _by_content: dict[bytes, int] = field(default_factory=dict)
    _kept: list[Image] = field(default_factory=list)  # so that no other image gets the identity of one that is known

    def info(self, texture: Texture, channels: Channels, second_uv: np.ndarray | None = None) -> dict[str, Any]:
        """What a material's property is. Where the texture is mapped by `second_uv`, the mesh's second map is it."""
        entry = {"sampler": self._index(self.samplers, _sampler(texture)), "source": self._image(texture.image, channels)}
        info: dict[str, Any] = {"index": self._index(self.textures, entry)}
        if second_uv is not None and np.array_equal(texture.image_from_uv, second_uv):
            return {**info, "texCoord": 1}
        transform = transform_of(np.asarray(texture.image_from_uv, float))
        if transform:
            self.uses_transforms = True
            info["extensions"] = {"KHR_texture_transform": transform}
        return info

    def _image(self, image: Image, channels: Channels) -> int:
        key = (id(image), channels)
        if key not in self._by_image:
            self._kept.append(image)
            data, mime_type = encoded(image, channels)
            if data not in self._by_content:
                self._by_content[data] = len(self.images)
                self.images.append(self.buffer.add_image(image.name, data, mime_type))
            self._by_image[key] = self._by_content[data]
        return self._by_image[key]

    @staticmethod
    def _index(entries: list, entry: dict) -> int:
        if entry not in entries:
            entries.append(entry)
        return entries.index(entry)

    def to_json(self) -> dict[str, Any]:
        parts = {"images": self.images, "samplers": self.samplers, "textures": self.textures}
        return {name: part for name, part in parts.items() if part}


def _sampler(texture: Texture) -> dict[str, int]:
    filters = (_NEAREST, _NEAREST) if texture.is_nearest else (_LINEAR, _LINEAR_MIPMAP_LINEAR)
    return {"magFilter": filters[0], "minFilter": filters[1], "wrapS": texture.wrap[0].value,
            "wrapT": texture.wrap[1].value}
