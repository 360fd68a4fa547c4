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
  const stage = document.querySelector(".stage");
  const map = new MapPanel(data, focus);
  const isWide = map.aspect() > 2.6;  // then the map stands above the charts instead of beside them
  const list = chartList(data.scans);
  const board = new ChartBoard(data, focus);
  stage.classList.toggle("lone", list.length === 0);
  stage.classList.toggle("wide", isWide && list.length > 0);
  stage.classList.toggle("quiet-run", data.events.length === 0);
  if (list.length > 0) addChart(board, side, list.shift(), "grow first");
  addChart(board, side, statusChart(data.scans), "status-panel");
  if (data.events.length > 0) side.append(eventsPanel(data, focus));
  const few = data.events.length <= 4;
  if (list.length > 0 && (isWide || few)) addChart(board, side, list.shift(), "grow second");
  if (list.length > 0 && isWide && few && data.events.length > 0) {
    stage.classList.add("few-events");
    addChart(board, side, list.shift(), "grow third");
  }
  if (data.warnings.length > 0) charts.append(warningsPanel(data));
  for (const options of list) addChart(board, charts, options);
  if (list.length % 2 === 1) charts.lastElementChild.classList.add("wide");

  showColourModes(map);
}

start();
