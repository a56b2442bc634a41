/* Draws the content of the page: charts with plotly.js, tables with DataTables, shapes with three.js. */
"use strict";

const content = JSON.parse(document.getElementById("data").textContent);
// On a narrow screen, buttons would cover the chart
const options = { responsive: true, displaylogo: false, displayModeBar: window.innerWidth < 600 ? false : "hover",
  modeBarButtonsToRemove: ["lasso2d", "select2d"] };

/* Draws all charts. For each chart with a selection list, returns a function that shows the entry with a given key. */
function drawCharts() {
  const choosers = {};
  for (const chart of content.charts) {
    if (chart.choices) choosers[chart.id] = drawChoices(chart);
    else Plotly.newPlot("chart-" + chart.id, chart.data, chart.layout, options);
  }
  return choosers;
}

function drawChoices(chart) {
  const list = document.getElementById("choice-" + chart.id);
  const choose = (key) => {
    const choice = chart.choices.find((one) => one.key === key);
    if (!choice) return;
    list.value = key;
    Plotly.react("chart-" + chart.id, choice.data, choice.layout, options);
  };
  list.onchange = () => choose(list.value);
  choose(chart.chosen);
  return choose;
}

function drawTables() {
  $("table.sortable").each(function () {
    const isLong = this.tBodies[0].rows.length > 25;
    $(this).DataTable({ order: [], paging: isLong, info: isLong, searching: isLong, pageLength: 25, lengthChange: false });
  });
}

function title(mode) {
  return `${mode.label}, ${mode.frequency.toFixed(0)} Hz, ξ = ${mode.rate.toPrecision(3)} %`;
}

function numbers(text, Type) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  return new Type(bytes.buffer);
}

/* Colour scale YlGnBu of ColorBrewer */
const COLOURS = ["#ffffd9", "#edf8b1", "#c7e9b4", "#7fcdbb", "#41b6c4", "#1d91c0", "#225ea8", "#253494", "#081d58"].map((code) => new THREE.Color(code));

function colour(share) {
  const place = Math.min(share, 0.9999) * (COLOURS.length - 1), first = Math.floor(place);
  return COLOURS[first].clone().lerp(COLOURS[first + 1], place - first);
}

/* Animated disc and pins in a canvas that can be rotated. */
class Viewer {
  constructor(shapes, place) {
    this.rest = numbers(shapes.points, Float32Array);
    this.faces = numbers(shapes.faces, Uint32Array);
    this.isDisc = numbers(shapes.disc, Uint8Array);
    this.length = shapes.size;
    this.place = place;
    this.size = 0.06;
    this.moves = true;
    this.phase = 0;
    this.frames = 0;

    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color("#ffffff");
    this.camera = new THREE.PerspectiveCamera(32, 1, this.length / 100, this.length * 20);
    this.camera.up.set(0, 0, 1);
    this.lamp = new THREE.DirectionalLight("#ffffff", 0.5);
    this.scene.add(new THREE.AmbientLight("#ffffff", 0.72), this.camera);
    this.camera.add(this.lamp);
    this.renderer = new THREE.WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(window.devicePixelRatio);
    place.appendChild(this.renderer.domElement);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);

