"""Runs pipelines with a recording of a head and prints their latencies and errors in pixels."""

import sys

import numpy as np

import pxpl5

# The recording is a file in the format of the emulator, of EuRoC or of TUM, or arrays of seconds, metres and quaternions (real part first).
if len(sys.argv) > 1:
    motion = pxpl5.Motion.recording(sys.argv[1])
else:
    times = np.linspace(0, 4, 241)
    angle = np.radians(20) * np.sin(2 * np.pi * 0.5 * times)
    none = np.zeros_like(times)
    turns = np.column_stack([np.cos(angle / 2), none, np.sin(angle / 2), none])
    motion = pxpl5.Motion.from_arrays(times, np.zeros((len(times), 3)), turns)

for pipeline in ("rendering-control", "slats", "jitp-scanline-racing"):
    for predict in ("none", "kalman"):
        head = pxpl5.Head(motion, tracker="fastrak", predict=predict)
        outcome = pxpl5.Experiment(pipeline, "full-screen:4", head=head, fields=120, pixels="off").run()
        report = outcome.report["head"]
        error = report["error"]["pixels"]
        light = report["end_to_end"]["head_to_light_ms"]
        print(f"{pipeline:22} {predict:7} {light:6.1f} ms from head to light, {error['mean']:6.2f} px of error, 99 %: {error['p99']:.1f}")
