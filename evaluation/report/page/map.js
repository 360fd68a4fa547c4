// The trajectory over the map from above: own canvases, drag to move, wheel to zoom.

class MapPanel {
  constructor(data, focus) {
    this.data = data;
    this.scans = data.scans;
    this.focus = focus;
    this.root = document.getElementById("map");
    this.base = this.root.querySelector(".base");
    this.overlay = this.root.querySelector(".overlay");
    this.tooltip = document.getElementById("tooltip");
    this.points = data.map ? classifyPoints(decodePoints(data.map)) : null;
    this.drawn = (this.scans.x || []).map((x, i) => (isKnown(x) ? i : -1)).filter((i) => i >= 0);
    this.range = null;
    this.candidates = [];  // of the search that is looked at
    this.view = { x: 0, y: 0, scale: 1 };
    this.chooseColours();
    this.listen();
    this.resize();
  }

  chooseColours() {
    const errors = this.scans.error_m;
    const calm = new Set(this.drawn.map((i) => this.scans.status[i])).size <= 1 &&
      this.drawn.length === this.scans.t.length - (this.drawn[0] || 0);
    const usual = 20 * percentile(errors || [], 0.5);  // so that outliers do not flatten the rest
    this.errorTop = errors ? Math.min(percentile(errors, 0.99), usual) || 1e-6 : null;
    this.mode = errors && calm ? "error" : "status";
    this.modes = errors ? ["status", "error"] : ["status"];
  }

  // Device pixels of a place in the map; y points up.
  u(x) { return (x - this.view.x) * this.view.scale + this.base.width / 2; }
  v(y) { return (this.view.y - y) * this.view.scale + this.base.height / 2; }

