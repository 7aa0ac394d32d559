/* What the statuses of a robot's nodes come to: which leaf is active, and which failures are only guards that do not hold. */
import { lettersOf, valueAt } from "./match.js";

const MOST = 4000, known = new WeakMap();
const parentsOf = nodes => {
  const open = [];
  return nodes.map((node, i) => { open[node.depth] = i; return node.depth ? open[node.depth - 1] : -1; });
};
const read = (nodes, parents, letters) => {
  const marks = [...letters], faulty = nodes.map(() => false), path = new Set();
  let running = -1, last = -1;
  for (let i = nodes.length - 1; i >= 0; i--) {
    const { kind, condition } = nodes[i], leaf = kind === "leaf";
    if (leaf && running < 0 && marks[i] === "R") running = i;
    if (leaf && last < 0 && marks[i] === "S") last = i;
    if (marks[i] === "F" && leaf && !condition) faulty[i] = true;
    if (faulty[i] && parents[i] >= 0) faulty[parents[i]] = true;
    /* It fails because something in it does not hold, not because anything went wrong. */
    if (marks[i] === "F" && !faulty[i]) marks[i] = "N";
  }
  const active = running < 0 ? last : running;
  for (let i = active; i > 0; i = parents[i]) path.add(parents[i]);
  return { marks, active, path };
};
/* marks: a letter a node, N for one that does not hold; active: the leaf that acts, -1 without; path: the nodes above it. */
export const readingOf = (robot, letters) => {
  let own = known.get(robot);
  if (!own || own.readings.size > MOST) known.set(robot, own = { parents: parentsOf(robot.nodes), readings: new Map() });
  let reading = own.readings.get(letters);
  if (!reading) own.readings.set(letters, reading = read(robot.nodes, own.parents, letters));
  return reading;
};
/* Why a branch failed: what went wrong in it, last the leaf that decided it, found by the last child that failed. */
export const reasonOf = (robot, place, frame) => {
  const { nodes } = robot, letters = lettersOf(robot, frame), wrong = [];
  let decided = place;
  for (let i = place + 1; i < nodes.length && nodes[i].depth > nodes[place].depth; i++) if (letters[i] === "F" && nodes[i].kind === "leaf" && !nodes[i].condition) wrong.push(i);
  for (let found = place; found >= 0;) {
    decided = found; found = -1;
    for (let i = decided + 1; i < nodes.length && nodes[i].depth > nodes[decided].depth; i++) if (nodes[i].depth === nodes[decided].depth + 1 && letters[i] === "F") found = i;
  }
  return [...wrong.filter(i => i !== decided), decided].map(i => {
    const said = valueAt(robot.said[i], frame, "");
    return i === place ? said : `${nodes[i].name}${said ? `: ${said}` : nodes[i].condition ? " does not hold" : " failed"}`;
  }).join(" · ");
};
export const readingAt = (robot, frame) => readingOf(robot, lettersOf(robot, frame) || "-".repeat(robot.nodes.length));
