"""Beams in space from Python: closed forms, the planar beams in the plane, and the errors of wrong ones."""

import math
import signal
import threading
import time

import numpy
import pytest
from hihna import StructureError, ancf

STEEL = ancf.Material(youngs_modulus=2.07e11, poisson_ratio=0.3, density=7850.0)
STRIP = ancf.SpatialSection.rectangle(0.04, 0.1)
#: A beam askew: its length, height and width.
ASKEW = ((math.cos(0.7), math.sin(0.7), 0.0), (0.0, 0.0, 1.0), (math.sin(0.7), -math.cos(0.7), 0.0))
SHEAR = STEEL.youngs_modulus / 2.6


def cantilever(elements=4, section=STRIP, **more):
    return ancf.SpaceBeam(1.0, elements, section, STEEL, **more).clamp_section(0)


def test_sections():
    """A rectangle's closed moments; a slim trapezoid with upright flanks is a rectangle; a tube's J is its polar moment."""
    assert STRIP.area == pytest.approx(0.004) and STRIP.second_moment_y == pytest.approx(0.04 * 0.1**3 / 12)
    upright = ancf.SpatialSection.trapezoid(0.04, 0.1, 0.0)
    for name in ("area", "second_moment_y", "second_moment_z", "fourth_moment_z", "mixed_fourth_moment"):
        assert getattr(upright, name) == pytest.approx(getattr(STRIP, name), rel=1e-12)
    tube = ancf.SpatialSection.tube(0.02, 0.015)
    assert tube.torsion_constant == pytest.approx(tube.second_moment_y + tube.second_moment_z)
    assert ancf.SpatialSection.circle(0.02).area == pytest.approx(math.pi * 0.02**2)
    with pytest.raises(StructureError, match="flanks"):
        ancf.SpatialSection.trapezoid(0.01, 0.1, 1.0)


@pytest.mark.parametrize(("axis", "moment"), [(1, STRIP.second_moment_y), (2, STRIP.second_moment_z)])
def test_a_cantilever_askew_bends_as_timoshenko_says(axis, moment):
    """F L³ / 3 E I + F L / ks G A of linear theory, of which belt beams are exact; rounding by a condition of 1e6."""
    exact = 1 / (3 * STEEL.youngs_modulus * moment) + 1 / (5 / 6 * SHEAR * STRIP.area)
    beam = cantilever(3, axes=ASKEW, start=(0.1, -0.2, 0.3))
    moved = beam.force(beam.last, ASKEW[axis]).linear_displacements()
    assert moved.shape == (4, 4, 3)
    assert moved[-1, 0] @ numpy.array(ASKEW[axis]) == pytest.approx(exact, rel=1e-9)
    # A tip that bends by w is drawn back by about 3 w²/5 L along the beam, of which linear theory knows nothing.
    bent = beam.equilibrium()
    drawn = beam.drawn().reshape(4, 4, 3)
    numpy.testing.assert_allclose(bent.positions[-1] - drawn[-1, 0], moved[-1, 0], rtol=0, atol=exact**2)
    numpy.testing.assert_allclose(bent.reactions.sum(axis=0), -numpy.array(ASKEW[axis]), atol=1e-6)


@pytest.mark.parametrize("element", ["belt-beam-3d", "linear-beam-3d"])
def test_moments_turn_the_tip(element):
    """A twist of M L / G J with Saint-Venant's factor; a bend of M L / E I about either axis: constant along the beam, so any
    number of elements has it. Rounding."""
    more = {"element": element, "torsion_factor": STRIP.saint_venant_torsion_factor}
    length, height, width = ASKEW
    bending = [STEEL.youngs_modulus * moment for moment in (STRIP.second_moment_z, STRIP.second_moment_y)]
    stiffness = [SHEAR * STRIP.torsion_constant, *bending]
    for axis, resists in zip(ASKEW, stiffness):
        beam = cantilever(3, axes=ASKEW, **more)
        slopes = beam.moment(beam.last, axis).linear_displacements()[-1]
        turned = numpy.cross(axis, width if axis is not width else height)
        slope = slopes[-1] if axis is not width else slopes[-2]
        # A fibre s turned by a small angle about the axis moves by angle x s.
        assert slope @ turned == pytest.approx(1 / resists, rel=1e-9)


def test_axial_forces():
    """A bar askew pulled along itself by a kilonewton has it everywhere; strains are 1e-6."""
    beam = cantilever(3, axes=ASKEW)
    bent = beam.force(3, 1000.0 * numpy.array(ASKEW[0])).equilibrium()
    numpy.testing.assert_allclose(beam.axial_forces(bent), 1000.0, rtol=1e-5)


