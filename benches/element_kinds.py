"""Coordinates and CPU time that belts of each kind of element need for 1 % in driven speed and 3 % in tension.

    cargo build --release && python3 benches/element_kinds.py

The drive of Fig. 3.7 over 1 s. Errors are against 160 belt beams: the largest difference of the driven speed,
relative to 12 rad/s, and the RMS difference of the two span tensions, relative to their RMS. Each kind is
refined until both are met. CPU time is that of the stepping, the smallest of three runs.
"""

import csv
import json
import math
import os
import subprocess
import tempfile

PROGRAM = os.environ.get("HIHNA", os.path.join("target", "release", "hihna"))
DRIVE = os.path.join("examples", "figure_3_7.toml")
SPANS = ("driver-driven.tension", "driven-driver.tension")
REFERENCE = ("belt-beam", "7", 0.3, 160)
# Element, contact points per element ("nodes": at its ends, which neighbours share), Poisson's ratio, meshes. The
# cubic beam is in plane strain: its axial stiffness is E A/(1 - nu²), so that it is compared without lateral
# contraction as well.
KINDS = [
    ("belt-beam", "7", 0.3, [20, 25, 30, 32, 34, 36, 38, 40]),
    ("cubic-beam", "7", 0.3, [20, 40, 80, 120]),
    ("cubic-beam", "7", 0.0, [20, 30, 40, 50, 60, 70, 80, 100, 120]),
    ("linear-beam", "5", 0.3, [40, 80, 120, 160, 180, 200, 220, 240, 280, 320]),
    ("linear-beam", "nodes", 0.3, [40, 80, 120, 160, 180, 190, 200, 210, 220, 240, 260, 280, 320, 400]),
    ("linear-beam", "1", 0.3, [40, 80, 120, 160, 200, 240, 260, 280, 300, 320, 360, 400]),
]


def run(folder, element, points, poisson, elements, repeats):
    command = [PROGRAM, "run", DRIVE, "--out", folder, "--force", "--json", "--quiet"]
    for setting in (
        f"belt.element={element}",
        f"belt.elements={elements}",
        f"contact.points={2 if points == 'nodes' else points}",
        f'contact.integration="{"trapezoidal" if points == "nodes" else "gauss"}"',
        f"belt.poisson_ratio={poisson}",
        "run.end_time=1.0",
    ):
        command += ["--set", setting]
    seconds = math.inf
    for _ in range(repeats):
        output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
        summary = json.loads(output)
        if "solver" not in summary:
            return None
        seconds = min(seconds, summary["solver"]["cpu_seconds"])
    with open(os.path.join(folder, "history.csv"), newline="") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return summary, seconds, rows


def main():
    with tempfile.TemporaryDirectory() as folder:
        place = os.path.join(folder, "result")
        _, _, exact = run(place, *REFERENCE, 1)
        scale = sum(row[k] ** 2 for row in exact for k in SPANS)
        print(
            "| element | nu | contact points per element | elements | coordinates | CPU s | speed error % "
            "| tension error % | tension at rest N | audit |"
        )
        print("|---|---|---|---|---|---|---|---|---|---|")
        for element, points, poisson, meshes in KINDS:
            for elements in meshes:
                result = run(place, element, points, poisson, elements, 3)
                if result is None:
                    print(f"| {element} | {poisson} | {points} | {elements} | | | | | | did not start |", flush=True)
                    continue
                summary, seconds, rows = result
                speed = max(abs(a["driven.speed"] - b["driven.speed"]) for a, b in zip(rows, exact)) / 12.0
                error = sum((a[k] - b[k]) ** 2 for a, b in zip(rows, exact) for k in SPANS)
                tension = math.sqrt(error / scale)
                print(
                    f"| {element} | {poisson} | {points} | {elements} | {summary['model']['dofs']} | {seconds:.3f} "
                    f"| {100 * speed:.2f} | {100 * tension:.1f} | {summary['start']['tension']:.2f} "
                    f"| {'passed' if summary['audit']['passed'] else 'failed'} |",
                    flush=True,
                )
                if speed <= 0.01 and tension <= 0.03:
                    break


if __name__ == "__main__":
    main()
