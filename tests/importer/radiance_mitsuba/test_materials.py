"""Mitsuba's materials in pictures: squares in a white sky, seen straight on and at two angles."""

from __future__ import annotations

import sys
import unittest
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import mitsuba_rays as rays
import mitsuba_scattering as model
import mitsuba_xml as xml
from mitsuba_scenes import linear
from mitsuba_xml import number, rgb, twosided
from rendering import RadianceTest, Source, mean_of

SIDE, SPACING, HALF, PIXELS = 4, 0.5, 0.23, 48
ANGLES = (0, 45, 70)
RHO = np.array((0.6, 0.3, 0.1))
ETA, K = (0.2, 0.9, 1.4), (3.6, 2.6, 2.0)  # between those of gold and of a duller metal
TINT = np.array((0.9, 0.6, 0.3))


@dataclass(frozen=True)
class Exhibit:
    """`allowed`: how far glTF's model is off at each of the ANGLES."""

    bsdf: str
    expected: Callable[[float], object]  # of the cosine of the view; for each channel
    allowed: tuple[float, float, float] = (2e-3, 2e-3, 2e-3)
    kind: str = "rectangle"


def each(function: Callable[[float], float]) -> Callable[[np.ndarray], np.ndarray]:
    return lambda values: np.array([function(float(value)) for value in values])


MATT = twosided("diffuse", rgb("reflectance", RHO))
OTHER = twosided("diffuse", rgb("reflectance", (0.1, 0.8, 0.5)))
GREY = twosided("diffuse", rgb("reflectance", 0.4))
METAL = rgb("eta", ETA) + rgb("k", K)
GGX, BECKMANN = xml.word("distribution", "ggx"), xml.word("distribution", "beckmann")


def grey_mirror(share: float) -> str:
    return f'<bsdf type="conductor">{xml.word("material", "none")}{rgb("specular_reflectance", share)}</bsdf>'


def metal(c: float) -> np.ndarray:
    return np.array([model.fresnel_conductor(c, eta, k) for eta, k in zip(ETA, K)])


def rough_metal(alpha: float, is_beckmann: bool) -> Callable[[float], np.ndarray]:
    return lambda c: np.array([model.rough(c, alpha, lambda v, eta=eta, k=k: model.fresnel_conductor(v, eta, k), is_beckmann)
                               for eta, k in zip(ETA, K)])


def rough_schlick(alpha: float) -> Callable[[float], np.ndarray]:
    """Principled::eval of a metal: Schlick's curve from the base colour on, and alpha is the square of its roughness."""
    return lambda c: each(lambda f0: model.rough(c, alpha, lambda v: f0 + (1 - f0) * (1 - v) ** 5))(RHO)


