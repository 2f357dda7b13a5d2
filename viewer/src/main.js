// The page: pattern to tick off, tabs, and the view with its controls.
import { read, yarn } from "./data.js";
import { stl } from "./model.js";
import { paint } from "./colors.js";
import { Stage } from "./stage.js";

const $ = (id) => document.getElementById(id);
const data = read($("picot-data").textContent);
const { scene } = data;
const state = { rows: null, mode: "yarn", color: "plain", view: "iso", tab: "pattern", upto: 0 };
let stage = null;
let yarnColors = [];
let lit = [];
let pinned = false;

function make(tag, text, attributes = {}) {
  const node = document.createElement(tag);
  if (text !== undefined) node.textContent = text;
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  return node;
}

// ---- what is ticked off -------------------------------------------------------------------------------------------

function remember() {
  const key = `picot:${data.hash}`;
  const boxes = [...document.querySelectorAll("#pattern .round input")];
  let done = new Set();
  try {
    done = new Set(JSON.parse(localStorage.getItem(key) || "[]"));
  } catch {
    // Storage may be closed to files; boxes then last as long as the page.
  }
  const tell = () => {
    const count = boxes.filter((box) => box.checked).length;
    $("progress").textContent = count ? `${count} of ${boxes.length} lines done` : "";
  };
  for (const box of boxes) {
    const id = box.parentElement.id;
    box.checked = done.has(id);
    box.parentElement.classList.toggle("done", box.checked);
    box.addEventListener("change", () => {
      box.parentElement.classList.toggle("done", box.checked);
      const checked = boxes.filter((it) => it.checked).map((it) => it.parentElement.id);
      try {
        localStorage.setItem(key, JSON.stringify(checked));
      } catch {
        // As above.
      }
      tell();
    });
  }
  tell();
}

// ---- tabs ---------------------------------------------------------------------------------------------------------

function tabs() {
  const list = $("tabs");
  const panels = [...document.querySelectorAll(".panel")];
  for (const panel of panels) {
    const tab = make("button", panel.dataset.title, {
      type: "button", role: "tab", id: `tab-${panel.id}`, "aria-controls": panel.id,
    });
    tab.addEventListener("click", () => open(panel.id));
    list.append(tab);
  }
  list.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!way) return;
    const index = panels.findIndex((panel) => panel.id === state.tab);
    const next = panels[(index + way + panels.length) % panels.length];
    open(next.id);
    $(`tab-${next.id}`).focus();
    event.preventDefault();
  });
  document.body.classList.add("tabbed");
}

function open(id, quiet) {
  if (!$(id) || !$(id).classList.contains("panel")) return;
  state.tab = id;
  for (const panel of document.querySelectorAll(".panel")) {
    const on = panel.id === id;
    panel.classList.toggle("on", on);
    const tab = $(`tab-${panel.id}`);
    tab.setAttribute("aria-selected", String(on));
    tab.tabIndex = on ? 0 : -1;
  }
  if (!quiet) write();
}

// ---- text and stitches --------------------------------------------------------------------------------------------

/** The rounds of the scene that a line of the pattern stands for. */
function roundsOf(part, row) {
  return scene.rounds.filter((round) => round.row === row && (row >= 0 || round.number === 1) && scene.pieces[round.piece].part === part);
}

/** The first stitches of every pass of a run: brackets repeat it. */
function offsets(run) {
  let at = [Number(run.dataset.s)];
  for (const every of (run.dataset.r || "").split(";").filter(Boolean)) {
    const [period, times] = every.split(",").map(Number);
    at = at.flatMap((from) => Array.from({ length: times }, (_, k) => from + k * period));
  }
  return at;
}

function stitchesOf(node) {
  const item = node.closest(".round");
  if (!item || !scene) return [];
  const rounds = roundsOf(Number(item.dataset.part), Number(item.dataset.row));
  const run = node.closest(".run");
  const found = [];
  for (const round of rounds) {
    if (!run) {
      for (let i = 0; i < round.size; i++) found.push(round.first + i);
      continue;
    }
    for (const from of offsets(run)) {
      for (let i = 0; i < Number(run.dataset.n); i++) if (from + i < round.size) found.push(round.first + from + i);
    }
  }
  return found;
}

