// A browser that was started without a language (LANG=C) tells pages one that Intl refuses ("en-US@posix"), and uPlot
// formats numbers by it as soon as it is loaded.
try {
  new Intl.NumberFormat(navigator.language);
} catch {
  Object.defineProperty(navigator, "language", { value: "en-US", configurable: true });
}
