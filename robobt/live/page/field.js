/* The picture of the field. */
import { $, buffer, clamp, colours } from "./base.js";
import { ABSENT, frameOf, lettersOf, match, state, valueAt } from "./match.js";
import { readingAt } from "./reading.js";

export const canvas = $("field");
const pen = canvas.getContext("2d");
/* scale: pixels a metre; x, y: what of the field lies in the middle of the picture. */
export const view = { width: 0, height: 0, whole: 1, scale: 1, zoom: 1, x: 0, y: 0, dpr: 1, worldWidth: 1, worldHeight: 1 };
const px = x => (x - view.x) * view.scale + view.width / 2, py = y => (view.y - y) * view.scale + view.height / 2;
export const look = (zoom, x, y) => {
  view.zoom = Math.min(8, Math.max(1, zoom)); view.scale = view.whole * view.zoom;
  view.x = clamp(x, (view.worldWidth - view.worldWidth / view.zoom) / 2); view.y = clamp(y, (view.worldHeight - view.worldHeight / view.zoom) / 2);
  canvas.style.cursor = view.zoom > 1 ? "grab" : "crosshair";
};

export const fit = () => {
  view.worldWidth = match.field.length + 2 * match.field.goal_line_margin; view.worldHeight = match.field.width + 2 * match.field.margin;
  const stage = canvas.parentElement;
  /* As high as the window leaves room below what else stands on the card. */
  const card = stage.parentElement, others = card.getBoundingClientRect().top + window.scrollY + card.offsetHeight - canvas.offsetHeight;
  const most = Math.max(220, (window.innerHeight - others - 24) * view.worldWidth / view.worldHeight);
  const wide = matchMedia("(max-width: 1020px)").matches ? stage.clientWidth : Math.min(stage.clientWidth, most);
  view.dpr = window.devicePixelRatio || 1;
  view.width = Math.max(60, Math.floor(wide)); view.whole = view.width / view.worldWidth;
  view.height = Math.round(view.worldHeight * view.whole); look(view.zoom, view.x, view.y);
  canvas.style.width = view.width + "px"; canvas.style.height = view.height + "px";
  canvas.width = Math.round(view.width * view.dpr); canvas.height = Math.round(view.height * view.dpr);
};
const drawField = () => {
  const F = match.field, s = view.scale, half = F.length / 2, wide = F.width / 2;
  pen.fillStyle = colours.apron; pen.fillRect(0, 0, view.width, view.height);
  const stripes = 2 * Math.round(F.length / 2);
  for (let i = 0; i < stripes; i++) {
    pen.fillStyle = i % 2 ? colours.grass : colours["grass-2"];
    pen.fillRect(px(-half + i * F.length / stripes), py(wide), F.length / stripes * s + (i + 1 < stripes ? 1 : 0), F.width * s);
  }
  for (const [side, team] of [[-1, "blue"], [1, "yellow"]]) {
    const left = px(side > 0 ? half : -half - F.goal_depth);
    pen.globalAlpha = .3; pen.fillStyle = colours[team];
    pen.fillRect(left, py(F.goal_width / 2), F.goal_depth * s, F.goal_width * s);
    pen.globalAlpha = 1; pen.strokeStyle = colours[team]; pen.lineWidth = Math.max(2, .03 * s); pen.lineJoin = "round";
    pen.beginPath();
    pen.moveTo(px(side * half), py(F.goal_width / 2)); pen.lineTo(px(side * (half + F.goal_depth)), py(F.goal_width / 2));
    pen.lineTo(px(side * (half + F.goal_depth)), py(-F.goal_width / 2)); pen.lineTo(px(side * half), py(-F.goal_width / 2));
    pen.stroke();
  }
  pen.strokeStyle = pen.fillStyle = colours.paint; pen.lineWidth = Math.max(1.2, .01 * s); pen.lineJoin = "miter";
  pen.strokeRect(px(-half), py(wide), F.length * s, F.width * s);
  pen.beginPath(); pen.moveTo(px(0), py(wide)); pen.lineTo(px(0), py(-wide));
  pen.moveTo(px(-half), py(0)); pen.lineTo(px(half), py(0)); pen.stroke();
  pen.beginPath(); pen.arc(px(0), py(0), F.center_radius * s, 0, 7); pen.stroke();
  for (const side of [-1, 1]) {
    const left = side > 0 ? half - F.defense_depth : -half;
    pen.strokeRect(px(left), py(F.defense_width / 2), F.defense_depth * s, F.defense_width * s);
  }
  pen.strokeStyle = colours.wall; pen.lineWidth = 3; pen.strokeRect(px(-view.worldWidth / 2), py(view.worldHeight / 2), view.worldWidth * s, view.worldHeight * s);
};
/* Positions between two frames, unless something was put somewhere else in between. */
const between = (rows, width, frame, share) => {
  const a = frame * width, x = rows[a], y = rows[a + 1];
  if (x === ABSENT) return null;
  const b = a + width;
  if (share <= 0 || frame + 1 >= match.frames || rows[b] === ABSENT || Math.hypot(rows[b] - x, rows[b + 1] - y) > 400)
    return { x: x / 1000, y: y / 1000, turn: rows[a + 2] / 1000 };
  let turn = (rows[b + 2] - rows[a + 2]) / 1000;
  if (turn > Math.PI) turn -= 2 * Math.PI; else if (turn < -Math.PI) turn += 2 * Math.PI;
  return { x: (x + share * (rows[b] - x)) / 1000, y: (y + share * (rows[b + 1] - y)) / 1000, turn: rows[a + 2] / 1000 + share * turn };
};
const drawTrail = (frame, here) => {
  const { ball } = match, from = frameOf(match.times[frame] - 1.6);
  pen.lineCap = "round"; pen.strokeStyle = colours.ball; pen.lineWidth = Math.max(1.6, .03 * view.scale);
  let x = here.x, y = here.y;
  for (let i = frame; i >= from; i--) {
    if (ball[4 * i] === ABSENT) break;
    const u = ball[4 * i] / 1000, v = ball[4 * i + 1] / 1000;
    if (Math.hypot(u - x, v - y) > .4) break;
    const share = (i - from + 1) / (frame - from + 1);
    pen.globalAlpha = .75 * share * share;
    pen.beginPath(); pen.moveTo(px(x), py(y)); pen.lineTo(px(u), py(v)); pen.stroke();
    x = u; y = v;
  }
  pen.globalAlpha = 1;
};
const doing = (robot, frame) => {
  const { marks, active } = readingAt(robot, frame);
  return marks[active] === "R" ? robot.nodes[active].name : "";
};
const drawRobot = (robot, at, frame, chosen) => {
  const s = view.scale, x = px(at.x), y = py(at.y), radius = robot.radius * s;
  const flags = valueAt(robot.flags, frame, 0);
  if (chosen) {
    pen.beginPath(); pen.arc(x, y, radius + Math.max(4, .05 * s), 0, 7);
    pen.strokeStyle = "#fff"; pen.lineWidth = 2; pen.stroke();
  }
  const open = Math.acos(Math.min(1, robot.mouth / robot.radius)), facing = -at.turn;
  pen.beginPath(); pen.arc(x, y, radius, facing + open, facing - open + 2 * Math.PI); pen.closePath();
  pen.fillStyle = colours[robot.team]; pen.fill();
  pen.strokeStyle = "rgba(0,0,0,.45)"; pen.lineWidth = Math.max(1, .008 * s); pen.lineJoin = "round"; pen.stroke();
  const bar = Math.max(2, .022 * s), front = robot.mouth * s - bar / 2, half = radius * Math.sin(open);
  pen.beginPath();
  pen.moveTo(x + front * Math.cos(facing) - half * Math.sin(facing), y + front * Math.sin(facing) + half * Math.cos(facing));
  pen.lineTo(x + front * Math.cos(facing) + half * Math.sin(facing), y + front * Math.sin(facing) - half * Math.cos(facing));
  pen.strokeStyle = flags & 1 ? colours.ball : colours.mouth; pen.lineWidth = bar; pen.lineCap = "butt"; pen.stroke();
  if (radius < 5.5) return;
  const size = Math.max(7, .115 * s);
  pen.font = `700 ${size}px Inter, system-ui, "DejaVu Sans", sans-serif`; pen.textAlign = "center"; pen.textBaseline = "middle";
  pen.fillStyle = robot.team === "blue" ? "#fff" : "#2c2200";
  const back = .014 * s;
  pen.fillText(String(robot.number), x - back * Math.cos(facing), y - back * Math.sin(facing) + size * .05);
};
/* Below the robot, or where no robot and no label is in the way: above, else further off. */
const drawLabel = (text, at, taken) => {
  const inside = Math.abs(at.x - view.x) * view.scale < view.width / 2 && Math.abs(at.y - view.y) * view.scale < view.height / 2;
  if (!text || !inside) return;
  pen.font = `500 11px Inter, system-ui, "DejaVu Sans", sans-serif`; pen.textAlign = "center"; pen.textBaseline = "middle";
  const shown = text.length > 28 ? text.slice(0, 27) + "…" : text, width = pen.measureText(shown).width + 10;
  const x = Math.min(view.width - width / 2 - 3, Math.max(width / 2 + 3, px(at.x)));
  const off = .09 * view.scale + 15, free = (y, others) => y > 9 && y < view.height - 9 && !others.some(other => Math.abs(other.y - y) < 9 + other.height / 2 && Math.abs(other.x - x) < (other.width + width) / 2);
  const spots = [off, -off, off + 18, -off - 18, off + 36, -off - 36].map(shift => py(at.y) + shift);
  const y = spots.find(spot => free(spot, taken)) ?? spots.find(spot => free(spot, taken.filter(other => other.label)));
  if (y === undefined) return;
  taken.push({ x, y, width, height: 18, label: true });
  pen.fillStyle = "rgba(8,16,22,.66)"; pen.beginPath(); pen.roundRect(x - width / 2, y - 8, width, 16, 5); pen.fill();
  pen.fillStyle = "#fff"; pen.fillText(shown, x, y + .5);
};
/* What a skill thought that is not asked any more is out of date. */
const asked = (robot, places, frame) => { const letters = lettersOf(robot, frame); return places.some(place => (letters[place] || "-") !== "-"); };
const judgedBy = (robot, frame) => {
  const line = valueAt(robot.judged, frame, null);
  return line && (!robot.judges.length || asked(robot, robot.judges, frame)) ? line : null;
};
/* The passes that a robot compares, the best one bold, each with its score. */
const outlined = (text, x, y, ink = "#fff") => {
  pen.font = `600 11px Inter, system-ui, "DejaVu Sans", sans-serif`; pen.textBaseline = "middle"; pen.textAlign = "center";
  pen.lineWidth = 3; pen.lineJoin = "round"; pen.strokeStyle = "rgba(8,16,22,.75)"; pen.fillStyle = ink;
  pen.strokeText(text, x, y); pen.fillText(text, x, y);
};
const drawCompared = (robot, frame, from) => {
  if (!asked(robot, robot.compares, frame)) return;
  const passes = valueAt(robot.compared, frame, []);
  if (passes.length) draws("passes");
  passes.map((pass, rank) => [pass, rank]).reverse().forEach(([[x, y, score], rank]) => {
    const u = px(robot.view * x), v = py(robot.view * y);
    pen.globalAlpha = rank ? .45 : .95; pen.strokeStyle = pen.fillStyle = "#fff"; pen.lineWidth = rank ? 1 : 2;
    pen.beginPath(); pen.moveTo(px(from.x), py(from.y)); pen.lineTo(u, v); pen.stroke();
    pen.beginPath(); pen.arc(u, v, 3, 0, 7); pen.fill();
    pen.globalAlpha = 1; outlined(score.toFixed(2), u, v - 10);
  });
};
/* What skills draw themselves, each layer in a colour of its own. */
const INKS = ["#7fe3ff", "#ffd166", "#ff9ad5", "#b9ff8a", "#ffb38a", "#c9b6ff", "#8affd8", "#ffffff"];
/* What was drawn at some time of this match; the page tells what it means. */
const drawn = new Set();
let drawnIn = null;
const draws = name => { drawn.add(name); };
export const drawnSoFar = () => drawn;
export const inkOf = layer => INKS[[...match.layers].sort().indexOf(layer) % INKS.length] || INKS[0];
const drawShape = ([layer, kind, x, y, u, v], side) => {
  const a = px(side * x), b = py(side * y);
  pen.strokeStyle = pen.fillStyle = inkOf(layer); pen.lineWidth = 1.5; pen.lineCap = "round";
  if (kind === "text") { outlined(u, a, b - 9, pen.fillStyle); return; }
  pen.beginPath();
  if (kind === "line") { pen.moveTo(a, b); pen.lineTo(px(side * u), py(side * v)); }
  else if (kind === "circle") pen.arc(a, b, u * view.scale, 0, 7);
  else { pen.moveTo(a - 4, b - 4); pen.lineTo(a + 4, b + 4); pen.moveTo(a - 4, b + 4); pen.lineTo(a + 4, b - 4); }
  pen.stroke();
};
const shapesOf = (changes, frame) => { const text = valueAt(changes, frame, ""); return text && text !== "[]" ? JSON.parse(text).filter(([layer]) => state.layers.has(layer)) : []; };
const drawDrawn = (frame, places) => {
  match.robots.forEach((robot, slot) => {
    if (!places[slot]) return;
    for (const shape of shapesOf(robot.drawn, frame)) drawShape(shape, robot.view);
    let row = 0;
    for (const known of robot.numbers.values()) {
      const value = state.layers.has(known.layer) ? valueAt(known, frame, null) : null;
      if (value !== null) outlined(`${known.name} ${Number(value.toPrecision(3))}`, px(places[slot].x), py(places[slot].y) + .14 * view.scale + 13 * ++row, inkOf(known.layer));
    }
  });
};
/* Whom a team marks, the opponents it fears by rank, and where its attacker is to meet the rolling ball. */
const PLANS = ["marking", "threats", "meeting"];
const drawPlans = (frame, places) => {
  const { robots } = match, placeOf = (team, number) => places[robots.findIndex(robot => robot.team === team && robot.number === Number(number))];
  for (const { team, changes } of match.plans) {
    const [marks, threats, meets] = valueAt(changes, frame, [{}, [], []]).map((each, i) => state.layers.has(PLANS[i]) ? each : []), others = team === "blue" ? "yellow" : "blue";
    pen.strokeStyle = colours[team]; pen.lineWidth = 2; pen.setLineDash([3, 4]);
    for (const [marker, marked] of Object.entries(marks || {})) {
      const a = placeOf(team, marker), b = placeOf(others, marked);
      if (a && b) { draws("marking"); pen.beginPath(); pen.moveTo(px(a.x), py(a.y)); pen.lineTo(px(b.x), py(b.y)); pen.stroke(); }
    }
    pen.setLineDash([]);
    const [number, x, y] = meets || [], attacker = robots.find(robot => robot.team === team && robot.number === number);
    const from = attacker && placeOf(team, number);
    if (from) {
      draws("meeting");
      const u = px(attacker.view * x), v = py(attacker.view * y);
      pen.beginPath(); pen.moveTo(px(from.x), py(from.y)); pen.lineTo(u, v); pen.stroke();
      pen.beginPath(); pen.moveTo(u - 5, v - 5); pen.lineTo(u + 5, v + 5); pen.moveTo(u - 5, v + 5); pen.lineTo(u + 5, v - 5); pen.stroke();
    }
    (threats || []).forEach((number, rank) => { const at = placeOf(others, number); if (at) draws("threats"), outlined(`!${rank + 1}`, px(at.x) + .13 * view.scale, py(at.y) - .13 * view.scale); });
  }
};
/* The goal line as robots judge it, red for no chance to green for a sure goal, with the lanes to it. */
const drawJudged = (robot, [reach, text], from) => {
  const F = match.field, chances = new Uint8Array(buffer(text)), count = chances.length;
  if (!count) return;
  draws("goal line");
  const side = robot.team === "blue" ? 1 : -1, x = px(side * F.length / 2), step = 2 * reach / 1000 / Math.max(1, count - 1);
  const deep = side * Math.min(F.goal_depth, .14) * view.scale, top = i => py(side * (i * step - reach / 1000 - step / 2));
  const shade = chance => `hsl(${1.25 * chance} 95% ${48 + .1 * chance}%)`;
  let best = 0;
  for (let i = 0; i < count;) {
    let j = i + 1;
    while (j < count && chances[j] === chances[i]) j++;
    if (chances[i] > chances[best]) best = i;
    pen.fillStyle = shade(chances[i]);
    pen.fillRect(x, Math.min(top(i), top(j)), deep, Math.abs(top(j) - top(i)) + .3);
    pen.globalAlpha = .1 + .004 * chances[i];
    pen.beginPath(); pen.moveTo(px(from.x), py(from.y)); pen.lineTo(x, top(i)); pen.lineTo(x, top(j)); pen.closePath(); pen.fill();
    pen.globalAlpha = 1; i = j;
  }
  let last = best;
  while (last + 1 < count && chances[last + 1] === chances[best]) last++;
  const y = (top(best) + top(last + 1)) / 2;
  pen.font = `600 11px Inter, system-ui, "DejaVu Sans", sans-serif`; pen.textBaseline = "middle"; pen.textAlign = side > 0 ? "right" : "left";
  pen.lineWidth = 3; pen.lineJoin = "round"; pen.strokeStyle = "rgba(8,16,22,.75)"; pen.fillStyle = "#fff";
  const at = x - 6 * side;
  pen.strokeText(chances[best] + " %", at, y); pen.fillText(chances[best] + " %", at, y);
};
export const drawMatch = () => {
  const { ball, games, robots, times } = match, N = match.frames;
  pen.setTransform(view.dpr, 0, 0, view.dpr, 0, 0);
  drawField();
  if (drawnIn !== match.robots) { drawnIn = match.robots; drawn.clear(); }
  if (!N) return;
  const frame = frameOf(state.time), gap = frame + 1 < N ? times[frame + 1] - times[frame] : 0;
  const share = gap > 0 ? Math.min(1, Math.max(0, (state.time - times[frame]) / gap)) : 0;
  const game = valueAt(games, frame, null);
  if (game && game.placement) {
    draws("placement");
    pen.beginPath(); pen.arc(px(game.placement[0]), py(game.placement[1]), .15 * view.scale, 0, 7);
    pen.setLineDash([4, 4]); pen.strokeStyle = colours.ball; pen.lineWidth = 1.5; pen.stroke(); pen.setLineDash([]);
  }
  const there = between(ball, 4, frame, share);
  if (there) drawTrail(frame, there);
  if (there && state.layers.has("goal line")) {
    const judging = robots.filter(robot => judgedBy(robot, frame));
    for (const robot of judging.includes(state.robot) ? [state.robot] : judging) drawJudged(robot, judgedBy(robot, frame), there);
  }
  const places = robots.map(robot => between(robot.rows, 4, frame, share));
  if (there && state.layers.has("passes")) for (const robot of robots) drawCompared(robot, frame, there);
  drawPlans(frame, places); drawDrawn(frame, places);
  robots.forEach((robot, slot) => { if (places[slot]) drawRobot(robot, places[slot], frame, robot === state.robot); });
  if (there) {
    const radius = Math.max(2.6, .0215 * view.scale), height = ball[4 * frame + 3] / 1000;
    if (height > 0) {
      /* In the air: its shadow lies where it is, the ball above that, nearer and so larger. */
      pen.beginPath(); pen.arc(px(there.x), py(there.y), radius, 0, 7);
      pen.fillStyle = "rgba(0,0,0,.45)"; pen.fill();
    }
    pen.beginPath(); pen.arc(px(there.x), py(there.y) - .5 * height * view.scale, radius * (1 + height), 0, 7);
    pen.fillStyle = colours.ball; pen.fill(); pen.strokeStyle = "rgba(60,20,0,.6)"; pen.lineWidth = 1; pen.stroke();
  }
  /* What cameras reported lies over what was made of it. */
  for (const shape of shapesOf(match.drawn, frame)) drawShape(shape, 1);
  /* The chosen robot's first: it is the one that is sure of its place. */
  const wide = .2 * view.scale, taken = places.filter(Boolean).map(place => ({ x: px(place.x), y: py(place.y), width: wide, height: wide, label: false }));
  if (state.robot) { const place = places[robots.indexOf(state.robot)]; if (place) drawLabel(doing(state.robot, frame), place, taken); }
  robots.forEach((robot, slot) => { if (places[slot] && state.labels && robot !== state.robot) drawLabel(doing(robot, frame), places[slot], taken); });
};

/* ---------------------------------------------------------------- pointing */
export const spotOf = event => [view.x + (event.offsetX - view.width / 2) / view.scale, view.y - (event.offsetY - view.height / 2) / view.scale];
/* The robot nearest to a spot, if there is one. */
export const robotAt = ([x, y]) => {
  if (!match.frames) return null;
  const frame = frameOf(state.time);
  let nearest = null, least = Math.max(.2, 16 / view.scale);
  for (const robot of match.robots) {
    if (robot.rows[4 * frame] === ABSENT) continue;
    const gap = Math.hypot(robot.rows[4 * frame] / 1000 - x, robot.rows[4 * frame + 1] / 1000 - y);
    if (gap < least) { nearest = robot; least = gap; }
  }
  return nearest;
};
