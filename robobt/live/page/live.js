/* The page of a match that is being played. */
import { $, clock, make, put, words } from "./base.js";
import { connect, on, send, VERSION } from "./link.js";
import { showLayers, wanted } from "./layers.js";
import { append, endTime, forget, frameOf, match, openMatch, startTime, state } from "./match.js";
import { buildFigures, buildHead, chip, choose } from "./panel.js";
import { delays, showDriving } from "./drive.js";
import { bridge, showSteering } from "./steering.js";
import { go, refresh, remote, showPlaying, showSpeed, start, toNow } from "./player.js";

/* Ticks that come slower than one in so many seconds are gone through evenly. */
const KEPT = 300, SLOW = .02;
/* How the match goes, as the server tells it. */
let now = { paused: false, speed: 1, steers: false, viewers: 1, over: null };
let header = null, link = "connecting";
/* Chunks that came before those of the past were all there. */
let past = null, later = null;
/* From a tick to its picture: times [ms] of the last ticks, for whoever measures. */
const measured = { painted: [], frames: 0, matches: 0, delays };
window.robobt = { measured, match, state };
let unpainted = [];

/* ---------------------------------------------------------------- what is said */
const told = make("div", "told");
told.setAttribute("role", "status");
let telling = 0;
export const say = text => {
  put(told, text);
  clearTimeout(telling);
  telling = setTimeout(() => put(told, ""), 6000);
};
export const act = message => {
  if (!now.steers) { say("Another viewer steers. Press “Steer” to do it here."); return false; }
  return send(message);
};

Object.assign(bridge, { act, say, now: () => now });
addEventListener("picked", event => choose(event.detail));

/* ---------------------------------------------------------------- controls */
const look = layers => send({ do: "layers", shown: layers });
/* What a recording holds is there to be seen, until it is switched off. */
let layered = 0;
const offerLayers = () => {
  if (!("span" in now)) return;
  for (const layer of now.layers || []) match.layers.add(layer);
  if (now.span && match.layers.size !== layered) for (const layer of match.layers) state.layers.add(layer);
  layered = match.layers.size;
  showLayers(look);
};
const control = (name, title, action) => {
  const button = make("button", "toggle", name);
  button.title = title;
  button.addEventListener("click", action);
  return button;
};
const nowButton = control("Now", "Back to the newest tick (End)", toNow);
const steerButton = control("Steer", "Let this page act on the match, and no other", () => send({ do: "steer" }));
const nextButton = control("Next seed", "Start the scenario anew with the next seed", () => act({ do: "reset" }));
const againButton = control("Again", "Start the scenario anew with the same seed", () => act({ do: "reset", next: false }));
const saveButton = make("a", "toggle", "Save recording");
saveButton.title = "Save what was seen, up to five minutes, as a recording";
saveButton.href = "recording.robobt.arrows";
/* Through a recording: the line of time is only of what was shown. */
const seek = make("label", "seek", "Go to"), seekTo = make("input"), seekAt = make("span");
seekTo.type = "range"; seekTo.step = "any";
seekTo.addEventListener("input", () => put(seekAt, clock(Number(seekTo.value))));
seekTo.addEventListener("change", () => act({ do: "seek", time: Number(seekTo.value) }));
seek.append(seekTo, seekAt);
const showHead = () => {
  const chips = [chip(link === "found" ? now.paused ? "paused" : "live" : link, undefined, link !== "found")];
  if (now.over) chips.push(chip("over", words(now.over).toLowerCase()));
  if (now.viewers > 1) chips.push(chip("viewers", String(now.viewers)));
  buildHead(chips);
};
const count = make("div", "count");
count.setAttribute("role", "status");
document.querySelector(".stage").append(count);
const showState = () => {
  state.delays = now.delays;
  put(count, now.countdown || ""); count.classList.toggle("words", (now.countdown || "").length > 2);
  showHead(); showSteering(now); showDriving(now); offerLayers();
  nowButton.hidden = state.follow;
  steerButton.setAttribute("aria-pressed", String(now.steers));
  seek.hidden = !now.span; nextButton.hidden = !(now.plays || []).length; againButton.hidden = nextButton.hidden && !now.span;
  if (now.span) [seekTo.min, seekTo.max] = now.span.map(String);
  seekTo.disabled = !now.steers;
  for (const button of [nextButton, againButton]) button.disabled = !now.steers;
  nextButton.setAttribute("aria-pressed", String(Boolean(now.over)));
  showPlaying(state.follow ? !now.paused : state.playing);
  showSpeed(state.follow ? now.speed : state.speed);
};
/* Without the wheel, to pause is to look at one moment while the match goes on. */
remote.toggle = () => now.steers ? send({ do: "pause", on: !now.paused }) : go(state.time);
remote.step = () => act({ do: "step" });
remote.setSpeed = speed => act({ do: "speed", factor: speed });
addEventListener("follow", showState);

