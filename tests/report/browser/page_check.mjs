// Opens pages of `ttfusion report` in headless Chromium, by file://, and acts as a reader.
//   node page_check.mjs CHROMIUM SCREENSHOT_FOLDER run=FILE compared=FILE experiment=FILE hostile=FILE many=FILE
// Exit 1 and a line for every failure.
import { chromium } from "playwright-core";
import { mkdirSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { WIDTHS, fits } from "./layout_check.mjs";
import { coloured, many_play, scene_plays } from "./scene_check.mjs";
import { turns } from "./timing_check.mjs";

const [executablePath, pictures, ...named] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });
let failures = 0;
const check = (what, holds) => {
  if (holds) return;
  ++failures;
  console.log(`FAILED: ${what}`);
};

const browser = await chromium.launch({ executablePath, args: ["--no-sandbox", "--force-color-profile=srgb"] });

// A watched page: any complaint or request of it is a failure.
async function opened(name, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1440, height: 1000 }, offline: true, ...options });
  const page = await context.newPage();
  // A plot's texts on its canvas, with their places.
  await page.addInitScript(() => {
    globalThis.written = [];
    const write = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function(text, x, y) {
      globalThis.written.push({ canvas: this.canvas, text, x, y });
      write.apply(this, arguments);
    };
  });
  const url = pathToFileURL(file).href;
  page.on(
      "console",
      (message) => check(`${name}: console says ${message.text()}`, !["error", "warning"].includes(message.type())));
  page.on("pageerror", (error) => check(`${name}: ${error}`, false));
  page.on("request", (request) => check(`${name}: asks for ${request.url().slice(0, 100)}`,
    request.url() === url || request.url().startsWith("data:")));
  page.on("dialog", (dialog) => { check(`${name}: a dialog`, false); dialog.dismiss(); });
  const begin = Date.now();
  await page.goto(url);
  await page.waitForTimeout(300);
  check(`${name}: it takes ${Date.now() - begin} ms to open`, Date.now() - begin < 8000);
  return page;
}

const range = (element) => element.evaluate((e) => [Number(e.dataset.from), Number(e.dataset.to)]);
const inside = ([a, b], [c, d]) => a >= c - 1e-9 && b <= d + 1e-9 && b - a < (d - c) * 0.99;
const same = ([a, b], [c, d]) => Math.abs(a - c) + Math.abs(b - d) < 1e-6 * (Math.abs(c) + Math.abs(d));

// An axis' labels are the values at their places: both grow in proportion from label to label.
async function labels_hold(name, page, figure) {
  const seen = new Set();
  for (let zoomed = 0; zoomed < 8; ++zoomed) {
    await page.evaluate(() => { globalThis.written = []; });
    await page.keyboard.press("+");
    await page.waitForTimeout(50);
    const written = await figure.locator("canvas").evaluate(
        (canvas) => globalThis.written.filter((one) => one.canvas === canvas && /^-?[\d.]+$/.test(one.text))
                        .map(({ text, x, y }) => ({ text, x, y })));
    const bottom = Math.max(...written.map((one) => one.y));
    const labels = written.filter((one) => one.y === bottom).map((one) => [Number(one.text), one.x]);
    for (let i = 2; i < labels.length; ++i) {
      const [[a, x], [b, y], [c, z]] = labels.slice(i - 2);
      const apart = (c - b) * (y - x) - (b - a) * (z - y), least = Math.abs((c - a) * 4);   // of pixels, 2 each
      check(`${name}: labels ${a}, ${b}, ${c} stand at ${x}, ${y}, ${z}`, Math.abs(apart) <= least);
      seen.add((Math.abs(c - b)).toPrecision(1));
    }
  }
  check(`${name}: steps of several sizes are labelled: ${[...seen]}`, seen.size >= 3);
  await page.keyboard.press("0");
  await page.waitForTimeout(50);
}

