"""Work and precision of the time integration, 1 s of three drives.

    cargo build --release && python3 benches/work_precision.py

Errors are against the same mesh at a small fixed step: the largest difference of any speed, relative to the largest
of that pulley, and the RMS difference of the span tensions. CPU time is that of the stepping, the smallest of
three runs.
"""

import csv
import json
import math
import os
import subprocess
import tempfile

PROGRAM = os.environ.get("HIHNA", os.path.join("target", "release", "hihna"))
GENERALIZED_ALPHA = 'run.integrator="generalized-alpha"'
TR_BDF2 = 'run.integrator="tr-bdf2"'
# Title, drive file with settings, the reference's step, runs.
DRIVES = [
    (
        "base case, 30 elements",
        ["examples/two_pulley.toml", "belt.elements=30", "run.end_time=1.0"],
        "2.5e-5",
        [
            ("auto, accuracy 2e-2", ["run.accuracy=2e-2"]),
            ("auto, accuracy 1e-2", ["run.accuracy=1e-2"]),
            ("auto, accuracy 1e-3 (default)", []),
            ("auto, accuracy 1e-4", ["run.accuracy=1e-4"]),
            ("generalized-alpha, 1e-3 s", ["run.step=1e-3", GENERALIZED_ALPHA]),
            ("generalized-alpha, 5e-4 s", ["run.step=5e-4", GENERALIZED_ALPHA]),
            ("generalized-alpha, 2.5e-4 s", ["run.step=2.5e-4", GENERALIZED_ALPHA]),
            ("TR-BDF2, 1e-3 s", ["run.step=1e-3", TR_BDF2]),
            ("TR-BDF2, 5e-4 s", ["run.step=5e-4", TR_BDF2]),
        ],
    ),
    (
        "120 rad/s, 30 elements",
        ["examples/figures_3_10_to_3_20.toml"],
        "2e-5",
        [
            ("auto, accuracy 1e-3 (default)", []),
            ("generalized-alpha, 1e-4 s", ["run.step=1e-4", GENERALIZED_ALPHA]),
            ("generalized-alpha, 2e-4 s", ["run.step=2e-4", GENERALIZED_ALPHA]),
            ("TR-BDF2, accuracy 1e-3", [TR_BDF2]),
            ("TR-BDF2, accuracy 1e-2", [TR_BDF2, "run.accuracy=1e-2"]),
        ],
    ),
    (
        "serpentine, 60 elements, five pulleys",
        ["examples/serpentine.toml"],
        "2e-5",
        [
            ("auto, accuracy 1e-2", ["run.accuracy=1e-2"]),
            ("auto, accuracy 1e-3 (default)", []),
        ],
    ),
]


def run(folder, drive, settings, repeats):
    command = [PROGRAM, "run", drive[0], "--out", folder, "--force", "--json", "--quiet"]
    for setting in [*drive[1:], *settings]:
        command += ["--set", setting]
    seconds = math.inf
    for _ in range(repeats):
        output = subprocess.run(command, capture_output=True, text=True, check=False).stdout
        summary = json.loads(output)
        seconds = min(seconds, summary["solver"]["cpu_seconds"])
    with open(os.path.join(folder, "history.csv"), newline="") as file:
        rows = [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]
    return summary, seconds, rows


def errors(rows, exact):
    """Of speeds and tensions."""
    pulleys = [k for k in exact[0] if k.endswith(".speed") and "-" not in k]
    spans = [k for k in exact[0] if k.endswith(".tension")]
    speed = max(
        max(abs(a[k] - b[k]) for a, b in zip(rows, exact)) / max(abs(b[k]) for b in exact) for k in pulleys
    )
    error = sum((a[k] - b[k]) ** 2 for a, b in zip(rows, exact) for k in spans)
    scale = sum(b[k] ** 2 for b in exact for k in spans)
    return speed, math.sqrt(error / scale)


def main():
    with tempfile.TemporaryDirectory() as folder:
        place = os.path.join(folder, "result")
        for title, drive, step, cases in DRIVES:
            _, _, exact = run(place, drive, [f"run.step={step}", GENERALIZED_ALPHA, "run.accuracy=1e-4"], 1)
            print(f"\n## {title}\n")
            print("| run | steps | halved | forces | tangents | speed error 1e-4 | tension RMS % | energy residual 1e-4 | CPU s |")
            print("|---|---|---|---|---|---|---|---|---|")
            for name, settings in cases:
                summary, seconds, rows = run(place, drive, settings, 3)
                speed, tension = errors(rows, exact)
                solver = summary["solver"]
                print(
                    f"| {name} | {solver['steps']} | {solver['halved_steps']} | {solver['force_evaluations']} "
                    f"| {solver['tangent_evaluations']} | {1e4 * speed:.2f} | {100 * tension:.2f} "
                    f"| {1e4 * summary['audit']['energy_residual']:.2f} | {seconds:.3f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
