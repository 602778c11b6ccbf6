// Finds the charts of a page: an element with data-chart="ID" (and data-height, in px) draws the JSON of the script
// element with that id.
// They are drawn when they come near the window or get the focus (a campaign has dozens), all of them before printing,
// and `scan` takes up those that came into the page later. data-wheel and data-drag are the options of chart.js.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});
  const drawn = new Map(), waiting = new Set();
  const PAPER = 680;                                                     // [px] of A4 within margins of 10 mm at 96 dpi

  T.mount = function (box, spec, options) {
    if (drawn.has(box)) drawn.get(box).destroy();
    const made = spec.kind === "heatmap" ? new T.HeatMap(box, spec) : new T.Chart(box, spec, options);
    drawn.set(box, made);
    if (!T.first) { T.first = performance.now(); performance.mark("thermochart-first"); }
    return made;
  };
  T.of = function (box) { if (waiting.has(box)) draw(box); return drawn.get(box); };

  function draw(box) {
    waiting.delete(box); near.unobserve(box);
    const text = document.getElementById(box.dataset.chart);
    const options = {};
    if (box.dataset.wheel) options.wheel = box.dataset.wheel;
    if (box.dataset.drag) options.drag = box.dataset.drag;
    T.mount(box, JSON.parse(text.textContent), options);
  }
  const near = new IntersectionObserver(entries => entries.forEach(e => { if (e.isIntersecting && waiting.has(e.target)) draw(e.target); }),
    {rootMargin: "600px"});

  T.scan = function (root) {
    root.querySelectorAll("[data-chart]").forEach(box => {
      if (drawn.has(box) || waiting.has(box)) return;
      if (box.dataset.height) box.style.minHeight = box.dataset.height + "px";
      box.tabIndex = 0;                                                  // the keyboard may be there before the window
      box.addEventListener("focus", () => { if (waiting.has(box)) draw(box); }, {once: true});
      waiting.add(box); near.observe(box);
    });
    drawn.forEach((chart, box) => { if (!box.isConnected) { chart.destroy(); drawn.delete(box); } });
  };

  // the chart of a box in sight, zoomed, with the focus: what a link to a weak spot does
  T.show = function (box, from, to) {
    box.scrollIntoView({block: "center"});
    const chart = T.of(box);
    if (!chart) return;
    box.focus({preventScroll: true});
    if (chart.zoom && from !== undefined) chart.zoom(from, to);
  };

  let look;
  window.addEventListener("beforeprint", () => {
    waiting.forEach(draw);
    look = document.documentElement.dataset.theme;
    document.documentElement.dataset.theme = "light"; T.looks();         // paper is white
    drawn.forEach(chart => chart.print(PAPER));
  });
  window.addEventListener("afterprint", () => {
    if (look === undefined) delete document.documentElement.dataset.theme; else document.documentElement.dataset.theme = look;
    T.looks();
    drawn.forEach(chart => chart.print(null));
  });

  function start() { T.scan(document); }
  if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", start); else start();
})();
