// Strips of colour, one a row, on a scale that does not change. Specification: HeatMap in chart/spec.py.
// Event on the element: tc:pick {row, x, target} when a row is clicked, or chosen with Enter.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});
  const ROW = 26, GAP = 5, FOOT = 58;

  function rgb(text) { return [1, 3, 5].map(i => parseInt(text.slice(i, i + 2), 16)); }
  function mixed(a, b, share) { return a.map((v, i) => Math.round(v + (b[i] - v) * share)); }

  T.HeatMap = class {
    constructor(box, spec) {
      this.box = box; this.spec = spec; this.values = T.column(spec.values); this.at = null;
      box.textContent = ""; box.classList.add("tc", "tc-heat"); box.tabIndex = 0;
      box.setAttribute("role", "group"); box.setAttribute("aria-label", spec.about); box.style.minHeight = "";
      this.place = T.make("output", "tc-at", ""); this.canvas = document.createElement("canvas");
      const bar = T.make("div", "tc-bar"); bar.append(this.place);
      box.append(bar, this.canvas);
      this.stop = [T.onlook(() => this.draw())];
      const sized = new ResizeObserver(() => this.draw()); sized.observe(box); this.stop.push(() => sized.disconnect());
      this.canvas.addEventListener("mousemove", e => this._read(e));
      this.canvas.addEventListener("mouseleave", () => { this.at = null; this._say(); });
      this.canvas.addEventListener("click", e => { this._read(e); this._pick(); });
      box.addEventListener("keydown", e => this._key(e));
      this.draw(); this._say();
    }

    _sizes() {
      const width = Math.max(this.fixed || this.box.clientWidth || 600, 200), ctx = this.canvas.getContext("2d");
      ctx.font = "12px " + T.FONT;
      const names = Math.min(Math.max(...this.spec.rows.map(r => ctx.measureText(r).width), 20) + 10, width * 0.34);
      const texts = this.spec.figures.length ? [...this.spec.figures, this.spec.figures_title] : [];
      const right = Math.max(0, ...texts.map(t => ctx.measureText(t).width + 10)) + 12;
      return {width: width, left: names, right: right, plot: width - names - right, height: this.spec.rows.length * ROW + FOOT};
    }

    colour(v) {
      const share = Math.max(-1, Math.min(1, v / this.spec.limit)), zero = rgb(T.colour("zero"));
      // a little opened in the middle, for small errors must be seen beside large ones; the key shows it
      return mixed(zero, rgb(T.colour(share < 0 ? "cold" : "hot")), Math.pow(Math.abs(share), 0.75));
    }

    draw() {
      const s = this.spec, z = this._sizes(), r = window.devicePixelRatio || 1, c = this.canvas, ctx = c.getContext("2d");
      c.width = z.width * r; c.height = z.height * r; c.style.width = z.width + "px"; c.style.height = z.height + "px";
      ctx.clearRect(0, 0, c.width, c.height);
      const each = z.plot * r / s.columns;
      s.rows.forEach((name, row) => {
        const top = row * ROW * r, high = (ROW - GAP) * r, wide = s.lengths[row] * each;
        T.hatched(ctx, z.left * r, top, wide, high, T.colour("muted"), r, 0.5);
        for (let i = 0; i < s.lengths[row]; i++) {
          const v = this.values[row * s.columns + i];
          if (v === null) continue;
          ctx.fillStyle = "rgb(" + this.colour(v).join(",") + ")";
          ctx.fillRect(Math.floor(z.left * r + i * each), top, Math.ceil(each + 0.5), high);
        }
        ctx.strokeStyle = T.colour("line"); ctx.lineWidth = r; ctx.strokeRect(z.left * r + 0.5, top + 0.5, Math.max(wide - 1, 1), high - 1);
        T.text(ctx, this._fit(ctx, name, z.left - 10, r), (z.left - 8) * r, top + high / 2, T.colour("ink"), r, 12, "right");
        if (s.figures.length) T.text(ctx, s.figures[row], (z.width - 2) * r, top + high / 2, T.colour("ink"), r, 12, "right");
      });
      this._axis(ctx, z, r); this._key_of_colours(ctx, z, r);
      if (this.at) {
        ctx.strokeStyle = T.colour("accent"); ctx.lineWidth = 2 * r;
        ctx.strokeRect(z.left * r, this.at.row * ROW * r, s.lengths[this.at.row] * each, (ROW - GAP) * r);
        ctx.beginPath(); const x = z.left * r + (this.at.column + 0.5) * each;
        ctx.moveTo(x, this.at.row * ROW * r); ctx.lineTo(x, (this.at.row * ROW + ROW - GAP) * r); ctx.stroke();
      }
    }

    _fit(ctx, name, room, r) {
      ctx.font = 12 * r + "px " + T.FONT;
      let text = name;
      for (let most = name.length; most > 3 && ctx.measureText(text).width > room * r; most--) text = T.short(name, most);
      return text;
    }

    _axis(ctx, z, r) {
      const s = this.spec, span = s.columns * s.step, y = (s.rows.length * ROW + 8) * r;
      const steps = s.axis.unit === "%" ? [1, 2, 5, 10, 20, 50, 100] : [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 4, 6, 12, 24, 48, 96];
      const step = steps.find(v => span / v <= Math.max(z.plot / 60, 2)) || span;
      for (let at = Math.ceil(s.start / step) * step; at <= s.start + span + step * 1e-6; at += step) {
        T.text(ctx, T.tick(at), (z.left + (at - s.start) / span * z.plot) * r, y, T.colour("muted"), r, 11, "center");
      }
      if (s.figures.length) T.text(ctx, s.figures_title, (z.width - 2) * r, y, T.colour("muted"), r, 11, "right");
      T.text(ctx, s.axis.label + " [" + T.unit(s.axis.unit) + "]", (z.left + z.plot / 2) * r, y + 15 * r, T.colour("muted"), r, 11, "center");
    }

    _key_of_colours(ctx, z, r) {
      const s = this.spec, y = (s.rows.length * ROW + 38) * r, wide = Math.min(180, z.plot * 0.4) * r, left = z.left * r + 34 * r;
      for (let i = 0; i < 60; i++) {
        ctx.fillStyle = "rgb(" + this.colour((i / 29.5 - 1) * s.limit).join(",") + ")";
        ctx.fillRect(left + i * wide / 60, y, Math.ceil(wide / 60), 10 * r);
      }
      ctx.strokeStyle = T.colour("line"); ctx.lineWidth = r; ctx.strokeRect(left, y, wide, 10 * r);
      const text = T.number(s.limit, 2), unit = T.unit(s.unit);
      T.text(ctx, "−" + text, left - 4 * r, y + 5 * r, T.colour("muted"), r, 11, "right");
      T.text(ctx, "+" + text + " " + unit, left + wide + 4 * r, y + 5 * r, T.colour("muted"), r, 11);
      if (z.plot < 300) return;
      const key = left + wide + 76 * r;
      T.hatched(ctx, key, y, 22 * r, 10 * r, T.colour("muted"), r, 0.6);
      ctx.strokeRect(key, y, 22 * r, 10 * r);
      T.text(ctx, "not measured", key + 27 * r, y + 5 * r, T.colour("muted"), r, 11);
    }

    _read(e) {
      const s = this.spec, z = this._sizes(), box = this.canvas.getBoundingClientRect();
      const row = Math.floor((e.clientY - box.top) / ROW), column = Math.floor((e.clientX - box.left - z.left) / z.plot * s.columns);
      this.at = row >= 0 && row < s.rows.length ? {row: row, column: Math.max(0, Math.min(column, s.lengths[row] - 1))} : null;
      this._say();
    }

    _say() {
      const s = this.spec, a = this.at;
      this.canvas.style.cursor = a && s.targets[a.row] ? "pointer" : "default";
      this.place.textContent = a ? s.rows[a.row] + ", " + T.number(s.start + (a.column + 0.5) * s.step, 3) + "\u00a0" + T.unit(s.axis.unit) + ": "
        + (this.values[a.row * s.columns + a.column] === null ? "not measured" : T.signed(this.values[a.row * s.columns + a.column]) + "\u00a0" + T.unit(s.unit)) : s.note;
      this.draw();
    }

    _pick() {
      const s = this.spec, a = this.at;
      if (!a) return;
      const x = s.start + (a.column + 0.5) * s.step;
      this.box.dispatchEvent(new CustomEvent("tc:pick", {detail: {row: a.row, x: x, target: s.targets[a.row] || ""}, bubbles: true}));
    }

    _key(e) {
      const s = this.spec, a = this.at || {row: 0, column: 0}, steps = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0]}[e.key];
      if (e.key === "Enter") { e.preventDefault(); this._pick(); return; }
      if (e.key === "Escape") { this.at = null; this._say(); return; }
      if (!steps || e.ctrlKey || e.metaKey || e.altKey) return;
      e.preventDefault();
      this.place.setAttribute("aria-live", "polite");
      const row = Math.max(0, Math.min(s.rows.length - 1, a.row + (this.at ? steps[0] : 0)));
      const by = (e.shiftKey ? 10 : 1) * Math.max(1, Math.round(s.columns / 200));
      this.at = {row: row, column: Math.max(0, Math.min(s.lengths[row] - 1, a.column + (this.at ? steps[1] * by : 0)))};
      this._say();
    }

    redraw() { this.draw(); }
    resize() { this.draw(); }
    print(width) { this.fixed = width; this.draw(); }
    destroy() { this.stop.forEach(f => f()); this.box.textContent = ""; }
  };
})();
