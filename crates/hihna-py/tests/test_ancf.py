"""Structures from Python: closed forms, and the errors of wrong ones."""

import math

import numpy
import pytest
from hihna import StructureError, ancf

STEEL = ancf.Material(youngs_modulus=2.07e11, poisson_ratio=0.3, density=7850.0)
SQUARE = ancf.Section.rectangle(0.1, 0.1)


def cantilever(elements=16, element="linear-beam", section=SQUARE, material=STEEL, **more):
    return ancf.Beam(2.0, elements, section, material, element=element, **more).clamp(0)


@pytest.mark.parametrize("element", ["linear-beam", "belt-beam"])
def test_a_cantilever_bends_as_timoshenko_says(element):
    """Tip deflection P L³ / 3 E I + P L / k G A of small loads; second order in the element's length."""
    stiffness = STEEL.youngs_modulus * SQUARE.second_moment
    shear = 5 / 6 * STEEL.youngs_modulus / 2.6 * SQUARE.area
    exact = 1000 * (2.0**3 / (3 * stiffness) + 2.0 / shear)
    errors = []
    for elements in (4, 8, 16):
        beam = cantilever(elements, element)
        bent = beam.force(beam.last, (0.0, -1000.0)).equilibrium()
        errors.append(abs(-bent.positions[-1, 1] / exact - 1))
        numpy.testing.assert_allclose(bent.reactions.sum(axis=0), [0.0, 1000.0], atol=1e-6)
    # Large rotations and the section's curvature take parts of the order of the deflection squared, 1e-6.
    assert errors[-1] < max(errors[0] / 12, 2e-3)
    assert errors[-1] < 2e-3


def test_supports_chain_and_forces_balance():
    beam = ancf.Beam(2.0, 8, SQUARE, STEEL)
    bent = beam.pin(0).roller(beam.last, (0.0, 1.0)).line_load((0.0, -500.0)).equilibrium()
    numpy.testing.assert_allclose(bent.reactions[[0, -1], 1], [500.0, 500.0], rtol=1e-5)
    assert bent.positions.shape == (9, 2) and bent.iterations >= 1


def test_frequencies_of_a_slender_cantilever():
    """(1.8751 / L)² sqrt(E I / rho A), Euler and Bernoulli's; 100 times longer than thick, shear takes 1e-4 of it."""
    thin = ancf.Section.rectangle(0.02, 0.02)
    modes = cantilever(32, section=thin).modes()
    exact = (1.8751041 / 2.0) ** 2 * math.sqrt(STEEL.youngs_modulus * thin.second_moment / (STEEL.density * thin.area))
    assert modes.frequencies[0] == pytest.approx(exact, rel=2e-3)
    assert numpy.all(numpy.diff(modes.frequencies) >= 0)
    # The tip moves most, across the beam.
    assert abs(modes.shapes[0, :, 1]).argmax() == 32
    assert numpy.abs(modes.growths).max() < 1e-6 * modes.frequencies.max()


def test_a_falling_pendulum_keeps_its_energy():
    rubber = ancf.Material(youngs_modulus=2.07e7, poisson_ratio=0.0, density=7850.0)
    beam = ancf.Beam(2.0, 4, SQUARE, rubber).pin(0).gravity((0.0, -9.81))
    film = beam.integrate(0.5, 2e-4, method="runge-kutta", interval=0.05)
    assert film.time == pytest.approx(numpy.linspace(0, 0.5, 11))
    assert film.positions.shape == film.velocities.shape == (11, 5, 2)
    # Against what fell: m g L / 2 = 1540 J.
    assert numpy.abs(film.energy - film.energy[0]).max() < 1e-5 * 1540
    numpy.testing.assert_allclose(film.positions[:, 0], 0.0, atol=1e-12)


