// Puts the page together from its data.

function addChart(board, place, options, className) {
  const node = panel(options.title, className);
  place.append(node);
  board.add(new Chart(node, options));
}

function start() {
  const data = JSON.parse(document.getElementById("payload").textContent);
  const focus = new Focus();
  theme.start();
  showVerdict(data);
  showCards(data);
  showFigures(data);

  const side = document.getElementById("side");
  const charts = document.getElementById("charts");
  const list = chartList(data.scans);
  const board = new ChartBoard(data, focus);
  const stage = document.querySelector(".stage");
  if (list.length > 0) addChart(board, side, list.shift(), "grow");
  else stage.classList.add("lone");
  addChart(board, side, statusChart(data.scans), "status-panel");
  if (data.events.length > 0) side.append(eventsPanel(data, focus));
  if (data.events.length <= 4 && list.length > 0) addChart(board, side, list.shift(), "grow");
  if (data.warnings.length > 0) charts.append(warningsPanel(data));
  for (const options of list) addChart(board, charts, options);
  if (list.length % 2 === 1) charts.lastElementChild.classList.add("wide");

  showColourModes(new MapPanel(data, focus));
}

start();
