// Opens pages from the disk, clicks, hovers, slides and prints them, and looks at what they say about themselves.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(new URL("../../viewer/package.json", import.meta.url))("playwright-core");
const [folder, ...names] = process.argv.slice(2);

const profile = mkdtempSync(join(tmpdir(), "picot-browser-"));
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  args: [
    "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
  ],
});

/** A page with its errors and the requests that leave the disk. */
async function open(file, hash = "", options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 640 }, ...options });
  // Software rendering on a busy machine is slow, and no fault of the page.
  context.setDefaultTimeout(120000);
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(`error: ${error.message}`));
  page.on("console", (message) => message.type() === "error" && wrong.push(`console: ${message.text()}`));
  page.on("dialog", (dialog) => wrong.push(`dialog: ${dialog.message()}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) wrong.push(`request: ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href + hash);
  await page.locator("html[data-ready]").waitFor({ state: "attached", timeout: 120000 });
  return { page, wrong, context, stats: () => page.evaluate(() => window.__stats) };
}

/** Share of the picture that is not background, and its mean color. */
async function look(page) {
  return page.evaluate(() => {
    const canvas = document.getElementById("canvas");
    return new Promise((done) => {
      const image = new Image();
      image.onload = () => {
        const copy = document.createElement("canvas");
        [copy.width, copy.height] = [200, 150];
        const context = copy.getContext("2d");
        context.drawImage(image, 0, 0, 200, 150);
        const { data } = context.getImageData(0, 0, 200, 150);
        let drawn = 0;
        const sum = [0, 0, 0];
        for (let i = 0; i < data.length; i += 4) {
          if (data[i + 3] < 128) continue;
          drawn++;
          for (let k = 0; k < 3; k++) sum[k] += data[i + k];
        }
        done({ drawn: drawn / 30000, mean: sum.map((x) => Math.round(x / Math.max(1, drawn))) });
      };
      image.src = window.__photo ? window.__photo() : canvas.toDataURL();
    });
  });
}

const different = (a, b) => a.mean.some((x, k) => Math.abs(x - b.mean[k]) > 6);