def test_far_bent_in_the_plane_it_is_the_planar_beam():
    """The same energy: what Newton's method leaves over, 1e-9 of the length, is all that differs. In one step of load and in
    ten."""
    load, elements = 3.0e6, 8
    planar = ancf.Beam(1.0, elements, ancf.Section.rectangle(0.04, 0.1), STEEL).clamp(0)
    flat = planar.force(elements, (0.0, -load)).equilibrium()
    beam = ancf.SpaceBeam(1.0, elements, STRIP, STEEL, element="linear-beam-3d").clamp(0)
    beam.force(elements, (0.0, -load, 0.0))
    for steps in (1, 10):
        bent = beam.equilibrium(load_steps=steps)
        assert len(bent.corrections) >= steps and bent.iterations == sum(map(len, bent.corrections))
        assert bent.positions[-1, 1] < -0.3, "bent far"
        numpy.testing.assert_allclose(bent.positions[:, :2], flat.positions, atol=1e-8)
        numpy.testing.assert_allclose(bent.positions[:, 2], 0.0, atol=1e-12)


def test_frequencies_in_both_planes():
    """(1.8751 / L)² sqrt(E I / rho A) of Euler and Bernoulli: 100 times longer than high, shear and rotation take 3e-4."""
    section = ancf.SpatialSection.rectangle(0.006, 0.01)
    modes = cantilever(8, section).modes()
    for moment in (section.second_moment_z, section.second_moment_y):
        exact = 1.8751041**2 * math.sqrt(STEEL.youngs_modulus * moment / (STEEL.density * section.area))
        assert numpy.abs(modes.frequencies / exact - 1).min() < 3e-4
    assert modes.shapes.shape == (len(modes.frequencies), 9, 3)
    assert numpy.abs(modes.imaginary_shapes).max() == 0.0, "nothing gyroscopic"


def test_a_beam_let_go_keeps_its_energy():
    """Bent by a force and let go, it starts from that equilibrium: its strain energy turns into motion and back. The explicit
    scheme has the error of its fourth order, (omega h)⁴ of the fastest motion over many steps: 1e-5 of the energy."""
    soft = ancf.Material(2.07e8, 0.3, 7850.0)
    bent = ancf.SpaceBeam(1.0, 2, STRIP, soft).clamp(0).force(2, (0.0, -40.0, 30.0)).equilibrium()
    beam = ancf.SpaceBeam(1.0, 2, STRIP, soft).clamp(0)
    film = beam.integrate(0.05, 5e-6, method="runge-kutta", start=bent, interval=0.005)
    assert film.time == pytest.approx(numpy.linspace(0, 0.05, 11)) and film.steps >= 10000
    numpy.testing.assert_allclose(film.positions[0], bent.positions, atol=1e-12)
    assert film.energy[0] > 0.1
    assert numpy.abs(film.energy / film.energy[0] - 1).max() < 1e-5
    # The force pulled down and to the side; the tip swings back both ways.
    assert film.positions[-1, -1, 1] > film.positions[0, -1, 1] and film.positions[-1, -1, 2] < film.positions[0, -1, 2]
    # A motion goes on from where it was: the same as one without a stop.
    half = beam.integrate(0.025, 5e-6, method="runge-kutta", start=bent, interval=0.025)
    rest = beam.integrate(
        0.025, 5e-6, method="runge-kutta", start=half.coordinates[-1], velocities=half.coordinate_rates[-1], interval=0.025
    )
    numpy.testing.assert_allclose(rest.positions[-1], film.positions[-1], atol=1e-10)


def test_a_support_moves_by_a_function():
    """A beam whose root is moved sideways, slowly beside its lowest frequency of 20 rad/s, follows as a whole."""
    def sideways(time):
        return 0.01 * (1 - math.cos(time)), 0.01 * math.sin(time), 0.01 * math.cos(time)

    beam = ancf.SpaceBeam(1.0, 2, STRIP, STEEL)
    for vector in ("height", "width"):
        for axis in range(3):
            beam.fix(0, vector, axis)
    beam.fix(0, "position", 0).fix(0, "position", 1).prescribe(0, 2, sideways)
    film = beam.integrate(0.5, 1e-3, interval=0.1)
    expected = 0.01 * (1 - numpy.cos(film.time))
    numpy.testing.assert_allclose(film.positions[:, 0, 2], expected, atol=1e-14)
    # The lowest frequency of this steel beam is 200 rad/s: the tip lags by the acceleration over its square, 2.5e-7 m, twice.
    numpy.testing.assert_allclose(film.positions[:, -1, 2], expected, atol=1e-6)


