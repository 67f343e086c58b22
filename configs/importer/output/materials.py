"""Materials as glTF 2.0 says them, with the extensions that each needs and no others."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from importer.output.packing import Packer
from importer.output.pixels import Channels
from importer.output.textures import Textures, is_sheared
from importer.problems import ImportProblem, Notes
from importer.scene import WHITE, Colour, Material, Number, Rgb, Texture

_MOST_RADIANCE = 1e12  # of the reader (engine/gltf/material.cpp)
_MOST_TINT = 1e6  # F0 ends at 1, and that of the smallest index that is told from 1 is above 1e-6
_DEFAULT_INDEX = 1.5  # of KHR_materials_ior


@dataclass
class Written:
    """`second_uv`: of the second UV map that the material's textures read; None where the first serves."""

    index: int
    second_uv: np.ndarray | None


def _numbers(values: tuple[float, ...] | Rgb, what: str, most: float = 1.0) -> list[float]:
    for value in values:
        if not 0 <= value <= most + 1e-6:  # false of NaN
            raise ImportProblem(f"{what} is {value:g}; a number from 0 to {most:g} would be right")
    return [min(float(value), most) for value in values]


class _Writer:
    """Of one material."""

    def __init__(self, material: Material, textures: Textures, packer: Packer) -> None:
        self.material, self.textures, self.packer = material, textures, packer
        self.where = f"material {material.name}"
        self.second_uv = self._second_uv(packer.notes)
        self.extensions: dict[str, Any] = {}

    def _second_uv(self, notes: Notes) -> np.ndarray | None:
        values = [getattr(self.material, f.name) for f in dataclasses.fields(self.material)]
        matrices = [np.asarray(value.image_from_uv, float) for value in values if isinstance(value, Texture)]
        sheared = [matrix for matrix in matrices if is_sheared(matrix)]
        if any(not np.array_equal(matrix, sheared[0]) for matrix in sheared):
            notes.refuse("textures that are sheared in different ways", self.where)
        return sheared[0] if sheared else None

    def _info(self, texture: Texture, channels: Channels) -> dict[str, Any]:
        return self.textures.info(texture, channels, self.second_uv)

    def number(self, name: str, value: Number, channels: Channels) -> tuple[float, dict[str, Any] | None]:
        """A factor and, where the number varies, its texture, with the number in the channel where glTF has it."""
        if not isinstance(value, Texture):
            return _numbers((value,), f"{self.where}: {name}")[0], None
        return 1.0, self._info(self.packer.numbers(value, self.where), channels)

    def set_number(self, extension: str, name: str, value: Number, channels: Channels = Channels.NUMBERS) -> None:
        factor, info = self.number(name, value, channels)
        said = self.extensions.setdefault(extension, {})
        said[f"{name}Factor"] = factor
        if info:
            said[f"{name}Texture"] = info

    def surface(self) -> dict[str, Any]:
        factor, info = self._base_colour()
        said: dict[str, Any] = {"baseColorFactor": factor}
        if info:
            said["baseColorTexture"] = info
        said["metallicFactor"] = _numbers((self.material.metallic,), f"{self.where}: metallic")[0]
        said["roughnessFactor"], info = self.number("roughness", self.material.roughness, Channels.GREEN)
        if info:
            said["metallicRoughnessTexture"] = info
        return said

    def _base_colour(self) -> tuple[list[float], dict[str, Any] | None]:
        colour, opacity = self.material.base_colour, self.material.opacity
        alpha = 1.0 if isinstance(opacity, Texture) else _numbers((opacity,), f"{self.where}: opacity")[0]
        if not isinstance(colour, Texture):
            factor = [*_numbers(colour, f"{self.where}: base colour"), alpha]
            if not isinstance(opacity, Texture):
                return factor, None
            return factor, self._info(self.packer.numbers(opacity, self.where), Channels.ALPHA)
        if isinstance(opacity, Texture):
            colour, channels = self.packer.colours_and_opacity(colour, opacity, self.where), Channels.COLOUR_AND_ALPHA
        else:
            channels = Channels.COLOUR if alpha == 1 else Channels.COLOUR_ALONE
            colour = self.packer.colours(colour, self.where)
        return [*_numbers(colour.scale, f"{self.where}: base colour's scale"), alpha], self._info(colour, channels)

    def add_dielectric(self) -> None:
        material = self.material
        if material.ior != 0 and not material.ior >= 1:
            raise ImportProblem(f"{self.where}: its index is {material.ior:g}; 1 or more, or 0, would be right")
        if material.metallic == 1:  # of which nothing is dielectric
            return
        if material.specular != 1:
            self.set_number("KHR_materials_specular", "specular", material.specular, Channels.ALPHA)
        if material.specular_colour != WHITE:
            said = self.extensions.setdefault("KHR_materials_specular", {})
            colour = material.specular_colour
            if isinstance(colour, Texture):
                said["specularColorTexture"] = self._info(colour, Channels.COLOUR)
                colour = colour.scale
            said["specularColorFactor"] = _numbers(colour, f"{self.where}: specular colour", _MOST_TINT)
        if material.ior != _DEFAULT_INDEX:
            self.extensions["KHR_materials_ior"] = {"ior": float(material.ior)}

    def add_transmission(self) -> None:
        material = self.material
        if material.transmission == 0:
            return
        self.set_number("KHR_materials_transmission", "transmission", material.transmission)
        if material.is_thin:
            return
        volume: dict[str, Any] = {"thicknessFactor": 0.01}  # that there is a volume; how thick it is, rays find out
        if material.attenuation_distance is not None and material.attenuation_colour != WHITE:
            if not 0 < material.attenuation_distance < np.inf:
                raise ImportProblem(f"{self.where}: its light is attenuated over {material.attenuation_distance:g}; "
                                    f"a distance above 0 would be right")
            volume["attenuationColor"] = _numbers(material.attenuation_colour, f"{self.where}: attenuation colour")
            volume["attenuationDistance"] = float(material.attenuation_distance)
        self.extensions["KHR_materials_volume"] = volume

    def add_coat(self) -> None:
        material = self.material
        if material.clearcoat == 0:
            return
        self.set_number("KHR_materials_clearcoat", "clearcoat", material.clearcoat)
        self.set_number("KHR_materials_clearcoat", "clearcoatRoughness", material.clearcoat_roughness)
        if material.normal_map:
            self.extensions["KHR_materials_clearcoat"]["clearcoatNormalTexture"] = self._normal_info()

    def _normal_info(self) -> dict[str, Any]:
        return self._info(self.material.normal_map, Channels.NUMBERS)

    def emission(self) -> dict[str, Any]:
        """The factor ends at 1 in glTF; what is above goes into KHR_materials_emissive_strength."""
        radiance: Colour = self.material.radiance
        rgb = radiance.scale if isinstance(radiance, Texture) else radiance
        factor = _numbers(rgb, f"{self.where}: radiance", _MOST_RADIANCE)
        strength = max(factor)
        if strength == 0:
            return {}
        if strength > 1:
            self.extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
            factor = [channel / strength for channel in factor]
        said: dict[str, Any] = {"emissiveFactor": factor}
        if isinstance(radiance, Texture):
            said["emissiveTexture"] = self._info(radiance, Channels.COLOUR)
        return said

    def to_json(self) -> dict[str, Any]:
        material = self.material
        said: dict[str, Any] = {"name": material.name, "pbrMetallicRoughness": self.surface(), **self.emission()}
        if material.normal_map:
            said["normalTexture"] = self._normal_info()
        if isinstance(material.opacity, Texture) or material.opacity < 1:
            said["alphaMode"] = "BLEND"
        self.add_dielectric()
        self.add_transmission()
        self.add_coat()
        # What does not emit scatters on both sides here anyway, and viewers shall show both, but of volumes.
        is_open = "emissiveFactor" not in said and "KHR_materials_volume" not in self.extensions
        if material.emits_both_sides or is_open:
            said["doubleSided"] = True
        return {**said, "extensions": self.extensions} if self.extensions else said


@dataclass
class Materials:
    """Those of the file so far, each once."""

    textures: Textures
    packer: Packer
    listed: list[dict[str, Any]] = field(default_factory=list)
    _by_content: dict[str, int] = field(default_factory=dict)
    _written: dict[int, tuple[Material, Written]] = field(default_factory=dict)  # with the material, so that it lives on

    def written(self, material: Material) -> Written:
        if id(material) not in self._written:
            writer = _Writer(material, self.textures, self.packer)
            said = writer.to_json()
            index = self._by_content.setdefault(json.dumps(said), len(self.listed))
            if index == len(self.listed):
                self.listed.append(said)
            self._written[id(material)] = (material, Written(index, writer.second_uv))
        return self._written[id(material)][1]

    def extensions(self) -> set[str]:
        return {name for said in self.listed for name in said.get("extensions", {})}