  resize() {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(this.root.clientWidth * ratio));
    const height = Math.max(1, Math.round(this.root.clientHeight * ratio));
    if (width === this.base.width && height === this.base.height) return;
    for (const canvas of [this.base, this.overlay]) Object.assign(canvas, { width, height });
    this.ratio = ratio;
    if (!this.moved) this.fit();
    this.drawNow();  // setting the size has cleared the canvas
  }

  // Everything that was driven, and the map around it without its stray points: [low, high] of x
  // and of y.
  extent() {
    const own = this.drawn.filter((_, k) => k % 5 === 0);
    const truth = this.data.truth || { x: [], y: [] };
    const span = (axis) => {
      const way = own.map((i) => this.scans[axis][i]).concat(truth[axis].filter(isKnown));
      const points = this.points ? Array.from(this.points[axis].filter((_, k) => k % 7 === 0)) : [];
      const low = [percentile(points, 0.003), ...way].filter(isKnown);
      const high = [percentile(points, 0.997), ...way].filter(isKnown);
      if (low.length === 0) return [0, 1];
      return [low.reduce((a, b) => Math.min(a, b)), high.reduce((a, b) => Math.max(a, b))];
    };
    return [span("x"), span("y")];
  }

  // Width by height of what there is to see.
  aspect() {
    const [x, y] = this.extent();
    return (x[1] - x[0]) / Math.max(y[1] - y[0], 1e-3);
  }

  fit() {
    const [x, y] = this.extent();
    const border = 34 * this.ratio;
    const foot = 26 * this.ratio;
    const { width, height } = this.base;
    const scale = Math.min((width - 2 * border) / Math.max(x[1] - x[0], 1),
      (height - 2 * border - foot) / Math.max(y[1] - y[0], 1));
    this.view = { scale: Math.max(scale, 1e-3), x: (x[0] + x[1]) / 2, y: (y[0] + y[1]) / 2 };
    this.view.y -= foot / 2 / this.view.scale;
    this.moved = false;
  }

  zoom(factor, u = this.base.width / 2, v = this.base.height / 2) {
    const before = this.placeAt(u, v);
    this.view.scale = Math.min(Math.max(this.view.scale * factor, 0.05), 5000);
    const after = this.placeAt(u, v);
    this.view.x += before.x - after.x;
    this.view.y += before.y - after.y;
    this.moved = true;
    this.draw();
  }

  placeAt(u, v) {
    return { x: this.view.x + (u - this.base.width / 2) / this.view.scale,
      y: this.view.y - (v - this.base.height / 2) / this.view.scale };
  }

  listen() {
    new ResizeObserver(() => this.resize()).observe(this.root);
    theme.listeners.push(() => this.draw());
    this.focus.listen((index) => this.showFocus(index));
    this.focus.listenEvent((event) => {
      this.candidates = event.candidates || [];
      this.draw();
    });
    this.focus.listenRange((range) => {
      this.range = range;
      this.draw();
    });
    this.root.addEventListener("wheel", (event) => {
      event.preventDefault();
      const [u, v] = this.pixel(event);
      this.zoom(Math.exp(-event.deltaY * 0.0016), u, v);
    }, { passive: false });
    this.root.addEventListener("pointerdown", (event) => {
      if (event.target.closest("button")) return;
      this.drag = this.pixel(event);
      this.root.setPointerCapture(event.pointerId);
      this.root.classList.add("dragging");
    });
    this.root.addEventListener("pointermove", (event) => this.pointerMoved(event));
    this.root.addEventListener("pointerup", () => this.release());
    this.root.addEventListener("pointercancel", () => this.release());
    this.root.addEventListener("pointerleave", () => this.focus.set(null));
    this.root.addEventListener("dblclick", (event) => {
      if (!event.target.closest("button")) this.showAll();
    });
    this.root.addEventListener("keydown", (event) => this.keyPressed(event));
    for (const button of this.root.querySelectorAll(".map-buttons button")) {
      const factor = Number(button.dataset.zoom);
      button.addEventListener("click", () => (factor ? this.zoom(factor) : this.showAll()));
    }
  }

  showAll() {
    this.fit();
    this.draw();
  }

  keyPressed(event) {
    const step = 60 * this.ratio / this.view.scale;
    const moves = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step],
      ArrowDown: [0, -step] };
    if (event.key === "+" || event.key === "=") return this.zoom(1.3);
    if (event.key === "-") return this.zoom(1 / 1.3);
    if (event.key === "0") return this.showAll();
    if (!moves[event.key]) return undefined;
    event.preventDefault();
    this.view.x += moves[event.key][0];
    this.view.y += moves[event.key][1];
    this.moved = true;
    return this.draw();
  }

  pixel(event) {
    const box = this.root.getBoundingClientRect();
    return [(event.clientX - box.left) * this.ratio, (event.clientY - box.top) * this.ratio];
  }

  pointerMoved(event) {
    const [u, v] = this.pixel(event);
    if (!this.drag) return this.focus.set(this.nearest(u, v));
    this.view.x -= (u - this.drag[0]) / this.view.scale;
    this.view.y += (v - this.drag[1]) / this.view.scale;
    this.drag = [u, v];
    this.moved = true;
    return this.draw();
  }

  release() {
    this.drag = null;
    this.root.classList.remove("dragging");
  }

  nearest(u, v) {
    let best = null;
    let closest = (26 * this.ratio) ** 2;
    for (const i of this.drawn) {
      const distance = (this.u(this.scans.x[i]) - u) ** 2 + (this.v(this.scans.y[i]) - v) ** 2;
      if (distance < closest) [best, closest] = [i, distance];
    }
    return best;
  }

  setMode(mode) {
    this.mode = mode;
    this.draw();
  }

  colourOf(i) {
    if (this.mode === "status") return statusColour(this.scans.statuses[this.scans.status[i]]);
    const error = this.scans.error_m[i];
    return isKnown(error) ? rgb(rampColour(kErrorRamp, error / this.errorTop)) : "#93a0b2";
  }

  draw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    if (this.waiting) cancelAnimationFrame(this.waiting);
    this.waiting = null;
    this.drawBase();
    this.drawOverlay();
    this.drawScaleBar();
  }

  showFocus(index) {
    this.marked = index;
    this.drawOverlay();
    const shown = index !== null && isKnown((this.scans.x || [])[index]);
    this.tooltip.hidden = !shown;
    if (!shown) return;
    fillTooltip(this.tooltip, this.scans, index);
    const u = this.u(this.scans.x[index]) / this.ratio;
    const v = this.v(this.scans.y[index]) / this.ratio;
    const { offsetWidth, offsetHeight } = this.tooltip;
    const left = u + 18 + offsetWidth > this.root.clientWidth ? u - 18 - offsetWidth : u + 18;
    const top = Math.min(Math.max(v - offsetHeight / 2, 8),
      this.root.clientHeight - offsetHeight - 8);
    this.tooltip.style.transform = `translate(${Math.max(left, 8)}px, ${top}px)`;
  }
}

Object.assign(MapPanel.prototype, mapDrawing);
