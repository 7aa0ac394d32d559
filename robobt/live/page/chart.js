/* Numbers over time below the line of time: places and speeds, and what skills write and publish. */
import { $, clock, colours, make, put } from "./base.js";
import { view } from "./field.js";
import { ABSENT, frameOf, match, state, valueAt } from "./match.js";
import { line, lineTime, lineX } from "./timeline.js";

const MOST_SERIES = 6, MOST_OFFERED = 150, DEEPEST = 3, SAMPLES = 4, HEIGHT = 110, EDGE = 6;
const PENS = ["accent", "ball", "good", "bad", "yellow-ink", "dim"];
const opener = make("button", "toggle", "Chart"), box = make("div", "chart"), plot = make("div", "plot");
const graph = make("canvas"), brush = graph.getContext("2d"), cursor = make("i", "cursor"), choice = make("i", "choice");
const add = make("select"), legend = make("div", "series"), save = make("a", "toggle", "CSV");
let series = [], hovered = null, range = null, begun = null;

/* ---------------------------------------------------------------- what there is to show */
const row = (rows, place) => frame => rows()[4 * frame] === ABSENT ? null : rows()[4 * frame + place] / 1000;
const fields = (owner, rows, names) => names.map((name, place) => ({ name: `${owner} ${name}`, at: row(rows, place) }));
/* Rows tell speeds; the direction is that from the frame before to the one after, as is how fast it turns. */
const around = (rows, frame) => {
  const from = Math.max(0, frame - 1), to = Math.min(match.frames - 1, frame + 1);
  if ([from, frame, to].some(each => rows[4 * each] === ABSENT) || from === to) return null;
  return { seconds: match.times[to] - match.times[from], moved: [0, 1, 2].map(place => (rows[4 * to + place] - rows[4 * from + place]) / 1000) };
};
const velocity = (rows, place, speed) => frame => {
  const step = around(rows(), frame);
  return step && (rows()[4 * frame + speed] / 1000 * step.moved[place] / Math.hypot(step.moved[0], step.moved[1]) || 0);
};
const turning = rows => frame => { const step = around(rows(), frame); return step && Math.atan2(Math.sin(step.moved[2]), Math.cos(step.moved[2])) / step.seconds; };
const FLAGS = { "ball contact": 1, "dribbler": 2, "kick": 4 };
const robotOf = name => match.robots.find(robot => robot.name === name);
const within = (value, path) => path.reduce((inner, key) => inner === null || typeof inner !== "object" ? null : inner[key] ?? null, value);
const pathsOf = (value, path = []) => typeof value === "number" ? [path]
  : value && typeof value === "object" && path.length < DEEPEST ? Object.entries(value).flatMap(([key, inner]) => pathsOf(inner, [...path, key])) : [];
const holding = (robot, kind, key) => frame => { const known = robotOf(robot); return known && known[kind].has(key) ? valueAt(known[kind].get(key), frame, null) : null; };
const number = value => typeof value === "number" && Number.isFinite(value) ? value : null;
/* The ball's, and those of the chosen robot: each finds its robot by name, in a later match too. */
const offered = () => {
  const ball = () => match.ball, found = fields("ball", ball, ["x [m]", "y [m]", "speed [m/s]", "height [m]"]);
  ["vx", "vy"].forEach((axis, place) => found.push({ name: `ball ${axis} [m/s]`, at: velocity(ball, place, 2) }));
  if (state.robot) {
    const { name, numbers, written } = state.robot;
    const rows = () => (robotOf(name) || { rows: [ABSENT] }).rows;
    found.push(...fields(name, rows, ["x [m]", "y [m]", "heading [rad]", "speed [m/s]"]));
    ["vx", "vy"].forEach((axis, place) => found.push({ name: `${name} ${axis} [m/s]`, at: velocity(rows, place, 3) }));
    found.push({ name: `${name} turning [rad/s]`, at: turning(rows) });
    for (const [flag, bit] of Object.entries(FLAGS)) found.push({ name: `${name} ${flag}`, at: frame => robotOf(name) ? Number((valueAt(robotOf(name).flags, frame, 0) & bit) > 0) : null });
    for (const key of numbers.keys()) found.push({ name: `${name} ${key}`, at: holding(name, "numbers", key) });
    for (const [entry, { values }] of written) {
      const paths = new Map([...values.slice(-200), null].flatMap(value => pathsOf(value)).map(path => [path.join("."), path]));
      for (const [text, path] of paths) {
        const at = holding(name, "written", entry);
        found.push({ name: `${name} ${entry}${text ? "." + text : ""}`, at: frame => number(within(at(frame), path)) });
      }
    }
  }
  return found.slice(0, MOST_OFFERED);
};
let offers = [], listed = null;
const offer = () => {
  offers = offered().filter(each => !series.some(({ name }) => name === each.name));
  const names = offers.map(({ name }) => name).join("\n");
  /* A list that is open must not change under the pointer. */
  if (names !== listed) add.replaceChildren(new Option("Add…", ""), ...offers.map(({ name }) => new Option(name, name)));
  listed = names; add.value = "";
};

