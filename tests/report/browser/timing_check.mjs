// A timing diagram goes over the whole drive, window by window.

const range = (element) => element.evaluate((e) => [Number(e.dataset.from), Number(e.dataset.to)]);
const window_of = (diagram) => diagram.evaluate((e) => Number(e.dataset.window));

// Waits until the diagram shows the window that `holds` says, and returns what it shows.
async function turned(diagram, holds) {
  for (let i = 0; i < 50 && !holds(await window_of(diagram)); ++i) await diagram.page().waitForTimeout(50);
  return window_of(diagram);
}

export async function turns(name, page, check) {
  const diagram = page.locator(".diagram").first(), paper = diagram.locator(".paper");
  const slider = diagram.getByRole("slider");
  const scene = page.locator("figure.scenes"), frames = diagram.locator("rect.frame:not([display])");
  await paper.scrollIntoViewIfNeeded();
  const ends = await slider.evaluate((e) => [Number(e.min), Number(e.max)]);
  check(`${name}: the slider goes over the drive: ${ends}`, ends[0] === 0 && ends[1] > 0.6);
  const go = (at) => slider.evaluate((e, value) => {
    e.value = value;
    e.dispatchEvent(new Event("input", { bubbles: true }));
  }, at);
  for (const part of [0.21, 0.42, 0.64, 0.93]) {
    const at = ends[0] + part * (ends[1] - ends[0]);
    await go(at);
    let seen;
    for (let i = 0; i < 50; ++i) {
      seen = await range(diagram);
      if (seen[0] <= at * 1e3 && at * 1e3 <= seen[1]) break;
      await page.waitForTimeout(50);
    }
    check(`${name}: the slider at ${at} s shows ${seen} ms`, seen[0] <= at * 1e3 && at * 1e3 <= seen[1]);
    check(`${name}: slots are drawn there`, await frames.count() > 10);
    check(`${name}: the line is there`, await diagram.locator("path.instant:not([display])").count() === 1);
    check(`${name}: the scene is there`, Math.abs(await scene.evaluate((e) => Number(e.dataset.at)) - at) < 0.002);
  }
  // Keys go to the neighbours, and back.
  await go(0.5 * (ends[0] + ends[1]));
  await page.waitForTimeout(300);
  await diagram.getByRole("button", { name: "Show all" }).click();
  await paper.focus();
  const middle = await window_of(diagram), all = await range(diagram);
  await page.keyboard.press("n");
  check(`${name}: N shows the next window`, await turned(diagram, (w) => w !== middle) === middle + 1);
  const next = await range(diagram);
  check(`${name}: they adjoin: ${all}, ${next}`, Math.abs(all[1] - next[0]) < 0.01);
  await page.keyboard.press("p");
  check(`${name}: P shows the one before`, await turned(diagram, (w) => w === middle) === middle);
  await diagram.getByRole("button", { name: "Previous window" }).click();
  check(`${name}: the button, too`, await turned(diagram, (w) => w !== middle) === middle - 1);
  // A step beyond the end leads into the next window, with the same zoom.
  await paper.focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("+");
  await page.waitForTimeout(100);
  const span = (await range(diagram))[1] - (await range(diagram))[0];
  for (let i = 0; i < 60 && await window_of(diagram) === middle - 1; ++i) {
    await page.keyboard.press("ArrowRight");
    await page.waitForTimeout(20);
  }
  const [from, to] = await range(diagram);
  check(`${name}: steps lead into the next window`, await window_of(diagram) === middle);
  check(`${name}: the zoom stays: ${span}, ${to - from}`, Math.abs(to - from - span) < 0.01);
  // An instant that is chosen elsewhere turns the diagram.
  await page.evaluate((at) => Instant.set(at), ends[0] + 0.1 * (ends[1] - ends[0]));
  const early = await turned(diagram, (w) => w < middle - 1);
  check(`${name}: an instant of another part turns to window ${early}`, early < middle - 1);
}
