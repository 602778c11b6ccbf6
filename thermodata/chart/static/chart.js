// One chart: panels over one x, each a uPlot, with one cursor, one zoom and a readout. Specification: chart/spec.py.
//   const chart = new ThermoChart.Chart(element, spec, {wheel: "focus" | "always", drag: "zoom" | "range"});
//   chart.zoom(from, to); chart.whole(); chart.point(x); chart.measure(a, b); chart.update(spec); chart.destroy();
// Events on the element, detail in x units: tc:zoom {from, to}, tc:range {from, to}, tc:pick {x, panel}.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});
  const groups = new Map();
  const NARROW = 620, AXIS = 46, TICKS = 26, LABEL = 18;

  class Chart {
    constructor(box, spec, options) {
      this.box = box;
      this.options = Object.assign({wheel: "focus", drag: "zoom"}, options);
      this.at = null; this.a = null; this.b = null; this.hidden = new Set();
      this.stop = [];
      this._read(spec);
      this.lo = this.full[0]; this.hi = this.full[1];
      const sized = new ResizeObserver(() => this.resize());
      this.stop.push(T.onlook(() => this.redraw()), () => sized.disconnect());
      this._build();
      sized.observe(box);
    }

    _read(spec) {
      this.spec = spec; this.axis = spec.axis; this.x = T.column(spec.x);
      this.panels = spec.panels.map((p, i) => Object.assign({number: i, rows: null}, p, T.table(p, this.x)));
      if (spec.rows.length) {
        this.panels.push({number: this.panels.length, rows: spec.rows, title: spec.rows_title, unit: "", series: [], marks: [],
          limits: [], lines: [], scale: "linear", range: [0, 1], strip: false, zero: false, height: 17 * spec.rows.length,
          data: T.table({series: []}, this.x).data});
      }
      const xs = this.panels.map(p => p.data[0]).filter(d => d.length);
      this.full = this.axis.range || [Math.min(...xs.map(d => d[0])), Math.max(...xs.map(d => d[d.length - 1]))];
      if (!xs.length && !this.axis.range) this.full = [0, 1];
      this.axis = T.told(this.axis, this.full);
    }

    // ---- the page's elements

    _build() {
      const box = this.box, spec = this.spec;
      box.textContent = ""; box.classList.add("tc"); box.tabIndex = 0; box.style.minHeight = "";
      box.setAttribute("role", "group"); box.setAttribute("aria-label", spec.about);
      this.bar = T.make("div", "tc-bar");
      this.place = T.make("output", "tc-at", "");
      this.bar.append(this.place);
      if (spec.tools) this._tools();
      this.table = T.make("table", "tc-diff"); this.table.hidden = true;
      box.append(this.bar, this.table);
      this.narrow = this._width() < NARROW;
      this._gutter();
      this.panels.forEach((p, i) => this._panel(p, i === this.panels.length - 1));
      this._events();
      this._place();
    }

    _tools() {
      const tools = T.make("span", "tc-tools");
      const add = (text, title, act) => {
        const b = T.make("button", "", text); b.type = "button"; b.title = title; b.setAttribute("aria-label", title);
        b.addEventListener("click", act); tools.append(b); return b;
      };
      add("+", "Zoom in (+ key, wheel, or drag over a stretch)", () => this.scale(0.5));
      add("−", "Zoom out (- key)", () => this.scale(2));
      add("whole", "Show the whole (0 key, or double-click)", () => this.whole());
      this.both = add("A–B", "A–B: two cursors with their difference (keys a and b)", () => this.toggleMeasure());
      this.both.setAttribute("aria-pressed", "false");
      this.bar.append(tools);
    }

    _panel(p, last) {
      const part = T.make("div", "tc-panel" + (p.strip ? " tc-strip" : ""));
      const head = T.make("div", "tc-head"), unit = T.unit(p.unit);
      head.append(T.make("b", "", p.title + (unit ? " [" + unit + "]" : "")));
      // a strip has no ticks: its head says what it goes over; a state without a unit is on or off
      if (p.strip && unit) { p.reach = T.make("span", "tc-reach", ""); head.append(p.reach); }
      p.values = p.series.map((s, i) => {
        const key = T.make("button", "tc-key"); key.type = "button";
        key.title = s.note || "Show or hide " + s.name; key.setAttribute("aria-pressed", "true");
        const swatch = T.make("i", "tc-swatch tc-" + s.dash); swatch.style.color = "var(--c-" + s.colour + ")";
        const value = T.make("span", "tc-value", "");
        const text = s.name + (s.band ? " ± " + s.band.label : "");
        key.append(swatch, T.make("span", "", this._label(p, i) && this.narrow ? this._label(p, i) + " " + text : text), value);
        key.addEventListener("click", () => this.toggle(p, i));
        ["mouseenter", "focus"].forEach(n => key.addEventListener(n, () => this.single(p, i)));
        ["mouseleave", "blur"].forEach(n => key.addEventListener(n, () => this.single(p, -1)));
        // one curve whose name is the title needs no key, only its value
        if (p.series.length === 1 && (p.strip || s.name === p.title)) { head.append(value); }
        else head.append(key);
        return {key: key, value: value};
      });
      if (p.rows) { p.rowvalue = T.make("span", "tc-value", ""); head.append(p.rowvalue); }
      p.note = T.make("span", "tc-note", ""); head.append(p.note);
      p.holder = T.make("div", "tc-plot");
      part.append(head, p.holder);
      this.box.append(part);
      p.last = last;
      p.plot = new uPlot(this._options(p), p.data, p.holder);
    }

    // text at the end of a line; its number where there is no room
    _label(p, i) {
      const s = p.series[i];
      if (p.strip || !s.label || p.series.length < 2) return "";
      return this.narrow ? String(i + 1) : T.short(s.label, 18);
    }

    _gutter() {
      const ctx = (this._canvas = this._canvas || document.createElement("canvas")).getContext("2d");
      ctx.font = "11px " + T.FONT;
      const texts = this.panels.flatMap(p => p.rows ? p.rows.map((r, i) => this.narrow ? String(i + 1) : T.short(r.name, 18))
        : p.series.map((s, i) => this._label(p, i)));
      const most = Math.max(0, ...texts.map(t => ctx.measureText(t).width));
      this.gutter = most ? Math.ceil(most) + 16 : 10;
    }

    _width() { return Math.max(this.fixed || this.box.clientWidth || 600, 200); }
    _height(p) { return p.height + (p.strip ? 4 : 12) + (p.last ? TICKS + LABEL : 0); }

    _options(p) {
      const chart = this, font = "11px " + T.FONT, ink = () => T.colour("muted"), grid = () => T.colour("grid");
      const size = this.narrow ? 38 : AXIS;
      const series = [{}], bands = [];
      p.lines.forEach(line => { series[line.column] = chart._line(p, line.series, line); });
      p.lines.filter(line => line.band).forEach(line => {
        const s = p.series[line.series], none = {scale: "y", stroke: "transparent", width: 0, points: {show: false}};
        series[line.column + 1] = none; series[line.column + 2] = Object.assign({}, none);
        bands.push({series: [line.column + 2, line.column + 1], fill: () => chart._faint(s.colour, "33")});
      });
      return {
        width: this._width(), height: this._height(p),
        padding: [p.strip ? 2 : 8, () => chart.gutter, p.last ? 0 : 4, 0],
        legend: {show: false}, focus: {alpha: 0.2},
        cursor: {y: false, drag: {x: true, y: false, setScale: false, dist: 5},
          points: {size: 6, show: !p.strip && !p.rows}, dataIdx: (u, i, near, x) => i ? T.nearest(u.data[0], u.data[i], x) : near,
          bind: {dblclick: () => () => { chart.whole(); return null; },
            mousedown: (u, _, handle) => e => { chart._grab(u, e) || handle(e); return null; }}},
        scales: {
          x: {time: this.axis.time, distr: this.axis.scale === "log" ? 3 : 1, auto: false, range: () => [chart.lo, chart.hi]},
          y: {distr: p.scale === "log" ? 3 : 1, range: p.range ? () => p.range : p.scale === "log" ? undefined : (u, a, b) => chart._span(p, a, b)},
        },
        tzDate: ts => uPlot.tzDate(new Date(ts * 1e3), "Etc/UTC"),
        axes: [
          {show: true, size: p.last ? TICKS : 0, font: font, stroke: p.last ? ink : "transparent", gap: 4, labelFont: font, labelSize: LABEL, labelGap: 0,
            splits: this.axis.scale === "log" ? (u, i, a, b) => T.decades(a, b)
              : this.axis.times ? (u, i, a, b) => T.even(a, b, this.axis.times, u.bbox.width / devicePixelRatio / 60) : undefined,
            label: p.last ? this.axis.label + (this.axis.unit && !this.axis.time ? " [" + T.unit(this.axis.shown || this.axis.unit) + "]" : "") : undefined,
            grid: {stroke: grid, width: 1}, ticks: {show: p.last, stroke: grid, size: 4},
            values: !p.last ? (u, splits) => splits.map(() => null) : this.axis.time ? undefined
              : (u, splits) => splits.map(v => T.tick(+(v * (this.axis.times || 1)).toPrecision(6)))},
          {show: true, size: size, font: font, stroke: ink, gap: 4, space: 28, grid: {show: !p.strip && !p.rows, stroke: grid, width: 1},
            ticks: {show: !p.strip && !p.rows, stroke: grid, size: 4},
            values: p.strip || p.rows ? (u, splits) => splits.map(() => null)
              : (u, splits) => splits.map(T.tick),
            splits: p.scale === "log" ? (u, i, a, b) => T.decades(a, b) : undefined},
        ],
        series: series, bands: bands,
        hooks: {
          drawClear: [u => T.spans(u, chart.spec.spans, p.number)],
          draw: [u => chart._over(p, u)],
          setCursor: [u => { if (u.cursor.event) chart._moved(u); }],
          setSelect: [u => chart._selected(u)],
        },
      };
    }

    _line(p, i, line) {
      const s = p.series[i], chart = this, paths = uPlot.paths;
      const made = {scale: "y", label: s.name, stroke: () => T.colour(s.colour), width: s.width, dash: T.dash[s.dash], show: !this.hidden.has(p.number + ":" + i)};
      if (s.style === "steps") made.paths = paths.stepped({align: 1});
      if (s.style === "area") { made.paths = paths.stepped({align: 1}); made.fill = () => chart._faint(s.colour, "66"); }
      if (s.style === "points") { made.paths = () => null; made.points = {show: true, size: 3, width: 0, fill: () => T.colour(s.colour)}; return made; }
      // a sample that stands alone between gaps makes no line: it is drawn as a point
      made.points = {show: false, size: 3, width: 0, fill: () => T.colour(s.colour), filter: (u, at) => chart._alone(u, at)};
      return made;
    }

    _alone(u, at) {
      const ys = u.data[at], found = [];
      const [from, to] = u.series[0].idxs;
      for (let i = from; i <= to; i++) {
        if (ys[i] !== null && ys[i] !== undefined && (i === 0 || ys[i - 1] === null) && (i === ys.length - 1 || ys[i + 1] === null)) found.push(i);
      }
      return found.length ? found : null;
    }

    _faint(colour, alpha) { return T.colour(colour) + alpha; }

    // what is in sight fills the height, with a margin; levels that are named stay in sight where they are near
    _span(p, low, high) {
      p.seen = [low, high];
      if (low === null || low === undefined) return [0, 1];
      if (p.strip) { low = Math.min(low, 0); high = Math.max(high, 0); }
      if (p.zero) { low = Math.min(low, 0); high = Math.max(high, 0); }
      const reach = high - low || Math.abs(high) * 0.1 || 1;
      p.limits.forEach(line => {
        if (line.y > high && line.y < high + reach) high = line.y;
        if (line.y < low && line.y > low - reach) low = line.y;
      });
      const room = 0.06 * (high - low || reach);
      return [low - (p.strip && low === 0 ? 0 : room), high + room];
    }

    _over(p, u) {
      const r = uPlot.pxRatio, ctx = u.ctx;
      if (p.rows) T.lanes(u, p.rows, this.narrow);
      if (p.reach) p.reach.textContent = p.seen ? T.reach(p.seen[0], p.seen[1]) : "";
      if (p.zero) T.limits(u, [{y: 0, label: "", colour: "muted"}]);
      T.limits(u, p.limits); T.marks(u, p.marks); T.spanlabels(u, this.spec.spans, p.number);
      T.endlabels(u, this._ends(p, u));
      [["A", this.a], ["B", this.b]].forEach(([name, x]) => {
        if (x === null || x < this.lo || x > this.hi) return;
        const at = u.valToPos(x, "x", true);
        ctx.save(); ctx.strokeStyle = T.colour("accent"); ctx.lineWidth = 1.5 * r; ctx.beginPath();
        ctx.moveTo(at, u.bbox.top); ctx.lineTo(at, u.bbox.top + u.bbox.height); ctx.stroke(); ctx.restore();
        if (p.number === 0) T.text(ctx, name, at + 3 * r, u.bbox.top + 8 * r, T.colour("accent"), r, 12, "left", true);
      });
    }

    _ends(p, u) {
      const labels = [];
      p.lines.forEach(line => {
        const text = this._label(p, line.series), ys = u.data[line.column];
        if (!text || !u.series[line.column].show) return;
        let i = u.series[0].idxs[1], first = u.series[0].idxs[0];
        while (i >= first && (ys[i] === null || ys[i] === undefined)) i--;
        if (i < first) return;
        const y = Math.min(Math.max(u.valToPos(ys[i], "y", true), u.bbox.top), u.bbox.top + u.bbox.height);
        labels.push({y: y, text: text, colour: T.colour(p.series[line.series].colour)});
      });
      return labels;
    }

    // ---- cursor and readout

    _moved(u) { this.point(u.cursor.left < 0 ? null : u.posToVal(u.cursor.left, "x"), u); }

    // put the cursor to x, null takes it away; from: the plot that has it already
    point(x, from, quiet) {
      this.at = x;
      this.panels.forEach(p => {
        if (p.plot !== from) p.plot.setCursor({left: x === null ? -10 : p.plot.valToPos(x, "x"), top: x === null ? -10 : 0}, false);
      });
      this._place();
      if (!quiet) this._others(c => c.point(x, null, true));
    }

    _value(p, line, x) {
      const i = T.nearest(p.data[0], p.data[line.column], x);
      return i < 0 ? null : p.data[line.column][i];
    }

    _place() {
      const x = this.at;
      this.panels.forEach(p => {
        p.lines.forEach(line => {
          const s = p.series[line.series], i = x === null ? -1 : T.nearest(p.data[0], p.data[line.column], x);
          let text = x === null ? "" : i < 0 ? "no data" : T.withunit(p.data[line.column][i], s.unit);
          if (line.band && i >= 0) {
            text += " (" + T.number(p.data[line.column + 1][i]) + " … " + T.number(p.data[line.column + 2][i]) + ")";
          }
          p.values[line.series].value.textContent = text;
        });
        p.note.textContent = x === null ? "" : this._reasons(p, x).join("; ");
        if (p.rows) {
          p.rowvalue.textContent = x === null ? "" : p.rows.flatMap(row =>
            row.runs.filter(run => run[0] <= x && x < run[1]).map(run => row.name + ": " + run[3])).slice(0, 6).join("; ");
        }
      });
      if (x === null) { this.place.textContent = this.axis.time ? "" : this._window(); return; }
      const here = this.spec.spans.filter(s => s.from <= x && x < s.to && (s.label || s.reason))
        .map(s => (s.rank ? "weak spot " + s.rank + ": " : "") + [s.label, s.reason].filter(Boolean).join(": "));
      this.place.textContent = [T.at(this.axis, x), ...new Set(here)].join(" · ");
    }

    _window() {
      return this.lo === this.full[0] && this.hi === this.full[1] ? "" :
        T.number(this.lo * (this.axis.times || 1)) + " … " + T.length(this.axis, this.hi) + " of " + T.length(this.axis, this.full[1]);
    }

    // why samples near x stand out: within five pixels
    _reasons(p, x) {
      const near = (this.hi - this.lo) / Math.max(p.plot.bbox.width / uPlot.pxRatio, 1) * 5, found = [];
      p.marks.forEach(m => {
        let best = -1;
        m.x.forEach((v, i) => { if (Math.abs(v - x) <= near && (best < 0 || Math.abs(v - x) < Math.abs(m.x[best] - x))) best = i; });
        if (best >= 0) found.push(m.name + " " + T.withunit(m.y[best], m.unit) + ": " + m.reasons[m.reason[best]]);
      });
      return found.slice(0, 3);
    }

    toggle(p, i) {
      const id = p.number + ":" + i, line = p.lines.find(l => l.series === i), show = this.hidden.has(id);
      if (show) this.hidden.delete(id); else this.hidden.add(id);
      p.values[i].key.setAttribute("aria-pressed", String(show));
      p.plot.setSeries(line.column, {show: show});
    }

    // one curve among many: the others fade; -1 for none
    single(p, i) {
      const line = p.lines.find(l => l.series === i);
      p.plot.setSeries(line ? line.column : null, {focus: true});
    }

    // ---- zoom

    zoom(from, to, quiet) {
      const [a, b] = this.full, least = (b - a) * 1e-6;
      from = Math.max(from, a); to = Math.min(to, b);
      if (!(to - from > least)) return;
      this.lo = from; this.hi = to;
      this.panels.forEach(p => p.plot.setScale("x", {min: from, max: to}));
      this._place();
      this._tell("zoom", {from: from, to: to});
      if (!quiet) this._others(c => c.zoom(from, to, true));
    }
    whole() { this.zoom(this.full[0], this.full[1]); }
    scale(times, about) {
      const at = about !== undefined ? about : this.at !== null && this.at >= this.lo && this.at <= this.hi ? this.at : (this.lo + this.hi) / 2;
      this.zoom(at - (at - this.lo) * times, at + (this.hi - at) * times);
    }
    pan(share) {
      const [a, b] = this.full, by = share * (this.hi - this.lo), d = Math.min(Math.max(by, a - this.lo), b - this.hi);
      this.zoom(this.lo + d, this.hi + d);
    }

    _selected(u) {
      if (u.select.width < 3) return;
      const from = u.posToVal(u.select.left, "x"), to = u.posToVal(u.select.left + u.select.width, "x");
      this.panels.forEach(p => p.plot.setSelect({left: 0, top: 0, width: 0, height: 0}, false));
      this._dragged = true;
      if (this.options.drag === "range") this._tell("range", {from: from, to: to}); else this.zoom(from, to);
    }

    // ---- two cursors

    measure(a, b) {
      this.a = a; this.b = b;
      if (this.both) this.both.setAttribute("aria-pressed", String(a !== null || b !== null));
      this._difference(); this.redraw();
    }
    toggleMeasure() {
      if (this.a !== null || this.b !== null) this.measure(null, null);
      else this.measure(this.lo + (this.hi - this.lo) / 3, this.lo + (this.hi - this.lo) * 2 / 3);
    }

    _grab(u, e) {
      if (e.button !== 0) return false;
      const left = e.clientX - u.over.getBoundingClientRect().left;
      const near = name => this[name] !== null && Math.abs(u.valToPos(this[name], "x") - left) < 7;
      const name = near("a") ? "a" : near("b") ? "b" : null;
      if (!name) return false;
      const move = ev => {
        const x = u.posToVal(ev.clientX - u.over.getBoundingClientRect().left, "x");
        const at = Math.min(Math.max(x, this.lo), this.hi);
        this.measure(name === "a" ? at : this.a, name === "b" ? at : this.b);
      };
      const up = () => { document.removeEventListener("mousemove", move); document.removeEventListener("mouseup", up); };
      document.addEventListener("mousemove", move); document.addEventListener("mouseup", up);
      return true;
    }

    _difference() {
      const table = this.table, a = this.a, b = this.b;
      table.hidden = a === null && b === null; table.textContent = "";
      if (table.hidden) return;
      const row = (cells, tag) => { const tr = T.make("tr"); cells.forEach(c => tr.append(T.make(tag, "", c))); table.append(tr); };
      const place = x => x === null ? "–" : T.at(this.axis, x);
      row(["", "A", "B", "B − A"], "th");
      row(["at", place(a), place(b), a === null || b === null ? "–" : T.length(this.axis, b - a)], "td");
      this.panels.forEach(p => p.lines.forEach(line => {
        const s = p.series[line.series];
        const va = a === null ? null : this._value(p, line, a), vb = b === null ? null : this._value(p, line, b);
        const d = va === null || vb === null || va === undefined || vb === undefined ? "–" : T.signed(vb - va) + "\u00a0" + T.unit(s.unit === "degC" ? "delta_degC" : s.unit);
        row([s.name, a === null ? "–" : T.withunit(va, s.unit), b === null ? "–" : T.withunit(vb, s.unit), d], "td");
      }));
    }

    // ---- mouse and keys

    _events() {
      const box = this.box;
      const on = (target, name, act, how) => { target.addEventListener(name, act, how); this.stop.push(() => target.removeEventListener(name, act, how)); };
      this.panels.forEach(p => {
        on(p.plot.over, "wheel", e => this._wheel(p.plot, e), {passive: false});
        on(p.plot.over, "mousedown", () => { this._dragged = false; box.focus({preventScroll: true}); });
        on(p.plot.over, "click", e => {
          if (this._dragged) return;
          const x = p.plot.posToVal(e.clientX - p.plot.over.getBoundingClientRect().left, "x");
          if (e.shiftKey) this.measure(this.a === null ? x : this.a, this.a === null ? this.b : x);
          this._tell("pick", {x: x, panel: p.number});
        });
      });
      on(box, "keydown", e => this._key(e));
    }

    _wheel(u, e) {
      const mine = this.options.wheel === "always" || e.ctrlKey || this.box.contains(document.activeElement);
      const out = e.deltaY > 0;
      // a chart that shows everything already lets the page scroll on
      if (!mine || (out && this.lo === this.full[0] && this.hi === this.full[1])) return;
      e.preventDefault();
      if (e.shiftKey) { this.pan(Math.sign(e.deltaY || e.deltaX) * 0.1); return; }
      this.scale(out ? 1.25 : 0.8, u.posToVal(e.clientX - u.over.getBoundingClientRect().left, "x"));
    }

    _key(e) {
      if (e.target !== this.box || e.ctrlKey || e.metaKey || e.altKey) return;
      const step = (this.hi - this.lo) * (e.shiftKey ? 0.1 : 0.01), at = this.at === null ? (this.lo + this.hi) / 2 : this.at;
      const go = x => {
        this.place.setAttribute("aria-live", "polite");
        x = Math.min(Math.max(x, this.full[0]), this.full[1]);
        if (x < this.lo || x > this.hi) this.pan(x < this.lo ? (x - this.lo) / (this.hi - this.lo) : (x - this.hi) / (this.hi - this.lo));
        this.point(x);
      };
      const acts = {
        ArrowLeft: () => go(at - step), ArrowRight: () => go(at + step),
        "+": () => this.scale(0.5), "=": () => this.scale(0.5), "-": () => this.scale(2),
        "0": () => this.whole(), ",": () => this.pan(-0.25), ".": () => this.pan(0.25),
        a: () => this.measure(at, this.b), b: () => this.measure(this.a, at),
        Escape: () => { this.measure(null, null); this.point(null); },
        Enter: () => this._tell("pick", {x: at, panel: 0}),
      };
      const act = acts[e.key];
      if (act) { e.preventDefault(); act(); }
    }

    _tell(name, detail) { this.box.dispatchEvent(new CustomEvent("tc:" + name, {detail: detail, bubbles: true})); }
    _others(act) {
      if (!this.spec.group) return;
      groups.forEach((group, chart) => { if (chart !== this && group === this.spec.group) act(chart); });
    }

    // ---- life

    // other data, or more of it for this window; the zoom, hidden curves and cursors stay where the panels are the same
    update(spec) {
      const same = spec.panels.length === this.spec.panels.length &&
        spec.panels.every((p, i) => JSON.stringify(p.series.map(s => s.name)) === JSON.stringify(this.spec.panels[i].series.map(s => s.name)))
        && spec.rows.length === this.spec.rows.length;
      const old = this.panels, whole = this.full;
      this._read(spec);
      if (!spec.axis.range) this.full = whole;
      if (!same) {
        if (this.full[0] !== whole[0] || this.full[1] !== whole[1]) { this.lo = this.full[0]; this.hi = this.full[1]; }
        old.forEach(p => p.plot.destroy()); this._anew(); return;
      }
      this.panels.forEach((p, i) => {
        ["plot", "holder", "values", "note", "reach", "rowvalue", "last"].forEach(k => { p[k] = old[i][k]; });
        Object.assign(old[i], p); this.panels[i] = old[i];
        old[i].plot.setData(p.data, false);
        old[i].plot.setScale("x", {min: this.lo, max: this.hi});
      });
      this._difference(); this._place();
    }

    resize() {
      const width = this._width(), narrow = width < NARROW;
      if (width === this._last) return;
      this._last = width;
      if (narrow !== this.narrow) { this.narrow = narrow; this._rebuild(); return; }
      this.panels.forEach(p => p.plot.setSize({width: width, height: this._height(p)}));
    }
    _rebuild() {
      this.panels.forEach(p => p.plot.destroy());
      this._anew();
    }
    _anew() {
      this.stop.splice(2).forEach(f => f());        // the listeners on what goes; look and size stay watched
      this._build(); this._difference();
    }
    redraw() { this.panels.forEach(p => p.plot.redraw(false, true)); }
    // a width of its own while a page prints; null gives it back
    print(width) { this.fixed = width; this._last = null; this.resize(); }
    destroy() {
      this.stop.forEach(f => f()); groups.delete(this);
      this.panels.forEach(p => p.plot.destroy());
      this.box.textContent = "";
    }
  }

  T.Chart = class extends Chart {
    constructor(box, spec, options) { super(box, spec, options); groups.set(this, spec.group); }
  };
})();
