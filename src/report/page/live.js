// The controls of the live part.  There is one state; every control changes it by change(), and
// whatever the state is, gets drawn.  `window.intaglio` is the same for programs: see its end.
"use strict";
(() => {

const {Renderer, shapes} = window.intaglio;
const root = document.getElementById("live");
const data = JSON.parse(document.getElementById("live-data").textContent);
const find = selector => root.querySelector(selector);
const stage = find(".live-stage"), canvas = find(".live-canvas");
const panes = ["technique", "exact", "difference"].map(name => find(`[data-pane="${name}"]`));

const view = {elevation: 35, azimuth: 250, zoom: 1};
const techniques = data.techniques.filter(t => !t.absent), absent = data.techniques.filter(t => t.absent);
const first = techniques.find(t => t.name === "parallax_occlusion") || techniques[0];
const state = {technique: first.name, steps: first.initial, shadow: data.shadows[0].name, map: data.maps[0].name,
               shape: "torus", ...view, lightElevation: 45, lightAzimuth: 20, depth: data.scale, amplify: 4};

const technique = () => techniques.find(t => t.name === state.technique);
const key_of = s => `${s.technique}|${s.steps}|${s.shadow}`;
const reference_of = s => `reference||${s.shadow}`;
const clamp = (x, least, most) => Math.min(Math.max(x, least), most);
const short = x => String(Number(x.toFixed(2)));

let renderer = null;
let wanted = 0, drawn = -1;  // states counted: the one to show, and the one shown in full
let pace = 1e-5;             // seconds that a pixel of both pictures took last
let waiting = [];            // resolved when what is wanted is shown
let settle = 0;

function say(sentence) {
  const message = find(".live-message");
  message.hidden = !sentence;
  message.textContent = sentence || "";
}

// Drawing ----------------------------------------------------------------------------------------

// Draws the pictures of a state, or one of them, into the renderer's pictures from `first` on; false while a program is
// being compiled.
const pictures = ["technique", "exact"];
async function draw_pictures(s, size, samples, which = pictures, first = 0) {
  const textures = await renderer.map(s.map), keys = [key_of(s), reference_of(s)];
  const indices = which.map(name => pictures.indexOf(name));
  if (!indices.map(index => renderer.compiled(keys[index])).every(Boolean)) return false;
  for (const index of indices) renderer.draw(first + index, keys[index], s, textures, size, samples);
  return true;
}

// Of the pixels with a surface: how far apart the pictures are, in steps of the display's 255.
function difference_of(a, b) {
  let pixels = 0, sum = 0, beyond = 0, worst = 0;
  for (let i = 0; i < a.length; i += 4) {
    if (!a[i + 3]) continue;
    const apart = Math.max(Math.abs(a[i] - b[i]), Math.abs(a[i + 1] - b[i + 1]), Math.abs(a[i + 2] - b[i + 2]));
    ++pixels;
    sum += apart;
    if (apart > 16) ++beyond;
    if (apart > worst) worst = apart;
  }
  return {mean: pixels ? sum / pixels : 0, beyond: pixels ? beyond / pixels : 0, worst, pixels};
}

// The canvas lies over the panes; each pane's place in it, in pixels from the lower left.
function lay_out() {
  const ratio = window.devicePixelRatio || 1, whole = stage.getBoundingClientRect();
  const width = Math.max(Math.round(whole.width * ratio), 1), height = Math.max(Math.round(whole.height * ratio), 1);
  if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
  return panes.map(pane => {
    const box = pane.getBoundingClientRect();
    return [Math.round((box.left - whole.left) * ratio), height - Math.round((box.bottom - whole.top) * ratio),
            Math.round(box.width * ratio), Math.round(box.height * ratio)];
  });
}

let running = false;
async function frame() {
  if (running) return;
  running = true;
  const serial = wanted, s = {...state}, moving = performance.now() < settle;
  try {
    const rectangles = lay_out(), full = clamp(rectangles[0][2], 96, 1024);
    // Drivers compile at a program's first draw, and its second one tells its pace: both are small and not shown.
    // Then come as many pixels as there is time for: while the view moves, and when it rests.
    const draws = renderer.draws([key_of(s), reference_of(s)]);
    const affordable = Math.sqrt((moving ? 0.035 : 2) / pace);
    const size = Math.round(clamp(draws < 2 ? 48 : affordable, draws < 2 || moving ? 32 : 96, full));
    const began = performance.now();
    if (await draw_pictures(s, size, 4)) {
      // Reading a pixel waits for the device.
      renderer.pixels(0, 1);
      const took = (performance.now() - began) / 1000;
      if (draws > 0) pace = took / size ** 2;
      if (draws > 1) {
        renderer.clear();
        rectangles.forEach((box, i) => renderer.show(box, i % 2, i === 2 ? s.amplify : 0));
      }
      // A device that was busy with something else gets another chance.
      if (draws > 1 && !moving && (size === full || took > 1)) {
        describe(difference_of(renderer.pixels(0), renderer.pixels(1)), size, full);
        drawn = serial;
        stage.removeAttribute("aria-busy");
      }
    }
  } catch (error) {
    if (!renderer.gl.isContextLost()) {
      say(`The browser's WebGL 2 could not draw this: ${error.message}`);
      console.error(error);
    }
    drawn = serial;
  }
  running = false;
  if (drawn !== wanted) requestAnimationFrame(frame);
  else waiting.splice(0).forEach(resolve => resolve());
}

function describe({mean, beyond, worst}, size, full) {
  const numbers = worst === 0
    ? "Both pictures are the same in every pixel."
    : `Against exact: ${(100 * beyond).toFixed(1)} % of the pixels differ by more than 16 of 255, ` +
      `on average by ${mean.toFixed(1)}, at worst by ${worst}.`;
  const coarse = size === full ? "" : ` Drawn with ${size} × ${size} pixels: all that this device manages in two seconds.`;
  find(".live-numbers").textContent = numbers + coarse;
}

// Changes the state, shows it in the controls and draws it.  `gliding`: more of the same will come.
function change(changes, gliding = false) {
  Object.assign(state, changes);
  if (changes.technique) {
    const values = technique().values;
    if (!values.includes(state.steps)) state.steps = technique().initial;
  }
  const shape = shapes[state.shape];
  state.elevation = clamp(state.elevation, shape.least, 90);
  state.azimuth = (state.azimuth % 360 + 360) % 360;
  state.zoom = clamp(state.zoom, 0.4, 3);
  state.lightElevation = clamp(state.lightElevation, 5, 90);
  state.lightAzimuth = (state.lightAzimuth % 360 + 360) % 360;
  ++wanted;
  if (gliding) settle = performance.now() + 180;
  stage.setAttribute("aria-busy", "true");
  show_state();
  requestAnimationFrame(frame);
}

// Controls ---------------------------------------------------------------------------------------

const sliders = {depth: x => short(x), lightElevation: x => `${Math.round(x)}°`, lightAzimuth: x => `${Math.round(x)}°`};
const choices = {
  steps: () => technique().values.filter(v => v).map(v => [v, v]),
  shadow: () => data.shadows.map(s => [s.name, s.name]),
  map: () => data.maps.map(m => [m.name, m.name.replaceAll("_", " ")]),
  shape: () => Object.keys(shapes).map(name => [name, name]),
  amplify: () => [[1, "1"], [4, "4"], [16, "16"]],
};

function element(name, properties = {}, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

function fill_choice(name) {
  const box = find(`[data-choice="${name}"] .live-choice`), options = choices[name]();
  box.classList.toggle("live-none", !options.length);
  box.replaceChildren(...options.map(([value, text]) => {
    const input = element("input", {type: "radio", name, value});
    input.addEventListener("change", () => change({[name]: value}));
    return element("label", {}, input, element("span", {textContent: text}));
  }));
  if (!options.length) box.textContent = "none: a fixed number of reads";
}

let listed = "";  // the technique whose steps are listed
function show_state() {
  const chosen = technique();
  if (listed !== chosen.name) {
    listed = chosen.name;
    fill_choice("steps");
    const field = find('[data-choice="steps"]');
    field.querySelector("legend").textContent = chosen.knob || "Knob";
    field.title = chosen.comment;
  }
  find("select").value = state.technique;
  find(".live-summary").textContent = chosen.summary + ".";
  for (const name of Object.keys(choices))
    for (const input of root.querySelectorAll(`[data-choice="${name}"] input`)) input.checked = input.value === String(state[name]);
  for (const [name, text] of Object.entries(sliders)) {
    find(`input[name="${name}"]`).value = state[name];
    find(`output[name="${name}Text"]`).textContent = text(state[name]);
  }
  const knob = chosen.knob ? ` · ${chosen.knob} = ${state.steps}` : "";
  const shadow = state.shadow === "none" ? "" : ` · shadow ${state.shadow}`;
  find('[data-text="technique"]').textContent = state.technique + knob + shadow;
  find('[data-text="exact"]').textContent = state.shadow === "none" ? "exact" : "exact · shadow exact";
  find('[data-text="difference"]').textContent = state.amplify === 1 ? "difference" : `difference × ${state.amplify}`;
  for (const tick of root.querySelectorAll("[data-tick]")) {
    const last = tick.dataset.tick === "1", at = Math.round(tick.dataset.tick * 255 / state.amplify);
    tick.textContent = last && at < 255 ? `≥ ${at} of 255` : at;
  }
  find('[data-text="command"]').textContent = commands().join("\n");
  if (find(".live-source").open) show_source();
}

function commands() {
  const program = data.programs[key_of(state)], map = data.maps.find(m => m.name === state.map);
  const distance = shapes[state.shape].distance * state.zoom;
  const look = `--mesh ${state.shape} --elevation ${short(state.elevation)} --azimuth ${short(state.azimuth)} ` +
    `--distance ${short(distance)} --light-elevation ${short(state.lightElevation)} ` +
    `--light-azimuth ${short(state.lightAzimuth)} --scale ${short(state.depth)}`;
  return map.run ? [program.emit, `${program.run}${map.run} ${look} -o picture.png`] : [program.emit];
}

function show_source() {
  const text = find('[data-text="source"]'), key = key_of(state);
  if (text.dataset.key === key) return;
  text.dataset.key = key;
  text.textContent = renderer.text(key, "pixel");
}

function add_controls() {
  const select = find("select");
  if (absent.length)
    find(".live-absent").textContent = `Not in this page, because what they read is too large for it or WebGL 2 refuses them: ${absent.map(t => t.name).join(", ")}.`;
  select.append(...techniques.map(t => element("option", {value: t.name, textContent: t.name})));
  select.addEventListener("change", () => change({technique: select.value}));
  for (const name of Object.keys(choices)) if (name !== "steps") fill_choice(name);
  for (const name of Object.keys(sliders)) {
    const input = find(`input[name="${name}"]`);
    input.addEventListener("input", () => change({[name]: Number(input.value)}, true));
  }
  const acts = {closer: () => ({zoom: state.zoom / 1.2}), farther: () => ({zoom: state.zoom * 1.2}), reset: () => view};
  for (const button of root.querySelectorAll("[data-act]"))
    button.addEventListener("click", () => change(acts[button.dataset.act]()));
  for (const form of root.querySelectorAll("form")) form.addEventListener("submit", event => event.preventDefault());
  find(".live-source").addEventListener("toggle", () => show_state());
  const stops = data.ramp.map(colour => `rgb(${colour.map(c => Math.round(255 * c)).join(" ")})`);
  find(".live-ramp").style.background = `linear-gradient(to right, ${stops.join(", ")})`;
}

// One pointer orbits, with Shift it turns the light; two pinch.
function add_pointers() {
  const held = new Map();
  const spread = () => {
    const [a, b] = [...held.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  };
  for (const pane of panes) {
    pane.addEventListener("pointerdown", event => {
      pane.setPointerCapture(event.pointerId);
      held.set(event.pointerId, {x: event.clientX, y: event.clientY});
      stage.focus({preventScroll: true});
      event.preventDefault();
    });
    pane.addEventListener("pointermove", event => {
      const last = held.get(event.pointerId);
      if (!last) return;
      const before = held.size === 2 ? spread() : 0, degrees = 180 / pane.clientWidth;
      const dx = (event.clientX - last.x) * degrees, dy = (event.clientY - last.y) * degrees;
      Object.assign(last, {x: event.clientX, y: event.clientY});
      if (held.size === 2) change({zoom: state.zoom * before / Math.max(spread(), 1)}, true);
      else if (event.shiftKey) change({lightAzimuth: state.lightAzimuth + dx, lightElevation: state.lightElevation - dy}, true);
      else change({azimuth: state.azimuth - dx, elevation: state.elevation + dy}, true);
    });
    for (const end of ["pointerup", "pointercancel"])
      pane.addEventListener(end, event => held.delete(event.pointerId));
  }
  stage.addEventListener("wheel", event => {
    if (document.activeElement !== stage && !event.ctrlKey) return;
    event.preventDefault();
    change({zoom: state.zoom * Math.exp(clamp(event.deltaY, -100, 100) / 500)}, true);
  }, {passive: false});
  const keys = {ArrowLeft: () => ({azimuth: state.azimuth + 5}), ArrowRight: () => ({azimuth: state.azimuth - 5}),
                ArrowUp: () => ({elevation: state.elevation + 5}), ArrowDown: () => ({elevation: state.elevation - 5}),
                "+": () => ({zoom: state.zoom / 1.1}), "=": () => ({zoom: state.zoom / 1.1}),
                "-": () => ({zoom: state.zoom * 1.1}), "0": () => view};
  stage.addEventListener("keydown", event => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    change(keys[event.key](), true);
  });
}

// ------------------------------------------------------------------------------------------------

function start() {
  try {
    renderer = new Renderer(canvas, data);
  } catch {
    say("This browser gives no WebGL 2, so nothing is drawn here; `intaglio run` draws the same pictures.");
    stage.hidden = true;
    for (const part of root.querySelectorAll("form, .live-hint, .live-numbers, .live-source")) part.hidden = true;
    return;
  }
  add_controls();
  add_pointers();
  canvas.addEventListener("webglcontextlost", event => {
    event.preventDefault();
    say("The browser took the graphics device away; the pictures come back when it returns it.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    renderer = new Renderer(canvas, data);
    say("");
    change({});
  });
  new ResizeObserver(() => change({}, true)).observe(stage);
}

const base64 = bytes => {
  let text = "";
  for (let i = 0; i < bytes.length; i += 4096) text += String.fromCharCode(...bytes.subarray(i, i + 4096));
  return btoa(text);
};
const settled = async () => {
  if (drawn !== wanted || running) await new Promise(resolve => waiting.push(resolve));
};

// For programs.  Pictures are RGBA of 8 bits in base64, their top row first.
Object.assign(window.intaglio, {
  data,
  state: () => ({...state}),
  change,
  // When the pictures of the state are on the page: they, as they are there.
  async shown() {
    await settled();
    return {size: renderer.targets[0].size, technique: base64(renderer.pixels(0)), exact: base64(renderer.pixels(1))};
  },
  // The pictures of the state with these changes, beside those on the page.
  async draw(changes, size, samples = 1, which = pictures) {
    const first = pictures.length, s = {...state, ...changes};
    while (!await draw_pictures(s, size, samples, which, first)) await new Promise(requestAnimationFrame);
    return Object.fromEntries(which.map(name => [name, base64(renderer.pixels(first + pictures.indexOf(name)))]));
  },
});

start();
})();
