#!/usr/bin/env python3
"""Draws docs/figures/coverage.svg, how often 95 % intervals hold the truth, from the output of trust_coverage.

usage: trust_coverage > coverage.csv; scripts/coverage_figure.py coverage.csv > docs/figures/coverage.svg
"""
import csv
import sys

ROWS = [("determined", "what drives determine"), ("same_drives", "the same, same drives"),
        ("parameters", "single parameters"), ("end_errors", "end errors of new drives")]
LEFT, TOP, WIDTH, STEP, GAP = 250, 30, 380, 17, 14
COLOURS = ["#0b5cab", "#4c9be8", "#c2571a", "#3f7d3a"]
LEAST = 60


def main():
    rows = list(csv.DictReader(open(sys.argv[1])))
    sets = list(dict.fromkeys(r["set"] for r in rows))
    share = {(r["set"], r["what"]): (float(r["percent"]), int(r["intervals"])) for r in rows if r["intervals"]}
    at = lambda percent: LEFT + WIDTH * (max(percent, LEAST) - LEAST) / (100 - LEAST)
    parts, y = [], TOP
    for name in sets:
        for (key, words), colour in zip(ROWS, COLOURS):
            y += STEP
            percent, count = share.get((name, key), (0, 0))
            if key == "determined":
                parts.append(f'<text x="8" y="{y + 4}" font-weight="bold">{name}</text>')
            parts.append(f'<text x="{LEFT - 10}" y="{y + 4}" text-anchor="end">{words}</text>')
            if count == 0:
                parts.append(f'<text x="{at(LEAST) + 6:.1f}" y="{y + 4}" fill="#555e69">none given</text>')
                continue
            parts.append(f'<circle cx="{at(percent):.1f}" cy="{y}" r="4.5" fill="{colour}"/>')
            parts.append(f'<text x="{LEFT + WIDTH + 12}" y="{y + 4}">{percent:.1f} %</text>')
        y += GAP
    height = y + 30
    band = (f'<rect x="{at(90):.1f}" y="{TOP}" width="{at(99) - at(90):.1f}" height="{y - TOP}" fill="#e4eef8"/>'
            f'<line x1="{at(95):.1f}" x2="{at(95):.1f}" y1="{TOP}" y2="{y}" stroke="#555e69" stroke-dasharray="3 3"/>')
    axis = "".join(f'<text x="{at(p):.1f}" y="{y + 18}" text-anchor="middle">{p} %</text>' for p in range(60, 101, 10))
    print(f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + 80}" height="{height}" '
          f'font-family="sans-serif" font-size="12" fill="#1c2127"><title>How often 95 % intervals hold the truth</title>'
          f'<rect width="100%" height="100%" fill="#ffffff"/>{band}{axis}{"".join(parts)}</svg>')


if __name__ == "__main__":
    main()
