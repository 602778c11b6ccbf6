// Links between a page's parts: weak spots and heat maps lead to the test, zoomed; the navigation shows where one is.
(function () {
  "use strict";
  function box(id) { return document.querySelector('[data-chart="' + id + '"]'); }

  document.addEventListener("click", function (e) {
    const link = e.target.closest("[data-show]");
    if (!link || !box(link.dataset.show)) return;
    e.preventDefault();
    const from = Number(link.dataset.from), to = Number(link.dataset.to), room = 0.5 * (to - from);
    ThermoChart.show(box(link.dataset.show), from - room, to + room);
  });
  document.addEventListener("tc:pick", function (e) {
    if (e.detail.target) {
      ThermoChart.show(box(e.detail.target));
      const chart = ThermoChart.of(box(e.detail.target));
      if (chart) chart.point(e.detail.x);
    }
  });

  const look = document.getElementById("look");
  if (look) {
    look.hidden = false;
    look.addEventListener("click", function () {
      const root = document.documentElement;
      const dark = root.dataset.theme ? root.dataset.theme === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
      root.dataset.theme = dark ? "light" : "dark";
    });
  }

  const links = new Map([...document.querySelectorAll("nav.toc a[href^='#']")].map(a => [a.getAttribute("href").slice(1), a]));
  const seen = new IntersectionObserver(entries => entries.forEach(e => {
    const link = links.get(e.target.id);
    if (!e.isIntersecting || !link) return;
    links.forEach(l => l.removeAttribute("aria-current"));
    link.setAttribute("aria-current", "true");
  }), {rootMargin: "-15% 0px -75% 0px"});
  links.forEach((_, id) => { const part = document.getElementById(id); if (part) seen.observe(part); });

  // what is folded stays away from paper only if nobody opened it: a reader of paper can't
  window.addEventListener("beforeprint", () => document.querySelectorAll("details[data-print]").forEach(d => { d.open = true; }));
})();
