"""Tests of pipelines whose policy is a Python callable."""

from typing import Any

import pytest

import pxpl5


def dealt(frame: dict[str, Any]) -> list[tuple[int, int]]:
    """Assigns the regions to the renderers in turn."""
    return [(region, region % frame["renderers"]) for region in range(len(frame["primitives"]))]


def by_one(frame: dict[str, Any]) -> list[tuple[int, int]]:
    """Assigns all regions to the first renderer."""
    return [(region, 0) for region in range(len(frame["primitives"]))]


def run(policy: pxpl5.PolicyPipeline, **keywords: Any) -> pxpl5.Outcome:
    keywords = {"scene": "full-screen:12", "machine": "small-hmd", "fields": 60, **keywords}
    return pxpl5.Experiment(policy, **keywords).run(progress=False)


def render_ms(outcome: pxpl5.Outcome) -> float:
    """Returns the mean time of RENDER over the pictures after the warm-up."""
    spans = [row["end_ps"] - row["begin_ps"] for row in outcome.stages.rows() if row["stage"] == "render" and row["picture"] > 4]
    return sum(spans) / len(spans) / 1e9


def test_five_renderers_take_their_commands_faster_than_one() -> None:
    """The shading of a region takes a renderer 95 us: 1.9 ms for 20 regions on one renderer, 0.4 ms on five (README).

    COPY of the 20 regions takes the port of the frame buffer 15.6 ms and hides this difference, so both latencies are one field.
    """
    five = run(pxpl5.PolicyPipeline(dealt), pixels="off")
    one = run(pxpl5.PolicyPipeline(by_one), pixels="off")
    assert render_ms(five) < 1.9 < render_ms(one)
    assert five.latency_fields.mean == pytest.approx(one.latency_fields.mean) == pytest.approx(1, abs=1e-5)


def test_a_policy_changes_no_pixel_of_the_first_picture() -> None:
    pictures = [run(pxpl5.PolicyPipeline(policy)).picture() for policy in (dealt, lambda frame: dealt(frame)[::-1])]
    assert pictures[0] is not None and pictures[1] is not None
    assert pictures[0].array.std() > 0


def test_a_policy_sees_the_frame() -> None:
    seen: list[dict[str, Any]] = []

    def watching(frame: dict[str, Any]) -> list[tuple[int, int]]:
        seen.append(frame)
        return dealt(frame)

    run(pxpl5.PolicyPipeline(watching), pixels="off")
    # If a short run ends without events, the library repeats the run to detect a deadlock. The frames then occur again.
    frames = [frame["frame"] for frame in seen]
    again = frames.index(0, 1) if 0 in frames[1:] else len(frames)
    assert frames[:again] == list(range(again)) and again > 20
    # Twelve triangles that each cover the whole screen, in 5 x 4 regions.
    assert seen[0]["primitives"] == [12] * 20 and (seen[0]["columns"], seen[0]["renderers"]) == (5, 5)
    assert seen[1]["time_s"] > seen[0]["time_s"] > 0


def test_the_same_policy_has_the_same_trace() -> None:
    assert run(pxpl5.PolicyPipeline(dealt)).trace_hash == run(pxpl5.PolicyPipeline(dealt), pixels="off").trace_hash


@pytest.mark.parametrize(
    ("answer", "words"),
    [
        ([(0, 0)], "expected all 20 regions, found none for region 1"),
        ([(0, 0), (0, 1)], r"expected each of 20 regions once, for one of 5 renderers, found \(0, 1\)"),
        ([(0, 5)], r"found \(0, 5\)"),
        ([(99, 0)], r"found \(99, 0\)"),
    ],
)
def test_wrong_answers_are_refused(answer: list[tuple[int, int]], words: str) -> None:
    with pytest.raises(pxpl5.SettingError, match=words):
        run(pxpl5.PolicyPipeline(lambda frame: answer))


def test_what_a_policy_raises_is_raised_where_it_is_run() -> None:
    def wrong(frame: dict[str, Any]) -> list[tuple[int, int]]:
        raise LookupError("no policy")

    with pytest.raises(LookupError, match="no policy"):
        run(pxpl5.PolicyPipeline(wrong))
    with pytest.raises(pxpl5.SettingError, match=r"expected a list of pairs \(region, renderer\), found 'renderers'"):
        run(pxpl5.PolicyPipeline(lambda frame: "renderers"))  # type: ignore[arg-type, return-value]
    with pytest.raises(pxpl5.SettingError, match="shading: expected phong or gouraud"):
        pxpl5.PolicyPipeline(dealt, shading="flat")
