"""Experiments. An experiment has a machine, a pipeline, a scene and a head, given as keywords or as an experiment file."""

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

#: A function that takes a frame and returns a pair (region, renderer) for every region, in the order of sending.
Policy = Callable[[PolicyFrame], Sequence[tuple[int, int]]]


class Made:
    """Settings in the form of the library, and the objects that have no name in the settings."""

    def __init__(self) -> None:
        self.settings = _native.Settings()
        self.scene: Scene | None = None
        self.motion: Motion | None = None
        self.policy: Policy | None = None
        self.phong = True

    def put(self, path: str, value: object) -> None:
        """Sets the value of a key."""
        try:
            text = toml_of(value)
        except TypeError as error:
            raise SettingError(f"{path}: {error}") from None
        self.settings.set(f"{path}={text}", "")

    def put_all(
        self,
        pipeline: str | PolicyPipeline | None,
        scene: str | PathLike[str] | Scene | None,
        machine: str | Machine | None,
        head: str | Head | None,
        keys: Mapping[str, object],
    ) -> None:
        """Sets the values of keywords. A keyword with the value None is ignored."""
        self._put_pipeline(pipeline)
        self._put_scene(scene)
        self._put_machine(machine)
        self._put_head(head)
        for path, value in keys.items():
            if value is not None:
                self.put(path.replace("__", "."), value)

    def _put_pipeline(self, pipeline: str | PolicyPipeline | None) -> None:
        if isinstance(pipeline, PolicyPipeline):
            # The registry has no entry for a policy, so keys and checks come from the entry of Rendering Control.
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
            for path, value in head.settings().items():
                self.put(path, value)
            self.move(head.moving())
        elif head is not None:
            raise SettingError(f"head: expected the name of a motion or a Head, found {head!r}")

    def move(self, motion: Motion | None) -> None:
        """Sets the motion of the head. None keeps the motion of the settings."""
        self.motion = motion
        if motion is not None:
            self.settings.set_motion(motion)

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
        """Refuses keys that would change a :class:`Scene` object."""
        given = [key for key in ("triangles", "cull", "fit") if keys.get(key) is not None]
        if self.scene is not None and given:
            methods = "Scene.decimated, Scene.culled or the scene's own fit"
            raise SettingError(f"{given[0]}: expected the name of a scene beside it, found a Scene; use {methods}")


