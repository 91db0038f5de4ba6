#!/usr/bin/env bash
# Draws docs/figures/drives.svg: one drive per trajectory as motion capture saw it, and where odometry says the robot was
# with nominal and with calibrated parameters. For whoever edits the README: needs gnuplot and python3
# (apt-get install gnuplot-nox python3), which neither building nor testing does.
#
# usage: scripts/readme_figure.sh SET.JSON [FIGURE.SVG]
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
bench=$root/build/release/bench/bench
if (($# < 1 || $# > 2)); then
  echo "usage: scripts/readme_figure.sh SET.JSON [FIGURE.SVG]" >&2
  exit 2
fi
set_json=$(realpath "$1")
figure=$(realpath --canonicalize-missing "${2:-$root/docs/figures/drives.svg}")
"$root/scripts/setup.sh" release bench
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$bench" --quiet --data="$set_json" --solver=lm --out=runs >/dev/null
python3 - <<'PYTHON'
import json
best = [r for r in map(json.loads, open("runs/runs.jsonl")) if r["label"] == "lm"][0]
json.dump({p["name"]: p["value"] for p in best["parameters"]} | {"name": "calibrated"}, open("calibrated.json", "w"))
PYTHON
"$bench" evaluate --data="$set_json" --parameters=nominal,calibrated.json --tracks=tracks.csv >/dev/null

# The first drive of each trajectory, thinned to about 120 points: one file per drive and parameter set.
awk -F, 'NR > 1 && $1 ~ /_1$/ { print >($1 "." $2 ".raw") }' tracks.csv
for raw in *.raw; do
  awk -F, -v rows="$(wc -l <"$raw")" 'BEGIN { step = int(rows / 120) + 1 }
    NR % step == 1 || NR == rows { print $3, $4, $5, $6, $7, $8, $9 }' "$raw" >"${raw%.raw}.dat"
done

mkdir -p "$(dirname "$figure")"
FIGURE=$figure gnuplot <<'GNUPLOT'
set terminal svg size 1000,600 font "sans-serif,13" background "white"
set output system("echo $FIGURE")
set multiplot layout 2,3 margins 0.07,0.985,0.15,0.92 spacing 0.065,0.14
set style line 1 lc rgb "#222222" lw 3
set style line 2 lc rgb "#d55e00" lw 1.8 dt (8,4)
set style line 3 lc rgb "#0072b2" lw 1.8
set border 3 lc rgb "#666666"
set tics nomirror textcolor rgb "#444444"
set xlabel "x [m]" offset 0,0.6
set ylabel "y [m]" offset 1.4,0
unset key
set xtics autofreq; set format y "%g"

paths(name) = sprintf('plot "%s.nominal.dat" using 5:6 with lines ls 1, "%s.nominal.dat" using 2:3 with lines ls 2, \
  "%s.calibrated.dat" using 2:3 with lines ls 3', name, name, name)
away(name) = sprintf('plot 0 with lines ls 1, \
  "%s.nominal.dat" using 1:(1000*sqrt(($2-$5)**2+($3-$6)**2)) with lines ls 2, \
  "%s.calibrated.dat" using 1:(1000*sqrt(($2-$5)**2+($3-$6)**2)) with lines ls 3', name, name)
turned(name) = sprintf('plot 0 with lines ls 1, "%s.nominal.dat" using 1:(($4-$7)*180/pi) with lines ls 2, \
  "%s.calibrated.dat" using 1:(($4-$7)*180/pi) with lines ls 3', name, name)
set title "4 m along x: path"
eval paths("line_x_1")
set title "4 m along y: path"
eval paths("line_y_1")
set xlabel "time [s]"
set ylabel "position error [mm]" offset 1.2,0
set title "circle, counter-clockwise"
eval away("circle_ccw_1")
set title "circle, clockwise"
eval away("circle_cw_1")
set ylabel "heading error [deg]" offset 1.2,0
set title "turn on the spot, counter-clockwise"
eval turned("rotation_ccw_1")
set title "turn on the spot, clockwise"
eval turned("rotation_cw_1")
# The key alone, in a plot without a frame below the others.
set margins screen 0, screen 1, screen 0, screen 0.07
unset border; unset tics; unset xlabel; unset ylabel; unset title
set key at screen 0.5,0.03 center center horizontal maxrows 1 samplen 3 width 1
set xrange [0:1]; set yrange [0:1]
plot 2 with lines ls 1 title "motion capture", 2 with lines ls 2 title "odometry, nominal parameters", \
  2 with lines ls 3 title "odometry, calibrated"
unset multiplot
GNUPLOT
echo "$figure: $(stat --format=%s "$figure") bytes"
