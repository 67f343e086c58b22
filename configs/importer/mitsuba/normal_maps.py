"""Normal maps from Mitsuba's frame into glTF's.

In both x runs along u. Mitsuba's y is the cross product of the normal and x (NormalMap::frame), glTF's runs against v.
Where u, v and the normal are right-handed, these are opposite to each other."""

from __future__ import annotations

import weakref
from dataclasses import replace

import numpy as np

from importer.scene import Image, Mesh, Texture

_turned: weakref.WeakKeyDictionary[Image, Image] = weakref.WeakKeyDictionary()


def suited(texture: Texture, mesh: Mesh, is_mirrored: bool) -> Texture:
    """The map for this mesh: as it is, or with y turned round."""
    if mesh.uvs is None or _is_right_handed(mesh) == is_mirrored:
        return texture
    if texture.image not in _turned:
        _turned[texture.image] = _with_turned_y(texture.image)
    return replace(texture, image=_turned[texture.image])


def _is_right_handed(mesh: Mesh) -> bool:
    """Of most of the mesh's area in texture space: counter-clockwise there as on its front."""
    assert mesh.uvs is not None
    a, b, c = (mesh.uvs[mesh.triangles[:, k]] for k in range(3))
    e, f = b - a, c - a
    return float((e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]).sum()) > 0


def _with_turned_y(image: Image) -> Image:
    pixels = image.pixels.copy()
    pixels[:, :, 1] = (255 if pixels.dtype == np.uint8 else 1.0) - pixels[:, :, 1]
    return Image(f"{image.name}, y turned round", pixels)
