"""Drives and results from Python: the same numbers as the program, errors that name the field."""

import pathlib
import signal
import threading
import time

import hihna
import numpy
import pytest

EXAMPLES = pathlib.Path(__file__).parents[3] / "examples"
SHORT = {"run.end_time": 0.1, "belt.elements": 12}


@pytest.fixture(scope="module")
def drive():
    return hihna.Drive.built_in().with_(SHORT)


@pytest.fixture(scope="module")
def results(drive):
    return drive.with_(run__frame_interval=0.05).run()


def test_the_built_in_drive_is_the_example():
    assert hihna.Drive.built_in().to_dict() == hihna.Drive.load(EXAMPLES / "two_pulley.toml").to_dict()


def test_a_dictionary_and_its_text_are_the_same_drive(drive):
    assert hihna.Drive.from_dict(drive.to_dict()).to_toml() == drive.to_toml()
    assert hihna.Drive.from_toml(drive.to_toml()).to_dict() == drive.to_dict()


def test_fields_are_replaced_in_a_copy(drive):
    other = drive.with_({"pulley.driven.inertia": "0.2 kg m2", "belt.width": numpy.float64(0.02)}, belt__elements=15)
    fields = other.to_dict()
    assert fields["pulley"][1]["inertia"] == 0.2
    assert (fields["belt"]["width"], fields["belt"]["elements"]) == (0.02, 15)
    assert drive.to_dict()["belt"]["elements"] == 12


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda d: d.with_(belt__elements=-1), "belt.elements"),
        (lambda d: d.with_(belt__elemnts=30), "belt.elemnts"),
        (lambda d: d.with_({"pulley.driven.radius": "3 kg"}), "pulley.driven.radius"),
        (lambda d: hihna.Drive.from_dict({**d.to_dict(), "belt": {}}), "belt"),
    ],
)
def test_errors_name_the_field(drive, make, field):
    with pytest.raises(hihna.InputError) as caught:
        make(drive)
    assert caught.value.field.startswith(field), caught.value.errors
    assert caught.value.errors[0]["message"]
    assert isinstance(caught.value, ValueError)


def test_errors_without_a_field_say_so_and_runs_name_theirs():
    with pytest.raises(hihna.InputError, match="finite") as caught:
        hihna.Drive.built_in().with_(belt__width=float("nan"))
    assert caught.value.field is None and len(caught.value.errors) == 0
    with pytest.raises(hihna.InputError, match="at rest at time zero") as caught:
        hihna.Drive.built_in().with_({"run.start": "steady"}).run()
    assert caught.value.field.startswith("pulley") or caught.value.field == "run.start"


def test_other_mistakes_are_exceptions_too(drive, tmp_path):
    with pytest.raises(hihna.InputError):
        hihna.Drive.load(tmp_path / "nowhere.toml")
    with pytest.raises(hihna.ReadError):
        hihna.Results.load(tmp_path)
    with pytest.raises(ValueError, match="capstan"):
        drive.steady(model="odd")
    with pytest.raises(ValueError, match="None"):
        drive.with_(belt__elements=None)
    with pytest.raises(TypeError):
        drive.with_(belt__elements=object())


def test_columns_are_views_of_one_table(results):
    speed = results["driver.speed"]
    assert speed.dtype == numpy.float64 and speed.shape == results.time.shape == (101,)
    assert numpy.shares_memory(speed, results.history)
    assert not speed.flags.writeable
    # The driver's ramp: 12 rad/s within 0.55 s from 0.05 s on.
    ramp = 12 / 0.55 * numpy.clip(results.time - 0.05, 0, None)
    numpy.testing.assert_allclose(speed, ramp, atol=1e-12)
    with pytest.raises(KeyError, match=r"driver\.speed"):
        results["driver.sped"]
    assert "driver.speed" in results and "driver.sped" not in results


def test_data_frames(results):
    pandas = pytest.importorskip("pandas")
    history = results.to_pandas()
    assert isinstance(history, pandas.DataFrame) and history.index.name == "time"
    numpy.testing.assert_array_equal(history["driven.speed"], results["driven.speed"])
    frames = results.to_pandas("frames")
    assert sorted(frames["time"].unique()) == pytest.approx([0.0, 0.05, 0.1])
    assert set(results.to_pandas("profile")["pulley"]) == {"", "driver", "driven"}
    assert results.to_pandas("edges").empty, "a belt in the plane has none"
    with pytest.raises(ValueError, match="history, profile, frames and edges"):
        results.to_pandas("edge")


