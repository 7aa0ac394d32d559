/* Which layers are shown: what is known of every match, and what skills draw themselves. */
import { $, make } from "./base.js";
import { drawMatch, drawnSoFar, fit, inkOf } from "./field.js";
import { match, state } from "./match.js";

/* What is known of every match, its sign on the field and what that means. */
const MEANS = {
  "goal line": ["▮", "colour of the goal line: chance that a shot there scores, red none, green sure"],
  "passes": ["─", "passes that are compared, each with its score; the best one bold"],
  "marking": ["╌╌", "from a defender to the opponent it marks"],
  "threats": ["!1", "most dangerous opponent, !2 the next"],
  "meeting": ["×", "where the robot will meet the rolling ball"],
};
const PLACEMENT = ["◌", "where the ball is to be placed"];
const KNOWN = Object.keys(MEANS);
const menu = make("details", "menu"), list = make("div", "choices");
const title = make("summary", "toggle", "Layers");
title.title = "What is drawn on the field";
menu.append(title, list);
$("labels").after(menu);
let shown = "";

/* Below the field: what the signs mean that were drawn so far and are not switched off. */
let explained = "";
export const explainDrawn = () => {
  const drawn = drawnSoFar(), told = KNOWN.filter(name => drawn.has(name) && state.layers.has(name)).map(name => MEANS[name]);
  if (drawn.has("placement")) told.push(PLACEMENT);
  const own = [...match.layers].filter(name => !KNOWN.includes(name) && state.layers.has(name)).sort();
  const text = [...told, ...own].join("\n");
  if (text === explained) return;
  explained = text;
  $("drawn").replaceChildren(...told.map(([sign, means]) => { const entry = make("span"); entry.append(make("b", "", sign), means); return entry; }), ...own.map(name => {
    const entry = make("span", "", name), ink = make("i");
    ink.style.background = inkOf(name); entry.prepend(ink);
    return entry;
  }));
  fit(); drawMatch();
};
/* The layers that skills are to draw. */
export const wanted = () => [...state.layers].filter(name => match.layers.has(name));
/* Offer the layers that there are; chosen is called with those of skills whenever one is switched. */
export const showLayers = (chosen = () => {}) => {
  const names = [...KNOWN, ...[...match.layers].filter(name => !KNOWN.includes(name)).sort()];
  if (shown === names.join("\n")) return;
  shown = names.join("\n");
  list.replaceChildren(...names.map(name => {
    const label = make("label"), box = make("input"), ink = make("i");
    box.type = "checkbox"; box.checked = state.layers.has(name); box.name = name;
    if (!KNOWN.includes(name)) ink.style.background = inkOf(name);
    box.addEventListener("change", () => {
      if (box.checked) state.layers.add(name); else state.layers.delete(name);
      chosen(wanted()); drawMatch(); explainDrawn();
    });
    if (MEANS[name]) label.title = MEANS[name].join(" ");
    label.append(box, ink, make("span", "", name));
    return label;
  }));
};
