"""The command of the package."""

import json
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

import pxpl5

PROGRAMS = [[sys.executable, "-m", "pxpl5"], [str(Path(sysconfig.get_path("scripts")) / "pxpl5")]]


def run(*arguments: str, program: list[str] = PROGRAMS[0]) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*program, *arguments], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("program", PROGRAMS, ids=["module", "script"])
def test_the_command_runs_the_same_experiment_as_the_module(program: list[str], slats: pxpl5.Outcome) -> None:
    done = run("run", "--pipeline", "slats", "--scene", "mig", "--triangles", "100", "--fields", "60", "--json", program=program)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["trace_hash"] == slats.trace_hash


def test_the_command_has_version_help_and_exit_codes() -> None:
    assert pxpl5.__version__ in run("--version").stdout
    assert "pxpl5 run" in run("--help").stdout
    wrong = run("run", "--pipeline", "slat", "--scene", "mig")
    assert wrong.returncode == 2 and "slats" in wrong.stderr


def test_a_comparison_has_the_rows_of_the_command() -> None:
    compared = ["compare", "--scene", "full-screen:2", "--fields", "24", "--seeds", "1", "--json"]

    def rows_of_command(*more: str) -> list[str]:
        return [row["pipeline"] for row in json.loads(run(*compared, *more).stdout)["pipelines"]]

    def rows(all_rows: bool) -> list[str]:
        found = pxpl5.compare("full-screen:2", fields=24, seeds=1, all_rows=all_rows, progress=False)
        return [row["pipeline"] for row in found.data["pipelines"]]

    assert rows(False) == rows_of_command() and rows(True) == rows_of_command("--all")
    assert set(rows(False)) < set(rows(True))
    with pytest.raises(pxpl5.SettingError, match="all_rows: expected no names in only, found 'slats'"):
        pxpl5.compare("mig", only="slats", all_rows=True)


def test_results_are_plotted_as_the_command_plots_them(tmp_path: Path) -> None:
    base = {"pipeline": "slats", "scene": "typical:100", "fields": 30, "measure": "latency_fields.mean"}
    results = pxpl5.sweep(pxpl5.SweepSpace(base, {"triangles": [20, 40, 60]}, seeds=2), out=tmp_path / "rows", progress=False)
    drawing = results.plot("triangles", "latency_fields.mean", title="Slats", width_mm=84)
    out = tmp_path / "plot" / "figure.svg"
    command = ["plot", str(tmp_path / "rows"), "--x", "triangles", "--y", "latency_fields.mean", "--title", "Slats", "--out", str(out)]
    assert run(*command).returncode == 0
    assert drawing.svg == out.read_text()
    with pytest.raises(pxpl5.SettingError, match="no row has `triangle`; did you mean `triangles`"):
        results.plot("triangle", "latency_fields.mean")
    with pytest.raises(pxpl5.SettingError, match="fields varies too|varies too"):
        space = pxpl5.SweepSpace(base, {"triangles": [20, 40], "machine.gp.triangle_ns": [20_000, 21_000]})
        pxpl5.sweep(space, progress=False).plot("triangles", "latency_fields.mean")
