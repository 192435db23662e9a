// Scenes, drives from above, as a reader sees and uses it; page_check.mjs opens the pages.
const range = (element) => element.evaluate((e) => [Number(e.dataset.from), Number(e.dataset.to)]);
// Returns the places of a canvas' pixels whose colour is that of a variable of the page: [x, y] on the canvas.
const places = (canvas, variable) => canvas.evaluate((element, name) => {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const digits = hex.length === 4 ? hex.replace(/[0-9a-f]/g, "$&$&") : hex;   // "#000"
  const wanted = [1, 3, 5].map((i) => parseInt(digits.slice(i, i + 2), 16));
  const copy = new OffscreenCanvas(element.width, element.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(element, 0, 0);
  const { data } = copy.getImageData(0, 0, element.width, element.height);
  const found = [], { width } = element;
  for (let i = 0; i < data.length; i += 4)
    if (data[i + 3] > 200 && wanted.every((part, k) => Math.abs(part - data[i + k]) < 40))
      found.push([i / 4 % width, Math.floor(i / 4 / width)].map((px) => px / devicePixelRatio));
  return found;
}, variable);
export const coloured = async (canvas, variable) => (await places(canvas, variable)).length;
// Returns a canvas' pixels, to compare.
const pixels = (canvas) => canvas.evaluate((element) => element.toDataURL());
const instant = (figure) => figure.evaluate((element) => Number(element.dataset.at));

// Pointing at a track tells of it, until the pointer leaves the canvas.
async function tells(name, page, canvas, check) {
  const tip = page.locator(".tip"), box = await canvas.boundingBox(), drawn = await places(canvas, "--c0");
  for (let i = 0; i < drawn.length && !await tip.isVisible(); i += 9)
    await page.mouse.move(box.x + drawn[i][0], box.y + drawn[i][1]);
  const told = await tip.textContent();
  check(`${name}: a track tells "${told}"`, await tip.isVisible() && /^(track|object) \d+/.test(told));
  await page.mouse.move(box.x + 5, box.y - 6);
  check(`${name}: the tip is gone when the pointer leaves the canvas`, await tip.isHidden());
}

// The ids that a canvas shows are inside it, and none covers another.
async function ids_apart(name, page, canvas, check) {
  await page.waitForTimeout(80);
  await page.evaluate(() => { globalThis.written = []; });
  await page.keyboard.press("ArrowLeft");
  await page.waitForTimeout(80);
  const ids = await canvas.evaluate((element) => {
    const c = element.getContext("2d"), { clientWidth, clientHeight } = element;
    c.font = "600 12px system-ui, sans-serif";
    // The numbers of the grid stand at its edges.
    return globalThis.written
        .filter((one) => one.canvas === element && one.x !== 4 && one.y !== parseFloat(element.style.height) - 5)
        .map(({ text, x, y }) => ({ text, x, y, half: c.measureText(text).width / 2, clientWidth, clientHeight }));
  });
  check(`${name}: ids are shown`, ids.length > 0);
  ids.forEach((one, i) => {
    check(`${name}: ${one.text} is on its canvas, at ${one.x}, ${one.y}`,
      one.x >= one.half && one.x + one.half <= one.clientWidth && one.y >= 9 && one.y <= one.clientHeight);
    for (const other of ids.slice(i + 1))
      check(`${name}: ${one.text} and ${other.text} stand apart`,
        Math.abs(one.x - other.x) >= one.half + other.half || Math.abs(one.y - other.y) >= 12);
  });
}

// Two fingers move and zoom a scene: the place between them stays between them. One finger moves it sideways.
async function fingers_move(name, page, canvas, figure, check) {
  const phone = await page.context().newCDPSession(page);
  const touch = (type, ...points) =>
      phone.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y, id], i) => ({ x, y, id: id ?? i })) });
  const box = await canvas.boundingBox(), middle = [box.x + box.width * 0.5, box.y + box.height * 0.4];
  const beside = (x, y) => [middle[0] + x, middle[1] + y];
  const view = async () => (await figure.getAttribute("data-view")).split(" ").map(Number);
  const place = ([x, y, scale], [px, py]) =>
      [x + (px - box.x - box.width / 2) / scale, y - (py - box.y - box.height / 2) / scale];
  const near = (a, b, most) => a.every((one, i) => Math.abs(one - b[i]) < most);
  const scroll = () => page.evaluate(() => [scrollY, visualViewport.scale]);
  const before = await view(), stood = await scroll();
  await touch("touchStart", beside(-40, 0));
  await touch("touchStart", beside(-40, 0), beside(40, 0));
  for (const part of [0.25, 0.5, 0.75, 1])
    await touch("touchMove", beside(-40 - 40 * part, 30 * part), beside(40 + 40 * part, 30 * part));
  await page.waitForTimeout(80);
  const zoomed = await view();
  check(`${name}: two fingers zoom the scene from ${before} to ${zoomed}`, Math.abs(zoomed[2] / before[2] - 2) < 0.02);
  check(`${name}: and move it`, near(place(zoomed, beside(0, 30)), place(before, middle), 2 / zoomed[2]));
  await touch("touchEnd", [...beside(80, 30), 1]);
  await touch("touchMove", beside(-110, 30));
  await page.waitForTimeout(80);
  const moved = await view();
  check(`${name}: the finger that stays moves the scene from ${zoomed} to ${moved}`,
    near(moved, [zoomed[0] + 30 / zoomed[2], zoomed[1], zoomed[2]], 2 / zoomed[2]));
  await touch("touchEnd");
  check(`${name}: the page stands still: ${stood}, ${await scroll()}`, near(await scroll(), stood, 0.5));
  await phone.detach();
}

