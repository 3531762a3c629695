// The page of one run.
setSpan(data.span);
const track = new FuseTrack(byId("map"), data.track, data.outages);

const once = make => { let made = null; return () => made || (made = make()); };
const times = data.times.map(text => once(() => unpackTimes(text)));
let group = null, grid = null;
for (const spec of data.charts) {
  spec.t = times[spec.t];
  spec.shades = data.outages;
  if (spec.host) {   // a section of its own; over orders it has a cursor of its own, too
    if (spec.span) spec.shades = [];
    new Plot(byId(spec.host), spec, spec.span ? ageClock(() => null, spec.span[1]) : driveClock);
    continue;
  }
  if (spec.group !== group) {
    group = spec.group;
    grid = element("div", "", "group");
    byId("charts").append(element("h2", group), grid);
  }
  new Plot(grid, spec, driveClock);
}
byId("embedded").textContent = data.embedded;

const slider = byId("time"), now = byId("now");
[slider.min, slider.max] = data.span;
slider.value = data.span[0];
slider.addEventListener("input", () => setTime(+slider.value));
onTime.push(() => {
  if (view.now !== null) slider.value = view.now;
  now.textContent = view.now === null ? "–" : `${view.now.toFixed(1)} s  (${clockText(view.now)})`;
  slider.setAttribute("aria-valuetext", now.textContent);
});
onRange.push(() => { byId("reset").hidden = driveClock.full(); });
byId("reset").addEventListener("click", () => { driveClock.all(); track.home(); });

for (const b of document.querySelectorAll("[data-from]")) {
  const from = +b.dataset.from, to = +b.dataset.to, margin = 0.25 * (to - from);
  b.disabled = to <= data.span[0] || from >= data.span[1];
  b.title = b.disabled ? "The solution does not reach this outage" : "Show this outage on the track and in the charts";
  b.addEventListener("click", () => {
    setRange(from - margin, to + margin);
    setTime(to - 0.5);
    track.show(from, to);
    byId("track").scrollIntoView({ behavior: "smooth" });
  });
}
setTheme("");