function light(stitches, pin) {
  lit = stitches;
  if (pin !== undefined) pinned = pin && stitches.length > 0;
  if (stage) stage.light(stitches);
  for (const node of document.querySelectorAll(".lit")) node.classList.remove("lit");
  if (stitches.length && stitches.length < 3000) {
    for (const id of stitches) chartSign(id)?.classList.add("lit");
  }
  stats();
}

// A sign of the chart without a number stands for the stitch after that of the sign before.
function numberSigns() {
  for (const round of document.querySelectorAll("#chart g[id^=p][id*=r]")) {
    let part;
    let step;
    for (const sign of round.querySelectorAll("path")) {
      const own = /^p(\d+)s(\d+)$/.exec(sign.id);
      if (own) [part, step] = [own[1], Number(own[2])];
      else if (part !== undefined) sign.id = `p${part}s${++step}`;
    }
  }
}

function chartSign(id) {
  const round = scene.rounds[scene.round[id]];
  const steps = scene.steps[round.piece];
  const step = lower(steps, id);
  return steps[step] === id ? $(`p${scene.pieces[round.piece].part}s${step}`) : null;
}

function lower(list, value) {
  let low = 0;
  let high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** Marks the run of the text that a stitch belongs to, and brings it into view. */
function findText(id) {
  const round = scene.rounds[scene.round[id]];
  const part = scene.pieces[round.piece].part;
  const item = round.row < 0 && round.number !== 1 ? null : $(`l${part}-${round.row}`);
  if (!item) return null;
  const offset = id - round.first;
  const run = [...item.querySelectorAll(".run")].find((it) =>
    offsets(it).some((from) => offset >= from && offset < from + Number(it.dataset.n)));
  (run || item).classList.add("lit");
  return run || item;
}

/** What to call a stitch that no round counts. */
const unnumbered = (id) => (scene.kinds[scene.kind[id]].group === "close" ? "drawn shut" : "start");

function describe(id) {
  const kind = scene.kinds[scene.kind[id]];
  const round = scene.rounds[scene.round[id]];
  const piece = scene.pieces[round.piece];
  const part = data.parts[piece.part];
  const words = [];
  if (data.parts.length > 1) words.push(part.name);
  words.push(round.number ? `${part.flat ? "row" : "round"} ${round.number}` : unnumbered(id));
  if (scene.place[id]) words.push(`stitch ${scene.place[id]}`);
  words.push(kind.name + (kind.against && kind.group !== "turn" ? " (working back)" : ""));
  const percent = (x) => `${x > 0 ? "+" : ""}${Math.round(100 * x)} %`;
  if (kind.group !== "turn" && kind.step) {
    words.push(`width ${percent(scene.course[id])}, height ${percent(scene.wale[id])}, skew ${scene.skew[id].toFixed(2)}`);
  }
  return words.join(" \u00b7 ");
}

function texts() {
  const rounds = $("pattern");
  const over = (event) => {
    if (pinned) return;
    const node = event.target.closest?.(".run, .rnd");
    light(node ? stitchesOf(node) : []);
  };
  rounds.addEventListener("mouseover", over);
  rounds.addEventListener("mouseleave", () => pinned || light([]));
  rounds.addEventListener("focusin", over);
  rounds.addEventListener("click", (event) => {
    const node = event.target.closest(".run, .rnd");
    if (!node) return;
    const stitches = stitchesOf(node);
    const same = pinned && stitches[0] === lit[0] && stitches.length === lit.length;
    light(same ? [] : stitches, !same);
    if (!same) {
      node.classList.add("lit");
      if (state.upto <= stitches[stitches.length - 1]) go(stitches[stitches.length - 1] + 1);
    }
  });
  numberSigns();
  $("chart").addEventListener("click", (event) => {
    const found = /^p(\d+)s(\d+)$/.exec(event.target.id || "");
    if (!found || !scene) return;
    const piece = scene.pieces.findIndex((it) => it.part === Number(found[1]));
    const id = scene.steps[piece]?.[Number(found[2])];
    if (id === undefined) return;
    light([id], true);
    tip(describe(id));
  });
}

// ---- the view -----------------------------------------------------------------------------------------------------

function tip(text, x, y) {
  const node = $("tip");
  node.hidden = !text;
  node.textContent = text || "";
  if (x !== undefined && text) {
    const wide = $("stage").clientWidth;
    node.style.left = `${Math.max(4, Math.min(x + 14, wide - node.offsetWidth - 4))}px`;
    node.style.top = `${Math.max(4, y - 34)}px`;
  }
}

function pointing(canvas) {
  let down = null;
  let asked = null;
  canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
  canvas.addEventListener("pointermove", (event) => {
    if (event.buttons || event.pointerType === "touch") return tip("");
    const first = !asked;
    asked = [event.offsetX, event.offsetY];
    if (!first) return;
    requestAnimationFrame(() => {
      const [x, y] = asked;
      asked = null;
      const id = stage.pick(x, y);
      tip(id < 0 ? "" : describe(id), x, y);
      if (!pinned && (id < 0 ? lit.length : lit[0] !== id)) light(id < 0 ? [] : [id]);
    });
  });
  canvas.addEventListener("pointerleave", () => {
    tip("");
    if (!pinned) light([]);
  });
  canvas.addEventListener("pointerup", (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5) return;
    const id = stage.pick(event.offsetX, event.offsetY);
    if (id < 0) {
      tip("");
      return light([], false);
    }
    light([id], true);
    tip(describe(id), event.offsetX, event.offsetY);
    if (state.tab !== "chart") open("pattern");
    const node = findText(id);
    const smooth = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    const sign = state.tab === "chart" ? chartSign(id) : node;
    if (sign?.scrollIntoView && innerWidth > 800) {
      sign.scrollIntoView({ block: "nearest", inline: "nearest", behavior: smooth ? "smooth" : "auto" });
    }
    stats();
  });
  canvas.addEventListener("keydown", (event) => {
    const turns = { ArrowLeft: [-0.15, 0], ArrowRight: [0.15, 0], ArrowUp: [0, 0.15], ArrowDown: [0, -0.15] };
    if (turns[event.key]) stage.turn(...turns[event.key]);
    else if (event.key === "+" || event.key === "=") stage.zoom(0.85);
    else if (event.key === "-") stage.zoom(1.18);
    else if (event.key === ".") round(1);
    else if (event.key === ",") round(-1);
    else if (event.key === "Escape") light([], false);
    else return;
    event.preventDefault();
  });
}

