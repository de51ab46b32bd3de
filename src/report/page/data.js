// What the page plays: reads its data, and tells where every body is at a time.
// Lengths are metres, times seconds from the decision, angles radians, left positive.

const DATA = JSON.parse(document.getElementById("page-data").textContent);
const EGO = -1;

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

const clamp = (value, low, high) => Math.max(low, Math.min(high, value));
const mix = (a, b, share) => a + (b - a) * share;

// Index of the last time that is not after `ms`, and how far it is on to the next.
function placeIn(times, ms) {
  let low = 0;
  let high = times.length - 1;
  if (ms <= times[0]) return [0, 0];
  if (ms >= times[high]) return [high, 0];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= ms) low = middle;
    else high = middle;
  }
  return [low, (ms - times[low]) / (times[high] - times[low])];
}

function poseOn(track, time) {
  const [i, share] = placeIn(track.t, 1000 * time);
  const at = (column) => share > 0 ? mix(column[i], column[i + 1], share) : column[i];
  return {
    x: at(track.x) / 1000,
    y: at(track.y) / 1000,
    z: track.z ? at(track.z) / 1000 : 0,
    heading: at(track.a) / 10000,
  };
}

// The body's point (forward, left) in the world.
function carry(pose, forward, left) {
  const c = Math.cos(pose.heading);
  const s = Math.sin(pose.heading);
  return [pose.x + c * forward - s * left, pose.y + s * forward + c * left];
}

function modelOf(body) {
  return DATA.models[body === EGO ? DATA.ego.model : DATA.actors[body].model];
}

const tiltOf = (body) => body === EGO ? DATA.ego.tilt : DATA.actors[body].tilt;
const nameOf = (body) => body === EGO ? "our car" : DATA.actors[body].name;

// What an actor is called in a future that is not the likeliest.
function nameElsewhere(body, p, plan) {
  const turns = Math.abs(plan.a[plan.a.length - 1] - plan.a[0]) > 5000;
  return `${shortened(nameOf(body))}, ${turns ? "if it turns" : "perhaps here"} (${percent(p)})`;
}

// Walls 1 to 4 are one structure.
const structureOf = (body) =>
  modelOf(body).fixed ? nameOf(body).replace(/[\s_-]*\d+$/, "") : null;

// Words that fit a narrow place; the whole name stands in the text of the page.
function shortened(words, most = 24) {
  const letters = [...words];
  return letters.length <= most ? words : letters.slice(0, most - 1).join("").trimEnd() + "…";
}

// Corners of what is seen of a body from above.
function outlineAt(body, pose) {
  return modelOf(body).outline.map(([forward, left]) => carry(pose, forward, left));
}

// Runs of intact and damaged triangles in turn, as [first, count] of the damaged ones.
function damagedRuns(base64) {
  const runs = [];
  let triangle = 0;
  let length = 0;
  let shift = 0;
  let isDamaged = false;
  for (const byte of bytesOf(base64)) {
    length += (byte & 127) * 2 ** shift;
    shift += 7;
    if (byte & 128) continue;
    if (isDamaged) runs.push([triangle, length]);
    triangle += length;
    isDamaged = !isDamaged;
    length = shift = 0;
  }
  return runs;
}

// One candidate and its crash in the likeliest future.
class Candidate {
  constructor(source) {
    this.source = source;
    this.row = source.row;
    this.name = DATA.rows[source.row][2];
    // What people call it; its place tells manoeuvres of a grid that are called alike apart.
    this.words = `${DATA.rows[source.row][0]}. ${DATA.rows[source.row][3] || this.name}`;
    this.contacts = source.contacts;
    this.first = this.contacts.length > 0 ? this.contacts[0].t : null;
    this.end = source.end;
    this.bodies = new Map(source.bodies.map((body) => [body.body, body]));
    const isPlayed = source.bodies.some((body) => body.motion);
    this.frozen = this.first !== null && !isPlayed ? this.first : Infinity;
    // Bodies whose crash is worth a trace, a label and a place in the picture.
    this.hit = [...this.bodies.keys()];
  }

