"""A corridor lit round two corners: three straight parts in the shape of a Z. The only lamp hangs at the end of the first part,
and the camera stands at the end of the third, which nothing reaches that the middle part has not reflected."""

from __future__ import annotations

from faceted import vase
from furniture import cabinet, chair
from gltf_writer import Camera, Material, Object
from models import head, teapot
from placing import placed
from shapes import Vec, box, rectangle
from unwrap import Island, pack

HEIGHT = 2.4
# The walls' corners, x and z, seen from above with what is inside on the left of each wall: 1.4 metres from wall to wall.
OUTLINE = [(0.0, 0.0), (4.4, 0.0), (4.4, 4.4), (8.6, 4.4), (8.6, 5.8), (3.0, 5.8), (3.0, 1.4), (0.0, 1.4)]
# Floors and ceilings: lower and upper corner of each part.
PARTS = {"first": ((0.0, 0.0), (4.4, 1.4)), "middle": ((3.0, 1.4), (4.4, 4.4)), "last": ((3.0, 4.4), (8.6, 5.8))}
LAMP: Vec = (0.8, HEIGHT - 0.06, 0.7)  # the panel's middle

CAMERA = Camera(eye=(8.2, 1.5, 5.3), target=(4.0, 1.0, 5.0), vertical_fov=56)

FLOOR = Material("tiles", (0.55, 0.50, 0.45))
CEILING = Material("ceiling", (0.85, 0.85, 0.85))
PLASTER = Material("plaster", (0.78, 0.76, 0.72))
BLUE = Material("blue_plaster", (0.42, 0.54, 0.68))
WOOD = Material("wood", (0.46, 0.29, 0.17))
CLAY = Material("clay", (0.74, 0.44, 0.34))
GLAZE = Material("glaze", (0.35, 0.60, 0.62))
MARBLE = Material("marble", (0.82, 0.82, 0.80))
FRAME = Material("frame", (0.30, 0.22, 0.14))
CANVASES = [Material("canvas_red", (0.64, 0.24, 0.18)), Material("canvas_green", (0.28, 0.48, 0.30)),
            Material("canvas_ochre", (0.72, 0.56, 0.26))]
HOUSING = Material("housing", (0.30, 0.30, 0.30))
LIGHT = Material("light", (0, 0, 0), (900.0, 780.0, 620.0))


def _wall(start: tuple[float, float], end: tuple[float, float]) -> Island:
    along = ((end[0] - start[0]) / 2, 0.0, (end[1] - start[1]) / 2)
    centre = ((start[0] + end[0]) / 2, HEIGHT / 2, (start[1] + end[1]) / 2)
    return rectangle(centre, along, (0, HEIGHT / 2, 0))


def _shell() -> list[Object]:
    objects = []
    for i, start in enumerate(OUTLINE):
        wall = _wall(start, OUTLINE[(i + 1) % len(OUTLINE)])
        objects.append(Object(f"wall_{i + 1}", pack([wall]), BLUE if i in (1, 5) else PLASTER))
    for name, (lo, hi) in PARTS.items():
        x, z = (lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2
        u, v = (hi[0] - lo[0]) / 2, (hi[1] - lo[1]) / 2
        objects += [Object(f"floor_{name}", pack([rectangle((x, 0, z), (u, 0, 0), (0, 0, -v))]), FLOOR),
                    Object(f"ceiling_{name}", pack([rectangle((x, HEIGHT, z), (u, 0, 0), (0, 0, v))]), CEILING)]
    return objects


def _lamp() -> list[Object]:
    x, y, z = LAMP
    return [placed("lamp_housing", HOUSING, box((x, y + 0.03, z), (0.5, 0.05, 0.5))),
            placed("lamp", LIGHT, [rectangle((x, y, z), (0.2, 0, 0), (0, 0, 0.2))])]


def _pictures() -> list[Object]:
    """Along the last part's further wall, which ends at z = 5.8."""
    objects = []
    for i, canvas in enumerate(CANVASES):
        x = 4.3 + 1.2 * i
        objects += [placed(f"frame_{i + 1}", FRAME, box((x, 1.5, 5.78), (0.7, 0.5, 0.03))),
                    placed(f"canvas_{i + 1}", canvas, box((x, 1.5, 5.76), (0.58, 0.38, 0.012)))]
    return objects


def corridor() -> list[Object]:
    return [
        *_shell(), *_lamp(), *_pictures(),
        placed("cabinet", WOOD, cabinet(0, 0), 180, (6.2, 0, 5.5)),
        placed("chair", WOOD, chair(0, 0), 200, (4.6, 0, 4.9)),
        placed("teapot", GLAZE, teapot(30, (0, 0, 0)), 0, (6.3, 0.781, 5.5)),
        placed("vase", CLAY, vase(), 0, (3.5, 0, 5.2)),
        placed("head", MARBLE, head(0.42, -70, (0, 0, 0)), 0, (5.9, 0.781, 5.5)),
        placed("plinth", MARBLE, box((3.7, 0.4, 2.4), (0.35, 0.8, 0.35))),
    ]
