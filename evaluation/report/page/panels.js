// Everything but map and charts: the result in one line, cards, events, warnings, tables.

const tones = { good: "good", fair: "fair", bad: "bad", none: "none" };
const toneOf = (light) => `var(--${tones[light] || "none"})`;

function panel(title, className) {
  const node = element("section", `panel ${className || ""}`);
  const head = element("div", "panel-head");
  head.append(element("h2", "", title));
  node.append(head);
  return node;
}

function showVerdict(data) {
  document.getElementById("headline").textContent = data.verdict.headline;
  document.getElementById("sentence").textContent =
    data.verdict.sentence.replaceAll(" deg", "°");
  document.getElementById("run").textContent = data.title;
  document.getElementById("verdict-light").style.setProperty("--tone", toneOf(data.verdict.light));
}

// "1.9 mm" with a smaller unit.
function valueNode(text) {
  const node = element("div", "value");
  const split = /^(.*\d) (\S+)$/.exec(text);
  if (!split) {
    node.textContent = text;
    return node;
  }
  node.append(split[1], element("small", "", ` ${split[2] === "deg" ? "°" : split[2]}`));
  return node;
}

function showCards(data) {
  const place = document.getElementById("cards");
  for (const card of data.cards) {
    const node = element("div", "card");
    const label = element("div", "label", card.label);
    if (card.light !== "none") {
      const mark = element("i");
      mark.style.setProperty("--tone", toneOf(card.light));
      label.prepend(mark);
    }
    const note = element("div", "note", card.note.replaceAll(" deg", "°"));
    note.title = card.note;
    node.append(label, valueNode(card.value), note);
    place.append(node);
  }
}

function showFigures(data) {
  const place = document.getElementById("figures");
  for (const group of data.figures) {
    const node = panel(group.name);
    const table = element("table");
    for (const [label, value, meaning] of group.rows) {
      const row = table.insertRow();
      const cell = row.insertCell();
      cell.append(label);
      if (meaning) cell.append(element("small", "", meaning));
      row.insertCell().textContent = value.replace(/ deg\b/g, "°");
    }
    node.append(table);
    place.append(node);
  }
}

// What spoke for and against, and where else the robot might have been: for the chosen event.
function eventLines(event) {
  const node = element("ul", "event-lines");
  for (const line of event.lines || []) node.append(element("li", "", line));
  node.hidden = true;
  return node;
}

function eventRow(event, data, focus) {
  const row = element("button", "event");
  row.type = "button";
  const mark = element("i", event.source === "world" ? "world" : "");
  const status = event.name === "status" && /to (\w+)/.exec(event.text);
  mark.style.setProperty("--tone", status ? statusColour(status[1]) : eventColour(event));
  const text = element("span", "", event.text.replaceAll(" deg", "°"));
  text.prepend(element("b", "", event.name.replaceAll("_", " ")));
  row.append(element("time", "", timeText(event.t)), mark, text);
  row.addEventListener("click", () => {
    const index = data.scans.t.findIndex((t) => t >= event.t);
    focus.set(index < 0 ? data.scans.t.length - 1 : index);
    focus.setEvent(event);
  });
  if (!event.lines) return [row];
  const lines = eventLines(event);
  row.setAttribute("aria-expanded", "false");
  row.addEventListener("click", () => {
    lines.hidden = !lines.hidden;
    row.setAttribute("aria-expanded", String(!lines.hidden));
  });
  return [row, lines];
}

function eventsPanel(data, focus) {
  const node = panel("Events", "events-panel");
  const list = element("div", "events");
  for (const event of data.events) list.append(...eventRow(event, data, focus));
  node.append(list);
  theme.listeners.push(() => {
    list.replaceChildren(...data.events.flatMap((event) => eventRow(event, data, focus)));
  });
  return node;
}

function warningsPanel(data) {
  const node = panel(data.warnings.length === 1 ? "1 warning" : `${data.warnings.length} warnings`,
    "warnings-panel wide");
  const list = element("ul", "warnings");
  for (const warning of data.warnings) list.append(element("li", "", warning));
  node.append(list);
  return node;
}

function fillTooltip(node, scans, i) {
  const head = element("b", "", timeText(scans.t[i]));
  const table = element("table");
  const add = (label, value) => {
    const row = table.insertRow();
    row.insertCell().textContent = label;
    row.insertCell().textContent = value;
  };
  add("status", scans.statuses[scans.status[i]].replaceAll("_", " ").toLowerCase());
  const reason = scans.reasons[scans.reason[i]];
  if (reason) add("reason", reason);
  add("position", [scans.x[i], scans.y[i], scans.z[i]].map((v) => v.toFixed(3)).join("  ") + " m");
  add("yaw, pitch, roll",
    [scans.yaw[i], scans.pitch[i], scans.roll[i]].map((v) => v.toFixed(2) + "°").join("  "));
  if (scans.error_m && isKnown(scans.error_m[i]))
    add("error", `${lengthText(scans.error_m[i])}, ${angleText(scans.error_deg[i])}`);
  node.replaceChildren(head, table);
}

function showMapLegend(map) {
  const place = document.getElementById("map-legend");
  const { scans } = map;
  const key = (className, colour, text) => {
    const node = element("span", "key");
    const mark = element("i", className);
    mark.style.setProperty("--tone", colour);
    node.append(mark, text);
    return node;
  };
  const keys = [];
  if (map.mode === "error") {
    const ramp = key("ramp", "", "");
    ramp.firstElementChild.style.background =
      `linear-gradient(90deg, ${kErrorRamp.map((c) => rgb(c)).join(", ")})`;
    ramp.prepend("error 0");
    ramp.append(lengthText(map.errorTop));
    keys.push(ramp);
  } else {
    const shown = new Set(map.drawn.map((i) => scans.status[i]));
    for (const status of shown)
      keys.push(key("", statusColour(scans.statuses[status]),
        scans.statuses[status].replaceAll("_", " ").toLowerCase()));
  }
  if (map.data.truth) keys.push(key("dashed", "var(--truth)", "truth"));
  place.replaceChildren(...keys);
  place.hidden = keys.length === 0;
}

function showColourModes(map) {
  const place = document.getElementById("colour-modes");
  if (map.modes.length > 1) {
    for (const mode of map.modes) {
      const button = element("button", "", mode);
      button.type = "button";
      button.setAttribute("aria-pressed", String(mode === map.mode));
      button.addEventListener("click", () => {
        map.setMode(mode);
        for (const other of place.children)
          other.setAttribute("aria-pressed", String(other === button));
        showMapLegend(map);
      });
      place.append(button);
    }
  }
  showMapLegend(map);
}
