// The layout of a page in windows of several widths.

export const WIDTHS = [1000, 1280, 1920, 2560];

export async function fits(name, page, width, check) {
  const found = await page.evaluate(() => {
    const seen = (e) => e.getClientRects().length > 0 && e.checkVisibility({ contentVisibilityAuto: true });
    const named = (e) => e.getAttribute("aria-label") || e.closest("[data-label]")?.dataset.label || e.className;
    const cut = [...document.querySelectorAll(".table, .paper, .canvas")]
                    .filter((e) => seen(e) && e.clientWidth > 0 && e.scrollWidth > e.clientWidth + 1)
                    .map((e) => `${named(e)}: ${e.scrollWidth} of ${e.clientWidth} px`);
    const tall = [...document.querySelectorAll("thead")].filter(seen).filter((head) => {
      const cells = [...head.querySelectorAll("th")], line = parseFloat(getComputedStyle(cells[0]).fontSize) * 1.55;
      return cells.some((cell) => cell.getBoundingClientRect().height > 2 * line + 14) ||
          head.querySelectorAll("tr").length > 2;
    });
    const lead = [...document.querySelectorAll(".lead")].at(-1).getBoundingClientRect();
    return {
      over: document.documentElement.scrollWidth - innerWidth, cut, lead: lead.bottom + scrollY,
      tall: tall.map((head) => head.innerText.replaceAll("\n", " ").slice(0, 80))
    };
  });
  check(`${name}: at ${width} px it is ${found.over} px too wide`, found.over <= 0);
  for (const one of found.cut) check(`${name}: at ${width} px something is cut: ${one}`, false);
  for (const head of found.tall) check(`${name}: at ${width} px headings have more than two rows: ${head}`, false);
  check(`${name}: at ${width} px the answer ends at ${found.lead} px`, found.lead <= 900);
}
