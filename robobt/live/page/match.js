/* The match that is shown: its ticks come in chunks, all at once or while it is played. */
import { buffer } from "./base.js";

export const ABSENT = -32768;
export const match = { frames: 0 };
/* What is shown of it, and where in time; follow: the newest tick, as it comes. */
export const state = { time: 0, playing: false, follow: false, speed: 1, robot: null, node: null, unlisted: new Set(), labels: false, layers: new Set(["goal line", "passes", "marking", "threats", "meeting"]), show: () => {} };

/* Values and the frames from which on they hold. */
const changes = () => ({ frames: [], values: [] });
export const indexAt = (sorted, wanted) => {
  let low = 0, high = sorted.length;
  while (low < high) { const middle = (low + high) >> 1; if (sorted[middle] <= wanted) low = middle + 1; else high = middle; }
  return low - 1;
};
export const valueAt = (changes, frame, missing) => {
  const index = indexAt(changes.frames, frame);
  return index < 0 ? missing : changes.values[index];
};
export const lettersOf = (robot, frame) => valueAt(robot.statuses, frame, "");

export const openMatch = header => {
  Object.assign(match, header, {
    frames: 0, times: new Float32Array(0), ball: new Int16Array(0), games: changes(), events: [],
    refereed: false, forgotten: { blue: 0, yellow: 0 },
    drawn: changes(), layers: match.layers || new Set(),
    plans: ["blue", "yellow"].map(team => ({ team, changes: changes() })),
    robots: header.robots.map(robot => ({
      team: robot.team, view: robot.view, number: robot.number, play: robot.play, radius: robot.radius, mouth: robot.mouth,
      name: `${robot.team} ${robot.number}`, rows: new Int16Array(0),
      flags: changes(), statuses: changes(), written: new Map(), numbers: new Map(), drawn: changes(), compared: changes(), judged: changes(), said: robot.tree.map(changes),
      compares: robot.tree.flatMap(([name, type], place) => type === "ChooseKick" ? [place] : []),
      judges: robot.tree.flatMap(([name, type], place) => type === "SelectShot" ? [place] : []),
      nodes: robot.tree.map(([name, type, kind, depth, glyph, detail, condition, path]) => ({ name, type, kind, depth, glyph, detail, condition, path })),
    })),
  });
};

const extended = (array, start, more) => {
  const needed = start + more.length;
  if (array.length < needed) {
    const roomier = new array.constructor(start ? 2 * needed : needed);
    roomier.set(array.subarray(0, start));
    array = roomier;
  }
  array.set(more, start);
  return array;
};
/* The changes of what has this name; such names are free text. */
const named = (known, name) => { if (!known.has(name)) known.set(name, changes()); return known.get(name); };
/* Flat pairs (frames since the change before, value). */
const extend = (changes, flat, frame, read) => {
  if (!flat) return;
  for (let i = 0; i < flat.length; i += 2) { frame += flat[i]; changes.frames.push(frame); changes.values.push(read ? read(flat[i + 1]) : flat[i + 1]); }
};
/* A whole chunk tells at its first frame all that holds then, as after a gap, or again of the newest one. */
export const append = chunk => {
  const { texts, letters } = chunk, times = new Float32Array(buffer(chunk.times));
  if (chunk.whole && match.frames && times[0] === endTime()) match.frames--;
  const start = match.frames;
  match.times = extended(match.times, start, times);
  match.ball = extended(match.ball, 4 * start, new Int16Array(buffer(chunk.ball)));
  match.frames += chunk.frames;
  chunk.robots.forEach((news, slot) => {
    const robot = match.robots[slot];
    robot.rows = extended(robot.rows, 4 * start, new Int16Array(buffer(news.rows)));
    extend(robot.flags, news.flags, start);
    extend(robot.statuses, news.statuses, start, place => letters[place]);
    for (let i = 0, frame = start, flat = news.written || []; i < flat.length; i += 2) {
      frame += flat[i];
      for (const [entry, value] of Object.entries(flat[i + 1])) { const known = named(robot.written, entry); known.frames.push(frame); known.values.push(value); }
    }
    if (chunk.whole) for (const known of robot.numbers.values()) { known.frames.push(start); known.values.push(null); }
    for (const [layer, name, flat] of news.numbers || []) extend(Object.assign(named(robot.numbers, `${layer}: ${name}`), { layer, name }), flat, start);
    extend(robot.drawn, news.drawn, start);
    extend(robot.compared, news.candidates, start);
    extend(robot.judged, news.goal_line, start, line => line && [line[0], texts[line[1]]]);
    if (chunk.whole) for (const said of robot.said) { said.frames.push(start); said.values.push(""); }
    const words = news.feedback || [];
    for (let i = 0, frame = start; i < words.length; i += 3) {
      frame += words[i];
      const said = robot.said[words[i + 1]];
      said.frames.push(frame); said.values.push(texts[words[i + 2]]);
    }
  });
  extend(match.drawn, chunk.drawn, start);
  for (const layer of chunk.layers || []) match.layers.add(layer);
  for (const { team, changes } of match.plans) extend(changes, chunk.plans[team], start);
  extend(match.games, chunk.games, start);
  match.refereed ||= (chunk.games || []).some((game, i) => i % 2 && (game.blue || game.yellow));
  for (const [time, kind, team, number, text] of chunk.events || []) match.events.push({ time, kind, team, number, text });
};

/* Forget the first frames; what holds from then on stays known. */
const shorten = (changes, count) => {
  const first = Math.max(0, indexAt(changes.frames, count));
  changes.frames = changes.frames.slice(first).map(frame => Math.max(0, frame - count));
  changes.values = changes.values.slice(first);
};
export const forget = count => {
  match.times.copyWithin(0, count, match.frames);
  match.ball.copyWithin(0, 4 * count, 4 * match.frames);
  for (const robot of match.robots) {
    robot.rows.copyWithin(0, 4 * count, 4 * match.frames);
    for (const each of [robot.flags, robot.statuses, robot.drawn, robot.compared, robot.judged, ...robot.said, ...robot.written.values(), ...robot.numbers.values()]) shorten(each, count);
  }
  for (const { changes } of match.plans) shorten(changes, count);
  shorten(match.games, count); shorten(match.drawn, count);
  match.frames -= count;
  const kept = match.events.findIndex(event => event.time >= match.times[0]);
  for (const event of match.events.splice(0, kept < 0 ? match.events.length : kept)) if (event.kind === "goal" && event.team) match.forgotten[event.team]++;
};

export const startTime = () => match.frames ? match.times[0] : 0;
export const endTime = () => match.frames ? match.times[match.frames - 1] : 0;
export const frameOf = time => {
  let low = 0, high = match.frames;
  while (low < high) { const middle = (low + high) >> 1; if (match.times[middle] <= time + 1e-4) low = middle + 1; else high = middle; }
  return Math.max(0, low - 1);
};
/* Without a referee nobody keeps the score; the goals themselves are events. */
export const scoreOf = (team, game) => match.refereed ? game ? game[team] : 0
  : match.forgotten[team] + match.events.filter(event => event.kind === "goal" && event.team === team && event.time <= state.time + 1e-3).length;