/** The rounds that the slider goes through: an end for each. */
let stops = [];

function go(upto) {
  state.upto = Math.max(0, Math.min(scene.count, upto));
  const slider = $("rows");
  const index = stops.findIndex((stop) => stop.end >= state.upto);
  slider.value = String(state.upto === 0 ? 0 : index + 1);
  state.rows = Number(slider.value);
  const stop = stops[Math.max(0, index)];
  const text = state.upto === 0 ? "not begun"
    : `${stop.label}${state.upto < stop.end ? `, ${state.upto - stop.first} of ${stop.end - stop.first}` : ""}`;
  $("where").textContent = text;
  slider.setAttribute("aria-valuetext", text);
  stage.show(state.mode, state.upto);
  stats();
}

function round(way) {
  const at = stops.findIndex((stop) => stop.end >= state.upto);
  if (way > 0) {
    const next = state.upto === 0 ? 0 : stops[at].end > state.upto ? at : at + 1;
    go(stops[Math.min(stops.length - 1, next)].end);
  } else {
    go(at <= 0 ? 0 : stops[at].first);
  }
  write();
}

let playing = 0;
function play(on) {
  clearInterval(playing);
  playing = 0;
  $("play").setAttribute("aria-pressed", String(on));
  $("play").textContent = on ? "\u275a\u275a Pause" : "\u25b6 Play";
  if (!on) return write();
  if (state.upto >= scene.count) go(0);
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  // The whole object takes some twenty seconds, stitch by stitch; by rounds where motion is unwelcome.
  const each = Math.max(1, Math.round(scene.count / 600));
  playing = setInterval(() => {
    if (still) round(1);
    else go(state.upto + each);
    if (state.upto >= scene.count) play(false);
  }, still ? 900 : 33);
}

