/* Shows the match at a time, and moves that time: play, step, jump, by buttons, keys and pointer. */
import { $, clock, make, put, readColours, words } from "./base.js";
import { drawChart, drawChartBase } from "./chart.js";
import { canvas, drawMatch, fit, look, robotAt, spotOf, view } from "./field.js";
import { explainDrawn } from "./layers.js";
import { endTime, frameOf, match, scoreOf, startTime, state, valueAt } from "./match.js";
import { buildEvents, buildPicker, choose, showEvents, showPanel } from "./panel.js";
import { drawBase, drawLine, fitLine, line, listenLine } from "./timeline.js";
import { showWhole } from "./tree.js";

/* At the newest tick of a match that is being played, these act on the match itself. */
export const remote = { toggle: null, step: null, setSpeed: null, grab: null };
export const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];

/* ---------------------------------------------------------------- showing */
const STOPPED = /^(HALT|TIMEOUT)/, STARTED = /START$|_FREE/, WAITING = /^(STOP|PREPARE|BALL_PLACEMENT)/;
/* What a game controller says besides, as far as it is news; where none speaks, no goalkeeper is named. */
const orderOf = command => { const [, order, team] = /^(?:PREPARE_)?(.*?)(?:_(BLUE|YELLOW))?$/.exec(command); return words(order).toLowerCase() + (team ? ` for ${team.toLowerCase()}` : ""); };
const cardsOf = (count, colour) => count ? `${count} ${colour} card${count > 1 ? "s" : ""}` : "";
const stageOf = ({ stage, upcoming, teams, happened }) => teams.some(team => team.keeper !== null) ? [
  words(stage), upcoming && `next: ${orderOf(upcoming)}`,
  ...teams.map(({ team, most, yellow, red, substituting }) => [team, [
    cardsOf(yellow, "yellow"), cardsOf(red, "red"), (yellow || red) && most !== null && `so at most ${most} robots`, substituting && "substitutes a robot",
  ].filter(Boolean).join(", ")]).filter(([, news]) => news).map(([team, news]) => `${team}: ${news}`), happened.length && happened.map(name => name.replace(/_/g, " ")).join(", "),
].filter(Boolean).join(" · ") : "";
let shownGame;
const show = () => {
  const N = match.frames, frame = frameOf(state.time), game = N ? valueAt(match.games, frame, null) : null;
  const score = $("score"), text = ["blue", "yellow"].map(team => scoreOf(team, game)).join(" : ");
  if (score.dataset.now !== text) {
    score.dataset.now = text;
    const [blue, yellow] = text.split(" : ");
    score.replaceChildren(make("span", "", blue), make("i", "", ":"), make("span", "", yellow));
  }
  if (game && shownGame !== game) {
    shownGame = game;
    const lamp = make("span", "lamp" + (STOPPED.test(game.command) ? " stop" : WAITING.test(game.command) ? " wait" : ""));
    const restart = game.restart ? ` · ${game.restart.replace(/_/g, " ")}${game.team ? " for " + game.team : ""}` : "";
    /* A command holds until the next one; what it ordered is over once the ball is in play. */
    $("word").replaceChildren(lamp, STARTED.test(game.command) && !restart ? "In play" : words(game.command) + restart);
    put($("stage"), stageOf(game));
  }
  const clockText = N ? `${clock(state.time)} / ${clock(endTime())}` : "No frame was recorded.";
  if ($("clock").dataset.now !== clockText) {
    $("clock").dataset.now = clockText;
    if (!N) $("clock").textContent = clockText;
    else if (state.follow) $("clock").replaceChildren(clock(state.time));
    else $("clock").replaceChildren(clock(state.time), make("span", "", ` / ${clock(endTime())}${remote.toggle ? "" : ` · frame ${frame + 1}`}`));
  }
  line.setAttribute("aria-valuenow", state.time.toFixed(2)); line.setAttribute("aria-valuetext", clock(state.time));
  showPanel(frame); showEvents(); drawMatch(); explainDrawn(); drawLine(); drawChart();
};
state.show = show;

/* ---------------------------------------------------------------- time */
const PLAY = "M3.5 1.5v13l11-6.5z", PAUSE = "M3 2h3.6v12H3zM9.4 2H13v12H9.4z";
let before = 0;
export const showPlaying = on => $("play-shape").setAttribute("d", on ? PAUSE : PLAY);
const run = now => {
  if (!state.playing) return;
  state.time += Math.min(.25, Math.max(0, (now - before) / 1000)) * state.speed; before = now;
  if (state.time >= endTime()) { state.time = endTime(); pause(); if (remote.toggle) toNow(); }
  show();
  if (state.playing) requestAnimationFrame(run);
};
export const pause = () => { state.playing = false; showPlaying(false); };
const play = () => {
  if (!match.frames || endTime() <= startTime()) return;
  if (state.time >= endTime() - 1e-3) state.time = startTime();
  state.playing = true; showPlaying(true);
  before = performance.now(); requestAnimationFrame(run);
};
const follow = on => {
  if (state.follow === on) return;
  state.follow = on;
  dispatchEvent(new Event("follow"));
};
/* Back to the newest tick, and on with it. */
export const toNow = () => { if (!state.follow) { pause(); follow(true); } };
export const go = time => {
  if (remote.toggle) follow(time >= endTime() - .02 && state.follow);
  state.time = Math.min(endTime(), Math.max(startTime(), time)); show();
};
const toggle = () => state.follow ? remote.toggle() : state.playing ? pause() : play();
const step = count => {
  if (state.follow && count > 0) { remote.step(); return; }
  pause();
  if (match.frames) go(match.times[Math.min(match.frames - 1, Math.max(0, frameOf(state.time) + count))]);
};
const jump = way => {
  const marks = match.events.filter(event => !state.unlisted.has(event.kind)).map(event => event.time).sort((a, b) => a - b);
  const next = way > 0 ? marks.find(time => time > state.time + .02) : marks.reverse().find(time => time < state.time - .02);
  if (next !== undefined) go(next);
};
export const showSpeed = speed =>
  [...$("speeds").children].forEach((button, i) => button.setAttribute("aria-pressed", String(SPEEDS[i] === speed)));
