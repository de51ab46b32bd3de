// A candidate's pictures side by side, the plan and the view in 3-D, and the hands on them.

// Drags, pinches, wheel and keys on a picture. One finger scrolls the page until the picture has
// focus; so does the wheel.
function takeInHand(canvas, pane, redraw) {
  const held = new Map();
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spread = () => {
    const [a, b] = [...held.values()];
    return {gap: Math.hypot(a[0] - b[0], a[1] - b[1]), x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2};
  };
  canvas.addEventListener("pointerdown", (event) => {
    canvas.focus({preventScroll: true});
    held.set(event.pointerId, place(event));
    try {
      canvas.setPointerCapture(event.pointerId);
    } catch {
      // A pointer that has gone by now has nothing to capture.
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!held.has(event.pointerId)) return;
    const before = held.size === 2 ? spread() : null;
    const [fromX, fromY] = held.get(event.pointerId);
    const [x, y] = place(event);
    held.set(event.pointerId, [x, y]);
    if (before) {
      const now = spread();
      pane.nearer(now.gap / Math.max(1, before.gap), now.x, now.y);
      pane.move(now.x - before.x, now.y - before.y, true);
    } else if (held.size === 1) {
      pane.move(x - fromX, y - fromY, event.shiftKey || event.buttons === 2);
    }
    redraw();
  });
  for (const end of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(end, (event) => held.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("wheel", (event) => {
    if (document.activeElement !== canvas) return;
    event.preventDefault();
    pane.nearer(Math.exp(-0.0015 * event.deltaY), ...place(event));
    redraw();
  }, {passive: false});
  canvas.addEventListener("keydown", (event) => {
    const middle = [canvas.clientWidth / 2, canvas.clientHeight / 2];
    if (event.key === "+" || event.key === "=") pane.nearer(1.25, ...middle);
    else if (event.key === "-") pane.nearer(0.8, ...middle);
    else if (event.key === "0") pane.reset();
    else return;
    event.preventDefault();
    redraw();
  });
}

class SceneView {
  constructor(holder) {
    this.title = element("h3");
    const plan = element("canvas", {class: "plan-canvas", tabindex: "0", role: "img"});
    this.plan = new PlanPane(plan);
    this.box = element("div", {class: "scene"}, this.title, element("div", {class: "panes"}, plan));
    holder.append(this.box);
    takeInHand(plan, this.plan, () => this.redraw());
    this.addView3d();
    new ResizeObserver(() => this.redraw()).observe(this.box);
  }

  addView3d() {
    const canvas = element("canvas", {class: "view-canvas", tabindex: "0", role: "img"});
    const overlay = element("canvas", {class: "words-canvas", "aria-hidden": "true"});
    const pane = element("div", {class: "pane3d"}, canvas, overlay);
    this.box.querySelector(".panes").append(pane);
    try {
      this.view = new View3d(canvas, overlay);
    } catch {
      pane.remove();
      document.body.classList.add("flat");
      return;
    }
    takeInHand(canvas, this.view, () => this.redraw());
    canvas.addEventListener("webglcontextlost", () => {
      pane.remove();
      this.view = null;
      document.body.classList.add("flat");
    });
  }

  show(candidate, ghosts) {
    this.candidate = candidate;
    this.shows = {ghosts, parts: partings(candidate)};
    const row = DATA.rows[candidate.row];
    this.title.textContent = candidate.words;
    for (const canvas of this.box.querySelectorAll("[role=img]")) {
      const from = canvas.classList.contains("plan-canvas") ? "from above" : "in 3-D";
      canvas.setAttribute("aria-label", `${row[2]}, ${from}: ${row[9]}`);
    }
    this.plan.reset();
    this.plan.fit(candidate);
    if (this.view) this.view.candidate = null;
  }

  draw(time) {
    if (!this.candidate) return;
    this.time = time;
    // Others are ghosts until somebody crashes.
    const isBefore = (other) => time < Math.min(this.candidate.first ?? Infinity, other.first ?? Infinity);
    const shows = {ghosts: this.shows.ghosts.filter(isBefore), parts: this.shows.parts,
      elsewhere: this.candidate.elsewhere(time)};
    this.plan.draw(this.candidate, time, shows);
    if (this.view) this.view.draw(this.candidate, time, shows);
  }

  redraw() {
    if (this.time !== undefined) this.draw(this.time);
  }
}

// The pictures and their clock.
class Stage {
  constructor() {
    this.section = document.getElementById("stage");
    this.holder = document.getElementById("views");
    this.shown = document.getElementById("shown");
    this.beside = document.getElementById("beside");
    this.told = document.getElementById("told");
    for (const candidate of CANDIDATES) {
      for (const select of [this.shown, this.beside]) {
        select.append(element("option", {value: candidate.row}, candidate.words));
      }
    }
    this.views = [new SceneView(this.holder)];
    this.clock = new Clock((time) => this.views.forEach((view) => view.draw(time)));
    this.shown.addEventListener("change", () => this.show(Number(this.shown.value)));
    this.beside.addEventListener("change", () => this.compare());
    this.section.addEventListener("keydown", (event) => this.key(event));
    this.show(CANDIDATES[0].row);
  }

  show(row) {
    const candidate = candidateOfRow(row);
    if (!candidate) return;
    this.shown.value = row;
    this.candidate = candidate;
    this.update(false);
  }

  compare() {
    if (this.beside.value !== "" && this.views.length === 1) {
      this.views.push(new SceneView(this.holder));
    } else if (this.beside.value === "" && this.views.length === 2) {
      this.views.pop().box.remove();
    }
    this.update(true);
  }

  update(keepsTime) {
    const other = this.beside.value === "" ? null : candidateOfRow(Number(this.beside.value));
    this.holder.classList.toggle("two", other !== null);
    const ghosts = CANDIDATES.filter((each) => each !== this.candidate).slice(0, 4);
    this.views[0].show(this.candidate, other ? [] : ghosts);
    if (other) this.views[1].show(other, []);
    const parts = partings(this.candidate).filter((part) => !other || part.other === other)
      .slice(0, 1);
    this.told.textContent = parts.map((part) =>
      `“${part.other.words}” can still be chosen until ${part.time.toFixed(2)} s.`).join(" ");
    this.clock.pause();
    this.clock.show(other ? [this.candidate, other] : [this.candidate], keepsTime);
  }

  key(event) {
    if (event.target.matches("select, button, input[type=checkbox]") || event.ctrlKey ||
        event.metaKey || event.altKey) {
      return;
    }
    const step = event.shiftKey ? 0.5 : 0.05;
    const acts = {
      " ": () => this.clock.toggle(),
      "ArrowLeft": () => this.clock.step(-step),
      "ArrowRight": () => this.clock.step(step),
      "Home": () => this.clock.step(-Infinity),
      "End": () => this.clock.step(Infinity),
      "n": () => this.clock.leap(1),
      "p": () => this.clock.leap(-1),
    };
    const act = acts[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    act();
  }
}

