/* A person drives a robot: by keyboard, game controller or touch. */
import { $, make, put } from "./base.js";
import { state } from "./match.js";
import { bridge } from "./steering.js";

const DEADZONE = .12, CHARGE = 800, KICK_TIME = 300, ASSISTED_TIME = 1200, LEAST_KICK = .15;
/* From a key to its command [ms], for whoever measures. */
export const delays = [];
const settings = { frame: "field", kick: 6.5, assist: false };
const held = new Set(), sticks = { move: null, turn: null };
let robot = null, dribbler = false, charged = null, kicking = { until: 0, speed: 0 }, wasPressed = new Set(), toDrive = () => {};

/* ---------------------------------------------------------------- what is wanted */
const axis = (more, less) => (held.has(more) ? 1 : 0) - (held.has(less) ? 1 : 0);
const dead = value => Math.sign(value || 0) * Math.max(0, Math.abs(value || 0) - DEADZONE) / (1 - DEADZONE);
const padOf = () => [...(navigator.getGamepads ? navigator.getGamepads() : [])].find(pad => pad && pad.connected) || null;
const charge = on => {
  if (on && charged === null) charged = performance.now();
  if (on || charged === null) return;
  const share = Math.min(1, LEAST_KICK + (1 - LEAST_KICK) * (performance.now() - charged) / CHARGE);
  kicking = { until: performance.now() + (settings.assist ? ASSISTED_TIME : KICK_TIME), speed: share * settings.kick };
  charged = null;
};
const pressed = (pad, place, action) => {
  const down = Boolean(pad.buttons[place] && pad.buttons[place].pressed), was = wasPressed.has(place);
  if (down !== was) { action(down); if (down) wasPressed.add(place); else wasPressed.delete(place); }
};
const wanted = () => {
  const slow = held.has("shift") ? .3 : 1;
  /* On the picture x goes right and y up; in the robot's frame x is ahead and y its left. */
  let right = axis("d", "a") * slow, up = axis("w", "s") * slow, turn = axis("q", "e") * slow;
  const pad = padOf();
  if (pad) {
    right += dead(pad.axes[0]); up -= dead(pad.axes[1]); turn -= dead(pad.axes[2]);
    pressed(pad, 7, charge); pressed(pad, 0, charge);
    pressed(pad, 1, down => { if (down) dribbler = !dribbler; });
  }
  if (sticks.move) { right += sticks.move[0]; up += sticks.move[1]; }
  if (sticks.turn) turn -= sticks.turn[0];
  const most = value => Math.round(1000 * Math.min(1, Math.max(-1, value))) / 1000;
  const [vx, vy] = settings.frame === "field" ? [right, up] : [up, -right];
  return { vx: most(vx), vy: most(vy), omega: most(turn) };
};
const attentive = () => document.visibilityState === "visible" && document.hasFocus();
const send = () => {
  if (!robot) return;
  const speed = performance.now() < kicking.until ? kicking.speed : 0;
  bridge.act({ do: "drive", at: Math.round(performance.now()) / 1000, frame: settings.frame, assist: settings.assist, dribbler, kick: Math.round(100 * speed) / 100, ...wanted() });
};
const rest = () => {
  held.clear(); charged = null; sticks.move = sticks.turn = null;
  if (robot) bridge.act({ do: "rest" });
};
const beat = () => {
  if (!robot) return;
  if (attentive()) send();
  const strength = charged === null ? 0 : Math.min(1, LEAST_KICK + (1 - LEAST_KICK) * (performance.now() - charged) / CHARGE);
  put(meter, strength ? `kick ${(strength * settings.kick).toFixed(1)} m/s` : dribbler ? "dribbler on" : "");
  requestAnimationFrame(beat);
};

