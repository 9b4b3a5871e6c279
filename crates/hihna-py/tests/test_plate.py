"""Plates from Python: closed forms, and the errors of wrong ones."""

import math

import numpy
import pytest
from hihna import StructureError, ancf

STEEL = ancf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0)
THICKNESS = 0.01
RIGIDITY = STEEL.youngs_modulus * THICKNESS**3 / (12 * (1 - 0.3**2))


def square(elements, **more):
    return ancf.Plate(1.0, 1.0, THICKNESS, (elements, elements), STEEL, **more)


def test_a_supported_square_bends_as_navier_says():
    """0.00406235 p a⁴/D in the middle (Timoshenko & Woinowsky-Krieger, table 8), under a pressure that bends it by 2e-4 of
    its thickness: membrane forces take a part of the square of that. The element converges with its length squared."""
    pressure = 10.0
    exact = 0.00406235 * pressure / RIGIDITY
    errors = []
    for elements in (4, 8, 16):
        bent = square(elements).support().bending_only().pressure(pressure).equilibrium()
        assert bent.positions.shape == (elements + 1, elements + 1, 3) and bent.iterations >= 1
        errors.append(abs(bent.positions[elements // 2, elements // 2, 2] / exact - 1))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15) and errors[1] / errors[2] == pytest.approx(4.0, rel=0.1)


def test_a_strip_under_an_end_moment_is_an_arc():
    """Without Poisson's ratio curvature M/D: 1 m of it turned by a tenth of a radian ends at the chord of the arc."""
    soft = ancf.Material(youngs_modulus=2e11, poisson_ratio=0.0, density=7800.0)
    rigidity = soft.youngs_modulus * THICKNESS**3 / 12
    strip = ancf.Plate(1.0, 0.1, THICKNESS, (16, 1), soft).clamp("start").end_moment(0.1 * rigidity)
    tip = strip.equilibrium().positions[-1]
    # The moment is dead in its slopes, and the element's angle is of second order: a percent at sixteen elements.
    numpy.testing.assert_allclose(tip[:, 2], (1 - math.cos(0.1)) / 0.1, rtol=0.01)


def test_frequencies_of_a_supported_square():
    """Mode (m, n) has pi² (m² + n²)/a² sqrt(D / rho h)."""
    modes = square(8).support().bending_only().modes()
    unit = math.pi**2 * math.sqrt(RIGIDITY / (STEEL.density * THICKNESS))
    assert modes.frequencies[0] == pytest.approx(2 * unit, rel=0.02)
    assert modes.frequencies[1:3] == pytest.approx([5 * unit] * 2, rel=0.04)
    assert modes.shapes.shape[1:] == (9, 9, 3) and len(modes.growths) == len(modes.frequencies)
    # The middle moves most.
    assert numpy.unravel_index(numpy.abs(modes.shapes[0, :, :, 2]).argmax(), (9, 9)) == (4, 4)


def test_mistakes_are_told():
    with pytest.raises(StructureError):
        square(2).pressure(1.0).equilibrium()
    with pytest.raises(StructureError):
        square(2).clamp().force((7, 0), (0.0, 0.0, 1.0)).equilibrium()
    with pytest.raises(StructureError):
        square(0)
    with pytest.raises(StructureError):
        ancf.Plate(1.0, -1.0, 0.01, (2, 2), STEEL)
    with pytest.raises(ValueError, match="start, end, right and left"):
        square(2).clamp("top")
    with pytest.raises(ValueError, match="bending"):
        square(2, bending="odd")
    other = square(2).clamp().equilibrium()
    with pytest.raises(StructureError, match="another structure"):
        square(3).clamp().modes(other)


def test_reactions_carry_the_load():
    """Slope forces of a clamped edge have no part in the sum of forces; what the supports carry is the load."""
    bent = square(4).clamp("start").force((4, 2), (0.0, 0.0, -50.0)).equilibrium()
    numpy.testing.assert_allclose(bent.reactions[0].sum(axis=0), [0.0, 0.0, 50.0], atol=1e-6)
    # Free nodes feel what Newton's method leaves over.
    numpy.testing.assert_allclose(bent.reactions[1:-1], 0.0, atol=1e-5)


def test_membrane_forces():
    """A strip pulled along x by its nodes' shares, 100 N on a width of a metre: n_xx = 100 N/m by equilibrium of every
    cross-section, on average over the width, whatever the clamp does to its neighbourhood."""
    plate = square(8).clamp("start")
    for j in range(9):
        plate.force((8, j), (100.0 * (0.5 if j in (0, 8) else 1.0) / 8, 0.0, 0.0))
    forces = plate.membrane_forces(plate.equilibrium())
    assert forces.shape == (8, 8, 3)
    # The middle of an element is not the mean over it; halves of elements apart the field is smooth.
    numpy.testing.assert_allclose(forces[2:-1, :, 0].mean(axis=1), 100.0, rtol=0.01)
    assert numpy.abs(forces[4:6, :, 1:]).max() < 5.0


def test_a_plate_swings_about_its_equilibrium():
    """Let go from the shape of its first mode, scaled to a hundredth of the thickness, a supported square comes back after a
    period of that mode: a cosine. Steps of a hundredth of the period are off by the scheme's (omega h)²/12, 3e-4 of the
    phase; at the cosine's crest that is second order."""
    plate = square(4).support().bending_only()
    modes = plate.modes()
    period = 2 * math.pi / modes.frequencies[0]
    bent = plate.pressure(1.0).equilibrium()
    film = square(4).support().bending_only().integrate(period, period / 100, start=bent, interval=period / 4)
    middle = film.positions[:, 2, 2, 2]
    # Pressure bends the plate nearly as its first mode moves it: the others hold a few parts in a hundred.
    numpy.testing.assert_allclose(middle / middle[0], [1.0, 0.0, -1.0, 0.0, 1.0], atol=0.06)
    assert film.vectors.shape == (5, 5, 5, 3, 3) and film.velocities.shape == (5, 5, 5, 3)
    # What generalized-alpha takes of the higher modes in a hundred steps, by the strain energy at the start.
    assert abs(film.energy[-1] / film.energy[0] - 1) < 0.05
