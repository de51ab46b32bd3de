// The scene in three dimensions, drawn with WebGL 2: the road as a picture on the ground, shadows,
// ways, and all bodies as meshes that turn red and dent where the crash damages them.

const MOST_DENTS = 4;

const BODY_VERTEX = `#version 300 es
in vec3 corner;
in vec3 colour;
in float damaged;
uniform mat4 view;
uniform mat4 body;
uniform vec3 origin, size;
uniform float damage;
uniform int dents;
uniform vec4 along[${MOST_DENTS}];  // direction, where the surface is, depth
uniform vec3 low[${MOST_DENTS}], high[${MOST_DENTS}];
out vec3 world, paint;
void main() {
  vec3 p = origin + size * corner;
  for (int i = 0; i < dents; ++i) {
    vec3 outside = max(max(low[i] - p, p - high[i]), vec3(0.0));
    float near = 1.0 - smoothstep(0.0, 0.3, length(outside));
    float depth = along[i].z + along[i].w - dot(p.xy, along[i].xy);
    if (depth > 0.0) p.xy += near * depth * along[i].xy;
  }
  vec4 at = body * vec4(p, 1.0);
  world = at.xyz;
  paint = mix(colour, vec3(0.85, 0.09, 0.05), damaged * damage);
  gl_Position = view * at;
}`;

const BODY_FRAGMENT = `#version 300 es
precision highp float;
in vec3 world, paint;
uniform vec3 eye, fog;
uniform float alpha, haze;
out vec4 shown;
void main() {
  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
  vec3 to_eye = normalize(eye - world);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  float sun = max(dot(normal, normalize(vec3(-0.4, 0.5, 0.75))), 0.0);
  float sky = 0.5 + 0.5 * normal.z;
  float shine = pow(max(dot(reflect(-to_eye, normal), normalize(vec3(-0.4, 0.5, 0.75))), 0.0), 24.0);
  vec3 light = paint * (0.35 + 0.2 * sky + 0.55 * sun) + 0.1 * shine;
  shown = vec4(mix(light, fog, 1.0 - exp(-haze * distance(eye, world))), alpha);
}`;

const FLAT_VERTEX = `#version 300 es
in vec3 corner;
in vec4 colour;
uniform mat4 view;
out vec4 paint;
out vec3 world;
void main() {
  paint = colour;
  world = corner;
  gl_Position = view * vec4(corner, 1.0);
}`;

const FLAT_FRAGMENT = `#version 300 es
precision highp float;
in vec4 paint;
in vec3 world;
uniform vec3 eye, fog;
uniform vec4 box;
uniform float haze;
uniform sampler2D road;
out vec4 shown;
void main() {
  vec4 colour = paint;
  if (paint.a < 0.0) {
    vec2 at = (world.xy - box.xy) / box.zw;
    colour = vec4(texture(road, clamp(at, 0.0, 1.0)).rgb, 1.0);
  }
  shown = vec4(mix(colour.rgb, fog, 1.0 - exp(-haze * distance(eye, world))), colour.a);
}`;

function multiply(a, b) {
  const out = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, times = 1) => a.map((value, i) => value + times * b[i]);

// Where a camera looks: to the right, up and ahead, for its azimuth and elevation above the ground.
function cameraAxes(azimuth, elevation) {
  const [ca, sa, ce, se] = [Math.cos(azimuth), Math.sin(azimuth), Math.cos(elevation),
    Math.sin(elevation)];
  return {right: [-sa, ca, 0], up: [-ca * se, -sa * se, ce], ahead: [-ca * ce, -sa * ce, -se]};
}

// Where a camera stands so that points, [place across, depth], lie as far to one side as to the
// other in its picture.
function middleOf(points) {
  let [low, high] = [Math.min(...points.map(([at]) => at)), Math.max(...points.map(([at]) => at))];
  for (let i = 0; i < 30; ++i) {
    const middle = (low + high) / 2;
    const slopes = points.map(([at, depth]) => (at - middle) / depth);
    if (Math.max(...slopes) + Math.min(...slopes) > 0) low = middle;
    else high = middle;
  }
  return (low + high) / 2;
}

