// Moves and zooms the timing diagrams that timing_drawing.js draws, turns to other windows of the drive, and tells of
// slots, tasks and arrows.
"use strict";
(() => {
  const { make, buttons } = Elements;
  const ms = (t) => (Math.round(t * 1e4) / 1e4).toString();
  const lasting = (t) => (t < 1 ? `${Math.round(t * 1e4) / 10} µs` : `${Math.round(t * 1e3) / 1e3} ms`);

  const tip = make("div", { className: "tip", hidden: true });
  document.body.append(tip);

  class Diagram extends TimingDrawing {
    // `windows` are those of the whole drive, if the page has them.
    constructor(box, windows) {
      super(box);
      this.windows = windows;
      if (!this.plot && !windows) return;
      this.near = true;
      this.controls();
      if (this.plot) this.taken();
      if (windows) this.window = windows.at(this.first ?? windows.from);
      if (!this.plot) this.turn(this.window);
      Instant.on((at, by) => this.mark(at, by));
      new ResizeObserver(() => this.fit()).observe(this.paper);
      // A diagram out of sight follows the page's instant when it is seen again.
      if (windows)
        new IntersectionObserver(([entry]) => {
          this.near = entry.isIntersecting;
          if (this.near) this.mark(Instant.at);
        }, { rootMargin: "200px" }).observe(this.paper);
    }

    // Reads what the script needs of a new picture.
    taken() {
      this.things = this.items.filter((item) => item.title).sort((p, q) => p.a - q.a || p.y - q.y);
      this.by_element = new Map(this.things.map((item) => [item.element, item]));
      this.line = document.createElementNS("http://www.w3.org/2000/svg", "path");
      this.line.setAttribute("class", "instant");
      this.svg.append(this.line);
    }

    // Shows another window of the drive, and of it the times that `view` gives; by default all.
    async turn(window, view = () => [this.first, this.last]) {
      this.wanted = window;
      const svg = await this.windows.svg(window), ids = this.box.dataset.ids;
      if (this.wanted !== window) return;   // the reader has gone on
      this.wanted = undefined;
      this.choose(undefined);
      this.svg.outerHTML = svg.replaceAll(" id=\"", ` id="${ids}`).replaceAll("url(#", `url(#${ids}`);
      this.window = window;
      this.box.dataset.window = window;
      this.take();
      this.taken();
      this.show(...view());
      this.fit();
    }
    // Turns to a neighbour, at the end that adjoins, and keeps the time that is seen. Returns whether there is one.
    beside(by) {
      const window = (this.wanted ?? this.window) + by;
      if (!this.windows || window < 0 || window >= this.windows.count) return false;
      const span = this.to - this.from;
      this.turn(window, () => (by > 0 ? [this.first, this.first + span] : [this.last - span, this.last]));
      return true;
    }
    // Turns to the window of an instant [ms], and moves to it.
    follow(t) {
      const window = this.windows.at(t), span = this.to - this.from;
      const view = () => [t - span / 2, t + span / 2];
      if (!this.windows.has(window, t)) return;
      if (window !== (this.wanted ?? this.window)) this.turn(window, view);
      else if (this.wanted === undefined && (t < this.from || t > this.to)) this.show(...view());
    }
    // At the end of a window, a step leads into the next one.
    move(part) {
      const ends = part > 0 ? this.to >= this.last - 1e-6 : this.from <= this.first + 1e-6;
      if (!ends || !this.beside(Math.sign(part))) super.move(part);
    }

    controls() {
      this.range = make("span", { className: "range" });
      const bar = make("div", { className: "bar" });
      const button = buttons(bar);
      if (this.windows) this.over_the_drive(bar, button);
      bar.append(this.range, make("span", { className: "grow" }));
      button("◀", "Earlier", () => this.move(-0.25));
      button("▶", "Later", () => this.move(0.25));
      button("+", "Zoom in", () => this.zoom(0.5));
      button("−", "Zoom out", () => this.zoom(2));
      button("All", "Show all", () => this.show(this.first, this.last));
      this.told = make("p", { className: "told" });
      this.told.setAttribute("aria-live", "polite");
      this.keys = make("p", { className: "keys" });
      this.keys.innerHTML =
          "Click to choose the instant, drag to move, <kbd>Ctrl</kbd> or <kbd>Shift</kbd> and the wheel to zoom, or, with the focus here: " +
          "<kbd>+</kbd> <kbd>−</kbd> zoom, <kbd>←</kbd> <kbd>→</kbd> move, <kbd>0</kbd> all, " +
          "<kbd>,</kbd> <kbd>.</kbd> from thing to thing" +
          (this.windows ? ", <kbd>P</kbd> <kbd>N</kbd> previous and next window" : "") +
          "<span class=\"scrolls\">, <kbd>Shift</kbd> with <kbd>←</kbd> <kbd>→</kbd> to the parts beside it</span>.";
      this.paper.before(bar);
      this.paper.after(this.told, this.keys);
      this.paper.tabIndex = 0;
      this.paper.setAttribute("role", "group");
      this.paper.setAttribute(
          "aria-label",
          `Timing diagram, ${this.box.dataset.label}. Plus and minus zoom, arrow keys move, ` +
              "0 shows all, comma and full stop go from thing to thing" +
              (this.windows ? ", P and N to the previous and next window." : "."));
      this.paper.addEventListener("keydown", (event) => this.key(event));
      this.paper.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
      this.paper.addEventListener("dblclick", () => this.show(this.first, this.last));
      this.paper.addEventListener("pointerdown", (event) => this.grab(event));
      this.paper.addEventListener("pointermove", (event) => this.point(event));
      this.paper.addEventListener("pointerleave", () => this.leave());
    }

    // The slider goes over the whole drive, and chooses the page's instant.
    over_the_drive(bar, button) {
      const { from, to } = this.windows;
      this.slider = make("input", { type: "range", min: from / 1e3, max: to / 1e3, step: "any" });
      this.slider.setAttribute("aria-label", `Instant of the timing diagram, ${this.box.dataset.label}`);
      this.slider.addEventListener("input", () => {
        const at = Number(this.slider.value);
        Instant.set(at, this);
        this.follow(at * 1e3);
      });
      this.place_in_drive = make("output", { className: "range" });
      button("|◀", "Previous window", () => this.beside(-1));
      bar.append(this.slider, this.place_in_drive);
      button("▶|", "Next window", () => this.beside(1));
    }

    drawn() {
      this.mark(Instant.at, this);
      if (this.windows) {
        const at = Instant.at * 1e3, shown = at >= this.first && at <= this.last ? at : this.from;
        this.slider.value = shown / 1e3;
        const [now, end] = [shown, this.windows.to].map((t) => (t / 1e3).toFixed(3));
        this.place_in_drive.textContent = `${now} s of ${end} s`;
      }
      this.range.textContent =
          `${this.box.dataset.label}: ${ms(this.from)} to ${ms(this.to)} ms, ${lasting(this.to - this.from)}`;
    }

    // Shows the page's instant. A part of the diagram follows it.
    mark(at, by) {
      if (!this.plot) return;
      const t = at === undefined ? NaN : at * 1e3, span = this.to - this.from;
      const drawn = t >= this.first && t <= this.last;
      if (by !== this && !drawn && this.windows && this.near && !Number.isNaN(t)) this.follow(t);
      if (drawn && by !== this && (t < this.from || t > this.to)) this.show(t - span / 2, t + span / 2);
      if (drawn && t >= this.from && t <= this.to) {
        this.line.removeAttribute("display");
        this.line.setAttribute("d", `M${this.x(t).toFixed(2)} ${this.top}V${this.top + this.height}`);
      } else {
        this.line.setAttribute("display", "none");
      }
    }

    words(item) {
      const lines = [item.title];
      if (item.b === undefined) lines.push(`at ${ms(item.a)} ms`);
      else if (item.beyond) lines.push(`${ms(item.a)} ms until after ${ms(item.b)} ms`);
      else lines.push(`${ms(item.a)} ms to ${ms(item.b)} ms, ${lasting(item.b - item.a)}`);
      if (item.since !== undefined)
        lines.push(`age ${lasting(item.a - item.since)} to ${lasting(item.b - item.since)} since ${ms(item.since)} ms`);
      return lines.join("\n");
    }
    // Highlights everything of one list.
    choose(item) {
      for (const element of this.svg.querySelectorAll(".hot")) element.classList.remove("hot");
      this.chosen = item;
      if (!item) { this.told.textContent = ""; return; }
      for (const one of this.things)
        if (one === item || (item.id !== undefined && one.id === item.id && Math.abs(one.a - item.a) < 500))
          one.element.classList.add("hot");
      this.told.textContent = this.words(item).replaceAll("\n", " · ");
    }
    step(by) {
      const seen = this.things.filter(
          (item) => item.a >= this.from && item.a <= this.to && !item.element.classList.contains("null"));
      if (seen.length === 0) return;
      const at = seen.indexOf(this.chosen);
      this.choose(seen[at < 0 ? (by > 0 ? 0 : seen.length - 1) : Math.max(0, Math.min(seen.length - 1, at + by))]);
      const x = this.x(this.chosen.a), room = this.paper.clientWidth, from = this.paper.scrollLeft;
      if (x < from || x > from + room) this.paper.scrollLeft = x - room / 2;
    }
    key(event) {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const scroll = event.shiftKey ? { ArrowLeft: -120, ArrowRight: 120 }[event.key] : undefined;
      if (scroll !== undefined) {
        event.preventDefault();
        this.paper.scrollLeft += scroll;
        return;
      }
      const act = {
        "+": () => this.zoom(0.5), "=": () => this.zoom(0.5), "-": () => this.zoom(2), "_": () => this.zoom(2),
        "0": () => this.show(this.first, this.last), "Home": () => this.show(this.first, this.last),
        "ArrowLeft": () => this.move(-0.1), "ArrowRight": () => this.move(0.1),
        ",": () => this.step(-1), ".": () => this.step(1),
        "p": () => this.beside(-1), "n": () => this.beside(1), "Escape": () => this.choose(undefined),
      }[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    }
    wheel(event) {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      this.zoom((event.deltaY || event.deltaX) > 0 ? 1.25 : 0.8, this.t(event.clientX));
    }
    grab(event) {
      if (event.button !== 0) return;
      const box = this.paper.getBoundingClientRect();
      if (event.clientY > box.top + this.paper.clientTop + this.paper.clientHeight) return;   // on its scroll bar
      if (event.pointerType === "touch" && this.paper.classList.contains("wider")) return;    // it scrolls
      const held = this.t(event.clientX);
      this.paper.classList.add("dragging");
      this.paper.setPointerCapture(event.pointerId);
      const drag = (moved) => {
        const by = held - this.t(moved.clientX);
        this.show(this.from + by, this.to + by);
      };
      const drop = (dropped) => {
        if (dropped.type === "pointerup" && Math.abs(dropped.clientX - event.clientX) < 3)
          Instant.set(held / 1e3, this);
        this.paper.classList.remove("dragging");
        this.paper.removeEventListener("pointermove", drag);
      };
      this.paper.addEventListener("pointermove", drag);
      this.paper.addEventListener("pointerup", drop, { once: true });
      this.paper.addEventListener("pointercancel", drop, { once: true });
    }
    // An arrow is thin: a distance of up to three pixels counts as a hit.
    under(event) {
      for (const [dx, dy] of [[0, 0], [0, 3], [0, -3], [3, 0], [-3, 0]]) {
        const element = document.elementFromPoint(event.clientX + dx, event.clientY + dy);
        const item = this.by_element.get(element);
        if (item) return item;
      }
      return undefined;
    }
    point(event) {
      if (event.buttons !== 0) { tip.hidden = true; return; }
      const item = this.under(event);
      if (item !== this.chosen) this.choose(item);
      tip.hidden = !item;
      if (!item) return;
      tip.textContent = this.words(item);
      tip.style.left = `${Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8)}px`;
      tip.style.top = `${
          event.clientY + 18 + tip.offsetHeight > innerHeight ? event.clientY - tip.offsetHeight - 12 :
                                                                event.clientY + 18}px`;
    }
    leave() {
      tip.hidden = true;
      this.choose(undefined);
    }
  }

  const data = JSON.parse(document.getElementById("timings")?.textContent ?? "[]");
  const windows_of = (box) => {
    const one = data[box.dataset.windows];
    return one && TimingWindows.possible ? new TimingWindows(one) : undefined;
  };
  for (const figure of document.querySelectorAll("figure.timing")) {
    const boxes = [...figure.querySelectorAll(".diagram")];
    const one_of = (chosen) => boxes.forEach((box, i) => { box.hidden = i !== chosen; });
    if (boxes.length > 1) {
      const select = make("select");
      select.setAttribute("aria-label", "Drive of the timing diagram");
      boxes.forEach((box, i) => select.append(new Option(box.dataset.label, i)));
      select.addEventListener("change", () => one_of(Number(select.value)));
      boxes[0].before(make("div", { className: "bar" }, select));
    }
    for (const box of boxes) new Diagram(box, windows_of(box));
    if (boxes.length > 1) one_of(0);
  }
})();
