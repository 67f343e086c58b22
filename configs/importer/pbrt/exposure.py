"""The film's exposure: what a pixel is of the radiance, carried over to all lights, since glTF has no film."""

from __future__ import annotations

from dataclasses import replace

from importer.materials import parameters as arithmetic
from importer.pbrt.lights import scaled
from importer.scene import Material, Scene


def expose(scene: Scene, factor: float) -> None:
    """Multiplies all that the scene emits, in place."""
    scene.lights = [replace(light, intensity=scaled(light.intensity, factor)) for light in scene.lights]
    sky = scene.sky
    scene.sky = replace(sky, radiance=scaled(sky.radiance, factor), scale=scaled(sky.scale, factor))
    exposed: dict[Material, Material] = {}
    for part in scene.parts:
        material = part.material
        if arithmetic.is_constant(material.radiance, 0.0):
            continue
        if material not in exposed:
            exposed[material] = replace(material, radiance=arithmetic.scaled(material.radiance, factor))
        part.material = exposed[material]
