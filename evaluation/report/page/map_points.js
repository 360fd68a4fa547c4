// The map's points, and which of them are floor or ceiling.

// Undoes map_points_json of map_points.cpp.
function decodePoints(map) {
  const text = atob(map.xyz);
  const n = map.count;
  const points = { n, x: new Float32Array(n), y: new Float32Array(n), z: new Float32Array(n) };
  const read = (i, axis) => {
    const at = 6 * i + 2 * axis;
    const integer = text.charCodeAt(at) | (text.charCodeAt(at + 1) << 8);
    return map.min[axis] + map.step[axis] * integer;
  };
  for (let i = 0; i < n; ++i) {
    points.x[i] = read(i, 0);
    points.y[i] = read(i, 1);
    points.z[i] = read(i, 2);
  }
  return points;
}

// Height of the ground and of the ceiling around each cell of `size` metres: the 5 and 95 %
// heights of a cell, then the lowest and highest of it and its eight neighbours.
function heightCells(points, size) {
  const cells = new Map();
  const key = (i, j) => i * 65536 + j;
  for (let k = 0; k < points.n; ++k) {
    const place = key(Math.floor(points.x[k] / size), Math.floor(points.y[k] / size));
    if (!cells.has(place)) cells.set(place, []);
    cells.get(place).push(points.z[k]);
  }
  const own = new Map();
  for (const [place, heights] of cells) {
    heights.sort((a, b) => a - b);
    const last = heights.length - 1;
    own.set(place, [heights[Math.floor(0.05 * last)], heights[Math.ceil(0.95 * last)]]);
  }
  const around = new Map();
  for (const place of own.keys()) {
    let low = Infinity;
    let high = -Infinity;
    for (const shift of [-65537, -65536, -65535, -1, 0, 1, 65535, 65536, 65537]) {
      const cell = own.get(place + shift);
      if (!cell) continue;
      low = Math.min(low, cell[0]);
      high = Math.max(high, cell[1]);
    }
    around.set(place, [low, high]);
  }
  const at = (x, y) => around.get(key(Math.floor(x / size), Math.floor(y / size)));
  return { count: own.size, at };
}

// Typical distance between the points of one kind, seen from above.
function spacing(points, kind, cell) {
  const cells = new Set();
  let count = 0;
  for (let k = 0; k < points.n; ++k) {
    if (points.kind[k] !== kind) continue;
    cells.add(Math.floor(points.x[k] / cell) * 65536 + Math.floor(points.y[k] / cell));
    ++count;
  }
  return count > 0 ? Math.sqrt((cells.size * cell * cell) / count) : cell;
}

// Adds `kind` (0 floor, 1 structure, 2 ceiling), `rise` (0 to 1, height above the ground by the
// typical height of what stands there) and `spacing_m` of floor and structure. A ceiling needs
// 1.8 m of room below it.
function classifyPoints(points) {
  let size = 2;
  let cells = heightCells(points, size);
  while (points.n / cells.count < 25 && size < 64) cells = heightCells(points, (size *= 2));
  points.kind = new Uint8Array(points.n);
  points.rise = new Float32Array(points.n);
  const heights = [];
  for (let k = 0; k < points.n; ++k) {
    const [low, high] = cells.at(points.x[k], points.y[k]);
    const height = points.z[k] - low;
    const isCeiling = high - low > 1.8 && points.z[k] > high - 0.25;
    points.kind[k] = height < 0.25 ? 0 : isCeiling ? 2 : 1;
    points.rise[k] = height;
    if (points.kind[k] === 1) heights.push(height);
  }
  const tall = Math.max(percentile(heights, 0.97) || 1, 0.5);
  for (let k = 0; k < points.n; ++k) points.rise[k] = Math.min(points.rise[k] / tall, 1);
  points.spacing_m = [0, 1].map((kind) => spacing(points, kind, size / 4));
  return points;
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

// Paints the points into `image` (RGBA, `width` x `height` device pixels) as if looking through
// them from above: alpha grows with how much stands on a pixel, colour follows how high it stands.
function paintPoints(points, view, image, width, height, colours) {
  const weight = new Float32Array(width * height);
  const rise = new Float32Array(width * height);
  const floor = new Float32Array(width * height);
  const sizes = [clamp(Math.round(2.2 * view.scale * points.spacing_m[0]), 2, 24),
    clamp(Math.round(0.5 * view.scale * points.spacing_m[1]), 2, 7)];
  for (let k = 0; k < points.n; ++k) {
    if (points.kind[k] === 2) continue;
    const size = sizes[points.kind[k]];
    const half = size >> 1;
    const u0 = Math.round(view.u(points.x[k])) - half;
    const v0 = Math.round(view.v(points.y[k])) - half;
    if (u0 < 0 || v0 < 0 || u0 + size > width || v0 + size > height) continue;
    for (let v = v0; v < v0 + size; ++v) {
      for (let at = v * width + u0; at < v * width + u0 + size; ++at) {
        if (points.kind[k] === 0) {
          floor[at] += 1;
        } else {
          weight[at] += 1;
          rise[at] = Math.max(rise[at], points.rise[k]);
        }
      }
    }
  }
  const pixels = image.data;
  for (let at = 0; at < weight.length; ++at) {
    const structure = 1 - Math.exp(-0.75 * weight[at]);
    const ground = 0.24 * (1 - Math.exp(-1.1 * floor[at]));
    const alpha = structure + (1 - structure) * ground;
    if (alpha < 0.01) continue;
    for (let i = 0; i < 3; ++i) {
      const wall = colours.low[i] + rise[at] * (colours.high[i] - colours.low[i]);
      pixels[4 * at + i] =
        (structure * wall + (1 - structure) * ground * colours.floor[i]) / alpha;
    }
    pixels[4 * at + 3] = 255 * alpha;
  }
}
