/* Beside the field: robots to choose from, the chosen one's tree and figures, what happened. */
import { $, clock, make, put, words } from "./base.js";
import { ABSENT, match, state, valueAt } from "./match.js";
import { drawBase } from "./timeline.js";
import { buildTree, showTree } from "./tree.js";

let picks = [], items = [], lastItem = -1;

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
  return String(value).replace(/_/g, " ");
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
  let group = null;
  picks = robots.map((robot, slot) => {
    if (!slot || robot.team !== robots[slot - 1].team) picker.append(group = make("div", "team"));
    const button = make("button", "pick " + robot.team, String(robot.number));
    button.title = robot.name + (robot.play ? ", " + robot.play : "");
    button.setAttribute("aria-label", button.title);
    button.addEventListener("click", () => choose(robot));
    group.append(button);
    return button;
  });
};
export const choose = robot => {
  state.robot = robot; state.node = null;
  picks.forEach((button, slot) => button.setAttribute("aria-pressed", String(match.robots[slot] === robot)));
  $("who").hidden = !robot;
  if (robot) { put($("who-name"), words(robot.name)); put($("who-play"), robot.play); }
  buildTree(); drawBase(); state.show();
  dispatchEvent(new Event("chosen"));
};

/* ---------------------------------------------------------------- figures */
const told = value => Array.isArray(value) ? `(${value.map(told).join(", ")})`
  : typeof value === "number" ? String(Number.isInteger(value) ? value : Number(value.toPrecision(3)))
    : value === null ? "none" : typeof value === "object" ? Object.entries(value).map(([key, item]) => `${entryName(key)} ${told(item)}`).join(", ") : String(value);
/* Entries are named as Python has them: pass_ is one because pass is a word of the language. */
const entryName = entry => entry.replace(/_+$/, "").replace(/_/g, " ");
const wroteOf = (robot, frame) => [...robot.written].map(([entry, changes]) => [entry, valueAt(changes, frame, null)])
  .filter(([, value]) => value !== null).map(([entry, value]) => `${entryName(entry)} ${told(value)}`).join(" · ");
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
  put($("f-ball"), (flags & 1 ? "has it" : "away") + (flags & 4 ? ", kicks" : flags & 2 ? ", dribbles" : ""));
  $("f-ball").classList.toggle("on", Boolean(flags & 1));
  const delay = (state.delays || {})[robot.name];
  $("delay").hidden = delay === undefined;
  put($("f-delay"), delay ? `${Math.round(1000 * delay[0])} ± ${Math.max(1, Math.round(1000 * delay[1]))} ms` : "not seen enough");
  put($("wrote"), wroteOf(robot, frame));
  const game = valueAt(match.games, frame, null), keeps = game && game.teams.some(({ team, keeper }) => team === robot.team && keeper === robot.number);
  put($("who-play"), [robot.play, keeps && "goalkeeper"].filter(Boolean).join(", "));
  showTree(frame);
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
/* Kinds of events, each of which can be left out of the list, the line of time and the jumps. */
const buildKinds = go => {
  const kinds = [...new Set(match.events.map(event => event.kind))];
  if ($("kinds").children.length === kinds.length) return;
  $("kinds").replaceChildren(...kinds.map(kind => {
    const button = make("button", "", words(kind));
    button.title = "Show these, or leave them out";
    button.setAttribute("aria-pressed", String(!state.unlisted.has(kind)));
    button.addEventListener("click", () => {
      if (!state.unlisted.delete(kind)) state.unlisted.add(kind);
      button.setAttribute("aria-pressed", String(!state.unlisted.has(kind)));
      buildEvents(go); drawBase(); state.show();
    });
    return button;
  }));
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
  buildKinds(go);
  for (const { event, item } of items) item.hidden = state.unlisted.has(event.kind);
  lastItem = -1;
  $("events").hidden = !items.length;
};
export const showEvents = () => {
  let current = -1;
  for (let i = 0; i < items.length && items[i].event.time <= state.time + 1e-3; i++) if (!items[i].item.hidden) current = i;
  if (current === lastItem) return;
  items.forEach(({ item }, i) => item.classList.toggle("now", i === current));
  if (current >= 0) {
    const list = $("list"), { item } = items[current], top = item.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + item.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = top - list.clientHeight / 2;
  }
  lastItem = current;
};
