"""How far the driven pulley of Table 3.1 overshoots with its inertia, and what the steady theory says of a load."""

import hihna

drive = hihna.Drive.built_in().with_(run__end_time=1.0)
print("inertia [kg m2]   peak speed [rad/s]   least tension [N]")
for inertia in (0.05, 0.1, 0.2):
    results = drive.with_({"pulley.driven.inertia": inertia}).run()
    tension = min(results["driver-driven.tension"].min(), results["driven-driver.tension"].min())
    print(f"{inertia:15.2f}   {results['driven.speed'].max():18.3f}   {tension:17.2f}")

print("\nload [N m]   speed loss [%]   power lost [W]")
for load in (0.5, 1.0, 2.0):
    steady = drive.with_({"pulley.driven.torque": -load}).steady()
    loss = steady["pulley"]["driven"]["speed_loss"]
    print(f"{load:10.1f}   {100 * loss:14.4f}   {steady['power_lost']:14.4f}")
