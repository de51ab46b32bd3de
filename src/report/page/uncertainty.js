// What is not known: the harm of every future as a strip with pictures, and places over samples.

const SVG = "http://www.w3.org/2000/svg";
function svg(tag, attributes, text) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  if (text !== undefined) made.textContent = text;
  return made;
}

// A strip for each candidate, as wide as a future is probable and coloured by its harm.
function showFutures(candidate) {
  const holder = document.getElementById("futures");
  const listed = CANDIDATES.filter((each) => each.source.futures.length > 1).slice(0, 6);
  if (listed.length === 0) return;
  const most = Math.max(...listed.flatMap(
    (each) => each.source.futures.map((future) => future.score))) || 1;
  const strips = listed.map((each) => {
    const strip = element("div", {class: "strip"});
    for (const future of each.source.futures) {
      if (!(future.p > 0)) continue;
      const part = element("span", {title: futureWords(future)});
      if (future.p > 0.08) part.append(element("b", {}, percent(future.p)));
      part.style.flexGrow = future.p;
      part.style.setProperty("--share", 100 * future.score / most + "%");
      strip.append(part);
    }
    const row = element("div", {class: each === candidate ? "future chosen" : "future"},
      element("span", {}, each.name), strip);
    return row;
  });
  holder.replaceChildren(element("h3", {}, `${DATA.measure} in each future, as wide as it is probable`),
    ...strips, futurePictures(candidate, most));
}

function futureWords(future) {
  const what = future.t === undefined ? "no contact"
    : `contact with ${nameOf(future.body)} after ${future.t.toFixed(2)} s at ${kmh(future.closing)}`;
  return `${percent(future.p)}${future.likeliest ? " (likeliest)" : ""}: ${what}` +
    (future.leaves ? ", leaves the road" : "") + `; ${DATA.measure} ${Number(future.score.toPrecision(2))}`;
}

// A small plan of each of the candidate's likeliest futures, at its contact.
function futurePictures(candidate, most) {
  const figures = candidate.source.futures.filter((future) => future.p > 0).slice(0, 6)
    .map((future) => {
      const canvas = element("canvas", {role: "img", "aria-label": futureWords(future)});
      const figure = element("figure", {}, canvas, element("figcaption", {}, futureWords(future)));
      figure.style.setProperty("--share", 100 * future.score / most + "%");
      drawFuture(canvas, candidate, future);
      return figure;
    });
  return element("div", {class: "pictures"}, ...figures);
}

function drawFuture(canvas, candidate, future) {
  const [width, height] = [220, 120];
  canvas.width = 2 * width;
  canvas.height = 2 * height;
  const context = canvas.getContext("2d");
  context.setTransform(2, 0, 0, 2, 0, 0);
  const time = future.t ?? Math.min(candidate.end, DATA.horizon) / 2;
  const ego = poseOn(candidate.source.plan, time);
  const scale = 7;
  const c = Math.cos(-ego.heading) * scale;
  const s = Math.sin(-ego.heading) * scale;
  const to = (x, y) => [width / 2 + c * (x - ego.x) - s * (y - ego.y),
    height / 2 - s * (x - ego.x) - c * (y - ego.y)];
  drawRoad(context, to, width, height);
  const fill = (body, pose, colour) => {
    context.beginPath();
    for (const [x, y] of outlineAt(body, pose)) context.lineTo(...to(x, y));
    context.closePath();
    context.fillStyle = colour;
    context.fill();
    context.strokeStyle = COLOURS.ink;
    context.lineWidth = 0.75;
    context.stroke();
  };
  for (const body of BODIES) {
    if (body === EGO || body === future.body) continue;
    fill(body, poseOn(candidate.planOf(body), time), COLOURS.still);
  }
  if (future.t !== undefined) {
    fill(future.body, poseOn(planInFuture(candidate, future), time), COLOURS.other);
  }
  fill(EGO, ego, COLOURS.ego);
}

// Places of the first candidates in every sample of what is not known, as wide as the page has room.
function showStability() {
  const told = DATA.stability;
  // Where all are first throughout there is nothing to see.
  if (!told || told.places.flat().every((place) => place === 1)) return;
  const holder = document.getElementById("stability");
  const samples = told.places[0].length;
  const width = clamp(holder.clientWidth, 300, 1000);
  const [step, left, letter] = [24, 24, 6.6];
  // Names get what they need, half of the chart at most.
  const most = Math.floor(width / 2 / letter);
  const names = told.names.map((name) => shortened(name, most));
  const right = 14 + letter * Math.max(...names.map((name) => [...name].length));
  const deepest = Math.min(Math.max(...told.places.flat()), told.places.length + 4);
  const foot = 8 + step * deepest;
  const chart = svg("svg", {class: "bump", role: "img",
    "aria-label": "Places of the first candidates over the samples of what is not known"});
  const x = (i) => left + (width - left - right) * (samples > 1 ? i / (samples - 1) : 0);
  const y = (place) => 8 + step * (Math.min(place, deepest) - 0.5);
  for (let place = 1; place <= deepest; ++place) {
    chart.append(svg("text", {x: 4, y: y(place) + 4}, place));
  }
  // Titles of groups stand in the first line in which they cover none.
  const lines = [];
  let begin = 0;
  for (const [title, count] of told.groups) {
    if (count / samples > 0.12) {
      let line = lines.findIndex((end) => end < x(begin));
      if (line < 0) line = lines.length;
      lines[line] = x(begin) + letter * title.length + 8;
      const base = foot + 16 * (line + 1);
      chart.append(svg("line", {x1: x(begin), x2: x(begin), y1: 4, y2: base, class: "rule"}));
      chart.append(svg("text", {x: x(begin) + 3, y: base}, title));
    }
    begin += count;
  }
  const height = foot + 16 * lines.length + 6;
  chart.setAttribute("viewBox", `0 0 ${width} ${height}`);
  told.places.forEach((places, k) => {
    const points = places.map((place, i) => `${x(i).toFixed(1)},${y(place).toFixed(1)}`).join(" ");
    const line = svg("polyline", {points, class: k === 0 ? "first" : "later"});
    line.style.setProperty("--turn", `${47 * k}deg`);
    line.append(svg("title", {}, told.names[k]));
    const name = svg("text", {x: width - right + 8, y: y(places[samples - 1]) + 4, class: "name"},
      names[k]);
    name.append(svg("title", {}, told.names[k]));
    chart.append(line, name);
  });
  spreadNames(chart, step * 0.6);
  holder.replaceChildren(
    element("h3", {}, `Places over ${samples} samples of what is not known`), chart,
    element("p", {class: "hint"}, "Every column is one combination of friction, stiffness, " +
      "restitution and injury curves; lines that do not cross are certain against each other."));
}

// Names at the end of the lines stand below each other where they would cover each other.
function spreadNames(chart, gap) {
  const names = [...chart.querySelectorAll(".name")];
  names.sort((a, b) => a.getAttribute("y") - b.getAttribute("y"));
  let before = -Infinity;
  for (const name of names) {
    const y = Math.max(Number(name.getAttribute("y")), before + gap);
    name.setAttribute("y", y.toFixed(1));
    before = y;
  }
}
