// The page of a bench.
const benchTrack = new BenchTrack(byId("map"));
byId("embedded").textContent = data.embedded;
onState.push(() => {
  const { truth } = benchTrack;
  benchTrack.turn();
  const now = benchTrack.card;
  const span = now ? [now.start, now.end] : benchTrack.truth.t.length ? [benchTrack.truth.t[0], benchTrack.truth.t[benchTrack.truth.t.length - 1]] : [0, 1];
  if (span[0] !== view.span[0] || span[1] !== view.span[1]) setSpan(span);
  if (benchTrack.shown !== now || truth !== benchTrack.truth) { benchTrack.shown = now; if (benchTrack.width) benchTrack.home(); }
  benchTrack.redraw();
});
onTime.push(() => {
  const { card } = benchTrack;
  byId("now").textContent = view.now === null ? "" : `${view.now.toFixed(1)} s into the drive${card ? `, ${(view.now - card.start).toFixed(1)} s without GNSS` : ""}`;
});
drawApart();
drawPrefix();
change({});
setTheme("");