/** Every line of the printed pattern, as the text target has it. */
function lines(html) {
  const items = html.match(/<li class="round[^]*?<\/li>/g) || [];
  const plain = (text) => text.replace(/<[^>]*>/g, "").replace(/&lt;/g, "<").replace(/&gt;/g, ">").replace(/&amp;/g, "&");
  return items.map((item) => plain(item).trim());
}

async function check(name) {
  const file = join(folder, `${name}.html`);
  const { page, wrong, context, stats } = await open(file);
  const first = await stats();
  assert.ok(first.stitches > 50 && first.nodes > 50, `${name}: ${JSON.stringify(first)}`);
  assert.ok(first.triangles > first.stitches * 50 && first.drawCalls <= 8, `${name}: ${JSON.stringify(first)}`);
  assert.equal(first.visible, first.stitches);
  const whole = await look(page);
  assert.ok(whole.drawn > 0.08 && whole.drawn < 0.9, `${name}: ${JSON.stringify(whole)}`);

  // Nothing moves, so nothing is drawn.
  await page.waitForTimeout(300);
  const rest = (await stats()).frames;
  await page.waitForTimeout(400);
  assert.equal((await stats()).frames, rest, `${name} draws without a reason`);

  // The slider takes stitches away.
  await page.locator("#rows").fill(String(Math.floor(first.rows / 2)));
  const half = await stats();
  assert.ok(half.visible > 0 && half.visible < first.stitches && half.visibleRows === Math.floor(first.rows / 2));
  assert.match(page.url(), /rows=/);
  assert.ok((await look(page)).drawn < whole.drawn);
  await page.locator("#more").click();
  assert.equal((await stats()).visible, half.visible + 1);
  await page.locator("#rows").focus();
  await page.keyboard.press("End");
  assert.equal((await stats()).visible, first.stitches);

  // Colors change the picture and come back.
  const plain = await look(page);
  for (const mode of name === names[0] ? ["kind", "length", "skew", "round", "short"] : ["kind"]) {
    await page.selectOption("#color", mode);
    assert.ok(different(await look(page), plain), `${name}: color ${mode} changes nothing`);
    assert.equal((await stats()).color, mode);
    assert.ok(await page.locator("#key").isVisible());
  }
  await page.selectOption("#color", "plain");
  assert.ok(!different(await look(page), plain));

  // Strain is offered where the shape is predicted, and nowhere else.
  assert.ok(await page.locator("#color option[value=strain]").isDisabled());

  // The page's yarn is that of the models: each ring of four points in the OBJ lies around a point of it.
  const yarn = await page.evaluate(() => window.__yarn());
  const model = readFileSync(join(folder, `${name}.obj`), "utf8").split("\n").filter((line) => line.startsWith("v "));
  const vertices = model.map((line) => line.split(" ").slice(1).map(Number));
  let furthest = 0;
  // The page has the first point twice; the model has a middle for its lid before the first ring.
  const count = Math.min(yarn.length / 3 - 2, (vertices.length - 2) / 4);
  assert.ok(Math.abs(yarn.length / 3 - 2 - (vertices.length - 2) / 4) < 1, `${name}: other yarn in the model`);
  for (let k = 0; k < count; k += 7) {
    const ring = vertices.slice(1 + 4 * k, 5 + 4 * k);
    const middle = [0, 1, 2].map((n) => ring.reduce((sum, at) => sum + at[n], 0) / 4);
    furthest = Math.max(furthest, Math.hypot(...middle.map((x, n) => x - yarn[3 * (k + 1) + n])));
  }
  assert.ok(furthest < 0.03, `${name}: the page's yarn is ${furthest} mm off`);

  // Files.
  const download = async (button) => {
    const [file] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
    return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
  };
  const saved = await download("#model");
  assert.match(saved.name, /\.stl$/);
  assert.equal(saved.bytes.readUInt32LE(80), readFileSync(join(folder, `${name}.stl`)).readUInt32LE(80), `${name}: triangles`);
  assert.equal(saved.bytes.length, 84 + 50 * saved.bytes.readUInt32LE(80));
  writeFileSync(join(folder, `${name}-page.stl`), saved.bytes);
  const text = await download("#text");
  assert.equal(text.bytes.toString(), readFileSync(join(folder, `${name}.txt`), "utf8"));
  assert.match((await download("#picture")).name, /\.png$/);

  // Wire-frame.
  await page.locator("input[value=wire]").check();
  // What is drawn is counted with the next frame.
  let wire = await stats();
  for (let wait = 0; wait < 30 && wire.triangles >= first.triangles; wait += 1) {
    await page.waitForTimeout(100);
    wire = await stats();
  }
  assert.ok(wire.mode === "wire" && wire.triangles < first.triangles, JSON.stringify(wire));
  await page.locator("input[value=yarn]").check();

  // Hovering names the stitch; a click finds it in the text.
  const box = await page.locator("#canvas").boundingBox();
  await page.locator('[data-view="front"]').click();
  let found = null;
  for (const [x, y] of [[0.5, 0.5], [0.5, 0.35], [0.45, 0.6], [0.4, 0.5], [0.6, 0.5], [0.5, 0.7]]) {
    found = [box.x + box.width * x, box.y + box.height * y];
    await page.mouse.move(...found);
    await page.waitForTimeout(120);
    if (await page.locator("#tip").isVisible()) break;
  }
  const tip = await page.locator("#tip").textContent();
  assert.match(tip, /(round|row) \d+ . stitch \d+ . \w+/u, `${name}: ${tip}`);
  assert.equal((await stats()).highlighted, 1);
  await page.mouse.click(...found);
  assert.equal(await page.locator("#pattern .lit").count(), 1, `${name}: no text is lit`);
  const round = await page.locator("#pattern .lit").evaluate((node) => node.closest(".round")?.textContent || "");
  const number = Number(/(?:round|row) (\d+)/.exec(tip)[1]);
  const [from, to] = /(\d+)(?:-(\d+))?/.exec(round).slice(1).map(Number);
  assert.ok(number === from || (number > from && number <= to), `${name}: ${tip} is not in ${round}`);
  await page.keyboard.press("Escape");

  // Text lights stitches.
  const run = page.locator("#pattern .run").nth(3);
  const asked = await run.evaluate((node) => {
    const times = (node.dataset.r || "").split(";").filter(Boolean).reduce((all, it) => all * Number(it.split(",")[1]), 1);
    const rounds = /Rnds (\d+)-(\d+)/.exec(node.closest(".round").textContent);
    return Number(node.dataset.n) * times * (rounds ? rounds[2] - rounds[1] + 1 : 1);
  });
  await page.mouse.click(box.x + 4, box.y + 4);
  await run.click();
  assert.equal((await stats()).highlighted, asked, `${name}: a run lights other stitches`);

  // What is ticked off is remembered.
  await page.locator("#pattern .round input").nth(1).check();
  await page.reload();
  await page.locator("html[data-ready]").waitFor({ state: "attached", timeout: 120000 });
  assert.ok(await page.locator("#pattern .round input").nth(1).isChecked(), `${name}: a tick is lost`);

  // Tabs by keyboard.
  await page.locator("#tab-pattern").focus();
  await page.keyboard.press("ArrowRight");
  assert.ok(await page.locator("#chart svg").isVisible());
  const sign = page.locator("#chart svg path[id]").nth(20);
  await sign.click({ force: true });
  assert.equal((await stats()).highlighted, 1);

  // Everything that has a job has a name.
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll("button, input, select, canvas, [role=tab]")].filter(
      (node) => !(node.textContent.trim() || node.ariaLabel || node.labels?.length)).length);
  assert.equal(nameless, 0);

  // On paper every round is there, whatever tab was open.
  for (const format of ["A4", "Letter"]) {
    const pdf = join(profile, `${name}.pdf`);
    await page.pdf({ path: pdf, format, preferCSSPageSize: false });
    const printed = execFileSync("pdftotext", ["-raw", pdf, "-"]).toString().replace(/\s+/g, "");
    for (const line of lines(readFileSync(file, "utf8"))) {
      assert.ok(printed.includes(line.replace(/\s+/g, "")), `${name} on ${format}: "${line}" is not printed`);
    }
    if (process.env.KEEP) await page.screenshot({ path: join(process.env.KEEP, `${name}.png`) });
    if (process.env.KEEP) writeFileSync(join(process.env.KEEP, `${name}-${format}.pdf`), readFileSync(pdf));
  }
  assert.deepEqual(wrong, [], name);
  await context.close();
  return first;
}