// A scene plays, and goes where keys, slider, plots and timing diagram send it.
export async function scene_plays(name, page, check, pictures) {
  const figure = page.locator("figure.scenes"), canvas = figure.locator("canvas").first();
  const settled = () => page.waitForTimeout(80);
  await canvas.scrollIntoViewIfNeeded();
  await canvas.focus();
  await page.keyboard.press("End");
  const end = await instant(figure);
  await page.keyboard.press("Home");
  await settled();
  const begin = await instant(figure), first = await pixels(canvas);
  check(`${name}: Home and End are the drive's ends: ${begin} to ${end}`, begin < 0.1 && end > begin + 0.5);
  const drawn = async () => Number(await canvas.getAttribute("data-drawn"));
  const before = await drawn();
  await page.keyboard.press(" ");
  await page.waitForTimeout(400);
  await page.keyboard.press(" ");
  const reached = await instant(figure);
  await page.waitForTimeout(150);
  check(`${name}: Space plays and stops: ${begin} to ${reached}`, reached > begin + 0.1 && reached < begin + 2);
  check(`${name}: it stands still when stopped`, await instant(figure) === reached);
  check(`${name}: it draws while it plays`, await drawn() > before + 4);
  check(`${name}: the picture has changed`, await pixels(canvas) !== first);
  const said = await figure.locator(".heard").textContent();
  check(`${name}: it says what is seen: "${said}"`, /^\d+\.\d{3} s; .+: \d+ objects?, \d+ tracks?/.test(said));
  // From image to image, forth and back.
  await page.keyboard.press("ArrowRight");
  const image = await instant(figure);
  await page.keyboard.press("ArrowRight");
  const next = await instant(figure);
  await page.keyboard.press("ArrowLeft");
  check(`${name}: arrows go from image to image: ${image}, ${next}`,
    image > reached && next > image && next < image + 0.3);
  check(`${name}: and back`, Math.abs(await instant(figure) - image) < 1e-6);
  await figure.locator("input[type=range]").fill((begin + (end - begin) * 0.9).toFixed(3));
  await settled();
  check(`${name}: the slider scrubs`, Math.abs(await instant(figure) - (begin + (end - begin) * 0.9)) < 0.002);
  // The tracks have the colour of their drive's curves, and can be hidden.
  const seen = Number(await canvas.getAttribute("data-tracks")), ink = await coloured(canvas, "--c0");
  check(`${name}: ${seen} tracks are drawn with ${ink} pixels`, seen > 0 && ink > 20);
  await tells(name, page, canvas, check);
  const layer = (words) => figure.getByRole("button", { name: words, exact: true });
  for (const words of ["tracks", "camera: observations"]) await layer(words).click();
  await settled();
  check(`${name}: hidden tracks are gone`, await coloured(canvas, "--c0") === 0);
  for (const words of ["tracks", "camera: observations"]) await layer(words).click();
  await settled();
  check(`${name}: shown tracks are back`, await coloured(canvas, "--c0") === ink);
  const head = figure.locator(".panel .label").first(), counts = await head.textContent();
  await layer("true objects").click();
  await settled();
  check(`${name}: hidden objects are counted: ${counts}`, await head.textContent() === counts);
  await layer("true objects").click();
  await settled();
  const whole = await pixels(canvas);
  await canvas.focus();
  await page.keyboard.press("+");
  await settled();
  check(`${name}: plus zooms the scene`, await pixels(canvas) !== whole);
  for (let i = 0; i < 4; ++i) await page.keyboard.press("+");
  await settled();
  check(`${name}: a track stays in sight however near`, await coloured(canvas, "--c0") > 20);
  await page.keyboard.press("0");
  await settled();
  check(`${name}: 0 shows all of it`, await pixels(canvas) === whole);
  await fingers_move(name, page, canvas, figure, check);
  await page.keyboard.press("0");
  await settled();
  check(`${name}: 0 shows all of it after fingers`, await pixels(canvas) === whole);
  await page.screenshot({ path: `${pictures}/${name}_scene.png` });
  // One instant for the whole page: a click in a plot, and one in the timing diagram.
  const plot = page.locator("figure.plot").filter({ hasText: "Error over time" }), over = plot.locator(".u-over");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox(), [from, to] = await range(plot);
  await page.mouse.click(box.x + box.width * 0.6, box.y + 50);
  const chosen = await instant(figure);
  check(`${name}: a click in a plot chooses ${chosen}`,
    Math.abs(chosen - (from + (to - from) * 0.6)) < (to - from) * 0.01);
  const line = await over.locator(".instant").boundingBox();
  check(`${name}: the plot's line stands there`, Math.abs(line.x - (box.x + box.width * 0.6)) < 3);
  const diagram = page.locator(".diagram").first(), paper = diagram.locator(".paper");
  await paper.scrollIntoViewIfNeeded();
  await page.waitForTimeout(400);   // it turns to the instant
  const place = await diagram.locator("rect.plot").boundingBox(), [early, late] = await range(diagram);
  await page.mouse.click(place.x + place.width / 2, place.y + 4);
  const middle = await instant(figure);
  check(`${name}: a click in the timing diagram chooses ${middle}`,
    Math.abs(middle * 1e3 - (early + late) / 2) < (late - early) * 0.01);
  check(`${name}: the diagram's line is seen`, await diagram.locator("path.instant:not([display])").count() === 1);
  check(`${name}: and the plot's has moved`, Math.abs((await over.locator(".instant").boundingBox()).x - line.x) > 1);
}

