#!/usr/bin/env python3
"""Draws the history of a run: pulley speeds and span tensions over time, as SVG.

    python3 docs/plot_history.py RESULT_FOLDER [OUTPUT.svg]

Without OUTPUT the picture goes to docs/src/images/NAME.svg, NAME being the folder's name without
`-result`. Needs nothing but Python's standard library.
"""

import csv
import json
import math
import sys
from html import escape
from pathlib import Path

WIDTH, PANEL, GAP, LEFT, RIGHT, TOP, BOTTOM = 800, 230, 78, 78, 24, 84, 56
COLOURS = ["#0b5cad", "#c2410c", "#15803d", "#7e22ce", "#0f766e", "#a16207"]
DASHES = ["", "7 4", "2 3", "9 3 2 3"]
INK, GRID, PAPER = "#1f2933", "#d5dbe1", "#ffffff"
FONT = "font-family='Helvetica, Arial, sans-serif'"


def read(folder):
    """Columns of history.csv by name."""
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        names = next(rows)
        columns = list(zip(*([float(x) for x in row] for row in rows)))
    if not columns:
        raise ValueError("history.csv has no rows")
    return dict(zip(names, columns))


def ticks(low, high, count):
    """About `count` round numbers within [low, high]."""
    rough = (high - low) / count
    power = 10.0 ** math.floor(math.log10(rough))
    step = min((f * power for f in (1, 2, 5, 10)), key=lambda step: abs(math.log(step / rough)))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    return [(i * step, f"{i * step:.{decimals}f}") for i in range(first, last + 1)]


def text(x, y, words, size=13, anchor="start", weight="normal", turn=""):
    return (
        f"<text x='{x:.1f}' y='{y:.1f}' font-size='{size}' text-anchor='{anchor}' "
        f"font-weight='{weight}' fill='{INK}' {FONT}{turn}>{escape(words)}</text>"
    )


def line(x1, y1, x2, y2, colour, width=1.0, dash=""):
    dashes = f" stroke-dasharray='{dash}'" if dash else ""
    return (
        f"<line x1='{x1:.1f}' y1='{y1:.1f}' x2='{x2:.1f}' y2='{y2:.1f}' "
        f"stroke='{colour}' stroke-width='{width}'{dashes}/>"
    )


def panel(top, title, unit, time, curves, last):
    """One diagram: `curves` by name over `time`; the last one carries the label of the time axis."""
    low = min(min(values) for values in curves.values())
    high = max(max(values) for values in curves.values())
    pad = 0.06 * (high - low) or max(abs(high), 1.0) * 0.05
    low, high = low - pad, high + pad
    start, end = time[0], time[-1]
    width = WIDTH - LEFT - RIGHT

    def x(t):
        return LEFT + width * (t - start) / (end - start or 1.0)

    def y(value):
        return top + PANEL * (high - value) / (high - low)

    out = [text(LEFT, top - 28, title, 14, weight="bold")]
    for value, label in ticks(low, high, 6):
        out.append(line(LEFT, y(value), WIDTH - RIGHT, y(value), GRID))
        out.append(text(LEFT - 8, y(value) + 4.5, label, anchor="end"))
    for value, label in ticks(start, end, 8) if end > start else []:
        out.append(line(x(value), top, x(value), top + PANEL, GRID))
        out.append(text(x(value), top + PANEL + 18, label, anchor="middle"))
    middle = top + PANEL / 2
    out.append(text(20, middle, unit, anchor="middle", turn=f" transform='rotate(-90 20 {middle})'"))
    if last:
        out.append(text(LEFT + width / 2, top + PANEL + 40, "time [s]", anchor="middle"))

    place = LEFT
    for i, (name, values) in enumerate(curves.items()):
        colour, dash = COLOURS[i % len(COLOURS)], DASHES[i % len(DASHES)]
        dashes = f" stroke-dasharray='{dash}'" if dash else ""
        points = " ".join(f"{x(t):.1f},{y(v):.1f}" for t, v in zip(time, values))
        out.append(
            f"<polyline points='{points}' fill='none' stroke='{colour}' stroke-width='1.8' "
            f"stroke-linejoin='round'{dashes}/>"
        )
        out.append(line(place, top - 11, place + 28, top - 11, colour, 2.4, dash))
        out.append(text(place + 34, top - 6.5, name, 12))
        place += 34 + 7 * len(name) + 30
    out.append(
        f"<rect x='{LEFT}' y='{top}' width='{width}' height='{PANEL}' fill='none' stroke='{INK}'/>"
    )
    return out


def thin(time, curves, most=1500):
    """At most about `most` points of each curve."""
    every = max(1, math.ceil(len(time) / most))
    pick = sorted(set(range(0, len(time), every)) | {len(time) - 1})
    return [time[i] for i in pick], {n: [v[i] for i in pick] for n, v in curves.items()}


def draw(folder):
    """The whole picture."""
    history = read(folder)
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    pulleys, spans = summary["end"]["pulley"], summary["end"]["span"]
    speeds = {name: history[f"{name}.speed"] for name in pulleys}
    tensions = {f"span {name}": history[f"{name}.tension"] for name in spans}
    height = TOP + 2 * PANEL + GAP + BOTTOM
    title = summary["title"] or "Belt drive"
    out = [
        f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {height}' role='img' "
        f"aria-label='{escape(title, quote=True)}: pulley speeds and span tensions over time'>",
        f"<rect width='{WIDTH}' height='{height}' fill='{PAPER}'/>",
        text(LEFT, 30, title, 17, weight="bold"),
    ]
    time, curves = thin(history["time"], speeds)
    out += panel(TOP, "Pulley speeds", "speed [rad/s]", time, curves, False)
    time, curves = thin(history["time"], tensions)
    out += panel(TOP + PANEL + GAP, "Span tensions", "tension [N]", time, curves, True)
    out.append("</svg>")
    return "\n".join(out) + "\n"


def main(arguments):
    if len(arguments) not in (1, 2) or arguments[0].startswith("-"):
        print(__doc__.strip(), file=sys.stderr)
        return 0 if arguments in (["-h"], ["--help"]) else 2
    folder = Path(arguments[0])
    if len(arguments) == 2:
        target = Path(arguments[1])
    else:
        name = folder.resolve().name.removesuffix("-result")
        target = Path(__file__).resolve().parent / "src" / "images" / f"{name}.svg"
    try:
        picture = draw(folder)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(picture, encoding="utf-8")
    except (OSError, KeyError, ValueError) as error:
        print(f"cannot draw {folder}: {error}", file=sys.stderr)
        return 1
    print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