def test_a_ring_is_closed_by_its_nodes():
    """A ring of belt beams drawn as a circle: bent from straight, its strain energy is E I / 2 R² of the length and its
    curvature is uniform, so it is at rest but for what rounding and the mesh leave. The first node comes again as the last."""
    radius, count = 0.5, 24
    section = ancf.SpatialSection.rectangle(0.02, 0.005)
    angle = 2 * math.pi * numpy.arange(count + 1) / count
    outward = numpy.stack([numpy.cos(angle), numpy.sin(angle), 0 * angle], axis=1)
    along = numpy.stack([-numpy.sin(angle), numpy.cos(angle), 0 * angle], axis=1)
    axis = numpy.tile([0.0, 0.0, 1.0], (count + 1, 1))
    nodes = numpy.stack([radius * outward, along, -outward, axis], axis=1)
    # Ends that meet exactly, whatever sine makes of a full turn.
    nodes[-1] = nodes[0]
    ring = ancf.SpaceBeam(2 * math.pi * radius, count, section, STEEL, nodes=nodes).join_ends().clamp(0)
    rest = ring.equilibrium()
    assert rest.positions.shape == (count + 1, 3)
    numpy.testing.assert_array_equal(rest.positions[0], rest.positions[-1])
    # 24 cubic pieces differ from the circle by (2 pi / 24)⁴ / 384 of the radius, 1e-5.
    numpy.testing.assert_allclose(numpy.linalg.norm(rest.positions, axis=1), radius, rtol=1e-4)
    film = ring.integrate(1e-4, 1e-4)
    bending = STEEL.youngs_modulus * section.second_moment_y / (2 * radius**2) * 2 * math.pi * radius
    # Green's strain over the height and the pieces: parts of (h / R)² and of 1e-4.
    assert film.energy[0] == pytest.approx(bending, rel=1e-3)


def test_what_is_wrong_is_told():
    with pytest.raises(StructureError, match="free"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL).force(1, (1.0, 0.0, 0.0)).equilibrium()
    with pytest.raises(StructureError, match="there is no node 9"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL).clamp(9).equilibrium()
    with pytest.raises(StructureError, match="at least one"):
        ancf.SpaceBeam(1.0, 0, STRIP, STEEL)
    with pytest.raises(StructureError, match="numbers"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL, nodes=numpy.zeros((3, 3, 3)))
    with pytest.raises(StructureError, match="no slope along"):
        beam = ancf.SpaceBeam(1.0, 2, STRIP, STEEL, element="linear-beam-3d").clamp(0)
        beam.force(1, (1, 0, 0), vector="along").equilibrium()
    with pytest.raises(StructureError, match="axes"):
        cantilever().fix(0, "height", 3)
    with pytest.raises(ValueError, match="height and width"):
        cantilever().force(1, (0, 0, 1), vector="across")
    with pytest.raises(ValueError, match="right angles"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL, axes=((1, 0, 0), (1, 1, 0), (0, 0, 1)))
    with pytest.raises(ValueError, match="linear-beam-3d"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL, element="beam")
    with pytest.raises(ValueError, match="belt-beam-3d"):
        ancf.SpaceBeam(1.0, 2, STRIP, STEEL, element="linear-beam-3d", bending_factor=0.1)
    with pytest.raises(ValueError, match="load_steps"):
        cantilever().equilibrium(load_steps=0)
    beam = cantilever()
    with pytest.raises(StructureError, match="another structure"):
        beam.modes(cantilever(2).equilibrium())
    with pytest.raises(StructureError, match="another structure"):
        beam.integrate(0.1, 0.1, start=numpy.zeros(5))
    with pytest.raises(StructureError, match="breaks the constraint"):
        beam.integrate(0.1, 0.1, start=beam.drawn() + 0.1)
    with pytest.raises(ValueError, match="positive"):
        beam.integrate(0.1, -0.1)


def long_motion():
    return ancf.SpaceBeam(1.0, 8, STRIP, STEEL).clamp(0).gravity((0.0, -9.81, 0.0))


def test_other_threads_run_and_ctrl_c_stops():
    """A motion of minutes is interrupted after a fifth of a second, in which a thread beside it has run."""
    ticks, done = [], threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.monotonic())

    other = threading.Thread(target=tick)
    other.start()
    threading.Timer(0.2, signal.pthread_kill, (threading.main_thread().ident, signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        long_motion().integrate(1e3, 1e-4, interval=1.0)
    done.set()
    other.join()
    assert len(ticks) > 2, "the interpreter was locked during the motion"
