"""Work and precision of the time integration on the base case with 30 elements, 1 s.

    cargo build --release && python3 benches/work_precision.py

Errors are against the same mesh with generalized-alpha at 2.5e-5 s: the largest difference of the
driven speed, relative to 12 rad/s, and the RMS difference of the two span tensions. CPU time is that of
the stepping, the smallest of three runs.
"""

import csv
import json
import math
import os
import subprocess
import tempfile

PROGRAM = os.path.join("target", "release", "hihna")
SPANS = ("driver-driven.tension", "driven-driver.tension")
CASES = [
    ("auto, accuracy 2e-2", ["run.accuracy=2e-2"]),
    ("auto, accuracy 1e-2", ["run.accuracy=1e-2"]),
    ("auto, accuracy 1e-3 (default)", []),
    ("auto, accuracy 1e-4", ["run.accuracy=1e-4"]),
    ("generalized-alpha, 1e-3 s", ["run.step=1e-3", 'run.integrator="generalized-alpha"']),
    ("generalized-alpha, 5e-4 s", ["run.step=5e-4", 'run.integrator="generalized-alpha"']),
    ("generalized-alpha, 2.5e-4 s", ["run.step=2.5e-4", 'run.integrator="generalized-alpha"']),
    ("TR-BDF2, 1e-3 s", ["run.step=1e-3", 'run.integrator="tr-bdf2"']),
    ("TR-BDF2, 5e-4 s", ["run.step=5e-4", 'run.integrator="tr-bdf2"']),
]


def run(folder, settings, repeats):
    command = [PROGRAM, "run", "--out", folder, "--force", "--json", "--quiet"]
    for setting in ["belt.elements=30", "run.end_time=1.0", *settings]:
        command += ["--set", setting]
    seconds = math.inf
    for _ in range(repeats):
        output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
        summary = json.loads(output)
        seconds = min(seconds, summary["solver"]["cpu_seconds"])
    with open(os.path.join(folder, "history.csv"), newline="") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return summary, seconds, rows


def main():
    with tempfile.TemporaryDirectory() as folder:
        place = os.path.join(folder, "result")
        _, _, exact = run(place, ["run.step=2.5e-5", "run.accuracy=1e-4"], 1)
        print(
            "| run | steps | halved | forces | tangents | speed error, 1e-4 of 12 rad/s "
            "| tension RMS % | energy residual 1e-4 | CPU s |"
        )
        print("|---|---|---|---|---|---|---|---|---|")
        for name, settings in CASES:
            summary, seconds, rows = run(place, settings, 3)
            speed = max(abs(a["driven.speed"] - b["driven.speed"]) for a, b in zip(rows, exact)) / 12.0
            error = sum((a[k] - b[k]) ** 2 for a, b in zip(rows, exact) for k in SPANS)
            scale = sum(b[k] ** 2 for b in exact for k in SPANS)
            solver = summary["solver"]
            print(
                f"| {name} | {solver['steps']} | {solver['halved_steps']} | {solver['force_evaluations']} "
                f"| {solver['tangent_evaluations']} | {1e4 * speed:.2f} "
                f"| {100 * math.sqrt(error / scale):.2f} "
                f"| {1e4 * summary['audit']['energy_residual']:.2f} | {seconds:.3f} |"
            )


if __name__ == "__main__":
    main()
