/* What people do to the match: drag, turn, put on and off, the referee's orders, plays and parameters. */
import { $, make, put, words } from "./base.js";
import { canvas, drawMatch, robotAt, spotOf, view } from "./field.js";
import { ABSENT, frameOf, match, state } from "./match.js";
import { remote } from "./player.js";
import { readingAt } from "./reading.js";

/* Set by the page: sends a message of one who steers, and says something. */
export const bridge = { act: () => false, say: () => {}, now: () => ({}) };
const RESEND = 100, TURN = Math.PI / 12, FLICK = .4, FASTEST = 6.5, TRACE = 120;

/* ---------------------------------------------------------------- dragging */
let grip = null;
const poseOf = robot => {
  const at = 4 * frameOf(state.time), [x, y, turn] = robot.rows.subarray(at, at + 3);
  return x === ABSENT ? null : { x: x / 1000, y: y / 1000, turn: turn / 1000 };
};
const nearBall = ([x, y]) => {
  const at = 4 * frameOf(state.time);
  return match.frames && match.ball[at] !== ABSENT && Math.hypot(match.ball[at] / 1000 - x, match.ball[at + 1] / 1000 - y) < Math.max(.06, 9 / view.scale);
};
const beyond = ([x, y]) => Math.abs(x) > view.worldWidth / 2 - .02 || Math.abs(y) > view.worldHeight / 2 - .02;
const within = ([x, y]) => [Math.min(view.worldWidth / 2 - .1, Math.max(.1 - view.worldWidth / 2, x)), Math.min(view.worldHeight / 2 - .1, Math.max(.1 - view.worldHeight / 2, y))];
const round = value => Math.round(value * 1e4) / 1e4;
const tellPlace = held => {
  const [x, y] = within(grip.spot).map(round);
  if (grip.robot) bridge.act({ do: "robot", robot: grip.robot.name, x, y, heading: round(grip.turn), held });
  else bridge.act({ do: "ball", x, y, held });
};
/* Whether the pointer took hold of something; where nothing can be moved it only looks. */
remote.grab = event => {
  if (!state.follow || event.button > 0) return false;
  const spot = spotOf(event), ball = nearBall(spot), robot = ball ? null : robotAt(spot);
  if (!ball && !robot) return false;
  const { steers, movable } = bridge.now();
  if (!steers || !movable) {
    if (steers && event.detail !== 2) bridge.say("Nothing can be moved here: this is no simulator of ours.");
    return false;
  }
  const pose = robot && poseOf(robot);
  grip = { robot, turn: pose ? pose.turn : 0, spot, moved: false, trace: [], timer: 0, offset: pose ? [pose.x - spot[0], pose.y - spot[1]] : [0, 0] };
  canvas.setPointerCapture(event.pointerId);
  return true;
};
const dragged = event => {
  if (!grip) return;
  const [x, y] = spotOf(event), spot = [x + grip.offset[0], y + grip.offset[1]];
  if (!grip.moved && Math.hypot(spot[0] - grip.spot[0], spot[1] - grip.spot[1]) * view.scale < 4) return;
  if (!grip.moved) grip.timer = setInterval(() => tellPlace(true), RESEND);
  grip.moved = true;
  /* With shift it turns on the spot towards the pointer. */
  if (event.shiftKey && grip.robot) grip.turn = Math.atan2(y - grip.spot[1], x - grip.spot[0]);
  else grip.spot = spot;
  grip.trace.push([event.timeStamp, ...grip.spot]);
  while (grip.trace[0][0] < event.timeStamp - TRACE) grip.trace.shift();
  tellPlace(true);
};
const dropped = event => {
  if (!grip) return;
  const { robot, moved, trace } = grip;
  clearInterval(grip.timer);
  if (!moved) { if (robot) dispatchEvent(new CustomEvent("picked", { detail: robot })); }
  else if (robot && beyond(grip.spot)) bridge.act({ do: "off", robot: robot.name });
  else if (robot) tellPlace(false);
  else {
    const [first, last] = [trace[0], trace[trace.length - 1]], passed = last && (last[0] - first[0]) / 1000;
    let vx = 0, vy = 0;
    /* Let go in motion it rolls on; after a rest it lies. */
    if (passed > .01 && event.timeStamp - last[0] < TRACE) { vx = (last[1] - first[1]) / passed; vy = (last[2] - first[2]) / passed; }
    const speed = Math.hypot(vx, vy), share = speed < FLICK ? 0 : Math.min(1, FASTEST / speed);
    const [x, y] = within(grip.spot).map(round);
    bridge.act({ do: "ball", x, y, vx: round(vx * share), vy: round(vy * share) });
  }
  grip = null;
};
canvas.addEventListener("pointermove", dragged);
canvas.addEventListener("pointerup", dropped);
canvas.addEventListener("pointercancel", dropped);

