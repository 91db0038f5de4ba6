#!/usr/bin/env python3
"""Writes the tables of docs/references.md: what the accuracy of a reference buys in the accuracy of parameters.

usage: scripts/reference_accuracy.py BENCH [SEEDS]

BENCH   the program
SEEDS   made-up sets of each row, of the seeds 0 to SEEDS - 1 [20]

A robot drives two squares of 2 m and two circles in each sense and two lines, at 0.3 m/s, 20 rows a second; wheels without error.
Two robots: two wheels (true: track 288 mm, radii 49.5 and 50.1 mm; nominal 300, 50, 50), and a tricycle (true: wheelbase 812 mm,
radius 98.5 mm, steering that reads 13 mrad too little; nominal 800, 100, 0). The reference of each row of the table has errors of
its own; the set is calibrated by `lm`. Printed: root mean square errors over the seeds, of lengths relative.
"""
import json
import math
import os
import random
import subprocess
import sys
import tempfile

TRACK, RIGHT, LEFT, STEP = 0.288, 0.0495, 0.0501, 0.05
BASE, FRONT, ZERO = 0.812, 0.0985, 0.013
KINDS = {  # kind of reference: every how many rows, set's "reference", its errors one by one
    "motion capture": (1, None),
    "tags or lidar against a map, 5 a second": (4, None),
    "visual or lidar odometry": (1, "drifting"),
    "tape measure at the end": (0, None),
    "gyro, nothing else": (1, "headings"),
}
# kind, what is said of it, white m, white rad, walk m/sqrt(m), walk rad/sqrt(m), scale, rate noise rad/s at 20 Hz, bias left rad/s, cost
ROWS = [
    ("motion capture", "0.2 mm, 0.3 mrad", 0.0002, 0.0003, 0, 0, 0, 0, 0, "every_sample"),
    ("motion capture", "2 mm, 3 mrad", 0.002, 0.003, 0, 0, 0, 0, 0, "every_sample"),
    ("tags or lidar against a map, 5 a second", "5 mm, 3 mrad", 0.005, 0.003, 0, 0, 0, 0, 0, "every_sample"),
    ("tags or lidar against a map, 5 a second", "20 mm, 10 mrad", 0.02, 0.01, 0, 0, 0, 0, 0, "every_sample"),
    ("tags or lidar against a map, 5 a second", "20 mm, 10 mrad", 0.02, 0.01, 0, 0, 0, 0, 0, "segments"),
    ("tags or lidar against a map, 5 a second", "50 mm, 20 mrad", 0.05, 0.02, 0, 0, 0, 0, 0, "segments"),
    ("visual or lidar odometry", "2 mm, 2 mrad a root metre", 0.001, 0.001, 0.002, 0.002, 0, 0, 0, "segments"),
    ("visual or lidar odometry", "5 mm, 5 mrad a root metre", 0.001, 0.001, 0.005, 0.005, 0, 0, 0, "every_sample"),
    ("visual or lidar odometry", "5 mm, 5 mrad a root metre", 0.001, 0.001, 0.005, 0.005, 0, 0, 0, "segments"),
    ("visual or lidar odometry", "20 mm, 20 mrad a root metre", 0.001, 0.001, 0.02, 0.02, 0, 0, 0, "segments"),
    ("visual or lidar odometry", "5 mm, 5 mrad, scale 1 %", 0.001, 0.001, 0.005, 0.005, 0.01, 0, 0, "segments"),
    ("tape measure at the end", "2 mm, 5 mrad", 0.002, 0.005, 0, 0, 0, 0, 0, "final_pose"),
    ("tape measure at the end", "5 mm, 10 mrad", 0.005, 0.010, 0, 0, 0, 0, 0, "final_pose"),
    ("tape measure at the end", "20 mm, 30 mrad", 0.020, 0.030, 0, 0, 0, 0, 0, "final_pose"),
    ("gyro, nothing else", "2 mrad/s, bias known to 0.1 mrad/s", 0, 0, 0, 0, 0, 0.002, 0.0001, "segments"),
    ("gyro, nothing else", "2 mrad/s, bias known to 1 mrad/s", 0, 0, 0, 0, 0, 0.002, 0.001, "segments"),
    ("gyro, nothing else", "5 mrad/s, bias known to 5 mrad/s", 0, 0, 0, 0, 0, 0.005, 0.005, "segments"),
]