# What is allowed is what the formulas of both models, put side by side, leave between them, and 0.006 at most besides:
# Schlick's curve, masking that is height-correlated, GGX's wider skirt, and a diffuse lobe below a surface that is right in
# the sum of all views alone. Silver and copper are those of table 9.2 of Real-Time Rendering (2018), of other measurements.
EXHIBITS = {
    "diffuse": Exhibit(MATT, lambda c: RHO),
    "principled metal": Exhibit(twosided("principled", rgb("base_color", RHO) + number("metallic", 1)
                                         + number("roughness", 0.5)), rough_schlick(0.25), (0.002, 0.003, 0.006)),
    "conductor": Exhibit(twosided("conductor", METAL), metal, (0.002, 0.008, 0.03)),
    "mirror": Exhibit(twosided("conductor", rgb("specular_reflectance", 0.6)), lambda c: 0.6),
    "silver": Exhibit(twosided("conductor", '<string name="material" value="Ag"/>'), lambda c: (0.972, 0.96, 0.915),
                      (0.012, 0.012, 0.012)),
    "copper": Exhibit(twosided("conductor", '<string name="material" value="Cu"/>'), lambda c: (0.955, 0.638, 0.538),
                      (0.035, 0.035, 0.04)),
    "rough metal": Exhibit(twosided("roughconductor", METAL + GGX + number("alpha", 0.3)), rough_metal(0.3, False),
                           (0.004, 0.006, 0.022)),
    "Beckmann's metal": Exhibit(twosided("roughconductor", METAL + BECKMANN + number("alpha", 0.2)), rough_metal(0.2, True),
                                (0.055, 0.075, 0.06)),
    "plastic": Exhibit(twosided("plastic", rgb("diffuse_reflectance", RHO) + number("int_ior", 1.5)),
                       lambda c: each(lambda rho: model.plastic(c, rho, 1.5 / 1.000277))(RHO), (0.035, 0.038, 0.038)),
    "nonlinear plastic": Exhibit(twosided("plastic", rgb("diffuse_reflectance", RHO) + number("int_ior", 1.5)
                                          + '<boolean name="nonlinear" value="true"/>'),
                                 lambda c: each(lambda rho: model.plastic(c, rho, 1.5 / 1.000277, True))(RHO),
                                 (0.025, 0.03, 0.02)),
    "rough plastic": Exhibit(twosided("roughplastic", rgb("diffuse_reflectance", RHO) + number("int_ior", 1.5) + GGX
                                      + number("alpha", 0.2)),
                             lambda c: each(lambda rho: model.rough_plastic(c, rho, 1.5 / 1.000277, 0.2))(RHO),
                             (0.022, 0.02, 0.032)),
    "thin glass": Exhibit('<bsdf type="thindielectric">' + rgb("specular_transmittance", TINT) + number("int_ior", 1.5)
                          + "</bsdf>", lambda c: each(lambda t: model.thin(c, 1.5 / 1.000277, t))(TINT),
                          (0.002, 0.015, 0.08)),
    "slab": Exhibit('<bsdf type="dielectric">' + rgb("specular_transmittance", TINT) + number("int_ior", 1.8) + "</bsdf>",
                    lambda c: each(lambda t: model.slab(c, 1.8 / 1.000277, t))(TINT), (0.002, 0.012, 0.022), "cube"),
    "mask": Exhibit(f'<bsdf type="mask">{number("opacity", 0.3)}{MATT}</bsdf>', lambda c: 0.3 * RHO + 0.7),
    "blend": Exhibit(f'<bsdf type="blendbsdf">{number("weight", 0.25)}{MATT}{OTHER}</bsdf>',
                     lambda c: 0.75 * RHO + 0.25 * np.array((0.1, 0.8, 0.5))),
    "null": Exhibit('<bsdf type="null"/>', lambda c: 1.0),
}
# 0.6 alone. What Phong's lobe reflects falls with the cosine of the view, which glTF's has no means for.
OLD = {
    "diffuse": Exhibit(twosided("diffuse", '<srgb name="reflectance" value="#8040c0"/>'),
                       lambda c: [linear(0x80), linear(0x40), linear(0xC0)]),
    "grey": Exhibit(twosided("diffuse", '<spectrum name="reflectance" value="0.35"/>'), lambda c: 0.35),
    "conductor": Exhibit(twosided("conductor", METAL + number("ext_eta", 1.0)), metal, (0.002, 0.008, 0.03)),
    "plastic": Exhibit(twosided("plastic", rgb("diffuse_reflectance", RHO) + number("int_ior", 1.5) + number("ext_ior", 1)),
                       lambda c: each(lambda rho: model.plastic(c, rho, 1.5))(RHO), (0.035, 0.038, 0.038)),
    "coating": Exhibit(f'<bsdf type="coating">{number("int_ior", 1.5)}{number("ext_ior", 1)}{MATT}</bsdf>',
                       lambda c: each(lambda rho: model.coated(c, rho, 1.5))(RHO), (0.004, 0.012, 0.016)),
    "phong": Exhibit(twosided("phong", rgb("diffuse_reflectance", RHO) + rgb("specular_reflectance", 0.3)
                              + number("exponent", 60)), lambda c: each(lambda rho: model.phong(c, rho, 0.3, 60))(RHO),
                     (0.006, 0.09, 0.2)),
    "tinted metal": Exhibit(twosided("conductor", METAL + number("ext_eta", 1.0) + rgb("specular_reflectance", TINT)),
                            lambda c: metal(c) * TINT, (0.002, 0.006, 0.08)),
    "one side": Exhibit(f'<bsdf type="diffuse">{rgb("diffuse_reflectance", RHO)}</bsdf>', lambda c: RHO),
    "mixture": Exhibit(f'<bsdf type="mixturebsdf">{xml.word("weights", "0.2, 0.5, 0.3")}{MATT}{OTHER}{GREY}</bsdf>',
                       lambda c: 0.2 * RHO + 0.5 * np.array((0.1, 0.8, 0.5)) + 0.3 * 0.4),
    "blended mirrors": Exhibit(f'<bsdf type="blendbsdf">{number("weight", 0.25)}{grey_mirror(0.6)}{grey_mirror(0.2)}</bsdf>',
                               lambda c: 0.75 * 0.6 + 0.25 * 0.2),
    "blend with nothing": Exhibit(f'<bsdf type="blendbsdf">{number("weight", 0.25)}{MATT}<bsdf type="null"/></bsdf>',
                                  lambda c: 0.75 * RHO + 0.25),
    "bump map": Exhibit(f'<bsdf type="bumpmap"><texture type="checkerboard"/>{MATT}</bsdf>', lambda c: RHO),
    "thin glass": Exhibit('<bsdf type="thindielectric">' + rgb("specular_transmittance", TINT) + number("int_ior", 1.5)
                          + number("ext_ior", 1) + "</bsdf>", lambda c: each(lambda t: model.thin(c, 1.5, t))(TINT),
                          (0.002, 0.015, 0.08)),
    "slab": Exhibit('<bsdf type="dielectric">' + rgb("specular_transmittance", TINT) + xml.word("int_ior", "water")
                    + number("ext_ior", 1) + "</bsdf>", lambda c: each(lambda t: model.slab(c, 1.333, t))(TINT),
                    (0.002, 0.012, 0.022), "cube"),
    # Nearly smooth; what microfacets lose and bend is within what is allowed.
    "rough slab": Exhibit('<bsdf type="roughdielectric">' + rgb("specular_transmittance", TINT) + GGX + number("alpha", 0.01)
                          + number("int_ior", 1.5) + number("ext_ior", 1) + "</bsdf>",
                          lambda c: each(lambda t: model.slab(c, 1.5, t))(TINT), (0.004, 0.015, 0.025), "cube"),
}


