"""A head with a tracker, a predictor and the raster of its display."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from ._checks import named
from ._native import Motion


@named
@dataclass(frozen=True)
class Head:
    """A moving head with a tracker and a predictor.

    With a head, outcomes have the error in pixels and the latency from the head to light. Without a head, pipelines use the scene's own
    motion without delay.
    """

    #: Motion: a name (``still``, ``pan:DEG_PER_S``, ``slide:M_PER_S``, ``sine:DEG:HZ``, ``pendulum``, ``synthetic:SEED``,
    #: ``walk:M_PER_S``), the path of a recording, a :class:`Motion`, or a callable. The callable takes the time in seconds and returns
    #: the position x, y, z in metres and the unit quaternion w, i, j, k.
    motion: str | Motion | Callable[[float], tuple[float, ...]]
    #: Tracker: ``optical``, ``fastrak``, ``fastrak-polled``, ``flock``, ``flock-patched``, ``3space``,
    #: ``3space-patched`` or ``ideal``.
    tracker: str = "optical"
    #: Predictor: ``none``, ``velocity``, ``acceleration`` or ``kalman``.
    predict: str = "kalman"
    #: Instant for which a view is predicted: ``middle``, ``first-pixel``, ``last-pixel`` or ``retrace``.
    aim: str = "middle"
    #: Raster of the display: ``plain``, ``vdrt`` (shifted by the error of the predicted pose), or a reprojection such as
    #: ``rotation every line, 100 us``.
    raster: str = "plain"
    #: Meaning of the poses of the motion. ``scene``: the motion begins where the scene's own motion begins.
    #: ``world``: the poses are metres in the scene's coordinates.
    place: str = "scene"
    #: Distance in metres of the points for which errors are evaluated; None for the points of the scene.
    evaluate_at: float | None = None
    #: Parameters of trackers and predictors by path, such as ``optical.latency``: see :func:`tracking_parameters`.
    tracking: dict[str, float] = field(default_factory=dict)

    def settings(self) -> dict[str, object]:
        """Returns the keys of an experiment file for this head. The motion ``still`` stands for a motion without a name."""
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
        """Returns the motion as an object if it has no name, otherwise None."""
        if isinstance(self.motion, str):
            return None
        if isinstance(self.motion, Motion):
            return self.motion
        return Motion.from_callable(self.motion, name=getattr(self.motion, "__qualname__", "callable"))
