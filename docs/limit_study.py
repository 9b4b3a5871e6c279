"""Belt beams on their way to the extensible string: docs/src/studies/string_limit.md.

    cargo build --release && python3 docs/limit_study.py

Runs examples/towards_the_string.toml with one number changed at a time and compares its steady means with
`hihna steady`. Prints the table of the page and draws docs/src/images/string_limit.svg. Python's own
library is enough.
"""

import json
import math
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target" / "release" / "hihna"
DRIVE = ROOT / "examples" / "towards_the_string.toml"
SWEEPS = {
    "belt.elements": [60, 80, 100, 120],
    "belt.bending_factor": [1.0, 0.1, 0.01, 0.001],
    "contact.stiffness": [1e7, 1e8, 1e9, 1e10],
    "contact.friction.slope": [1e4, 3e4, 1e5, 3e5],
}


def call(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True)
    if not done.stdout:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def compare(key, value):
    change = ["--set", f"{key}={value}"]
    with tempfile.TemporaryDirectory() as folder:
        run = call("run", DRIVE, "--json", "--quiet", "--out", f"{folder}/out", *change)
    string = call("steady", DRIVE, "--json", *change)["steady"]
    means = run["steady"]
    speed = means["pulley"]["driven"]["speed"] / string["pulley"]["driven"]["speed"] - 1
    tension = max(
        abs(means["span"][name]["tension"] / state["tension"] - 1)
        for name, state in string["span"].items()
    )
    return abs(speed), tension, run["audit"]["passed"], run["solver"]["cpu_seconds"]


def chart(results):
    """Four panels side by side: errors over the number changed, both axes logarithmic."""
    width, height, left, top = 230, 220, 58, 40
    floor, ceiling = -6, 1
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width * len(results) + 30} {height + 110}" '
        'font-family="sans-serif" font-size="11">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for panel, (key, rows) in enumerate(results.items()):
        x0, y0 = left + panel * width, top
        w, h = width - 60, height
        logs = [math.log10(value) for value, *_ in rows]
        low, high = min(logs), max(logs)

        def place(value, error):
            x = x0 + w * (math.log10(value) - low) / (high - low)
            y = y0 + h * (ceiling - math.log10(max(error, 10.0**floor))) / (ceiling - floor)
            return x, y

        parts.append(f'<rect x="{x0}" y="{y0}" width="{w}" height="{h}" fill="none" stroke="#888"/>')
        parts.append(f'<text x="{x0 + w / 2}" y="{y0 - 10}" text-anchor="middle">{key}</text>')
        for power in range(floor, ceiling + 1):
            y = place(rows[0][0], 10.0**power)[1]
            parts.append(f'<line x1="{x0}" x2="{x0 + w}" y1="{y:.1f}" y2="{y:.1f}" stroke="#ddd"/>')
            if panel == 0:
                parts.append(f'<text x="{x0 - 6}" y="{y + 4:.1f}" text-anchor="end">1e{power}</text>')
        for value, *_ in rows:
            x = place(value, 1.0)[0]
            parts.append(f'<text x="{x:.1f}" y="{y0 + h + 16}" text-anchor="middle">{value:g}</text>')
        for index, colour in ((1, "#0072b2"), (2, "#d55e00")):
            points = [place(row[0], row[index]) for row in rows]
            line = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
            parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
            parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
    y = top + height + 44
    parts.append(f'<text x="{left}" y="{y}" fill="#0072b2">driven speed, relative difference from the string</text>')
    parts.append(f'<text x="{left}" y="{y + 18}" fill="#d55e00">span tension, larger of the relative differences</text>')
    parts.append("</svg>\n")
    (ROOT / "docs" / "src" / "images" / "string_limit.svg").write_text("\n".join(parts))


def main():
    results = {}
    print("| changed | value | speed | tension | audit | CPU s |")
    print("|---|---|---|---|---|---|")
    for key, values in SWEEPS.items():
        results[key] = []
        for value in values:
            speed, tension, passed, cpu = compare(key, value)
            results[key].append((value, speed, tension))
            audit = "passed" if passed else "FAILED"
            print(f"| `{key}` | {value:g} | {speed:.1e} | {tension:.1e} | {audit} | {cpu:.1f} |", flush=True)
    chart(results)


if __name__ == "__main__":
    main()