def test_a_motion_by_a_python_function():
    """A user's spin-up and the built-in one give the same motion."""
    aluminium = ancf.Material(6.895e10, 0.0, 2766.67)
    section = ancf.Section.rectangle(1.986e-3, 3.675e-2)
    speed, rise = 4.0, 15.0

    def angle(t):
        rate = 2 * math.pi / rise
        return (
            speed / rise * (t * t / 2 + (math.cos(rate * t) - 1) / rate**2),
            speed / rise * (t - math.sin(rate * t) / rate),
            speed / rise * (1 - math.cos(rate * t)),
        )

    films = []
    for drive in (lambda b: b.turn(0, angle), lambda b: b.spin_up(0, speed, rise)):
        beam = drive(ancf.Beam(8.0, 3, section, aluminium))
        films.append(beam.integrate(0.5, 5e-3, interval=0.1))
    numpy.testing.assert_allclose(films[0].positions, films[1].positions, atol=1e-9)


def test_an_error_in_a_function_is_told():
    def angle(t):
        raise LookupError("no such angle")

    beam = ancf.Beam(2.0, 2, SQUARE, STEEL).turn(0, angle)
    with pytest.raises(LookupError, match="no such angle"):
        beam.integrate(0.1, 1e-3)
    with pytest.raises(LookupError, match="no such angle"):
        beam.equilibrium()


def test_what_is_wrong_is_told():
    with pytest.raises(StructureError, match="nothing holds"):
        ancf.Beam(2.0, 2, SQUARE, STEEL).force(1, (1.0, 0.0)).equilibrium()
    with pytest.raises(StructureError, match="there is no node 9"):
        ancf.Beam(2.0, 2, SQUARE, STEEL).clamp(9).equilibrium()
    with pytest.raises(StructureError, match="at least one"):
        ancf.Beam(2.0, 0, SQUARE, STEEL)
    with pytest.raises(ValueError, match="linear-beam"):
        ancf.Beam(2.0, 2, SQUARE, STEEL, element="beam")
    with pytest.raises(ValueError, match="belt-beam"):
        ancf.Beam(2.0, 2, SQUARE, STEEL, bending_factor=0.01)
    with pytest.raises(OverflowError):
        ancf.Beam(2.0, 2, SQUARE, STEEL).pin(-1)


def test_a_rigid_body_at_the_tip():
    """A mass fastened to a massless-like cantilever: omega² = 3 E I / (m L³), Rayleigh's 33/140 of the beam added."""
    thin = ancf.Section.rectangle(0.02, 0.02)
    beam = cantilever(16, section=thin)
    mass = 1000.0
    body = beam.body("weight", mass, 1e-3, (2.0, 0.0))
    found = beam.fasten(beam.last, body).modes().frequencies[0]
    own = STEEL.density * thin.area * 2.0
    exact = math.sqrt(3 * STEEL.youngs_modulus * thin.second_moment / ((mass + 33 / 140 * own) * 2.0**3))
    assert found == pytest.approx(exact, rel=3e-3)


def test_a_curved_beam_is_free_of_stress_as_drawn():
    """A quarter of a circle of cubic beams, clamped at one end and pulled at the other along the root's tangent: E I u / F R³ =
    pi/4 along the force for a thin curved beam (Castigliano), stretch and shear take parts of (h / R)², 4e-4. Coarse meshes
    lock, the error falls with more than the square of the element's length."""
    radius, height = 1.0, 0.02
    section = ancf.Section.rectangle(0.02, height)
    # Without Poisson's ratio: a fully parametrised beam locks its sections' breathing against bending.
    metal = ancf.Material(2.07e11, 0.0, 7850.0)
    # At the angle a the force has the lever R cos a about a section: u = F R³ / E I times the integral of cos² a.
    exact = math.pi / 4 * radius**3 / (metal.youngs_modulus * section.second_moment)
    errors = []
    for count in (16, 32, 64):
        angle = 0.5 * math.pi * numpy.arange(count + 1) / count
        inward = numpy.stack([-numpy.cos(angle), -numpy.sin(angle)], axis=1)
        along = numpy.stack([-numpy.sin(angle), numpy.cos(angle)], axis=1)
        nodes = numpy.stack([-radius * inward, along, inward], axis=1)
        beam = ancf.Beam(0.5 * math.pi * radius, count, section, metal, element="cubic-beam", nodes=nodes).clamp(0)
        numpy.testing.assert_allclose(beam.equilibrium().positions, nodes[:, 0], atol=1e-12)
        moved = beam.force(beam.last, (0.0, 1.0)).linear_displacements()[-1, 0]
        errors.append(abs(moved[1] / exact - 1))
    assert errors[0] / errors[1] > 4 and errors[1] / errors[2] > 4
    assert errors[-1] < (height / radius) ** 2


