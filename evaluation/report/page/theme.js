// Colours: those of the theme come from report.css, those of statuses and stages stand here.

const kStatusColours = {
  TRACKING: "#16a38a",
  DEGRADED: "#eaa221",
  DEAD_RECKONING: "#ee7623",
  UNMAPPED: "#8a6cf0",
  SUSPECT: "#d94fae",
  LOST: "#e0454f",
  RELOCALIZING: "#3d86f6",
  INITIALIZING: "#93a0b2",
  "NO CLAIM": "#b5bfcc",
};
const kStageColours = ["#2f6bff", "#12a594", "#f0a020", "#d94fae", "#8a6cf0", "#e8663d", "#6b9b2f",
  "#17a2c4", "#93a0b2"];
const kErrorRamp = ["#2f6bff", "#7a5cf5", "#d64fb0", "#f2633f", "#f7a11a"].map(parseColour);

const statusColour = (name) => kStatusColours[name] || "#93a0b2";

function parseColour(hex) {
  const bits = parseInt(hex.trim().slice(1), 16);
  return [bits >> 16, (bits >> 8) & 255, bits & 255];
}

function mix(a, b, share) {
  return [0, 1, 2].map((i) => Math.round(a[i] + share * (b[i] - a[i])));
}

function rampColour(ramp, share) {
  const place = Math.min(Math.max(share, 0), 1) * (ramp.length - 1);
  const below = Math.min(Math.floor(place), ramp.length - 2);
  return mix(ramp[below], ramp[below + 1], place - below);
}

const rgb = (colour, alpha = 1) => `rgb(${colour[0]} ${colour[1]} ${colour[2]} / ${alpha})`;

const theme = {
  listeners: [],
  colour(name) {
    return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  },
  set(name) {
    document.documentElement.dataset.theme = name;
    for (const listener of this.listeners) listener();
  },
  start() {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const wanted = location.hash.slice(1);
    const forced = wanted === "dark" || wanted === "light";
    document.documentElement.dataset.theme =
      forced ? wanted : system.matches ? "dark" : "light";
    if (!forced)
      system.addEventListener("change", () => this.set(system.matches ? "dark" : "light"));
    document.getElementById("theme").addEventListener("click", () =>
      this.set(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  },
};
