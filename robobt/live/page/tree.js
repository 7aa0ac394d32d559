/* The chosen robot's tree: the way to the active leaf is open, the rest folds, unless somebody folds it otherwise. */
import { $, make, put } from "./base.js";
import { state, valueAt } from "./match.js";
import { readingAt, reasonOf } from "./reading.js";
import { drawBase } from "./timeline.js";

let lines = [], folds = new Map(), whole = false, unfolded = null; /* unfolded: for which active leaf it is laid out */
const SVG = shape => `<svg viewBox="0 0 12 12" class="m-${shape[0]}"><path d="${shape[1]}"/></svg>`;
const MARKS = [["R", "M4.2 2.8 8.8 6 4.2 9.2z"], ["S", "M2.5 6.4 5 8.8 9.5 3.6"], ["F", "M3.2 3.2l5.6 5.6M8.8 3.2 3.2 8.8"], ["N", "M3 6h6"]].map(SVG).join("");
/* Whether a branch line has to go on below node i at this depth. */
const goesOn = (nodes, i, depth) => {
  for (let j = i + 1; j < nodes.length && nodes[j].depth >= depth; j++) if (nodes[j].depth === depth) return true;
  return false;
};
const below = (nodes, i) => {
  let j = i + 1;
  while (j < nodes.length && nodes[j].depth > nodes[i].depth) j++;
  return j - i - 1;
};
const pickNode = i => { state.node = state.node === i ? null : i; markNode(); drawBase(); state.show(); };
const rowOf = (nodes, i) => {
  const node = nodes[i], row = make("button", "row " + node.kind), inner = below(nodes, i);
  for (let depth = 1; depth <= node.depth; depth++) {
    const own = depth === node.depth, on = goesOn(nodes, i, depth);
    row.append(make("span", "bar" + (own ? " turn" + (on ? "" : " last") : on ? "" : " none")));
  }
  const mark = make("span", "mark"); mark.innerHTML = MARKS;
  const what = make("span", "what"), title = make("span", "title"), say = make("span", "say");
  if (node.glyph) title.append(make("span", "glyph", node.glyph + (node.detail === "memory" ? "*" : "")));
  title.append(make("span", "name", node.name));
  const told = node.kind === "composite" ? [] : [node.type === node.name ? "" : node.type, node.detail].filter(Boolean);
  if (told.length) title.append(make("span", "kind", told.join(" · ")));
  const fold = make("span", "fold");
  if (inner) { title.append(fold); fold.title = "Fold or unfold what is below"; }
  what.append(title, say); row.append(mark, what);
  row.title = [node.type, node.detail].filter(Boolean).join(", ");
  row.addEventListener("click", event => {
    if (event.target !== fold || !inner) { pickNode(i); return; }
    folds.set(i, lines[i].open);
    unfolded = null; state.show();
  });
  return { row, say, fold, inner, open: false, status: "", text: "" };
};
export const buildTree = () => {
  const robot = state.robot, tree = $("tree");
  tree.replaceChildren(); lines = []; folds = new Map(); unfolded = null;
  if (!robot || !robot.nodes.length) { tree.append(make("div", "note", robot ? "No tree was recorded for this robot." : "Select a robot.")); return; }
  lines = robot.nodes.map((_, i) => rowOf(robot.nodes, i));
  tree.append(...lines.map(entry => entry.row));
  markNode();
};
const markNode = () => {
  lines.forEach((entry, i) => entry.row.classList.toggle("chosen", i === state.node));
  if (state.node !== null) put($("strip"), state.robot.nodes[state.node].name);
  else unfolded = null;
};
export const showWhole = on => {
  whole = on; folds = new Map(); unfolded = null;
  $("whole").setAttribute("aria-pressed", String(on));
  state.show();
};
const layOut = (nodes, reading) => {
  let hidden = Infinity;
  lines.forEach((entry, i) => {
    const { row, fold, inner } = entry, { depth } = nodes[i];
    if (depth <= hidden) hidden = Infinity;
    row.hidden = depth > hidden;
    const open = whole ? !folds.get(i) : folds.has(i) ? !folds.get(i) : reading.path.has(i);
    entry.open = open; row.classList.toggle("active", i === reading.active);
    if (inner) put(fold, open ? "▾" : `▸ ${inner}`);
    if (!open && hidden === Infinity && inner) hidden = depth;
  });
};
const scrollTo = row => {
  const tree = $("tree"), top = row.offsetTop - tree.offsetTop;
  if (tree.matches(":hover") || (top >= tree.scrollTop && top + row.offsetHeight <= tree.scrollTop + tree.clientHeight)) return;
  tree.scrollTop = top - tree.clientHeight / 2;
};
export const showTree = frame => {
  const robot = state.robot, reading = readingAt(robot, frame), { marks, active } = reading;
  const fresh = lines.length && (unfolded === null || unfolded !== active);
  if (fresh) layOut(robot.nodes, reading);
  lines.forEach((entry, i) => {
    const status = marks[i] || "-";
    if (status !== entry.status) { entry.status = status; entry.row.dataset.s = status; }
    /* What is folded away tells here why it failed. */
    const failed = entry.inner && !entry.open && (status === "F" || status === "N");
    const text = status === "-" || entry.row.hidden ? "" : failed ? reasonOf(robot, i, frame) : valueAt(robot.said[i], frame, "");
    if (text !== entry.text) { entry.text = text; entry.say.textContent = text; }
  });
  if (!fresh) return;
  unfolded = active;
  if (state.node === null) put($("strip"), active < 0 ? "active leaf" : `active leaf, ${robot.nodes[active].name}`);
  if (active >= 0) scrollTo(lines[active].row);
};