def drives():
    quarter = math.pi / 2
    square = [(0.3, 0, 2 / 0.3), (0, 0.6, quarter / 0.6)] * 4
    circle = [(0.3, 0.4, 4 * math.pi / 0.4)]
    turned = lambda parts: [(v, -w, t) for v, w, t in parts]
    return {"square_ccw": square, "square_cw": turned(square), "circle_ccw": circle, "circle_cw": turned(circle),
            "line": [(0.3, 0, 10)]}


class TwoWheels:
    title = "Two wheels"
    columns = ["b", "mean radius", "difference of radii"]
    held = "r_right"
    kinematics, nominal = "differential", {"b": 0.3, "r_right": 0.05, "r_left": 0.05}
    signals = [{"name": "wheel.right", "kind": "position", "unit": "rad"},
               {"name": "wheel.left", "kind": "position", "unit": "rad"}]

    def wheels(self, v, w):
        """What the signals do in a second, and what they are."""
        return {"wheel.right": (v + w * TRACK / 2) / RIGHT, "wheel.left": (v - w * TRACK / 2) / LEFT}, {}

    def errors(self, z, ratios):
        scale = z["r_right"] / RIGHT if ratios else 1  # what is held is the measure of all others
        mean = (RIGHT + LEFT) / 2 * scale
        return ["%", z["b"] / (TRACK * scale) - 1, None if ratios else (z["r_right"] + z["r_left"]) / 2 / mean - 1,
                (z["r_right"] - z["r_left"] - (RIGHT - LEFT) * scale) / mean]


class Tricycle:
    title = "A tricycle"
    columns = ["wheelbase", "radius", "zero of the steering"]
    held = "r"
    kinematics, nominal = "tricycle", {"wheelbase": 0.8, "r": 0.1, "steering_zero": 0}
    signals = [{"name": "wheel", "kind": "position", "unit": "rad"}, {"name": "steering", "kind": "angle", "unit": "rad"}]

    def wheels(self, v, w):
        return {"wheel": math.hypot(v, w * BASE) / FRONT}, {"steering": math.atan2(w * BASE, v) - ZERO}

    def errors(self, z, ratios):
        scale = z["r"] / FRONT if ratios else 1
        return ["rad", z["wheelbase"] / (BASE * scale) - 1, None if ratios else z["r"] / FRONT - 1,
                z["steering_zero"] - ZERO]


def driven(robot, parts):
    """Poses and signals at every row, exact arcs; an angle stands for the way to its row."""
    x = y = theta = 0.0
    rows, columns = [(0.0, 0.0, 0.0)], {s["name"]: [0.0] for s in robot.signals}
    for v, w, seconds in parts:
        count = max(1, round(seconds / STEP))
        dt = seconds / count
        rates, angles = robot.wheels(v, w)
        for _ in range(count):
            half = w * dt / 2
            chord = v * dt * (math.sin(half) / half if half else 1)
            x, y, theta = x + chord * math.cos(theta + half), y + chord * math.sin(theta + half), theta + w * dt
            rows.append((x, y, theta))
            for name, rate in rates.items():
                columns[name].append(columns[name][-1] + rate * dt)
            for name, angle in angles.items():
                columns[name].append(angle)
    return rows, columns


