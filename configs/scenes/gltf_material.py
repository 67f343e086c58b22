"""Materials of glTF 2.0 with the extensions that the scenes use, and what is written of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Sequence

from images import Image


@dataclass(frozen=True)
class Texture:
    """An image that covers squares of `metres` along the second UV map, which is in metres."""

    image: Image
    metres: float

    def info(self, index: int) -> dict[str, Any]:
        scale = round(1 / self.metres, 6)
        return {"index": index, "texCoord": 1,
                "extensions": {"KHR_texture_transform": {"scale": [scale, scale]}}}


@dataclass(frozen=True)
class Material:
    """Reflectance (linear RGB) and one-sided emission (W / (sr m^2)); Lambert unless it has a specular lobe."""

    name: str
    reflectance: Sequence[float]
    radiance: Sequence[float] = (0.0, 0.0, 0.0)
    metallic: float = 0
    roughness: float = 1
    specular: float = 0
    # Of glass: the share that passes, the index of refraction, and what is left of white after so many metres.
    transmission: float = 0
    ior: float = 1.5
    attenuation: Sequence[float] = (1.0, 1.0, 1.0)
    attenuation_metres: float = 0
    clearcoat: float = 0
    clearcoat_roughness: float = 0
    colour_map: Texture | None = None  # times the reflectance
    roughness_map: Texture | None = None  # times the roughness
    normal_map: Texture | None = None  # of the clearcoat, too

    def textures(self) -> list[Texture]:
        return [t for t in (self.colour_map, self.roughness_map, self.normal_map) if t is not None]

    def to_json(self, index: Callable[[Image], int]) -> dict[str, Any]:
        """`index`: of an image's texture in the file."""
        surface: dict[str, Any] = {
            "baseColorFactor": [*self.reflectance, 1],
            "metallicFactor": self.metallic, "roughnessFactor": self.roughness}
        result: dict[str, Any] = {"name": self.name, "pbrMetallicRoughness": surface}
        extensions: dict[str, Any] = {"KHR_materials_specular": {"specularFactor": self.specular}}
        if self.colour_map:
            surface["baseColorTexture"] = self.colour_map.info(index(self.colour_map.image))
        if self.roughness_map:
            surface["metallicRoughnessTexture"] = self.roughness_map.info(index(self.roughness_map.image))
        if self.normal_map:
            result["normalTexture"] = self.normal_map.info(index(self.normal_map.image))
        strength = max(self.radiance)
        if strength > 0:
            result["emissiveFactor"] = [round(c / strength, 9) for c in self.radiance]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        return {**result, "extensions": extensions | self._glass() | self._coat(index)}

    def _glass(self) -> dict[str, Any]:
        if self.transmission == 0:
            return {}
        volume: dict[str, Any] = {"thicknessFactor": 0.01}  # for renderers that do not follow rays; the shape is what counts
        if self.attenuation_metres > 0:
            volume |= {"attenuationColor": list(self.attenuation), "attenuationDistance": self.attenuation_metres}
        return {"KHR_materials_transmission": {"transmissionFactor": self.transmission},
                "KHR_materials_ior": {"ior": self.ior}, "KHR_materials_volume": volume}

    def _coat(self, index: Callable[[Image], int]) -> dict[str, Any]:
        if self.clearcoat == 0:
            return {}
        coat: dict[str, Any] = {"clearcoatFactor": self.clearcoat, "clearcoatRoughnessFactor": self.clearcoat_roughness}
        if self.normal_map:
            coat["clearcoatNormalTexture"] = self.normal_map.info(index(self.normal_map.image))
        return {"KHR_materials_clearcoat": coat}