function recolor() {
  const { of, legend } = paint(scene, state.color, yarnColors);
  stage.paint(of);
  const box = $("key");
  box.replaceChildren();
  box.hidden = !legend && state.mode !== "wire";
  if (state.mode === "wire") {
    const keys = make("p");
    keys.append(swatch([0.72, 0.31, 0.06]), make("span", " course "), swatch([0.12, 0.36, 0.72]), make("span", " wale"));
    box.append(keys);
  }
  if (!legend) return;
  box.append(make("b", legend.title));
  for (const [name, color] of legend.entries || []) {
    const line = make("p");
    line.append(swatch(color), make("span", ` ${name}`));
    box.append(line);
  }
  if (legend.stops) {
    const bars = make("div", undefined, { class: "bars", role: "img", "aria-label": "Histogram of the stitches" });
    const most = Math.max(...legend.bins, 1);
    for (const bin of legend.bins) {
      const bar = make("i");
      bar.style.height = `${(100 * bin) / most}%`;
      bars.append(bar);
    }
    const scale = make("div", undefined, { class: "scale" });
    scale.style.background = `linear-gradient(to right, ${legend.stops.map(css).join(", ")})`;
    const ends = make("p", undefined, { class: "ends" });
    for (const end of legend.scale) ends.append(make("span", end));
    box.append(bars, scale, ends, make("p", legend.note));
  }
}

const css = (color) => `rgb(${color.map((x) => Math.round(255 * x)).join(",")})`;
function swatch(color) {
  const node = make("i", undefined, { class: "swatch" });
  node.style.background = css(color);
  return node;
}

const hex = (color) => `#${color.map((x) => Math.round(255 * x).toString(16).padStart(2, "0")).join("")}`;

function controls() {
  $("controls").hidden = false;
  $("controls").addEventListener("submit", (event) => event.preventDefault());
  stops = scene.rounds
    .map((it) => {
      const part = data.parts[scene.pieces[it.piece].part];
      const name = data.parts.length > 1 ? `${part.name}, ` : "";
      const label = it.number ? `${part.flat ? "row" : "round"} ${it.number}` : unnumbered(it.first);
      return { first: it.first, end: it.first + it.size, label: name + label };
    });
  $("rows").max = String(stops.length);
  $("rows").addEventListener("input", () => {
    const value = Number($("rows").value);
    go(value ? stops[value - 1].end : 0);
    write();
  });
  $("back").addEventListener("click", () => round(-1));
  $("on").addEventListener("click", () => round(1));
  $("less").addEventListener("click", () => go(state.upto - 1));
  $("more").addEventListener("click", () => go(state.upto + 1));
  $("play").addEventListener("click", () => play(!playing));
  for (const radio of document.querySelectorAll("input[name=mode]")) {
    radio.addEventListener("change", () => {
      state.mode = radio.value;
      if (state.mode === "wire" && state.color === "plain") state.color = $("color").value = "kind";
      stage.show(state.mode, state.upto);
      recolor();
      write();
    });
  }
  $("color").addEventListener("change", () => {
    state.color = $("color").value;
    recolor();
    write();
  });
  yarnColors = scene.colors.map((color) => color.map((x) => x / 255));
  $("yarn-color").value = hex(yarnColors[0]);
  $("yarn-color").addEventListener("input", () => {
    const value = Number.parseInt($("yarn-color").value.slice(1), 16);
    yarnColors[0] = [value >> 16, (value >> 8) & 255, value & 255].map((x) => x / 255);
    recolor();
  });
  $("thickness").addEventListener("input", () => stage.thick(Number($("thickness").value)));
  for (const button of document.querySelectorAll("[data-view]")) {
    button.addEventListener("click", () => {
      stage.look((state.view = button.dataset.view));
      write();
    });
  }
  $("picture").addEventListener("click", () => {
    make("a", "", { href: stage.photo(), download: `${fileName()}.png` }).click();
  });
  $("model").addEventListener("click", () => save("stl", new Blob([stl(scene)], { type: "model/stl" })));
  const strain = [...$("color").options].find((it) => it.value === "strain");
  strain.disabled = scene.predicted === null;
  if (strain.disabled) {
    strain.textContent = "strain (needs a prediction)";
    $("why").textContent = "Strain needs the predicted shape: build with --set places=predicted.";
    $("why").hidden = false;
  }
  $("print").addEventListener("click", () => print());
  addEventListener("beforeprint", photograph);
  // A picture that is not decoded yet would be missing on paper.
  setTimeout(photograph, 50);
}

const fileName = () => data.name.replace(/[^\p{L}\p{N}._-]+/gu, "-").slice(0, 60) || "picot";

