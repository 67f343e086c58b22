"""Infinite lights (pbrt-v4: lights.cpp, ImageInfiniteLight; pbrt-v3: lights/infinite.cpp).

In both the light's own +z is up. v3's images are in latitude and longitude: row 0 at +z, column 0 at +x, and +y a
quarter to the right of it. v4's are square, by the octahedral map of equal areas, and become v3's here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from importer.images.load import load_radiance
from importer.materials import colours
from importer.pbrt.lights import emission, scaled
from importer.pbrt.octahedral import latitude_longitude, upper_illuminance
from importer.pbrt.parameters import Parameters
from importer.pbrt.source import Folder
from importer.pbrt.spectra import COLOURS, Spectra
from importer.pbrt.transforms import of_directions, orthogonal_part
from importer.problems import ImportProblem, Notes
from importer.scene import BLACK, Sky

# From the directions of `Sky` (up +y, the image's middle -z, its right half +x) to those of a light: +z, -x and -y.
LIGHT_FROM_SKY = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


class Skies:
    """All infinite lights of one scene, which shine together."""

    def __init__(self, folder: Folder, spectra: Spectra, notes: Notes, version: int) -> None:
        self._folder = folder
        self._spectra = spectra
        self._notes = notes
        self._version = version
        self._constant = np.zeros(3)
        self._image: Sky | None = None

    def read(self, parameters: Parameters, to_world: np.ndarray, colour_space: str) -> None:
        name = parameters.string("filename", "") or parameters.string("mapname", "")
        rgb = emission(self._spectra, parameters, "L", colour_space, self._version)
        illuminance = parameters.number("illuminance", -1.0) if self._version == 4 else -1.0
        if parameters.numbers("portal", "point3", width=3) is not None:
            self._notes.left_out("the portal of an infinite light, which is taken to shine from everywhere",
                                 str(parameters.place))
        if name:
            self._add_image(name, parameters, scaled(rgb, 1.0), to_world, illuminance)
        else:
            self._constant += scaled(rgb, illuminance / np.pi) if illuminance > 0 else rgb
        parameters.without_effect("nsamples", "samples")
        parameters.finish(self._notes)

    def sky(self) -> Sky:
        """What all of them are together."""
        red, green, blue = (float(value) for value in self._constant)
        if self._image is None:
            return Sky((red, green, blue))
        if not self._constant.any():
            return self._image
        assert self._image.image is not None
        together = self._image.image * np.array(self._image.scale) + self._constant
        return replace(self._image, image=together.astype(np.float32), scale=(1.0, 1.0, 1.0))

    def _add_image(self, name: str, parameters: Parameters, scale: tuple[float, float, float], to_world: np.ndarray,
                   illuminance: float) -> None:
        where = str(parameters.place)
        if self._version == 4 and parameters.has("L", *COLOURS):
            raise ImportProblem(f'{where}: an infinite light has both "L" and "filename"; pbrt-v4 takes one of them')
        if self._image is not None:
            self._notes.refuse("a second sky with an image", where)
            return
        if scale == BLACK:
            return
        image = load_radiance(self._folder.find(name, where))
        if self._version == 4:
            if image.shape[0] != image.shape[1]:
                raise ImportProblem(f"{where}: {name} has {image.shape[1]} x {image.shape[0]} pixels; a sky of pbrt-v4 must"
                                    " be square, of equal areas (imgtool makeequiarea)")
            if illuminance > 0:
                there = upper_illuminance(image, colours.LUMINANCE_OF_RGB)
                if there <= 0:
                    raise ImportProblem(f"{where}: {name} is dark above the horizon, so that no scale gives it the"
                                        ' "illuminance"; it must be bright there')
                scale = scaled(scale, illuminance / there)
                # Its sum over the upper half of the image has 2 pi over all pixels for their solid angle (Light::Create).
                self._notes.approximated('the "illuminance" of a sky with an image as what it says; pbrt-v4 itself shows'
                                         " twice as much", where)
            self._notes.approximated("the octahedral map of a sky by latitudes and longitudes", where)
            image = latitude_longitude(image)
        turned, is_orthogonal = orthogonal_part(of_directions(to_world, parameters.place))
        if not is_orthogonal:
            self._notes.approximated("the stretched directions of a sky as unstretched ones", where)
        self._image = Sky(image=image, scale=scale, to_world=turned @ LIGHT_FROM_SKY)
