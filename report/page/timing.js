// Timing diagrams: what stands in time is put anew for the window that is seen, so that texts, arrow heads and line
// widths stay as they are. What the attributes mean: report/timing_tags.h. The window stands in data-from and data-to.
"use strict";
(() => {
  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };
  const SVG = "http://www.w3.org/2000/svg";
  const LEAST = 0.05;   // ms that are seen at least
  const ms = (t) => (Math.round(t * 1e4) / 1e4).toString();
  const lasting = (t) => (t < 1 ? `${Math.round(t * 1e4) / 10} µs` : `${Math.round(t * 1e3) / 1e3} ms`);
  const number = (element, name) => Number(element.getAttribute(name));

  const tip = make("div", { className: "tip", hidden: true });
  document.body.append(tip);

  class Diagram {
    constructor(box) {
      this.box = box;
      this.paper = box.querySelector(".paper");
      this.svg = box.querySelector("svg");
      const plot = this.svg.querySelector("rect.plot");
      if (!plot) return;   // a picture that says why it shows nothing
      this.plot = plot;
      this.svg.querySelector("title")?.remove();
      [this.left, this.top, this.width, this.height] = ["x", "y", "width", "height"].map((name) => number(plot, name));
      [this.first, this.last] = [Number(plot.dataset.a), Number(plot.dataset.b)];
      [this.from, this.to] = [this.first, this.last];
      this.items =
          [...this.svg.querySelectorAll("[data-a]")].filter((one) => one !== plot).map((one) => this.item(one));
      this.things = this.items.filter((item) => item.title).sort((p, q) => p.a - q.a || p.y - q.y);
      this.by_element = new Map(this.things.map((item) => [item.element, item]));
      this.frame();
      this.controls();
      new ResizeObserver(() => this.fit()).observe(this.paper);
    }

    // What is known of an element before it is moved for the first time.
    item(element) {
      const title = element.querySelector("title");
      const { a, b, id, since, label, beyond } = element.dataset;
      const item = {
        element,
        a: Number(a),
        b: b === undefined ? undefined : Number(b),
        id,
        beyond: beyond !== undefined,
        title: title?.textContent,
        since: since === undefined ? undefined : Number(since),
        label: label === undefined ? undefined : Number(label)
      };
      title?.remove();
      item.origin = this.x(item.a);
      if (element.tagName === "text") {
        item.kind = "text";
        item.x = number(element, "x");
        item.y = number(element, "y");
        item.free = element.parentNode.classList.contains("grid");
      } else if (element.tagName === "rect" && item.b !== undefined) {
        item.kind = "box";
        item.y = number(element, "y");
      } else if (element.tagName === "path" && item.b !== undefined) {
        item.kind = "line";
        const ends = element.getAttribute("d").match(/^M\S+ ([\d.-]+)L\S+ ([\d.-]+)$/);
        [item.y, item.y2] = [Number(ends[1]), Number(ends[2])];
      } else {
        item.kind = "mark";
        item.y = 0;
      }
      return item;
    }

    // What is as wide as the plot.
    frame() {
      const right = this.left + this.width;
      this.lines =
          [...this.svg.querySelectorAll("path:not([data-a])")]
              .filter((path) => {
                const ends = path.getAttribute("d").match(/^M\S+ (\S+)L(\S+) (\S+)$/);
                return ends && ends[1] === ends[3] && Math.abs(Number(ends[2]) - right) < 0.02;
              })
              .map(
                  (path) => (
                      {path, begin: path.getAttribute("d").split("L")[0], y: path.getAttribute("d").split(" ").pop()}));
      this.clips = [...this.svg.querySelectorAll("clipPath rect")];
      this.ground = this.svg.querySelector("svg > rect");
      this.axis = this.svg.querySelector("g.time");
      this.least = this.svg.viewBox.baseVal.width;
      this.tall = this.svg.viewBox.baseVal.height;
    }

    controls() {
      this.range = make("span", { className: "range" });
      const bar = make("div", { className: "bar" });
      const button = (text, label, act) => {
        const one = make("button", { type: "button", textContent: text, title: label });
        one.setAttribute("aria-label", label);
        one.addEventListener("click", act);
        bar.append(one);
      };
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
          "Drag to move, <kbd>Ctrl</kbd> or <kbd>Shift</kbd> and the wheel to zoom, or, with the focus here: " +
          "<kbd>+</kbd> <kbd>−</kbd> zoom, <kbd>←</kbd> <kbd>→</kbd> move, <kbd>0</kbd> all, " +
          "<kbd>,</kbd> <kbd>.</kbd> from thing to thing" +
          "<span class=\"scrolls\">, <kbd>Shift</kbd> with <kbd>←</kbd> <kbd>→</kbd> to what is beside it</span>.";
      this.paper.before(bar);
      this.paper.after(this.told, this.keys);
      this.paper.tabIndex = 0;
      this.paper.setAttribute("role", "group");
      this.paper.setAttribute(
          "aria-label",
          `Timing diagram, ${this.box.dataset.label}. Plus and minus zoom, arrow keys move, ` +
              "0 shows all, comma and full stop go from thing to thing.");
      this.paper.addEventListener("keydown", (event) => this.key(event));
      this.paper.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
      this.paper.addEventListener("dblclick", () => this.show(this.first, this.last));
      this.paper.addEventListener("pointerdown", (event) => this.grab(event));
      this.paper.addEventListener("pointermove", (event) => this.point(event));
      this.paper.addEventListener("pointerleave", () => this.leave());
    }

    x(t) { return this.left + (t - this.from) / (this.to - this.from) * this.width; }
    t(client) {
      const px = (client - this.svg.getBoundingClientRect().left) / this.svg.getBoundingClientRect().width *
          this.svg.viewBox.baseVal.width;
      return this.from + (px - this.left) / this.width * (this.to - this.from);
    }

    fit() {
      const room = this.paper.clientWidth;
      if (room < 50) return;
      const wide = Math.max(room, this.least);   // what is wider than its room is scrolled to
      this.paper.classList.toggle("wider", wide > room);
      this.svg.setAttribute("width", wide);
      this.svg.setAttribute("viewBox", `0 0 ${wide} ${this.tall}`);
      this.ground.setAttribute("width", wide);
      this.width = wide - this.left - 24;
      this.plot.setAttribute("width", this.width);
      for (const clip of this.clips) clip.setAttribute("width", this.width);
      for (const { path, begin, y } of this.lines) path.setAttribute("d", `${begin}L${this.left + this.width} ${y}`);
      this.draw();
    }

    show(from, to) {
      const span = Math.min(Math.max(to - from, LEAST), this.last - this.first);
      from = Math.max(this.first, Math.min(from, this.last - span));
      [this.from, this.to] = [from, from + span];
      this.pending ??= requestAnimationFrame(() => { this.pending = undefined; this.draw(); });
      this.box.dataset.from = this.from;
      this.box.dataset.to = this.to;
    }
    zoom(factor, at = (this.from + this.to) / 2) {
      const span = Math.max(LEAST, (this.to - this.from) * factor), part = (at - this.from) / (this.to - this.from);
      this.show(at - part * span, at - part * span + span);
    }
    move(part) {
      const by = part * (this.to - this.from);
      this.show(this.from + by, this.to + by);
    }

    draw() {
      const right = this.left + this.width, rows = new Map();
      for (const item of this.items) {
        const { element, a, b } = item;
        let seen = a < this.to && (b ?? a) >= this.from;
        if (seen && item.kind === "box") {
          const x = Math.max(this.x(a), this.left - 4), end = Math.min(this.x(b), right + 4);
          element.setAttribute("x", x.toFixed(2));
          element.setAttribute("width", Math.max(1, end - x).toFixed(2));
        } else if (seen && item.kind === "line") {
          element.setAttribute("d", `M${this.x(a).toFixed(2)} ${item.y}L${this.x(b).toFixed(2)} ${item.y2}`);
        } else if (seen && item.kind === "mark") {
          element.setAttribute("transform", `translate(${(this.x(a) - item.origin).toFixed(2)} 0)`);
        } else if (seen) {
          seen = this.place(item, right, rows);
        }
        if (seen !== item.seen) {
          item.seen = seen;
          if (seen) element.removeAttribute("display"); else element.setAttribute("display", "none");
        }
      }
      this.ticks();
      this.box.dataset.from = this.from;
      this.box.dataset.to = this.to;
      this.range.textContent =
          `${this.box.dataset.label}: ${ms(this.from)} to ${ms(this.to)} ms, ${lasting(this.to - this.from)}`;
    }

    // A text: in its box if that is wide enough, or beside what it names if its neighbours leave room; a cycle's number
    // is above it.
    place(item, right, rows) {
      let x, begin;
      if (item.b !== undefined) {
        const low = Math.max(this.x(item.a), this.left), high = Math.min(this.x(item.b), right);
        if (!item.free && high - low < item.label + 5) return false;
        x = (low + high) / 2;
        begin = x - item.label / 2;
        if (begin < this.left || begin + item.label > right) return false;
      } else {
        x = begin = this.x(item.a) + item.x - item.origin;
        if (begin < this.left || begin + item.label > right) return false;
      }
      if (begin < (rows.get(item.y) ?? -Infinity)) return false;
      rows.set(item.y, begin + item.label + 3);
      item.element.setAttribute("x", x.toFixed(2));
      return true;
    }

    ticks() {
      const rough = (this.to - this.from) / Math.max(2, this.width / 110), power = 10 ** Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= rough);
      const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9)), bottom = this.top + this.height;
      const draw = (tag, attributes, text) => {
        const element = document.createElementNS(SVG, tag);
        for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
        if (text !== undefined) element.textContent = text;
        return element;
      };
      const marks = [];
      for (let n = Math.ceil(this.from / step - 1e-9); n * step <= this.to + step * 1e-9; ++n) {
        const x = this.x(n * step);
        marks.push(
            draw("path", {d: `M${x} ${bottom}V${bottom + 4}`, stroke: "#000", "stroke-width": 0.8}),
            draw(
                "text", {x, y: bottom + 16, "font-size": 10.5, "text-anchor": "middle"}, (n * step).toFixed(decimals)));
      }
      marks.push(draw(
          "text", {x: this.left + this.width / 2, y: bottom + 33, "font-size": 11.5, "text-anchor": "middle"},
          "true time [ms]"));
      this.axis.replaceChildren(...marks);
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
    // Everything of one list stands out with it.
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
        ",": () => this.step(-1), ".": () => this.step(1), "Escape": () => this.choose(undefined),
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
      if (event.clientY > box.top + this.paper.clientTop + this.paper.clientHeight) return;   // its scroll bar
      if (event.pointerType === "touch" && this.paper.classList.contains("wider")) return;    // scrolls
      const held = this.t(event.clientX);
      this.paper.classList.add("dragging");
      this.paper.setPointerCapture(event.pointerId);
      const drag = (moved) => {
        const by = held - this.t(moved.clientX);
        this.show(this.from + by, this.to + by);
      };
      const drop = () => {
        this.paper.classList.remove("dragging");
        this.paper.removeEventListener("pointermove", drag);
      };
      this.paper.addEventListener("pointermove", drag);
      this.paper.addEventListener("pointerup", drop, { once: true });
      this.paper.addEventListener("pointercancel", drop, { once: true });
    }
    // An arrow is thin: what is three pixels away is meant, too.
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

  for (const figure of document.querySelectorAll("figure.timing")) {
    const boxes = [...figure.querySelectorAll(".diagram")];
    const one_of = (chosen) => boxes.forEach((box, i) => { box.hidden = i !== chosen; });
    if (boxes.length > 1) {
      const select = make("select");
      select.setAttribute("aria-label", "Whose timing diagram");
      boxes.forEach((box, i) => select.append(new Option(box.dataset.label, i)));
      select.addEventListener("change", () => one_of(Number(select.value)));
      boxes[0].before(make("div", { className: "bar" }, select));
    }
    for (const box of boxes) new Diagram(box);
    if (boxes.length > 1) one_of(0);
  }
})();
