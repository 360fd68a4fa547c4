// Figures over time: thin wrappers of uPlot that share cursor, zoom, events and statuses.

// What is looked at: an index of a scan, and a range of time; everyone listens, everyone may set.
class Focus {
  constructor() {
    this.listeners = [];
    this.rangeListeners = [];
    this.eventListeners = [];
    this.index = null;
  }
  listen(listener) { this.listeners.push(listener); }
  listenRange(listener) { this.rangeListeners.push(listener); }
  listenEvent(listener) { this.eventListeners.push(listener); }
  set(index) {
    if (index === this.index) return;
    this.index = index;
    for (const listener of this.listeners) listener(index);
  }
  setEvent(event) {
    for (const listener of this.eventListeners) listener(event);
  }
  setRange(range) {
    for (const listener of this.rangeListeners) listener(range);
  }
}

// Events worth a line in every chart: not the changes of status, which the band shows.
const isMarked = (event) => event.name !== "status" && event.name !== "search";
const eventColour = (event) =>
  event.source === "world" ? theme.colour("accent")
    : event.name === "relocalized" ? theme.colour("good")
      : event.name === "status" ? theme.colour("faint") : theme.colour("bad");

// Neighbouring scans of one status: [first, last, status].
function statusRuns(scans) {
  const runs = [];
  scans.status.forEach((status, i) => {
    const run = runs[runs.length - 1];
    if (run && run[2] === status) run[1] = i;
    else runs.push([i, i, status]);
  });
  return runs;
}

function paintStatuses(plot, scans, runs, alpha) {
  const { ctx, bbox } = plot;
  const half = (scans.t[scans.t.length - 1] - scans.t[0]) / Math.max(scans.t.length - 1, 1) / 2;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  for (const [first, last, status] of runs) {
    const name = scans.statuses[status];
    if (alpha < 1 && name === "TRACKING") continue;
    const left = plot.valToPos(scans.t[first] - half, "x", true);
    const right = plot.valToPos(scans.t[last] + half, "x", true);
    ctx.globalAlpha = alpha;
    ctx.fillStyle = statusColour(name);
    ctx.fillRect(left, bbox.top, Math.max(right - left, 1), bbox.height);
  }
  ctx.restore();
}

