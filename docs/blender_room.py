"""Models a room with a lamp in Blender and exports it for qtrace:

    blender -b --factory-startup --python docs/blender_room.py -- room.glb
"""

import math
import sys

import bpy

ROOM = 4.0    # metres, width and depth
HEIGHT = 2.6


def material(name: str, colour: tuple[float, float, float], emission: float = 0.0, roughness: float = 0.5,
             metallic: float = 0.0, specular: float = 0.0) -> bpy.types.Material:
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    inputs = result.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (*colour, 1)
    inputs["Roughness"].default_value = roughness
    inputs["Metallic"].default_value = metallic
    inputs["Specular"].default_value = specular  # 0: no reflection but at grazing angles
    if emission > 0:
        inputs["Emission"].default_value = (1, 0.85, 0.6, 1)
        inputs["Emission Strength"].default_value = emission
    # Without culling the exporter writes doubleSided, and a lamp shines to both sides.
    result.use_backface_culling = True
    return result


def plane(name: str, location: tuple[float, float, float], rotation: tuple[float, float, float],
          scale: tuple[float, float], look: bpy.types.Material) -> None:
    """A rectangle whose front faces along its own +z."""
    bpy.ops.mesh.primitive_plane_add(size=1, location=location, rotation=rotation)
    bpy.context.object.name = name
    bpy.context.object.scale = (*scale, 1)
    bpy.context.object.data.materials.append(look)


def solid(name: str, look: bpy.types.Material) -> None:
    bpy.context.object.name = name
    bpy.context.object.data.materials.append(look)


def model() -> None:
    quarter, half, middle = math.pi / 2, ROOM / 2, HEIGHT / 2
    white = material("white", (0.75, 0.75, 0.72))
    plane("floor", (0, 0, 0), (0, 0, 0), (ROOM, ROOM), material("boards", (0.45, 0.3, 0.2)))
    plane("ceiling", (0, 0, HEIGHT), (math.pi, 0, 0), (ROOM, ROOM), white)
    plane("wall_back", (0, half, middle), (quarter, 0, 0), (ROOM, HEIGHT), white)
    plane("wall_front", (0, -half, middle), (-quarter, 0, 0), (ROOM, HEIGHT), white)
    plane("wall_left", (-half, 0, middle), (0, quarter, 0), (HEIGHT, ROOM), material("red", (0.6, 0.1, 0.08)))
    plane("wall_right", (half, 0, middle), (0, -quarter, 0), (HEIGHT, ROOM), material("green", (0.12, 0.45, 0.15)))
    plane("lamp", (0.6, 0.4, HEIGHT - 0.3), (math.pi, 0, 0), (0.8, 0.8), material("lamp", (0, 0, 0), emission=12))
    bpy.ops.mesh.primitive_cube_add(size=0.7, location=(-0.7, 0.8, 0.35), rotation=(0, 0, 0.4))
    bpy.context.object.modifiers.new("round", "BEVEL").width = 0.05  # applied by the export
    solid("box", white)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=0.4, location=(0.6, 0.3, 0.4))
    bpy.ops.object.shade_smooth()
    solid("ball", material("metal", (0.9, 0.7, 0.4), metallic=1, roughness=0.25))


def set_camera() -> None:
    bpy.ops.object.camera_add(location=(0, -ROOM / 2 + 0.1, 1.3), rotation=(math.radians(85), 0, 0))
    camera = bpy.context.object
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(65)  # vertical: what qtrace takes from the file
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = 256, 192  # as width and height in the config


def main() -> None:
    file = sys.argv[sys.argv.index("--") + 1]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    model()
    set_camera()
    bpy.ops.export_scene.gltf(filepath=file, export_format="GLB", export_cameras=True, export_apply=True,
                              export_lights=False, export_animations=False, export_materials="EXPORT")


main()
