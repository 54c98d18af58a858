"""A pipeline of my own: which renderer draws which region, decided by a function of mine in every frame."""

import pxpl5

Answer = list[tuple[int, int]]


def in_turn(frame: pxpl5.PolicyFrame) -> Answer:
    """Region after region, renderer after renderer."""
    return [(region, region % frame["renderers"]) for region in range(len(frame["primitives"]))]


def heaviest_first(frame: pxpl5.PolicyFrame) -> Answer:
    """The region with most primitives first, each to the renderer that has least to do."""
    load = [0] * frame["renderers"]
    answer = []
    primitives = frame["primitives"]
    for region in sorted(range(len(primitives)), key=lambda region: -primitives[region]):
        renderer = min(range(len(load)), key=load.__getitem__)
        # Clearing, shading and copying a region cost about as much as a hundred triangles.
        load[renderer] += primitives[region] + 100
        answer.append((region, renderer))
    return answer


for policy in (in_turn, heaviest_first):
    pipeline = pxpl5.PolicyPipeline(policy)
    outcome = pxpl5.Experiment(pipeline, "mig", machine="small-hmd", fields=120, pixels="off").run()
    stages = [row for row in outcome.stages if row["stage"] == "render"]
    # A stage in progress at the end of the run has no end.
    render = [row["end_ps"] - row["begin_ps"] for row in stages if row["end_ps"] is not None]
    print(f"{policy.__name__}: {outcome.latency_ms.mean:.2f} ms, of it RENDER {sum(render) / len(render) / 1e9:.3f} ms")
