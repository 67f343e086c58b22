"""The pbrt front end: a scene file of pbrt-v4 or pbrt-v3 as a `Scene`."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from importer.pbrt import materials_v3, materials_v4
from importer.pbrt.camera import exposure_time, read_camera
from importer.pbrt.exposure import expose
from importer.pbrt.film import Film, read_film
from importer.pbrt.lights import Lights
from importer.pbrt.materials import Materials
from importer.pbrt.options import note_filter, read_max_bounces, read_option
from importer.pbrt.parameters import Parameters
from importer.pbrt.shapes import Shapes
from importer.pbrt.skies import Skies
from importer.pbrt.source import Folder
from importer.pbrt.spectra import Spectra
from importer.pbrt.state import States, collected
from importer.pbrt.statements import Statement, read_statements
from importer.pbrt.textures import Textures
from importer.pbrt.version import version_of
from importer.pbrt.world import World
from importer.problems import ImportProblem, Notes
from importer.scene import Camera, Scene

_BEFORE_THE_WORLD = ("Camera", "Film", "PixelFilter", "Integrator", "Sampler", "Accelerator", "Option")
_IN_THE_WORLD = ("Shape", "LightSource", "AreaLightSource", "ObjectBegin", "ObjectEnd", "ObjectInstance",
                 "ReverseOrientation", "Material", "NamedMaterial", "MakeNamedMaterial", "Texture")


def read_pbrt(path: Path, notes: Notes) -> Scene:
    """Raises ImportProblem for what cannot be read, and says in `notes` what is approximated."""
    if not path.is_file():
        raise ImportProblem(f"{path}: the scene is missing; it must be a .pbrt file")
    folder = Folder(path)
    statements = list(read_statements(path, folder))
    return _Reader(path, folder, notes, version_of(statements)).read(statements)


class _Reader:
    """Carries one scene's statements out."""

    def __init__(self, path: Path, folder: Folder, notes: Notes, version: int) -> None:
        self._path = path
        self._notes = notes
        self._version = version
        spectra = Spectra(folder, notes, version)
        textures = Textures(folder, spectra, notes, version)
        makers = materials_v4 if version == 4 else materials_v3
        materials = Materials(makers.MAKERS, makers.REFUSED, textures, spectra, notes, version)
        self._states = States(notes, version)
        self._world = World(Shapes(folder, notes), materials, textures, spectra, notes, version)
        self._lights = Lights(spectra, notes, version)
        self._skies = Skies(folder, spectra, notes, version)
        self._scene = Scene(path.name.split(".")[0], Camera(np.eye(4)), source_version=str(version))
        self._options: dict[str, Statement] = {}
        self._camera_from_world = np.eye(4)
        self._is_world = False

    def read(self, statements: list[Statement]) -> Scene:
        """Takes the list apart."""
        if self._version == 4:
            self._states = collected(statements, self._notes)
        statements.reverse()
        while statements:
            self._carry_out(statements.pop())  # so that a mesh's numbers are freed once they are a mesh
        self._states.check_closed()
        if not self._is_world:
            raise ImportProblem(f"{self._path.name}: there is no WorldBegin; the scene's shapes must follow one")
        self._scene.parts = self._world.parts
        self._scene.sky = self._skies.sky()
        self._finish()
        return self._scene

    def _carry_out(self, statement: Statement) -> None:
        directive, place = statement.directive, statement.place
        if directive in _BEFORE_THE_WORLD or directive in _IN_THE_WORLD:
            self._check_order(statement, directive in _IN_THE_WORLD)
        if self._states.apply(statement):
            return
        if directive.endswith(("Begin", "End")):
            self._bracket(statement)
        elif directive == "Option":
            read_option(statement, self._notes)
        elif directive in _BEFORE_THE_WORLD:
            self._options[directive] = statement  # of Sampler and Accelerator the converged picture has nothing
            if directive == "Camera":
                self._camera_from_world = self._states.now.to_world
        elif directive in ("Material", "NamedMaterial", "MakeNamedMaterial", "Texture", "AreaLightSource"):
            self._define(statement)
        elif directive == "MediumInterface":
            self._states.now = replace(self._states.now, medium=self._world.media.inside(statement))
        elif directive == "MakeNamedMedium":
            name = statement.strings[0]
            self._world.media.define(name, self._states.parameters(statement, f'the medium "{name}"', "medium"),
                                     self._states.now.colour_space)
        elif directive == "TransformTimes":
            self._notes.left_out("the times of a movement (TransformTimes)", str(place))
        else:
            self._add(statement)

    def _check_order(self, statement: Statement, is_of_the_world: bool) -> None:
        if is_of_the_world and not self._is_world:
            raise ImportProblem(f"{statement.place}: {statement.directive} stands before WorldBegin; it must follow it")
        if not is_of_the_world and self._is_world:
            raise ImportProblem(f"{statement.place}: {statement.directive} stands behind WorldBegin; it must precede it")

    def _bracket(self, statement: Statement) -> None:
        if statement.directive == "WorldBegin":
            if self._is_world:
                raise ImportProblem(f"{statement.place}: a second WorldBegin; a scene has one")
            self._is_world = True
        elif statement.directive == "ObjectBegin":
            self._world.begin_object(statement)
        elif statement.directive == "ObjectEnd":
            self._world.end_object(statement.place)
        self._states.bracket(statement)

    def _define(self, statement: Statement) -> None:
        directive, states = statement.directive, self._states
        name = statement.strings[0]
        if directive == "NamedMaterial":
            if name not in states.now.materials:
                raise ImportProblem(f'{statement.place}: there is no material "{name}"; MakeNamedMaterial must define it')
            states.now = replace(states.now, material=states.now.materials[name])
        elif directive == "Material":
            states.now = replace(states.now, material=states.definition(statement, f'the material "{name}"', "material"))
        elif directive == "AreaLightSource":
            if name not in ("diffuse", "area"):
                raise ImportProblem(f'{statement.place}: there is no area light "{name}"; it must be diffuse')
            states.now = replace(states.now, area_light=states.definition(statement, f'the area light "{name}"', "light"))
        else:
            states.define(statement)

    def _add(self, statement: Statement) -> None:
        now = self._states.now
        kind = statement.strings[0]
        if statement.directive == "Shape":
            self._world.add_shape(kind, self._states.parameters(statement, f'the shape "{kind}"', "shape"), now)
        elif statement.directive == "ObjectInstance":
            self._world.add_instance(statement, now.to_world)
        else:
            parameters = self._states.parameters(statement, f'the light "{kind}"', "light")
            if kind in ("infinite", "exinfinite"):
                self._skies.read(parameters, now.to_world, now.colour_space)
                return
            light = self._lights.read(kind, parameters, now.to_world, now.colour_space)
            if light is not None:
                self._scene.lights.append(light)

    def _finish(self) -> None:
        """The camera, whose picture and exposure depend on the film, and the rest of what precedes the world."""
        film_statement = self._options.get("Film")
        film = Film()
        if film_statement is not None:
            film = read_film(film_statement.strings[0], self._of_option("Film"), self._notes, self._version)
        camera = self._options.get("Camera")
        if camera is None:
            raise ImportProblem(f"{self._path.name}: the scene has no Camera; it must have one")
        parameters = self._of_option("Camera")
        exposure = film.exposure * exposure_time(parameters, self._version)
        self._scene.camera = read_camera(camera.strings[0], parameters, np.linalg.inv(self._camera_from_world), film,
                                         self._notes)
        if exposure != 1.0:
            expose(self._scene, exposure)
            self._notes.approximated("the exposure of the film as brighter or darker lights", str(camera.place))
        integrator = self._options.get("Integrator")
        self._scene.max_bounces = 5 if integrator is None else read_max_bounces(integrator.strings[0],
                                                                               self._of_option("Integrator"), self._notes)
        note_filter(self._options.get("PixelFilter"), self._path.name, self._version, self._notes)

    def _of_option(self, directive: str) -> Parameters:
        statement = self._options[directive]
        return Parameters(statement.parameters, statement.place, f'the {directive.lower()} "{statement.strings[0]}"')
