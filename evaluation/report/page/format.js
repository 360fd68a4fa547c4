// Figures as people read them, in one unit for a whole axis.

const isKnown = (value) => value !== null && value !== undefined;

function threeDigits(value) {
  const size = Math.abs(value);
  return value.toFixed(size < 0.9995 ? 3 : size < 9.995 ? 2 : size < 99.95 ? 1 : 0);
}

function lengthText(metres) {
  if (!isKnown(metres)) return "–";
  if (Math.abs(metres) >= 0.09995) return threeDigits(metres) + " m";
  const mm = 1000 * metres;
  return mm.toFixed(Math.abs(mm) < 0.9995 ? 2 : 1) + " mm";
}

const angleText = (degrees) => (isKnown(degrees) ? threeDigits(degrees) + "°" : "–");
const shareText = (share) => (isKnown(share) ? (100 * share).toFixed(1) + " %" : "–");
const countText = (count) =>
  isKnown(count) ? Math.round(count).toString().replace(/\B(?=(\d{3})+$)/g, " ") : "–";
const msText = (ms) => (isKnown(ms) ? threeDigits(ms) + " ms" : "–");
const timeText = (seconds) =>
  (isKnown(seconds) ? (Math.abs(seconds) < 0.005 ? 0 : seconds).toFixed(2) + " s" : "–");

// A length axis in mm when all of it is small.
function lengthUnit(values) {
  const largest = Math.max(0, ...[percentile(values, 0.995)].filter(isKnown));
  return largest < 0.2 ? { factor: 1000, name: "mm" } : { factor: 1, name: "m" };
}

function percentile(values, share) {
  const known = values.filter(isKnown).sort((a, b) => a - b);
  return known.length ? known[Math.floor(share * (known.length - 1))] : null;
}

// The next 1, 2 or 5 times a power of ten, not above `value`.
function roundDown125(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const digit = value / power;
  return power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1);
}

function element(tag, className, text) {
  const node = document.createElement(tag);
  if (className) node.className = className;
  if (isKnown(text)) node.textContent = text;
  return node;
}