  // When to begin: a second before the first contact of any future.
  get begin() {
    let first = this.first === null ? Infinity : this.first;
    for (const future of this.source.futures) {
      if (future.t !== undefined) first = Math.min(first, future.t);
    }
    return Number.isFinite(first) ? Math.max(0, first - 1) : 0;
  }

  planOf(body) {
    return body === EGO ? this.source.plan : DATA.actors[body].plan;
  }

  poseOf(body, time) {
    const moved = this.bodies.get(body);
    const now = Math.min(time, this.frozen);
    if (moved && moved.motion && 1000 * now >= moved.motion.t[0]) return poseOn(moved.motion, now);
    return poseOn(this.planOf(body), now);
  }

  // Whether a contact has damaged the body by then.
  isDamaged(body, time) {
    return this.contacts.some((contact) => contact.t <= time && contact.bodies.includes(body));
  }

  exposureOf(body, time) {
    const moved = this.bodies.get(body);
    if (!moved || !moved.exposure || 1000 * time < moved.exposure.t[0]) return 0;
    const [i, share] = placeIn(moved.exposure.t, 1000 * time);
    const v = moved.exposure.v;
    return (share > 0 ? mix(v[i], v[i + 1], share) : v[i]) / 1000;
  }

  // Where an actor is in other futures, until this one or that one has its crash: what would have
  // been afterwards belongs to another story.
  elsewhere(time) {
    return ELSEWHERE.filter(({body}) => time < Math.min(this.first ?? Infinity,
      ...this.source.futures.filter((future) => future.body === body && !future.likeliest)
        .map((future) => future.t + 0.3)));
  }

  // The last time at which its way is still another's: both are within half a metre, and within
  // 2 m/s of speed over the step that follows.
  partsFrom(other) {
    const step = 0.02;
    const until = Math.min(DATA.horizon, this.first ?? Infinity, other.first ?? Infinity);
    for (let time = 0; time < until; time += step) {
      const mine = poseOn(this.source.plan, time + step);
      const its = poseOn(other.source.plan, time + step);
      if (Math.hypot(mine.x - its.x, mine.y - its.y) > 0.5) return time;
    }
    return until;
  }
}

const CANDIDATES = DATA.candidates.map((source) => new Candidate(source));
const candidateOfRow = (row) => CANDIDATES.find((candidate) => candidate.row === row);

// Bodies that exist in the likeliest future, the ego last, so that it is drawn over the others.
const BODIES = DATA.actors.map((_, i) => i).filter((i) => DATA.actors[i].exists).concat([EGO]);

// Where an actor goes in futures that are not the likeliest: [{body, p, plan}].
const ELSEWHERE = DATA.actors.flatMap((actor, body) => {
  const others = actor.others.map(({p, plan}) => ({body, p, plan}));
  if (!actor.exists && actor.p > 0) others.push({body, p: actor.p, plan: actor.plan});
  return others;
});

// The motion that an actor is most likely on where a future lets it meet the ego.
function planInFuture(candidate, future) {
  const ego = poseOn(candidate.source.plan, future.t);
  const plans = [candidate.planOf(future.body)].concat(
    ELSEWHERE.filter(({body}) => body === future.body).map(({plan}) => plan));
  const gap = (plan) => {
    const pose = poseOn(plan, future.t);
    return Math.hypot(pose.x - ego.x, pose.y - ego.y);
  };
  return plans.reduce((best, plan) => gap(plan) < gap(best) ? plan : best);
}

