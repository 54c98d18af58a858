"""Experiments: a machine, a pipeline, a scene and a head, given as keywords or as an experiment file."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from . import _native
from ._head import Head
from ._machine import Machine, Parameter, parameter_table
from ._native import Motion, Scene, Table
from ._outcome import Outcome
from ._progress import Progress, reporting

#: A frame as a policy sees it, and what it answers: (region, renderer) for every region, in the order of sending.
Policy = Callable[[dict[str, Any]], Sequence[tuple[int, int]]]


def toml_of(value: object) -> str:
    """A value as experiment files write it."""
    if isinstance(value, bool) or isinstance(value, int):
        return json.dumps(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, PathLike):
        return json.dumps(fspath(value), ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{json.dumps(str(key))} = {toml_of(entry)}" for key, entry in value.items()) + " }"
    if hasattr(value, "tolist"):
        return toml_of(value.tolist())
    if isinstance(value, Sequence):
        return "[" + ", ".join(toml_of(entry) for entry in value) + "]"
    if hasattr(value, "item"):
        return toml_of(value.item())
    raise TypeError(f"expected text, a number, a truth value or a list of these, found {type(value).__name__}")


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
        if isinstance(scene, Scene):
            self.scene = scene
            self.put("scene", "full-screen:1")
        elif scene is not None:
            self.put("scene", fspath(scene))
        self._put_machine(machine)
        if isinstance(head, str):
            self.put("head.motion", head)
        elif head is not None:
            self.motion = head.moving()
            for path, value in head.settings().items():
                self.put(path, value)
        for path, value in keys.items():
            if value is not None:
                self.put(path.replace("__", "."), value)

    def _put_pipeline(self, pipeline: str | PolicyPipeline | None) -> None:
        if isinstance(pipeline, PolicyPipeline):
            # What the firmware is told apart by is its own; keys and checks are those of the nearest in the registry.
            self.policy = pipeline.policy
            self.phong = pipeline.shading == "phong"
            self.put("pipeline", "rendering-control")
        elif pipeline is not None:
            self.put("pipeline", pipeline)

    def _put_machine(self, machine: str | Machine | None) -> None:
        if isinstance(machine, Machine):
            self.put("machine.preset", machine.preset)
            for path, value in machine.changes.items():
                self.put(f"machine.{path}", value)
        elif machine is not None:
            self.put("machine.preset", machine)

    def check_scene(self, keys: Mapping[str, object]) -> None:
        """A scene that was given as such is drawn as it is."""
        given = [key for key in ("triangles", "cull", "fit") if keys.get(key) is not None]
        if self.scene is not None and given:
            from ._errors import SettingError

            methods = "Scene.decimated, Scene.culled or the scene's own fit"
            raise SettingError(f"keyword {given[0]}: expected the name of a scene beside it, found a Scene; use {methods}")


class PolicyPipeline:
    """A pipeline of one's own: one graphics processor draws mono frames, and a callable says which renderer draws what.

    ``policy(frame)`` is asked when TRANSFORM is done. ``frame`` is a dictionary: ``frame`` (its number), ``time_s`` (simulated
    seconds), ``columns`` (regions in a row), ``primitives`` (a list, how many each region has, row by row) and ``renderers`` (how
    many there are). It returns a list of (region, renderer) with every region once, in the order in which they are sent.

    What it raises ends the run, and is raised there. The same frame must always get the same answer: a run may be repeated to tell
    whether it is stuck, or when views are seen.
    """

    def __init__(self, policy: Policy, *, shading: str = "phong") -> None:
        if shading not in ("phong", "gouraud"):
            from ._errors import SettingError

            raise SettingError(f"shading: expected phong or gouraud, found {shading}")
        self.policy = policy
        self.shading = shading

    def __repr__(self) -> str:
        return f"<pxpl5.PolicyPipeline {getattr(self.policy, '__qualname__', 'callable')}, {self.shading}>"


class Experiment:
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
        pipeline: str | PolicyPipeline | None = None,
        scene: str | PathLike[str] | Scene | None = None,
        *,
        machine: str | Machine | None = None,
        head: str | Head | None = None,
        fields: int | None = None,
        seed: int | None = None,
        level: str | None = None,
        pixels: str | None = None,
        triangles: int | None = None,
        measure: Sequence[str] | None = None,
        settings: Mapping[str, object] | None = None,
        **keys: object,
    ) -> None:
        given: dict[str, object] = {"fields": fields, "seed": seed, "level": level, "pixels": pixels, "triangles": triangles}
        given |= {"measure": None if measure is None else list(measure), **keys, **(settings or {})}
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

    def run(self, *, progress: Progress = None, threads: int | None = None, keep: str = "everything") -> Outcome:
        """Runs it, without the interpreter's lock; Ctrl-C ends it within a fraction of a second.

        - ``progress``: True for a bar of tqdm, False for none, or a callable (fields done, of all); default: a bar in notebooks and
          terminals.
        - ``threads``: workers for ``pixels="all"``; default: one a core. No result depends on them.
        - ``keep``: ``everything``, or ``statistics`` for runs of any length, without tables, timelines and errors in pixels.

        Raises :class:`TooShortError` when nothing but the warm-up was shown, :class:`RunError` when the machine cannot go on; both have
        everything until then in ``partial``.
        """
        if keep not in ("everything", "statistics"):
            from ._errors import SettingError

            raise SettingError(f"keep: expected everything or statistics, found {keep}")
        with reporting(progress, "fields") as told:
            return Outcome(self._native.run(told, threads, keep == "everything"))

    def measure(self) -> dict[str, float | None]:
        """The quantities in ``measure`` at the experiment's own level, which may be analytic; None where it shows none.

        Raises as :meth:`run`.
        """
        return self._native.measure()

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

    def parameter_table(self) -> Table:
        """The same as a table: path, value, unit, standing, low, high, source, read_only."""
        return parameter_table(self.parameters)

    def settings(self) -> str:
        """Every setting as it takes effect: the text of an experiment file that says the same.

        A :class:`Scene`, a :class:`Motion` and a policy have no name there: what stands for them does.
        """
        return self._made.settings.text()

    def __repr__(self) -> str:
        return f"<pxpl5.Experiment {self.config_hash}>"
