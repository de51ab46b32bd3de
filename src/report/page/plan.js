// The plan: the scene from above, drawn on a canvas, the ego's heading at the start to the right.

// Draws what never moves; `to` carries world coordinates to the canvas.
function drawRoad(context, to, width, height) {
  const trace = (ring) => {
    ring.forEach(([x, y], i) => {
      const [px, py] = to(x, y);
      if (i === 0) context.moveTo(px, py);
      else context.lineTo(px, py);
    });
    context.closePath();
  };
  context.fillStyle = DATA.road.length > 0 ? COLOURS.ground : COLOURS.asphalt;
  context.fillRect(0, 0, width, height);
  for (const rings of DATA.road) {
    context.beginPath();
    rings.forEach(trace);
    context.fillStyle = COLOURS.asphalt;
    context.fill("evenodd");
  }
  // Borders of areas that meet are those of lanes.
  context.strokeStyle = COLOURS.line;
  context.lineWidth = 1.5;
  for (const rings of DATA.road) {
    context.beginPath();
    rings.forEach(trace);
    context.stroke();
  }
}

// A line every ten metres within a box of the world.
function drawGrid(context, to, [left, bottom, right, top]) {
  context.strokeStyle = COLOURS.line;
  context.globalAlpha = 0.5;
  context.lineWidth = 1;
  context.beginPath();
  const stroke = (x0, y0, x1, y1) => {
    context.moveTo(...to(x0, y0));
    context.lineTo(...to(x1, y1));
  };
  for (let x = Math.ceil(left / 10) * 10; x <= right; x += 10) stroke(x, bottom, x, top);
  for (let y = Math.ceil(bottom / 10) * 10; y <= top; y += 10) stroke(left, y, right, y);
  context.stroke();
  context.globalAlpha = 1;
}

