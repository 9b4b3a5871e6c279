"""Materials of structures."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """An isotropic, linear elastic material: Young's modulus [Pa], Poisson's ratio [-], density [kg/m³]."""

    youngs_modulus: float
    poisson_ratio: float
    density: float
