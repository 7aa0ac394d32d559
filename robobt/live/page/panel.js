/* Beside the field: robots to choose from, the chosen one's tree and figures, what happened. */
import { $, clock, make, put, words } from "./base.js";
import { ABSENT, lettersOf, match, state, valueAt } from "./match.js";
import { drawBase, drawLine } from "./timeline.js";

let picks = [], rows = [], items = [], lastItem = -1;

/* ---------------------------------------------------------------- head */
export const chip = (label, value, warn) => {
  const element = make("span", warn ? "chip warn" : "chip", label);
  if (value !== undefined) element.append(" ", make("b", "", value));
  return element;
};
const plain = value => {
  if (value === null) return "–";
  if (typeof value === "number") return String(Math.round(value * 1000) / 1000);
  if (Array.isArray(value)) return value.map(plain).join(", ");
  if (typeof value === "object") return Object.entries(value).map(([key, item]) => `${key} ${plain(item)}`).join(", ");
  return String(value);
};
export const outcomeChips = outcome => Object.entries(outcome).map(([key, value]) => chip(words(key).toLowerCase(), plain(value)));
/* Name what is shown; the chips say how it ended or goes. */
export const buildHead = chips => {
  $("head").replaceChildren(
    make("h1", "", match.scenario || "Recorded match"), chip("trial", String(match.trial)), chip("seed", match.seed),
    ...chips, make("span", "spacer"), make("span", "brand", `robobt ${match.robobt}`));
  $("blue-name").textContent = match.teams.blue || "Blue";
  $("yellow-name").textContent = match.teams.yellow || "Yellow";
};
export const buildFigures = figures => {
  const teams = Object.values(figures);
  $("figures").hidden = !teams.length;
  for (const name of teams.length ? Object.keys(teams[0]) : []) {
    const row = make("tr"), value = team => name === "possession" ? `${Math.round(100 * team[name])} %` : String(Math.round(team[name] * 100) / 100);
    row.append(make("td", "", value(figures.blue)), make("th", "", words(name)), make("td", "", value(figures.yellow)));
    $("figures").querySelector("tbody").append(row);
  }
};

/* ---------------------------------------------------------------- robots */
export const buildPicker = () => {
  const { robots } = match, picker = $("picker");
  picker.replaceChildren();
  picks = robots.map((robot, slot) => {
    if (slot && robot.team !== robots[slot - 1].team) picker.append(make("span", "gap"));
    const button = make("button", "pick " + robot.team, String(robot.number));
    button.title = robot.name + (robot.play ? ", " + robot.play : "");
    button.setAttribute("aria-label", button.title);
    button.addEventListener("click", () => choose(robot));
    picker.append(button);
    return button;
  });
};
export const choose = robot => {
  state.robot = robot; state.node = 0;
  picks.forEach((button, slot) => button.setAttribute("aria-pressed", String(match.robots[slot] === robot)));
  $("who").hidden = !robot;
  if (robot) { $("who-name").textContent = words(robot.name); $("who-play").textContent = robot.play; }
  buildTree(); drawBase(); state.show();
  dispatchEvent(new Event("chosen"));
};

/* ---------------------------------------------------------------- tree */
const SVG = shape => `<svg viewBox="0 0 12 12" class="m-${shape[0]}"><path d="${shape[1]}"/></svg>`;
const MARKS = [["R", "M4.2 2.8 8.8 6 4.2 9.2z"], ["S", "M2.5 6.4 5 8.8 9.5 3.6"], ["F", "M3.2 3.2l5.6 5.6M8.8 3.2 3.2 8.8"]].map(SVG).join("");
/* Whether a branch line has to go on below node i at this depth. */
const goesOn = (nodes, i, depth) => {
  for (let j = i + 1; j < nodes.length && nodes[j].depth >= depth; j++) if (nodes[j].depth === depth) return true;
  return false;
};
const buildTree = () => {
  const robot = state.robot, tree = $("tree");
  tree.replaceChildren(); rows = [];
  if (!robot || !robot.nodes.length) { tree.append(make("div", "note", robot ? "No tree was recorded for this robot." : "Select a robot.")); return; }
  robot.nodes.forEach((node, i) => {
    const row = make("button", "row " + node.kind);
    for (let depth = 1; depth <= node.depth; depth++) {
      const own = depth === node.depth, on = goesOn(robot.nodes, i, depth);
      row.append(make("span", "bar" + (own ? " turn" + (on ? "" : " last") : on ? "" : " none")));
    }
    const mark = make("span", "mark"); mark.innerHTML = MARKS;
    const what = make("span", "what"), title = make("span", "title"), say = make("span", "say");
    if (node.glyph) title.append(make("span", "glyph", node.glyph + (node.detail === "memory" ? "*" : "")));
    title.append(make("span", "name", node.name));
    const told = node.kind === "composite" ? [] : [node.type === node.name ? "" : node.type, node.detail].filter(Boolean);
    if (told.length) title.append(make("span", "kind", told.join(" · ")));
    what.append(title, say); row.append(mark, what);
    row.title = [node.type, node.detail].filter(Boolean).join(", ");
    row.addEventListener("click", () => { state.node = i; markNode(); drawBase(); drawLine(); });
    tree.append(row);
    rows.push({ row, say, status: "", text: "" });
  });
  markNode();
};
const markNode = () => {
  rows.forEach((entry, i) => entry.row.classList.toggle("chosen", i === state.node));
  $("strip").textContent = state.robot.nodes[state.node].name;
};
const told = value => Array.isArray(value) ? `(${value.map(told).join(", ")})`
  : typeof value === "number" ? String(Number.isInteger(value) ? value : Number(value.toPrecision(3)))
    : value === null ? "none" : typeof value === "object" ? Object.entries(value).map(([key, item]) => `${key} ${told(item)}`).join(", ") : String(value);