class PlanPane {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.reset();
  }

  reset() {
    this.zoom = 1;
    this.shift = [0, 0];
  }

  move(dx, dy) {
    this.shift[0] += dx;
    this.shift[1] += dy;
  }

  nearer(factor, x, y) {
    const zoom = clamp(this.zoom * factor, 0.4, 30);
    const grown = zoom / this.zoom;
    this.zoom = zoom;
    const from = [x - this.width / 2, y - this.height / 2];
    this.shift = this.shift.map((value, i) => from[i] - (from[i] - value) * grown);
  }

  // Fits the picture of a candidate to the canvas.
  fit(candidate) {
    this.turn = -poseOn(candidate.source.plan, 0).heading;
    const c = Math.cos(this.turn);
    const s = Math.sin(this.turn);
    const turned = (corners) => corners.map(([x, y]) => [c * x - s * y, s * x + c * y]);
    let points = turned(sceneOf(candidate));
    this.frame(points);
    // Vehicles that the edge of the picture would cut stand in it as a whole. More of them come
    // into a larger picture: once more, and no further.
    const until = candidate.first === null ? candidate.end : candidate.first + 1;
    const outlines = BODIES.filter((body) => !modelOf(body).fixed).flatMap((body) =>
      [0, candidate.begin, candidate.first ?? until, until, candidate.end].map((time) =>
        turned(outlineAt(body, candidate.poseOf(body, time)))));
    for (let i = 0; i < 2; ++i) {
      points = points.concat(outlines.filter((corners) => this.cuts(corners)).flat());
      this.frame(points);
    }
  }

  // Takes what has to be seen, in turned coordinates.
  frame(points) {
    const ends = [0, 1].map((axis) => {
      const values = points.map((point) => point[axis]);
      return [Math.min(...values), Math.max(...values)];
    });
    this.middle = ends.map(([low, high]) => (low + high) / 2);
    this.extent = ends.map(([low, high]) => high - low + 5);
  }

  // Whether some of these corners are in the picture and some are not.
  cuts(corners) {
    const size = [this.canvas.clientWidth || 600, this.canvas.clientHeight || 400];
    const scale = Math.min(size[0] / this.extent[0], size[1] / this.extent[1], 40);
    const seen = corners.filter((corner) => corner.every(
      (value, axis) => Math.abs(value - this.middle[axis]) < size[axis] / scale / 2));
    return seen.length > 0 && seen.length < corners.length;
  }

  scaleOf() {
    return this.zoom * Math.min(this.width / this.extent[0], this.height / this.extent[1], 40);
  }

  // World to canvas.
  projection() {
    const scale = this.scaleOf();
    const c = Math.cos(this.turn) * scale;
    const s = Math.sin(this.turn) * scale;
    const left = this.width / 2 + this.shift[0] - this.middle[0] * scale;
    const top = this.height / 2 + this.shift[1] + this.middle[1] * scale;
    return (x, y) => [left + c * x - s * y, top - (s * x + c * y)];
  }

  // The box of the world that the canvas shows.
  box() {
    const scale = this.scaleOf();
    const reach = Math.hypot(this.width, this.height) / 2 / scale +
      Math.hypot(...this.shift) / scale;
    const c = Math.cos(-this.turn);
    const s = Math.sin(-this.turn);
    const x = c * this.middle[0] - s * this.middle[1];
    const y = s * this.middle[0] + c * this.middle[1];
    return [x - reach, y - reach, x + reach, y + reach];
  }

  draw(candidate, time, shows) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    if (!(this.width > 0)) return;
    this.canvas.width = Math.round(this.width * ratio);
    this.canvas.height = Math.round(this.height * ratio);
    const context = this.context;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.to = this.projection();
    drawRoad(context, this.to, this.width, this.height);
    drawGrid(context, this.to, this.box());
    this.ways(candidate, time, shows);
    for (const body of BODIES) this.body(candidate, body, time);
    this.contacts(candidate, time);
    this.labels(candidate, time, shows);
    this.scaleBar();
  }

  polyline(track, from, until) {
    const context = this.context;
    context.beginPath();
    const steps = 40;
    for (let i = 0; i <= steps; ++i) {
      const pose = poseOn(track, mix(from, until, i / steps));
      const point = this.to(pose.x, pose.y);
      if (i === 0) context.moveTo(...point);
      else context.lineTo(...point);
    }
    context.stroke();
  }

  polygon(corners) {
    const context = this.context;
    context.beginPath();
    corners.forEach(([x, y], i) => {
      if (i === 0) context.moveTo(...this.to(x, y));
      else context.lineTo(...this.to(x, y));
    });
    context.closePath();
  }

  // Ways ahead, other candidates and other futures.
  ways(candidate, time, shows) {
    const context = this.context;
    context.lineWidth = 1.5;
    for (const other of shows.ghosts) {
      context.globalAlpha = 0.55;
      context.strokeStyle = COLOURS.ghost;
      this.polyline(other.source.plan, 0, other.first ?? other.end);
      this.polygon(outlineAt(EGO, other.poseOf(EGO, time)));
      context.globalAlpha = 0.5;
      context.stroke();
    }
    for (const {body, p, plan} of shows.elsewhere) {
      context.globalAlpha = clamp(p + 0.35, 0.45, 0.9);
      context.strokeStyle = COLOURS.future;
      context.fillStyle = COLOURS.future;
      context.setLineDash([5, 4]);
      this.polyline(plan, 0, DATA.horizon);
      context.setLineDash([]);
      const pose = poseOn(plan, time);
      this.polygon(outlineAt(body, pose));
      context.stroke();
      context.globalAlpha = clamp(p, 0.1, 0.7);
      context.fill();
    }
    context.globalAlpha = 1;
    for (const body of candidate.hit.filter((each) => each !== EGO)) {
      if (modelOf(body).fixed) continue;
      context.strokeStyle = COLOURS.other;
      context.setLineDash([2, 4]);
      this.polyline(candidate.planOf(body), 0, candidate.first ?? DATA.horizon);
      context.setLineDash([]);
    }
    context.strokeStyle = COLOURS.ego;
    context.lineWidth = 2.5;
    this.polyline(candidate.source.plan, 0, Math.min(candidate.first ?? candidate.end, DATA.horizon));
    context.lineWidth = 1.5;
    for (const {time: part} of shows.parts) {
      const pose = poseOn(candidate.source.plan, part);
      context.fillStyle = COLOURS.mark;
      context.beginPath();
      context.arc(...this.to(pose.x, pose.y), 3.5, 0, 7);
      context.fill();
    }
  }

  body(candidate, body, time) {
    const context = this.context;
    const pose = candidate.poseOf(body, time);
    const model = modelOf(body);
    this.polygon(outlineAt(body, pose));
    const isHit = candidate.hit.includes(body);
    context.fillStyle = body === EGO ? COLOURS.ego : isHit ? COLOURS.other : COLOURS.still;
    context.fill();
    const damaged = candidate.isDamaged(body, time);
    context.strokeStyle = damaged ? COLOURS.damage : COLOURS.ink;
    context.lineWidth = damaged ? 2.5 : 0.75;
    context.stroke();
    if (model.fixed) return;
    const front = Math.max(...model.outline.map(([forward]) => forward));
    this.polygon([[front - 0.2, 0], [front - 0.9, 0.35], [front - 0.9, -0.35]].map(
      ([forward, left]) => carry(pose, forward, left)));
    context.fillStyle = "#fff";
    context.fill();
  }

  contacts(candidate, time) {
    const context = this.context;
    for (const contact of candidate.contacts) {
      const age = time - contact.t;
      if (age < 0) continue;
      const [x, y] = this.to(contact.at[0], contact.at[1]);
      const flash = clamp(1 - age / 0.5, 0, 1);
      context.globalAlpha = 0.35 + 0.65 * flash;
      context.strokeStyle = COLOURS.damage;
      context.lineWidth = 2;
      context.beginPath();
      context.arc(x, y, 5 + 14 * flash, 0, 7);
      context.stroke();
      context.globalAlpha = 1;
      if (age < 0.5) this.kicks(contact, x, y);
    }
  }

  // Changes of velocity, as arrows from the contact.
  kicks(contact, x, y) {
    contact.kicks.forEach((kick, side) => {
      const [tipX, tipY] = this.to(contact.at[0] + 0.3 * kick[0], contact.at[1] + 0.3 * kick[1]);
      if (Math.hypot(tipX - x, tipY - y) < 6) return;
      drawArrow(this.context, [x, y], [tipX, tipY],
        contact.bodies[side] === EGO ? COLOURS.ego : COLOURS.other);
    });
  }

  // Left, top, right and bottom of a body on the canvas.
  boxOf(body, pose) {
    const corners = outlineAt(body, pose).map((corner) => this.to(...corner));
    const [x, y] = [0, 1].map((axis) => corners.map((corner) => corner[axis]));
    return [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
  }

  // Names beside the bodies, those that matter most first; those of bodies that crash stand further
  // off, at the end of a line, where there is no room. A structure is named once.
  labels(candidate, time, shows) {
    const labels = new Labels(this.context, this.width, this.height);
    const boxes = new Map(BODIES.map(
      (body) => [body, this.boxOf(body, candidate.poseOf(body, time))]));
    const hit = candidate.hit.filter((body) => body !== EGO && boxes.has(body));
    const isFree = (body, half) => ([x, y]) => ![...boxes].some(
      ([other, [left, top, right, bottom]]) => other !== body && x + half > left - 2 &&
        x - half < right + 2 && y > top - 1 && y < bottom + 10);
    const beside = (body, pose, text, colour, takesPart) => {
      const middle = this.to(...middleOfBody(body, pose));
      const [left, top, right, bottom] = this.boxOf(body, pose);
      if (right < 0 || bottom < 0 || left > this.width || top > this.height) return;
      const half = labels.halfOf(text);
      const [x, y] = [clamp(middle[0], half + 2, this.width - half - 2), middle[1] + 4];
      const near = [[x, bottom + 13], [x, top - 4], [right + half + 5, y], [left - half - 5, y]];
      // The side that is away from whom it crashes with comes first.
      const isBelow = [EGO, ...hit].some((other) => other !== body && takesPart &&
        boxes.get(other)[3] > bottom && boxes.get(other)[1] < bottom + 20 &&
        boxes.get(other)[0] < right && boxes.get(other)[2] > left);
      if (isBelow) near.unshift(...near.splice(1, 1));
      const far = [];
      for (let off = 16; takesPart && off < 100; off += 12) {
        for (const aside of [0, 40, -40]) {
          far.push([x + aside, top - 4 - off], [x + aside, bottom + 13 + off]);
        }
      }
      const free = near.concat(far.filter((place) => labels.isClear(place, middle)))
        .filter(isFree(body, half));
      const at = labels.add(text, takesPart ? free.concat(near) : free, colour);
      if (at && far.some((place) => place[0] === at[0] && place[1] === at[1])) {
        labels.lead(at, middle, colour);
      }
    };
    const named = new Set(hit.map(structureOf));
    // Where many take no part, they stay without names.
    const most = candidate.first === null ? Infinity : 6;
    const rest = BODIES.filter((body) => {
      if (body === EGO || hit.includes(body)) return false;
      const [left, top, right, bottom] = boxes.get(body);
      const structure = structureOf(body);
      if (right < 0 || bottom < 0 || left > this.width || top > this.height) return false;
      if (structure === null) return true;
      const isNew = !named.has(structure);
      named.add(structure);
      return isNew;
    });
    for (const body of [EGO, ...hit]) {
      beside(body, candidate.poseOf(body, time), shortened(nameOf(body)), COLOURS.ink, true);
    }
    for (const {body, p, plan} of shows.elsewhere) {
      beside(body, poseOn(plan, time), nameElsewhere(body, p, plan), COLOURS.future, true);
    }
    for (const body of rest.length > most ? [] : rest) {
      beside(body, candidate.poseOf(body, time), shortened(structureOf(body) ?? nameOf(body)),
        COLOURS.soft, false);
    }
  }

  scaleBar() {
    const context = this.context;
    const length = this.scaleOf() * 5;
    const y = this.height - 10;
    context.strokeStyle = COLOURS.ink;
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(10, y);
    context.lineTo(10 + length, y);
    context.stroke();
    drawLabel(context, "5 m", 10, y - 5, COLOURS.ink);
  }
}