/* ---------------------------------------------------------------- keyboard, focus */
const KEYS = new Set(["w", "a", "s", "d", "q", "e", "shift"]);
addEventListener("keydown", event => {
  const key = event.key.toLowerCase();
  if (!robot || event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  if (key === "k") charge(true);
  else if (key === "f" && !event.repeat) dribbler = !dribbler;
  else if (!KEYS.has(key)) return;
  event.preventDefault();
  if (event.repeat) return;
  held.add(key); send();
  delays.push(performance.now() - event.timeStamp);
}, true);
addEventListener("keyup", event => {
  const key = event.key.toLowerCase();
  if (key === "k") charge(false);
  if (held.delete(key)) send();
}, true);
addEventListener("blur", rest);
addEventListener("pagehide", rest);
document.addEventListener("visibilitychange", () => { if (document.visibilityState !== "visible") rest(); });

/* ---------------------------------------------------------------- touch, buttons */
const stick = (name, label) => {
  const pad = make("div", "stick " + name, label);
  const at = event => {
    const box = pad.getBoundingClientRect(), half = box.width / 2;
    const x = (event.clientX - box.x - half) / half, y = (box.y + half - event.clientY) / half, size = Math.max(1, Math.hypot(x, y));
    sticks[name] = [x / size, y / size];
  };
  pad.addEventListener("pointerdown", event => { pad.setPointerCapture(event.pointerId); at(event); event.preventDefault(); });
  pad.addEventListener("pointermove", event => { if (sticks[name]) at(event); });
  for (const end of ["pointerup", "pointercancel"]) pad.addEventListener(end, () => { sticks[name] = null; });
  return pad;
};
const plain = (name, title) => { const button = make("button", "toggle", name); button.type = "button"; button.title = title; return button; };
const drive = plain("Drive", "Drive the chosen robot by keyboard, game controller or touch");
const frame = plain("Field frame", "Whether “up” is up on the picture or ahead of the robot");
const kick = plain("Kick", "Hold for a stronger kick (K, right trigger)");
const roll = plain("Dribbler", "Dribbler on or off (F, button B)");
const assist = plain("Pass assist", "A kick goes to the mate whom the robot about looks at, as fast as it takes");
assist.setAttribute("aria-pressed", "false");
assist.addEventListener("click", () => { settings.assist = !settings.assist; assist.setAttribute("aria-pressed", String(settings.assist)); });
const meter = make("span", "meter"), pads = make("div", "pads"), keys = make("div", "group driving");
const help = make("p", "dim", "W A S D drive, Q E turn, shift slowly, hold K to kick, F dribbler; or a game controller's sticks, right trigger and B.");
export const most = make("input");
most.type = "number"; most.min = "1"; most.max = "8"; most.step = "0.5"; most.value = "6.5"; most.title = "Strongest kick [m/s]";
most.setAttribute("aria-label", "Strongest kick in metres a second");
most.addEventListener("change", () => { settings.kick = Math.min(8, Math.max(1, Number(most.value) || 6.5)); });
drive.addEventListener("click", () => {
  if (robot) bridge.act({ do: "release" });
  else if (state.robot) bridge.act({ do: "take", robot: state.robot.name });
});
frame.addEventListener("click", () => {
  settings.frame = settings.frame === "field" ? "robot" : "field";
  put(frame, settings.frame === "field" ? "Field frame" : "Robot frame");
});
kick.addEventListener("pointerdown", event => { charge(true); event.preventDefault(); });
for (const end of ["pointerup", "pointercancel", "pointerleave"]) kick.addEventListener(end, () => charge(false));
roll.addEventListener("click", () => { dribbler = !dribbler; });
/* At the bottom of a phone's screen, below the field. */
const kicker = make("div", "stick kick", "kick");
kicker.addEventListener("pointerdown", event => { kicker.setPointerCapture(event.pointerId); charge(true); event.preventDefault(); });
for (const end of ["pointerup", "pointercancel"]) kicker.addEventListener(end, () => charge(false));
pads.append(stick("move", "move"), kicker, stick("turn", "turn"));
keys.append(drive, frame, kick, most, roll, assist, meter);
const card = document.querySelector(".steering");
card.append(keys, help, pads);

/* What the server says of who is driven; to somebody else's robot this page does nothing. */
export const showDriving = now => {
  const driven = now.steers ? now.driven || null : null;
  drive.disabled = !now.steers; drive.hidden = !(now.plays || []).length;
  drive.setAttribute("aria-pressed", String(Boolean(driven)));
  put(drive, driven ? "Let go" : "Drive");
  for (const each of [frame, kick, most, roll, assist, pads, help]) each.hidden = !driven;
  if (driven && !robot && matchMedia("(pointer: coarse)").matches) $("field").scrollIntoView();
  if (driven && !robot) { dribbler = false; held.clear(); requestAnimationFrame(beat); }
  robot = driven;
};