function paintEvents(plot, events) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.lineWidth = devicePixelRatio;
  for (const event of events) {
    if (!isMarked(event)) continue;
    const at = Math.round(plot.valToPos(event.t, "x", true)) + 0.5;
    if (at < bbox.left || at > bbox.left + bbox.width) continue;
    ctx.strokeStyle = eventColour(event);
    ctx.setLineDash(event.source === "world" ? [] : [4 * devicePixelRatio, 3 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(at, bbox.top);
    ctx.lineTo(at, bbox.top + bbox.height);
    ctx.stroke();
  }
  ctx.restore();
}

// All charts of the page; they zoom and point together.
class ChartBoard {
  constructor(data, focus) {
    this.data = data;
    this.focus = focus;
    this.runs = statusRuns(data.scans);
    this.charts = [];
    this.whole = [data.scans.t[0], data.scans.t[data.scans.t.length - 1]];
    if (this.whole[1] <= this.whole[0]) this.whole[1] = this.whole[0] + 1;
    this.range = this.whole;
    focus.listen((index) => this.point(index));
    theme.listeners.push(() => this.rebuild());
  }

  add(chart) {
    this.charts.push(chart);
    chart.build(this);
    new ResizeObserver(() => chart.resize()).observe(chart.place);
  }

  rebuild() {
    for (const chart of this.charts) chart.build(this);
  }

  point(index) {
    for (const chart of this.charts) chart.point(index);
  }

  zoom(range) {
    this.range = range || this.whole;
    for (const chart of this.charts) chart.plot.setScale("x", { min: this.range[0],
      max: this.range[1] });
    this.focus.setRange(range);
  }
}

// One chart. `lines`: [{label, values, text, colour, axis: "y"|"y2", width, fill, shown}];
// `axes`: {y: {text}, y2: {text}}; `stacked` draws the lines on top of each other.
class Chart {
  constructor(panel, options) {
    this.options = options;
    this.place = element("div", "chart");
    this.keys = element("div", "keys");
    panel.querySelector(".panel-head").append(this.keys);
    panel.append(this.place);
  }

  build(board) {
    if (this.plot) this.plot.destroy();
    this.board = board;
    const { lines } = this.options;
    const data = [board.data.scans.t, ...(this.options.stacked ? stack(lines)
      : lines.map((line) => line.values))];
    this.plot = new uPlot(this.uplotOptions(board), data, this.place);
    this.plot.over.addEventListener("dblclick", () => board.zoom(null));
    this.showKeys(board.focus.index);
  }

  size() {
    return { width: Math.max(this.place.clientWidth, 50),
      height: Math.max(this.place.clientHeight, 40) };
  }

  resize() {
    this.plot.setSize(this.size());
  }

  uplotOptions(board) {
    const { lines, axes, band } = this.options;
    const scales = { x: { time: false, range: () => board.range } };
    for (const [name, axis] of Object.entries(axes))
      scales[name] = axis.log ? { distr: 3, range: axis.log } : { range: axisRange(axis) };
    return {
      ...this.size(),
      padding: [8, axes.y2 ? 0 : 14, 0, 0],
      legend: { show: false },
      scales,
      axes: [timeAxis(), ...Object.entries(axes).map(([name, axis]) => valueAxis(name, axis))],
      series: [{}, ...lines.map((line) => this.seriesOptions(line))],
      cursor: {
        y: false,
        points: { show: !band && !this.options.stacked, size: 7 },
        drag: { x: true, y: false, setScale: false },
      },
      hooks: {
        drawClear: [(plot) => paintStatuses(plot, board.data.scans, board.runs, band ? 1 : 0.1)],
        draw: [(plot) => paintEvents(plot, board.data.events)],
        setCursor: [(plot) => this.cursorMoved(plot)],
        setSelect: [(plot) => this.selected(plot)],
      },
    };
  }

  seriesOptions(line) {
    const colour = line.colour();
    return {
      scale: line.axis || "y",
      stroke: this.options.stacked ? undefined : colour,
      width: line.width || 1.5,
      dash: line.dash,
      fill: this.options.stacked ? colour : line.fill ? fade(colour, 0.14) : undefined,
      points: { show: false },
      spanGaps: false,
    };
  }

  cursorMoved(plot) {
    if (this.pointing || !plot.cursor.event) return;
    const outside = plot.cursor.left < 0;
    this.board.focus.set(outside || !isKnown(plot.cursor.idx) ? null : plot.cursor.idx);
  }

  selected(plot) {
    const { left, width } = plot.select;
    if (width < 4) return;
    const range = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
    this.board.zoom(range);
  }

  point(index) {
    this.pointing = true;
    const left = index === null ? -10
      : this.plot.valToPos(this.board.data.scans.t[index], "x");
    this.plot.setCursor({ left, top: 1 }, false);
    this.pointing = false;
    this.showKeys(index);
  }

  showKeys(index) {
    this.keys.replaceChildren();
    if (this.options.band) return this.showStatusKeys(index);
    if (index === null && this.options.note)
      this.keys.append(element("span", "note", this.options.note));
    const crowded = this.options.lines.length > 3;  // no room for labels and values at once
    for (const line of this.options.lines) {
      const key = element("span", "key");
      key.title = line.label;
      const mark = element("i");
      mark.style.setProperty("--tone", line.colour());
      key.append(mark);
      if (index === null || !crowded) key.append(line.label);
      if (index !== null) key.append(element("b", "", line.text(line.values[index])));
      this.keys.append(key);
    }
    return undefined;
  }

  showStatusKeys(index) {
    const { scans } = this.board.data;
    const shown = index === null ? scans.statuses.map((_, i) => i) : [scans.status[index]];
    for (const status of shown) {
      const key = element("span", "key");
      const mark = element("i");
      mark.style.setProperty("--tone", statusColour(scans.statuses[status]));
      key.append(mark, scans.statuses[status].replaceAll("_", " ").toLowerCase());
      const share = scans.status.filter((s) => s === status).length / scans.status.length;
      if (index === null) key.append(element("b", "", shareText(share)));
      else if (scans.reasons[scans.reason[index]]) key.append(scans.reasons[scans.reason[index]]);
      this.keys.append(key);
    }
  }
}

// From the whole sum down to the first stage, so that each fill covers what is below it.
function stack(lines) {
  const sum = new Array(lines[0].values.length).fill(0);
  const sums = [...lines].reverse().map((line) => line.values.map((value, i) =>
    (isKnown(value) ? (sum[i] += value) : sum[i])));
  return sums.reverse();
}

function fade(colour, alpha) {
  return `color-mix(in srgb, ${colour} ${Math.round(100 * alpha)}%, transparent)`;
}

// From zero (or `low`) to a little above the largest value; a few outliers may be cut off.
function axisRange(axis) {
  return (plot, min, max) => {
    if (!isKnown(max)) return [0, 1];
    const low = axis.low === undefined ? 0 : Math.min(axis.low, min);
    const high = axis.high === undefined ? max : axis.high;
    return [low, high > low ? low + (high - low) * (axis.high === undefined ? 1.12 : 1) : low + 1];
  };
}

const kAxisFont = "11.5px Inter, ui-sans-serif, system-ui, sans-serif";

function timeAxis() {
  return { stroke: theme.colour("faint"), font: kAxisFont, size: 26, gap: 3,
    grid: { show: false }, ticks: { show: false },
    values: (plot, values) => values.map((value, i) =>
      (i === values.length - 1 ? `${value} s` : `${value}`)) };
}

function powersOfTen([low, high]) {
  const count = Math.round(Math.log10(high / low));
  const step = Math.max(1, Math.ceil(count / 5));
  const powers = [];
  for (let i = 0; i <= count; i += step) powers.push(+(low * 10 ** i).toPrecision(1));
  return () => powers;
}

function valueAxis(name, axis) {
  return { scale: name, side: name === "y" ? 3 : 1, stroke: theme.colour("faint"),
    font: kAxisFont, size: 50, gap: 4,
    grid: { show: name === "y" && !axis.hidden, stroke: theme.colour("grid"), width: 1 },
    ticks: { show: false }, space: 34, splits: axis.log ? powersOfTen(axis.log) : undefined,
    values: (plot, values) => values.map((value) => (isKnown(value) ? axis.text(value) : "")) };
}
