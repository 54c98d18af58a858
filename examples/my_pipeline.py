"""A pipeline of your own: in every frame, a function assigns the regions of the picture to renderers."""

import pxpl5

Answer = list[tuple[int, int]]


def in_turn(frame: pxpl5.PolicyFrame) -> Answer:
    """Assigns the regions in order to the renderers in turn."""
    return [(region, region % frame["renderers"]) for region in range(len(frame["primitives"]))]


def heaviest_first(frame: pxpl5.PolicyFrame) -> Answer:
    """Assigns the regions in order of their primitives, each to the renderer with the least work."""
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
