"""Runs a model of your own on a machine of your own, with two pipelines, and prints latencies and pixels."""

import sys

import numpy as np

import pxpl5

# The model is a file (PLY, OBJ or PDB), or a pyramid from NumPy arrays of vertices and triangles.
if len(sys.argv) > 1:
    model = pxpl5.Scene.load(sys.argv[1])
else:
    corners = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1], [0, 1.5, 0]], dtype=float)
    sides = np.array([[0, 4, 1], [1, 4, 2], [2, 4, 3], [3, 4, 0], [0, 1, 2], [0, 2, 3]])
    model = pxpl5.Scene.from_arrays(corners, sides, name="pyramid")

# The machine of the papers with more graphics processors, and faster code on them.
machine = pxpl5.Machine("small-hmd")
machine.n_gps = 20
machine["gp.triangle_ns"] = 18_000
for warning in machine.warnings:
    print("warning:", warning)

for pipeline in ("rendering-control", "slats"):
    outcome = pxpl5.Experiment(pipeline, model, machine=machine, fields=80).run()
    latency = outcome.latency_ms
    print(f"{pipeline}: {latency.mean:.1f} ms (sd {latency.sd:.1f}, n {latency.n}), {outcome.quantity('updates_hz'):.1f} Hz")
    picture = outcome.picture("left")
    assert picture is not None
    seen = picture.array  # (480, 640, 3) uint8, not copied
    print(f"  {np.count_nonzero((seen != seen[0, 0]).any(axis=2))} pixels of the model, trace {outcome.trace_hash}")
