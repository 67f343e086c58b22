"""What protects the hard cases of configs/stability.json: each with an edit that takes it out."""

from __future__ import annotations

from dataclasses import dataclass

from tree import Edit


@dataclass(frozen=True)
class Protection:
    name: str
    cases: tuple[str, ...]  # of stability.json; or of the test suite HardCases, where is_test
    edits: tuple[Edit, ...]
    is_test: bool = False


SURFACE, INTERSECT, NEE = "shaders/geometry/surface.glsl", "shaders/geometry/intersect.glsl", "shaders/light/nee.glsl"
ORIGIN = "return s.position + s.offset * (side * s.geometric_normal + s.inwards);"
OFFSET = "s.offset = OFFSET_FRACTION * max_component(max(abs(v0), max(abs(v1), abs(v2))));"
INSIDE = "bool inside = all(greaterThanEqual(weights, vec3(0.0))) || all(lessThanEqual(weights, vec3(0.0)));"
HAS_AREA = ("return twice_area > kMinRelativeHeight * longest && "
            "twice_area >= std::numeric_limits<float>::min();")

# Where a case depends on no line that was written for it alone, an error stands in for one that the case is there to
# see. Triangles without area are not here: kept by the loader, and with NaN taken for a hit besides, they still leave the
# picture as it is.
PROTECTIONS = [
    Protection("edges belong to their triangles", ("white furnace", "camera in geometry"), (Edit(
        INTERSECT, INSIDE,
        "float margin = 1e-4 * abs(weights.x + weights.y + weights.z);\n"
        "  bool inside = all(greaterThanEqual(weights, vec3(margin))) || all(lessThanEqual(weights, vec3(-margin)));"),)),
    Protection("rays leave surfaces off them and off their edges", ("white furnace", "camera in geometry"),
               (Edit(SURFACE, ORIGIN, "return s.position;"),)),
    Protection("scenes far from the origin are moved there", ("white furnace, moved", "room, moved 10,000"), (Edit(
        "engine/gltf/origin.cpp", "constexpr double kFar = 64;", "constexpr double kFar = 1e30;"),)),
    Protection("the power heuristic by a ratio, not by squares", ("grazing light",), (
        Edit(NEE, "return 1.0 / (1.0 + ratio * ratio);", "return pdf * pdf / (pdf * pdf + other * other);"),
        Edit(NEE, "  if (contribution == vec3(0.0)) return contribution;\n", ""))),
    Protection("triangles are too flat by their shape, not by a size", ("tiny bright light",), (Edit(
        "engine/gltf/triangle.cpp", HAS_AREA,
        "return kMinRelativeHeight > 0 && twice_area > 1e-4;"),)),
    Protection("ray offsets by the scene's size, not a constant", ("room, scaled 0.001",),
               (Edit(SURFACE, OFFSET, "s.offset = 1e-3;"),)),
    Protection("no length is too far", ("room, scaled 10,000",), (Edit(
        "shaders/geometry/traverse.glsl", "nearest_hit(origin, direction, INFINITY)", "nearest_hit(origin, direction, 1e4)"),)),
    Protection("a light's triangles are chosen by their area", ("slivers",), (Edit(
        "shaders/light/lights.glsl", "return fraction <= link.z ? triangle : link.x;", "return triangle;"),)),
    Protection("doubled triangles are dropped", ("doubled triangles",), (Edit(
        "engine/gltf/load_gltf.cpp", "  drop_duplicates(source, scene);\n", ""),)),
    Protection("mirrored nodes turn their triangles round", ("mirrored nodes",), (Edit(
        "engine/gltf/triangle.cpp", "if (is_mirrored(primitive, vertices[0])) std::swap",
        "if (is_mirrored(primitive, vertices[0]) && index > 1u << 30u) std::swap"),)),
    Protection("sums in double precision", ("AMillionFramesKeepTheMean", "AMillionFramesAfterAFireflyDoNotStall"),
               (Edit("shaders/passes/pixel_sum.glsl", "  sum.r += weighed.r;",
                     "  sum.r = double(float(sum.r) + float(weighed.r));"),), True),
    Protection("visit counters stop at their limit", ("VisitCountersAtTheirLimitDoNotWrap",), (Edit(
        "shaders/learning/storage.glsl",
        "q_visits[entry] = min(q_visits[entry], 0x7fffffffu) + min(targets, 0x7fffffffu);",
        "q_visits[entry] = q_visits[entry] + targets;"),), True),
    Protection("targets are clamped", ("TargetsBeyondTheFixedPointAreCounted",), (Edit(
        "shaders/learning/actions.glsl", "float units = round(min(target, TARGET_LIMIT));", "float units = round(target);"),), True),
    Protection("full sums stay full", ("TargetsBeyondTheFixedPointAreCounted",), (Edit(
        "shaders/learning/target_sums.glsl", "  if (is_full(sum)) return float(SUM_HIGH_FULL) * SUM_HIGH_UNIT;\n", ""),), True),
    Protection("bins have a floor, and none vanishes", ("TableEntriesAtBothEndsOfTheirRangeKeepTheImage",), (Edit(
        "shaders/passes/learn.comp", "uint floor_width = uint(floor_share * (FLOOR_RANGE / float(BINS)));",
        "uint floor_width = 0u;"),), True),
    Protection("counts run over into the next word", ("AMillionUpdatesOfOneEntryAreTheirMean",), (Edit(
        "shaders/learning/actions.glsl", "counted = (before & SUM_LOW_COUNT) == SUM_LOW_COUNT ? 1u : 0u;", "counted = 0u;"),), True),
    Protection("emission met after a light sample is weighted", ("room",), (Edit(
        NEE, "float sampled = light_pdf(cell, s.light, t, direction);", "float sampled = 0.0;"),)),
    Protection("specular directions have the density that they are drawn with",
               ("metal of roughness 0.05", "dielectric of roughness 0.05"), (Edit(
        "shaders/material/microfacet.glsl", "ggx_distribution(n, h, alpha) * 0.25;", "ggx_distribution(n, h, alpha) * 0.2;"),)),
    Protection("what does not emit is black", ("no light",), (Edit(
        "shaders/material/emission.glsl", "return s.back && emission.w == EMITS_FRONT ? vec3(0.0) : emission.rgb;", "return emission.rgb + 1e-3;"),)),
    Protection("the environment is met after every event", ("environment alone",), (Edit(
        "shaders/path/trace.glsl",
        "weight = bounce == 0u ? 1.0 : environment_weight(path.direction, path.pdf, path.cell, chain_of(path));",
        "weight = bounce > 0u ? 0.0 : 1.0;"),)),
    Protection("a tree of one leaf has a node", ("one triangle",), (Edit(
        "engine/device_scene/wide_nodes.cpp", "uvec4(corners(bvh_.nodes[0]), 0), uvec4(0, 0, link(0), link(0))",
        "uvec4(0), uvec4(0, 0, link(0), link(0))"),)),
    Protection("links have room for millions of triangles", ("five million triangles",), (Edit(
        "shaders/geometry/wide_nodes.glsl", "return (leaf & ~LEAF_LINK) >> LEAF_BITS;",
        "return ((leaf & ~LEAF_LINK) >> LEAF_BITS) & 0x3fffffu;"),)),
]
