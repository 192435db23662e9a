// Scenes, drives from above, as a reader sees and uses it; page_check.mjs opens the pages.
const range = (element) => element.evaluate((e) => [Number(e.dataset.from), Number(e.dataset.to)]);
// Counts the pixels of a canvas whose colour is that of a variable of the page.
export const coloured = (canvas, variable) => canvas.evaluate((element, name) => {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const digits = hex.length === 4 ? hex.replace(/[0-9a-f]/g, "$&$&") : hex;   // "#000"
  const wanted = [1, 3, 5].map((i) => parseInt(digits.slice(i, i + 2), 16));
  const copy = new OffscreenCanvas(element.width, element.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(element, 0, 0);
  const { data } = copy.getImageData(0, 0, element.width, element.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4)
    if (data[i + 3] > 200 && wanted.every((part, k) => Math.abs(part - data[i + k]) < 40)) ++count;
  return count;
}, variable);
// Returns a canvas' pixels, to compare.
const pixels = (canvas) => canvas.evaluate((element) => element.toDataURL());
const instant = (figure) => figure.evaluate((element) => Number(element.dataset.at));

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
  const layer = (words) => figure.getByRole("button", { name: words, exact: true });
  for (const words of ["tracks", "camera: observations"]) await layer(words).click();
  await settled();
  check(`${name}: hidden tracks are gone`, await coloured(canvas, "--c0") === 0);
  for (const words of ["tracks", "camera: observations"]) await layer(words).click();
  await settled();
  check(`${name}: shown tracks are back`, await coloured(canvas, "--c0") === ink);
  const whole = await pixels(canvas);
  await canvas.focus();
  await page.keyboard.press("+");
  await settled();
  check(`${name}: plus zooms the scene`, await pixels(canvas) !== whole);
  await page.keyboard.press("0");
  await settled();
  check(`${name}: 0 shows all of it`, await pixels(canvas) === whole);
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
}
