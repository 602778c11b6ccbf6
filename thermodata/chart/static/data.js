// Columns as they come (thermodata/chart/pack.py) and as uPlot wants them: arrays with null where nothing was measured.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});

  function bytes(text) {
    const raw = atob(text), out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; i++) out[i] = raw.charCodeAt(i);
    return out.buffer;
  }

  // a packed column, or a plain list -> array of numbers, null where nothing was measured
  T.column = function (packed) {
    if (Array.isArray(packed)) return packed;
    if ("n" in packed) return Array.from({length: packed.n}, (_, i) => packed.start + packed.step * i);
    if ("u2" in packed) {
      return Array.from(new Uint16Array(bytes(packed.u2)), c => c === 65535 ? null : packed.low + packed.step * c);
    }
    const values = "f8" in packed ? new Float64Array(bytes(packed.f8)) : new Float32Array(bytes(packed.f4));
    return Array.from(values, v => Number.isNaN(v) ? null : v);
  };

  // index of the sample nearest to x, of those that the series has there; -1 where it has none
  T.nearest = function (xs, ys, x) {
    let low = 0, high = xs.length - 1;
    if (high < 0) return -1;
    while (high - low > 1) { const mid = (low + high) >> 1; if (xs[mid] < x) low = mid; else high = mid; }
    let a = low, b = high;
    while (a >= 0 && ys[a] === undefined) a--;
    while (b < xs.length && ys[b] === undefined) b++;
    if (a < 0) return b < xs.length ? b : -1;
    if (b >= xs.length) return a;
    return Math.abs(xs[a] - x) <= Math.abs(xs[b] - x) ? a : b;
  };

  // one panel's table [x, y, y, ...] and the columns of each series in it. A band's edges are columns of their own.
  T.table = function (panel, x) {
    const own = [], lines = [];
    panel.series.forEach(function (s, i) {
      const ys = [T.column(s.y)];
      if (s.band) ys.push(T.column(s.band.low), T.column(s.band.high));
      const found = own.find(t => s.x === null ? t.shared : false);
      const table = found || {shared: s.x === null, data: [s.x === null ? x : T.column(s.x)]};
      if (!found) own.push(table);
      lines.push({series: i, table: table, at: table.data.length, band: Boolean(s.band)});
      table.data.push(...ys);
    });
    if (!own.length) return {data: [x.length ? [x[0], x[x.length - 1]] : []], lines: []};
    let first = 1;
    own.forEach(t => { t.first = first; first += t.data.length - 1; });
    lines.forEach(line => { line.column = line.table.first + line.at - 1; });
    // series on other times: holes of the join are undefined (drawn across), holes of the data stay null
    return {data: own.length === 1 ? own[0].data : uPlot.join(own.map(t => t.data)), lines: lines};
  };
})();
