// The one clock that drives all pictures: slider, play and pause, slow motion around contacts, and
// the traces under the slider.

class Clock {
  // `draw` is called with every new time.
  constructor(draw) {
    this.draw = draw;
    this.slider = document.getElementById("time");
    this.button = document.getElementById("play");
    this.shownTime = document.getElementById("now");
    this.slow = document.getElementById("slow");
    this.trace = document.getElementById("trace");
    this.time = 0;
    this.candidates = [];
    this.slider.addEventListener("input", () => {
      this.pause();
      this.set(Number(this.slider.value));
    });
    this.button.addEventListener("click", () => this.toggle());
  }

  // Takes the candidates that are shown; the first one decides where it begins.
  show(candidates, keepsTime) {
    this.candidates = candidates;
    this.end = Math.max(...candidates.map((candidate) => candidate.end));
    this.slider.max = this.end.toFixed(2);
    this.set(keepsTime ? this.time : candidates[0].begin);
  }

  set(time) {
    this.time = clamp(time, 0, this.end);
    this.slider.value = this.time;
    this.slider.setAttribute("aria-valuetext", this.words());
    this.shownTime.textContent = this.time.toFixed(2) + " s";
    this.draw(this.time);
    this.drawTrace();
  }

  // What the time means, for those who do not see it.
  words() {
    const [candidate] = this.candidates;
    if (!candidate || candidate.first === null) return this.time.toFixed(2) + " seconds";
    const left = candidate.first - this.time;
    return `${this.time.toFixed(2)} seconds, ` + (left > 0
      ? `${left.toFixed(2)} before first contact` : `${(-left).toFixed(2)} after first contact`);
  }

  // Contacts that are worth slowing down or stopping at, apart from each other.
  moments() {
    const times = [];
    for (const candidate of this.candidates) {
      for (const contact of candidate.contacts) {
        if (contact.closing > 0.5) times.push(contact.t);
      }
    }
    times.sort((a, b) => a - b);
    return times.filter((time, i) => i === 0 || time - times[i - 1] > 0.1);
  }

  pace() {
    if (!this.slow.checked) return 1;
    const isNear = this.moments().slice(0, 8).some(
      (moment) => this.time > moment - 0.12 && this.time < moment + 0.3);
    return isNear ? 0.15 : 1;
  }

  toggle() {
    if (this.isPlaying) this.pause();
    else this.play();
  }

  play() {
    if (this.time >= this.end - 1e-3) this.set(this.candidates[0].begin);
    this.isPlaying = true;
    this.button.textContent = "Pause";
    let before = null;
    const step = (now) => {
      if (!this.isPlaying) return;
      const passed = before === null ? 0 : Math.min(0.1, (now - before) / 1000);
      before = now;
      this.set(this.time + passed * this.pace());
      if (this.time >= this.end) this.pause();
      else requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  pause() {
    this.isPlaying = false;
    this.button.textContent = "Play";
  }

  step(seconds) {
    this.pause();
    this.set(this.time + seconds);
  }

  // To the next contact, or the one before for -1.
  leap(direction) {
    const times = this.moments();
    const next = direction > 0 ? times.find((time) => time > this.time + 1e-3)
      : times.reverse().find((time) => time < this.time - 1e-3);
    this.step((next ?? (direction > 0 ? this.end : 0)) - this.time);
  }

  // Exposure of every body over time, contacts, and moments from which others can not be chosen.
  drawTrace() {
    const canvas = this.trace;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    if (!(width > 0)) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    // The thumb of a slider keeps its own half from the edges.
    const margin = 8;
    const at = (time) => margin + (width - 2 * margin) * time / this.end;
    const base = height - 34;
    const [candidate] = this.candidates;
    const traces = candidate.hit.map((body) => [body, candidate.bodies.get(body).exposure])
      .filter(([, exposure]) => exposure);
    const most = Math.max(1, ...traces.flatMap(([, exposure]) => exposure.v)) / 1000;
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = context.strokeStyle = COLOURS.line;
    context.fillRect(margin, base, width - 2 * margin, 1);
    for (const [body, exposure] of traces) {
      context.strokeStyle = body === EGO ? COLOURS.ego : COLOURS.other;
      context.lineWidth = 1.75;
      context.beginPath();
      exposure.t.forEach((ms, i) => {
        context.lineTo(at(ms / 1000), base - (base - 6) * exposure.v[i] / 1000 / most);
      });
      context.stroke();
    }
    this.drawMarks(context, candidate, at, base);
    context.fillStyle = COLOURS.ink;
    context.fillRect(at(this.time) - 0.5, 0, 1, base);
    context.fillStyle = COLOURS.soft;
    const words = traces.map(([body]) => [body, candidate.exposureOf(body, this.time)])
      .filter(([, speed]) => speed > 0.3).map(([body, speed]) => `${shortened(nameOf(body))} ${kmh(speed)}`);
    context.textAlign = "left";
    context.fillText(words.join(", "), margin, base + 15);
    context.fillText("change of velocity within 0.3 s, tyres included", margin, base + 30);
    context.textAlign = "right";
    if (traces.length > 0) context.fillText("most " + kmh(most), width - margin, 12);
    context.textAlign = "left";
  }

  drawMarks(context, candidate, at, base) {
    context.fillStyle = COLOURS.damage;
    for (const contact of candidate.contacts) context.fillRect(at(contact.t) - 1, base - 6, 2, 10);
    for (const future of candidate.source.futures) {
      if (future.t === undefined || future.likeliest) continue;
      context.fillStyle = COLOURS.future;
      context.fillRect(at(future.t) - 1, base - 8, 2, 12);
    }
    context.fillStyle = COLOURS.mark;
    for (const part of partings(candidate)) {
      const x = at(part.time);
      context.beginPath();
      context.moveTo(x - 4, 0);
      context.lineTo(x + 4, 0);
      context.lineTo(x, 7);
      context.fill();
    }
  }
}

// Until when each other candidate can still be chosen: its way is the same so far. Rows that are
// drawn, the best ones first.
const partingsOf = new Map();
function partings(candidate) {
  if (!partingsOf.has(candidate)) {
    partingsOf.set(candidate, CANDIDATES.filter((other) => other !== candidate).slice(0, 6)
      .map((other) => ({other, time: candidate.partsFrom(other)})));
  }
  return partingsOf.get(candidate);
}

