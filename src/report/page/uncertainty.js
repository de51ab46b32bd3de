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
    : `hits ${nameOf(future.body)} after ${future.t.toFixed(2)} s at ${kmh(future.closing)}`;
  return `${percent(future.p)}${future.likeliest ? " (likeliest)" : ""}: ${what}` +
    (future.leaves ? ", leaves the road" : "") + `; ${DATA.measure} ${future.score}`;
}

// A small plan of each of the candidate's likeliest futures, at its contact.
function futurePictures(candidate, most) {
  const figures = candidate.source.futures.filter((future) => future.p > 0).slice(0, 6)
    .map((future) => {
      const canvas = element("canvas", {role: "img", "aria-label": futureWords(future)});
      const figure = element("figure", {}, canvas, element("figcaption", {}, futureWords(future)));
      figure.style.setProperty("--share", 100 * future.score / most + "%");
      requestAnimationFrame(() => drawFuture(canvas, candidate, future));
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

// Places of the first candidates in every sample of what is not known.
function showStability() {
  const told = DATA.stability;
  if (!told) return;
  const holder = document.getElementById("stability");
  const samples = told.places[0].length;
  const [width, step, left, right] = [760, 24, 30, 190];
  const deepest = Math.min(Math.max(...told.places.flat()), told.places.length + 4);
  const height = 34 + step * deepest;
  const chart = svg("svg", {viewBox: `0 0 ${width} ${height}`, class: "bump", role: "img",
    "aria-label": "Places of the first candidates over the samples of what is not known"});
  const x = (i) => left + (width - left - right) * (samples > 1 ? i / (samples - 1) : 0);
  const y = (place) => 8 + step * (Math.min(place, deepest) - 0.5);
  for (let place = 1; place <= deepest; ++place) {
    chart.append(svg("text", {x: 4, y: y(place) + 4}, place));
  }
  let begin = 0;
  for (const [title, count] of told.groups) {
    chart.append(svg("line", {x1: x(begin), x2: x(begin), y1: 4, y2: height - 26, class: "rule"}));
    if (count / samples > 0.12) {
      chart.append(svg("text", {x: x(begin) + 3, y: height - 8}, title));
    }
    begin += count;
  }
  told.places.forEach((places, k) => {
    const points = places.map((place, i) => `${x(i).toFixed(1)},${y(place).toFixed(1)}`).join(" ");
    const line = svg("polyline", {points, class: k === 0 ? "first" : "later"});
    line.style.setProperty("--turn", `${47 * k}deg`);
    line.append(svg("title", {}, told.names[k]));
    const name = svg("text", {x: width - right + 8, y: y(places[samples - 1]) + 4}, told.names[k]);
    chart.append(line, name);
  });
  spreadNames(chart, step * 0.6, width - right);
  holder.replaceChildren(
    element("h3", {}, `Places over ${samples} samples of what is not known`), chart,
    element("p", {class: "hint"}, "Every column is one combination of friction, stiffness, " +
      "restitution and injury curves; lines that do not cross are certain against each other."));
}

// Names at the end of the lines stand below each other where they would cover each other.
function spreadNames(chart, gap, from) {
  const names = [...chart.querySelectorAll("text")].filter(
    (text) => Number(text.getAttribute("x")) > from);
  names.sort((a, b) => a.getAttribute("y") - b.getAttribute("y"));
  let before = -Infinity;
  for (const name of names) {
    const y = Math.max(Number(name.getAttribute("y")), before + gap);
    name.setAttribute("y", y.toFixed(1));
    before = y;
  }
}

