// Figures are drawn when they come into sight (a campaign has dozens), and all of them before printing.
(function () {
  var config = {displaylogo: false, responsive: true, modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"]};
  function draw(box) {
    if (box.dataset.drawn) return;
    box.dataset.drawn = "1";
    var figure = JSON.parse(document.getElementById(box.dataset.figure).textContent);
    if (box.clientWidth < 620) {
      figure.layout.margin.l = Math.min(figure.layout.margin.l, 40);
      figure.layout.dragmode = false;           // a finger scrolls the page
      // the panels' titles need the line for themselves: legends move below the plot's top
      ["legend", "legend2", "legend3"].forEach(function (k) { if (figure.layout[k]) figure.layout[k].yanchor = "top"; });
    }
    var bar = box.dataset.figure.indexOf("test") === 0;      // only the figures of tests are worth the tools
    Plotly.newPlot(box, figure.data, figure.layout, Object.assign({displayModeBar: bar ? "hover" : false}, config));
  }
  var boxes = document.querySelectorAll("[data-figure]");
  function all() { boxes.forEach(draw); }
  if (!("IntersectionObserver" in window)) { all(); return; }
  var seen = new IntersectionObserver(function (entries) {
    entries.forEach(function (e) { if (e.isIntersecting) { draw(e.target); seen.unobserve(e.target); } });
  }, {rootMargin: "600px"});
  boxes.forEach(function (b) { seen.observe(b); });
  window.addEventListener("beforeprint", all);
})();
