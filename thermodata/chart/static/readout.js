// Figures, units and times in words.
(function () {
  "use strict";
  const T = (window.ThermoChart = window.ThermoChart || {});
  const UNITS = {"1": "", delta_degC: "K"};

  T.unit = function (unit) {
    if (unit in UNITS) return UNITS[unit];
    return unit.replace(/\bum(?=\d|\b)/g, "µm").replace(/\bdegC\b/g, "°C").replace(/([a-zA-Z])(\^|\*\*)?2\b/g, "$1²");
  };
  // the middle goes: names of channels and tests often differ in their end only
  T.short = function (text, most) {
    const end = Math.floor((most - 1) / 2);
    return text.length > most ? text.slice(0, most - 1 - end) + "…" + text.slice(text.length - end) : text;
  };

  // four significant digits, a true minus
  T.number = function (v, digits) {
    if (v === null || v === undefined || Number.isNaN(v)) return "–";
    if (v === 0) return "0";
    const size = Math.floor(Math.log10(Math.abs(v)));
    const text = size < -4 || size > 6 ? v.toExponential((digits || 4) - 1)
      : v.toFixed(Math.max(0, Math.min(6, (digits || 4) - 1 - size)));
    return text.replace("-", "−");
  };
  T.tick = v => v === null ? null : (Math.abs(v) >= 1e5 || (v && Math.abs(v) < 1e-4) ? v.toExponential() : String(+v.toPrecision(6))).replace("-", "−");
  // '0 … 9000'; one number where nothing moves
  T.reach = function (low, high) {
    if (low === null || low === undefined) return "";
    const [a, b] = [low, high].map(v => T.tick(+v.toPrecision(3)));
    return a === b ? a : a + " … " + b;
  };
  T.decades = function (low, high) {
    const made = [], first = Math.floor(Math.log10(low)), last = Math.ceil(Math.log10(high)), step = Math.max(1, Math.ceil((last - first) / 8));
    for (let e = first; e <= last; e += step) made.push(Math.pow(10, e));
    return made;
  };
  T.signed = function (v) { return (v > 0 ? "+" : "") + T.number(v); };
  T.withunit = function (v, unit) {
    const u = T.unit(unit);
    return v === null || v === undefined ? "no data" : T.number(v) + (u ? "\u00a0" + u : "");
  };

  // the axis as it is read: hours, of which there is not one, as minutes; places of the chart and of its events stay hours
  T.told = (axis, full) => axis.unit === "h" && !axis.time && axis.scale !== "log" && full[1] - full[0] < 1
    ? Object.assign({}, axis, {shown: "min", times: 60}) : axis;
  // even places between low and high, round in what is read (times the place): at most `most`
  T.even = function (low, high, times, most) {
    const span = (high - low) * times, rough = span / Math.max(most, 2), ten = Math.pow(10, Math.floor(Math.log10(rough)));
    const step = [1, 2, 5, 10].map(v => v * ten).find(v => v >= rough * 0.999), made = [];
    for (let i = Math.ceil(low * times / step - 1e-9); i * step <= high * times + step * 1e-9; i++) made.push(i * step / times);
    return made;
  };

  // a place on the x axis: '9.052 h (9:03:07)', or a date in UTC
  T.at = function (axis, x) {
    if (axis.time) return new Date(x * 1000).toISOString().replace("T", " ").replace(/\.?0*Z$/, " UTC");
    const text = T.length(axis, x);
    if (axis.unit !== "h") return text;
    const s = Math.round(Math.abs(x) * 3600), two = n => String(n).padStart(2, "0");
    return text + " (" + (x < 0 ? "−" : "") + Math.floor(s / 3600) + ":" + two(Math.floor(s / 60) % 60) + ":" + two(s % 60) + ")";
  };
  T.length = function (axis, d) {
    return axis.time ? T.number(d / 3600) + "\u00a0h" : T.withunit(d * (axis.times || 1), axis.shown || axis.unit);
  };

  T.make = function (tag, name, text) {
    const made = document.createElement(tag);
    if (name) made.className = name;
    if (text !== undefined) made.textContent = text;
    return made;
  };
})();
