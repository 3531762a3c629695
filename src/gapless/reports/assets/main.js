// Puts the page together.
const track = new Track(document.getElementById("map"));
for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", () => {
  if (button.dataset.zoom === "all") track.fit(); else track.zoom(button.dataset.zoom === "in" ? 1.5 : 1 / 1.5);
});

const charts = document.getElementById("charts");
let group = null, grid = null;
for (const spec of data.charts) {
  spec.t = data.times[spec.t];
  if (spec.group !== group) {
    group = spec.group;
    grid = element("div", "", "group");
    charts.append(element("h2", group), grid);
  }
  new Chart(spec, grid);
}

const slider = document.getElementById("time");
[slider.min, slider.max] = data.span;
slider.value = data.span[0];
slider.addEventListener("input", () => setTime(+slider.value));
document.getElementById("reset").addEventListener("click", () => { setRange(...data.span); track.fit(); });
for (const button of document.querySelectorAll("[data-from]")) {
  const from = +button.dataset.from, to = +button.dataset.to, margin = 0.25 * (to - from);
  button.disabled = to <= data.span[0] || from >= data.span[1];
  button.title = button.disabled ? "The solution does not reach this outage" : "Show this outage on the track and in the charts";
  button.addEventListener("click", () => {
    setRange(from - margin, to + margin);
    setTime(to - 0.5);
    track.fit(from, to);
    document.getElementById("track").scrollIntoView({ behavior: "smooth" });
  });
}

matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => request(true));
const printing = on => {
  if (on) setTime(null);
  document.documentElement.toggleAttribute("data-theme", on);
  if (on) document.documentElement.dataset.theme = "light";
  for (const d of drawings) { d.sharp = on ? 3 : 1; d.stale = true; d.refresh(); }
};
addEventListener("beforeprint", () => printing(true));
addEventListener("afterprint", () => printing(false));
request(true);
