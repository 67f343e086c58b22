"""Normal maps from the frame of Mitsuba and pbrt-v4 into glTF's.

In all of them x runs along u. Theirs has the cross product of the normal and x for y (Mitsuba: NormalMap::frame; pbrt:
NormalMap, Frame::FromXZ); glTF's y runs against v. Where u, v and the normal are right-handed, v being that of `Mesh`, these
are opposite to each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from importer.scene import Image, Material, Mesh


class NormalMaps:
    """Each material has its map as it is for some meshes, and with y turned round for others."""

    def __init__(self) -> None:
        self._materials: dict[int, tuple[Material, Material]] = {}  # by id: the material and its other self
        self._images: dict[int, tuple[Image, Image]] = {}
        self._handedness: dict[int, tuple[Mesh, bool]] = {}

    def suited(self, material: Material, mesh: Mesh, is_mirrored: bool) -> Material:
        if not material.normal_map or mesh.uvs is None or self._is_right_handed(mesh) == is_mirrored:
            return material
        if id(material) not in self._materials:
            texture = replace(material.normal_map, image=self._turned(material.normal_map.image))
            self._materials[id(material)] = material, replace(material, normal_map=texture)
        return self._materials[id(material)][1]

    def _is_right_handed(self, mesh: Mesh) -> bool:
        """Of most of the mesh's area in texture space: counter-clockwise there as on its front."""
        if id(mesh) not in self._handedness:
            assert mesh.uvs is not None
            a, b, c = (mesh.uvs[mesh.triangles[:, k]] for k in range(3))
            e, f = b - a, c - a
            self._handedness[id(mesh)] = mesh, float((e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]).sum()) > 0
        return self._handedness[id(mesh)][1]

    def _turned(self, image: Image) -> Image:
        if id(image) not in self._images:
            pixels = image.pixels.copy()
            pixels[:, :, 1] = (255 if pixels.dtype == np.uint8 else 1.0) - pixels[:, :, 1]
            self._images[id(image)] = image, Image(f"{image.name}, y turned round", pixels)
        return self._images[id(image)][1]
