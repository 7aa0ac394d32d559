/* What all of the page uses. */
export const $ = id => document.getElementById(id);
export const make = (tag, className, text) => {
  const element = document.createElement(tag);
  if (className) element.className = className;
  if (text !== undefined) element.textContent = text;
  return element;
};
export const put = (element, text) => { if (element.textContent !== text) element.textContent = text; };
export const buffer = text => {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes.buffer;
};
export const clamp = (value, most) => Math.min(most, Math.max(-most, value));
export const words = name => { const text = name.toLowerCase().replace(/_/g, " "); return text.charAt(0).toUpperCase() + text.slice(1); };
export const clock = time => {
  const sign = time < 0 ? "-" : "", centis = Math.round(Math.abs(time) * 100);
  const pad = n => String(n).padStart(2, "0");
  return `${sign}${Math.floor(centis / 6000)}:${pad(Math.floor(centis / 100) % 60)}.${pad(centis % 100)}`;
};
export const colours = {};
export const readColours = () => {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["ink", "card", "dim", "faint", "edge", "soft", "accent", "blue", "yellow", "ball", "run", "good", "bad", "idle", "grass", "grass-2", "apron", "paint", "wall", "mouth"])
    colours[name] = style.getPropertyValue("--" + name).trim();
};
