"""Friction and loads as Python functions: the same drive as the library's laws, errors that name the law."""

import hihna
import numpy
import pytest

RAMP = {"kind": "ramp", "from": 0.0, "to": 6.0, "start": 0.0, "end": 0.05}
# Equal steps, so that runs differ by no more than what Newton's method leaves over.
SHORT = {"run.end_time": 0.05, "run.step": 1e-4, "belt.elements": 12, "pulley.driver.speed": RAMP}
COULOMB = {"law": "coulomb", "coefficient": 0.6, "velocity": 0.1}


@pytest.fixture(scope="module")
def drive():
    return hihna.Drive.built_in().with_(SHORT)


def coulomb(slip, normal):
    part = max(-1.0, min(slip / 0.1, 1.0))
    return 0.6 * normal * part


def coulomb_with_derivatives(slip, normal):
    sticks = abs(slip) < 0.1
    part = slip / 0.1 if sticks else numpy.sign(slip)
    return 0.6 * normal * part, 6.0 * normal if sticks else 0.0, 0.6 * part


@pytest.mark.parametrize("law", [coulomb, coulomb_with_derivatives])
def test_a_function_is_a_friction_law(drive, law):
    own = drive.with_({"contact.friction": COULOMB}).run()
    stated = drive.run(friction={"driver": law, "driven": law})
    # Newton's method leaves at most 2e-7 of the nominal speed over in a step.
    steps = max(results.summary["solver"]["steps"] for results in (own, stated))
    numpy.testing.assert_allclose(stated["driven.speed"], own["driven.speed"], rtol=0, atol=2e-7 * 6.0 * steps)
    assert numpy.abs(own["driven.speed"]).max() > 0.01, "the driven pulley is moved by friction"
    told = "\n".join(stated.summary["warnings"])
    assert "friction on pulley `driven`" in told and "drive file" in told
    assert stated.summary["stated_friction"] == ["driven", "driver"]
    assert "class=\"slip\"" in own.svg() and "class=\"slip\"" not in stated.svg(), "the drive does not know this slip"


def test_a_function_is_a_load(drive):
    times = []

    def fan(time, speed):
        times.append(time)
        return -0.5 * speed * abs(speed)

    own = drive.with_({"pulley.driven.load": {"law": "fan", "torque": 0.5, "speed": 1.0}}).run()
    for law in (fan, lambda time, speed: (-0.5 * speed * abs(speed), -abs(speed))):
        stated = drive.run(load={"driven": law})
        steps = max(results.summary["solver"]["steps"] for results in (own, stated))
        numpy.testing.assert_allclose(stated["driven.speed"], own["driven.speed"], rtol=0, atol=2e-7 * 6.0 * steps)
        speed = stated["driven.speed"]
        numpy.testing.assert_allclose(stated["driven.external_torque"], -0.5 * speed * abs(speed), rtol=1e-12)
    assert 0.0 < max(times) <= 0.05


def test_what_a_function_raises_names_the_law(drive):
    def wrong(slip, normal):
        return 1 / 0

    with pytest.raises(hihna.RunError, match="friction law of pulley `driven` raised ZeroDivisionError") as caught:
        drive.run(friction={"driven": wrong})
    assert isinstance(caught.value.__cause__, ZeroDivisionError)
    with pytest.raises(hihna.RunError, match="load of pulley `driven` raised ValueError: it gave NaN at"):
        drive.run(load={"driven": lambda time, speed: float("nan")})
    with pytest.raises(hihna.RunError, match="raised TypeError"):
        drive.run(friction={"driven": lambda slip, normal: "much"})

    def late(time, speed):
        if time > 0.01:
            raise KeyError("late")
        return 0.0

    with pytest.raises(hihna.RunError, match="KeyError"):
        drive.run(load={"driven": late})

    def interrupted(slip, normal):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        drive.run(friction={"driven": interrupted})


def test_laws_without_a_place_are_told(drive):
    with pytest.raises(ValueError, match="dirven.*driver, driven"):
        drive.run(friction={"dirven": coulomb})
    with pytest.raises(ValueError, match="prescribed"):
        drive.run(load={"driver": lambda time, speed: 0.0})
    with pytest.raises(TypeError, match="not a function"):
        drive.run(load={"driven": 3.0})


def test_steady_running_of_finite_elements():
    drive = hihna.Drive.built_in().with_({"pulley.driven.torque": -1.0, "belt.elements": 40})
    found = drive.steady(model="fe")
    assert found["answer"] == "running" and found["model"]["theory"] == "finite-elements"
    steady = found["steady"]
    assert steady["pulley"]["driven"]["external_torque"] == pytest.approx(-1.0, rel=1e-9)
    assert found["audit"]["power_residual"] < 1e-3
    # Beyond what friction carries: the torque that the capacity promises, and a tenth more.
    limit = found["capacity"]["factor"]
    assert drive.with_({"pulley.driven.torque": -1.1 * limit}).steady(model="fe")["answer"] == "gross-slip"
    with pytest.raises(ValueError, match="closure"):
        drive.steady(model="fe", closure="tension-sum")
    with pytest.raises(hihna.InputError) as caught:
        hihna.Drive.built_in().with_({"pulley.driver.speed": 0.0}).steady(model="fe")
    assert caught.value.field
