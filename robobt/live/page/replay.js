/* The page of a recording, which is in the page. */
import { $ } from "./base.js";
import { showLayers } from "./layers.js";
import { append, match, openMatch, state } from "./match.js";
import { buildFigures, buildHead, chip, outcomeChips } from "./panel.js";
import { start } from "./player.js";

const recording = JSON.parse($("recording").textContent);
openMatch(recording); append(recording);
buildHead(match.outcome === null ? [chip("cut off before its end", undefined, true)] : outcomeChips(match.outcome));
buildFigures(recording.figures);
for (const layer of match.layers) state.layers.add(layer);
showLayers();
start();
window.robobt = { match, state };
