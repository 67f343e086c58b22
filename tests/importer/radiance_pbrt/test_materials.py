"""What pbrt's materials make of light, against its own formulas: in a white sky, and under a light of one direction."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import pbrt_formulas as formulas
from pbrt_rendering import numbers
from pbrt_tiles import Tile, TilesTest, cosine_of, tiles_source
from rendering import Source

_ETA, _K = np.array([0.2, 0.9, 1.5]), np.array([3.9, 2.5, 1.8])  # a metal's
_METAL = f'"rgb eta" [{numbers(_ETA)}] "rgb k" [{numbers(_K)}]'
_NOT_REMAPPED, _NOT_REMAPPED_V3 = '"bool remaproughness" false', '"bool remaproughness" "false"'
# Schlick's curve is off by less than a hundredth up to 45 degrees, and at 70 by no more than the list of an import says,
# which names a bound up to 89 degrees.
_EXACT = {0: 1e-3, 45: 1e-3, 70: 1e-3}
_SCHLICK = {0: 2e-3, 45: 0.01, 70: 0.05}


def _metal(fresnel_of: Callable[[float, float, float], float]) -> Callable[[float], np.ndarray]:
    return lambda angle: np.array([fresnel_of(cosine_of(angle), n, a) for n, a in zip(_ETA, _K)])


def _smooth(cosine: float, eta: float, k: float) -> float:
    return float(formulas.conductor(cosine, eta, k))


def _rough(alpha: float) -> Callable[[float, float, float], float]:
    return lambda cosine, eta, k: formulas.rough(cosine, alpha, lambda c: formulas.conductor(c, eta, k))


def _of_reflectance(values: object) -> Callable[[float], np.ndarray]:
    """An index of 1 and k = 2 sqrt(r / (1 - r)) (ConductorMaterial::GetBxDF)."""
    return lambda angle: np.array([_smooth(cosine_of(angle), 1.0, 2 * math.sqrt(r / (1 - r))) for r in np.asarray(values)])


_RHO = np.array([0.8, 0.5, 0.2])
_RGB = numbers(_RHO)


def _furnace_of_version_4() -> dict[str, Tile]:
    black = 'Material "diffuse" "rgb reflectance" [0 0 0]'
    named = ('MakeNamedMaterial "{0}" "string type" "diffuse" "rgb reflectance" [1 0 .2]\n'
             'MakeNamedMaterial "{1}" "string type" "diffuse" "rgb reflectance" [0 .8 1]\n').format("a", "b")
    return {
        "diffuse": Tile(f'Material "diffuse" "rgb reflectance" [{_RGB}]', lambda angle: _RHO, _EXACT),
        "default": Tile("", lambda angle: 0.5, _EXACT),
        "black": Tile(black, lambda angle: 0.0, _EXACT),
        "metal": Tile(f'Material "conductor" {_METAL}', _metal(_smooth), _SCHLICK),
        # alpha is the root of the roughness.
        "rough metal": Tile(f'Material "conductor" {_METAL} "float roughness" .16', _metal(_rough(0.4)), _SCHLICK),
        "metal of a reflectance": Tile(f'Material "conductor" "rgb reflectance" [{_RGB}]', _of_reflectance(_RHO),
                                       {0: 2e-3, 45: 0.03, 70: 0.12}),
        # Gold's, seen straight on (Akenine-Moeller et al., Real-Time Rendering, 4th edition, table 9.2); of spectra, so only
        # about that.
        "gold": Tile('Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"',
                     lambda angle: np.array([1.0, 0.782, 0.344]), {0: 0.06, 45: 0.06, 70: 0.12}),
        # glTF dims the lobe below a coat by 1 - F at the half vector. In all it sends as much light as the source's, less of
        # it straight up and more at grazing angles; the list of an import says 0.05 up to 60 degrees of both.
        "coated diffuse": Tile(f'Material "coateddiffuse" "rgb reflectance" [{_RGB}] "float roughness" 0',
                               lambda angle: formulas.coated_diffuse(cosine_of(angle), _RHO, 1.5, 0.01),
                               {0: 0.045, 45: 0.045, 70: 0.03}),
        # A thin and rough one: alpha is the root of 0.09.
        "rough coat": Tile(f'Material "coateddiffuse" "rgb reflectance" [{_RGB}] "float roughness" .09',
                           lambda angle: formulas.rough_coated_diffuse(cosine_of(angle), _RHO, 1.5, 0.01, 0.3),
                           {0: 0.03, 45: 0.02, 70: 0.03}),
        "thick coat": Tile(f'Material "coateddiffuse" "rgb reflectance" [{_RGB}] "float eta" 1.3 "float thickness" .5',
                           lambda angle: formulas.coated_diffuse(cosine_of(angle), _RHO, 1.3, 0.5),
                           {0: 0.025, 45: 0.015, 70: 0.04}),
        # glTF's coat has an index of 1.5 and dims once.
        "coated metal": Tile(f'Material "coatedconductor" {_METAL.replace("rgb ", "rgb conductor.")}'
                             ' "float interface.roughness" 0 "float conductor.roughness" 0',
                             lambda angle: formulas.coated_conductor(cosine_of(angle), 1.5, 0.01, _ETA, _K),
                             {0: 0.005, 45: 0.01, 70: 0.09}),
        # What is mixed by an amount of 1/4 is 3/4 of the first.
        "mixture": Tile(named + 'Material "mix" "string materials" ["a" "b"] "float amount" .25',
                        lambda angle: np.array([0.75, 0.2, 0.4]), _EXACT),
        "spectrum": Tile('Material "diffuse" "spectrum reflectance" [300 .3 900 .3]', lambda angle: 0.3, _SCHLICK),
    }


def _furnace_of_version_3() -> dict[str, Tile]:
    alpha = formulas.alpha_of_version_3(0.1)

    def plastic(angle: float) -> np.ndarray:
        return 0.4 * _RHO + 0.5 * formulas.rough(cosine_of(angle), alpha, lambda c: formulas.dielectric(c, 1.5))
    mixture = ('MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [1 0 .2]\n'
               'MakeNamedMaterial "b" "string type" "matte" "rgb Kd" [0 .8 1]\n')
    base, below = {0: 2e-3, 45: 4e-3, 70: 8e-3}, numbers(0.4 * _RHO)
    return {
        "matte": Tile(f'Material "matte" "rgb Kd" [{_RGB}]', lambda angle: _RHO, _EXACT),
        "default": Tile("", lambda angle: 0.5, _EXACT),
        "metal": Tile(f'Material "metal" {_METAL} "float roughness" 0 {_NOT_REMAPPED_V3}', _metal(_smooth), _SCHLICK),
        "rough metal": Tile(f'Material "metal" {_METAL} "float roughness" .1', _metal(_rough(alpha)), _SCHLICK),
        # A mirror of version 3 has no Fresnel term (FresnelNoOp).
        "grey mirror": Tile('Material "mirror" "rgb Kr" [.6 .6 .6]', lambda angle: 0.6, _EXACT),
        # Of a coloured one all channels have the greatest at grazing angles here.
        "mirror": Tile(f'Material "mirror" "rgb Kr" [{_RGB}]', lambda angle: _RHO, {0: 1e-3, 45: 0.01, 70: 0.1}),
        # Kd, and Ks times the reflectance of an index of 1.5, neither dimmed by the other (the book's indices, 9.2.2).
        "plastic": Tile(f'Material "plastic" "rgb Kd" [{below}] "rgb Ks" [.5 .5 .5] "float roughness" .1', plastic, base),
        "uber": Tile(f'Material "uber" "rgb Kd" [{below}] "rgb Ks" [.5 .5 .5] "float roughness" .1', plastic, base),
        # Its diffuse lobe, too, sends as much in all, and is another one; the list says 0.2 up to 60 degrees.
        "substrate": Tile(f'Material "substrate" "rgb Kd" [{_RGB}] "rgb Ks" [.05 .05 .05] "float uroughness" .1 "float '
                          'vroughness" .1',
                          lambda angle: formulas.substrate(cosine_of(angle), _RHO, np.full(3, 0.05), alpha),
                          {0: 0.11, 45: 0.05, 70: 0.16}),
        # The other way round than in version 4: "amount" is the share of the first.
        "mixture": Tile(mixture + 'Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" '
                        "[.25 .25 .25]", lambda angle: np.array([0.25, 0.6, 0.8]), _EXACT),
    }


class Furnaces(TilesTest):
    """Each as bright as its directional albedo."""

    KEYS = {"frames": 512, "random": "sobol", "replicates": 8}
    ANGLES = (0, 45, 70)
    TILES = {3: _furnace_of_version_3(), 4: _furnace_of_version_4()}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        sky = 'LightSource "infinite" "rgb L" [1 1 1]\n'
        return {f"v{version}-{angle}": tiles_source(tiles, angle, sky, 1, version)
                for version, tiles in cls.TILES.items() for angle in cls.ANGLES}

    def test_white_sky(self) -> None:
        for version, tiles in self.TILES.items():
            for angle in self.ANGLES:
                self.check(self.pictures[f"v{version}-{angle}"], tiles, angle)


def _peak(alpha: float, fresnel: Callable[[np.ndarray], np.ndarray], light: float) -> Callable[[float], float]:
    return lambda angle: formulas.lobe(light, angle, alpha, fresnel)


def _peaks_of_metal(alpha: float, light: float) -> Callable[[float], np.ndarray]:
    return lambda angle: np.array([formulas.lobe(light, angle, alpha, lambda c, n=n, a=a: formulas.conductor(c, n, a))
                                   for n, a in zip(_ETA, _K)])


def _lobe(material: str, expected: Callable[[float], object], light: float) -> Tile:
    """Schlick's curve is off by a hundredth of itself where light comes at 25 degrees or less, and by a seventh at the half
    vector's 42 degrees."""
    share = 0.02 if light <= 25 else 0.2
    return Tile(material, expected, {angle: share * float(np.max(expected(angle))) + 1e-4 for angle in (0, 25)})


