// Colours of the page's look, and what is drawn by hand: shading, hatches, marks, labels at the ends of lines.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});
  const known = new Map(), listeners = new Set();
  T.FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif";

  T.colour = function (name) {
    if (!known.has(name)) {
      known.set(name, getComputedStyle(document.documentElement).getPropertyValue("--c-" + name).trim() || "#888888");
    }
    return known.get(name);
  };
  T.onlook = function (redraw) { listeners.add(redraw); return () => listeners.delete(redraw); };
  T.looks = function () { known.clear(); listeners.forEach(redraw => redraw()); };
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", T.looks);
  new MutationObserver(T.looks).observe(document.documentElement, {attributes: true, attributeFilter: ["data-theme"]});

  T.dash = {
    solid: [], dashed: [7, 4], dotted: [2, 3], "dash-dot": [8, 3, 2, 3],
    long: [15, 4], "dash-dot-dot": [8, 3, 2, 3, 2, 3], sparse: [3, 7], "long-dot": [15, 3, 2, 3],
  };

  T.hatched = function (ctx, x, y, w, h, colour, ratio, alpha) {
    if (w <= 0 || h <= 0) return;
    ctx.save();
    ctx.beginPath(); ctx.rect(x, y, w, h); ctx.clip();
    ctx.strokeStyle = colour; ctx.globalAlpha = alpha || 0.55; ctx.lineWidth = ratio; ctx.beginPath();
    const step = 6 * ratio;
    for (let at = x - h - ((x - h) % step); at < x + w; at += step) { ctx.moveTo(at, y + h); ctx.lineTo(at + h, y); }
    ctx.stroke(); ctx.restore();
  };

  T.text = function (ctx, text, x, y, colour, ratio, size, align, halo) {
    ctx.save();
    ctx.font = (size * ratio) + "px " + T.FONT; ctx.textAlign = align || "left"; ctx.textBaseline = "middle";
    if (halo) { ctx.strokeStyle = T.colour("paper"); ctx.lineWidth = 3 * ratio; ctx.lineJoin = "round"; ctx.strokeText(text, x, y); }
    ctx.fillStyle = colour; ctx.fillText(text, x, y);
    ctx.restore();
  };

  // a text that can be read on curves that go up and down right behind it
  T.boxed = function (ctx, text, x, y, colour, ratio, size) {
    ctx.save();
    ctx.font = (size * ratio) + "px " + T.FONT; ctx.fillStyle = T.colour("paper"); ctx.globalAlpha = 0.85;
    ctx.fillRect(x - 2 * ratio, y - 0.62 * size * ratio, ctx.measureText(text).width + 4 * ratio, 1.24 * size * ratio);
    ctx.restore();
    T.text(ctx, text, x, y, colour, ratio, size, "left");
  };

  // shaded stretches of one panel, below the curves
  T.spans = function (u, spans, number) {
    const ctx = u.ctx, r = uPlot.pxRatio, top = u.bbox.top, height = u.bbox.height;
    ctx.save();
    ctx.beginPath(); ctx.rect(u.bbox.left, top, u.bbox.width, height); ctx.clip();
    spans.forEach(function (s) {
      if (s.panels && !s.panels.includes(number)) return;
      const a = u.valToPos(s.from, "x", true), b = u.valToPos(s.to, "x", true);
      if (b < u.bbox.left || a > u.bbox.left + u.bbox.width) return;
      const from = Math.max(a, u.bbox.left), width = Math.max(Math.min(b, u.bbox.left + u.bbox.width) - from, r);
      if (s.kind === "weak") {
        ctx.fillStyle = T.colour("weak");
        ctx.globalAlpha = s.rank === 1 ? 0.14 : 0.07; ctx.fillRect(from, top, width, height);
        ctx.globalAlpha = 1; ctx.fillRect(from, top, width, 3 * r);
      } else if (s.kind === "phase") {
        ctx.strokeStyle = T.colour("line"); ctx.lineWidth = r; ctx.setLineDash([4 * r, 3 * r]);
        ctx.beginPath(); ctx.moveTo(a, top); ctx.lineTo(a, top + height); ctx.stroke(); ctx.setLineDash([]);
      } else {
        ctx.fillStyle = T.colour("muted"); ctx.globalAlpha = 0.08; ctx.fillRect(from, top, width, height); ctx.globalAlpha = 1;
        T.hatched(ctx, from, top, width, height, T.colour("muted"), r, 0.35);
      }
    });
    ctx.restore();
  };

  // their words, above curves and grid: the rank of a weak spot, the name of a stretch in the first panel that it is in
  T.spanlabels = function (u, spans, number) {
    const ctx = u.ctx, r = uPlot.pxRatio, left = u.bbox.left, right = left + u.bbox.width, foot = u.bbox.top + u.bbox.height;
    ctx.save();
    ctx.beginPath(); ctx.rect(left, u.bbox.top, u.bbox.width, u.bbox.height); ctx.clip();
    spans.forEach(function (s) {
      if (s.panels && !s.panels.includes(number)) return;
      const from = Math.max(u.valToPos(s.from, "x", true), left), to = Math.min(u.valToPos(s.to, "x", true), right);
      if (to < left || from > right) return;
      if (s.kind === "weak") {
        if (s.rank) T.text(ctx, String(s.rank), from + 4 * r, u.bbox.top + 11 * r, T.colour("warn"), r, 11, "left", true);
      } else if (s.label && to - from > 30 * r && number === (s.panels ? s.panels[0] : 0)) {
        T.text(ctx, s.label, from + 4 * r, foot - 8 * r, T.colour("muted"), r, 10.5, "left", true);
      }
    });
    ctx.restore();
  };

  T.limits = function (u, limits) {
    const ctx = u.ctx, r = uPlot.pxRatio;
    limits.forEach(function (line) {
      const y = u.valToPos(line.y, "y", true);
      if (y < u.bbox.top || y > u.bbox.top + u.bbox.height) return;
      ctx.save();
      ctx.strokeStyle = T.colour(line.colour); ctx.lineWidth = r; ctx.setLineDash([2 * r, 3 * r]);
      ctx.beginPath(); ctx.moveTo(u.bbox.left, y); ctx.lineTo(u.bbox.left + u.bbox.width, y); ctx.stroke(); ctx.restore();
      if (line.label) T.boxed(ctx, line.label, u.bbox.left + 4 * r, y - 7 * r, T.colour(line.colour), r, 10.5);
    });
  };

  // samples that stand out: a circle where they are, a triangle at the edge where they lie beyond it
  T.marks = function (u, marks) {
    const ctx = u.ctx, r = uPlot.pxRatio, top = u.bbox.top, bottom = top + u.bbox.height;
    marks.forEach(function (m) {
      m.x.forEach(function (x, i) {
        const at = u.valToPos(x, "x", true);
        if (at < u.bbox.left || at > u.bbox.left + u.bbox.width) return;
        const y = u.valToPos(m.y[i], "y", true), size = 2.6 * r;
        ctx.fillStyle = T.colour(m.colours[m.colour[i]]);
        ctx.beginPath();
        if (y >= top && y <= bottom) ctx.arc(at, y, size, 0, 2 * Math.PI);
        else {
          const up = y < top, tip = up ? top + r : bottom - r, foot = tip + (up ? 1 : -1) * 2.2 * size;
          ctx.moveTo(at, tip); ctx.lineTo(at - size * 1.3, foot); ctx.lineTo(at + size * 1.3, foot);
        }
        ctx.fill();
      });
    });
  };

  // [{y (device px), text, colour}] at the right of a panel, pushed apart so that each can be read
  T.endlabels = function (u, labels) {
    const ctx = u.ctx, r = uPlot.pxRatio, left = u.bbox.left + u.bbox.width;
    const gap = Math.min(12.5 * r, u.bbox.height / Math.max(labels.length, 1));  // none runs out of a low panel
    const top = u.bbox.top + gap / 2, bottom = u.bbox.top + u.bbox.height - gap / 2;
    labels.sort((a, b) => a.y - b.y);
    labels.forEach((l, i) => { l.at = Math.max(l.y, top, i ? labels[i - 1].at + gap : -Infinity); });
    for (let i = labels.length - 1, most = bottom; i >= 0; i--, most -= gap) {
      if (labels[i].at > most) labels[i].at = most; else most = labels[i].at;
    }
    labels.forEach(function (l) {
      ctx.save(); ctx.strokeStyle = l.colour; ctx.lineWidth = 1.5 * r;
      ctx.beginPath(); ctx.moveTo(left + r, l.y); ctx.lineTo(left + 7 * r, l.at); ctx.stroke(); ctx.restore();
      T.text(ctx, l.text, left + 10 * r, l.at, T.colour("ink"), r, 11);
    });
  };

  // lanes of stretches, such as flags: [{name, runs: [[from, to, colour, reason]]}]
  T.lanes = function (u, rows, narrow) {
    const ctx = u.ctx, r = uPlot.pxRatio, each = u.bbox.height / rows.length;
    rows.forEach(function (row, i) {
      const top = u.bbox.top + i * each;
      ctx.save();
      ctx.beginPath(); ctx.rect(u.bbox.left, top, u.bbox.width, each); ctx.clip();
      ctx.fillStyle = T.colour("soft"); ctx.fillRect(u.bbox.left, top + 1.5 * r, u.bbox.width, each - 3 * r);
      row.runs.forEach(function (run) {
        const a = u.valToPos(run[0], "x", true), b = u.valToPos(run[1], "x", true);
        ctx.fillStyle = T.colour(run[2]); ctx.fillRect(a, top + 1.5 * r, Math.max(b - a, r), each - 3 * r);
      });
      ctx.restore();
      const text = narrow ? String(i + 1) : T.short(row.name, 18);
      T.text(ctx, text, u.bbox.left + u.bbox.width + (narrow ? 4 : 10) * r, top + each / 2, T.colour("ink"), r, 11);
    });
  };
})();