/* ---------------------------------------------------------------- drawing */
const sampled = ({ at }, width) => {
  const points = [];
  for (let x = 0, before = -1; x < width * SAMPLES; x++) {
    const frame = frameOf(lineTime(x / SAMPLES));
    if (frame !== before) { points.push([lineX(match.times[frame]), number(at(frame))]); before = frame; }
  }
  return points;
};
export const drawChartBase = () => {
  if (box.hidden) return;
  const width = plot.clientWidth;
  graph.width = Math.round(width * view.dpr); graph.height = Math.round(HEIGHT * view.dpr);
  brush.setTransform(view.dpr, 0, 0, view.dpr, 0, 0);
  brush.lineWidth = 1.4; brush.lineJoin = "round";
  if (match.frames) series.forEach((each, i) => {
    const points = sampled(each, width), values = points.map(([, value]) => value).filter(value => value !== null);
    const least = Math.min(...values), most = Math.max(...values), high = most - least || 1;
    each.low.textContent = values.length ? `${short(least)} … ${short(most)}` : "no value";
    brush.strokeStyle = colours[PENS[i]]; brush.beginPath();
    let on = false;
    for (const [x, value] of points) {
      if (value === null) { on = false; continue; }
      const y = HEIGHT - EDGE - (value - least) / high * (HEIGHT - 2 * EDGE);
      if (on) brush.lineTo(x, y); else brush.moveTo(x, y);
      on = true;
    }
    brush.stroke();
  });
  drawChart();
};
const short = value => value === null ? "–" : String(Number(value.toPrecision(4)));
/* The moment that is shown, or that the pointer is at, and the values then. */
export const drawChart = () => {
  if (box.hidden || !match.frames) return;
  const time = hovered === null ? state.time : hovered, frame = frameOf(time);
  cursor.style.transform = `translateX(${lineX(time)}px)`;
  choice.hidden = !range;
  if (range) { const [from, to] = bounds().map(lineX); choice.style.left = `${from}px`; choice.style.width = `${to - from}px`; }
  for (const each of series) put(each.now, short(number(each.at(frame))));
  put(save, range ? `CSV of ${bounds().map(clock).join(" to ")}` : "CSV of all");
};

/* ---------------------------------------------------------------- choosing */
const bounds = () => range ? [...range].sort((a, b) => a - b) : [lineTime(0), lineTime(1e9)];
const showSeries = () => {
  legend.replaceChildren(...series.map((each, i) => {
    const entry = make("button", "entry"), ink = make("i");
    ink.style.background = `var(--${PENS[i]})`;
    each.now = make("b"); each.low = make("small");
    entry.append(ink, make("span", "", each.name), each.now, each.low, "×");
    entry.title = "Take it off the chart";
    entry.addEventListener("click", () => { series = series.filter(other => other !== each); showSeries(); });
    return entry;
  }));
  save.hidden = !series.length; add.disabled = series.length >= MOST_SERIES;
  offer(); drawChartBase();
};
/* A name may hold whatever a file says: quoted, and no formula of a spreadsheet. */
const cell = text => `"${(/^[=+@-]/.test(text) ? "'" : "") + text.replace(/"/g, '""')}"`;
export const csv = () => {
  const [from, to] = bounds(), rows = [["time [s]", ...series.map(({ name }) => name)].map(cell).join(",")];
  for (let frame = frameOf(from), last = frameOf(to); frame <= last; frame++)
    rows.push([match.times[frame].toFixed(4), ...series.map(({ at }) => number(at(frame)) ?? "")].join(","));
  return rows.join("\r\n") + "\r\n";
};
save.href = "#"; save.download = "robobt.csv";
save.addEventListener("click", () => {
  const url = URL.createObjectURL(new Blob([csv()], { type: "text/csv" }));
  save.href = url;
  setTimeout(() => { URL.revokeObjectURL(url); save.href = "#"; }, 10000);
});
add.setAttribute("aria-label", "What to show over time");
add.addEventListener("pointerdown", offer);
add.addEventListener("focus", offer);
add.addEventListener("change", () => {
  const found = offers.find(({ name }) => name === add.value);
  if (found) { series.push(found); showSeries(); }
});
const timeAt = event => lineTime(event.clientX - plot.getBoundingClientRect().left);
plot.addEventListener("pointerdown", event => { begun = timeAt(event); range = null; plot.setPointerCapture(event.pointerId); drawChart(); });
plot.addEventListener("pointermove", event => {
  hovered = timeAt(event);
  if (begun !== null && Math.abs(lineX(hovered) - lineX(begun)) > 3) range = [begun, hovered];
  drawChart();
});
for (const end of ["pointerup", "pointercancel"]) plot.addEventListener(end, () => { begun = null; });
plot.addEventListener("pointerleave", () => { hovered = null; drawChart(); });
opener.title = "Numbers over time: places, speeds, and what skills write";
opener.addEventListener("click", () => {
  box.hidden = !box.hidden; opener.setAttribute("aria-pressed", String(!box.hidden));
  if (!series.length) series = offered().filter(({ name }) => name === "ball speed [m/s]");
  showSeries();
  dispatchEvent(new Event("resize"));
});
const choosing = make("div", "group");
choosing.append(add, save);
plot.append(graph, choice, cursor); box.append(plot, legend, choosing); box.hidden = save.hidden = choice.hidden = true;
line.after(box); $("labels").after(opener);
addEventListener("chosen", offer);
