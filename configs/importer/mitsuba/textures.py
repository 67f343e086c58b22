"""<texture>: pictures, checkerboards, scales; and parameters that are a colour or a texture.

Mitsuba's v runs downwards in a picture: its first row lies at v = 0 (bitmap.cpp), as scene.Mesh has it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from importer.images import bake
from importer.images.load import load_image, load_scaled
from importer.materials.parameters import mean_rgb, scaled
from importer.mitsuba.colours import SPECTRA, Use, rgb_of_plugin, rgb_of_property
from importer.mitsuba.files import SceneFolder
from importer.mitsuba.plugin import Plugin
from importer.problems import ImportProblem, Notes
from importer.scene import WHITE, Colour, Image, Number, Rgb, Texture, Wrap

TEXTURES = {
    "bitmap": "png, jpg, tga, bmp, exr, hdr and pfm",
    "checkerboard": "as a picture of four texels",
    "scale": "",
}
_WRAPS = {"repeat": Wrap.REPEAT, "mirror": Wrap.MIRRORED, "clamp": Wrap.CLAMP}
_BITMAP_PLAIN = ("max_anisotropy", "cache", "format", "accel")
_WITHOUT_COUNTERPART = {"gridtexture", "wireframe", "curvature", "vertexcolors", "mesh_attribute", "volume"}


@dataclass
class TextureReader:
    """Reads each picture once, and makes one texture of each <texture>, however often it is referred to."""

    folder: SceneFolder
    notes: Notes
    _images: dict[tuple[str, bool | None, bool], tuple[Image, float]] = field(default_factory=dict)
    _textures: dict[tuple[int, Use], Colour] = field(default_factory=dict)

    def colour(self, plugin: Plugin, name: str, default: Rgb | float, use: Use = Use.REFLECTANCE) -> Colour:
        """A parameter of a plugin, be it <rgb name="..."> or <texture name="...">."""
        child = plugin.child(name)
        if child:
            return self.texture(child, use)
        if found := plugin.get(name):
            return rgb_of_property(found, use, plugin.is_old)
        return default if isinstance(default, tuple) else (default, default, default)

    def rgb(self, plugin: Plugin, name: str, default: Rgb | float, use: Use) -> Rgb:
        """A parameter that is the same all over; of a texture its mean, which is noted."""
        value = self.colour(plugin, name, default, use)
        if not isinstance(value, Texture):
            return value
        self.notes.approximated(f"the texture of \"{name}\" of {plugin.type} as its mean", plugin.where)
        return mean_rgb(value)

    def number(self, plugin: Plugin, name: str, default: float) -> Number:
        child = plugin.child(name)
        if child and child.type not in SPECTRA:
            value = self.texture(child, Use.REFLECTANCE)
            return value if isinstance(value, Texture) else float(np.mean(value))
        if child:
            return float(np.mean(rgb_of_plugin(child, Use.REFLECTANCE)))
        found = plugin.get(name)
        return float(np.mean(rgb_of_property(found, Use.REFLECTANCE, plugin.is_old))) if found else default

    def texture(self, plugin: Plugin, use: Use) -> Colour:
        """A colour where the plugin is a spectrum, or a texture that varies."""
        if plugin.kind != "texture":
            raise ImportProblem(f"{plugin.where}: is no texture; a <texture> or a colour is right")
        key = plugin.key, use
        if key not in self._textures:
            self._textures[key] = self._read(plugin, use)
            plugin.note_rest(self.notes)
        return self._textures[key]

    def normal_map(self, plugin: Plugin) -> Texture | None:
        """A texture whose numbers are taken as they are stored."""
        if plugin.type != "bitmap":
            self.notes.left_out(f"a normal map of type \"{plugin.type}\"", plugin.where)
            return None
        plugin.ignore("raw", "gamma")
        texture = self._bitmap(plugin, True, Use.REFLECTANCE)
        plugin.note_rest(self.notes)
        return texture

    def _read(self, plugin: Plugin, use: Use) -> Colour:
        if plugin.type in SPECTRA:
            return rgb_of_plugin(plugin, use)
        if plugin.type == "bitmap":
            return self._bitmap(plugin, _is_linear(plugin, self.notes), use)
        if plugin.type == "checkerboard":
            return self._checkerboard(plugin, use)
        if plugin.type == "scale":
            return self._scaled(plugin, use)
        if plugin.type in _WITHOUT_COUNTERPART:
            self.notes.refuse(f"a texture of type \"{plugin.type}\"", plugin.where)
            return 0.5, 0.5, 0.5
        raise ImportProblem(f"{plugin.where}: is no texture of Mitsuba's; known are {', '.join([*TEXTURES, *SPECTRA])}")

    def _bitmap(self, plugin: Plugin, is_linear: bool | None, use: Use) -> Texture:
        plugin.ignore(*_BITMAP_PLAIN)
        if plugin.get("channel"):
            self.notes.refuse("one channel of a picture (\"channel\" of a bitmap)", plugin.where)
        path = self.folder.find(plugin.string("filename"), plugin.folders, plugin.where)
        key = str(path), is_linear, use is Use.EMISSION  # radiance above 1 is kept by a scale, reflectances end at 1
        if key not in self._images:
            with self.folder.reading(plugin.where):
                is_light = use is Use.EMISSION
                self._images[key] = load_scaled(path, is_linear) if is_light else (load_image(path, is_linear), 1.0)
        image, scale = self._images[key]
        return Texture(image, _image_from_uv(plugin), _wraps(plugin, self.notes), _is_nearest(plugin), (scale,) * 3)

    def _checkerboard(self, plugin: Plugin, use: Use) -> Colour:
        """color0 where u and v are both in the first half of a period, or both in the second (Checkerboard::eval)."""
        colours = [self.colour(plugin, "color0", 0.4, use), self.colour(plugin, "color1", 0.2, use)]
        if any(isinstance(colour, Texture) for colour in colours):
            self.notes.refuse("a checkerboard of textures", plugin.where)
            colours = [colour.scale if isinstance(colour, Texture) else colour for colour in colours]
        a, b = np.array(colours, float)
        scale = max(1.0, float(a.max()), float(b.max()))
        image = bake.checkerboard("checkerboard", tuple(a / scale), tuple(b / scale))
        return Texture(image, _image_from_uv(plugin), is_nearest=True, scale=(scale, scale, scale))

    def _scaled(self, plugin: Plugin, use: Use) -> Colour:
        """0.6's: a texture, or a colour under the name "value", times "scale"."""
        factor = self.rgb(plugin, "scale", 1.0, Use.REFLECTANCE)
        inner = plugin.all_of("texture")
        if len(inner) > 1:
            raise ImportProblem(f"{plugin.where}: has {len(inner)} textures; one is right")
        value = self.texture(inner[0], use) if inner else self.colour(plugin, "value", WHITE, use)
        return scaled(value, factor)