const wroteOf = (robot, frame) => [...robot.written].map(([entry, changes]) => [entry, valueAt(changes, frame, null)])
  .filter(([, value]) => value !== null).map(([entry, value]) => `${entry} ${told(value)}`).join(" · ");
export const showPanel = frame => {
  picks.forEach((button, slot) => button.classList.toggle("gone", !match.frames || match.robots[slot].rows[4 * frame] === ABSENT));
  const robot = state.robot;
  if (!robot || !match.frames) return;
  const at = 4 * frame, [x, y, turn, speed] = robot.rows.subarray(at, at + 4), flags = valueAt(robot.flags, frame, 0);
  // A robot's skills write in the view of its own team, so all that is shown of it is in that view.
  const here = x !== ABSENT, side = robot.view;
  put($("f-speed"), here ? (speed / 1000).toFixed(2) + " m/s" : "–");
  put($("f-place"), here ? `${(side * x / 1000).toFixed(2)}, ${(side * y / 1000).toFixed(2)} m` : "off the field");
  put($("f-heading"), here ? Math.round((turn / 1000 * 180 / Math.PI + (side < 0 ? 360 : 180)) % 360 - 180) + "°" : "–");
  put($("f-ball"), (flags & 1 ? "in the mouth" : "–") + (flags & 4 ? ", kicks" : flags & 2 ? ", dribbles" : ""));
  $("f-ball").classList.toggle("on", Boolean(flags & 1));
  const letters = lettersOf(robot, frame);
  put($("wrote"), wroteOf(robot, frame));
  put($("why"), robot.nodes.map((node, i) => letters[i] === "F" && node.kind === "leaf" ? valueAt(robot.said[i], frame, "") && `${node.name}: ${valueAt(robot.said[i], frame, "")}` : "").filter(Boolean).join(" · "));
  rows.forEach((entry, i) => {
    const status = letters[i] || "-";
    if (status !== entry.status) { entry.status = status; entry.row.dataset.s = status; }
    const text = status === "-" ? "" : valueAt(robot.said[i], frame, "");
    if (text !== entry.text) { entry.text = text; entry.say.textContent = text; }
  });
};

/* ---------------------------------------------------------------- events */
const itemOf = (event, go) => {
  const item = make("button", "item");
  item.append(make("time", "", clock(event.time)));
  if (event.team) item.append(make("span", "disc " + event.team));
  item.append(make("b", "", words(event.kind)));
  const rest = [event.number === null ? "" : `${event.team} ${event.number}`, event.text].filter(Boolean).join(" · ");
  item.append(make("span", "", rest));
  item.addEventListener("click", () => go(event.time));
  return item;
};
/* List the events that are known now; go is called with the time of one that is chosen. */
export const buildEvents = go => {
  const known = new Map(items.map(entry => [entry.event, entry]));
  const list = $("list"), fresh = [];
  items = match.events.map(event => {
    let entry = known.get(event);
    if (entry) known.delete(event);
    else { entry = { event, item: itemOf(event, go) }; fresh.push(entry.item); }
    return entry;
  });
  for (const { item } of known.values()) item.remove();
  list.append(...fresh);
  lastItem = -1;
  $("events").hidden = !items.length;
};
export const showEvents = () => {
  let current = -1;
  for (let i = 0; i < items.length && items[i].event.time <= state.time + 1e-3; i++) current = i;
  if (current === lastItem) return;
  items.forEach(({ item }, i) => item.classList.toggle("now", i === current));
  if (current >= 0) {
    const list = $("list"), { item } = items[current], top = item.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + item.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top - list.clientHeight / 2;
  }
  lastItem = current;
};