/* ---------------------------------------------------------------- messages */
const open = () => {
  openMatch(header);
  for (const chunk of past || []) append(chunk);
  for (const chunk of later || []) append(chunk);
  start();
  if (state.follow) state.time = endTime();
  showState();
};
on("hello", message => {
  if (message.version !== VERSION) { link = "this page is out of date: load it anew"; showHead(); return; }
  if (!header) put(told, "");
  header = message; past = null; later = message.past ? [] : null; unpainted = [];
  if (message.past) send({ do: "past" });
  state.follow = true; measured.matches++;
  openMatch(header); buildFigures({}); start(); showState();
  if (state.layers.size) look(wanted());
});
on("now", message => {
  for (const chunk of message.chunks) {
    append(chunk);
    if (later) later.push(chunk);
  }
  if (match.layers.size !== layered) offerLayers();
  /* What stands in place of the newest frame is news too. */
  shownFrames = -1;
  came = performance.now();
  const last = message.chunks[message.chunks.length - 1];
  if (last) unpainted.push({ time: endTime(), at: last.at });
});
on("past", message => {
  past = [...past || [], ...message.chunks];
  if (!message.done) return;
  open();
  past = later = null;
});
let heard = 0;
on("state", message => {
  now = message;
  if (now.said && now.said[0] > heard) say(now.said[1]);
  heard = now.said ? now.said[0] : 0;
  showState();
});
on("refused", message => say(message.said));
on("found", () => {
  link = "found";
  /* A training shows nothing before its first evaluation, a field nothing before all is set up. */
  if (!header) setTimeout(() => { if (!header) put(told, "Nothing is played yet. This page shows it as soon as it is."); }, 500);
});
on("lost", () => { link = "connection lost"; if (header) showHead(); else say("The match is not there."); });

/* ---------------------------------------------------------------- time */
let came = 0, shownFrames = -1, refreshed = 0, listed = -1;
/* The newest tick at once; where there are more pictures than ticks, as in slow motion, all the way to it. */
const follow = time => {
  const end = endTime(), gap = match.frames > 1 ? end - match.times[match.frames - 2] : 0, lasts = gap / now.speed;
  const reached = lasts < SLOW || lasts > 1 || now.paused ? end : end - gap + Math.max(0, time - came) / 1000 * now.speed;
  state.time = Math.min(end, Math.max(state.time, reached));
};
const painted = () => {
  const time = performance.timeOrigin + performance.now();
  unpainted = unpainted.filter(each => {
    if (each.time > state.time + 1e-4) return true;
    measured.painted.push(time - each.at);
    return false;
  });
  measured.painted.splice(0, measured.painted.length - 2000);
};
const beat = time => {
  if (header && match.frames) {
    if (endTime() - startTime() > KEPT + 10) { forget(frameOf(endTime() - KEPT)); state.time = Math.max(state.time, startTime()); }
    const earlier = state.time;
    if (state.follow) follow(time);
    if (state.time !== earlier || shownFrames !== match.frames && state.follow) {
      shownFrames = match.frames;
      state.show();
      measured.frames++;
      setTimeout(painted);
    }
    if (time > refreshed + 250) { refreshed = time; if (listed !== match.frames) { listed = match.frames; refresh(); if (now.span && !seekTo.matches(":active")) { seekTo.value = String(endTime()); put(seekAt, clock(endTime())); } if (!state.playing) state.show(); } }
  }
  requestAnimationFrame(beat);
};

const group = make("div", "group live");
group.append(nowButton, steerButton, againButton, nextButton, saveButton, seek);
document.querySelector(".keys").insertBefore(group, document.querySelector(".hint"));
document.querySelector(".tools").append(told);
openMatch({ scenario: "", trial: 0, seed: "", robobt: "", teams: {}, robots: [], field: { length: 9, width: 6, margin: .3, goal_line_margin: .3, goal_width: 1, goal_depth: .18, center_radius: .5, defense_depth: 1, defense_width: 2 } });
connect();
requestAnimationFrame(beat);