/* ---------------------------------------------------------------- the panel */
const card = make("section", "card steering");
card.setAttribute("aria-label", "Steering");
const note = make("p", "dim"), forms = make("div", "forms");
const button = (name, title, action) => {
  const made = make("button", "toggle", name);
  made.type = "button"; made.title = title;
  made.addEventListener("click", action);
  return made;
};
const chosen = action => () => { if (state.robot) action(state.robot); };
const turn = by => chosen(robot => {
  const pose = poseOf(robot);
  if (pose) bridge.act({ do: "robot", robot: robot.name, x: round(pose.x), y: round(pose.y), heading: round(Math.atan2(Math.sin(pose.turn + by), Math.cos(pose.turn + by))) });
});
const place = chosen(robot => {
  if (poseOf(robot)) bridge.act({ do: "off", robot: robot.name });
  else bridge.act({ do: "robot", robot: robot.name, x: round(-robot.view * 1.5), y: 0, heading: robot.view > 0 ? 0 : round(Math.PI) });
});
const moving = make("div", "group"), referee = make("div", "group");
const offButton = button("Take off", "Take the chosen robot off the field, or put it on again", place);
moving.append(button("⟲ Turn", "Turn the chosen robot to its left", turn(TURN)), button("Turn ⟳", "Turn the chosen robot to its right", turn(-TURN)), offButton,
  button("Edit play", "Another play for the chosen robot, and its parameters", chosen(robot => bridge.act({ do: "form", robot: robot.name }))),
  button("Edit skill", "Parameters of the node that is chosen in the tree", chosen(robot => bridge.act({ do: "form", robot: robot.name, path: pathOf(robot, state.node ?? readingAt(robot, frameOf(state.time)).active) }))),
  button("Save situation", "Save the present situation as a scenario file", () => bridge.act({ do: "situation" })));
const team = make("select");
team.setAttribute("aria-label", "Team of the referee's order");
for (const name of ["blue", "yellow"]) team.append(new Option(words(name), name));
const order = (name, of) => button(words(name), "As the referee", () => bridge.act({ do: "order", order: name, team: of ? team.value : null }));
referee.append(order("halt"), order("stop"), order("continue"), order("force start"), team, order("kick-off", true), order("free kick", true), order("penalty", true));
const heading = make("h3", "", "Steering");
const controlled = make("p", "dim");
card.append(heading, note, moving, referee, controlled, forms);
document.querySelector("aside").insertBefore(card, $("figures"));

/* A node's id as recordings have it: names from the root, and a number where two would be the same. */
export const pathOf = (robot, place) => robot.nodes[place] ? robot.nodes[place].path : "";