def measured(rows, noise, white, turn_white, walk, turn_walk, scale, rate, bias):
    """What a reference says of these poses: motion by motion with a drift, then white noise."""
    size, drift, left = 1 + noise.gauss(0, scale), 0.0, noise.gauss(0, bias)
    x, y = rows[0][:2]
    out = []
    for k, row in enumerate(rows):
        if k > 0:
            dx, dy = row[0] - rows[k - 1][0], row[1] - rows[k - 1][1]
            root = math.sqrt(math.hypot(dx, dy) + 0.1 * abs(row[2] - rows[k - 1][2]))
            c, s = math.cos(drift), math.sin(drift)
            x += size * (c * dx - s * dy) + noise.gauss(0, walk * root)
            y += size * (s * dx + c * dy) + noise.gauss(0, walk * root)
            drift += noise.gauss(0, turn_walk * root) + (left + noise.gauss(0, rate)) * STEP
        out.append((x + noise.gauss(0, white), y + noise.gauss(0, white), row[2] + drift + noise.gauss(0, turn_white)))
    return out


def thinned(poses, rows, every):
    if every == 0:  # the start is known, the end is measured
        return [rows[0]] + [None] * (len(rows) - 2) + [poses[-1]]
    return [p if k % every == 0 else None for k, p in enumerate(poses)]


def make_set(robot, seed, row):
    noise = random.Random(seed)
    every, kind = KINDS[row[0]]
    recordings = []
    for name, parts in drives().items():
        rows, columns = driven(robot, parts)
        for repetition in (1, 2):
            poses = thinned(measured(rows, noise, *row[2:9]), rows, every)
            column = lambda i: [None if p is None else p[i] for p in poses]
            recordings.append({"id": f"{name}_{repetition}", "trajectory": name, "repetition": repetition,
                               "samples": len(rows),
                               "columns": {"time_us": [round(1e6 * STEP * k) for k in range(len(rows))], "x": column(0),
                                           "y": column(1), "theta": column(2), **columns}})
    held = {robot.held} if kind == "headings" else set()
    parameters = [{"name": n, "nominal": v, **({"lower": v, "upper": v} if n in held else {})}
                  for n, v in robot.nominal.items()]
    data = {"schema": "odobench-dataset", "schema_version": 2, "name": "made_up",
            "robot": {"name": "made_up", "kinematics": robot.kinematics, "parameters": parameters},
            "signals": robot.signals, "trajectories": [{"name": name} for name in drives()], "recordings": recordings}
    return {**data, "reference": kind} if kind else data


def calibrated(bench, folder, data, cost):
    path = os.path.join(folder, "set.json")
    with open(path, "w") as file:
        json.dump(data, file)
    out = os.path.join(folder, "out")
    run = subprocess.run([bench, "--data=" + path, "--solver=lm", "--quiet", "--accept=all", "--overwrite", "--out=" + out,
                          "--validate=none", "--cost=" + cost], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(run.stderr)
    with open(os.path.join(out, "runs.jsonl")) as file:
        record = [json.loads(line) for line in file][-1]
    return {p["name"]: p["value"] for p in record["parameters"]}


def write_table(robot, bench, seeds):
    print(f"**{robot.title}**\n\n| reference | its errors | cost | {' | '.join(robot.columns)} |\n|---|---|---|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as folder:
        for row in ROWS:
            ratios, squares = KINDS[row[0]][1] == "headings", [0.0, 0.0, 0.0]
            for seed in range(seeds):
                z = calibrated(bench, folder, make_set(robot, seed, row), row[9])
                unit, *errors = robot.errors(z, ratios)
                squares = [None if e is None else s + e * e / seeds for s, e in zip(squares, errors)]
            cells = ["-" if s is None else f"{100 * math.sqrt(s):.2g} %" for s in squares]
            if unit == "rad":
                cells[2] = f"{1e3 * math.sqrt(squares[2]):.2g} mrad"
            if ratios:
                cells[0] += f" of {robot.held}"
            print(f"| {row[0]} | {row[1]} | `{row[9]}` | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__.strip())
    for each in (TwoWheels(), Tricycle()):
        write_table(each, os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) == 3 else 20)
        print()
