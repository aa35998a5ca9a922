"use strict";
// Plays the motions of a page on canvases: drag to turn, button and slider for time.
function hull(points) {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (list) => {
    const kept = [];
    for (const p of list) {
      while (kept.length > 1) {
        const [a, b] = kept.slice(-2);
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        kept.pop();
      }
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return chain(sorted).concat(chain(sorted.slice().reverse()));
}
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
function placed(pose, v) {
  const q = [pose[4], pose[5], pose[6]], w = pose[3];
  const t = cross(q, v).map((x) => 2 * x), u = cross(q, t);
  return [0, 1, 2].map((k) => pose[k] + v[k] + w * t[k] + u[k]);
}
function poseAt(body, frame) { return body.fixed ? body.p[0] : body.p[frame]; }
// Directions of the picture: right, up, and away from the eye; turned about up, then tilted.
function axesOf(data, turn, tilt) {
  const away = cross(data.up, data.right);
  const mix = (a, b, angle) => a.map((x, k) => x * Math.cos(angle) + b[k] * Math.sin(angle));
  const right = mix(data.right, away, turn), flat = mix(away, data.right, -turn);
  return { right, up: mix(data.up, flat, tilt), away: mix(flat, data.up, -tilt) };
}
// What of the motion must be seen: all that can move, in every frame, and a cavity or cell around it.
function roomOf(data) {
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const body of data.bodies) {
    const size = Math.max(...body.v.map((v) => Math.hypot(...v)));
    for (const pose of body.fixed && body.c !== "none" ? [] : body.p) {
      if (!pose) continue;
      low = low.map((x, k) => Math.min(x, pose[k] - size));
      high = high.map((x, k) => Math.max(x, pose[k] + size));
    }
  }
  for (const end of data.cell.flat()) {
    low = low.map((x, k) => Math.min(x, end[k]));
    high = high.map((x, k) => Math.max(x, end[k]));
  }
  return { centre: low.map((x, k) => (x + high[k]) / 2), half: Math.hypot(...low.map((x, k) => high[k] - x)) / 2 };
}
function outlines(data, frame, axes) {
  return data.bodies
    .map((body) => ({ body, pose: poseAt(body, frame) }))
    .filter((one) => one.pose)
    .sort((a, b) => dot(b.pose, axes.away) - dot(a.pose, axes.away))
    .map(({ body, pose }) => ({
      colour: body.c,
      points: hull(body.v.map((v) => placed(pose, v)).map((p) => [dot(p, axes.right), dot(p, axes.up)])),
    }));
}
function player(box) {
  const data = JSON.parse(box.querySelector("script").textContent);
  const canvas = box.querySelector("canvas"), button = box.querySelector("button");
  const slider = box.querySelector("input"), clock = box.querySelector("output");
  const context = canvas.getContext("2d"), room = roomOf(data);
  const last = data.t.length - 1, length = data.t[last] - data.t[0];
  let turn = 0, tilt = 0, frame = last, began = null;
  box.querySelector("img")?.remove();
  box.querySelector(".controls").hidden = canvas.hidden = false;
  slider.max = String(last);
  const draw = () => {
    const axes = axesOf(data, turn, tilt), { width, height } = canvas;
    const scale = Math.min(width, height) / (2.1 * room.half);
    const middle = [dot(room.centre, axes.right), dot(room.centre, axes.up)];
    const at = (p) => [width / 2 + (p[0] - middle[0]) * scale, height / 2 - (p[1] - middle[1]) * scale];
    const path = (points) => {
      context.beginPath();
      points.forEach((p, k) => context[k ? "lineTo" : "moveTo"](...at(p)));
    };
    context.clearRect(0, 0, width, height);
    context.strokeStyle = "#666";
    for (const [point, level] of data.grounds) {
      const long = 4 * room.half;
      const ends = [-long, long].map((s) => point.map((x, k) => x + s * level[k]));
      path(ends.map((p) => [dot(p, axes.right), dot(p, axes.up)]));
      context.stroke();
    }
    context.setLineDash([2, 3]);
    for (const edge of data.cell) {
      path(edge.map((p) => [dot(p, axes.right), dot(p, axes.up)]));
      context.stroke();
    }
    context.setLineDash([]);
    context.strokeStyle = "#222";
    for (const one of outlines(data, frame, axes)) {
      path(one.points);
      context.closePath();
      if (one.colour !== "none") {
        context.fillStyle = one.colour;
        context.fill();
      }
      context.stroke();
    }
    slider.value = String(frame);
    clock.textContent = data.t[frame].toFixed(3) + " s";
  };
  // As fast as it happens, but for what is shorter than a second or longer than ten.
  const seconds = Math.min(Math.max(length, 1), 10);
  const step = (now) => {
    if (began === null) return;
    const time = data.t[0] + (((now - began) / 1000 / seconds) % 1) * length;
    while (frame < last && data.t[frame + 1] <= time) frame += 1;
    if (data.t[frame] > time) frame = 0;
    draw();
    requestAnimationFrame(step);
  };
  button.addEventListener("click", () => {
    const plays = began === null;
    button.textContent = plays ? "Pause" : "Play";
    if (frame === last) frame = 0;
    began = plays ? performance.now() - ((data.t[frame] - data.t[0]) / length) * seconds * 1000 : null;
    if (plays) requestAnimationFrame(step);
  });
  slider.addEventListener("input", () => {
    began = null;
    button.textContent = "Play";
    frame = Number(slider.value);
    draw();
  });
  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; });
  canvas.addEventListener("pointermove", (event) => {
    if (!held || !event.buttons) return;
    turn += (event.clientX - held[0]) / 100;
    tilt += (event.clientY - held[1]) / 100;
    held = [event.clientX, event.clientY];
    draw();
  });
  draw();
}
if (typeof document !== "undefined") document.querySelectorAll(".player").forEach(player);
if (typeof module !== "undefined") module.exports = { hull, placed, axesOf, outlines, roomOf, player };
