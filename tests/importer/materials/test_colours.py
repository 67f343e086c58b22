"""Colours of spectra, black bodies and illuminants against closed forms and published values."""

from __future__ import annotations

import math
import sys
import unittest
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "configs"))

from importer.materials import cie, colours, metal_spectra, metals  # noqa: E402
from importer.materials.colours import White  # noqa: E402
from importer.problems import ImportProblem  # noqa: E402


def chromaticity(rgb: tuple[float, float, float]) -> tuple[float, float]:
    x, y, z = np.linalg.solve(colours.RGB_OF_XYZ, np.array(rgb))
    return x / (x + y + z), y / (x + y + z)


class Observer(unittest.TestCase):
    def test_tables_have_the_sums_that_the_cie_states(self) -> None:
        # CIE 15:2004: the observer's curves have one area, 106.86 nm, and D65 is at (0.31272, 0.32903).
        for area in cie.OBSERVER.sum(axis=0) * 5.0:
            self.assertAlmostEqual(area, 106.857, delta=0.002)
        x, y, z = (cie.OBSERVER * cie.DAYLIGHT[:, None]).sum(axis=0)
        self.assertAlmostEqual(x / (x + y + z), 0.31272, delta=2e-5)
        self.assertAlmostEqual(y / (x + y + z), 0.32903, delta=2e-5)

    def test_flat_spectra(self) -> None:
        # Under equal energy X = Y = Z, so that red is 3.240479 - 1.537150 - 0.498535.
        for value, expected in zip(colours.rgb_of_spectrum([300, 900], [0.5, 0.5]), (1.204794, 0.948291, 0.908916)):
            self.assertAlmostEqual(value, 0.5 * expected, delta=2e-4)
        self.assertEqual(colours.rgb_of_constant_emission(2.0)[0], 2.0 * (3.240479 - 1.537150 - 0.498535))
        for value in colours.rgb_of_reflectance([300, 900], [0.5, 0.5], White.D65):
            self.assertAlmostEqual(value, 0.5, delta=3e-4)

    def test_a_narrow_band_has_the_chromaticity_of_its_wavelength(self) -> None:
        # At 550 nm: x = 0.43345 / (0.43345 + 0.99495 + 0.00875).
        x, y, z = colours.xyz_of_spectrum([548, 549, 550, 551, 552], [0, 0.5, 1, 0.5, 0])
        self.assertAlmostEqual(x / (x + y + z), 0.30160, delta=5e-4)
        self.assertAlmostEqual(y / (x + y + z), 0.69231, delta=5e-4)
        self.assertAlmostEqual(y, 0.99495 * 2.0 / 106.857, delta=1e-4)

    def test_what_is_outside_of_a_spectrum(self) -> None:
        self.assertEqual(colours.xyz_of_spectrum([780, 790], [1, 1])[2], 0.0)
        zero = colours.rgb_of_spectrum([500, 600], [1, 1])
        extended = colours.rgb_of_spectrum([500, 600], [1, 1], is_extended=True)
        self.assertLess(zero[0], 1.0)
        self.assertAlmostEqual(extended[0], 1.204794, delta=2e-4)

    def test_no_channel_is_negative_or_a_reflectance_above_1(self) -> None:
        self.assertEqual(colours.rgb_of_spectrum([499, 500, 501], [0, 1, 0])[0], 0.0)
        self.assertEqual(max(colours.rgb_of_reflectance([300, 900], [3, 3])), 1.0)

    def test_metals_in_rgb_are_those_that_mitsuba_lists(self) -> None:
        # The spectra and the list come from different sources; both under equal energy.
        for name in ("Ag", "Al", "Au", "Cu"):
            wavelengths, *curves = metal_spectra.spectra(name)
            for curve, listed in zip(curves, metals.named_metal(name)):
                for value, expected in zip(colours.rgb_of_spectrum(wavelengths, curve), listed):
                    self.assertAlmostEqual(value / expected, 1.0, delta=0.0025, msg=name)

    def test_bad_spectra_are_one_sentence(self) -> None:
        for wavelengths, values, what in (([400], [1], "two pairs"), ([400, 500], [1], "2 wavelengths and 1 values"),
                                          ([500, 400], [1, 1], "must increase"), ([400, math.nan], [1, 1], "not finite"),
                                          ([400, 500], [1, math.inf], "not finite")):
            with self.assertRaisesRegex(ImportProblem, "^lamp: .*" + what):
                colours.rgb_of_spectrum(wavelengths, values, where="lamp")


class BlackBodies(unittest.TestCase):
    def test_plancks_law_has_the_power_of_stefan_and_boltzmann(self) -> None:
        # sigma T^4 / pi, with sigma = 5.670374e-8, and Wien's peak of 2897.77 um / T.
        wavelengths = np.geomspace(50.0, 1e6, 20001)
        radiance = colours.blackbody_radiance(wavelengths, 3000.0)
        self.assertAlmostEqual(np.trapezoid(radiance, wavelengths * 1e-9) if hasattr(np, "trapezoid")
                               else np.trapz(radiance, wavelengths * 1e-9), 5.670374e-8 * 3000.0 ** 4 / math.pi, delta=50.0)
        self.assertAlmostEqual(wavelengths[radiance.argmax()], 965.92, delta=1.0)

    def test_colours(self) -> None:
        # Illuminant A is a black body of 2856 K: CIE 15:2004 has it at (0.44758, 0.40745).
        x, y = chromaticity(colours.rgb_of_blackbody(2856.0, True))
        self.assertAlmostEqual(x, 0.44758, delta=2e-4)
        self.assertAlmostEqual(y, 0.40745, delta=2e-4)

    def test_normalisations(self) -> None:
        self.assertAlmostEqual(colours.luminance(colours.rgb_of_blackbody(4000.0, True)), 1.0, delta=1e-5)
        # Planck at 555 nm and 5000 K: 1.19104e-16 / (5.55e-7)^5 / (exp(5.18475) - 1) = 1.2740e13 W / (m^2 sr m). The mean
        # over the observer's curve is within 2 % of it, as the spectrum is flat there: its peak is at 579.6 nm.
        y = colours.luminance(colours.rgb_of_blackbody(5000.0, False))
        self.assertAlmostEqual(y / 1.2740e4, 1.0, delta=0.02)
        self.assertAlmostEqual(colours.luminance(colours.rgb_of_blackbody_by_peak(5000.0)), 1.0, delta=0.02)

    def test_strange_temperatures_are_one_sentence(self) -> None:
        for kelvin in (0.0, -5.0, math.nan, 1e9):
            with self.assertRaisesRegex(ImportProblem, "^sun: a black body has .* kelvin"):
                colours.rgb_of_blackbody(kelvin, True, "sun")


class Illuminants(unittest.TestCase):
    def test_named_ones(self) -> None:
        for value in colours.named_illuminant("stdillum-D65"):
            self.assertAlmostEqual(value, 1.0, delta=1e-3)
        x, y = chromaticity(colours.named_illuminant("stdillum-F2"))
        self.assertAlmostEqual(x, 0.3721, delta=1e-6)
        self.assertAlmostEqual(colours.luminance(colours.named_illuminant("stdillum-A")), 1.0, delta=1e-5)
        with self.assertRaisesRegex(ImportProblem, "no illuminant is named \"stdillum-B\"; known are illum-acesD60"):
            colours.named_illuminant("stdillum-B")


if __name__ == "__main__":
    unittest.main()