// On a screen narrower than a timing diagram, its end and its legend are reached by scrolling.
async function diagram_scrolls(name, page) {
  const diagram = page.locator(".diagram").first();
  const ends = await diagram.evaluate((box) => {
    const paper = box.querySelector(".paper"), svg = paper.querySelector("svg");
    paper.scrollLeft = 1e6;
    const frame = paper.getBoundingClientRect(), picture = svg.getBoundingClientRect();
    const right = Math.max(...[...svg.querySelectorAll("text")].map((text) => text.getBoundingClientRect().right));
    return {
      paper: frame.right, plot: svg.querySelector("rect.plot").getBoundingClientRect().right, texts: right,
      picture: picture.right, below: picture.bottom - frame.bottom, wide: paper.scrollWidth > paper.clientWidth
    };
  });
  check(`${name}: the diagram is wider than the screen`, ends.wide);
  check(`${name}: the diagram's right end is reached: ${JSON.stringify(ends)}`,
    ends.plot <= ends.paper && ends.texts <= ends.picture + 1 && ends.picture <= ends.paper && ends.below <= 0);
  const paper = diagram.locator(".paper");
  await paper.focus();
  for (let i = 0; i < 20; ++i) await page.keyboard.press("Shift+ArrowLeft");
  check(`${name}: keys scroll the diagram back`, await paper.evaluate((e) => e.scrollLeft) === 0);
}

async function plot_zooms(name, page) {
  const figure = page.locator("figure.plot").first(), canvas = figure.locator(".canvas"),
        over = figure.locator(".u-over");
  await canvas.scrollIntoViewIfNeeded();
  await page.waitForTimeout(100);
  const all = await range(figure);
  check(`${name}: a plot shows something`, all[1] > all[0]);
  await canvas.focus();
  await page.keyboard.press("+");
  const near = await range(figure);
  check(`${name}: plus zooms a plot: ${all} to ${near}`, inside(near, all));
  await page.keyboard.press("ArrowRight");
  const later = await range(figure);
  check(`${name}: an arrow moves a plot: ${near} to ${later}`, later[0] > near[0]);
  await page.keyboard.press("0");
  check(`${name}: 0 shows all of a plot`, same(await range(figure), all));
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  const heard = await figure.locator(".heard").textContent();
  check(`${name}: keys say a point's values: "${heard}"`, /^.+: .+ at \S+/.test(heard));
  if (name !== "experiment") await labels_hold(name, page, figure);   // whose axis has few points
  const box = await over.boundingBox();
  await page.mouse.move(box.x + box.width * 0.3, box.y + 60);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, box.y + 60, { steps: 5 });
  await page.mouse.up();
  check(`${name}: dragging zooms a plot`, inside(await range(figure), all));
  await figure.getByRole("button", { name: "Show all" }).click();
  check(`${name}: the button shows all`, same(await range(figure), all));
  await page.keyboard.down("Shift");
  await page.mouse.move(box.x + box.width * 0.5, box.y + 60);
  await page.mouse.wheel(0, -200);
  await page.keyboard.up("Shift");
  await page.waitForTimeout(100);
  check(`${name}: the wheel zooms a plot`, inside(await range(figure), all));
  await figure.getByRole("button", { name: "Show all" }).click();
  const value = figure.locator(".legend .value").first();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 100);
  check(`${name}: the cursor tells values`, (await value.textContent()).includes(" at "));
}