try {
  for (const name of names) {
    const figures = await check(name);
    console.log(`${name}: ${figures.stitches} stitches, ${figures.triangles} triangles, ${figures.drawCalls} draw calls`);
  }
  // A phone in the dark, with a state in the address.
  const phone = { viewport: { width: 360, height: 740 }, colorScheme: "dark", hasTouch: true, reducedMotion: "reduce" };
  const small = await open(join(folder, `${names[0]}.html`), "#rows=5&mode=wire&color=skew&view=front&tab=chart", phone);
  const stats = await small.stats();
  assert.deepEqual([stats.visibleRows, stats.mode, stats.color, stats.tab], [5, "wire", "skew", "chart"]);
  assert.ok(await small.page.evaluate(() => document.documentElement.scrollWidth <= 360), "wider than a phone");
  if (process.env.KEEP) await small.page.screenshot({ path: join(process.env.KEEP, "phone.png") });
  assert.deepEqual(small.wrong, []);
  await small.context.close();
  // A predicted shape has strain to show.
  const predicted = await open(join(folder, "predicted.html"), "#color=strain");
  assert.equal((await predicted.stats()).color, "strain");
  assert.match(await predicted.page.locator("#key").textContent(), /Predicted strain/);
  assert.deepEqual(predicted.wrong, []);
  await predicted.context.close();
  // Names are text.
  const hostile = await open(join(folder, "hostile.html"));
  assert.equal(await hostile.page.locator("img[src=x]").count(), 0);
  assert.match(await hostile.page.locator("h1").textContent(), /<img src=x/);
  assert.deepEqual(hostile.wrong, []);
  await hostile.context.close();
  // Without WebGL the pattern and the chart are there.
  const script = "HTMLCanvasElement.prototype.getContext = () => null;";
  const context = await browser.newContext();
  context.setDefaultTimeout(120000);
  const page = await context.newPage();
  await page.addInitScript(script);
  await page.goto(pathToFileURL(join(folder, `${names[0]}.html`)).href);
  await page.locator("html[data-ready]").waitFor({ state: "attached", timeout: 120000 });
  assert.ok(await page.locator("#no-view").isVisible());
  assert.ok(await page.locator("#pattern .round").first().isVisible());
  await context.close();
  console.log("phone, hostile names, no WebGL: fine");
} finally {
  await browser.close();
  rmSync(profile, { recursive: true, force: true });
}
