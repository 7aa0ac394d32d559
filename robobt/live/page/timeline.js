/* The line of time with the strip of a node's statuses. */
import { $, clock, colours, make, words } from "./base.js";
import { view } from "./field.js";
import { endTime, frameOf, match, startTime, state } from "./match.js";
import { readingAt, readingOf } from "./reading.js";

export const line = $("line");
const track = $("track"), chart = track.getContext("2d"), tip = $("tip");
const base = document.createElement("canvas"), under = base.getContext("2d");
const PAD = 8, RIBBON = 5, RAIL = 30;
let lineWidth = 1, lineHeight = 52;
const span = () => Math.max(1e-6, endTime() - startTime());
export const lineX = time => PAD + (time - startTime()) / span() * (lineWidth - 2 * PAD);
export const lineTime = x => Math.min(endTime(), Math.max(startTime(), startTime() + (x - PAD) / Math.max(1, lineWidth - 2 * PAD) * span()));
const markColour = event => event.kind === "error" ? colours.bad : event.team ? colours[event.team] : colours.dim;
export const fitLine = () => {
  lineWidth = line.clientWidth; lineHeight = line.clientHeight;
  for (const each of [track, base]) { each.width = Math.round(lineWidth * view.dpr); each.height = Math.round(lineHeight * view.dpr); }
};
/* What the strip's colours mean: the leaves that were active, or the statuses of the chosen node. */
const inks = new WeakMap();
/* In the order of their first use, so that the few leaves of a match are well apart. */
const inkOfLeaf = (robot, place) => {
  if (!inks.has(robot)) inks.set(robot, new Map());
  const known = inks.get(robot);
  if (!known.has(place)) known.set(place, known.size);
  return `hsl(${(205 + known.get(place) * 137.5) % 360} 58% 56%)`;
};
const STATUSES = { R: "running", S: "success", F: "failure", N: "does not hold" };
let listedInks = "";
const listInks = named => {
  const text = JSON.stringify(named);
  if (text === listedInks) return;
  listedInks = text;
  $("inks").replaceChildren(...named.map(([colour, name]) => {
    const entry = make("span", "", name), ink = make("i");
    ink.style.background = colour; entry.prepend(ink);
    return entry;
  }));
};
export const drawBase = () => {
  under.setTransform(view.dpr, 0, 0, view.dpr, 0, 0);
  under.clearRect(0, 0, lineWidth, lineHeight);
  const right = lineX(endTime());
  under.fillStyle = colours.soft; under.beginPath(); under.roundRect(PAD, RIBBON, lineWidth - 2 * PAD, 9, 3); under.fill();
  const robot = state.robot;
  if (robot && robot.nodes.length && match.frames) {
    under.save(); under.clip();
    const paint = { R: colours.run, S: colours.good, F: colours.bad, N: colours.idle };
    const { frames, values } = robot.statuses;
    /* Without a chosen node each leaf has a colour of its own while it is the active one. */
    const letter = index => { const { marks, active } = readingOf(robot, values[index]); return state.node === null ? active : marks[state.node]; };
    const colourOf = it => state.node !== null ? paint[it] : it < 0 ? "" : inkOfLeaf(robot, it), used = new Set();
    for (let i = 0; i < frames.length;) {
      let j = i + 1;
      while (j < frames.length && letter(j) === letter(i)) j++;
      const colour = colourOf(letter(i));
      if (colour) {
        used.add(letter(i));
        const from = lineX(match.times[frames[i]]), to = j < frames.length ? lineX(match.times[frames[j]]) : right;
        under.fillStyle = colour; under.fillRect(from, RIBBON, Math.max(.3, to - from), 9);
      }
      i = j;
    }
    under.restore();
    listInks([...used].sort((a, b) => a - b).map(it => [colourOf(it), state.node !== null ? STATUSES[it] : robot.nodes[it].name]));
  } else listInks([]);
  under.fillStyle = colours.edge; under.beginPath(); under.roundRect(PAD, RAIL - 2, lineWidth - 2 * PAD, 4, 2); under.fill();
  for (const event of match.events) {
    const x = lineX(event.time);
    if (event.kind === "goal" || state.unlisted.has(event.kind)) continue;
    under.globalAlpha = event.kind === "kick" ? .75 : 1; under.fillStyle = markColour(event);
    const tall = event.kind === "kick" ? 9 : 13;
    under.fillRect(x - .8, RAIL - tall / 2, 1.6, tall);
  }
  under.globalAlpha = 1;
  under.fillStyle = colours.faint; under.font = `10.5px Inter, system-ui, "DejaVu Sans", sans-serif`; under.textBaseline = "alphabetic";
  const room = Math.max(1, Math.floor((lineWidth - 2 * PAD) / 70));
  const unit = [.1, .2, .5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 1800].find(step => span() / step <= room) || 3600;
  for (let time = Math.ceil(startTime() / unit - 1e-6) * unit; time <= endTime() + 1e-6; time += unit) {
    const x = lineX(time), text = unit < 1 ? time.toFixed(1) : `${Math.floor(time / 60)}:${String(Math.round(time) % 60).padStart(2, "0")}`;
    under.textAlign = x < 30 ? "left" : x > lineWidth - 30 ? "right" : "center"; under.fillText(text, x, lineHeight - 1);
  }
  for (const event of match.events) {
    if (event.kind !== "goal" || state.unlisted.has(event.kind)) continue;
    const x = lineX(event.time);
    under.beginPath(); under.arc(x, RAIL, 6, 0, 7); under.fillStyle = colours.card; under.fill();
    under.beginPath(); under.arc(x, RAIL, 4.6, 0, 7); under.fillStyle = markColour(event); under.fill();
  }
};
export const drawLine = () => {
  chart.setTransform(1, 0, 0, 1, 0, 0);
  chart.clearRect(0, 0, track.width, track.height); chart.drawImage(base, 0, 0);
  chart.setTransform(view.dpr, 0, 0, view.dpr, 0, 0);
  const x = lineX(state.time);
  chart.globalAlpha = .55; chart.fillStyle = colours.accent; chart.fillRect(PAD, RAIL - 2, x - PAD, 4); chart.globalAlpha = 1;
  chart.fillStyle = colours.ink; chart.fillRect(x - .75, RIBBON - 3, 1.5, RAIL - RIBBON + 9);
  chart.beginPath(); chart.arc(x, RAIL, 6.5, 0, 7); chart.fillStyle = colours.accent; chart.fill();
  chart.lineWidth = 2; chart.strokeStyle = colours.card; chart.stroke();
};
const describe = event => {
  const who = event.number === null ? event.team || "" : `${event.team} ${event.number}`;
  return [words(event.kind), who, event.text].filter(Boolean).join(" · ");
};

