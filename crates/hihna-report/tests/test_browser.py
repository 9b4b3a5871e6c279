"""The report in a browser without network: no errors, no requests, the animation plays.

Needs pytest, playwright and a Chromium (`CHROMIUM` names another than /usr/bin/chromium); `HIHNA` is the program and
`SCREENSHOTS` a folder for pictures. The test command provides all of them.
"""

import os
import pathlib
import shutil
import subprocess

import pytest
from playwright.sync_api import sync_playwright

CHROMIUM = os.environ.get("CHROMIUM") or shutil.which("chromium") or "/usr/bin/chromium"
HIHNA = os.environ["HIHNA"]
EXAMPLES = pathlib.Path(__file__).parents[3] / "examples"

# Short runs, one of each kind of drive; names that would break a page that trusts them.
DRIVES = {
    "base": ["--set", "run.end_time=1.5"],
    "idler": [str(EXAMPLES / "back_side_idler.toml"), "--set", "run.end_time=0.2"],
    "plates": [str(EXAMPLES / "crowned_pulleys.toml"), "--set", "run.end_time=0.08", "--set", "run.frame_interval=0.002"],
    "names": ["--set", "run.end_time=0.05", "--set", "title=<script>document.title='taken'</script>"],
}


@pytest.fixture(scope="module")
def browser():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def reports(tmp_path_factory):
    folder = tmp_path_factory.mktemp("reports")
    for name, arguments in DRIVES.items():
        done = subprocess.run([HIHNA, "run", *arguments, "--report", "--quiet", "--out", str(folder / name)], check=False)
        assert done.returncode in (0, 1), name
    bare = [HIHNA, "run", "--set", "run.end_time=0.02", "--quiet", "--out", str(folder / "bare")]
    subprocess.run(bare, check=False)
    subprocess.run([HIHNA, "report", str(folder / "bare")], check=True)
    return folder


@pytest.fixture
def page(browser):
    context = browser.new_context(viewport={"width": 1280, "height": 900}, offline=True)
    page = context.new_page()
    page.troubles = []
    page.on("console", lambda message: page.troubles.append(message.text))
    page.on("pageerror", lambda error: page.troubles.append(str(error)))
    page.on("request", lambda request: page.troubles.append(request.url) if not request.url.startswith(("file:", "data:", "blob:")) else None)
    yield page
    context.close()


def open_report(page, folder):
    page.goto((folder / "report.html").as_uri())
    page.wait_for_selector("html[data-ready=true]")


def keep(page, name, **options):
    if folder := os.environ.get("SCREENSHOTS"):
        page.screenshot(path=pathlib.Path(folder) / f"{name}.png", **options)


@pytest.mark.parametrize("name", [*DRIVES, "bare"])
def test_the_page_is_quiet_and_whole(page, reports, name):
    open_report(page, reports / name)
    charts = page.locator(".chart")
    assert charts.count() >= 15
    assert page.locator(".chart .main-svg").count() >= charts.count(), "a chart is not drawn"
    assert page.locator("#animation").count() == (0 if name == "bare" else 1)
    assert page.locator(".hihna-drive .wrap").count() >= 2
    assert page.title() != "taken"
    keep(page, f"{name}-light", full_page=True)
    assert page.troubles == []


def test_every_axis_has_a_title_with_a_unit(page, reports):
    open_report(page, reports / "base")
    titles = page.eval_on_selector_all(".chart", "all => all.flatMap(c => [c.layout.xaxis.title.text, c.layout.yaxis.title.text])")
    assert len(titles) >= 30
    assert all("[" in title for title in titles)


def test_the_animation_plays_pauses_and_steps(page, reports):
    open_report(page, reports / "base")
    frame = lambda: int(page.input_value("#frame"))
    picture = lambda: page.evaluate("document.getElementById('stage').toDataURL()")
    last = frame()
    assert last >= 100
    page.select_option("#pace", "1")
    page.click("#play")
    page.wait_for_function(f"Number(document.getElementById('frame').value) < {last // 2}")
    page.wait_for_timeout(400)
    assert page.inner_text("#play") == "Pause"
    page.click("#play")
    stopped = frame()
    assert 0 < stopped < last
    page.wait_for_timeout(200)
    assert frame() == stopped
    before = picture()
    page.focus("#stage")
    page.keyboard.press("ArrowRight")
    assert frame() == stopped + 1
    assert picture() != before, "the belt or the pulleys move from frame to frame"
    page.keyboard.press("End")
    assert frame() == last
    plain = picture()
    page.select_option("#magnify", "50")
    assert picture() != plain, "the shape is magnified"
    page.locator("#animation").scroll_into_view_if_needed()
    keep(page, "magnified")
    page.keyboard.press("Home")
    assert page.troubles == []


