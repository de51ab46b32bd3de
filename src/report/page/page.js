// Brings the parts of the page together.

readColours();
document.body.classList.add("live");
const stage = new Stage();
const table = new RankingTable((row) => {
  const candidate = candidateOfRow(row);
  if (!candidate) return;
  stage.show(row);
  showFutures(candidate);
});
showFutures(CANDIDATES[0]);
showStability();
let widthBefore = innerWidth;
window.addEventListener("resize", () => {
  if (innerWidth === widthBefore) return;
  widthBefore = innerWidth;
  showStability();
});

// Reads colours again, and paints with them what was painted once.
function recolour() {
  readColours();
  for (const view of stage.views) if (view.view) view.view.candidate = null;
  showFutures(stage.candidate);
}

function repaint() {
  recolour();
  stage.clock.set(stage.clock.time);
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);

// Paper is light, shows the moment of first contact, and describes every candidate.
let timeBefore = null;
window.addEventListener("beforeprint", () => {
  stage.clock.pause();
  timeBefore = stage.clock.time;
  document.documentElement.classList.add("paper");
  recolour();
  table.print();
  stage.clock.set(stage.candidate.first ?? stage.candidate.end / 2);
});
window.addEventListener("afterprint", () => {
  document.documentElement.classList.remove("paper");
  table.draw(true);
  if (timeBefore !== null) stage.clock.set(timeBefore);
  repaint();
});
document.body.dataset.view = "ready";