// Middle of what is seen of a body from above.
function middleOfBody(body, pose) {
  const ends = modelOf(body).outline.map(([forward]) => forward);
  return carry(pose, (Math.min(...ends) + Math.max(...ends)) / 2, 0);
}

// Where a name may stand beside the point that it is led to: straight above, higher or aside,
// below; nearest first.
const LED_PLACES = [0, 25, -25, 50, -50, 80, -80, 120, -120].flatMap((aside) =>
  [-18, -31, -44, -57, -70, -83, -96, 30, 44, 58, 72, 86].map((off) => [aside, off]));
const farOff = ([x, y]) => Math.hypot(x, y > 0 ? 60 + y : y);
LED_PLACES.sort((a, b) => farOff(a) - farOff(b));

// Eight points of a line.
const along = (from, to) => [0, 1, 2, 3, 4, 5, 6, 7].map((i) =>
  [mix(from[0], to[0], i / 7), mix(from[1], to[1], i / 7)]);

// Names on a picture; one that would cover another wherever it may stand, or that stands outside,
// is left out.
class Labels {
  constructor(context, width, height) {
    this.context = context;
    this.width = width;
    this.height = height;
    this.placed = [];
  }

  halfOf(text) {
    this.context.font = "12px system-ui, sans-serif";
    return this.context.measureText(text).width / 2;
  }