def middle(index: int) -> tuple[float, float]:
    row, column = divmod(index, SIDE)
    return (column - (SIDE - 1) / 2) * SPACING, ((SIDE - 1) / 2 - row) * SPACING


def furnace(exhibits: dict[str, Exhibit], version: str) -> str:
    """All squares lie in one plane, so that none sees another. A cube is a plate of its size."""
    eye: rays.Step = ("lookat", (0, 0, 5, 0, 0, 0, 0, 1, 0))
    camera = xml.sensor("orthographic", [eye], PIXELS, PIXELS).replace('"0, 0, 5"', '"0, $y, $z"')
    text = f'<default name="y" value="0"/><default name="z" value="5"/>{camera}<emitter type="constant"/>'
    for index, exhibit in enumerate(exhibits.values()):
        place = rays.steps_xml([("scale", (HALF, HALF, 0.002)), ("translate", (*middle(index), 0))])
        text += f'<shape type="{exhibit.kind}">{place}{exhibit.bsdf}</shape>'
    return xml.scene(version, text)


def view(angle: float) -> rays.Step:
    return "lookat", (0, -5 * np.sin(np.radians(angle)), 5 * np.cos(np.radians(angle)), 0, 0, 0, 0, 1, 0)


class FurnaceTest(RadianceTest):
    KEYS = {"frames": 128}

    @classmethod
    def sources(cls) -> dict[str, Source]:
        found = {}
        for angle in ANGLES:
            y, z = view(angle)[1][1:3]
            options = ("--define", f"y={y:.9f}", "--define", f"z={z:.9f}")
            found[f"3 {angle}"] = Source(furnace(EXHIBITS, "3.0.0"), options=options)
            found[f"old {angle}"] = Source(furnace(OLD, "0.6.0"), options=options)
        return found

    def on(self, index: int, angle: float) -> np.ndarray:
        """The pixels that lie wholly on a square, by where their rays meet its plane."""
        seen = rays.orthographic(rays.steps_matrix([view(angle)]), PIXELS, PIXELS)
        at = seen.origins - seen.origins[..., 2:] / seen.directions[..., 2:] * seen.directions
        pixel = 2 / PIXELS
        return ((abs(at[..., 0] - middle(index)[0]) < HALF - 0.6 * pixel)
                & (abs(at[..., 1] - middle(index)[1]) < HALF - 0.6 * pixel / np.cos(np.radians(angle))))

    def compare(self, exhibits: dict[str, Exhibit], version: str) -> None:
        for angle_index, angle in enumerate(ANGLES):
            picture = self.pictures[f"{version} {angle}"]
            for index, (name, exhibit) in enumerate(exhibits.items()):
                with self.subTest(name, angle=angle):
                    where = self.on(index, angle)
                    self.assertGreater(where.sum(), 10)
                    mean, error = mean_of(picture, where)
                    self.assert_near(mean, exhibit.expected(np.cos(np.radians(angle))),
                                     4 * error + exhibit.allowed[angle_index], name)

    def test_materials_of_3(self) -> None:
        self.compare(EXHIBITS, "3")

    def test_materials_of_the_older_version(self) -> None:
        self.compare(OLD, "old")


if __name__ == "__main__":
    unittest.main()
