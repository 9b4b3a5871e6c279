"""A blade in space, clamped at its root: how far it bends and twists under loads, and how it swings afterwards."""

import numpy
from hihna import ancf

steel = ancf.Material(youngs_modulus=2.07e11, poisson_ratio=0.3, density=7850.0)
section = ancf.SpatialSection.rectangle(width=0.002, height=0.02)


def blade():
    return ancf.SpaceBeam(
        0.5, 8, section, steel, torsion_factor=section.saint_venant_torsion_factor
    ).clamp_section(0)


print("moment [N m]   twist [deg]   tip sideways [mm]")
for moment in (0.0, 0.5, 1.0):
    loaded = blade().moment(8, (moment, 0.0, 0.0)).force(8, (0.0, 0.0, 0.5))
    bent = loaded.equilibrium(load_steps=2)
    height = bent.vectors[8, 2]
    twist = numpy.degrees(numpy.arctan2(height[2], height[1]))
    print(f"{moment:12.1f}   {twist:11.2f}   {1000 * bent.positions[8, 2]:17.2f}")

lowest = blade().modes().frequencies[0]
film = blade().integrate(2 * numpy.pi / lowest, 0.01 / lowest, start=bent)
middle = len(film.time) // 2
tip = 1000 * film.positions[middle, 8, 2]
print(f"let go, after half a period of {lowest:.1f} rad/s the tip is at {tip:.2f} mm sideways")
