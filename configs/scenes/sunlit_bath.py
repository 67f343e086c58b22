"""A bath with glazed tiles, two mirrors and glassware, lit by sun and sky through an open window and by nothing else."""

from __future__ import annotations

from gltf_material import Texture
from gltf_writer import Camera, Material, Object
from images import Tiles, noise, normals, speckled, wood
from models import ball
from placing import placed, room_walls
from shapes import Vec, box, rectangle
from vessels import basin, bottle, tap, tub, tumbler
from windows import WindowWall

WIDTH, DEPTH, HEIGHT = 3.0, 3.6, 2.5
CAMERA = Camera(eye=(0.2, 1.5, 1.74), target=(-0.06, 0.84, -0.9), vertical_fov=70)
# As if in the wall on the left, seen from inside: along its x, which is the room's -z.
WINDOW = WindowWall(DEPTH, HEIGHT, 0.25, left=-0.5, right=0.9, sill=0.95, top=2.1)

GLAZED = Tiles(count=4, metres=0.4, joint=0.003)
STONE = Tiles(count=2, metres=0.6, joint=0.004)
TILE_RELIEF = Texture(normals("tile_normal", 0.0012 * GLAZED.face() + GLAZED.tilted(0.006, 5), 0.4), 0.4)
STONE_RELIEF = Texture(normals("stone_normal", 0.0015 * STONE.face(), 0.6), 0.6)
PLASTER_RELIEF = Texture(normals("plaster_normal", 0.0006 * noise(128, (3, 12), 40, 2), 0.8), 0.8)
OAK = Texture(wood("oak", (0.20, 0.10, 0.045), (0.50, 0.31, 0.16), 1, 4), 0.5)


def _tiles(name: str, colour: Vec) -> Material:
    return Material(
        name, (1.0, 1.0, 1.0), roughness=1, specular=1, clearcoat=1, clearcoat_roughness=0.1,
        colour_map=Texture(GLAZED.colours(name, colour, (0.62, 0.60, 0.56), 0.22, 3), 0.4),
        roughness_map=Texture(GLAZED.roughness("tile_roughness", 0.35, 0.95), 0.4), normal_map=TILE_RELIEF)


TILES = _tiles("tiles", (0.16, 0.42, 0.40))
FLOOR = Material("stone", (0.78, 0.72, 0.64), roughness=0.35, specular=1,
                 colour_map=Texture(speckled("stone", STONE, 8), 0.6), normal_map=STONE_RELIEF)
PLASTER = Material("plaster", (0.80, 0.76, 0.70), roughness=1, normal_map=PLASTER_RELIEF)
WOOD = Material("oak", (1.0, 1.0, 1.0), roughness=0.45, specular=1, colour_map=OAK)
PAINT = Material("white_paint", (0.78, 0.77, 0.74), roughness=0.4, specular=1)
CERAMIC = Material("ceramic", (0.82, 0.81, 0.78), roughness=0.6, specular=1, clearcoat=1, clearcoat_roughness=0.1)
MIRROR = Material("mirror", (0.93, 0.94, 0.93), metallic=1, roughness=0, specular=1)
CHROME = Material("chrome", (0.65, 0.66, 0.67), metallic=1, roughness=0.08, specular=1)
GLASS = Material("glass", (1.0, 1.0, 1.0), roughness=0, specular=1, transmission=1, ior=1.52,
                 attenuation=(0.90, 0.97, 0.93), attenuation_metres=0.02)
GREEN_GLASS = Material("green_glass", (1.0, 1.0, 1.0), roughness=0, specular=1, transmission=1, ior=1.52,
                       attenuation=(0.30, 0.72, 0.42), attenuation_metres=0.01)
TOWEL = Material("towel", (0.74, 0.42, 0.22))


