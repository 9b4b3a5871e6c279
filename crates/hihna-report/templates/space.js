"use strict";
// Paints a belt with a width and its pulleys in space, seen from far away. A belt lies on pulleys from outside, so what of it
// faces away from the eye is painted before them and the rest after them: no part of a pulley cuts through it.
const spacePainter = (film, { stage, path, tension, floats, shade, colour }) => {
  const { points, strip } = film;
  const sides = floats(strip.sides);
  const half = strip.half_width;
  const FACETS = 72;
  // A pulley is a little wider than its belt, in so many rings that a crown is round.
  const RINGS = 6;
  const reach = 1.25 * half;

  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const scaled = (a, s) => a.map((x) => s * x);
  const plus = (a, b) => a.map((x, i) => x + b[i]);
  const minus = (a, b) => a.map((x, i) => x - b[i]);
  const drums = strip.pulleys.map((drum, i) => {
    const { name, radius, angle } = film.pulleys[i];
    const sideways = cross([0, 1, 0], drum.axis);
    const across = scaled(sideways, 1 / Math.hypot(...sideways));
    return { ...drum, name, radius, angle, across, up: cross(drum.axis, across) };
  });
  const radial = (drum, angle) => plus(scaled(drum.across, Math.cos(angle)), scaled(drum.up, Math.sin(angle)));
  const surface = (drum, middle, along, angle, part = 1) => {
    const [slope, curvature] = drum.shape;
    const r = part * (drum.radius + along * (slope - 0.5 * curvature * along));
    return plus(middle, plus(scaled(drum.axis, along), scaled(radial(drum, angle), r)));
  };

  // Angles of the view: about the vertical of the screen, then about its horizontal.
  const REST = [-0.5, 0.35];
  let [yaw, pitch] = REST;
  // Right, up and towards the eye.
  const view = () => {
    const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
    return ([x, y, z]) => {
      const [right, towards] = [cy * x + sy * z, cy * z - sy * x];
      return [right, cp * y - sp * towards, sp * y + cp * towards];
    };
  };

  const paint = (pen, width, height, frame, factor) => {
    const turned = view();
    const [ink, soft, face] = ["--ink", "--soft", "--pulley"].map(colour);

    // The pulleys fit the stage, however they are turned.
    let low = [Infinity, Infinity];
    let high = [-Infinity, -Infinity];
    for (const drum of drums) for (const along of [-reach, reach]) for (let k = 0; k < 16; k++) {
      const corner = turned(surface(drum, drum.places[frame], along, (Math.PI * k) / 8));
      low = [0, 1].map((i) => Math.min(low[i], corner[i]));
      high = [0, 1].map((i) => Math.max(high[i], corner[i]));
    }
    const scale = 0.88 * Math.min(width / (high[0] - low[0]), height / (high[1] - low[1]));
    const place = (point) => {
      const [x, y] = turned(point);
      return [width / 2 + (x - (low[0] + high[0]) / 2) * scale, height / 2 - (y - (low[1] + high[1]) / 2) * scale];
    };
    const polygon = (corners, fill) => {
      pen.beginPath();
      for (const corner of corners) pen.lineTo(...place(corner));
      pen.closePath();
      pen.fillStyle = pen.strokeStyle = fill;
      pen.lineWidth = 0.7;
      pen.fill();
      // Without a line of the same colour the seams would show.
      pen.stroke();
    };
    const line = (corners, hue, thick) => {
      pen.beginPath();
      for (const corner of corners) pen.lineTo(...place(corner));
      pen.strokeStyle = hue;
      pen.lineWidth = thick;
      pen.stroke();
    };

    // The belt, piece by piece, on either side of the pulleys.
    const edges = Array.from({ length: points }, (_, i) => {
      const j = frame * points + i;
      return [-half, half].map((z, side) => {
        const k = 6 * j + 3 * side;
        return [path[2 * j] + factor * sides[k], path[2 * j + 1] + factor * sides[k + 1], z + factor * sides[k + 2]];
      });
    });
    const [behind, before] = [[], []];
    for (let i = 0; i < points; i++) {
      const [a, b] = [edges[i], edges[(i + 1) % points]];
      const middle = scaled(plus(plus(a[0], a[1]), plus(b[0], b[1])), 0.25);
      // Its normal, away from the pulley next to it.
      const gap = (drum) => {
        const arm = minus(middle, drum.places[frame]);
        return Math.hypot(...minus(arm, scaled(drum.axis, dot(arm, drum.axis)))) - drum.radius;
      };
      const next = drums.reduce((best, drum) => (gap(drum) < gap(best) ? drum : best));
      const normal = cross(minus(b[0], a[0]), minus(a[1], a[0]));
      const outwards = Math.sign(dot(normal, minus(middle, next.places[frame]))) || 1;
      const facing = outwards * turned(normal)[2] > 0;
      (facing ? before : behind).push({ a, b, depth: turned(middle)[2], hue: shade(tension[frame * points + i]) });
    }
    const paintBelt = (pieces) => {
      pieces.sort((p, q) => p.depth - q.depth);
      for (const { a, b, hue } of pieces) {
        polygon([a[0], b[0], b[1], a[1]], hue);
        for (const side of [0, 1]) line([a[side], b[side]], ink, 1);
      }
    };
    const paintDrum = (drum) => {
      const middle = drum.places[frame];
      const on = (along, angle, part) => surface(drum, middle, along, angle, part);
      const turn = (k) => drum.angle[frame] + (2 * Math.PI * k) / FACETS;
      const ring = (j) => reach * ((2 * j) / RINGS - 1);
      for (let k = 0; k < FACETS; k++) {
        if (turned(radial(drum, turn(k + 0.5)))[2] <= 0) continue;
        for (let j = 0; j < RINGS; j++) {
          const corners = [on(ring(j), turn(k)), on(ring(j + 1), turn(k)), on(ring(j + 1), turn(k + 1)), on(ring(j), turn(k + 1))];
          // Stripes show how it turns.
          polygon(corners, k % 12 === 0 ? soft : face);
        }
      }
      const near = Math.sign(turned(drum.axis)[2]) * reach || reach;
      const rims = [-reach, reach].map((along) => Array.from({ length: FACETS + 1 }, (_, k) => on(along, turn(k))));
      polygon(rims[near > 0 ? 1 : 0], face);
      for (let k = 0; k < 5; k++) {
        const angle = drum.angle[frame] + 0.4 * Math.PI * k;
        line([on(near, angle, 0.16), on(near, angle, 0.86)], soft, k === 4 ? 4 : 1);
      }
      line(rims[near > 0 ? 1 : 0], soft, 1);
      const far = rims[near > 0 ? 0 : 1];
      const faces = (k) => turned(radial(drum, turn(k + 0.5)))[2] > 0;
      for (let k = 0; k < FACETS; k++) {
        if (faces(k)) line([far[k], far[k + 1]], soft, 1);
        // Where the surface turns away its outline joins the rims.
        if (faces(k) !== faces(k + 1)) line(Array.from({ length: RINGS + 1 }, (_, j) => on(ring(j), turn(k + 1))), soft, 1);
      }
    };
    pen.lineJoin = "round";
    paintBelt(behind);
    const depth = (drum) => turned(drum.places[frame])[2];
    for (const drum of [...drums].sort((a, b) => depth(a) - depth(b))) paintDrum(drum);
    paintBelt(before);

    pen.font = "500 13px system-ui, sans-serif";
    pen.textAlign = "center";
    for (const drum of drums) {
      const near = Math.sign(turned(drum.axis)[2]) * reach || reach;
      const [x, y] = place(plus(drum.places[frame], scaled(drum.axis, near)));
      const wide = pen.measureText(drum.name).width / 2 + 5;
      pen.fillStyle = face;
      pen.fillRect(x - wide, y - 10, 2 * wide, 20);
      pen.fillStyle = ink;
      pen.fillText(drum.name, x, y + 4.5);
    }
  };

  // Turned by dragging, or by the arrow keys with Shift; a double click turns it back.
  const turnBy = (repaint) => {
    const turn = (across, upwards) => {
      yaw += across;
      pitch = Math.min(Math.max(pitch + upwards, -Math.PI / 2), Math.PI / 2);
      repaint();
    };
    stage.style.cursor = "grab";
    stage.style.touchAction = "none";
    stage.addEventListener("pointerdown", (event) => stage.setPointerCapture(event.pointerId));
    stage.addEventListener("pointermove", (event) => {
      if (event.buttons & 1) turn(event.movementX / 200, event.movementY / 200);
    });
    stage.addEventListener("dblclick", () => {
      [yaw, pitch] = REST;
      repaint();
    });
    stage.addEventListener("keydown", (event) => {
      const turns = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] };
      const way = event.shiftKey && turns[event.key];
      if (!way) return;
      event.preventDefault();
      turn(...way);
    });
  };
  return { paint, turnBy };
};
