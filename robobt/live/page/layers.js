/* Which layers are shown: what is known of every match, and what skills draw themselves. */
import { $, make } from "./base.js";
import { drawMatch, inkOf } from "./field.js";
import { match, state } from "./match.js";

const KNOWN = ["goal line", "passes", "marking", "threats", "meeting"];
const menu = make("details", "menu"), list = make("div", "choices");
const title = make("summary", "toggle", "Layers");
title.title = "What is drawn on the field";
menu.append(title, list);
$("labels").after(menu);
let shown = "";

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
      chosen(wanted()); drawMatch();
    });
    label.append(box, ink, make("span", "", name));
    return label;
  }));
};
