"""A small room lit by one bulb, which a frosted globe closes in and a brass cone half surrounds: no light reaches anything
without having passed glass, and much of it has been reflected by metal before."""

from __future__ import annotations

from furniture import cabinet, chair, table
from gltf_material import Texture
from gltf_writer import Camera, Material, Object
from images import noise, normals, wood
from models import ball, bowl, teapot
from placing import placed, room_walls
from shapes import Vec, box
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
WALLS = {"floor": FLOOR, "ceiling": PLASTER, "wall_left": GREEN, "wall_right": PLASTER, "wall_back": PLASTER,
         "wall_front": PLASTER}


def _lamp() -> list[Object]:
    """The globe looks out of the cone below and, through its upper opening, above; a rod holds it from there."""
    x, y, z = LAMP
    rod = y + GLOBE + 0.004
    return [
        placed("bulb", LIGHT, bulb(0.035), 0, LAMP),
        placed("globe", FROSTED, globe(0.004), 0, LAMP),
        placed("cone", BRASS, cone(), 0, (x, y + 0.03, z)),
        placed("rod", STEEL, box((x, (rod + HEIGHT - 0.002) / 2, z), (0.012, HEIGHT - 0.002 - rod, 0.012))),
    ]


def lamp_in_fixture() -> list[Object]:
    top = 0.761
    return [
        *room_walls(HALF, HALF, HEIGHT, WALLS), *_lamp(),
        placed("table", WOOD, table(0, 0), 8, (-0.1, 0, -0.35)),
        placed("chair", LACQUER, chair(0, 0), 165, (0.25, 0, 0.45)),
        placed("cabinet", WOOD, cabinet(0, 0), 0, (-1.62, 0, -0.6)),
        placed("vase", BLUE_GLASS, glass_vase(), 0, (0.22, top, -0.52)),
        placed("tumbler", GLASS, tumbler(), 0, (0.12, top, -0.16)),
        placed("teapot", GLAZE, teapot(0, (0, 0, 0)), -35, (-0.42, top, -0.42)),
        placed("bowl", STEEL, bowl(), 0, (-1.62, 0.901, -0.75)),
        placed("ball", GLASS, ball(0.08), 0, (-1.58, 0.901, -0.38)),
    ]
