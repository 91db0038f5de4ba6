#!/usr/bin/env python3
"""Writes docs/optiodom.md: OptiOdom's data sets, every method that applies beside the published cells, and
calibrations judged on the drives of other sets.

usage: scripts/optiodom_table.py [--figure=SVG] BENCH DATA REFERENCE [WORK] > docs/optiodom.md

BENCH      the program
DATA       folder with diff/, tricyc/, omni3/, omni4/ of OptiOdom's data, TYPE/PATH/STAMP/STAMP_*.csv
REFERENCE  folder with robots.json (published cells, minima of an independent evaluation) and robots_extras.json
WORK       folder for sets and run directories [a temporary one]
SVG        the last tables as a picture: errors after calibration over nominal ones

Exits 1, naming set and row, where a number differs from a published cell by more than the doc's words explain,
or where our J is above the independent minimum.
"""
import csv
import glob
import json
import math
import os
import subprocess
import sys
import tempfile
from html import escape

RULES = {"diff": "midpoint", "tricyc": "midpoint", "omni3": "optiodom-omni", "omni4": "optiodom-omni"}
STARTS = {"diff": "censi", "tricyc": "kallasi"}
OURS = {  # our parameters from theirs, which are diameters and whole distances
    "diff": lambda z: {"b": z[0], "r_right": z[1] / 2, "r_left": z[2] / 2},
    "tricyc": lambda z: {"wheelbase": z[0], "r": z[1] / 2, "steering_zero": z[2]},
    "omni3": lambda z: dict(R=z[0], **{f"r{i}": z[i] / 2 for i in (1, 2, 3)}),
    "omni4": lambda z: dict(lx=z[0] / 2, ly=z[1] / 2, roller=0.7853981633974483,
                            **{f"r{i}": z[i + 1] / 2 for i in (1, 2, 3, 4)}),
}
CELLS = ["max_position", "max_heading", "final_position", "final_heading"]
PRINTED = ["max_position_m", "max_heading_deg", "final_position_m", "final_heading_deg"]
PUBLISHED = {"classical:umbmark": "umbmark", "classical:jung_chung_optiodom": "jung_chung",
             "classical:ivanjko": "ivanjko", "classical:kallasi": "kallasi", "classical:lin": "lin"}
CELL = 42  # of the figure, pixels
failures = []