def _shell() -> list[Object]:
    walls = {"floor": FLOOR, "ceiling": PLASTER, "wall_right": TILES, "wall_back": TILES, "wall_front": PLASTER}
    return [*room_walls(WIDTH / 2, DEPTH / 2, HEIGHT, walls),
            placed("wall_window", PLASTER, WINDOW.islands(), 90, (-WIDTH / 2, 0, 0))]


def _frame(name: str, half_x: float, half_y: float, turn: float, base: Vec) -> list[Object]:
    """A mirror that faces +z before it is turned, in a wooden frame; its middle lies on `base`."""
    bar, deep, gap = 0.035, 0.02, 0.001
    sides = [box((s * (half_x + bar / 2), 0, deep / 2), (bar, 2 * (half_y - gap), deep)) for s in (-1, 1)]
    ends = [box((0, s * (half_y + bar / 2), deep / 2), (2 * (half_x + bar), bar, deep)) for s in (-1, 1)]
    return [placed(f"{name}", MIRROR, [rectangle((0, 0, 0.008), (half_x, 0, 0), (0, half_y, 0))], turn, base),
            placed(f"{name}_frame", WOOD, [face for part in (*sides, *ends) for face in part], turn, base)]


def _window_frame() -> list[Object]:
    return [placed(f"window_bar_{i}", PAINT, part, 90, (-WIDTH / 2, 0, 0)) for i, part in enumerate(WINDOW.frame(0.04), 1)]


def _wash_stand() -> list[Object]:
    """In the corner behind the window, below a mirror."""
    top, x, z = 0.82, -1.08, -1.53
    legs = [box((dx, 0.39, dz), (0.05, 0.78, 0.05)) for dx in (-0.33, 0.33) for dz in (-0.19, 0.19)]
    parts = [box((0, 0.80, 0), (0.76, 0.04, 0.48)), box((0, 0.22, 0), (0.61, 0.03, 0.33)), *legs]
    return [
        placed("wash_stand", WOOD, [face for part in parts for face in part], 0, (x, 0, z)),
        placed("basin", CERAMIC, basin(), 0, (x - 0.02, top + 0.001, z + 0.02)),
        placed("tap", CHROME, tap(), -90, (x - 0.02, top + 0.001, z - 0.215)),
        *[placed(f"towel_{i}", TOWEL, box((0, 0.025, 0), (0.34, 0.05, 0.26)), turn, (x, 0.237 + 0.051 * i, z))
          for i, turn in enumerate((2, -3, 1))],
        *_frame("mirror_stand", 0.30, 0.40, 0, (x, 1.60, -DEPTH / 2 + 0.001)),
    ]


def _in_the_sun() -> list[Object]:
    """Where the sun comes in: a bath, glass on a stool, and a tall mirror that sends the light on."""
    stool: Vec = (0.62, 0, -0.42)
    legs = [box((dx, 0.215, dz), (0.035, 0.43, 0.035)) for dx in (-0.15, 0.15) for dz in (-0.15, 0.15)]
    seat = [*box((0, 0.445, 0), (0.40, 0.03, 0.40)), *[face for leg in legs for face in leg]]
    top = 0.461
    return [
        placed("bath", CERAMIC, tub(), 0, (0.62, 0.001, -1.36)),
        placed("stool", WOOD, seat, 15, stool),
        placed("bottle_stool", GREEN_GLASS, bottle(), 0, (stool[0] - 0.07, top, stool[2] - 0.06)),
        placed("tumbler_stool", GLASS, tumbler(), 0, (stool[0] + 0.07, top, stool[2] + 0.06)),
        *_frame("mirror_wall", 0.36, 0.78, -90, (WIDTH / 2 - 0.001, 0.90, -0.45)),
    ]


def sunlit_bath() -> list[Object]:
    sill = 0.953
    return [
        *_shell(), *_window_frame(), *_wash_stand(), *_in_the_sun(),
        placed("bottle_sill", GLASS, bottle(), 0, (-1.59, sill, -0.55)),
        placed("glass_ball", GLASS, ball(0.055), 0, (-1.57, sill, 0.28)),
    ]
