"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const colour = (name) => getComputedStyle(root).getPropertyValue(name).trim();

  // Charts: data come with the page, colours with its theme (Okabe and Ito's, apart for the colour-blind).
  const COLOURS = {
    light: ["#0072b2", "#d55e00", "#009e73", "#a8437f", "#8a6d00", "#3b3f45"],
    dark: ["#56b4e9", "#ff8c42", "#2fc89b", "#e79ac6", "#f0d04a", "#c9d1d9"],
  };
  const charts = [...document.querySelectorAll(".chart")];
  const themed = (layout) => {
    const axis = { gridcolor: colour("--line"), zerolinecolor: colour("--soft"), linecolor: colour("--line"), hoverformat: ".5~g", exponentformat: "power" };
    // Titles keep clear of long tick labels.
    const titled = (one) => ({ ...one, ...axis, title: { ...one?.title, standoff: 10 } });
    return {
      ...layout,
      paper_bgcolor: "rgba(0,0,0,0)",
      plot_bgcolor: "rgba(0,0,0,0)",
      colorway: COLOURS[root.dataset.theme],
      font: { family: "system-ui, sans-serif", size: 12, color: colour("--ink") },
      hoverlabel: { bgcolor: colour("--panel"), bordercolor: colour("--line"), font: { color: colour("--ink") } },
      height: undefined,
      autosize: true,
      xaxis: titled(layout.xaxis),
      yaxis: titled(layout.yaxis),
    };
  };
  const draw = () => {
    for (const chart of charts) {
      const plot = data.plots[Number(chart.dataset.plot)];
      Plotly.react(chart, plot.data, themed(plot.layout), { responsive: true, displaylogo: false, displayModeBar: false });
    }
  };

  // Theme: what the reader's system asks for, until the button is pressed; paper is always light.
  const button = document.getElementById("theme");
  const redraw = [draw];
  const setTheme = (theme) => {
    root.dataset.theme = theme;
    button.textContent = theme === "dark" ? "Light theme" : "Dark theme";
    for (const one of redraw) one();
  };
  const system = matchMedia("(prefers-color-scheme: dark)");
  let chosen = null;
  const wanted = () => chosen ?? (system.matches ? "dark" : "light");
  button.addEventListener("click", () => {
    chosen = root.dataset.theme === "dark" ? "light" : "dark";
    setTheme(chosen);
  });
  system.addEventListener("change", () => setTheme(wanted()));
  addEventListener("beforeprint", () => {
    setTheme("light");
    // Paper is narrower than the window, and the browser lays it out only after this.
    for (const chart of charts) {
      const alone = chart.closest(".charts").children.length === 1;
      Plotly.relayout(chart, { autosize: false, width: alone ? 680 : 330, height: 220, "font.size": 9, "xaxis.title.font.size": 9, "yaxis.title.font.size": 9 });
    }
  });
  addEventListener("afterprint", () => setTheme(wanted()));

  if (data.animation) redraw.push(animate(data.animation));
  setTheme(wanted());
  root.dataset.ready = "true";

  function animate(film) {
    const floats = (text) => {
      const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
      return new Float32Array(bytes.buffer);
    };
    const path = floats(film.path);
    const offset = floats(film.offset);
    const tension = floats(film.tension);
    const { times, points, pulleys, outline } = film;
    const [least, most] = film.range;
    const last = times.length - 1;
    const find = (id) => document.getElementById(id);
    const [stage, play, slider, clock, pace, magnify] = ["stage", "play", "frame", "clock", "pace", "magnify"].map(find);

    // Viridis (Smith and van der Walt): even steps to every eye, and in grey.
    const VIRIDIS = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 145, 140], [40, 174, 128], [94, 201, 98], [173, 220, 48], [253, 231, 37]];
    const rgb = (part) => {
      const at = Math.min(Math.max(part, 0), 1) * (VIRIDIS.length - 1);
      const i = Math.min(Math.floor(at), VIRIDIS.length - 2);
      const mix = VIRIDIS[i].map((a, k) => Math.round(a + (at - i) * (VIRIDIS[i + 1][k] - a)));
      return `rgb(${mix})`;
    };
    const SHADES = Array.from({ length: 65 }, (_, i) => rgb(i / 64));
    const shade = (value) => {
      const part = most > least ? (value - least) / (most - least) : 0.5;
      return SHADES[Number.isFinite(part) ? Math.round(64 * Math.min(Math.max(part, 0), 1)) : 0];
    };
    find("least").textContent = `${least.toPrecision(4)} N`;
    find("most").textContent = `${most.toPrecision(4)} N`;
    find("colours").style.background = `linear-gradient(90deg, ${VIRIDIS.map((c) => `rgb(${c})`)})`;

    // Pace: how much slower than the drive itself; at first the film takes about eight seconds.
    const length = times[last] - times[0];
    const paces = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
    const fitting = paces.reduce((best, p) => (Math.abs(Math.log(length * p / 8)) < Math.abs(Math.log(length * best / 8)) ? p : best));
    for (const p of paces.filter((p) => p <= 20 * fitting)) {
      pace.add(new Option(p === 1 ? "real time" : `${p} × slower`, p, p === fitting, p === fitting));
    }
    slider.max = last;

    let frame = last;
    let playing = null;
    const show = () => {
      slider.value = frame;
      const text = `t = ${times[frame].toFixed(length < 1 ? 4 : 3)} s`;
      clock.textContent = text;
      slider.setAttribute("aria-valuetext", text);
      paint();
    };

    // The drive fits the stage with room for a magnified belt.
    let low = [Infinity, Infinity];
    let high = [-Infinity, -Infinity];
    for (const [x, y] of outline) {
      low = [Math.min(low[0], x), Math.min(low[1], y)];
      high = [Math.max(high[0], x), Math.max(high[1], y)];
    }
    for (const p of pulleys) for (const k of [0, 1]) {
      low[k] = Math.min(low[k], p.center[k] - p.radius);
      high[k] = Math.max(high[k], p.center[k] + p.radius);
    }

    const inSpace = film.strip && spacePainter(film, { stage, path, tension, floats, shade, colour });
    const paint = () => {
      const ratio = devicePixelRatio || 1;
      const { clientWidth: width, clientHeight: height } = stage;
      stage.width = Math.round(width * ratio);
      stage.height = Math.round(height * ratio);
      const pen = stage.getContext("2d");
      pen.scale(ratio, ratio);
      if (inSpace) {
        inSpace.paint(pen, width, height, frame, Number(magnify.value));
        return;
      }
      const scale = 0.84 * Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
      const X = (x) => width / 2 + (x - (low[0] + high[0]) / 2) * scale;
      const Y = (y) => height / 2 - (y - (low[1] + high[1]) / 2) * scale;
      pen.lineCap = "round";
      pen.lineJoin = "round";
      pen.textAlign = "center";
      pen.font = "500 13px system-ui, sans-serif";

      const center = (p) => (p.centers ? p.centers[frame] : p.center);
      for (const p of pulleys) {
        const r = p.radius * scale;
        pen.save();
        pen.translate(X(center(p)[0]), Y(center(p)[1]));
        pen.beginPath();
        pen.arc(0, 0, r, 0, 2 * Math.PI);
        pen.fillStyle = colour("--pulley");
        pen.strokeStyle = colour("--soft");
        pen.lineWidth = 1;
        pen.fill();
        pen.stroke();
        pen.rotate(-p.angle[frame]);
        for (let k = 0; k < 5; k++) {
          pen.rotate(0.4 * Math.PI);
          pen.beginPath();
          pen.moveTo(0.16 * r, 0);
          pen.lineTo(0.86 * r, 0);
          pen.lineWidth = k === 4 ? Math.max(3, 0.06 * r) : 1;
          pen.stroke();
        }
        pen.restore();
      }

      const factor = Number(magnify.value);
      if (factor > 1) {
        pen.setLineDash([4, 5]);
        pen.lineWidth = 1;
        pen.strokeStyle = colour("--soft");
        pen.beginPath();
        for (const [x, y] of outline) pen.lineTo(X(x), Y(y));
        pen.closePath();
        pen.stroke();
        pen.setLineDash([]);
      }

      const at = (i) => {
        const j = 2 * (frame * points + (i % points));
        return [X(path[j] + factor * offset[j]), Y(path[j + 1] + factor * offset[j + 1])];
      };
      // A smooth curve through the points: Hermite's, with slopes by the neighbours.
      const places = Array.from({ length: points }, (_, i) => at(i));
      const near = (i) => places[(i + points) % points];
      const gap = ([a, b], [c, d]) => Math.hypot(c - a, d - b) || 1e-9;
      const slopes = places.map((p, i) => {
        const [before, after] = [near(i - 1), near(i + 1)];
        const way = gap(before, p) + gap(p, after);
        return [(after[0] - before[0]) / way, (after[1] - before[1]) / way];
      });
      const along = (i) => {
        const j = (i + 1) % points;
        const [p, q] = [places[i], places[j]];
        const third = gap(p, q) / 3;
        pen.bezierCurveTo(
          p[0] + third * slopes[i][0], p[1] + third * slopes[i][1],
          q[0] - third * slopes[j][0], q[1] - third * slopes[j][1], ...q);
      };
      // A dark edge keeps the bright end of the scale legible on paper, a light one the dark end at night.
      pen.beginPath();
      pen.moveTo(...places[0]);
      for (let i = 0; i < points; i++) along(i);
      pen.lineWidth = 8;
      pen.strokeStyle = colour("--ink");
      pen.stroke();
      pen.lineWidth = 5.5;
      for (let i = 0; i < points; i++) {
        pen.beginPath();
        pen.moveTo(...places[i]);
        along(i);
        pen.strokeStyle = shade(tension[frame * points + i]);
        pen.stroke();
      }

      pen.fillStyle = colour("--ink");
      for (const p of pulleys) {
        const r = p.radius * scale;
        const [x, y] = center(p);
        const inside = pen.measureText(p.name).width < 1.7 * r;
        if (inside) {
          // A plate behind the name keeps the spokes from striking it through.
          const half = pen.measureText(p.name).width / 2 + 5;
          pen.fillStyle = colour("--pulley");
          pen.fillRect(X(x) - half, Y(y) - 10, 2 * half, 20);
          pen.fillStyle = colour("--ink");
          pen.fillText(p.name, X(x), Y(y) + 4.5);
          continue;
        }
        // On the side where no belt lies, and legible on whatever is there.
        const [right, up] = p.free;
        pen.textAlign = right > 0.5 ? "left" : right < -0.5 ? "right" : "center";
        const at = [X(x) + (r + 10) * right, Y(y) - (r + 10) * up + 4.5 - 5 * up];
        pen.lineWidth = 4;
        pen.strokeStyle = colour("--page");
        pen.strokeText(p.name, ...at);
        pen.fillText(p.name, ...at);
        pen.textAlign = "center";
      }
    };

    const pause = () => {
      cancelAnimationFrame(playing);
      playing = null;
      play.textContent = "Play";
    };
    const start = () => {
      if (frame === last) frame = 0;
      let begin = null;
      let from = times[frame];
      const step = (now) => {
        begin ??= now;
        const time = from + (now - begin) / 1000 / Number(pace.value);
        while (frame < last && times[frame + 1] <= time) frame += 1;
        show();
        if (frame === last) pause();
        else playing = requestAnimationFrame(step);
      };
      pace.onchange = () => { begin = null; from = times[frame]; };
      play.textContent = "Pause";
      playing = requestAnimationFrame(step);
    };
    const toggle = () => (playing === null ? start() : pause());
    const go = (to) => {
      pause();
      frame = Math.min(Math.max(to, 0), last);
      show();
    };
    play.addEventListener("click", toggle);
    slider.addEventListener("input", () => go(Number(slider.value)));
    magnify.addEventListener("change", paint);
    addEventListener("resize", paint);
    if (inSpace) inSpace.turnBy(paint);
    stage.addEventListener("keydown", (event) => {
      if (event.shiftKey && inSpace) return;
      const moves = { " ": toggle, ArrowLeft: () => go(frame - 1), ArrowRight: () => go(frame + 1), Home: () => go(0), End: () => go(last) };
      const move = moves[event.key];
      if (!move) return;
      event.preventDefault();
      move();
    });
    return show;
  }
})();
