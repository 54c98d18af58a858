"""A head with its tracker, a predictor and the raster before its eyes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from ._native import Motion


@dataclass(frozen=True)
class Head:
    """A head that moves, and what tracks it; without one, pipelines follow the scene's own motion without any delay.

    With a head, outcomes have the error in pixels and the time from head to light.
    """

    #: How it moves: a name (``still``, ``pan:DEG_PER_S``, ``slide:M_PER_S``, ``sine:DEG:HZ``, ``pendulum``, ``synthetic:SEED``,
    #: ``walk:M_PER_S``), the path of a recording, a :class:`Motion`, or a callable: time in seconds to x, y, z, w, i, j, k.
    motion: str | Motion | Callable[[float], tuple[float, ...]]
    #: ``optical``, ``fastrak``, ``fastrak-polled``, ``flock``, ``flock-patched``, ``3space``,
    #: ``3space-patched`` or ``ideal``.
    tracker: str = "optical"
    #: ``none``, ``velocity``, ``acceleration`` or ``kalman``.
    predict: str = "kalman"
    #: The instant that a view is predicted for: ``middle``, ``first-pixel``, ``last-pixel`` or ``retrace``.
    aim: str = "middle"
    #: The raster before the eyes: ``plain``, ``vdrt`` (shifted by the error of the pose), or a reprojection such as
    #: ``rotation every line, 100 us``.
    raster: str = "plain"
    #: Meaning of the poses of the motion. ``scene``: the motion begins where the scene's own motion begins.
    #: ``world``: the poses are metres in the scene's coordinates.
    place: str = "scene"
    #: Metres from the eye at which errors are judged; None where the scene's content lies.
    evaluate_at: float | None = None
    #: Numbers of trackers and predictors by path, such as ``optical.latency``: see :func:`tracking_parameters`.
    tracking: dict[str, float] = field(default_factory=dict)

    def settings(self) -> dict[str, object]:
        """Its keys as experiment files have them; a motion that has no name is left to the experiment."""
        named = isinstance(self.motion, str)
        keys: dict[str, object] = {
            "head.motion": self.motion if named else "still",
            "head.tracker": self.tracker,
            "head.predict": self.predict,
            "head.aim": self.aim,
            "head.raster": self.raster,
        }
        if self.place != "scene":
            keys["head.place"] = self.place
        if self.evaluate_at is not None:
            keys["head.evaluate_at"] = float(self.evaluate_at)
        keys.update({path if path.startswith("tracking.") else f"tracking.{path}": n for path, n in self.tracking.items()})
        return keys

    def moving(self) -> Motion | None:
        """The motion that has no name, if it is such a one."""
        if isinstance(self.motion, str):
            return None
        if isinstance(self.motion, Motion):
            return self.motion
        return Motion.from_callable(self.motion, name=getattr(self.motion, "__qualname__", "callable"))
