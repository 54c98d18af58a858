"""A sweep: a table of the latency for several numbers of triangles and graphics processors."""

import pxpl5

space = pxpl5.SweepSpace(
    {"pipeline": "rendering-control", "scene": "typical:8000", "machine": "small-hmd", "fields": 120,
     "measure": ["latency_ms.mean", "latency_ms.sd", "updates_hz"]},
    {"triangles": [1000, 4000, 8000], "machine.n_gps": [4, 13]},
    seeds=2,
)
results = pxpl5.sweep(space)
table = results.table
for name in table.names[:8]:
    print(f"{name:>20}  {table.definitions[name]}")
for row in table.rows():
    print(row["triangles"], row["machine.n_gps"], row["seed"], f"{row['latency_ms.mean']:.1f} ms", f"{row['updates_hz']:.1f} Hz")