async function diagram_zooms(name, page) {
  const diagram = page.locator(".diagram").first(), paper = diagram.locator(".paper");
  await paper.scrollIntoViewIfNeeded();
  await page.waitForTimeout(400);   // it turns to the instant
  await diagram.getByRole("button", { name: "Show all" }).click();
  await page.waitForTimeout(100);
  const all = await range(diagram);
  await paper.focus();
  await page.keyboard.press("+");
  await page.keyboard.press("+");
  await page.waitForTimeout(100);
  const near = await range(diagram);
  check(`${name}: plus zooms the diagram: ${all} to ${near}`, inside(near, all));
  const wide = async () => page.evaluate(() => {
    const one =
        [...document.querySelectorAll(".diagram:not([hidden]) rect.frame")].find((e) => !e.hasAttribute("display"));
    return Number(one.getAttribute("width"));
  });
  const before = await wide();
  await page.keyboard.press("ArrowRight");
  check(`${name}: an arrow moves the diagram`, (await range(diagram))[0] > near[0]);
  const box = await paper.boundingBox();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 200);
  await page.keyboard.down("Control");
  for (let i = 0; i < 4; ++i) await page.mouse.wheel(0, -200);
  await page.keyboard.up("Control");
  await page.waitForTimeout(200);
  const nearer = await range(diagram);
  check(`${name}: the wheel zooms the diagram`, nearer[1] - nearer[0] < near[1] - near[0]);
  check(`${name}: slots grow with it: ${before} to ${await wide()}`, await wide() > 1.5 * before);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.7, box.y + 200, { steps: 4 });
  await page.mouse.up();
  check(`${name}: dragging moves the diagram`, (await range(diagram))[0] < nearer[0]);
  await page.screenshot({ path: `${pictures}/${name}_diagram_zoomed.png` });
  await diagram.getByRole("button", { name: "Show all" }).click();
  await page.waitForTimeout(100);
  check(`${name}: the button shows all of the diagram`, same(await range(diagram), all));
  // Pointing at an arrow, a slot and a task shows its times and ages.
  await paper.focus();
  for (let i = 0; i < 2; ++i) await page.keyboard.press("+");
  await page.waitForTimeout(100);
  for (const [kind, words] of [
           ["path.arrow", / ms to .*age .* since /s], ["rect.frame", /slot \d+, cycle \d+.* ms to /s],
           ["rect.task", /: .* ms to /s], ["path.measured", /is measured\s+at /]]) {
    const spot = await page.evaluate((selector) => {
      for (const element of document.querySelectorAll(`.diagram:not([hidden]) ${selector}`)) {
        if (element.hasAttribute("display")) continue;
        const box = element.getBoundingClientRect();
        const x = box.x + box.width / 2, y = box.y + box.height / 2;
        if (document.elementFromPoint(x, y) === element) return [x, y];
      }
      return null;
    }, kind);
    check(`${name}: a ${kind} can be pointed at`, spot !== null);
    if (!spot) continue;
    await page.mouse.move(...spot);
    const told = await page.locator(".tip").textContent();
    check(`${name}: ${kind} says "${told}"`, words.test(told) && await page.locator(".tip").isVisible());
    if (kind === "path.arrow") await page.screenshot({ path: `${pictures}/${name}_diagram_hover.png` });
  }
  await paper.focus();
  await page.mouse.move(2, 2);
  await page.keyboard.press(".");
  await page.keyboard.press(".");
  check(`${name}: keys go from thing to thing`, (await diagram.locator(".told").textContent()).length > 10);
  await page.keyboard.press("Escape");
}

// An experiment shows a drive of each paradigm: a diagram each, chosen from a list, and one plot of ages and clocks.
async function side_by_side(name, page) {
  const figure = page.locator("figure.timing"), select = figure.locator("select");
  const labels = await select.locator("option").allTextContents();
  check(`${name}: a diagram of each paradigm: ${labels}`, labels.join() === "adva,tt");
  check(`${name}: one diagram is seen`, await figure.locator(".diagram:visible").count() === 1);
  await select.selectOption("1");
  check(`${name}: the list chooses the diagram`,
    await figure.locator(".diagram:visible").getAttribute("data-label") === "tt");
  const frames = figure.locator(".diagram:visible rect.frame:not([display])");
  check(`${name}: the other diagram is drawn`, await frames.count() > 10);
  await select.selectOption("0");
  for (const heading of ["Ages of measurements", "Precision", "Error over time"]) {
    const plot = page.locator("figure.plot").filter({ has: page.locator("strong", { hasText: heading }) }).first();
    const names = await plot.locator(".legend").innerText();
    check(`${name}: "${heading}" has a curve each: ${names}`, /adva/.test(names) && /tt/.test(names));
  }
}

// The Tab key reaches every control.
async function reached(name, page) {
  await page.locator(".skip").focus();
  const wanted =
      await page.locator("figure .canvas:visible, .diagram .paper:visible, figure select:visible, summary:visible")
          .count();
  const seen = new Set();
  for (let i = 0; i < 600; ++i) {
    await page.keyboard.press("Tab");
    const id = await page.evaluate(() => {
      const e = document.activeElement;
      if (!e.matches("figure .canvas, .diagram .paper, figure select, summary"))
        return e === document.body ? "end" : "";
      e.dataset.reached ??= String(Math.random());
      return e.dataset.reached;
    });
    if (id === "end") break;
    if (id) seen.add(id);
  }
  check(`${name}: ${seen.size} of ${wanted} things are reached with the Tab key`, seen.size >= wanted);
}