/** Offers bytes as a file. */
function save(extension, blob) {
  const address = URL.createObjectURL(blob);
  make("a", "", { href: address, download: `${fileName()}.${extension}` }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/** The picture for the printed pattern: the whole object in yarn. */
function photograph() {
  const { mode, upto } = state;
  stage.light([]);
  stage.paint(paint(scene, "plain", yarnColors).of);
  stage.show("yarn", scene.count);
  $("photo").src = stage.photo();
  stage.paint(paint(scene, state.color, yarnColors).of);
  stage.show(mode, upto);
  stage.light(lit);
}

// ---- state --------------------------------------------------------------------------------------------------------

let writing = false;
function write() {
  const words = [];
  if (stage && state.upto < scene.count) words.push(`rows=${state.rows}`);
  if (state.mode !== "yarn") words.push(`mode=${state.mode}`);
  if (state.color !== "plain") words.push(`color=${state.color}`);
  if (state.view !== "iso") words.push(`view=${state.view}`);
  if (state.tab !== "pattern") words.push(`tab=${state.tab}`);
  writing = true;
  try {
    history.replaceState(null, "", `#${words.join("&")}`);
  } catch {
    // Some browsers keep files from changing their address.
  }
  writing = false;
  stats();
}

function readHash() {
  if (writing) return;
  const asked = new URLSearchParams(location.hash.slice(1));
  open(asked.get("tab") || "pattern", true);
  if (!stage) return;
  state.mode = asked.get("mode") === "wire" ? "wire" : "yarn";
  document.querySelector(`input[name=mode][value=${state.mode}]`).checked = true;
  const color = asked.get("color") || (state.mode === "wire" ? "kind" : "plain");
  state.color = [...$("color").options].some((it) => it.value === color && !it.disabled) ? color : "plain";
  $("color").value = state.color;
  const view = asked.get("view");
  if (["front", "side", "top"].includes(view)) stage.look((state.view = view));
  const rows = asked.has("rows") ? Number(asked.get("rows")) : stops.length;
  const valid = Number.isInteger(rows) && rows >= 0 && rows <= stops.length ? rows : stops.length;
  go(valid ? stops[valid - 1].end : 0);
  recolor();
}

function stats() {
  const figures = (stage && stage.figures) || { drawCalls: 0, triangles: 0 };
  window.__stats = {
    stitches: scene ? scene.count : 0,
    nodes: scene ? scene.nodes : 0,
    visible: state.upto,
    visibleRows: state.rows ?? 0,
    rows: stops.length,
    highlighted: lit.length,
    mode: state.mode,
    color: state.color,
    tab: state.tab,
    frames: stage ? stage.frames : 0,
    ...figures,
  };
  document.documentElement.dataset.stats = JSON.stringify(window.__stats);
}

// For the tests of the project.
window.__pick = (x, y) => (stage ? stage.pick(x, y) : -1);
window.__yarn = () => {
  const { at, count } = yarn(scene, 1);
  return Array.from({ length: count * 3 }, (_, i) => at[i] + scene.middle[i % 3]);
};
window.__photo = () => (stage ? stage.photo() : "");

/** What the colors show, as figures. */
function summary() {
  const worked = [];
  for (let i = 0; i < scene.count; i++) {
    if (scene.kinds[scene.kind[i]].step && scene.kinds[scene.kind[i]].group !== "turn") worked.push(i);
  }
  const mean = (of) => worked.reduce((sum, i) => sum + of(i), 0) / Math.max(1, worked.length);
  const percent = (x) => `${(100 * x).toFixed(1)} %`;
  const text = `Against the gauge, stitch by stitch and as the view draws them: width off by ${percent(mean((i) => Math.abs(scene.course[i])))}`
    + `, height by ${percent(mean((i) => Math.abs(scene.wale[i])))} on average; mean skew ${mean((i) => scene.skew[i]).toFixed(3)}.`;
  $("numbers").querySelector("h2").after(make("p", text));
}

function start() {
  tabs();
  remember();
  texts();
  $("text").addEventListener("click", () => save("txt", new Blob([data.text], { type: "text/plain" })));
  if (scene) {
    summary();
    try {
      if (!document.createElement("canvas").getContext("webgl2")) throw new Error("no WebGL 2");
      stage = new Stage($("canvas"), scene, stats);
    } catch {
      stage = null;
    }
  }
  if (stage) {
    controls();
    pointing($("canvas"));
  } else {
    document.body.classList.add("flat");
    $("canvas").hidden = true;
    $("no-view").hidden = false;
    if (!scene) $("no-view").textContent = "There is no view of this pattern; About tells why.";
  }
  addEventListener("hashchange", readHash);
  readHash();
  if (stage) stage.render();
  stats();
  window.__ready = true;
  document.documentElement.dataset.ready = "true";
}

start();
