/* What htmx can't: copying a command, and a chart's window in the address. All state of a page is in its address. */
"use strict";
(() => {
  const copy = (button) => navigator.clipboard.writeText(button.dataset.copy).then(() => {
    const before = button.textContent;
    button.textContent = "Copied";
    setTimeout(() => { button.textContent = before; }, 1500);
  });

  document.addEventListener("click", (event) => {
    const button = event.target.closest("[data-copy]");
    if (button) copy(button);
  });

  // parts that came later may hold charts
  document.addEventListener("htmx:afterSettle", (event) => ThermoChart.scan(event.target));
  // work that is done leads on to its result, once
  document.addEventListener("htmx:afterSettle", () => {
    const done = document.querySelector("[data-onward]");
    if (done) { const onward = done.dataset.onward; done.removeAttribute("data-onward"); location.assign(onward); }
  });
  // what is refused is shown where it was asked for
  document.addEventListener("htmx:beforeSwap", (event) => { if (event.detail.xhr.status >= 400) event.detail.shouldSwap = true; });

  const plot = document.getElementById("plot");
  if (!plot) return;
  const HOUR = 3600, state = new URLSearchParams(location.search);
  let busy = false, again = false, coarse = null, loaded = null;

  const shown = () => ["from", "to"].map((k) => Number(state.get(k)));
  const keep = (from, to) => {
    state.set("from", from.toFixed(1)); state.set("to", to.toFixed(1));
    history.replaceState(history.state, "", location.pathname + "?" + state);
  };
  // finer points for the window, asked for at once. While an answer is on its way nothing else is asked; then the newest
  // window is, and what came for an older one is dropped: no answer overtakes a newer one
  const refine = async () => {
    again = busy;
    if (busy) return;
    busy = true;
    try {
      do {
        again = false;
        const [from, to] = shown(), began = performance.now();
        const answer = await fetch(`${plot.dataset.source}&from=${from}&to=${to}`);
        const spec = answer.ok ? await answer.json() : null;
        if (!spec || again) continue;
        draw(spec, [from, to]);
        plot.dataset.refined = (performance.now() - began).toFixed(1);
      } while (again);
    } catch { /* the server is gone: what was drawn stays, and the next zoom asks again */ } finally { busy = false; }
  };
  const draw = (spec, window) => { loaded = window; ThermoChart.of(plot).update(spec); };
  plot.addEventListener("tc:zoom", (event) => {
    const from = event.detail.from * HOUR, to = event.detail.to * HOUR;
    keep(from, to);
    refine();
    // beyond what was loaded stand the coarse points of the page until the finer ones come, never nothing
    if (loaded === null) coarse = plot.dataset.from ? null : ThermoChart.of(plot).spec;
    if (coarse && loaded && (from < loaded[0] - 1 || to > loaded[1] + 1)) draw(coarse, [-Infinity, Infinity]);
    loaded = loaded || [-Infinity, Infinity];
  });

  // a drag zooms, or chooses a stretch
  const choose = document.getElementById("choose");
  const set = (on) => {
    choose.setAttribute("aria-pressed", String(on));
    ThermoChart.of(plot).options.drag = on ? "range" : "zoom";
  };
  choose.addEventListener("click", () => {
    const chart = ThermoChart.of(plot), on = choose.getAttribute("aria-pressed") !== "true";
    set(on);
    // by keyboard: the stretch between the two cursors, where both stand
    if (on && chart.a !== null && chart.b !== null) stretch(Math.min(chart.a, chart.b), Math.max(chart.a, chart.b));
  });
  const stretch = (from, to) => {
    document.getElementById("range").textContent = "Reading the stretch …";   // the first one loads what it needs
    return htmx.ajax("GET", `${plot.dataset.range}&from=${(from * HOUR).toFixed(1)}&to=${(to * HOUR).toFixed(1)}`, "#range");
  };
  plot.addEventListener("tc:range", (event) => { stretch(event.detail.from, event.detail.to); });

  // from a point back to its file
  plot.addEventListener("tc:pick", (event) => {
    const chart = ThermoChart.of(plot), panel = chart.panels[event.detail.panel], box = document.getElementById("picked");
    const names = panel.series.map((s) => s.name).filter((n) => plot.dataset.channels.split(",").includes(n));
    box.textContent = "";
    box.hidden = names.length === 0;
    if (!names.length) return;
    box.append(`At ${event.detail.x.toFixed(4)} h, back to the file: `);
    names.forEach((name, i) => {
      const a = document.createElement("a");
      a.href = `${plot.dataset.trace}&channel=${encodeURIComponent(name)}&at=${(event.detail.x * HOUR).toFixed(3)}`;
      a.textContent = name;
      box.append(i ? ", " : "", a);
    });
  });

  window.addEventListener("load", () => {
    const chart = ThermoChart.of(plot);
    if (chart && plot.dataset.from) chart.zoom(Number(plot.dataset.from), Number(plot.dataset.to));
  });
})();
