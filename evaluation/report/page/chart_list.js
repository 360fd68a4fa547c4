// Which figures are drawn, and where.

const themed = (name) => () => theme.colour(name);
const fixed = (colour) => () => colour;
const kBlue = fixed("#3d7bfd");
const kOrange = fixed("#ee8a2b");
const kTeal = fixed("#12a594");
const kViolet = fixed("#8a6cf0");

// Labels of a length axis in the unit that suits its values.
function lengthAxis(values, more = {}) {
  const unit = lengthUnit(values);
  return { text: (v) => `${+(v * unit.factor).toPrecision(3)} ${unit.name}`, ...more };
}
// Where the largest value would flatten all others, the axis is logarithmic.
function spreadAxis(values) {
  const known = values.filter((v) => isKnown(v) && v > 0);
  const top = percentile(known, 1);
  if (known.length < 10 || top < 30 * percentile(known, 0.5)) return lengthAxis(values);
  const low = 10 ** Math.floor(Math.log10(percentile(known, 0.1)));
  return { log: [low, 10 ** Math.ceil(Math.log10(top))],
    text: (v) => (v < 0.0999 ? `${+(1000 * v).toPrecision(1)} mm` : `${+v.toPrecision(1)} m`) };
}
const plainAxis = (suffix) => ({ text: (v) => `${+v.toPrecision(3)}${suffix}` });

function errorChart(scans) {
  return {
    title: "Position error",
    lines: [{ label: "distance to the truth", values: scans.error_m, text: lengthText,
      colour: kBlue, fill: true }],
    axes: { y: spreadAxis(scans.error_m) },
  };
}

function rotationChart(scans) {
  return {
    title: "Rotation error",
    lines: [{ label: "angle to the truth", values: scans.error_deg, text: angleText,
      colour: kOrange, fill: true }],
    axes: { y: plainAxis("°") },
  };
}

function residualChart(scans) {
  return {
    title: "Distance of the scan to the map",
    lines: [{ label: "mean residual", values: scans.residual_m, text: lengthText, colour: kTeal,
      fill: true }],
    axes: { y: lengthAxis(scans.residual_m) },
  };
}

function agreementChart(scans) {
  const lines = [];
  const axes = {};
  if (scans.inlier_share) {
    lines.push({ label: "inlier share", values: scans.inlier_share, text: shareText,
      colour: kTeal });
    axes.y = { text: (v) => `${Math.round(100 * v)} %`, high: 1.02 };
  }
  if (scans.matches) {
    const axis = scans.inlier_share ? "y2" : "y";
    lines.push({ label: "matches", values: scans.matches, text: countText, colour: kViolet, axis,
      width: 1 });
    axes[axis] = { text: countText };
  }
  return { title: "Agreement with the map", lines, axes };
}

// The stated position uncertainty, three sigma, and beside it the error it should bound.
function sigmaChart(scans) {
  const lines = [];
  const axes = {};
  if (scans.sigma_m) {
    const three = scans.sigma_m.map((s) => (isKnown(s) ? 3 * s : null));
    lines.push({ label: "3σ position", values: three, text: lengthText, colour: kBlue,
      fill: true });
    if (scans.error_m) lines.push({ label: "error", values: scans.error_m, text: lengthText,
      colour: themed("soft"), width: 1 });
    axes.y = spreadAxis(three.concat(scans.error_m || []));
  }
  if (scans.sigma_deg) {
    const axis = scans.sigma_m ? "y2" : "y";
    const three = scans.sigma_deg.map((s) => (isKnown(s) ? 3 * s : null));
    lines.push({ label: "3σ rotation", values: three, text: angleText, colour: kOrange, axis,
      width: 1 });
    axes[axis] = plainAxis("°");
  }
  return { title: "Stated uncertainty", lines, axes };
}

function wrongChart(scans) {
  return {
    title: "Probability of being wrong, as stated",
    lines: [{ label: "p", values: scans.p_wrong, text: shareText, colour: themed("bad"),
      fill: true }],
    axes: { y: { text: (v) => `${+(100 * v).toPrecision(3)} %` } },
  };
}

const totals = (lines) => lines[0].values.map((_, i) =>
  lines.reduce((sum, line) => sum + (line.values[i] || 0), 0));

// A few values far above all others would flatten the rest: the axis then ends below them.
function cutOff(values) {
  const usual = percentile(values, 0.99);
  const worst = percentile(values, 1);
  return worst > 4 * usual ? { high: 1.8 * usual, worst } : undefined;
}

function stepChart(scans) {
  const names = Object.keys(scans.stages);
  const lines = names.map((name, i) => ({ label: name.replaceAll("_", " "),
    values: scans.stages[name], text: msText,
    colour: fixed(kStageColours[i % kStageColours.length]) }));
  const stacked = lines.length > 0;
  if (!stacked) lines.push({ label: "total", values: scans.ms_total, text: msText, colour: kBlue,
    fill: true });
  const cut = cutOff(totals(lines));
  return { title: "Time of a step", lines: lines.reverse(), stacked,
    axes: { y: { ...plainAxis(" ms"), high: cut && cut.high } },
    note: cut && `worst ${msText(cut.worst)}` };
}

function statusChart(scans) {
  return {
    title: "Status",
    band: true,
    lines: [{ label: "", values: scans.t.map(() => null), text: () => "", colour: fixed("#0000") }],
    axes: { y: { text: () => "", hidden: true } },
  };
}

// What the data holds, the most telling first.
function chartList(scans) {
  const list = [];
  if (scans.error_m) list.push(errorChart(scans));
  else if (scans.residual_m) list.push(residualChart(scans));
  if (scans.ms_total || Object.keys(scans.stages).length > 0) list.push(stepChart(scans));
  if (scans.error_deg) list.push(rotationChart(scans));
  if (scans.error_m && scans.residual_m) list.push(residualChart(scans));
  if (scans.inlier_share || scans.matches) list.push(agreementChart(scans));
  if (scans.sigma_m || scans.sigma_deg) list.push(sigmaChart(scans));
  if (scans.p_wrong) list.push(wrongChart(scans));
  return list;
}
