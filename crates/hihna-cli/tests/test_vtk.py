"""`hihna run --vtk` read back by VTK itself: the same belt as in frames.csv, and pulleys that turn.

Needs pytest, numpy and vtk; `HIHNA` is the program.
"""

import csv
import os
import pathlib
import subprocess
import xml.etree.ElementTree as tree

import numpy
import pytest
import vtk
from vtk.util.numpy_support import vtk_to_numpy


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("vtk") / "result"
    sets = ["run.end_time=0.3", "run.frame_interval=0.05", "run.frame_start=0.1"]
    arguments = [argument for item in sets for argument in ("--set", item)]
    subprocess.run([os.environ["HIHNA"], "run", *arguments, "--vtk", "--quiet", "--out", str(folder)], check=True)
    return folder


def read(path):
    reader = vtk.vtkXMLUnstructuredGridReader()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *_: errors.append("error"))
    reader.SetFileName(str(path))
    reader.Update()
    assert not errors
    grid = reader.GetOutput()
    data = grid.GetPointData()
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    fields = {name: vtk_to_numpy(data.GetArray(name)) for name in names}
    return vtk_to_numpy(grid.GetPoints().GetData()), fields, grid


def collection(folder):
    sets = tree.parse(folder / "belt.pvd").getroot().iter("DataSet")
    return [(float(s.get("timestep")), int(s.get("part")), s.get("file")) for s in sets]


def test_the_collection_names_every_file_once(folder):
    entries = collection(folder)
    times = [0.1, 0.15, 0.2, 0.25, 0.3]
    assert [time for time, part, _ in entries if part == 0] == pytest.approx(times)
    assert [time for time, part, _ in entries if part == 1] == pytest.approx(times)
    files = {path.name for path in pathlib.Path(folder).glob("*.vtu")}
    assert {file for *_, file in entries} == files


