"use strict";
// Draws both bodies of one candidate with their damage, and lets the reader turn them.
(function () {
  const holder = document.getElementById("view");
  const title = document.getElementById("view-title");
  const apart = document.getElementById("apart");
  const data = JSON.parse(document.getElementById("view-data").textContent);

  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, alpha: true});
  } catch (error) {
    document.getElementById("view-note").textContent =
      "This browser offers no WebGL for the 3-D view.";
    holder.classList.add("empty");
    document.querySelector(".controls").hidden = true;
    for (const button of document.querySelectorAll("button[data-place]")) button.hidden = true;
    return;
  }
  document.getElementById("view-note").remove();
  holder.appendChild(renderer.domElement);
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));

  const damaged = new THREE.Color("#e01f10");
  const scene = new THREE.Scene();
  scene.add(new THREE.HemisphereLight(0xffffff, 0x777066, 0.85));
  const sun = new THREE.DirectionalLight(0xffffff, 0.6);
  scene.add(sun);
  const camera = new THREE.PerspectiveCamera(32, 2, 0.05, 500);
  camera.up.set(0, 0, 1);

  function bytes(text) {
    const raw = atob(text);
    const out = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
    return out;
  }

  const decoded = {};
  function model(index) {
    if (!decoded[index]) {
      const source = data.models[index];
      decoded[index] = {
        positions: new Float32Array(bytes(source.positions).buffer),
        indices: new Uint32Array(bytes(source.indices).buffer),
        parts: source.parts,
      };
    }
    return decoded[index];
  }

  // One corner after the other, so that every triangle has a colour of its own.
  function meshOf(body, isEgo) {
    const {positions, indices, parts} = model(body.model);
    const flags = bytes(body.damaged);
    const corners = new Float32Array(indices.length * 3);
    const colours = new Float32Array(indices.length * 3);
    for (let i = 0; i < indices.length; ++i) {
      for (let k = 0; k < 3; ++k) corners[3 * i + k] = positions[3 * indices[i] + k];
    }
    const paint = new THREE.Color(isEgo ? "#3f6ea8" : "#bfa67c");
    const fill = (first, count, colour) => {
      for (let t = first; t < first + count; ++t) {
        const hit = (flags[t >> 3] >> (t & 7)) & 1;
        const c = hit ? damaged : colour;
        for (let k = 0; k < 3; ++k) colours.set([c.r, c.g, c.b], 9 * t + 3 * k);
      }
    };
    fill(0, indices.length / 3, paint);
    for (const [first, count, ego, other] of parts) {
      fill(first, count, new THREE.Color(isEgo ? ego : other));
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(corners, 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    const material = new THREE.MeshPhongMaterial({
      vertexColors: THREE.VertexColors, flatShading: true, side: THREE.DoubleSide, shininess: 18,
    });
    const mesh = new THREE.Mesh(geometry, material);
    const m = body.pose;
    mesh.matrixAutoUpdate = false;
    mesh.matrix.set(m[0], m[1], m[2], m[3], m[4], m[5], m[6], m[7], m[8], m[9], m[10], m[11],
      0, 0, 0, 1);
    return mesh;
  }

  const target = new THREE.Vector3();
  let azimuth = 0.8;
  let elevation = 0.4;
  let distance = 12;
  let shown = null;
  let bodies = [];
  let normal = new THREE.Vector3();

  function draw() {
    const width = holder.clientWidth;
    const height = holder.clientHeight;
    renderer.setSize(width, height);
    camera.aspect = width / Math.max(1, height);
    camera.updateProjectionMatrix();
    camera.position.set(
      target.x + distance * Math.cos(elevation) * Math.cos(azimuth),
      target.y + distance * Math.cos(elevation) * Math.sin(azimuth),
      target.z + distance * Math.sin(elevation));
    camera.lookAt(target);
    sun.position.copy(camera.position).add(new THREE.Vector3(3, -4, 9));
    const step = Number(apart.value);
    bodies.forEach((mesh, i) => {
      const sign = i === 0 ? -0.5 : 0.5;
      mesh.parent.position.copy(normal).multiplyScalar(sign * step);
    });
    renderer.render(scene, camera);
  }

  function show(place) {
    const wanted = data.scenes[place];
    if (!wanted || shown === place) return;
    shown = place;
    for (const mesh of bodies) {
      scene.remove(mesh.parent);
      mesh.geometry.dispose();
      mesh.material.dispose();
    }
    normal.set(wanted.normal[0], wanted.normal[1], wanted.normal[2]);
    const hull = new THREE.Box3();
    bodies = wanted.bodies.map((body, i) => {
      const mesh = meshOf(body, i === 0);
      const group = new THREE.Group();
      group.add(mesh);
      scene.add(group);
      mesh.geometry.computeBoundingBox();
      if (i === 0) hull.copy(mesh.geometry.boundingBox).applyMatrix4(mesh.matrix);
      return mesh;
    });
    // Between the ego and the contact, from beside the normal, where the gap between the bodies
    // shows; of the two sides the one that also sees the ego's front.
    hull.getCenter(target);
    target.lerp(new THREE.Vector3(...wanted.point), 0.5);
    distance = 2.0 * hull.getSize(new THREE.Vector3()).length();
    const heading = Math.atan2(wanted.bodies[0].pose[4], wanted.bodies[0].pose[0]);
    const across = Math.atan2(normal.y, normal.x);
    const sees = (side) => Math.cos(across + side - heading);
    azimuth = across + (sees(1.8) >= sees(-1.8) ? 1.8 : -1.8);
    elevation = 0.5;
    const row = document.querySelector("tr[data-place='" + place + "']");
    for (const other of document.querySelectorAll("tr.chosen")) other.classList.remove("chosen");
    if (row) {
      row.classList.add("chosen");
      title.textContent = place + ". " + row.cells[1].textContent;
    }
    draw();
  }

  let held = null;
  holder.addEventListener("pointerdown", (event) => {
    held = [event.clientX, event.clientY];
    holder.setPointerCapture(event.pointerId);
  });
  holder.addEventListener("pointermove", (event) => {
    if (!held) return;
    azimuth -= 0.008 * (event.clientX - held[0]);
    elevation = Math.max(-0.2, Math.min(1.5, elevation + 0.008 * (event.clientY - held[1])));
    held = [event.clientX, event.clientY];
    draw();
  });
  holder.addEventListener("pointerup", () => { held = null; });
  holder.addEventListener("wheel", (event) => {
    event.preventDefault();
    distance = Math.max(1, Math.min(200, distance * Math.exp(0.001 * event.deltaY)));
    draw();
  }, {passive: false});
  apart.addEventListener("input", draw);
  window.addEventListener("resize", draw);
  for (const element of document.querySelectorAll("[data-place]")) {
    element.addEventListener("click", () => {
      show(element.dataset.place);
      if (element.tagName === "BUTTON") holder.scrollIntoView({block: "center"});
    });
  }
  const places = Object.keys(data.scenes);
  if (places.length > 0) show(places[0]);
  document.body.classList.add("live");
  document.body.dataset.view = "ready";
})();
