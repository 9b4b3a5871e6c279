"""Structures of absolute nodal coordinates: beams in the plane and in space, thin plates; statics, modes, motion.

>>> from hihna import ancf
>>> steel = ancf.Material(youngs_modulus=2.07e11, poisson_ratio=0.3, density=7850.0)
>>> beam = ancf.Beam(length=2.0, elements=8, section=ancf.Section.rectangle(0.1, 0.1), material=steel)
>>> bent = beam.clamp(0).force(beam.last, (0.0, -1000.0)).equilibrium()
>>> bool(abs(bent.positions[-1, 1] + 1.55e-3) < 2e-5)    # P L³ / 3 E I = 1.546 mm, and shear
True

Nodes are numbered from 0 along the beam. Everything is in SI units and global axes.
"""

from .beam import Beam
from .material import Material
from .plate import Plate
from .section import Section, SpatialSection
from .space_beam import SpaceBeam
from .structure import Equilibrium, Film, Modes, Motion, Structure

__all__ = [
    "Beam",
    "Equilibrium",
    "Film",
    "Material",
    "Modes",
    "Motion",
    "Plate",
    "Section",
    "SpaceBeam",
    "SpatialSection",
    "Structure",
]
