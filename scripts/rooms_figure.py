#!/usr/bin/env python3
"""Draws docs/figures/rooms.svg from the project's own includes: a row and a column per room, a mark where the row includes the
column. Rooms stand in the order of the floors and within a floor below those that include them, so every mark lies left of
the diagonal; what does not is an arrow upward or a circle. Files that list the rooms below their own (rows of
scripts/check.sh that name a file) are not drawn.

usage: scripts/rooms_figure.py [--check [ROOT]]
  --check   draw nothing; exit 1 where headers include each other in a circle, where a mark would lie right of the
            diagonal, or where the figure is not that of the sources; of the checkout ROOT (default: this one)
"""
import pathlib
import re
import sys
from html import escape

HERE = pathlib.Path(__file__).resolve().parent
FLOORS = ["base", "datasets", "problems", "solvers", "reports", "bench"]
COLOURS = {"base": "#8a8f98", "datasets": "#2a7f9e", "problems": "#3d8b54", "solvers": "#a07a1e", "reports": "#8a5aa8", "bench": "#b4553c"}
INCLUDE = re.compile(r'^\s*#\s*include\s*"((?:%s)/[^"]+)"' % "|".join(FLOORS), re.M)
CELL, LEFT, TOP = 14, 190, 24


def includes(root):
    """file -> files of ours that it includes"""
    table = (HERE / "check.sh").read_text().split("arrows='")[1].split("'")[0]
    lists = {line.split()[0] for line in table.split("\n") if line and line.split()[0].endswith(".cpp")}
    graph = {}
    for floor in FLOORS:
        for path in sorted((root / floor).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix in (".hpp", ".cpp") and path.is_file() and name not in lists and name != "bench/main.cpp":
                graph[name] = INCLUDE.findall(path.read_text())
    return graph


def room(name):
    return name.rsplit("/", 1)[0]


def circle(graph):
    """Nodes that include each other, the first again at the end; None without."""
    done, trail = set(), []

    def visit(node):
        if node in trail:
            return trail[trail.index(node):] + [node]
        if node in done:
            return None
        trail.append(node)
        for other in graph.get(node, ()):
            found = visit(other)
            if found:
                return found
        done.add(trail.pop())
        return None

    for node in sorted(graph):
        found = visit(node)
        if found:
            return found
    return None


def rooms_of(graph):
    arrows = {}
    for name, targets in graph.items():
        arrows.setdefault(room(name), set()).update(room(t) for t in targets if room(t) != room(name) and t in graph)
    return arrows


def ordered(arrows):
    """Floor by floor; within a floor first what the others include."""
    order = []
    for floor in FLOORS:
        rest = sorted(r for r in arrows if r.split("/")[0] == floor)
        while rest:
            free = [r for r in rest if not arrows[r] & set(rest)] or rest  # a circle: as they come
            order.append(free[0])
            rest.remove(free[0])
    return order


def upward(arrows, order):
    place = {r: i for i, r in enumerate(order)}
    return [(r, t) for r in order for t in sorted(arrows[r]) if place[t] > place[r]]


def drawn(arrows, order):
    place = {r: i for i, r in enumerate(order)}
    width, height = LEFT + CELL * len(order) + 10, TOP + CELL * len(order) + 30
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="11">',
           f'<rect width="{width}" height="{height}" fill="#ffffff"/>',
           f'<text x="{LEFT}" y="15" fill="#444">a mark: the room of the row includes that of the column</text>']
    for r in order:
        i, colour = place[r], COLOURS[r.split("/")[0]]
        y = TOP + CELL * i
        out.append(f'<rect x="0" y="{y}" width="{LEFT + CELL * i}" height="{CELL}" fill="{colour}" fill-opacity="{0.16 if i % 2 else 0.08}"/>')
        out.append(f'<text x="6" y="{y + 11}" fill="#222">{escape(r)}/</text>')
        out.append(f'<rect x="{LEFT + CELL * i}" y="{y}" width="{CELL}" height="{CELL}" fill="{colour}"><title>{escape(r)}</title></rect>')
        for t in sorted(arrows[r], key=place.get):
            x, mark = LEFT + CELL * place[t], COLOURS[t.split("/")[0]] if place[t] < i else "#ff0000"
            out.append(f'<circle cx="{x + CELL / 2:g}" cy="{y + CELL / 2:g}" r="4" fill="{mark}"><title>{escape(r)} includes {escape(t)}</title></circle>')
    out.append(f'<text x="{LEFT}" y="{height - 10}" fill="#444">{len(order)} rooms; '
               f'{"no arrow upward, no circle" if not upward(arrows, order) else "red: upward"}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    check = sys.argv[1:2] == ["--check"]
    if len(sys.argv) > (3 if check else 1):
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[2]).resolve() if len(sys.argv) == 3 else HERE.parent
    graph = includes(root)
    arrows = rooms_of(graph)
    order = ordered(arrows)
    wrong = []
    headers = circle({f: t for f, t in graph.items() if f.endswith(".hpp")})
    if headers:
        wrong.append(f"{headers[0]}:1: headers in a circle: " + " -> ".join(headers))
    wrong += [f"{r}:1: includes {t}, which stands above it or includes it" for r, t in upward(arrows, order)]
    figure = root / "docs/figures/rooms.svg"
    if not check:
        figure.write_text(drawn(arrows, order))
    elif figure.parent.is_dir() and not (figure.is_file() and figure.read_text() == drawn(arrows, order)):
        wrong.append("docs/figures/rooms.svg:1: not that of the sources: run scripts/rooms_figure.py")
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
