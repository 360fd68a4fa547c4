// How the map panel is drawn: methods of MapPanel.

const mapDrawing = {
  drawBase() {
    const { width, height } = this.base;
    const context = this.base.getContext("2d");
    context.clearRect(0, 0, width, height);
    this.drawGrid(context);
    if (!this.points) return;
    const colours = {};
    for (const name of ["low", "high", "floor"])
      colours[name] = parseColour(theme.colour("map-" + name));
    const image = context.createImageData(width, height);
    const view = { u: (x) => this.u(x), v: (y) => this.v(y), scale: this.view.scale };
    paintPoints(this.points, view, image, width, height, colours);
    const layer = document.createElement("canvas");
    layer.width = width;
    layer.height = height;
    layer.getContext("2d").putImageData(image, 0, 0);
    context.drawImage(layer, 0, 0);
  },

  gridStep() {
    return roundDown125(190 * this.ratio / this.view.scale);
  },

  drawGrid(context) {
    const step = this.gridStep();
    const low = this.placeAt(0, this.base.height);
    const high = this.placeAt(this.base.width, 0);
    context.strokeStyle = theme.colour("grid");
    context.lineWidth = 1;
    context.beginPath();
    for (let x = Math.ceil(low.x / step) * step; x < high.x; x += step) {
      const u = Math.round(this.u(x)) + 0.5;
      context.moveTo(u, 0);
      context.lineTo(u, this.base.height);
    }
    for (let y = Math.ceil(low.y / step) * step; y < high.y; y += step) {
      const v = Math.round(this.v(y)) + 0.5;
      context.moveTo(0, v);
      context.lineTo(this.base.width, v);
    }
    context.stroke();
  },

  drawScaleBar() {
    const step = this.gridStep();
    const bar = document.getElementById("scale-bar");
    bar.firstElementChild.textContent = step < 1 ? `${Math.round(step * 100)} cm` : `${step} m`;
    bar.lastElementChild.style.width = `${(step * this.view.scale) / this.ratio}px`;
  },

  // Runs of scans that are claimed one after the other; a jump of over 2 m starts a new one.
  runs() {
    const runs = [];
    let last = -2;
    for (const i of this.drawn) {
      const jump = last === i - 1 ? Math.hypot(this.scans.x[i] - this.scans.x[last],
        this.scans.y[i] - this.scans.y[last]) : Infinity;
      const dt = last >= 0 ? this.scans.t[i] - this.scans.t[last] : 0;
      if (jump > Math.max(2, 40 * dt)) runs.push([]);
      runs[runs.length - 1].push(i);
      last = i;
    }
    return runs;
  },

  trace(context, run) {
    context.beginPath();
    for (const i of run) context.lineTo(this.u(this.scans.x[i]), this.v(this.scans.y[i]));
  },

  drawOverlay() {
    const context = this.overlay.getContext("2d");
    context.clearRect(0, 0, this.overlay.width, this.overlay.height);
    context.lineJoin = context.lineCap = "round";
    const runs = this.runs();
    this.drawTruth(context);
    context.strokeStyle = theme.colour("map-paper");
    context.lineWidth = 6 * this.ratio;
    for (const run of runs) {
      this.trace(context, run);
      context.stroke();
    }
    for (const run of runs) this.drawRun(context, run);
    this.drawEvents(context);
    this.drawEnds(context);
    this.drawCandidates(context);
    this.drawMarker(context);
  },

  // Of a search: the less likely, the paler.
  drawCandidates(context) {
    for (const candidate of [...this.candidates].reverse()) {
      const [u, v] = [this.u(candidate.x), this.v(candidate.y)];
      context.globalAlpha = 0.35 + 0.65 * (candidate.probability || 0);
      this.drawEnd(context, u, v, candidate.yaw);
      this.label(context, `${Math.round(100 * candidate.probability)} %`, u, v, 1);
    }
    context.globalAlpha = 1;
  },

  drawRun(context, run) {
    context.lineWidth = 3.4 * this.ratio;
    let from = 0;
    while (from < run.length) {
      const colour = this.colourOf(run[from]);
      const shown = this.isInRange(run[from]);
      let to = from + 1;
      while (to < run.length && this.colourOf(run[to]) === colour &&
        this.isInRange(run[to]) === shown) ++to;
      context.strokeStyle = colour;
      context.globalAlpha = shown ? 1 : 0.16;
      this.trace(context, run.slice(from, Math.min(to + 1, run.length)));
      context.stroke();
      from = to;
    }
    context.globalAlpha = 1;
  },

  isInRange(i) {
    return !this.range || (this.scans.t[i] >= this.range[0] && this.scans.t[i] <= this.range[1]);
  },

  drawTruth(context) {
    const { truth } = this.data;
    if (!truth) return;
    context.strokeStyle = theme.colour("truth");
    context.globalAlpha = 0.55;
    context.lineWidth = 1.1 * this.ratio;
    context.setLineDash([5 * this.ratio, 4 * this.ratio]);
    context.beginPath();
    let pen = false;
    truth.x.forEach((x, i) => {
      if (!isKnown(x)) pen = false;
      else if (pen) context.lineTo(this.u(x), this.v(truth.y[i]));
      else {
        context.moveTo(this.u(x), this.v(truth.y[i]));
        pen = true;
      }
    });
    context.stroke();
    context.setLineDash([]);
    context.globalAlpha = 1;
  },

  // Text beside a place: to its right (side 1) or left (-1), or the other way at the rim.
  label(context, text, u, v, wanted) {
    context.font = `600 ${12 * this.ratio}px Inter, system-ui, sans-serif`;
    context.textBaseline = "middle";
    const room = context.measureText(text).width + 14 * this.ratio;
    const fits = wanted > 0 ? u + room < this.overlay.width : u > room;
    const side = fits ? wanted : -wanted;
    context.textAlign = side < 0 ? "right" : "left";
    context.lineWidth = 4 * this.ratio;
    context.lineJoin = "round";
    context.strokeStyle = theme.colour("map-paper");
    context.fillStyle = theme.colour("ink");
    const at = u + side * 11 * this.ratio;
    context.strokeText(text, at, v);
    context.fillText(text, at, v);
  },

  drawEnds(context) {
    if (this.drawn.length === 0) return;
    const first = this.drawn[0];
    const last = this.drawn[this.drawn.length - 1];
    const place = (i) => [this.u(this.scans.x[i]), this.v(this.scans.y[i])];
    const [u0, v0] = place(first);
    const [u1, v1] = place(last);
    const second = this.drawn[Math.min(60, this.drawn.length - 1)];
    this.drawStart(context, u0, v0);
    this.drawEnd(context, u1, v1, this.scans.yaw[last]);
    const side = this.u(this.scans.x[second]) > u0 ? -1 : 1;
    const near = Math.hypot(u1 - u0, v1 - v0) < 60 * this.ratio;
    this.label(context, "start", u0, v0, side);
    const ahead = Math.cos((this.scans.yaw[last] * Math.PI) / 180) < -0.3 ? -1 : 1;
    this.label(context, "end", u1, v1, near ? -side : ahead);
  },

  drawStart(context, u, v) {
    context.beginPath();
    context.arc(u, v, 5.5 * this.ratio, 0, 2 * Math.PI);
    context.fillStyle = theme.colour("panel");
    context.fill();
    context.lineWidth = 2.4 * this.ratio;
    context.strokeStyle = theme.colour("ink");
    context.stroke();
  },

  // An arrow head that points where the body's x axis does.
  drawEnd(context, u, v, yaw) {
    const size = 8.5 * this.ratio;
    context.save();
    context.translate(u, v);
    context.rotate((-yaw * Math.PI) / 180);
    context.beginPath();
    context.moveTo(size, 0);
    context.lineTo(-0.8 * size, 0.75 * size);
    context.lineTo(-0.35 * size, 0);
    context.lineTo(-0.8 * size, -0.75 * size);
    context.closePath();
    context.lineWidth = 3 * this.ratio;
    context.strokeStyle = theme.colour("map-paper");
    context.stroke();
    context.fillStyle = theme.colour("ink");
    context.fill();
    context.restore();
  },

  drawEvents(context) {
    for (const event of this.data.events) {
      if (!isMarked(event)) continue;
      const i = this.claimAt(event.t);
      if (i === null) continue;
      const [u, v] = [this.u(this.scans.x[i]), this.v(this.scans.y[i])];
      const size = 6 * this.ratio;
      context.beginPath();
      context.moveTo(u, v - size);
      context.lineTo(u + size, v);
      context.lineTo(u, v + size);
      context.lineTo(u - size, v);
      context.closePath();
      context.fillStyle = eventColour(event);
      context.lineWidth = 2 * this.ratio;
      context.strokeStyle = theme.colour("panel");
      context.stroke();
      context.fill();
      this.label(context, event.name.replaceAll("_", " "), u, v, 1);
    }
  },

  // The claim nearest in time, within 1 s: later for what the run did, earlier for what was done.
  claimAt(t) {
    let best = null;
    let closest = 1;
    for (const i of this.drawn) {
      const distance = Math.abs(this.scans.t[i] - t);
      if (distance < closest) [best, closest] = [i, distance];
    }
    return best;
  },

  drawMarker(context) {
    if (!isKnown(this.marked) || !isKnown((this.scans.x || [])[this.marked])) return;
    const [u, v] = [this.u(this.scans.x[this.marked]), this.v(this.scans.y[this.marked])];
    context.beginPath();
    context.arc(u, v, 6 * this.ratio, 0, 2 * Math.PI);
    context.fillStyle = this.colourOf(this.marked);
    context.fill();
    context.lineWidth = 2.4 * this.ratio;
    context.strokeStyle = theme.colour("panel");
    context.stroke();
  },
};
