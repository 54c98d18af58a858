"""Machines and their parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from difflib import get_close_matches
from typing import TYPE_CHECKING

from . import _html, _native
from ._checks import Strict
from ._names import MachineName
from ._native import Table
from ._tables import table_of

if TYPE_CHECKING:
    from ._rows import ParameterRow


@dataclass(frozen=True)
class Parameter:
    """A number of a machine with its provenance and source."""

    #: Board and field, such as ``ring.word_ns``.
    path: str
    #: Value of the parameter, in :attr:`unit`.
    value: float
    #: Unit of the value and the range, such as ns.
    unit: str
    #: Provenance: published, derived or assumed.
    provenance: str
    #: Least value that the sources allow.
    low: float
    #: Greatest value that the sources allow.
    high: float
    #: Source of the value and the range.
    source: str
    #: True if the parameter is only listed and cannot be set.
    read_only: bool

    @property
    def range(self) -> tuple[float, float]:
        """Least and greatest value that the sources allow, in :attr:`unit`."""
        return (self.low, self.high)

    @property
    def in_range(self) -> bool:
        """True if the value is in the range of the sources. The model accepts other values with a warning."""
        return self.low <= self.value <= self.high


PARAMETER_DEFINITIONS = {
    "path": "board and field",
    "value": "in the unit beside it",
    "provenance": "published, derived or assumed",
    "low": "least value that the sources allow",
    "high": "greatest value that the sources allow",
    "read_only": "true if the parameter is listed but cannot be changed",
}


def parameter_table(parameters: list[Parameter]) -> Table[ParameterRow]:
    """Returns parameters as a table: path, value, unit, provenance, low, high, source, read_only."""
    rows = [asdict(parameter) for parameter in parameters]
    for row in rows:
        row.update({key: float(row[key]) for key in ("value", "low", "high")})
    return table_of(rows, PARAMETER_DEFINITIONS)


class Machine(Strict, Mapping[str, Parameter]):
    """A machine: a preset with changed parameters.

    ``machine["gp.triangle_ns"]`` is a :class:`Parameter`. ``machine["gp.triangle_ns"] = 30_000`` changes the value of this parameter,
    and ``machine.n_gps = 20`` changes the number of boards. :attr:`warnings` lists values outside the ranges of the sources.

    A pipeline can change other parameters of the machine, such as the times of its code. A pipeline never replaces a value that is set
    here.

    Raises :class:`SettingError` for an unknown preset or path, with the nearest known name, and for a value beyond the limits.
    """

    def __init__(self, preset: MachineName | str = "small-hmd", changes: Mapping[str, float] | None = None) -> None:
        self._preset = preset
        self._changes: dict[str, float] = {}
        self._known = _native.machine_parameters(preset, dict(changes or {}))
        self._changes.update(changes or {})

    @property
    def preset(self) -> str:
        """The name of the preset, one of :func:`presets`."""
        return self._preset

    @property
    def changes(self) -> dict[str, float]:
        """A copy of the changed values, by path, in the unit of each parameter."""
        return dict(self._changes)

    @property
    def n_gps(self) -> int:
        """Number of graphics processors, with the master."""
        return self._known["n_gps"]

    @n_gps.setter
    def n_gps(self, number: int) -> None:
        self["n_gps"] = number

    @property
    def n_renderers(self) -> int:
        """Number of renderers, each with an array of 128 x 128 pixels."""
        return self._known["n_renderers"]

    @n_renderers.setter
    def n_renderers(self, number: int) -> None:
        self["n_renderers"] = number

    def __setitem__(self, path: str, value: float) -> None:
        changes = {**self._changes, path: value}
        self._known = _native.machine_parameters(self._preset, changes)
        self._changes = changes

    def replaced(self, changes: Mapping[str, float]) -> Machine:
        """Returns a copy of this machine with other values of some parameters, given by path."""
        return Machine(self._preset, {**self._changes, **changes})

    @property
    def parameters(self) -> list[Parameter]:
        """All parameters in the order of the boards, with the parameters of firmware."""
        return [Parameter(**entry) for entry in self._known["parameters"]]

    @property
    def warnings(self) -> list[str]:
        """Warnings about values outside the ranges of their sources, each with range and source."""
        return list(self._known["warnings"])

    def table(self) -> Table[ParameterRow]:
        """Returns the parameters as a table: path, value, unit, provenance, low, high, source, read_only."""
        return parameter_table(self.parameters)

    def __getitem__(self, path: str) -> Parameter:
        for parameter in self.parameters:
            if parameter.path == path:
                return parameter
        nearest = get_close_matches(path, list(self), 1, 0.0)
        raise KeyError(f"there is no parameter `{path}`; did you mean `{nearest[0]}`?")

    def __iter__(self) -> Iterator[str]:
        return (parameter.path for parameter in self.parameters)

    def __len__(self) -> int:
        return len(self._known["parameters"])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Machine) and self._known == other._known and self._preset == other._preset

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        changes = f", {self._changes}" if self._changes else ""
        return f"<pxpl5.Machine {self._preset}: {self.n_gps} GPs, {self.n_renderers} renderers{changes}>"

    def _repr_html_(self) -> str:
        rows = [[p.path, p.value, p.unit, p.provenance, f"{p.low:g} to {p.high:g}", p.source] for p in self.parameters]
        head = ["parameter", "value", "unit", "provenance", "range", "source"]
        return _html.table(head, rows, f"{self._preset}: {self.n_gps} GPs, {self.n_renderers} renderers")