function bodyMatrix(body, pose) {
  const c = Math.cos(pose.heading);
  const s = Math.sin(pose.heading);
  const t = tiltOf(body) || [1, 0, 0, 0, 1, 0, 0, 0, 1];
  const column = (k) => [c * t[k] - s * t[3 + k], s * t[k] + c * t[3 + k], t[6 + k], 0];
  return new Float32Array([...column(0), ...column(1), ...column(2), pose.x, pose.y, pose.z, 1]);
}

// Three corners of its own for every triangle, so that each has a colour of its own.
const decodedMeshes = new Map();
function decodedMesh(model) {
  if (decodedMeshes.has(model)) return decodedMeshes.get(model);
  const mesh = DATA.models[model].mesh;
  const positions = new Uint16Array(bytesOf(mesh.positions).buffer);
  const indices = new Uint16Array(bytesOf(mesh.indices).buffer);
  const corners = new Uint16Array(3 * indices.length);
  for (let i = 0; i < indices.length; ++i) {
    for (let k = 0; k < 3; ++k) corners[3 * i + k] = positions[3 * indices[i] + k];
  }
  const paint = (which) => {
    const colours = new Uint8Array(3 * indices.length);
    for (const part of mesh.parts) {
      const rgb = rgbOf(part[which]).map((value) => 255 * value);
      for (let i = 3 * part[0]; i < 3 * (part[0] + part[1]); ++i) colours.set(rgb, 3 * i);
    }
    return colours;
  };
  const made = {mesh, corners, count: indices.length, ego: paint(2), other: paint(3)};
  decodedMeshes.set(model, made);
  return made;
}

class View3d {
  // Throws where the browser has no WebGL 2.
  constructor(canvas, overlay) {
    this.canvas = canvas;
    this.overlay = overlay;
    const gl = canvas.getContext("webgl2",
      {alpha: false, antialias: true, preserveDrawingBuffer: true});
    if (!gl) throw new Error("no WebGL 2");
    this.gl = gl;
    this.bodies = this.program(BODY_VERTEX, BODY_FRAGMENT);
    this.flat = this.program(FLAT_VERTEX, FLAT_FRAGMENT);
    this.buffers = new Map();
    this.flatBuffer = gl.createBuffer();
    this.texture = gl.createTexture();
  }