// Points in the world, [x, y], that a picture of the whole manoeuvre has to show: the ego and whom
// it meets from the begin to the end.
function sceneOf(candidate) {
  const points = [];
  const add = (body, pose) => points.push(...outlineAt(body, pose));
  // What little lies before the begin is seen as well.
  const begin = candidate.begin < 0.5 ? 0 : candidate.begin;
  const until = candidate.first === null ? candidate.end : Math.min(candidate.end, candidate.first + 3);
  const bodies = new Set(candidate.hit).add(EGO);
  for (const body of bodies) {
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      add(body, candidate.poseOf(body, mix(begin, until, share)));
    }
    if (candidate.first !== null) add(body, candidate.poseOf(body, candidate.first));
  }
  for (const future of candidate.source.futures) {
    if (future.t === undefined) continue;
    const plan = planInFuture(candidate, future);
    for (const time of [begin, future.t]) add(future.body, poseOn(plan, time));
  }
  // So are bodies that may go elsewhere, as long as they are within sight.
  for (const {body, plan} of ELSEWHERE) {
    for (const track of [plan, candidate.planOf(body)]) {
      for (const time of [begin, mix(begin, until, 0.5)]) {
        const pose = poseOn(track, time);
        if (Math.hypot(pose.x - points[0][0], pose.y - points[0][1]) < 50) add(body, pose);
      }
    }
  }
  // Whom it passes is a part of its way, and so is whom another manoeuvre hits.
  const reach = (pose) => Math.min(...points.map(([x, y]) => Math.hypot(x - pose.x, y - pose.y)));
  const near = candidate.first === null ? 12 : 5;
  const ways = points.slice();
  const comesNear = (body) => candidate.first === null &&
    reach(candidate.poseOf(body, begin)) < 35 && [0.25, 0.5, 0.75].some((share) => {
      const {x, y} = candidate.poseOf(body, mix(begin, until, share));
      return ways.some((point) => Math.hypot(point[0] - x, point[1] - y) < near);
    });
  const others = new Set(CANDIDATES.slice(0, 5).flatMap((each) => each.hit));
  for (const body of BODIES.filter((each) => !bodies.has(each))) {
    const pose = candidate.poseOf(body, begin);
    if (reach(pose) < (others.has(body) ? 15 : near) || comesNear(body)) add(body, pose);
  }
  return points;
}

// Points of the bodies that crash, in the second after the first contact.
function crashOf(candidate) {
  const moving = candidate.hit.filter((body) => !modelOf(body).fixed);
  return [candidate.contacts[0].at.slice(0, 2)].concat([0, 0.3, 1].flatMap((after) =>
    moving.flatMap((body) => outlineAt(body, candidate.poseOf(body, candidate.first + after)))));
}

// Whether another body hides the ego from an eye, [x, y, z].
function isHidden(candidate, time, eye) {
  const pose = candidate.poseOf(EGO, time);
  const point = [...middleOfBody(EGO, pose), pose.z + modelOf(EGO).height / 2];
  const [px, py, pz] = point;
  const [dx, dy, dz] = eye.map((value, i) => value - point[i]);
  return BODIES.some((body) => {
    const ring = body === EGO ? [] : outlineAt(body, candidate.poseOf(body, time));
    // Where the line of sight crosses a side.
    return ring.some(([ax, ay], i) => {
      const [bx, by] = ring[(i + 1) % ring.length];
      const across = dx * (by - ay) - dy * (bx - ax);
      const share = ((ax - px) * (by - ay) - (ay - py) * (bx - ax)) / across;
      const along = ((ax - px) * dy - (ay - py) * dx) / across;
      return share > 0 && share < 1 && along >= 0 && along <= 1 &&
        pz + share * dz < modelOf(body).height;
    });
  });
}

// Colours of the style sheet, which follow the light or dark scheme.
let COLOURS = {};
function readColours() {
  const style = getComputedStyle(document.documentElement);
  for (const name of ["page", "ink", "soft", "line", "ego", "other", "still", "damage", "asphalt",
    "ground", "sky", "ghost", "future", "mark"]) {
    COLOURS[name] = style.getPropertyValue("--" + name).trim();
  }
}

// "#rrggbb" as three numbers from 0 to 1.
function rgbOf(colour) {
  const value = parseInt(colour.slice(1), 16);
  return [(value >> 16) / 255, (value >> 8 & 255) / 255, (value & 255) / 255];
}

const percent = (p) => (p > 0 && p < 0.01 ? "<1" : Math.round(100 * p)) + " %";
const kmh = (speed) => Math.round(3.6 * speed) + " km/h";

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.append(...children);
  return made;
}