def test_a_belt_of_plates_is_drawn_in_space(page, reports):
    open_report(page, reports / "plates")
    picture = lambda: page.evaluate("document.getElementById('stage').toDataURL()")
    page.locator("#animation").scroll_into_view_if_needed()
    keep(page, "plates")
    pictures = [picture()]
    # Colours of the tension are there: points that are neither grey nor blue-grey.
    coloured = page.evaluate(
        "(() => { const s = document.getElementById('stage'); const d = s.getContext('2d').getImageData(0, 0, s.width, s.height).data;"
        " let n = 0; for (let i = 0; i < d.length; i += 4) if (d[i + 3] && Math.max(d[i], d[i + 1], d[i + 2]) - Math.min(d[i], d[i + 1], d[i + 2]) > 60) n += 1;"
        " return n / (d.length / 4); })()"
    )
    assert 0.01 < coloured < 0.5
    page.focus("#stage")
    page.keyboard.press("Home")
    pictures.append(picture())
    page.keyboard.press("Shift+ArrowRight")
    pictures.append(picture())
    box = page.locator("#stage").bounding_box()
    page.mouse.move(box["x"] + 300, box["y"] + 200)
    page.mouse.down()
    page.mouse.move(box["x"] + 380, box["y"] + 240, steps=4)
    page.mouse.up()
    pictures.append(picture())
    keep(page, "plates-turned")
    page.select_option("#magnify", "10")
    pictures.append(picture())
    assert len(set(pictures)) == len(pictures), "frames, turns and magnification each change the picture"
    page.select_option("#magnify", "1")
    page.dblclick("#stage")
    assert picture() == pictures[1], "a double click turns it back"
    assert page.troubles == []


def test_dark_and_print(page, reports):
    open_report(page, reports / "base")
    page.click("#theme")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    dark = page.evaluate("getComputedStyle(document.body).backgroundColor")
    keep(page, "base-dark", full_page=True)
    paper = page.pdf(format="A4", print_background=True)
    assert page.evaluate("document.documentElement.dataset.theme") == "dark", "the screen is as before"
    if folder := os.environ.get("SCREENSHOTS"):
        (pathlib.Path(folder) / "base.pdf").write_bytes(paper)
    assert paper.startswith(b"%PDF")
    assert dark != "rgb(255, 255, 255)"
    assert page.troubles == []


def test_the_systems_dark_is_followed(browser, reports):
    context = browser.new_context(color_scheme="dark", offline=True)
    page = context.new_page()
    open_report(page, reports / "bare")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    context.close()


# Two fields: contours, with points that slip as a whole. One: lines.
MAPS = {
    "plane": ["--map", "pulley.driven.torque=-0.5:-12:5", "--map", "belt.length=1.26:1.272:4"],
    "line": ["--map", "pulley.driven.torque=-0.5:-12:8", "--map", "belt.width=0.01:0.01:1"],
}


@pytest.fixture(scope="module")
def maps(tmp_path_factory):
    folder = tmp_path_factory.mktemp("maps")
    for name, arguments in MAPS.items():
        place = str(folder / name)
        subprocess.run([HIHNA, "steady", "--model", "fe", *arguments, "--out", place], check=True, capture_output=True)
        subprocess.run([HIHNA, "report", place], check=True, capture_output=True)
    return folder


@pytest.mark.parametrize(("name", "kind", "axes"), [("plane", "contour", 2), ("line", "scatter", 1)])
def test_a_map_is_drawn(page, maps, name, kind, axes):
    open_report(page, maps / name)
    charts = page.eval_on_selector_all(
        ".chart",
        "all => all.map(c => ({kinds: c.data.map(d => d.type), names: c.data.map(d => d.name),"
        " texts: c.data.flatMap(d => d.hovertext ?? []), titles: [c.layout.xaxis.title.text, c.layout.yaxis.title.text]}))",
    )
    assert len(charts) >= 10
    assert all(chart["kinds"][0] == kind for chart in charts)
    assert all("[" in title for chart in charts for title in chart["titles"])
    assert charts[0]["titles"][0] == "pulley.driven.torque [N m]"
    slipping = [chart for chart in charts if "gross slip" in chart["names"]]
    assert slipping and "times what friction carries" in slipping[0]["texts"][0]
    captions = page.locator(".charts figcaption").all_inner_texts()
    assert captions[0].startswith("Load over what friction carries") and all("[" in caption for caption in captions)
    assert page.locator("#inputs tbody tr").count() >= axes + 2
    keep(page, f"map-{name}", full_page=True)
    page.click("#theme")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    keep(page, f"map-{name}-dark", full_page=True)
    assert page.troubles == []