def test_the_belt_is_that_of_the_frames(folder):
    with open(folder / "frames.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for time, part, file in collection(folder):
        if part != 0:
            continue
        points, fields, grid = read(folder / file)
        frame = [row for row in rows if float(row["time"]) == time]
        assert len(frame) * 2 == len(points) and grid.GetNumberOfCells() == len(frame)
        # Both edges of the ribbon, half the belt's width to each side.
        for side, edge in ((0, -0.005), (1, 0.005)):
            expected = [[float(row["x"]), float(row["y"]), edge] for row in frame]
            numpy.testing.assert_array_equal(points[side::2], expected)
            for name in ("tension", "strain_green", "speed", "normal_force", "friction_force", "slip_speed"):
                numpy.testing.assert_array_equal(fields[name][side::2], [float(row[name]) for row in frame])
        stored = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
        assert stored == time


def test_the_ribbon_is_closed_and_as_long_as_the_belt(folder):
    _, _, file = collection(folder)[0]
    _, _, grid = read(folder / file)
    area = vtk.vtkCellSizeFilter()
    area.SetInputData(grid)
    area.Update()
    total = vtk_to_numpy(area.GetOutput().GetCellData().GetArray("Area")).sum()
    # 1.2763 m of path and 10 mm of width; chords between integration points cut the arcs by less than 1 %.
    assert total == pytest.approx(1.2763 * 0.010, rel=0.01)
    # Every point belongs to two quads: the loop is closed.
    connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
    assert set(numpy.bincount(connectivity)) == {2}


def test_the_pulleys_turn(folder):
    with open(folder / "history.csv", newline="") as file:
        history = {round(float(row["time"]), 6): row for row in csv.DictReader(file)}
    centers = {0: (-0.191441, 0.0), 1: (0.191441, 0.0)}
    names = {0: "driver", 1: "driven"}
    for time, part, file in collection(folder):
        if part != 1:
            continue
        points, fields, _ = read(folder / file)
        row = history[round(time, 6)]
        for pulley, name in names.items():
            mine = fields["pulley"] == pulley
            arm = points[mine][:, :2] - centers[pulley]
            rim = numpy.hypot(*arm.T) > 0.01
            numpy.testing.assert_allclose(numpy.hypot(*arm[rim].T), 0.08125, rtol=1e-12)
            turned = numpy.arctan2(arm[rim][:, 1], arm[rim][:, 0]) - fields["material_angle"][mine][rim]
            angle = float(row[f"{name}.angle"])
            numpy.testing.assert_allclose(numpy.exp(1j * turned), numpy.exp(1j * angle), atol=1e-9)
            assert fields["speed"][mine][0] == pytest.approx(float(row[f"{name}.speed"]), rel=1e-9)


@pytest.mark.parametrize("edge", [0, 1])
def test_a_belt_of_plates_has_its_edges(tmp_path, edge):
    """The line that the profile shows may be an edge: then frames.csv and edges.csv have the same points."""
    example = pathlib.Path(__file__).parents[3] / "examples" / "crowned_pulleys.toml"
    sets = ["run.end_time=0.02", "run.frame_interval=0.01", f"run.profile_line={edge}"]
    arguments = [argument for item in sets for argument in ("--set", item)]
    folder = tmp_path / "result"
    command = [os.environ["HIHNA"], "run", str(example), *arguments, "--vtk", "--quiet", "--out", str(folder)]
    assert subprocess.run(command, check=False).returncode in (0, 1)
    with open(folder / "frames.csv", newline="") as file:
        frames = list(csv.DictReader(file))
    with open(folder / "edges.csv", newline="") as file:
        edges = list(csv.DictReader(file))
    assert len(frames) == len(edges) > 0
    for name in ("time", "material_coordinate"):
        assert [row[name] for row in frames] == [row[name] for row in edges]
    line = numpy.array([[float(row[axis]) for axis in "xyz"] for row in frames])
    both = numpy.array([[[float(row[f"{axis}{side}"]) for axis in "xyz"] for side in (0, 1)] for row in edges])
    # The same sums of the same shape functions.
    numpy.testing.assert_allclose(both[:, edge], line, rtol=0, atol=1e-15)
    # Between free edges a belt keeps sqrt(1 - nu (f^2 - 1)) of its 40 mm. Mounted with f = 1.02 it is taut everywhere and
    # nowhere twice as tight, so each width lies between those of f = 1 and f = 1.04.
    width = numpy.linalg.norm(both[:, 1] - both[:, 0], axis=1)
    assert 0.04 * numpy.sqrt(1 - 0.3 * (1.04**2 - 1)) < width.min() < width.max() < 0.04
    points, _, _ = read(folder / "belt_00002.vtu")
    numpy.testing.assert_allclose(points.reshape(-1, 2, 3), both[-len(points) // 2 :], rtol=0, atol=1e-15)


@pytest.mark.parametrize("example", ["v_belt", "crowned_pulleys"])
def test_belts_in_space_have_all_fields_and_pulleys(tmp_path, example):
    """Tension, strain, speed, contact force and slip of every point, numbers that differ along the belt where it is pressed on
    pulleys; the pulleys beside it as the second part."""
    file = pathlib.Path(__file__).parents[3] / "examples" / f"{example}.toml"
    sets = ["run.end_time=0.01", "run.output_interval=0.005", "run.frame_interval=0.005"]
    arguments = [argument for item in sets for argument in ("--set", item)]
    folder = tmp_path / "result"
    subprocess.run([os.environ["HIHNA"], "run", str(file), *arguments, "--vtk", "--quiet", "--out", str(folder)], check=True)
    entries = collection(folder)
    assert [part for _, part, _ in entries] == [0, 1] * 3
    points, belt, grid = read(folder / entries[-2][2])
    assert grid.GetNumberOfCells() * 2 == len(points)
    for name in ("tension", "element_tension", "strain_engineering", "speed", "normal_force", "friction_force", "slip_speed"):
        assert belt[name].shape == (len(points),) and numpy.isfinite(belt[name]).all() and numpy.ptp(belt[name]) > 0, name
    # Half of the belt or more lies on two pulleys; spans are free.
    pressed = belt["normal_force"] > 0
    assert 0.2 < pressed.mean() < 0.9
    assert (belt["slip_speed"][~pressed] == 0).all()
    places, pulleys, _ = read(folder / entries[-1][2])
    assert set(pulleys["pulley"]) == {0, 1} and {"angle", "speed", "torque", "material_angle"} <= set(pulleys)
    assert numpy.ptp(places[:, 2]) > 0, "pulleys have a width"
