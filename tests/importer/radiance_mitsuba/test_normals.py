"""Normals of Mitsuba's surfaces in pictures: smooth ones, flat ones, and normal maps under a sun."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_rays as rays
import mitsuba_xml as xml
from mitsuba_exhibits import obj_square
from mitsuba_scenes import png
from mitsuba_xml import rgb, twosided
from rendering import RadianceTest, Source

RHO = np.array((0.6, 0.3, 0.1))
VIEW: list[rays.Step] = [("lookat", (0, 0, 5, 0, 0, 0, 0, 1, 0))]
NORMAL = np.array((200, 165, 230))
_SUN = np.array((0.3, -0.25, -1.0)) / np.linalg.norm((0.3, -0.25, -1.0))
SQUARES: dict[str, tuple[str, list[rays.Step]]] = {
    "rectangle": ("rectangle", []), "turned": ("rectangle", [("rotate", (0.2, 0.1, 1, 70))]),
    "mirrored": ("rectangle", [("scale", (-1, 1, 1)), ("rotate", (0.2, 0.1, 1, 20))]), "obj": ("obj", [])}


# Its ridge is the y axis, and its sides fall by 45 degrees.
ROOF = "v 0 -1 0\nv 0 1 0\nv 1 -1 -1\nv 1 1 -1\nv -1 -1 -1\nv -1 1 -1\nf 1 3 4 2\nf 1 2 6 5\n"


def normal_maps() -> str:
    texture = f'<texture type="bitmap" name="normalmap">{xml.yes("raw")}{xml.word("filename", "normal.png")}</texture>'
    bsdf = twosided("normalmap", f'{texture}<bsdf type="diffuse">{rgb("reflectance", RHO)}</bsdf>')
    text = (xml.path(2) + xml.sensor("orthographic", VIEW, 16, 16) + '<emitter type="directional"><vector '
            f'name="direction" value="{", ".join(map(str, _SUN))}"/>{rgb("irradiance", 2)}</emitter>')
    for index, (kind, steps) in enumerate(SQUARES.values()):
        place = rays.steps_xml([*steps, ("scale", (0.4, 0.4, 0.4)), ("translate", (index % 2 - 0.5, 0.5 - index // 2, 0))])
        text += f'<shape type="{kind}">{xml.word("filename", "square.obj") if kind == "obj" else ""}{place}{bsdf}</shape>'
    return xml.scene("3.0.0", text)


def roof(version: str, inside: str = "") -> str:
    shape = f'<shape type="obj">{xml.word("filename", "roof.obj")}{inside}{xml.matt(rgb("reflectance", RHO))}</shape>'
    return xml.scene(version, xml.sensor("orthographic", VIEW, 16, 4) + '<emitter type="constant"/>' + shape)


class NormalsTest(RadianceTest):
    KEYS = {"frames": 64}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        files = {"normal.png": png([[tuple(NORMAL.tolist())] * 2] * 2), "square.obj": obj_square(), "roof.obj": ROOF}
        return {"maps": Source(normal_maps(), files), "smooth": Source(roof("3.0.0"), files),
                "flat": Source(roof("3.0.0", xml.yes("face_normals")), files), "old": Source(roof("0.6.0"), files),
                "creased": Source(roof("0.6.0", xml.number("max_smooth_angle", 30)), files)}

    def test_a_roof(self) -> None:
        """Without normals in the file, the ridge has the mean of both sides, and between ridge and eaves normals go from it
        to the side's own (Mesh::recompute_vertex_normals). Sides at an angle above max_smooth_angle stay flat."""
        x = np.broadcast_to((2 * (np.arange(16) + 0.5) / 16 - 1), (4, 16))
        side = np.stack([np.sign(x) / np.sqrt(2), 0 * x, np.full_like(x, np.sqrt(0.5))], axis=-1)
        smooth = (1 - abs(x))[..., None] * (0, 0, 1) + abs(x)[..., None] * side
        smooth /= np.linalg.norm(smooth, axis=-1, keepdims=True)
        for name, expected in (("smooth", smooth), ("old", smooth), ("flat", side), ("creased", side)):
            with self.subTest(name):
                self.assert_near(self.pictures[name].normal, expected, 1e-4, "the normal")

    def test_normal_maps(self) -> None:
        """The normal's x runs along u, its y along the cross product of the surface's normal and that (NormalMap::frame)."""
        x, y, z = 2 * NORMAL / 255 - 1
        picture = self.pictures["maps"]
        for index, (name, (_, steps)) in enumerate(SQUARES.items()):
            matrix = rays.steps_matrix(steps)[:3, :3]
            along, normal = matrix @ (1, 0, 0), np.linalg.inv(matrix).T @ (0, 0, 1)
            shading = x * along + y * np.cross(normal, along) + z * normal
            cosine = -shading @ _SUN / np.linalg.norm(shading)
            row, column = (index // 2) * 8, (index % 2) * 8
            with self.subTest(name):
                region = picture.radiance[row + 3:row + 5, column + 3:column + 5]
                self.assert_near(region, RHO / np.pi * 2 * cosine, 3e-3)


if __name__ == "__main__":
    unittest.main()