// A thousand objects play with 30 frames a second: the machine that tests may be busy, so the middle frame counts.
export async function many_play(name, page, check, pictures) {
  const figure = page.locator("figure.scenes"), canvas = figure.locator("canvas");
  await canvas.scrollIntoViewIfNeeded();
  await canvas.focus();
  await page.keyboard.press("Home");
  await page.keyboard.press(" ");
  // A busy machine begins to play late.
  await page.waitForFunction((shown) => Number(shown.dataset.truth) >= 900, await canvas.elementHandle(), { timeout: 20000 })
    .catch(() => {});
  const took = [];
  for (let i = 0; i < 25; ++i) {
    await page.waitForTimeout(60);
    took.push(Number(await canvas.getAttribute("data-took")));
  }
  await page.keyboard.press(" ");
  const objects = Number(await canvas.getAttribute("data-truth")), middle = took.sort((a, b) => a - b)[12];
  check(`${name}: ${objects} objects are drawn in ${middle} ms`, objects >= 900 && middle < 33);
  check(`${name}: the page says what is left out`,
    /one in \d+ ms of each kind/.test(await figure.locator(".note").textContent()));
  await page.screenshot({ path: `${pictures}/${name}_scene.png` });
  await page.keyboard.press("Home");
  for (let i = 0; i < 12; ++i) await page.keyboard.press("ArrowRight");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("+");
  await ids_apart(name, page, canvas, check);
  await page.screenshot({ path: `${pictures}/${name}_scene_near.png` });
}