  // `places` are those of the middle of the text at which it may stand, best first; returns the one
  // that is taken.
  add(text, places, colour) {
    const half = this.halfOf(text);
    const covers = ([x, y]) => this.placed.some(([otherX, otherY, otherHalf]) =>
      Math.abs(otherY - y) < 13 && Math.abs(otherX - x) < half + otherHalf + 3);
    const at = places.find((place) => !covers(place) && place[0] > half && place[1] >= 12 &&
      place[0] < this.width - half && place[1] < this.height - 3);
    if (!at) return null;
    this.placed.push([...at, half]);
    drawLabel(this.context, text, at[0] - half, at[1], colour);
    return at;
  }

  // Keeps the names that follow off a line.
  keepOff(from, to) {
    this.placed.push(...along(from, to).map(([x, y]) => [x, y + 4, 0]));
  }

  // Whether a line crosses no name.
  isClear(from, to) {
    return !along(from, to).some(([x, y]) => this.placed.some(
      ([otherX, otherY, otherHalf]) => otherHalf > 0 && Math.abs(otherX - x) < otherHalf + 2 &&
        Math.abs(otherY - 4 - y) < 8));
  }

  // A line from the name that stands at a place to the point that it belongs to.
  lead([x, y], to, colour) {
    drawLine(this.context, [[x, y < to[1] ? y + 3 : y - 12], to], 1, colour);
  }

  // At the end of a line that leads to a point and crosses no name.
  led(text, to, colour) {
    if (to[0] < 0 || to[0] > this.width || to[1] < 0 || to[1] > this.height) return;
    const half = this.halfOf(text);
    const places = LED_PLACES.map(([x, y]) =>
      [clamp(to[0] + x, half + 2, this.width - half - 2), to[1] + y]);
    const clear = places.filter((each) => this.isClear(each, to));
    const at = this.add(text, [...clear, ...places], colour);
    if (!at) return;
    this.lead(at, to, colour);
    this.keepOff(at, to);
  }

  // At a point, or shifted up or down; moved inwards where the edge of the picture would cut it.
  above(text, [x, y], shifts, colour) {
    const half = this.halfOf(text);
    if (x < -half || x > this.width + half || y < 0 || y > this.height + 12) return;
    this.add(text, shifts.map((shift) => [clamp(x, half + 2, this.width - half - 2),
      clamp(y + shift, 12, this.height - 4)]), colour);
  }
}

// With a rim of the page's colour.
function drawLine(context, points, width, colour) {
  for (const [each, style] of [[width + 2.5, COLOURS.page], [width, colour]]) {
    context.strokeStyle = style;
    context.lineWidth = each;
    context.beginPath();
    for (const point of points) context.lineTo(...point);
    context.stroke();
  }
}

function drawArrow(context, from, to, colour) {
  const angle = Math.atan2(to[1] - from[1], to[0] - from[0]);
  const wing = (turn) => [to[0] - 9 * Math.cos(angle + turn), to[1] - 9 * Math.sin(angle + turn)];
  drawLine(context, [from, to, wing(0.5), to, wing(-0.5)], 2.5, colour);
}

function drawLabel(context, text, x, y, colour) {
  context.font = "12px system-ui, sans-serif";
  context.lineJoin = "round";
  context.lineWidth = 3;
  context.strokeStyle = COLOURS.page;
  context.strokeText(text, x, y);
  context.fillStyle = colour;
  context.fillText(text, x, y);
}