def test_a_folder_is_written_and_read(results, tmp_path):
    folder = tmp_path / "result"
    results.save(folder, vtk=True, report=True)
    assert {"drive.toml", "history.csv", "belt.pvd", "report.html"} <= {path.name for path in folder.iterdir()}
    with pytest.raises(FileExistsError):
        results.save(folder)
    results.save(folder, overwrite=True)
    again = hihna.Results.load(folder)
    numpy.testing.assert_array_equal(again.history, results.history)
    assert again.summary == results.summary
    assert again.drive.to_dict() == results.drive.to_dict()
    with pytest.raises(ValueError, match="copy"):
        again.save(tmp_path / "other")


def test_a_belt_of_plates_has_edges():
    short = {"run.end_time": 0.002, "run.output_interval": 1e-3, "run.frame_interval": 1e-3}
    drive = hihna.Drive.load(EXAMPLES / "crowned_pulleys.toml", **short)
    results = drive.run()
    edges, frames = results.edges, results.frames
    numpy.testing.assert_array_equal(edges["material_coordinate"], frames["material_coordinate"])
    # The frames show the middle line: half-way between the edges but for the plate's curvature across.
    middle = 0.5 * (edges["z0"] + edges["z1"])
    width = drive.to_dict()["belt"]["width"]
    numpy.testing.assert_allclose(middle, frames["z"], atol=1e-2 * width)
    assert (edges["z1"] - edges["z0"]).min() > 0.9 * width


def test_steady_running_agrees_with_theory():
    drive = hihna.Drive.load(EXAMPLES / "string_model_2.toml")
    found = drive.steady()
    assert found["answer"] == "running"
    power = found["power_in"] - found["power_out"] - found["power_lost"]
    assert abs(power) < 1e-9 * abs(found["power_in"])


def test_rich_display(drive, results):
    assert drive._repr_html_().count("<svg") == 1
    page = results._repr_html_()
    assert page.count("<svg") == 1 and page.count("<table") == 3 and "driven" in page
    nasty = drive.with_(title="<script>")
    assert "<script>" not in nasty._repr_html_()
    assert "built_in" not in repr(drive) and "driver" in repr(drive)


def test_functions_become_tables():
    ramp = hihna.profile(lambda t: 12.0 * min(t / 0.05, 1.0), 0.0, 0.05, 2)
    fan = hihna.load(lambda w: -0.01 * w * abs(w), 0.0, 20.0, 201)
    drive = hihna.Drive.built_in().with_(SHORT).with_({"pulley.driver.speed": ramp, "pulley.driven.load": fan})
    results = drive.run()
    expected = 12 * numpy.clip(results.time / 0.05, 0, 1)
    numpy.testing.assert_allclose(results["driver.speed"], expected, atol=1e-12)
    # Between points 0.1 rad/s apart the chord of 0.01 w² is off by at most 0.01 * 0.1² / 4.
    speed = results["driven.speed"]
    numpy.testing.assert_allclose(results["driven.external_torque"][speed > 0], -0.01 * speed[speed > 0] ** 2, atol=2.6e-5)


def test_progress_is_told_and_other_threads_run():
    told, ticks = [], []
    done = threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.monotonic())

    other = threading.Thread(target=tick)
    other.start()
    hihna.Drive.built_in().with_(belt__elements=60).run(lambda at, end: told.append((at, end)))
    done.set()
    other.join()
    assert told and all(0 <= at <= end == 1.5 for at, end in told)
    assert len(ticks) > 2, "the interpreter was locked during the run"


def test_an_error_in_progress_stops_the_run():
    def fail(at, end):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        hihna.Drive.built_in().with_({"run.end_time": 100.0}).run(fail)


def test_ctrl_c_stops_a_run():
    main = threading.main_thread().ident
    threading.Timer(0.3, signal.pthread_kill, (main, signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        hihna.Drive.built_in().with_({"run.end_time": 1000.0}).run()