async function looks(name, file) {
  const grounds = [];
  for (const colorScheme of ["light", "dark"]) {
    const page = await opened(`${name}, ${colorScheme}`, file, { colorScheme });
    grounds.push(await page.evaluate(() => getComputedStyle(document.body).backgroundColor));
    await page.screenshot({ path: `${pictures}/${name}_${colorScheme}.png`, fullPage: true });
    await page.context().close();
  }
  check(`${name}: dark is as light: ${grounds}`, grounds[0] !== grounds[1]);
  const wide = await opened(`${name}, wide`, file);
  for (const width of WIDTHS) {
    await wide.setViewportSize({ width, height: 900 });
    await wide.waitForTimeout(400);
    await fits(name, wide, width, check);
    await wide.screenshot({ path: `${pictures}/${name}_${width}.png` });
  }
  await wide.context().close();
  const narrow = await opened(`${name}, narrow`, file, { viewport: { width: 420, height: 900 } });
  const overflow = await narrow.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  check(`${name}: on a narrow screen it is ${overflow} px too wide`, overflow <= 0);
  if (await narrow.locator(".diagram").count() > 0) await diagram_scrolls(`${name}, narrow`, narrow);
  await narrow.screenshot({ path: `${pictures}/${name}_narrow.png` });
  await narrow.context().close();
  const paper = await opened(`${name}, printed`, file, { colorScheme: "dark" });
  await paper.pdf({ path: `${pictures}/${name}.pdf`, format: "A4" });
  await paper.emulateMedia({ media: "print" });
  const hidden = await paper.locator("nav").isHidden();
  check(`${name}: contents are not printed`, hidden);
  for (const canvas of await paper.locator("figure.scenes canvas").all())
    check(`${name}: a scene is printed, in ink for paper`, await coloured(canvas, "--ink") > 20);
  const diagrams = paper.locator(".diagram"), all = await diagrams.count();
  check(`${name}: all ${all} diagrams are printed`, await paper.locator(".diagram:visible").count() === all);
  for (let i = 0; i < all; ++i) {
    const label = await diagrams.nth(i).evaluate((box) => getComputedStyle(box, "::before").content);
    check(`${name}: diagram ${i} is printed with its name: ${label}`, label.length > 3 && label !== "none");
  }
  await paper.context().close();
}

for (const one of named) {
  const [name, file] = one.split("=");
  const page = await opened(name, file);
  if (name === "hostile") {
    check("hostile: nothing of a name runs", !(await page.evaluate(() => globalThis.broken)));
    check("hostile: a name is shown as it is", (await page.locator("h1").textContent()).includes("</script><script>"));
    await page.context().close();
    continue;
  }
  if (name === "many") {
    await many_play(name, page, check, pictures);
    await page.context().close();
    continue;
  }
  check(`${name}: sections`, await page.locator("section").count() >= 5);
  check(`${name}: an answer`, (await page.locator(".lead").last().textContent()).length > 30);
  check(`${name}: plots are drawn`, await page.locator("figure.plot canvas:visible").count() >= 2);
  check(`${name}: tables`, await page.locator("table tbody tr").count() >= 5);
  check(`${name}: commands`, /ttfusion (run|experiment)/.test(await page.locator("pre.command").first().textContent()));
  check(`${name}: uPlot's licence`, (await page.locator("footer").textContent()).includes("Leon Sorokin"));
  if (name !== "compared") await scene_plays(name, page, check, pictures);
  const scenes = await page.locator("figure.scenes canvas").count();
  check(`${name}: ${scenes} drives are seen from above`, scenes === { run: 3, compared: 6, experiment: 2 }[name]);
  await plot_zooms(name, page);
  await diagram_zooms(name, page);
  await turns(name, page, check);
  if (name === "experiment") await side_by_side(name, page);
  await reached(name, page);
  await page.context().close();
  await looks(name, file);
}
await browser.close();
console.log(failures === 0 ? "the pages do what they must" : `${failures} failures`);
process.exit(failures === 0 ? 0 : 1);