/* ---------------------------------------------------------------- forms */
const inputOf = field => {
  const { entered, value, choices } = field;
  if (entered === "choice") {
    const select = make("select");
    for (const choice of choices) select.append(new Option(String(choice), JSON.stringify(choice), false, choice === value));
    return [select, () => JSON.parse(select.value)];
  }
  const input = make("input");
  if (entered === "switch") { input.type = "checkbox"; input.checked = value; return [input, () => input.checked]; }
  if (entered === "number" || entered === "integer") {
    input.type = "number"; input.step = entered === "integer" ? "1" : "any"; input.value = value;
    return [input, () => { if (input.value === "") throw new Error("no number"); return Number(input.value); }];
  }
  input.type = "text";
  if (entered === "text") { input.value = value; return [input, () => input.value]; }
  input.value = JSON.stringify(value);
  return [input, () => JSON.parse(input.value)];
};
/* The newest form told of, as text, and what stands there of it: closed or with what was typed it stays as it is. */
let toldForm = null, shown = null;
const typedIn = input => input.type === "checkbox" ? input.checked : input.value;
const closeForm = () => { shown = null; forms.replaceChildren(); };
const showForm = (form, plays, steers) => {
  const text = JSON.stringify(form), before = toldForm;
  if (text === before) return;
  toldForm = text;
  if (!form) { closeForm(); return; }
  /* Nobody here asked for one that was there before this page, or that another viewer is shown. */
  if (before === null || !steers) return;
  /* An answer leaves what was typed since it was asked for. */
  const same = shown && shown.robot === form.robot && shown.path === form.path && shown.play === form.play;
  const typed = same ? shown.inputs.filter(each => typedIn(each.input) !== each.told).map(each => [each.input.name, typedIn(each.input)]) : [];
  const focused = same && forms.contains(document.activeElement) ? document.activeElement.name : null;
  closeForm();
  const made = make("form"), reads = [];
  made.append(make("h4", "", form.path ? `${words(form.robot)}: ${form.path}` : words(form.robot)));
  const row = (label, input, hint) => {
    const line = make("label");
    line.append(make("span", "", label), input);
    if (hint) line.title = hint;
    made.append(line);
  };
  let play = null, all = null;
  if (!form.path) {
    play = make("select"); play.name = "play";
    for (const name of [...new Set([form.play, ...plays])]) play.append(new Option(name, name, false, name === form.play));
    row("play", play);
    all = make("input"); all.type = "checkbox"; all.name = "team";
    row("all of the team but the goalkeeper", all);
  }
  for (const field of form.fields) {
    const [input, read] = inputOf(field);
    input.name = field.name;
    row(field.name, input, field.type);
    reads.push([field.name, read, JSON.stringify(field.value), input]);
  }
  if (!form.fields.length && form.path) made.append(make("p", "dim", "This node has no parameters to change."));
  const actions = make("div", "group"), send = make("button", "toggle", "Apply");
  actions.append(send, button("Close", "Close this form", closeForm));
  made.append(actions);
  made.addEventListener("submit", event => {
    event.preventDefault();
    const params = {};
    try {
      /* Of a play all that differs from what it was given, of a skill only what was changed here. */
      for (const [name, read, before] of reads) { const value = read(); if (JSON.stringify(value) !== before || !form.path && play.value === form.play) params[name] = value; }
    } catch { bridge.say("A value is written in a form that cannot be read: lists are [1, 2], texts \"so\"."); return; }
    /* What was wrong with an earlier value is wrong no more, or is said again. */
    bridge.say("");
    for (const each of shown.inputs) each.told = typedIn(each.input);
    if (form.path) bridge.act({ do: "skill", robot: form.robot, path: form.path, params });
    else bridge.act({ do: "play", robot: form.robot, play: play.value, params: play.value === form.play ? params : {}, team: all.checked });
  });
  shown = { ...form, inputs: reads.map(([, , , input]) => ({ input, told: typedIn(input) })) };
  for (const [name, value] of typed) {
    const input = made.elements[name];
    if (input) input[input.type === "checkbox" ? "checked" : "value"] = value;
  }
  forms.append(made);
  /* It stands below the buttons, often out of sight. */
  if (!same) made.scrollIntoView({ block: "nearest" });
  if (focused && made.elements[focused]) made.elements[focused].focus();
};

/* ---------------------------------------------------------------- state */
let saved = 0;
export const showSteering = now => {
  const { steers, movable, orders } = now;
  const plays = (now.plays || []).length > 0;
  card.hidden = !(movable || orders || plays);
  put(note, !steers ? "Another viewer steers this match."
    : movable ? "Drag robots and the ball; flick the ball to roll it; shift turns a robot; beyond the wall it is taken off."
      : "Nothing can be dragged here: these are no robots of our simulator.");
  for (const each of moving.children) each.disabled = !steers || !(/Turn|Take/.test(each.textContent) ? movable : plays);
  referee.hidden = Boolean(now.game_controller);
  for (const each of referee.children) each.disabled = !steers || !orders;
  referee.title = orders ? "" : "Nobody referees this match: it is played freely.";
  put(controlled, now.game_controller ? "A game controller decides this match; what it says is above the field." : "");
  forms.hidden = !steers;
  if ("form" in now) showForm(now.form, now.plays || [], steers);
  if (now.situation && now.situation > saved && steers) location.assign("situation.yaml");
  saved = now.situation || 0;
};