def bench(*words):
    run = subprocess.run([program, *words], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{' '.join(words)}: {run.stderr.strip()}")
    return run.stdout


def number(cell):
    return cell["value"] if isinstance(cell, dict) else cell


def tables(*words):
    """Row label -> J, four maxima, E_max,syst, reason; of any verb that prints tables."""
    rows = {}
    for table in json.loads(bench(*words, "--format=json"))["tables"]:
        key = table["columns"][0]["id"]
        for row in table["rows"]:
            if table["id"] in ("solvers", "cost"):
                rows.setdefault(row[key], {}).update(J=number(row["cost"]), reason=row.get("message"))
            elif table["id"] == "maxima":
                rows.setdefault(row[key], {}).update(cells=[number(row[c]) for c in CELLS])
            elif table["id"] == "ends":
                rows.setdefault(row[key], {}).update(ends=number(row["E_max_syst"]))
    return rows


def import_set(folder):
    path = os.path.join(work, folder.replace("/", "_") + ".json")
    bench("import", "optiodom", "--from=" + os.path.join(data, folder), "--out=" + path, "--overwrite", "--quiet")
    with open(path) as file:
        content = json.load(file)
    for p in content["robot"]["parameters"]:  # the box of the reference's minima
        if p["lower"] < p["upper"]:
            wide = 0.2 if p["nominal"] == 0 else 0.2 * abs(p["nominal"])
            p["lower"], p["upper"] = p["nominal"] - wide, p["nominal"] + wide
    with open(path, "w") as file:
        json.dump(content, file)
    return path


def side_of(folder):
    with open(glob.glob(os.path.join(data, folder, "*_metadata.csv"))[0]) as file:
        for row in csv.reader(file):
            if row[0] == "L" and row[1]:
                return row[1]
    return None


class Set:
    """One data set with all that is computed of it."""

    def __init__(self, folder, reference):
        self.folder, self.kind, self.reference = folder, folder.split("/")[0], reference
        self.path = import_set(folder)
        self.options = ["--data=" + self.path, "--cost=optiodom", "--integration=" + RULES[self.kind]]
        side = side_of(folder) if "square" in folder and self.kind == "diff" else None
        classical = ["--classical"] + (["--side=" + side] if side else [])
        self.rows = tables("evaluate", *self.options, *classical)
        published = os.path.join(work, "published.json")
        with open(published, "w") as file:
            json.dump(dict(OURS[self.kind](reference["published"]["optiodom"]["z"]), name="OptiOdom"), file)
        self.rows.update(tables("evaluate", *self.options, "--parameters=" + published))
        self.starts = {}
        for start in ["nominal", STARTS.get(self.kind), "multistart"]:
            if start is None:
                continue
            out = self.runs(start)
            solver = "--solver=multistart[starts=40,effort=0]" if start == "multistart" else "--solver=lm"
            first = [] if start in ("nominal", "multistart") else ["--start=" + start]
            rows = tables("run", *self.options, solver, *first, "--out=" + out, "--overwrite", "--quiet")
            self.starts[start] = next(row for label, row in rows.items() if label != "nominal")
        best = min(row["J"] for row in self.starts.values())
        # The first that reaches it: nominal before others.
        self.best = next(s for s, row in self.starts.items() if row["J"] <= best * (1 + 1e-9))
        self.rows["ours"] = self.starts[self.best]
        star = reference["problems"]["optiodom"]["optimum"]["J"]
        if not self.rows["ours"]["J"] <= star * (1 + 1e-9) + 1e-15:
            failures.append(f"{folder}: J {self.rows['ours']['J']} above {star}")

    def runs(self, start):
        return os.path.join(work, self.folder.replace("/", "_") + "_" + start)

    def best_runs(self):
        with open(os.path.join(self.runs(self.best), "runs.jsonl")) as file:
            labels = [json.loads(line)["label"] for line in file]
        label = next(name for name in labels if name != "nominal")
        return f"{self.runs(self.best)}:{label}"


def four(cells):
    return "{:.3f} / {:.4f} / {:.3f} / {:.4f}".format(1000 * cells[0], cells[1], 1000 * cells[2], cells[3])


def largest_differences(cells, printed):
    d = [abs(a - b) for a, b in zip(cells, printed)]
    return max(d[0], d[2]), max(d[1], d[3])


def compared(one, label, row):
    """The published cells and the words for what differs; a difference that these do not cover is a failure."""
    published = one.reference["published"]
    if label == "nominal":
        printed, words, limits = published["optiodom"]["table_nominal"], "every digit", (6e-7, 6e-7)
    elif label in PUBLISHED and PUBLISHED[label] in published:
        printed, words, limits = published[PUBLISHED[label]]["table"], "every digit", (6e-7, 6e-7)
        if label == "classical:ivanjko":
            words, limits = "(a) their inner search stops early", (1e-5, 2e-3)
    elif label == "classical:jung_chung":
        return "", "(b) as the method is meant"
    elif label == "OptiOdom":
        printed, words, limits = published["optiodom"]["table"], "(c) 6 printed decimals", (3.5e-4, 0.02)
    elif label == "ours":
        theirs = one.rows["OptiOdom"]["J"]
        return "", f"(e) J {100 * (row['J'] / theirs - 1):+.2f} %"
    elif label == "classical:antonelli":
        return "", "(f)"
    else:
        return "", ""
    cells = [printed[name] for name in PRINTED]
    position, heading = largest_differences(row["cells"], cells)
    if position > limits[0] or heading > limits[1]:
        failures.append(f"{one.folder}, {label}: {position} m and {heading} deg from the published cells")
    if label == "classical:lin" and row["J"] < one.rows["ours"]["J"]:
        words += ", (d) below ours"
    elif words != "every digit":
        if position <= 6e-7 and heading <= 6e-7:
            words = "every digit"
        else:
            words += f": {1000 * position:.2g} mm, {heading:.2g} deg"
    return four(cells), words


def sets_section(sets):
    print("| set, row | J | largest errors: anywhere mm / deg / at the end mm / deg | published | differs |")
    print("|---|---|---|---|---|")
    for one in sets:
        runs = len(one.reference["files"])
        print(f"| **{one.folder}** ({runs} drive{'s' if runs > 1 else ''}) | | | | |")
        for label, row in one.rows.items():
            if row.get("J") is None or "cells" not in row:
                continue
            shown, words = compared(one, label, row)
            name = {"ours": "**ours**, " + ("multistart" if one.best == "multistart" else f"lm from {one.best}"),
                    "OptiOdom": "OptiOdom, published parameters"}.get(label, label.replace("classical:", ""))
            print(f"| {name} | {row['J']:.6g} | {four(row['cells'])} | {shown} | {words} |")
    print()


def starts_section(sets):
    print("| set | J* of an independent evaluation | lm from nominal | lm from censi / kallasi | multistart |")
    print("|---|---|---|---|---|")
    for one in sets:
        star = one.reference["problems"]["optiodom"]["optimum"]["J"]

        def cell(start):
            if start not in one.starts:
                return "–"
            j = one.starts[start]["J"]
            return f"{j:.10g}" if j <= star * (1 + 1e-9) + 1e-15 else f"{j:.6g} (stalls)"
        print(f"| {one.folder} | {star:.10g} | {cell('nominal')} | {cell(STARTS.get(one.kind))} | {cell('multistart')} |")
    print()


def ends_section(sets):
    print("| set | nominal | umbmark | umbmark_y | jung_chung | OptiOdom | ours |")
    print("|---|---|---|---|---|---|---|")
    for one in sets:
        if "classical:umbmark" not in one.rows or one.rows["classical:umbmark"].get("J") is None:
            continue
        rows = ["nominal", "classical:umbmark", "classical:umbmark_y", "classical:jung_chung", "OptiOdom", "ours"]
        print(f"| {one.folder} | " + " | ".join(f"{1000 * one.rows[r]['ends']:.1f}" for r in rows) + " |")
    print()


def transfer_section(sets, extras, ratios):
    """`ratios`: filled with kind -> (names of sets, rows of errors over nominal errors)"""
    known = {(t["calibrated_on"], t["tested_on"]): t for t in extras["transfer"]}
    worst = 0
    for kind in RULES:
        group = [s for s in sets if s.kind == kind]
        print(f"**{kind}**, largest position error in mm / heading error in deg; rows: calibrated on, columns: judged on\n")
        print("| | " + " | ".join(s.folder[len(kind) + 1:] for s in group) + " |")
        print("|---|" + "---|" * len(group))
        print("| nominal | " + " | ".join("{:.0f} / {:.1f}".format(1000 * s.rows["nominal"]["cells"][0],
                                                                   s.rows["nominal"]["cells"][1]) for s in group) + " |")
        ratios[kind] = [s.folder[len(kind) + 1:] for s in group], []
        for a in group:
            cells = []
            ratios[kind][1].append([])
            for b in group:
                rows = tables("evaluate", *b.options, "--parameters=" + a.best_runs())
                row = next(r for label, r in rows.items() if label != "nominal")["cells"]
                expected = known.get((a.folder, b.folder))
                if expected:
                    difference = abs(row[0] - expected["max_position_m"])
                    worst = max(worst, difference)
                    if difference > 1e-5:
                        failures.append(f"{a.folder} on {b.folder}: {row[0]} m, expected {expected['max_position_m']}")
                ratios[kind][1][-1].append(row[0] / b.rows["nominal"]["cells"][0])
                bold = "**" if a is b else ""
                sign = " !" if row[0] > b.rows["nominal"]["cells"][0] else ""
                cells.append(f"{bold}{1000 * row[0]:.0f} / {row[1]:.1f}{bold}{sign}")
            print(f"| {a.folder[len(kind) + 1:]} | " + " | ".join(cells) + " |")
        print()
    return worst


def ratio_colour(ratio):
    """Blue below 1, orange above, white at 1; full at a factor of 5."""
    share = min(1, abs(math.log(ratio)) / math.log(5))
    return "#" + "".join(f"{round(255 + share * (end - 255)):02x}" for end in ((42, 106, 168) if ratio < 1 else (214, 110, 34)))


def robot_square(kind, names, rows, x0, y0):
    """SVG elements of one robot's square, its first cell at (x0, y0)."""
    def short(name):
        return escape(f"{name.split('/')[0]} {name[-4:]}")
    parts = [f'<text x="{x0 - 8}" y="{y0 - 14}" class="kind">{escape(kind)}</text>']
    for i, name in enumerate(names):
        at = CELL * i
        parts.append(f'<text transform="translate({x0 + at + CELL / 2 + 4:g} {y0 - 8}) rotate(-40)">{short(name)}</text>')
        parts.append(f'<text x="{x0 - 8}" y="{y0 + at + 26}" class="row">{short(name)}</text>')
        for j, ratio in enumerate(rows[i]):
            home = ' class="home"' if i == j else ""
            ink = "#fff" if abs(math.log(ratio)) > math.log(3) else "#222"
            parts.append(f'<rect x="{x0 + CELL * j}" y="{y0 + at}" width="{CELL - 3}" height="{CELL - 3}" rx="4" '
                         f'fill="{ratio_colour(ratio)}"{home}/>')
            parts.append(f'<text x="{x0 + CELL * j + CELL / 2 - 2:g}" y="{y0 + at + 25}" class="value" fill="{ink}">'
                         f'{f"{ratio:.2f}" if ratio < 9.995 else f"{ratio:.0f}"}</text>')
    return parts


def travel_figure(ratios):
    """A square of cells per robot: calibrated on the row's drives, judged on the column's. The first robot, which has
    most sets, stands to the left of the others."""
    left, top, parts, y, height, width = 112, 92, [], 0, 0, 0
    for index, (kind, (names, rows)) in enumerate(ratios.items()):
        x0 = left if index == 0 else 2 * left + 60 + CELL * len(next(iter(ratios.values()))[0])
        parts += robot_square(kind, names, rows, x0, y + top)
        y = 0 if index == 0 else y + top + CELL * len(names)
        height = max(height, top + CELL * len(names) if index == 0 else y)
        width = max(width, x0 + CELL * len(names) + 48)
    style = ("text{font:12px sans-serif;fill:#222}.kind{font:bold 15px sans-serif;text-anchor:end}.row{text-anchor:end}"
             '.value{text-anchor:middle}.value[fill="#fff"]{fill:#fff}.home{stroke:#222;stroke-width:2}')
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height + 8}" role="img" '
            'aria-label="Largest position error after calibration over that with nominal values, on drives of other sets">\n'
            f'<style>{style}</style>\n<rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")


def main():
    with open(os.path.join(reference_folder, "robots.json")) as file:
        reference = json.load(file)
    with open(os.path.join(reference_folder, "robots_extras.json")) as file:
        extras = json.load(file)
    sets = [Set(folder, entry) for folder, entry in reference.items()]
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "optiodom_words.md")) as file:
        parts = file.read().split("<!-- table -->\n")
    for part, section in zip(parts, (sets_section, starts_section, ends_section)):
        print(part, end="")
        section(sets)
    print(parts[3], end="")
    ratios = {}
    worst = transfer_section(sets, extras, ratios)
    if figure:
        with open(figure, "w") as file:
            file.write(travel_figure(ratios))
    print(parts[4].replace("WORST", f"{1000 * worst:.2g}"), end="")
    for line in failures:
        print("optiodom_table: " + line, file=sys.stderr)
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    figure = sys.argv.pop(1)[len("--figure="):] if sys.argv[1:] and sys.argv[1].startswith("--figure=") else None
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__.strip())
    program, data, reference_folder = (os.path.abspath(word) for word in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as temporary:
        work = os.path.abspath(sys.argv[4]) if len(sys.argv) == 5 else temporary
        os.makedirs(work, exist_ok=True)
        main()
