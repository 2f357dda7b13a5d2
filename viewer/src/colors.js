// What a stitch's color tells, and the legend that says so. Scales are safe for the color-blind and differ in gray.

/** Groups of kinds with their names. */
export const KINDS = {
  plain: ["plain stitch", [0.86, 0.80, 0.70]],
  inc: ["increase", [0.00, 0.45, 0.70]],
  dec: ["decrease", [0.84, 0.37, 0.00]],
  turn: ["turn", [0.35, 0.20, 0.45]],
  chain: ["chain", [0.55, 0.62, 0.45]],
  close: ["drawn shut", [0.45, 0.45, 0.45]],
  other: ["other stitch", [0.34, 0.71, 0.91]],
};

const mix = (a, b, t) => a.map((x, k) => x + (b[k] - x) * t);
const WHITE = [0.96, 0.95, 0.92];
const BLUE = [0.13, 0.36, 0.68];
const RED = [0.72, 0.19, 0.10];
const DARK = [0.30, 0.05, 0.36];

function diverging(value) {
  const t = Math.max(-1, Math.min(1, value));
  return t < 0 ? mix(WHITE, BLUE, -t) : mix(WHITE, RED, t);
}

const percent = (x) => `${(100 * x).toFixed(0)} %`;

function figures(values) {
  const mean = values.reduce((a, b) => a + b, 0) / Math.max(1, values.length);
  const abs = values.reduce((a, b) => a + Math.abs(b), 0) / Math.max(1, values.length);
  return { mean, abs };
}

function histogram(values, low, high) {
  const bins = new Array(24).fill(0);
  for (const value of values) {
    const t = (value - low) / (high - low);
    bins[Math.max(0, Math.min(23, Math.floor(t * 24)))]++;
  }
  return bins;
}

/** The worse of a stitch's two errors, with its sign. */
export function worst(scene, i) {
  return Math.abs(scene.course[i]) > Math.abs(scene.wale[i]) ? scene.course[i] : scene.wale[i];
}

/** Color of each stitch, and the legend: entries of name and color, a scale, a sentence. */
export function paint(scene, mode, yarn) {
  const worked = [];
  for (let i = 0; i < scene.count; i++) {
    const group = scene.kinds[scene.kind[i]].group;
    if (group === "plain" || group === "inc" || group === "dec" || group === "other") worked.push(i);
  }
  const group = (i) => scene.kinds[scene.kind[i]].group;
  switch (mode) {
    case "kind": {
      const used = new Map();
      for (let i = 0; i < scene.count; i++) used.set(group(i), (used.get(group(i)) || 0) + 1);
      const entries = Object.keys(KINDS).filter((key) => used.has(key));
      return {
        of: (i) => KINDS[group(i)][1],
        legend: { title: "Kind of stitch", entries: entries.map((key) => [`${KINDS[key][0]}: ${used.get(key)}`, KINDS[key][1]]) },
      };
    }
    case "round": {
      const shade = (i) => (scene.rounds[scene.round[i]].number % 2 ? [0.93, 0.85, 0.68] : [0.24, 0.47, 0.55]);
      return { of: shade, legend: { title: "Rounds", entries: [["odd", shadeOf(1)], ["even", shadeOf(0)]] } };
    }
    case "short": {
      const back = (i) => scene.kinds[scene.kind[i]].against || group(i) === "turn";
      return {
        of: (i) => (back(i) ? KINDS.dec[1] : KINDS.plain[1]),
        legend: { title: "Short rows", entries: [["worked back", KINDS.dec[1]], ["worked forward", KINDS.plain[1]]] },
      };
    }
    case "length": {
      const values = worked.map((i) => worst(scene, i));
      const { mean, abs } = figures(values);
      return {
        of: (i) => diverging(worst(scene, i) / 0.3),
        legend: {
          title: "Length error",
          scale: [-0.3, 0.3].map(percent),
          stops: [BLUE, WHITE, RED],
          bins: histogram(values, -0.3, 0.3),
          note: `the larger of width and height: mean ${percent(mean)}, mean size ${percent(abs)}`,
        },
      };
    }
    case "strain": {
      const values = worked.map((i) => worst(scene, i));
      const { mean, abs } = figures(values);
      return {
        of: (i) => diverging(worst(scene, i) / 0.15),
        legend: {
          title: scene.predicted ? "Predicted strain" : "Predicted strain, not converged",
          scale: [-0.15, 0.15].map(percent),
          stops: [BLUE, WHITE, RED],
          bins: histogram(values, -0.15, 0.15),
          note: `pressed to stretched: mean ${percent(mean)}, mean size ${percent(abs)}`,
        },
      };
    }
    case "skew": {
      const values = worked.map((i) => scene.skew[i]);
      return {
        of: (i) => mix(WHITE, DARK, Math.min(1, scene.skew[i] / 0.5)),
        legend: {
          title: "Skew",
          scale: ["0", "0.5"],
          stops: [WHITE, DARK],
          bins: histogram(values, 0, 0.5),
          note: `0 is square: mean ${figures(values).mean.toFixed(3)}`,
        },
      };
    }
    default:
      return { of: (i) => yarn[scene.color[i]] || yarn[0], legend: null };
  }
}

function shadeOf(odd) {
  return odd ? [0.93, 0.85, 0.68] : [0.24, 0.47, 0.55];
}