    this.geometry = new THREE.BufferGeometry();
    this.geometry.setAttribute("position", new THREE.BufferAttribute(this.rest.slice(), 3));
    this.geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(this.rest.length), 3));
    this.lines = new THREE.BufferGeometry();
    this.lines.setAttribute("position", this.geometry.getAttribute("position"));
    this.scene.add(new THREE.Mesh(this.geometry, new THREE.MeshLambertMaterial({
      vertexColors: THREE.VertexColors, side: THREE.DoubleSide, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 })));
    this.scene.add(new THREE.LineSegments(this.lines, new THREE.LineBasicMaterial({ color: "#30363c", transparent: true, opacity: 0.22 })));
    this.showDisc(true);
    this.look("above");
    new ResizeObserver(() => this.resize()).observe(place);
    this.resize();
  }

  showDisc(isShown) {
    const triangles = [], edges = [];
    for (let i = 0; i < this.faces.length; i += 4) {
      const [a, b, c, d] = this.faces.subarray(i, i + 4);
      if (!isShown && this.isDisc[a]) continue;
      triangles.push(a, b, c, a, c, d);
      edges.push(a, b, b, c, c, d, d, a);
    }
    this.geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(triangles), 1));
    this.lines.setIndex(new THREE.BufferAttribute(Uint32Array.from(edges), 1));
  }

  show(mode) {
    [this.real, this.imaginary] = [numbers(mode.real, Int16Array), numbers(mode.imag, Int16Array)];
    const colours = this.geometry.getAttribute("color"), n = this.rest.length / 3, amplitude = new Float32Array(n);
    let largest = 1e-30;
    for (let i = 0; i < n; ++i) {
      for (let d = 3 * i; d < 3 * i + 3; ++d) amplitude[i] += this.real[d] ** 2 + this.imaginary[d] ** 2;
      amplitude[i] = Math.sqrt(amplitude[i]);
      largest = Math.max(largest, amplitude[i]);
    }
    for (let i = 0; i < n; ++i) colour(amplitude[i] / largest).toArray(colours.array, 3 * i);
    colours.needsUpdate = true;
    this.unit = 1 / largest;
  }

  look(name) {
    const [x, y, z] = { above: [0.9, -1.1, 1.05], below: [0.9, -1.1, -1.05], side: [1.7, -0.4, 0.15] }[name];
    this.camera.position.set(x, y, z).multiplyScalar(0.92 * this.length);
    this.controls.target.set(0, 0, 0);
    this.controls.update();
  }

  resize() {
    const width = this.place.clientWidth, height = this.place.clientHeight;
    this.camera.aspect = width / height;
    this.camera.zoom = Math.min(1, this.camera.aspect / 1.3);
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
  }

  draw(seconds) {
    if (this.moves) this.phase += 2 * Math.PI * seconds / 1.6;
    const position = this.geometry.getAttribute("position"), factor = this.size * this.length * this.unit;
    const [c, s] = [factor * Math.cos(this.phase), factor * Math.sin(this.phase)];
    for (let i = 0; i < this.rest.length; ++i) position.array[i] = this.rest[i] + c * this.real[i] - s * this.imaginary[i];
    position.needsUpdate = true;
    this.renderer.render(this.scene, this.camera);
    ++this.frames;
  }
}

/* Animates a mode and passes its number to `showEnergy`. */
function drawShapes(showEnergy) {
  if (!content.shapes) return null;
  const viewer = new Viewer(content.shapes, document.getElementById("canvas"));
  const row = document.getElementById("modes");
  const choose = (k) => {
    [...row.children].forEach((button, i) => button.classList.toggle("chosen", i === k));
    viewer.show(content.shapes.modes[k]);
    if (showEnergy) showEnergy(String(content.shapes.modes[k].number));
  };
  content.shapes.modes.forEach((mode, k) => {
    const button = document.createElement("button");
    button.textContent = title(mode);
    button.onclick = () => choose(k);
    row.appendChild(button);
  });
  choose(content.shapes.leading);
  const play = document.getElementById("play");
  play.onclick = () => {
    viewer.moves = !viewer.moves;
    play.textContent = viewer.moves ? "pause" : "play";
  };
  document.getElementById("size").oninput = (event) => { viewer.size = Number(event.target.value); };
  document.getElementById("disc").onchange = (event) => viewer.showDisc(event.target.checked);
  document.querySelectorAll("[data-view]").forEach((button) => { button.onclick = () => viewer.look(button.dataset.view); });
  let before = performance.now();
  const step = (now) => {
    viewer.draw(Math.min(now - before, 100) / 1000);
    before = now;
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
  return viewer;
}

const choosers = drawCharts();
drawTables();
window.viewer = drawShapes(choosers.energy);
