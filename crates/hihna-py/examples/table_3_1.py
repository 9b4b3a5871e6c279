"""Driven speed and span tensions of the two-pulley drive of Table 3.1: `python table_3_1.py [PICTURE.png]`."""

import sys

import hihna

results = hihna.Drive.built_in().run()
print(results)
for span, found in results.summary["steady"]["span"].items():
    print(f"{span}: {found['tension']:.2f} N on average over the last tenth")

if len(sys.argv) > 1:
    import matplotlib.pyplot as plt

    figure, (speed, tension) = plt.subplots(2, sharex=True)
    speed.plot(results.time, results["driver.speed"], results.time, results["driven.speed"])
    tension.plot(results.time, results["driver-driven.tension"], results.time, results["driven-driver.tension"])
    speed.set_ylabel("speed [rad/s]")
    tension.set(xlabel="time [s]", ylabel="tension [N]")
    figure.savefig(sys.argv[1])