def _is_linear(plugin: Plugin, notes: Notes) -> bool | None:
    """Mitsuba 3's `raw`; 0.6's `gamma` of 1 for linear and -1 for sRGB."""
    if plugin.boolean("raw", False):
        return True
    gamma = plugin.number("gamma", 0.0)
    if gamma == 1.0:
        return True
    if gamma not in (0.0, -1.0):
        notes.approximated(f"a picture's gamma of {gamma:g} as sRGB's curve", plugin.where)
    return None if gamma == 0.0 else False


def _is_nearest(plugin: Plugin) -> bool:
    """All other filters differ in how they blur what is far away; here many samples do."""
    name = plugin.string("filter_type", "bilinear").lower()
    if name not in ("nearest", "bilinear", "trilinear", "ewa"):
        raise ImportProblem(f"{plugin.where}: its \"filter_type\" is \"{name}\"; nearest, bilinear, trilinear and ewa are "
                            "known")
    return name == "nearest"


def _wraps(plugin: Plugin, notes: Notes) -> tuple[Wrap, Wrap]:
    both = plugin.string("wrap_mode", "repeat")
    found = []
    for name in ("wrap_mode_u", "wrap_mode_v"):
        mode = plugin.string(name, both).lower()
        if mode in ("zero", "black", "one", "white"):
            notes.approximated(f"a texture's wrap mode \"{mode}\" as \"clamp\"", plugin.where)
            mode = "clamp"
        if mode not in _WRAPS:
            raise ImportProblem(f"{plugin.where}: its wrap mode is \"{mode}\"; {', '.join(_WRAPS)} are known")
        found.append(_WRAPS[mode])
    return found[0], found[1]


def _image_from_uv(plugin: Plugin) -> np.ndarray:
    """Mitsuba 3's to_uv, of which z means nothing (Transform::extract); 0.6's uv * scale + offset (Texture2D)."""
    uniform = plugin.number("uvscale", 1.0)
    scale = plugin.number("uscale", uniform), plugin.number("vscale", uniform)
    offset = plugin.number("uoffset", 0.0), plugin.number("voffset", 0.0)
    matrix = plugin.transform("to_uv")
    to_uv = matrix[:2][:, [0, 1, 3]]
    if abs(np.linalg.det(to_uv[:, :2])) < 1e-12:
        raise ImportProblem(f"{plugin.where}: its to_uv has no area")
    old = np.array([[scale[0], 0.0, offset[0]], [0.0, scale[1], offset[1]], [0.0, 0.0, 1.0]])
    if scale[0] == 0.0 or scale[1] == 0.0:
        raise ImportProblem(f"{plugin.where}: a scale of its uv is 0")
    return to_uv @ old