  program(vertex, fragment) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error("WebGL 2: " + gl.getProgramInfoLog(program));
    }
    const places = {program};
    const count = (what) => gl.getProgramParameter(program, what);
    for (let i = 0; i < count(gl.ACTIVE_UNIFORMS); ++i) {
      const name = gl.getActiveUniform(program, i).name.replace("[0]", "");
      places[name] = gl.getUniformLocation(program, name);
    }
    for (let i = 0; i < count(gl.ACTIVE_ATTRIBUTES); ++i) {
      const name = gl.getActiveAttrib(program, i).name;
      places[name] = gl.getAttribLocation(program, name);
    }
    return places;
  }

  reset() {
    if (this.candidate) this.fit(this.candidate);
  }

  move(dx, dy, isShift) {
    this.near = null;
    if (isShift) {
      const {right, up} = cameraAxes(this.azimuth, this.elevation);
      const step = this.distance * 1.2 / Math.max(1, this.canvas.clientHeight);
      this.target = plus(plus(this.target, right, -dx * step), up, dy * step);
    } else {
      this.azimuth -= 0.008 * dx;
      this.elevation = clamp(this.elevation + 0.006 * dy, 0.05, 1.5);
    }
  }

  nearer(factor) {
    this.near = null;
    this.distance = clamp(this.distance / factor, 2, 400);
  }

  // Finds the camera from which the whole manoeuvre is seen, nearest to where the bodies meet, and
  // one that it becomes until the first contact, which sees the crash alone.
  fit(candidate) {
    this.candidate = candidate;
    const raised = (flat) => flat.flatMap(([x, y]) => [[x, y, 0], [x, y, 1.6]]);
    const points = raised(sceneOf(candidate));
    const crash = candidate.first === null ? [] : raised(crashOf(candidate));
    const width = this.canvas.clientWidth || 600;
    const height = this.canvas.clientHeight || 400;
    const heading = poseOn(candidate.source.plan, candidate.first ?? candidate.begin).heading;
    const start = candidate.poseOf(EGO, candidate.begin);
    const focus = candidate.first !== null ? candidate.contacts[0].at
      : [start.x, start.y, start.z];
    const partner = candidate.hit.find((body) => body !== EGO);
    const their = partner === undefined ? null : candidate.poseOf(partner, candidate.begin);
    const meant = [[start.x, start.y, 0], focus].concat(their ? [[their.x, their.y, 0]] : []);
    let best = null;
    for (const beside of [2.75, -2.75, 2.45, -2.45, 2.1, -2.1, 1.75, -1.75]) {
      for (const elevation of [0.28, 0.38, 0.5]) {
        const [found, near] = [points, crash].map((each) =>
          each.length > 0 ? this.fitted(each, heading + beside, elevation, width, height) : null);
        // What is far is small: none of the three shall be.
        const reach = meant.reduce(
          (sum, point) => sum + Math.log(Math.hypot(...plus(found.eye, point, -1))),
          near && isHidden(candidate, candidate.first, near.eye) ? 2 : 0);
        if (best === null || reach < best.reach) best = {...found, reach, near};
      }
    }
    const {azimuth, elevation, target, distance} = best;
    Object.assign(this, {azimuth, elevation, target, distance, whole: best, near: best.near});
    this.paintRoad(points);
  }

  // The nearest camera of a direction that has all points between the edges of its picture.
  fitted(points, azimuth, elevation, width, height) {
    const axes = cameraAxes(azimuth, elevation);
    const slope = [0.92 * this.tangent() * width / height, 0.9 * this.tangent()];
    const depths = points.map((point) => dot(point, axes.ahead));
    const backs = [axes.right, axes.up].map((axis, k) => {
      const at = points.map((point) => dot(point, axis));
      const low = Math.min(...at.map((value, i) => value + slope[k] * depths[i]));
      const high = Math.max(...at.map((value, i) => value - slope[k] * depths[i]));
      return (high - low) / (2 * slope[k]);
    });
    const back = Math.max(...backs, 9 - Math.min(...depths));
    const middles = [axes.right, axes.up].map((axis) => {
      const at = points.map((point, i) => [dot(point, axis), depths[i] + back]);
      return middleOf(at);
    });
    let eye = axes.ahead.map((value) => -back * value);
    eye = plus(plus(eye, axes.right, middles[0]), axes.up, middles[1]);
    const distance = Math.max(4, (Math.min(...depths) + Math.max(...depths)) / 2 + back);
    return {azimuth, elevation, eye, distance, target: plus(eye, axes.ahead, distance)};
  }

  tangent() { return Math.tan(0.32); }

  // The road around the scene as the ground's picture.
  paintRoad(points) {
    const gl = this.gl;
    const reach = (axis, sign) => sign * Math.max(...points.map((point) => sign * point[axis]));
    const margin = 40;
    const [left, bottom] = [reach(0, -1) - margin, reach(1, -1) - margin];
    const size = [reach(0, 1) + margin - left, reach(1, 1) + margin - bottom];
    this.box = [left, bottom, size[0], size[1]];
    const canvas = document.createElement("canvas");
    canvas.width = canvas.height = 2048;
    const context = canvas.getContext("2d");
    const to = (x, y) => [(x - left) / size[0] * 2048, (y - bottom) / size[1] * 2048];
    drawRoad(context, to, 2048, 2048);
    drawGrid(context, to, [left, bottom, left + size[0], bottom + size[1]]);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, canvas);
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    const anisotropic = gl.getExtension("EXT_texture_filter_anisotropic");
    if (anisotropic) gl.texParameterf(gl.TEXTURE_2D, anisotropic.TEXTURE_MAX_ANISOTROPY_EXT, 8);
  }

  camera() {
    const {right, up, ahead} = cameraAxes(this.azimuth, this.elevation);
    this.eye = plus(this.target, ahead, -this.distance);
    const look = new Float32Array([right[0], up[0], -ahead[0], 0, right[1], up[1], -ahead[1], 0,
      right[2], up[2], -ahead[2], 0, -dot(right, this.eye), -dot(up, this.eye),
      dot(ahead, this.eye), 1]);
    const [near, far] = [Math.max(0.3, this.distance / 60), 2000];
    const f = 1 / this.tangent();
    const lens = new Float32Array([f * this.height / this.width, 0, 0, 0, 0, f, 0, 0, 0, 0,
      (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0]);
    this.view = multiply(lens, look);
  }

  // A point of the world on the canvas, or null behind the camera.
  onCanvas(x, y, z) {
    const m = this.view;
    const at = (row) => m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row];
    const w = at(3);
    if (w < 0.1) return null;
    return [(0.5 + 0.5 * at(0) / w) * this.width, (0.5 - 0.5 * at(1) / w) * this.height];
  }

  draw(candidate, time, shows) {
    const gl = this.gl;
    if (this.candidate !== candidate) this.fit(candidate);
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.width = this.canvas.clientWidth;
    this.height = this.canvas.clientHeight;
    if (!(this.width > 0)) return;
    for (const canvas of [this.canvas, this.overlay]) {
      const [width, height] = [Math.round(this.width * ratio), Math.round(this.height * ratio)];
      if (canvas.width !== width) canvas.width = width;
      if (canvas.height !== height) canvas.height = height;
    }
    if (this.near) {
      const passed = clamp((time - candidate.begin) / (candidate.first - candidate.begin || 1), 0, 1);
      const share = passed * passed * (3 - 2 * passed);
      this.target = this.whole.target.map((value, i) => mix(value, this.near.target[i], share));
      this.distance = mix(this.whole.distance, this.near.distance, share);
    }
    this.camera();
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    this.fog = rgbOf(COLOURS.sky);
    gl.clearColor(...this.fog, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.ground(candidate, time, shows);
    gl.enable(gl.DEPTH_TEST);
    for (const body of BODIES) {
      this.mesh(candidate, body, candidate.poseOf(body, time), time, 1);
    }
    for (const {body, p, plan} of shows.elsewhere) {
      this.mesh(null, body, poseOn(plan, time), time, clamp(p, 0.2, 0.7));
    }
    const mine = candidate.poseOf(EGO, time);
    for (const other of shows.ghosts.slice(0, 3)) {
      const pose = other.poseOf(EGO, time);
      // Where both are still in one place, nothing of the ghost would be seen but a veil.
      const apart = Math.hypot(pose.x - mine.x, pose.y - mine.y);
      if (apart > 0.8) this.mesh(null, EGO, pose, time, clamp(0.12 * apart, 0.05, 0.3));
    }
    gl.disable(gl.DEPTH_TEST);
    this.words(candidate, time, ratio, shows);
  }

  // The road, shadows and ways, all flat.
  ground(candidate, time, shows) {
    const gl = this.gl;
    const data = [];
    const corner = (x, y, colour) => data.push(x, y, 0, ...colour);
    const quad = (a, b, c, d, colour) => {
      for (const [x, y] of [a, b, c, a, c, d]) corner(x, y, colour);
    };
    const [x, y] = this.target;
    const far = 1500;
    quad([x - far, y - far], [x + far, y - far], [x + far, y + far], [x - far, y + far],
      [0, 0, 0, -1]);
    const ribbon = (track, from, until, half, colour) => {
      let before = null;
      for (let i = 0; i <= 40; ++i) {
        const pose = poseOn(track, mix(from, until, i / 40));
        const here = [carry(pose, 0, half), carry(pose, 0, -half)];
        if (before) quad(before[0], before[1], here[1], here[0], colour);
        before = here;
      }
    };
    for (const other of shows.ghosts) {
      ribbon(other.source.plan, 0, other.first ?? other.end, 0.08,
        [...rgbOf(COLOURS.ghost), 0.6]);
    }
    for (const {p, plan} of shows.elsewhere) {
      ribbon(plan, 0, DATA.horizon, 0.1, [...rgbOf(COLOURS.future), clamp(p + 0.2, 0.3, 0.9)]);
    }
    ribbon(candidate.source.plan, 0, candidate.first ?? candidate.end, 0.15,
      [...rgbOf(COLOURS.ego), 0.8]);
    for (const body of BODIES) {
      const pose = candidate.poseOf(body, time);
      const reach = 0.35 * Math.min(4, modelOf(body).height);
      for (const [grown, shift, alpha] of [[0.12, 0, 0.3], [0.1, reach, 0.18]]) {
        this.shadow(body, pose, grown, shift, alpha, corner);
      }
    }
    gl.useProgram(this.flat.program);
    gl.uniformMatrix4fv(this.flat.view, false, this.view);
    gl.uniform3fv(this.flat.eye, this.eye);
    gl.uniform3fv(this.flat.fog, this.fog);
    gl.uniform4fv(this.flat.box, this.box);
    gl.uniform1f(this.flat.haze, 0.003);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.flatBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.DYNAMIC_DRAW);
    this.attribute(this.flat.corner, 3, gl.FLOAT, false, 28, 0);
    this.attribute(this.flat.colour, 4, gl.FLOAT, false, 28, 12);
    gl.drawArrays(gl.TRIANGLES, 0, data.length / 7);
  }

  // The outline of a body on the ground, away from the sun.
  shadow(body, pose, grown, shift, alpha, corner) {
    const ring = modelOf(body).outline.map(([forward, left]) => {
      const length = Math.hypot(forward, left) || 1;
      const [x, y] = carry(pose, forward + grown * forward / length, left + grown * left / length);
      return [x + 0.6 * shift, y - 0.75 * shift];
    });
    for (let i = 2; i < ring.length; ++i) {
      for (const [x, y] of [ring[0], ring[i - 1], ring[i]]) corner(x, y, [0, 0, 0, alpha]);
    }
  }

  attribute(place, size, type, isShare, stride, offset) {
    const gl = this.gl;
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, type, isShare, stride, offset);
  }

  buffer(key, make) {
    const gl = this.gl;
    if (!this.buffers.has(key)) {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, make(), gl.STATIC_DRAW);
      this.buffers.set(key, buffer);
    }
    gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers.get(key));
  }

  // One body; without a candidate it is a ghost.
  mesh(candidate, body, pose, time, alpha) {
    const gl = this.gl;
    const model = body === EGO ? DATA.ego.model : DATA.actors[body].model;
    if (!DATA.models[model].mesh) return;
    const {mesh, corners, count, ego, other} = decodedMesh(model);
    const at = this.bodies;
    gl.useProgram(at.program);
    gl.uniformMatrix4fv(at.view, false, this.view);
    gl.uniformMatrix4fv(at.body, false, bodyMatrix(body, pose));
    gl.uniform3fv(at.origin, mesh.origin);
    gl.uniform3fv(at.size, mesh.step);
    gl.uniform3fv(at.eye, this.eye);
    gl.uniform3fv(at.fog, this.fog);
    gl.uniform1f(at.haze, 0.003);
    gl.uniform1f(at.alpha, alpha);
    this.buffer("corners " + model, () => corners);
    this.attribute(at.corner, 3, gl.UNSIGNED_SHORT, false, 0, 0);
    const isEgo = body === EGO;
    this.buffer((isEgo ? "ego " : "other ") + model, () => isEgo ? ego : other);
    this.attribute(at.colour, 3, gl.UNSIGNED_BYTE, true, 0, 0);
    const crash = candidate && candidate.bodies.get(body);
    if (crash && crash.damage) {
      this.buffer(`damage ${candidate.row} ${body}`, () => {
        const flags = new Uint8Array(count);
        for (const [first, length] of damagedRuns(crash.damage)) {
          flags.fill(255, 3 * first, 3 * (first + length));
        }
        return flags;
      });
      this.attribute(at.damaged, 1, gl.UNSIGNED_BYTE, true, 0, 0);
    } else {
      gl.disableVertexAttribArray(at.damaged);
      gl.vertexAttrib1f(at.damaged, 0);
    }
    const isDamaged = candidate && candidate.isDamaged(body, time);
    gl.uniform1f(at.damage, isDamaged ? 1 : 0);
    this.dents(crash, time);
    if (alpha < 1) {
      // The nearest surface alone shows through.
      gl.colorMask(false, false, false, false);
      gl.drawArrays(gl.TRIANGLES, 0, count);
      gl.colorMask(true, true, true, true);
      gl.depthFunc(gl.LEQUAL);
    }
    gl.drawArrays(gl.TRIANGLES, 0, count);
    gl.depthFunc(gl.LESS);
  }

  dents(crash, time) {
    const gl = this.gl;
    const grown = ((crash && crash.dents) || []).filter((dent) => dent.t < time);
    grown.sort((a, b) => b.depth - a.depth);
    grown.length = Math.min(grown.length, MOST_DENTS);
    gl.uniform1i(this.bodies.dents, grown.length);
    if (grown.length === 0) return;
    const along = [];
    const low = [];
    const high = [];
    for (const {t, for: lasting, along: [x, y], depth, box} of grown) {
      const share = clamp((time - t) / Math.max(0.02, lasting), 0, 1);
      const surface = Math.min(x * box[0], x * box[3]) + Math.min(y * box[1], y * box[4]);
      along.push(x, y, surface, depth * share * (2 - share));
      low.push(...box.slice(0, 3));
      high.push(...box.slice(3));
    }
    gl.uniform4fv(this.bodies.along, along);
    gl.uniform3fv(this.bodies.low, low);
    gl.uniform3fv(this.bodies.high, high);
  }

  // Names, flashes of contacts and changes of velocity, over the picture.
  words(candidate, time, ratio, shows) {
    const context = this.overlay.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    // Browsers print what is drawn with WebGL as a blank.
    if (document.documentElement.classList.contains("paper")) {
      context.drawImage(this.canvas, 0, 0, this.width, this.height);
    }
    const labels = new Labels(context, this.width, this.height);
    for (const contact of candidate.contacts) {
      const age = time - contact.t;
      if (age < 0 || age > 0.5) continue;
      const [x, y, z] = contact.at;
      const point = this.onCanvas(x, y, z);
      if (!point) continue;
      this.flash(context, point, 1 - age / 0.4);
      contact.kicks.forEach((kick, side) => {
        const speed = Math.hypot(...kick);
        const tip = this.onCanvas(x + 0.3 * kick[0], y + 0.3 * kick[1], z);
        if (!tip || speed < 1) return;
        const isEgo = contact.bodies[side] === EGO;
        drawArrow(context, point, tip, isEgo ? COLOURS.ego : COLOURS.other);
        labels.above("Δv " + kmh(speed), tip, [-10, 20, 34, -24], COLOURS.ink);
        labels.keepOff(point, tip);
      });
    }
    const names = [];
    const over = (body, pose, text, colour) => {
      const [x, y] = middleOfBody(body, pose);
      const roof = this.onCanvas(x, y, pose.z + modelOf(body).height);
      if (roof) names.push({text, roof, colour});
    };
    const named = candidate.first === null ? BODIES : candidate.hit;
    for (const body of [EGO, ...named.filter((each) => each !== EGO)]) {
      over(body, candidate.poseOf(body, time), shortened(nameOf(body)), COLOURS.ink);
    }
    for (const {body, p, plan} of shows.elsewhere) {
      over(body, poseOn(plan, time), nameElsewhere(body, p, plan), COLOURS.future);
    }
    // What is nearer stands lower in the picture: names of what is behind it stand above its own.
    names.sort((a, b) => b.roof[1] - a.roof[1]);
    for (const {text, roof, colour} of names) labels.led(text, roof, colour);
  }

  flash(context, [x, y], strength) {
    if (strength <= 0) return;
    context.globalAlpha = strength;
    context.fillStyle = COLOURS.mark;
    context.beginPath();
    for (let i = 0; i < 16; ++i) {
      const radius = (i % 2 ? 7 : 20) * (0.6 + 0.4 * strength);
      const angle = i * Math.PI / 8;
      context.lineTo(x + radius * Math.cos(angle), y + radius * Math.sin(angle));
    }
    context.fill();
    context.globalAlpha = 1;
  }
}