const setSpeed = speed => {
  if (state.follow) { remote.setSpeed(speed); return; }
  state.speed = speed; showSpeed(speed);
};
const speedNow = () => SPEEDS[[...$("speeds").children].findIndex(button => button.getAttribute("aria-pressed") === "true")];
const shiftSpeed = by => setSpeed(SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, SPEEDS.indexOf(speedNow()) + by))]);
const setLabels = on => { state.labels = on; $("labels").setAttribute("aria-pressed", String(on)); drawMatch(); };

/* ---------------------------------------------------------------- input */
const KEYS = {
  " ": toggle, "ArrowLeft": second => second ? go(state.time - 1) : step(-1), "ArrowRight": second => second ? go(state.time + 1) : step(1),
  "Home": () => go(startTime()), "End": () => remote.toggle ? toNow() : go(endTime()), ",": () => jump(-1), ".": () => jump(1),
  "[": () => shiftSpeed(-1), "]": () => shiftSpeed(1), "l": () => setLabels(!state.labels),
};
const listen = () => {
  for (const speed of SPEEDS) {
    const button = make("button", "", speed + "×");
    button.addEventListener("click", () => setSpeed(speed));
    $("speeds").append(button);
  }
  $("play").addEventListener("click", toggle);
  $("prev").addEventListener("click", () => step(-1));
  $("next").addEventListener("click", () => step(1));
  $("labels").addEventListener("click", () => setLabels(!state.labels));
  $("whole").addEventListener("click", () => showWhole($("whole").getAttribute("aria-pressed") !== "true"));
  let grip = null;
  canvas.addEventListener("pointerdown", event => {
    if (remote.grab && remote.grab(event)) return;
    grip = { x: event.offsetX, y: event.offsetY, moved: false }; canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", event => {
    if (!grip) return;
    const dx = event.offsetX - grip.x, dy = event.offsetY - grip.y;
    if (!grip.moved && Math.hypot(dx, dy) < 4) return;
    look(view.zoom, view.x - dx / view.scale, view.y + dy / view.scale);
    grip = { x: event.offsetX, y: event.offsetY, moved: true };
    drawMatch();
  });
  canvas.addEventListener("pointerup", event => {
    const robot = grip && !grip.moved ? robotAt(spotOf(event)) : null;
    if (robot) choose(robot);
    grip = null;
  });
  canvas.addEventListener("pointercancel", () => { grip = null; });
  canvas.addEventListener("dblclick", () => { look(1, 0, 0); drawMatch(); });
  canvas.addEventListener("wheel", event => {
    const zoom = Math.min(8, Math.max(1, view.zoom * Math.exp(-event.deltaY * .0015)));
    if (zoom === view.zoom) return;
    event.preventDefault();
    const [x, y] = spotOf(event), share = view.zoom / zoom;
    look(zoom, x + (view.x - x) * share, y + (view.y - y) * share);
    drawMatch();
  }, { passive: false });
  listenLine(time => { pause(); go(time); });
  addEventListener("keydown", event => {
    const typing = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
    if (event.ctrlKey || event.metaKey || event.altKey || typing || event.defaultPrevented) return;
    const action = KEYS[event.key];
    if (action) { event.preventDefault(); action(event.shiftKey); }
  });
  /* A focused button would be pressed by the space bar's release as well. */
  addEventListener("keyup", event => { if (event.key === " " && event.target.tagName === "BUTTON") event.preventDefault(); });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  addEventListener("resize", redraw);
  new ResizeObserver(redraw).observe(canvas.parentElement);
};

/* ---------------------------------------------------------------- start */
export const redraw = () => { readColours(); fit(); fitLine(); drawBase(); drawChartBase(); show(); };
/* What is new on the line of time and in the list of events. */
export const refresh = () => {
  line.setAttribute("aria-valuemin", startTime().toFixed(2)); line.setAttribute("aria-valuemax", endTime().toFixed(2));
  buildEvents(go); drawBase(); drawChartBase();
};
/* Show the match that was opened; the first of a page also starts to listen. */
let listening = false;
export const start = () => {
  const wanted = new URLSearchParams(location.hash.slice(1));
  const name = listening && state.robot ? state.robot.name : wanted.get("robot");
  buildPicker(); readColours();
  if (!listening) {
    const [zoom, x, y] = (wanted.get("view") || "1,0,0").split(",").map(Number);
    listen(); fit(); look(zoom || 1, x || 0, y || 0); fitLine();
    showSpeed(state.speed); setLabels(wanted.has("labels"));
    state.time = Math.min(endTime(), Math.max(startTime(), Number(wanted.get("t")) || startTime()));
  }
  listening = true;
  fit(); fitLine(); refresh();
  choose(match.robots.find(robot => robot.name === name) || match.robots.find(robot => robot.nodes.length) || match.robots[0] || null);
};
