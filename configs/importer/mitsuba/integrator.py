"""<integrator>: how long paths are. How light is sampled does not change what a picture converges to."""

from __future__ import annotations

from importer.mitsuba.plugin import Plugin
from importer.problems import ImportProblem, Notes

# All of them solve the whole equation of light transport (their documentation; "direct" one bounce of it).
INTEGRATORS = {"path", "volpath", "volpath_simple", "volpathmis", "bdpt", "ptracer", "pssmlt", "mlt", "erpt", "vpl", "sppm",
               "ppm", "photonmapper", "guided_path", "prb", "prb_basic", "prbvolpath", "direct"}
_AROUND = {"aov", "moment", "stokes", "irrcache", "adaptive", "multichannel"}
_PLAIN = ("rr_depth", "samples", "shading_samples", "emitter_samples", "bsdf_samples", "sample_count", "light_image",
          "sample_direct", "luminance_samples", "direct_samples", "direct_sampling", "mutations", "aovs", "granularity",
          "photon_count", "max_passes", "initial_radius", "alpha", "block_size", "timeout", "gather_locally",
          "auto_cancel_gathering")
_MAX_BOUNCES = 1_000_000


def read_max_bounces(integrator: Plugin | None, notes: Notes) -> int | None:
    """Mitsuba's max_depth counts the edges of a path: 1 is what is seen directly, -1 sets no limit."""
    while integrator and integrator.type in _AROUND:
        integrator.ignore(*_PLAIN)
        inner = integrator.all_of("integrator")
        integrator.note_rest(notes)
        integrator = inner[0] if inner else None
    if not integrator:
        return None
    if integrator.type not in INTEGRATORS:
        notes.approximated(f"the integrator \"{integrator.type}\" as one of full light transport", integrator.where)
    depth = 2 if integrator.type == "direct" else integrator.integer("max_depth", -1)
    integrator.ignore(*_PLAIN)
    if depth < -1 or depth > _MAX_BOUNCES:
        raise ImportProblem(f"{integrator.where}: \"max_depth\" is {depth}; a length up to {_MAX_BOUNCES} or -1 is right")
    if integrator.boolean("hide_emitters", False):
        notes.left_out("hide_emitters: what shines is seen by the camera here", integrator.where)
    if integrator.boolean("strict_normals", False):
        notes.left_out("strict_normals", integrator.where)
    if others := sorted(integrator.properties.keys() - {"max_depth", "hide_emitters", "strict_normals", *_PLAIN}):
        notes.left_out(f"parameters of the integrator \"{integrator.type}\": {', '.join(others)}", integrator.where)
        integrator.ignore(*others)
    integrator.note_rest(notes)
    return None if depth == -1 else max(depth - 1, 0)
