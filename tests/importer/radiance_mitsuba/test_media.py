"""Glass that takes up light in pictures, straight through the middle of a ball, by a closed form."""

from __future__ import annotations

import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from rendering import RadianceTest, Source

ABSORPTION = np.array((0.2, 0.5, 1.5))
RADIUS, INDEX = 0.75, 1.5
_MITSUBA = """<scene version="{version}">
  <integrator type="path"><integer name="{depth}" value="60"/></integrator>
  <sensor type="orthographic"><transform name="{to_world}"><scale value="0.02"/>
    <lookat origin="4, 3, 5" target="1, 1, 1" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="4"/><integer name="height" value="4"/><rfilter type="box"/></film></sensor>
  <shape type="sphere"><point name="center" x="1" y="1" z="1"/><float name="radius" value="0.75"/>
    <bsdf type="dielectric"><float name="{int_ior}" value="1.5"/><float name="{ext_ior}" value="1"/></bsdf>
    <medium type="homogeneous" name="interior">{medium}<float name="scale" value="0.5"/></medium></shape>
  <emitter type="constant"><rgb name="radiance" value="1"/></emitter>
</scene>"""
_NAMES_3 = {"version": "3.0.0", "depth": "max_depth", "to_world": "to_world", "int_ior": "int_ior", "ext_ior": "ext_ior",
            "medium": '<rgb name="sigma_t" value="0.4, 1, 3"/><float name="albedo" value="0"/>'}
_NAMES_06 = {"version": "0.6.0", "depth": "maxDepth", "to_world": "toWorld", "int_ior": "intIOR", "ext_ior": "extIOR",
             "medium": '<rgb name="sigmaA" value="0.4, 1, 3"/><rgb name="sigmaS" value="0"/>'}
# The ball is scaled by its transformation, and what its medium takes up on a unit of length is not.
_PBRT = """LookAt 4 3 5  1 1 1  0 1 0
Camera "orthographic" "float screenwindow" [ -0.02 0.02 -0.02 0.02 ]
Film "{film}" "integer xresolution" 4 "integer yresolution" 4
PixelFilter "box"
Integrator "path" "integer maxdepth" 60
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
MakeNamedMedium "ink" "string type" "homogeneous" "rgb sigma_a" [ 0.4 1 3 ] "rgb sigma_s" [ 0 0 0 ] "float scale" 0.5
AttributeBegin
  MediumInterface "ink" ""
  Material "{glass}"
  Translate 1 1 1
  Scale 3 3 3
  Shape "sphere" "float radius" 0.25
AttributeEnd
"""


def straight_through() -> np.ndarray:
    """All around is 1. What enters passes, or turns back at the far side and so on: F + (1 - F)^2 t / (1 - F t)."""
    f = ((INDEX - 1) / (INDEX + 1)) ** 2
    left = np.exp(-ABSORPTION * 2 * RADIUS)
    return f + (1 - f) ** 2 * left / (1 - f * left)


class MitsubaTest(RadianceTest):
    KEYS = {"frames": 256}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {names["version"]: Source(_MITSUBA.format(**names)) for names in (_NAMES_3, _NAMES_06)}

    def test_what_is_left(self) -> None:
        for version, picture in self.pictures.items():
            self.assert_radiance(picture, straight_through(), 2e-3, version)


class PbrtTest(RadianceTest):
    EXTENSION = ".pbrt"
    KEYS = {"frames": 256}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        return {"4": Source(_PBRT.format(film="rgb", glass="dielectric")),
                "3": Source(_PBRT.format(film="image", glass="glass") + "WorldEnd\n")}

    def test_what_is_left(self) -> None:
        for version, picture in self.pictures.items():
            self.assert_radiance(picture, straight_through(), 2e-3, version)


if __name__ == "__main__":
    unittest.main()