def test_a_map_of_three_fields_is_refused(tmp_path):
    fields = ["pulley.driven.torque=-0.5:-1:2", "belt.length=1.26:1.27:2", "belt.width=0.01:0.02:2"]
    arguments = [word for field in fields for word in ("--map", field)]
    place = str(tmp_path / "space")
    subprocess.run([HIHNA, "steady", "--model", "fe", *arguments, "--out", place], check=True, capture_output=True)
    done = subprocess.run([HIHNA, "report", place], check=False, capture_output=True, text=True)
    assert done.returncode == 2 and "3 fields" in done.stderr


def test_a_campbell_diagram_is_drawn(page, tmp_path):
    place = str(tmp_path / "modes")
    arguments = ["--set", "pulley.driven.torque=-1", "--modes", "3", "--map", "pulley.driver.speed=6:12:3", "--out", place]
    subprocess.run([HIHNA, "steady", "--model", "fe", *arguments], check=True, capture_output=True)
    subprocess.run([HIHNA, "report", place], check=True, capture_output=True)
    open_report(page, tmp_path / "modes")
    curves = page.eval_on_selector_all(".chart", "all => all.map(c => c.data.map(d => d.name))")
    assert len(curves) >= 3 and curves[0] == ["mode 1", "mode 2", "mode 3"]
    titles = page.eval_on_selector_all(".chart", "all => all.flatMap(c => [c.layout.xaxis.title.text, c.layout.yaxis.title.text])")
    assert titles[:2] == ["pulley.driver.speed [rad/s]", "Natural frequency [Hz]"]
    keep(page, "campbell", full_page=True)
    assert page.troubles == []


def test_a_phone_needs_no_sideways_scrolling(browser, reports):
    """Tables and the drawing scroll within themselves; the page does not."""
    context = browser.new_context(viewport={"width": 390, "height": 800}, offline=True)
    page = context.new_page()
    for name in ("base", "plates"):
        open_report(page, reports / name)
        assert page.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    context.close()


def test_names_keep_clear_of_the_belt(page, reports):
    """The small pulleys of the serpentine are named beside, where no belt lies: no name crosses a span or an arc of its own."""
    open_report(page, reports / "idler")
    crossings = page.evaluate(
        """(() => {
          const box = (e) => e.getBoundingClientRect();
          const names = [...document.querySelectorAll('.hihna-drive text:not(.inside)')].filter((t) => !t.textContent.includes(' '));
          const hits = (name, line) => {
            const [b, steps] = [box(name), 400];
            const m = line.getScreenCTM();
            for (let k = 0; k <= steps; k++) {
              const p = line.getPointAtLength((line.getTotalLength() * k) / steps).matrixTransform(m);
              if (p.x > b.left && p.x < b.right && p.y > b.top && p.y < b.bottom) return true;
            }
            return false;
          };
          const belt = [...document.querySelectorAll('.hihna-drive .belt, .hihna-drive .wrap')];
          return { names: names.map((n) => n.textContent), hits: names.filter((n) => belt.some((l) => hits(n, l))).map((n) => n.textContent) };
        })()"""
    )
    assert "generator" in crossings["names"] and crossings["hits"] == []


def test_the_pictures_of_the_guide(browser, reports):
    """What docs/src/images keeps: with SCREENSHOTS=docs/src/images and `-k guide` it is made anew."""
    context = browser.new_context(viewport={"width": 1280, "height": 900}, device_scale_factor=0.75, offline=True)
    page = context.new_page()
    open_report(page, reports / "base")
    below = page.locator("#speeds").bounding_box()["y"] - 20
    picture = page.screenshot(full_page=True, clip={"x": 0, "y": 0, "width": 1280, "height": below})
    open_report(page, reports / "plates")
    page.locator("#stage").scroll_into_view_if_needed()
    plates = page.locator("#stage").screenshot()
    for name, image in (("report", picture), ("report_plates", plates)):
        # A blank page compresses to a few kilobytes.
        assert image.startswith(b"\x89PNG") and len(image) > 20_000
        if folder := os.environ.get("SCREENSHOTS"):
            (pathlib.Path(folder) / f"{name}.png").write_bytes(image)
    context.close()