def _lobes_of_version_4(light: float) -> dict[str, Tile]:
    glass = _peak(0.2, lambda c: formulas.dielectric(c, 1.5), light)
    return {
        "metal": _lobe(f'Material "conductor" {_METAL} "float roughness" .0625', _peaks_of_metal(0.25, light), light),
        "metal, not remapped": _lobe(f'Material "conductor" {_METAL} "float roughness" .3 {_NOT_REMAPPED}',
                                     _peaks_of_metal(0.3, light), light),
        "metal, both roughnesses": _lobe(f'Material "conductor" {_METAL} "float uroughness" .09 "float vroughness" .09',
                                         _peaks_of_metal(0.3, light), light),
        "coat": _lobe('Material "coateddiffuse" "rgb reflectance" [0 0 0] "float roughness" .04', glass, light),
        "glass": _lobe('Material "dielectric" "float roughness" .04', glass, light),
        "glass of BK7": _lobe('Material "dielectric" "spectrum eta" "glass-BK7" "float roughness" .2 ' + _NOT_REMAPPED,
                              _peak(0.2, lambda c: formulas.dielectric(c, 1.517), light), light),
    }


def _lobes_of_version_3(light: float) -> dict[str, Tile]:
    rough, rougher = formulas.alpha_of_version_3(0.01), formulas.alpha_of_version_3(0.1)

    def glossy(alpha: float, factor: float, eta: float = 1.5) -> Callable[[float], float]:
        return _peak(alpha, lambda c: factor * formulas.dielectric(c, eta), light)
    return {
        "metal": _lobe(f'Material "metal" {_METAL} "float roughness" .1', _peaks_of_metal(rougher, light), light),
        "metal, not remapped": _lobe(f'Material "metal" {_METAL} "float roughness" .3 {_NOT_REMAPPED_V3}',
                                     _peaks_of_metal(0.3, light), light),
        # The polynomial makes an alpha of 0.047 of no roughness.
        "metal, no roughness": _lobe(f'Material "metal" {_METAL} "float roughness" 0',
                                     _peaks_of_metal(formulas.alpha_of_version_3(0), light), light),
        "plastic": _lobe('Material "plastic" "rgb Kd" [0 0 0] "rgb Ks" [.8 .8 .8] "float roughness" .01',
                         glossy(rough, 0.8), light),
        "uber": _lobe('Material "uber" "rgb Kd" [0 0 0] "rgb Ks" [.8 .8 .8] "float roughness" .01 "float eta" 1.8',
                      glossy(rough, 0.8, 1.8), light),
        "glass": _lobe(f'Material "glass" "float uroughness" .2 "float vroughness" .2 {_NOT_REMAPPED_V3}',
                       glossy(0.2, 1), light),
        # Disney's alpha is the square of its roughness, and a metal's F0 its colour (DisneyMaterial).
        "disney": _lobe('Material "disney" "rgb color" [.7 .7 .7] "float metallic" 1 "float roughness" .5',
                        _peak(0.25, lambda c: 0.7 + 0.3 * (1 - c) ** 5, light), light),
    }


class Lobes(TilesTest):
    """Under a light of irradiance 1, from the other side of the normal than the view: near the middle of a lobe and off it.
    These tell alpha, whose square the middle's height goes with inversely."""

    KEYS = {"frames": 2}
    PAIRS = ((0, 0), (25, 25), (60, 0))  # angles of light and view

    @classmethod
    def sources(cls) -> dict[str, Source]:
        found = {}
        for light, angle in cls.PAIRS:
            place = numbers((0, math.sin(math.radians(light)), cosine_of(light)))
            for version, tiles in ((3, _lobes_of_version_3(light)), (4, _lobes_of_version_4(light))):
                kind = "point3" if version == 4 else "point"
                world = f'LightSource "distant" "rgb L" [1 1 1] "{kind} from" [{place}] "{kind} to" [0 0 0]\n'
                found[f"v{version}-{light}"] = tiles_source(tiles, angle, world, 1, version)
        return found

    def test_directional_light(self) -> None:
        for light, angle in self.PAIRS:
            self.check(self.pictures[f"v3-{light}"], _lobes_of_version_3(light), angle)
            self.check(self.pictures[f"v4-{light}"], _lobes_of_version_4(light), angle)


if __name__ == "__main__":
    unittest.main()