const leafAt = time => {
  const robot = state.robot, { active } = robot && match.frames ? readingAt(robot, frameOf(time)) : { active: -1 };
  return active < 0 ? "" : robot.nodes[active].name;
};

/* The tip over the line, and where a pointer goes to in time. */
const spot = event => event.clientX - line.getBoundingClientRect().left;
export const listenLine = go => {
  let dragging = false;
  line.addEventListener("pointerdown", event => { dragging = true; line.setPointerCapture(event.pointerId); go(lineTime(spot(event))); });
  line.addEventListener("pointerup", () => { dragging = false; });
  line.addEventListener("pointercancel", () => { dragging = false; });
  line.addEventListener("pointermove", event => {
    const x = spot(event), time = lineTime(x);
    if (dragging) go(time);
    let near = null, least = 6;
    for (const mark of match.events) { if (state.unlisted.has(mark.kind)) continue; const gap = Math.abs(lineX(mark.time) - x); if (gap < least) { near = mark; least = gap; } }
    tip.textContent = near ? `${clock(near.time)}  ${describe(near)}` : `${clock(time)}  ${leafAt(time)}`;
    tip.style.display = "block";
    const half = tip.offsetWidth / 2;
    tip.style.left = Math.min(lineWidth - half, Math.max(half, x)) + "px";
  });
  line.addEventListener("pointerleave", () => { tip.style.display = "none"; });
};
