"""Natural frequencies of a beam spun about its root: turning makes it stiffer."""

from hihna import ancf

aluminium = ancf.Material(youngs_modulus=6.895e10, poisson_ratio=0.0, density=2766.67)
section = ancf.Section.rectangle(1.986e-3, 3.675e-2)
print("speed [rad/s]   first frequencies [rad/s]")
for speed in (0.0, 2.0, 4.0):
    beam = ancf.Beam(length=8.0, elements=8, section=section, material=aluminium)
    beam.clamp(0).rotating_frame(speed)
    modes = beam.modes(beam.equilibrium())
    print(f"{speed:13.1f}  ", "   ".join(f"{frequency:7.3f}" for frequency in modes.frequencies[:3]))
