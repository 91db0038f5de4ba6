#!/usr/bin/env python3
"""Writes the table of docs/references.md: what the accuracy of a reference buys in the accuracy of parameters.

usage: scripts/reference_accuracy.py BENCH [SEEDS]

BENCH   the program
SEEDS   made-up sets of each row [20]

A robot with two wheels (true: track 288 mm, radii 49.5 and 50.1 mm; nominal 300, 50, 50) drives two squares of 2 m and
two circles in each sense and two lines, at 0.3 m/s, 20 rows a second; wheels without error. The reference of each
row of the table has errors of its own; the set is calibrated by `lm`. Printed: root mean square errors of b and of
the mean radius and of the difference of radii over the seeds, relative.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

TRACK, RIGHT, LEFT, STEP = 0.288, 0.0495, 0.0501, 0.05
REFERENCES = [  # name, white m, white rad, walk m/sqrt(m), walk rad/sqrt(m), scale, options
    ("motion capture, 0.2 mm, 0.3 mrad", 0.0002, 0.0003, 0, 0, 0, ["--cost=every_sample"]),
    ("total station or markers, 2 mm, 3 mrad", 0.002, 0.003, 0, 0, 0, ["--cost=every_sample"]),
    ("tags or lidar against a map, 10 mm, 5 mrad", 0.010, 0.005, 0, 0, 0, ["--cost=every_sample"]),
    ("the same, motion from row to row", 0.010, 0.005, 0, 0, 0, ["--cost=segments"]),
    ("visual or lidar odometry, drift 5 mm and 5 mrad a root metre", 0.001, 0.001, 0.005, 0.005, 0, ["--cost=every_sample"]),
    ("the same, motion from row to row", 0.001, 0.001, 0.005, 0.005, 0, ["--cost=segments"]),
    ("the same with 1 % of scale", 0.001, 0.001, 0.005, 0.005, 0.01, ["--cost=segments"]),
    ("tape measure at the end, 5 mm, 10 mrad", 0.005, 0.010, 0, 0, 0, ["--cost=final_pose"]),
]


def drives():
    quarter = math.pi / 2
    square = [(0.3, 0, 2 / 0.3), (0, 0.6, quarter / 0.6)] * 4
    circle = [(0.3, 0.4, 4 * math.pi / 0.4)]
    turned = lambda parts: [(v, -w, t) for v, w, t in parts]
    return {"square_ccw": square, "square_cw": turned(square), "circle_ccw": circle, "circle_cw": turned(circle),
            "line": [(0.3, 0, 10)]}


def driven(parts):
    """Poses and wheel angles at every row, exact arcs."""
    x = y = theta = 0.0
    rows, right, left = [(0.0, 0.0, 0.0)], [0.0], [0.0]
    for v, w, seconds in parts:
        count = max(1, round(seconds / STEP))
        dt = seconds / count
        for _ in range(count):
            half = w * dt / 2
            chord = v * dt * (math.sin(half) / half if half else 1)
            x, y, theta = x + chord * math.cos(theta + half), y + chord * math.sin(theta + half), theta + w * dt
            rows.append((x, y, theta))
            right.append(right[-1] + (v + w * TRACK / 2) / RIGHT * dt)
            left.append(left[-1] + (v - w * TRACK / 2) / LEFT * dt)
    return rows, right, left


def measured(rows, noise, white, turn_white, walk, turn_walk, scale):
    """What a reference says of these poses: motion by motion with a drift, then white noise."""
    size, drift = 1 + noise.gauss(0, scale), 0.0
    x, y = rows[0][:2]
    out = []
    for k, row in enumerate(rows):
        if k > 0:
            dx, dy = row[0] - rows[k - 1][0], row[1] - rows[k - 1][1]
            root = math.sqrt(math.hypot(dx, dy) + 0.1 * abs(row[2] - rows[k - 1][2]))
            c, s = math.cos(drift), math.sin(drift)
            x += size * (c * dx - s * dy) + noise.gauss(0, walk * root)
            y += size * (s * dx + c * dy) + noise.gauss(0, walk * root)
            drift += noise.gauss(0, turn_walk * root)
        out.append((x + noise.gauss(0, white), y + noise.gauss(0, white), row[2] + drift + noise.gauss(0, turn_white)))
    return out


def make_set(seed, reference):
    noise = random.Random(seed)
    recordings = []
    for name, parts in drives().items():
        rows, right, left = driven(parts)
        for repetition in (1, 2):
            poses = measured(rows, noise, *reference[1:6])
            if reference[6] == ["--cost=final_pose"]:  # the start is known, the end is measured
                poses = [rows[0]] + [None] * (len(rows) - 2) + [poses[-1]]
            column = lambda i: [None if p is None else p[i] for p in poses]
            recordings.append({"id": f"{name}_{repetition}", "trajectory": name, "repetition": repetition,
                               "samples": len(rows),
                               "columns": {"time_us": [round(1e6 * STEP * k) for k in range(len(rows))], "x": column(0),
                                           "y": column(1), "theta": column(2), "wheel.right": right, "wheel.left": left}})
    return {"schema": "odobench-dataset", "schema_version": 2, "name": "made_up",
            "robot": {"name": "made_up", "kinematics": "differential",
                      "parameters": [{"name": "b", "nominal": 0.3}, {"name": "r_right", "nominal": 0.05},
                                     {"name": "r_left", "nominal": 0.05}]},
            "signals": [{"name": "wheel.right", "kind": "position", "unit": "rad"},
                        {"name": "wheel.left", "kind": "position", "unit": "rad"}],
            "trajectories": [{"name": name} for name in drives()], "recordings": recordings}


def calibrated(bench, folder, data, options):
    path = os.path.join(folder, "set.json")
    with open(path, "w") as file:
        json.dump(data, file)
    out = os.path.join(folder, "out")
    run = subprocess.run([bench, "--data=" + path, "--solver=lm", "--quiet", "--accept=all", "--overwrite", "--out=" + out,
                          *options], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(run.stderr)
    with open(os.path.join(out, "runs.jsonl")) as file:
        record = [json.loads(line) for line in file][-1]
    return {p["name"]: p["value"] for p in record["parameters"]}


def main(bench, seeds):
    print("| reference | cost | b | mean radius | difference of radii |\n|---|---|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for reference in REFERENCES:
            squares = [0.0, 0.0, 0.0]
            for seed in range(seeds):
                z = calibrated(bench, folder, make_set(seed, reference), reference[6])
                mean = (RIGHT + LEFT) / 2
                errors = (z["b"] / TRACK - 1, (z["r_right"] + z["r_left"]) / 2 / mean - 1,
                          (z["r_right"] - z["r_left"] - (RIGHT - LEFT)) / mean)
                squares = [s + e * e / seeds for s, e in zip(squares, errors)]
            cells = " | ".join(f"{100 * math.sqrt(s):.2g} %" for s in squares)
            print(f"| {reference[0]} | `{reference[6][0][7:]}` | {cells} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    main(os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) == 3 else 20)
