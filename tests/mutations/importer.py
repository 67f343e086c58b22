"""Deliberate errors of the importer (configs/importer), which its own tests must notice."""

from mutation import Mutation


def _of(file: str, name: str, find: str, replace: str) -> Mutation:
    return Mutation(name, f"configs/importer/{file}", find, replace)


IMPORTER_MUTATIONS = [
    _of("moves.py", "rotations by the left hand", "sin(angle) * cross +", "sin(-angle) * cross +"),
    _of("mitsuba/transforms.py", "Mitsuba's look-at with +x to the right", "left = _unit(np.cross(up, direction)", "left = _unit(np.cross(direction, up)"),
    _of("mitsuba/camera.py", "Mitsuba's camera not turned round", "np.diag([-1.0, 1.0, -1.0, 1.0])", "np.diag([1.0, 1.0, 1.0, 1.0])"),
    _of("mitsuba/camera.py", "a field of view always across", 'if axis == "y":\n        tangent *= aspect', 'if axis == "y":\n        tangent *= 1'),
    _of("mitsuba/camera.py", "a crop as wide as the film", "of_whole = crop[1] / size[1]", "of_whole = 1"),
    _of("mitsuba/lights.py", "Mitsuba's sky by half a turn off", "_MITSUBA_FROM_SKY = np.diag([-1.0, 1.0, -1.0])", "_MITSUBA_FROM_SKY = np.diag([1.0, 1.0, 1.0])"),
    _of("mitsuba/lights.py", "Mitsuba's spots along -z", "tuple(_direction(to_world[:3, 2], emitter))", "tuple(-_direction(to_world[:3, 2], emitter))"),
    _of("mitsuba/textures.py", "colours of a checkerboard exchanged", 'self.colour(plugin, "color0", 0.4, use), self.colour(plugin, "color1", 0.2, use)', 'self.colour(plugin, "color1", 0.2, use), self.colour(plugin, "color0", 0.4, use)'),
    _of("mitsuba/textures.py", "to_uv left out", "return to_uv @ old", "return old[:2]"),
    _of("mitsuba/materials.py", "every plastic by version 3's count", "0 if bsdf.is_old else 3", "3"),
    _of("materials/roughness.py", "alpha for glTF's roughness", "lambda a: np.sqrt(np.clip(a, 0.0, 1.0))", "lambda a: np.clip(a, 0.0, 1.0)"),
    _of("materials/roughness.py", "pbrt-v4's roughness not remapped", "return np.sqrt(np.maximum(roughness, 0.0))", "return np.maximum(roughness, 0.0)"),
    _of("materials/roughness.py", "pbrt-v3's polynomial without its last term", " + 0.000640711 * x ** 4", ""),
    _of("materials/metals.py", "metals by eta alone", "((n - 1.0) ** 2 + absorption ** 2) / ((n + 1.0) ** 2 + absorption ** 2)", "((n - 1.0) ** 2 + 0 * absorption) / ((n + 1.0) ** 2)"),
    _of("materials/conductors.py", "dark metals with white rims", "specular=strength, ior=0.0,", "specular=1.0, ior=0.0,"),
    _of("materials/glass.py", "thin walls with one face", "return 2.0 * reflectance / (1.0 + reflectance)", "return 1.0 * reflectance"),
    _of("materials/glass.py", "bubbles in glass as glass", "make = InwardGlass if eta < 1.0 else Material", "make = Material"),
    _of("materials/plastics.py", "plastics without what is reflected inside", "return rho / (eta ** 2 * (1.0 - (rho * inside if is_nonlinear else inside)))", "return rho / (eta ** 2 * (1.0 - 0 * inside))"),
    _of("materials/fresnel.py", "Fresnel's mean of both polarisations as one of them", "0.5 * (parallel ** 2 + perpendicular ** 2), 1.0)", "parallel ** 2, 1.0)"),
    _of("meshes/orient.py", "smooth normals without their angles", "faces[:, axis] * angle", "faces[:, axis]"),
    _of("meshes/orient.py", "fronts by the corners' order alone", "triangles[side < 0] = triangles[side < 0][:, ::-1]", ""),
    _of("meshes/primitives.py", "rectangles half as large", "corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)", "corners = 0.5 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], float)"),
    _of("meshes/primitives.py", "pbrt's disks from the inner radius", "np.array([1.0, 0.0]))\n    return revolved(profile, _phi(phimax), SEGMENTS, \"disk\")", "np.array([0.0, 1.0]))\n    return revolved(profile, _phi(phimax), SEGMENTS, \"disk\")"),
    _of("meshes/revolved.py", "round things inside out", "if normal @ (way[1], -way[0]) < 0:", "if normal @ (way[1], -way[0]) > 0:"),
    _of("images/bake.py", "textures joined without their mappings", "return _square(texture.image_from_uv) @ np.linalg.inv(matrix)", "return np.eye(3)"),
    _of("images/bake.py", "texels by half a texel off", "x, y = u * width - 0.5, v * height - 0.5", "x, y = u * width, v * height"),
    _of("pbrt/transforms.py", "pbrt's matrices row by row", "return numbers.reshape(4, 4).T.copy()", "return numbers.reshape(4, 4).copy()"),
    _of("pbrt/camera.py", "pbrt's camera not mirrored", "_FROM_GLTF = np.diag([1.0, 1.0, -1.0, 1.0])", "_FROM_GLTF = np.diag([-1.0, 1.0, -1.0, 1.0])"),
    _of("pbrt/state.py", "ReverseOrientation said twice", "is_reversed=not self.now.is_reversed", "is_reversed=True"),
    _of("pbrt/skies.py", "pbrt's sky mirrored", "[[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]", "[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]"),
    _of("pbrt/octahedral.py", "the lower half of the octahedron not folded", "s, t = np.where(is_below, 1 - t, s), np.where(is_below, 1 - s, t)", "s, t = s, t"),
    _of("pbrt/octahedral.py", "rows of the sky of the same weight", "share = np.sin(colatitude).reshape(count, fine)", "share = np.ones_like(colatitude).reshape(count, fine)"),
    _of("pbrt/world.py", "a lamp's power without pi", "count * power / (math.pi * area", "count * power / (area"),
    _of("pbrt/lights.py", "spots' power by the whole sphere", "steradians = 2 * math.pi * ((1 - cosines[1]) + (cosines[1] - cosines[0]) / 2)", "steradians = 4 * math.pi + 0 * cosines[0]"),
    _of("output/world.py", "a mirrored camera in an unmirrored world", "turn = _MIRROR if _is_mirroring(scene.camera) else np.eye(3)", "turn = np.eye(3)"),
    _of("output/world.py", "the sky turned the other way", "math.degrees(math.atan2(sky[0, 2], sky[2, 2]))", "math.degrees(math.atan2(-sky[0, 2], sky[2, 2]))"),
    _of("output/geometry.py", "mirrored meshes with their corners' order", "mesh.triangles[:, [0, 2, 1]] if volume < 0 else mesh.triangles", "mesh.triangles"),
    _of("output/geometry.py", "normals by the matrix of positions", "normals = mesh.normals @ cofactors.T", "normals = mesh.normals @ axes.T"),
    _of("output/textures.py", "textures turned the other way", "cosine, sine = (u[0], -u[1])", "cosine, sine = (u[0], u[1])"),
    _of("output/pixels.py", "roughness in the red channel", "return np.stack([ones, linear[..., 0], ones], axis=2)", "return np.stack([linear[..., 0], ones, ones], axis=2)"),
    _of("output/materials.py", "emission above 1 cut off", "factor = [channel / strength for channel in factor]", "factor = [min(channel, 1.0) for channel in factor]"),
]
