"""The models of both formats as glTF's, one function each; `notes` hears what a model loses, `where` says for what.

`dielectric` may return an `InwardGlass` (`is_inward`), whose mesh must be turned inside out."""

from __future__ import annotations

from importer.materials.blends import blended
from importer.materials.coats import coated, coated_conductor
from importer.materials.conductors import conductor, conductor_of_reflectance, exact_mirror, indices_of_reflectance
from importer.materials.glass import InwardGlass, absorbing, can_absorb, dielectric, is_inward, thin_dielectric
from importer.materials.glossy import phong, substrate, uber
from importer.materials.plastics import coated_diffuse, lambert_and_gloss, plastic
from importer.materials.principled import index_of_specular, principled
from importer.materials.simple import diffuse, diffuse_transmitter, lamp, masked, mirror, null, rough_diffuse

__all__ = [
    "InwardGlass", "absorbing", "blended", "can_absorb", "coated", "coated_conductor", "coated_diffuse", "conductor",
    "conductor_of_reflectance", "dielectric", "diffuse", "diffuse_transmitter", "exact_mirror", "index_of_specular",
    "indices_of_reflectance", "is_inward", "lambert_and_gloss", "lamp", "masked", "mirror", "null", "phong", "plastic",
    "principled", "rough_diffuse", "substrate", "thin_dielectric", "uber",
]
