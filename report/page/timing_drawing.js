// Places the timed parts of a timing diagram anew for the visible time window, so that texts, arrow heads and
// line widths keep their size. report/timing/tags.h explains the attributes; data-from and data-to hold the
// time window.
"use strict";
const TimingDrawing = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const LEAST = 0.05;   // the shortest visible time, in ms
  const number = (element, name) => Number(element.getAttribute(name));

  return class {
    // Takes an element div.diagram.
    constructor(box) {
      this.box = box;
      this.paper = box.querySelector(".paper");
      this.take();
    }
    // Reads the box's picture, and shows all of it. Without a plot, the picture says why it is empty.
    take() {
      this.svg = this.box.querySelector("svg");
      this.plot = this.svg.querySelector("rect.plot");
      if (!this.plot) return;
      this.svg.querySelector("title")?.remove();
      [this.left, this.top, this.width, this.height] =
          ["x", "y", "width", "height"].map((name) => number(this.plot, name));
      [this.first, this.last] = [Number(this.plot.dataset.a), Number(this.plot.dataset.b)];
      [this.from, this.to] = [this.first, this.last];
      this.items =
          [...this.svg.querySelectorAll("[data-a]")].filter((one) => one !== this.plot).map((one) => this.item(one));
      this.frame();
    }
    // Called after each change of the time window.
    drawn() {}

    // Reads an element's attributes before its first move.
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

    // Collects the lines that are as wide as the plot.
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

    x(t) { return this.left + (t - this.from) / (this.to - this.from) * this.width; }
    t(client) {
      const px = (client - this.svg.getBoundingClientRect().left) / this.svg.getBoundingClientRect().width *
          this.svg.viewBox.baseVal.width;
      return this.from + (px - this.left) / this.width * (this.to - this.from);
    }

    fit() {
      const room = this.paper.clientWidth;
      if (room < 50 || !this.plot) return;
      const wide = Math.max(room, this.least);   // a drawing wider than its room scrolls
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
      this.drawn();
    }

    // Places a text in its box if the box is wide enough, or beside the thing it names if the neighbours
    // leave room. A cycle's number stands above its cycle.
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
  };
})();
