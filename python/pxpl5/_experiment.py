"""Experiments: a machine, a pipeline, a scene and a head, given as keywords or as an experiment file."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING

from . import _html, _native, _pickle
from ._checks import Strict, choice, names, optional, whole
from ._errors import RunError, SettingError
from ._head import Head
from ._machine import Machine, Parameter, parameter_table
from ._names import LevelName, MachineName, PipelineName, PixelsName, QuantityName
from ._native import Motion, Scene, Table
from ._outcome import Outcome
from ._progress import Progress, reporting
from ._stepper import Stepper
from ._tables import table_of
from ._toml import toml_of
from ._types import PolicyFrame

if TYPE_CHECKING:
    from ._rows import ParameterRow, WhatIfRow
    from ._saved import ExperimentState

#: A function that gets a frame and returns (region, renderer) for every region, in the order of sending.
Policy = Callable[[PolicyFrame], Sequence[tuple[int, int]]]


class Made:
    """Settings as the library takes them, with what cannot be named in them."""

    def __init__(self) -> None:
        self.settings = _native.Settings()
        self.scene: Scene | None = None
        self.motion: Motion | None = None
        self.policy: Policy | None = None
        self.phong = True

    def put(self, path: str, value: object) -> None:
        """Sets a path."""
        self.settings.set(f"{path}={toml_of(value)}", f"keyword {path}")

    def put_all(
        self,
        pipeline: str | PolicyPipeline | None,
        scene: str | PathLike[str] | Scene | None,
        machine: str | Machine | None,
        head: str | Head | None,
        keys: Mapping[str, object],
    ) -> None:
        """Sets what keywords say; a key whose value is None is not set."""
        self._put_pipeline(pipeline)
        self._put_scene(scene)
        self._put_machine(machine)
        self._put_head(head)
        for path, value in keys.items():
            if value is not None:
                self.put(path.replace("__", "."), value)

    def _put_pipeline(self, pipeline: str | PolicyPipeline | None) -> None:
        if isinstance(pipeline, PolicyPipeline):
            # What the firmware is told apart by is its own; keys and checks are those of the nearest in the registry.
            self.policy = pipeline.policy
            self.phong = pipeline.shading == "phong"
            self.put("pipeline", "rendering-control")
        elif isinstance(pipeline, str):
            self.put("pipeline", pipeline)
        elif pipeline is not None:
            raise SettingError(f"pipeline: expected a name or a PolicyPipeline, found {pipeline!r}")

    def _put_scene(self, scene: str | PathLike[str] | Scene | None) -> None:
        if isinstance(scene, Scene):
            self.scene = scene
            self.put("scene", "full-screen:1")
        elif isinstance(scene, (str, PathLike)):
            self.put("scene", fspath(scene))
        elif scene is not None:
            raise SettingError(f"scene: expected a name, a path or a Scene, found {scene!r}")

    def _put_head(self, head: str | Head | None) -> None:
        if isinstance(head, str):
            self.put("head.motion", head)
        elif isinstance(head, Head):
            self.motion = head.moving()
            for path, value in head.settings().items():
                self.put(path, value)
        elif head is not None:
            raise SettingError(f"head: expected the name of a motion or a Head, found {head!r}")

    def _put_machine(self, machine: str | Machine | None) -> None:
        if isinstance(machine, Machine):
            self.put("machine.preset", machine.preset)
            for path, value in machine.changes.items():
                self.put(f"machine.{path}", value)
        elif isinstance(machine, str):
            self.put("machine.preset", machine)
        elif machine is not None:
            raise SettingError(f"machine: expected the name of a preset or a Machine, found {machine!r}")

    def check_scene(self, keys: Mapping[str, object]) -> None:
        """A scene that was given as such is drawn as it is."""
        given = [key for key in ("triangles", "cull", "fit") if keys.get(key) is not None]
        if self.scene is not None and given:
            methods = "Scene.decimated, Scene.culled or the scene's own fit"
            raise SettingError(f"keyword {given[0]}: expected the name of a scene beside it, found a Scene; use {methods}")


class PolicyPipeline(Strict):
    """A pipeline of one's own: one graphics processor draws mono frames, and a callable says which renderer draws what.

    ``policy(frame)`` is asked when TRANSFORM is done. ``frame`` is a dictionary: ``frame`` (its number), ``time_s`` (simulated
    seconds), ``columns`` (regions in a row), ``primitives`` (a list, how many each region has, row by row) and ``renderers`` (how
    many there are). It returns a list of (region, renderer) with every region once, in the order in which they are sent.

    What it raises ends the run, and is raised there. The same frame must always get the same answer: a run may be repeated to tell
    whether it is stuck, or when views are seen.
    """

    _fields = ("policy", "shading")

    def __init__(self, policy: Policy, *, shading: str = "phong") -> None:
        self.policy = policy
        self.shading = choice("shading", shading, ("phong", "gouraud"))

    def __repr__(self) -> str:
        return f"<pxpl5.PolicyPipeline {getattr(self.policy, '__qualname__', 'callable')}, {self.shading}>"


class Experiment(Strict):
    """A pipeline on a machine with a scene.

    - ``pipeline``: a name of :func:`pipelines`, or a :class:`PolicyPipeline`.
    - ``scene``: a built-in name, the path of a model file (PLY, OBJ, STL, PDB), or a :class:`Scene`.
    - ``machine``: a preset or a :class:`Machine`; default: the one on which the pipeline was published.
    - ``head``: a :class:`Head`, or the name of a motion; default: the scene's own motion, followed without delay.
    - ``fields``: periods of the display to simulate, NTSC fields of 1/60 s; default 120.
    - ``seed``, ``level`` (transaction or cycle; analytic for :meth:`measure`), ``pixels`` (off, lazy or all), ``triangles`` (the scene
      thinned out to so many), ``measure`` (names of :func:`quantities`), and any other key of :func:`keys` as a keyword, with ``__``
      for a point: ``copy="whole"``, ``motion__sway=0.5``.
    - ``settings``: keys that are not Python names, by path, such as ``{"machine.gp.triangle_ns": 30_000}``.

    Raises :class:`SettingError` for the first setting that is wrong or missing.
    """

    def __init__(
        self,
        pipeline: PipelineName | str | PolicyPipeline | None = None,
        scene: str | PathLike[str] | Scene | None = None,
        *,
        machine: MachineName | str | Machine | None = None,
        head: str | Head | None = None,
        fields: int | None = None,
        seed: int | None = None,
        level: LevelName | str | None = None,
        pixels: PixelsName | str | None = None,
        triangles: int | None = None,
        measure: QuantityName | Sequence[QuantityName | str] | None = None,
        settings: Mapping[str, object] | None = None,
        **keys: object,
    ) -> None:
        given: dict[str, object] = {"fields": fields, "seed": seed, "level": level, "pixels": pixels, "triangles": triangles}
        given |= {"measure": None if measure is None else names("measure", measure), **keys, **(settings or {})}
        made = Made()
        made.put_all(pipeline, scene, machine, head, given)
        made.check_scene(given)
        self._take(made)

    @classmethod
    def from_file(cls, path: str | PathLike[str], settings: Mapping[str, object] | None = None) -> Experiment:
        """An experiment file (TOML), as ``pxpl5 run FILE`` takes it, with some keys otherwise.

        Raises :class:`SettingError` with the file, the line, what was expected and what was found.
        """
        made = Made()
        made.settings.load(Path(path))
        made.put_all(None, None, None, None, settings or {})
        experiment = cls.__new__(cls)
        experiment._take(made)
        return experiment

    @classmethod
    def from_text(cls, text: str, settings: Mapping[str, object] | None = None) -> Experiment:
        """The same of the text of an experiment file.

        Raises :class:`SettingError` as :meth:`from_file`.
        """
        made = Made()
        made.settings.parse(text, "text")
        made.put_all(None, None, None, None, settings or {})
        experiment = cls.__new__(cls)
        experiment._take(made)
        return experiment

    def _take(self, made: Made) -> None:
        self._made = made
        self._native = _native.Experiment(
            made.settings, scene=made.scene, motion=made.motion, policy=made.policy, phong=made.phong
        )

    def run(
        self,
        *,
        progress: Progress = None,
        threads: int | None = None,
        keep: str = "everything",
        each_field: Callable[[Stepper], object] | None = None,
    ) -> Outcome:
        """Runs it, without the interpreter's lock; Ctrl-C ends it within a fraction of a second.

        - ``progress``: True for a bar of tqdm, False for none, or a callable (fields done, of all); default: a bar in notebooks and
          terminals.
        - ``threads``: workers for ``pixels="all"``; default: one a core. No result depends on them.
        - ``keep``: ``everything``, or ``statistics`` for runs of any length, without tables and timelines.
        - ``each_field``: a callable that gets the :class:`Stepper` of the run after each field, for pictures and states of boards.
          The outcome is the same as without it.

        Gives a RuntimeWarning with advice when the machine was too slow for the scene. Raises :class:`TooShortError` when nothing but
        the warm-up was shown, and :class:`RunError` when the machine cannot go on; both have all observations until then in
        ``partial``.
        """
        choice("keep", keep, ("everything", "statistics"))
        number = optional("threads", threads)
        with reporting(progress, "fields") as told:
            if each_field is None:
                outcome = self._finished(lambda: self._native.run(told, number, keep == "everything"))
            else:
                outcome = self._run_by_fields(keep, told, each_field)
        advice = outcome.advice
        if advice is not None:
            warnings.warn(advice, RuntimeWarning, stacklevel=2)
        return outcome

    def _run_by_fields(
        self, keep: str, told: Callable[[int, int], object] | None, each_field: Callable[[Stepper], object]
    ) -> Outcome:
        stepper = Stepper(self._native.stepper(keep == "everything"), self)
        for done in range(1, self.fields + 1):
            if stepper.run_to_field(done) not in ("reached", "end"):
                break
            each_field(stepper)
            if told is not None:
                told(done, self.fields)
        return stepper.finish()

    def _finished(self, run: Callable[[], _native.Outcome]) -> Outcome:
        """Returns the outcome of a run; an error gets the observations until then."""
        try:
            return Outcome(run(), self)
        except RunError as error:
            error.partial = None if error._native is None else Outcome(error._native, self)
            raise

    def stepper(self, *, keep: str = "everything") -> Stepper:
        """Begins a run that advances on request, by fields, lines or events, and whose state can be read.

        ``keep`` is as in :meth:`run`. Raises :class:`SettingError` if the machine cannot be built.
        """
        choice("keep", keep, ("everything", "statistics"))
        return Stepper(self._native.stepper(keep == "everything"), self)

    def frames(
        self, surface: str | int = "left", *, first: int = 0, fields: int | None = None
    ) -> Iterator[_native.Picture]:
        """Pictures of a run, one for each field from ``first`` on: the screen at the end of the field.

        ``surface`` is ``left``, ``right``, ``both`` side by side, or the number of a surface. ``fields`` is how many; default: all up
        to the last complete field of the run. The experiment is run once for this, with pixels, while the pictures are taken.

        Raises :class:`SettingError` for a surface that the display does not have.
        """
        count = self._frame_count(first, fields)
        return iter(self._native.frames(_surface(surface), first, count))

    def film(
        self, path: str | PathLike[str], surface: str | int = "left", *, first: int = 0, fields: int | None = None
    ) -> None:
        """Writes the pictures of :meth:`frames` as an animated PNG at the true rate, which browsers play.

        Raises as :meth:`frames`, and OSError when the file cannot be written.
        """
        count = self._frame_count(first, fields)
        Path(path).write_bytes(self._native.film(_surface(surface), first, count))

    def _frame_count(self, first: int, fields: int | None) -> int:
        start = whole("first", first)
        if fields is not None:
            return whole("fields", fields, 1)
        if start >= self.fields - 1:
            raise SettingError(f"first: expected 0 to {self.fields - 2}, found {start}")
        return self.fields - 1 - start

    def what_if(self) -> Table[WhatIfRow]:
        """What 10 % more of each resource of the machine would bring: a row for each, with latency and rate before and after.

        Raises as :meth:`run`.
        """
        rows = self._native.what_if()
        flat: list[dict[str, object]] = []
        for row in rows:
            before_ms, after_ms = row["latency_ms"]
            before_hz, after_hz = row["updates_hz"]
            flat.append(
                {
                    "resource": row["resource"],
                    "key": row["key"],
                    "from": row["from"],
                    "to": row["to"],
                    "latency_ms.before": before_ms,
                    "latency_ms.after": after_ms,
                    "updates_hz.before": before_hz,
                    "updates_hz.after": after_hz,
                    "level": row["level"],
                }
            )
        return table_of(flat, WHAT_IF_DEFINITIONS)

    def measure(self) -> dict[QuantityName, float | None]:
        """The quantities in ``measure`` at the experiment's own level, which may be analytic; None where it shows none.

        Raises as :meth:`run`.
        """
        return self._native.measure()

    @property
    def fields(self) -> int:
        """Number of display periods that a run simulates: for NTSC, fields of 1/60 s."""
        return self._native.fields

    @property
    def config_hash(self) -> str:
        """Name of everything on which the trace depends: the same as that of the command and of Rust."""
        return self._native.config_hash()

    @property
    def warnings(self) -> list[str]:
        """Parameters that no source allows, each with range and source; and what has no code at the cycle level."""
        return self._native.warnings()

    @property
    def parameters(self) -> list[Parameter]:
        """All numbers of the experiment: of the machine as the pipeline adapts it, and of the tracker and its predictor."""
        return [Parameter(**entry) for entry in self._native.parameters()]

    def parameter_table(self) -> Table[ParameterRow]:
        """The same as a table: path, value, unit, standing, low, high, source, read_only."""
        return parameter_table(self.parameters)

    def settings(self) -> str:
        """Every setting as it takes effect: the text of an experiment file that says the same.

        A :class:`Scene`, a :class:`Motion` and a policy have no name there: what stands for them does.
        """
        return self._made.settings.text()

    def _plain_state(self) -> ExperimentState | None:
        """The experiment as plain data; None if a Python function belongs to it."""
        made = self._made
        state: ExperimentState = {"settings": self.settings(), "phong": made.phong}
        if made.policy is not None:
            return None
        if made.motion is not None:
            restore, arguments = made.motion.__reduce__()
            if restore is _pickle.callable_motion:
                return None
            text = arguments[0]
            state["motion"] = [text.decode("latin-1"), *arguments[1:]] if isinstance(text, bytes) else list(arguments)
        if made.scene is not None:
            state["scene"] = made.scene.__reduce__()[1]
        return state

    @classmethod
    def _of_plain_state(cls, state: ExperimentState) -> Experiment:
        scene = _pickle.scene(*state["scene"]) if "scene" in state else None
        motion: Motion | None = None
        if "motion" in state:
            motion = _pickle.motion(state["motion"])
        return _experiment_of(state["settings"], scene, motion, None, state["phong"])

    def __reduce__(self) -> tuple[Callable[..., Experiment], tuple[object, ...]]:
        made = self._made
        return _experiment_of, (self.settings(), made.scene, made.motion, made.policy, made.phong)

    def __repr__(self) -> str:
        return f"<pxpl5.Experiment {self.config_hash}>"

    def _repr_html_(self) -> str:
        lines = [line for line in self.settings().splitlines() if line and not line.startswith("#")]
        shown = _html.lines(lines, f"Experiment {self.config_hash}")
        return shown + "".join(_html.warning(text) for text in self.warnings)


def _experiment_of(
    text: str, scene: Scene | None, motion: Motion | None, policy: Policy | None, phong: bool
) -> Experiment:
    """Returns the experiment with these settings and objects, for the module pickle."""
    made = Made()
    made.settings.parse(text, "pickle")
    made.scene, made.motion, made.policy, made.phong = scene, motion, policy, phong
    experiment = Experiment.__new__(Experiment)
    experiment._take(made)
    return experiment


def _surface(surface: str | int) -> int | None:
    """Returns the number of a surface; None stands for all."""
    if isinstance(surface, str):
        choice("surface", surface, ("left", "right", "both"))
        return {"left": 0, "right": 1, "both": None}[surface]
    return whole("surface", surface)


WHAT_IF_DEFINITIONS = {
    "resource": "what the machine gets more of",
    "key": "the setting that is changed",
    "from": "value of the setting",
    "to": "value that was tried: 10 % better, and at least one step",
    "latency_ms.before": "mean latency without the change, milliseconds",
    "latency_ms.after": "mean latency with the change, milliseconds",
    "updates_hz.before": "new complete pictures a second without the change",
    "updates_hz.after": "new complete pictures a second with the change",
    "level": "level of modelling of the results",
}

# An outcome that is loaded needs its experiment, whose module imports that of outcomes.
Outcome._experiment_of_state = Experiment._of_plain_state