def test_rigid_bodies_and_slopes_are_told():
    """A weight fastened to the tip goes where the tip goes and turns as its section turns."""
    beam = cantilever(8, "belt-beam")
    body = beam.body("weight", 10.0, 1.0, (2.0, 0.0))
    bent = beam.fasten(beam.last, body).body_load(body, (0.0, -2e4)).equilibrium()
    assert bent.vectors.shape == (9, 3, 2) and bent.bodies.shape == (1, 3)
    numpy.testing.assert_allclose(bent.bodies[0, :2], bent.positions[-1], atol=1e-9)
    across = bent.vectors[-1, 2]
    assert bent.bodies[0, 2] == pytest.approx(math.atan2(-across[0], across[1]), abs=1e-9) and bent.bodies[0, 2] < -0.001
    film = beam.integrate(1e-3, 1e-4, start=bent)
    numpy.testing.assert_allclose(film.bodies[-1], bent.bodies, atol=1e-6)
    moving = cantilever(2)
    moving.fasten(2, moving.body("weight", 10.0, 1.0, (2.0, 0.0)))
    swing = moving.prescribe_body(0, 1, lambda t: (-0.01 * t * t, -0.02 * t, -0.02)).integrate(0.01, 1e-3)
    assert swing.bodies[-1, 0, 1] == pytest.approx(-1e-6) and swing.body_rates[-1, 0, 1] == pytest.approx(-2e-4)


def test_steps_are_chosen_by_the_error():
    """With an error tolerance the step is the longest: fewer than the fixed ones, and the same end."""
    rubber = ancf.Material(youngs_modulus=2.07e7, poisson_ratio=0.0, density=7850.0)
    beam = ancf.Beam(2.0, 4, SQUARE, rubber).pin(0).gravity((0.0, -9.81))
    fine = beam.integrate(0.3, 1e-4, method="generalized-alpha", interval=0.3)
    chosen = beam.integrate(0.3, 1e-2, method="generalized-alpha", interval=0.3, error_tolerance=1e-3)
    assert 10 < chosen.steps < fine.steps
    # Errors of 1e-3 m/s over 0.3 s.
    numpy.testing.assert_allclose(chosen.positions[-1], fine.positions[-1], atol=3e-4)


def test_arrays_are_not_copied():
    """Nodes, bodies and rates are views of what the solver wrote, which Python owns."""
    film = cantilever(2).integrate(1e-3, 1e-4)
    for view in (film.vectors, film.positions):
        assert numpy.shares_memory(view, film.coordinates)
    for view in (film.rates, film.velocities):
        assert numpy.shares_memory(view, film.coordinate_rates)
    bent = cantilever(2).force(2, (0.0, -1.0)).equilibrium()
    assert numpy.shares_memory(bent.positions, bent.coordinates)


@pytest.mark.parametrize("element", ["linear-beam", "belt-beam", "cubic-beam"])
def test_axial_forces(element):
    """A hanging bar carries what hangs below the middle of each element: its displacement is quadratic, which cubic lines have
    exactly and linear ones in the middle. Pinned, as a clamp would hold the strain of the first node at zero. Strains are
    1e-6, and without Poisson's ratio a fully parametrised section does not resist being drawn thin."""
    metal = ancf.Material(2.07e11, 0.0, 7850.0)
    bar = ancf.Beam(2.0, 4, SQUARE, metal, element=element, angle=-math.pi / 2).pin(0).roller(4, (1.0, 0.0))
    bar.gravity((0.0, -9.81)).force(4, (0.0, -500.0))
    bent = bar.equilibrium()
    below = 2.0 - 0.5 * (numpy.arange(4) + 0.5)
    weight = 7850.0 * SQUARE.area * 9.81
    numpy.testing.assert_allclose(bar.axial_forces(bent), 500.0 + weight * below, rtol=1e-5)
    numpy.testing.assert_allclose(bar.axial_forces(bar.drawn()), 0.0, atol=1e-6)
    with pytest.raises(StructureError, match="another structure"):
        bar.axial_forces(numpy.zeros(3))
