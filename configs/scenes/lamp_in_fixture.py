"""A small room lit by one bulb, which a frosted globe closes in and a brass cone half surrounds: no light reaches anything
without having passed glass, and much of it has been reflected by metal before."""

from __future__ import annotations

import math

from furniture import cabinet, chair, table
from gltf_material import Texture
from gltf_writer import Camera, Material, Object
from images import noise, normals, wood
from models import ball, bowl, teapot
from shapes import Vec, box, moved, rectangle
from unwrap import Island, pack
from vessels import GLOBE, bulb, cone, glass_vase, globe, tumbler

HALF, HEIGHT = 1.9, 2.5
CAMERA = Camera(eye=(1.2, 1.55, 1.65), target=(-0.12, 0.98, -0.45), vertical_fov=62)
LAMP: Vec = (-0.1, 1.56, -0.35)  # the bulb's middle

OAK = Texture(wood("oak", (0.16, 0.085, 0.04), (0.42, 0.26, 0.14), 1, 4), 0.7)
PLANKS = Texture(wood("planks", (0.22, 0.12, 0.06), (0.52, 0.36, 0.22), 4, 9), 0.9)
PLASTER_RELIEF = Texture(normals("plaster_normal", 0.0006 * noise(128, (3, 12), 40, 2), 0.8), 0.8)

FLOOR = Material("planks", (1.0, 1.0, 1.0), roughness=0.5, specular=1, colour_map=PLANKS)
PLASTER = Material("plaster", (0.76, 0.71, 0.64), roughness=1, normal_map=PLASTER_RELIEF)
GREEN = Material("green_plaster", (0.30, 0.42, 0.34), roughness=1, normal_map=PLASTER_RELIEF)
WOOD = Material("oak", (1.0, 1.0, 1.0), roughness=0.4, specular=1, colour_map=OAK)
LACQUER = Material("lacquer", (0.30, 0.05, 0.04), roughness=0.6, specular=1, clearcoat=1, clearcoat_roughness=0.05)
GLAZE = Material("glaze", (0.62, 0.64, 0.60), roughness=0.6, specular=1, clearcoat=1, clearcoat_roughness=0)
BRASS = Material("brass", (0.91, 0.78, 0.42), metallic=1, roughness=0.15, specular=1)
STEEL = Material("steel", (0.77, 0.78, 0.78), metallic=1, roughness=0.1, specular=1)
FROSTED = Material("frosted_glass", (1.0, 1.0, 1.0), roughness=0.2, specular=1, transmission=1, ior=1.5)
GLASS = Material("glass", (1.0, 1.0, 1.0), roughness=0, specular=1, transmission=1, ior=1.5,
                 attenuation=(0.92, 0.97, 0.95), attenuation_metres=0.02)
BLUE_GLASS = Material("blue_glass", (1.0, 1.0, 1.0), roughness=0, specular=1, transmission=1, ior=1.5,
                      attenuation=(0.35, 0.60, 0.85), attenuation_metres=0.012)
LIGHT = Material("light", (0, 0, 0), (1000.0, 780.0, 530.0))


def _object(name: str, material: Material, islands: list[Island], turn: float = 0, base: Vec = (0, 0, 0)) -> Object:
    return Object(name, pack(moved(islands, math.radians(turn), base)), material)


def _shell() -> list[Object]:
    half = HEIGHT / 2
    sheets = {
        "floor": (FLOOR, rectangle((0, 0, 0), (HALF, 0, 0), (0, 0, -HALF))),
        "ceiling": (PLASTER, rectangle((0, HEIGHT, 0), (HALF, 0, 0), (0, 0, HALF))),
        "wall_left": (GREEN, rectangle((-HALF, half, 0), (0, 0, -HALF), (0, half, 0))),
        "wall_right": (PLASTER, rectangle((HALF, half, 0), (0, 0, HALF), (0, half, 0))),
        "wall_back": (PLASTER, rectangle((0, half, -HALF), (HALF, 0, 0), (0, half, 0))),
        "wall_front": (PLASTER, rectangle((0, half, HALF), (-HALF, 0, 0), (0, half, 0)))}
    return [Object(name, pack([sheet]), material) for name, (material, sheet) in sheets.items()]


def _lamp() -> list[Object]:
    """The globe looks out of the cone below and, through its upper opening, above; a rod holds it from there."""
    x, y, z = LAMP
    rod = y + GLOBE + 0.004
    return [
        _object("bulb", LIGHT, bulb(0.035), 0, LAMP),
        _object("globe", FROSTED, globe(0.004), 0, LAMP),
        _object("cone", BRASS, cone(), 0, (x, y + 0.03, z)),
        _object("rod", STEEL, box((x, (rod + HEIGHT - 0.002) / 2, z), (0.012, HEIGHT - 0.002 - rod, 0.012))),
    ]


def lamp_in_fixture() -> list[Object]:
    top = 0.761
    return [
        *_shell(), *_lamp(),
        _object("table", WOOD, table(0, 0), 8, (-0.1, 0, -0.35)),
        _object("chair", LACQUER, chair(0, 0), 165, (0.25, 0, 0.45)),
        _object("cabinet", WOOD, cabinet(0, 0), 0, (-1.62, 0, -0.6)),
        _object("vase", BLUE_GLASS, glass_vase(), 0, (0.22, top, -0.52)),
        _object("tumbler", GLASS, tumbler(), 0, (0.12, top, -0.16)),
        _object("teapot", GLAZE, teapot(0, (0, 0, 0)), -35, (-0.42, top, -0.42)),
        _object("bowl", STEEL, bowl(), 0, (-1.62, 0.901, -0.75)),
        _object("ball", GLASS, ball(0.08), 0, (-1.58, 0.901, -0.38)),
    ]