class PolicyPipeline(Strict):
    """A pipeline in which a callable, the *policy*, assigns the regions of each frame to renderers.

    One graphics processor draws frames for one eye. After TRANSFORM of a frame, the pipeline calls ``policy(frame)``. ``frame`` is a
    dictionary with these keys:

    - ``frame``: number of the frame.
    - ``time_s``: simulated time in seconds.
    - ``columns``: number of regions in a row of the screen.
    - ``primitives``: list with the number of primitives of each region, row by row.
    - ``renderers``: number of renderers.

    The policy returns a list of pairs (region, renderer). The list has each region once, in the order in which the regions are sent.

    An exception of the policy ends the run, and :meth:`Experiment.run` raises the exception. The policy must always return the same
    list for the same frame, because a run can be repeated: to detect a deadlock, or as a dry run before prediction.
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
    - ``machine``: the name of a preset or a :class:`Machine`; default: the machine with which the pipeline was published.
    - ``head``: a :class:`Head`, or the name of a motion; default: the scene's own motion, without a tracker.
    - ``fields``: number of display periods to simulate (fields of 1/60 s on an NTSC display); default 120.
    - ``seed``: seed of the random numbers.
    - ``level``: ``transaction`` or ``cycle``; also ``analytic`` for :meth:`measure`.
    - ``pixels``: ``off``, ``lazy`` or ``all``.
    - ``triangles``: number of triangles to which the scene is decimated.
    - ``measure``: names of :func:`quantities`.
    - ``settings``: other keys by path, such as ``{"machine.gp.triangle_ns": 30_000}``.

    Each key of :func:`keys` can also be a keyword argument, with ``__`` instead of a point: ``copy="whole"``, ``motion__sway=0.5``.

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
        """Reads an experiment file (TOML) for ``pxpl5 run FILE``. ``settings`` replace keys of the file.

        Raises :class:`SettingError` with the file, the line, the expected value and the found value.
        """
        made = Made()
        made.settings.load(Path(path))
        made.put_all(None, None, None, None, settings or {})
        experiment = cls.__new__(cls)
        experiment._take(made)
        return experiment

    @classmethod
    def from_text(cls, text: str, settings: Mapping[str, object] | None = None) -> Experiment:
        """Reads an experiment from the text of an experiment file. ``settings`` replace keys of the text.

        Raises :class:`SettingError` as :meth:`from_file` does.
        """
        made = Made()
        made.settings.parse(text, "text")
        made.put_all(None, None, None, None, settings or {})
        experiment = cls.__new__(cls)
        experiment._take(made)
        return experiment

    def _take(self, made: Made) -> None:
        self._made = made
        self._native = _native.Experiment(made.settings, scene=made.scene, policy=made.policy, phong=made.phong)

    def run(
        self,
        *,
        progress: Progress = None,
        threads: int | None = None,
        keep: str = "everything",
        each_field: Callable[[Stepper], object] | None = None,
    ) -> Outcome:
        """Runs the experiment without the interpreter's lock. Ctrl-C ends the run within a fraction of a second.

        - ``progress``: True for a progress bar of tqdm, False for no bar, or a callable with two arguments: the number of simulated fields
          and the number of all fields. Default: a bar in notebooks and terminals.
        - ``threads``: number of threads that draw pixels with ``pixels="all"``; default: one for each core. No result depends on this number.
        - ``keep``: ``everything``; or ``statistics``, for runs of any length without tables and timelines.
        - ``each_field``: a callable that is called after each field with the :class:`Stepper` of the run, for example to read pictures.
          The callable does not change the outcome.

        If the machine was too slow for the scene, the method gives a RuntimeWarning with advice.

        Raises :class:`TooShortError` if the run showed only pictures of the warm-up, and :class:`RunError` if the machine cannot continue.
        The attribute ``partial`` of both exceptions has the observations before the exception.
        """
        choice("keep", keep, ("everything", "statistics"))
        number = optional("threads", threads)
        with reporting(progress, "fields") as reporter:
            if each_field is None:
                outcome = self._finished(lambda: self._native.run(reporter, number, keep == "everything"))
            else:
                outcome = self._run_by_fields(keep, reporter, each_field)
        advice = outcome.advice
        if advice is not None:
            warnings.warn(advice, RuntimeWarning, stacklevel=2)
        return outcome

    def _run_by_fields(
        self, keep: str, reporter: Callable[[int, int], object] | None, each_field: Callable[[Stepper], object]
    ) -> Outcome:
        stepper = Stepper(self._native.stepper(keep == "everything"), self)
        for done in range(1, self.fields + 1):
            if stepper.run_to_field(done) not in ("reached", "end"):
                break
            each_field(stepper)
            if reporter is not None:
                reporter(done, self.fields)
        return stepper.finish()

    def _finished(self, run: Callable[[], _native.Outcome]) -> Outcome:
        """Returns the outcome of a run. If the run raises an error, the error gets the observations before the error."""
        try:
            return Outcome(run(), self)
        except RunError as error:
            error.partial = None if error._native is None else Outcome(error._native, self)
            raise

    def stepper(self, *, keep: str = "everything") -> Stepper:
        """Returns a run that advances step by step, by fields, lines or events. Its state can be read between two steps.

        ``keep`` has the same meaning as in :meth:`run`. Raises :class:`SettingError` if the machine cannot be built.
        """
        choice("keep", keep, ("everything", "statistics"))
        return Stepper(self._native.stepper(keep == "everything"), self)

    def frames(
        self, surface: str | int = "left", *, first: int = 0, fields: int | None = None
    ) -> Iterator[_native.Picture]:
        """Returns an iterator over the pictures of a run. Each picture is the screen at the end of a field, from field ``first`` on.

        - ``surface``: ``left``, ``right``, ``both`` (side by side), or the number of a surface.
        - ``fields``: number of pictures; default: all up to the last complete field of the run.

        The iterator runs the experiment once more, with pixels.

        Raises :class:`SettingError` for a surface that the display does not have.
        """
        count = self._frame_count(first, fields)
        return iter(self._native.frames(_surface(surface), first, count))

    def film(
        self, path: str | PathLike[str], surface: str | int = "left", *, first: int = 0, fields: int | None = None
    ) -> None:
        """Writes the pictures of :meth:`frames` as an animated PNG with the rate of the display. Browsers play such a file.

        Raises the exceptions of :meth:`frames`, and OSError if the file cannot be written.
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
        """Returns the effect of 10 % more of each resource of the machine: a row for each resource with latency and rate before and after.

        Raises the exceptions of :meth:`run`.
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
        """Returns the quantities of the setting ``measure``. The level of the experiment can be ``analytic``.

        A quantity without a value is None. Raises the exceptions of :meth:`run`.
        """
        return self._native.measure()

    @property
    def fields(self) -> int:
        """Number of display periods that a run simulates (fields of 1/60 s on an NTSC display)."""
        return self._native.fields

    @property
    def config_hash(self) -> str:
        """Hash of all settings on which the trace depends. The command and the Rust library give the same hash."""
        return self._native.config_hash()

    @property
    def warnings(self) -> list[str]:
        """Warnings: parameters outside the ranges of their sources, and work without i860 code at the cycle level."""
        return self._native.warnings()

    @property
    def parameters(self) -> list[Parameter]:
        """All parameters of the experiment: the machine with the changes of the pipeline, the tracker and the predictor."""
        return [Parameter(**entry) for entry in self._native.parameters()]

    def parameter_table(self) -> Table[ParameterRow]:
        """Returns :attr:`parameters` as a table: path, value, unit, provenance, low, high, source, read_only."""
        return parameter_table(self.parameters)

    def settings(self) -> str:
        """Returns all effective settings as the text of an experiment file.

        A :class:`Scene`, a motion without a name and a policy cannot be in an experiment file. The text has substitutes for scene and
        policy, and a hash of the motion.
        """
        return self._made.settings.text()

    def _plain_state(self) -> ExperimentState | None:
        """Returns the experiment as plain data, or None if the experiment has a Python function."""
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
    """Returns the experiment with the given settings and objects. The module pickle calls this function."""
    made = Made()
    made.settings.parse(text, "pickle")
    made.scene, made.policy, made.phong = scene, policy, phong
    made.move(motion)
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

# A loaded outcome needs its experiment. The module of outcomes cannot import this module, because this module imports the module of outcomes.
Outcome._experiment_of_state = Experiment._of_plain_state
