// The page's plots, drawn by uPlot. Dragging, buttons, keys (with the focus) and the wheel (with Ctrl or
// Shift) zoom. A click chooses the page's instant. data-from and data-to hold the visible range.
"use strict";
(() => {
  const DASHES = [[], [7, 4], [2, 3], [9, 3, 2, 3]];
  const dash_of = (curve) => DASHES[((curve.colour >> 3) + curve.colour) % 4];   // 8 colours, 4 dashes: 32 curves
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const { make, buttons } = Elements;
  const figures = (value) => (value == null ? "–" : Number(value.toPrecision(4)).toString());

  // Returns the number of decimals of an axis' step: 2.5 has one.
  const decimals = (step) => {
    let d = 0;
    while (d < 12 && Math.abs(step * 10 ** d - Math.round(step * 10 ** d)) > 1e-6 * step * 10 ** d) ++d;
    return d;
  };
  const labels = (u, splits, axis, space, step) => splits.map(
      (value) => value == null                   ? "" :
          u.scales.x.distr === 3 && axis === 0 ? figures(value) :
                                                 value.toFixed(decimals(step)));

  // Returns the index at which a curve is nearest to x.
  const nearest = (curve, x) => {
    let low = 0, high = curve.x.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (curve.x[middle] <= x) low = middle; else high = middle;
    }
    return x - curve.x[low] <= curve.x[high] - x ? low : high;
  };

  class Plot {
    constructor(figure, spec) {
      this.figure = figure;
      this.spec = spec;
      this.view = spec.views[0];
      this.hidden = new Set();
      this.timed = spec.x === "true time [s]";
      this.line = make("div", { className: "instant", hidden: true });
      if (this.timed) Instant.on((at) => this.mark(at));
      figure.querySelector("noscript")?.remove();
      this.range = make("span", { className: "range" });
      const bar = make("div", { className: "bar" });
      if (spec.views.length > 1) {
        const select = make("select");
        select.setAttribute("aria-label", `${spec.heading}: choice of view`);
        spec.views.forEach((view, i) => select.append(new Option(view.label, i)));
        select.addEventListener("change", () => {
          this.view = spec.views[select.value];
          this.hidden.clear();
          this.draw();
        });
        bar.append(select);
      }
      const button = buttons(bar);
      bar.append(this.range, make("span", { className: "grow" }));
      button("+", "Zoom in", () => this.zoom(0.5));
      button("−", "Zoom out", () => this.zoom(2));
      button("All", "Show all", () => this.reset());
      this.canvas = make("div", { className: "canvas", tabIndex: 0 });
      this.canvas.setAttribute("role", "group");
      this.canvas.setAttribute("aria-label", `${spec.heading}. Plus and minus zoom, arrow keys move, 0 shows all, ` +
        "comma and full stop go from point to point.");
      this.legend = make("div", { className: "legend" });
      this.heard = make("p", { className: "heard" });
      this.heard.setAttribute("aria-live", "polite");
      figure.append(bar, this.canvas, this.legend, this.heard);
      this.canvas.addEventListener("keydown", (event) => this.key(event));
      this.canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
      // Inside closed details the width is 0; drawing waits for a width.
      new ResizeObserver(() => this.fit()).observe(this.canvas);
    }

    fit(width = this.canvas.clientWidth) {
      if (width < 50) return;
      if (!this.uplot) this.draw(width);
      else if (Math.abs(this.uplot.width - width) > 1) this.uplot.setSize({ width, height: this.uplot.height });
    }

    get all() {
      let low = Infinity, high = -Infinity;
      for (const curve of this.view.curves)
        for (const x of curve.x) { low = Math.min(low, x); high = Math.max(high, x); }
      if (low < high) return [low, high];
      if (low > high) return this.spec.log ? [1, 10] : [0, 1];   // without points
      return this.spec.log ? [low / 1.5, low * 1.5] : [low - 0.5, low + 0.5];
    }
    get seen() { return [this.uplot.scales.x.min, this.uplot.scales.x.max]; }

    show(from, to) {
      const [low, high] = this.all;
      const least = this.spec.log ? 1e-12 : (high - low) * 1e-6;
      from = Math.max(from, low);
      to = Math.min(to, high);
      if (to - from > least) this.uplot.setScale("x", { min: from, max: to });
    }
    reset() { this.show(...this.all); }
    // Converts x to the axis' own scale: on a logarithmic axis, its logarithm.
    warp(x) { return this.spec.log ? Math.log(x) : x; }
    unwarp(x) { return this.spec.log ? Math.exp(x) : x; }
    zoom(factor, at) {
      const [from, to] = this.seen.map((x) => this.warp(x));
      const centre = at === undefined ? (from + to) / 2 : this.warp(at);
      this.show(this.unwarp(centre + (from - centre) * factor), this.unwarp(centre + (to - centre) * factor));
    }
    move(part) {
      const [low, high] = this.all.map((x) => this.warp(x)), [from, to] = this.seen.map((x) => this.warp(x));
      const by = Math.max(low - from, Math.min(high - to, part * (to - from)));
      this.show(this.unwarp(from + by), this.unwarp(to + by));
    }
    step(by) {
      const curve = this.view.curves.find((_, i) => !this.hidden.has(i));
      if (!curve) return;
      const [from, to] = this.seen;
      let at = this.at === undefined ? nearest(curve, by > 0 ? from : to) : nearest(curve, this.at) + by;
      at = Math.max(0, Math.min(curve.x.length - 1, at));
      const x = curve.x[at];
      if (x < from || x > to) return;
      this.uplot.setCursor({ left: this.uplot.valToPos(x, "x"), top: this.uplot.valToPos(curve.y[at] ?? 0, "y") });
      if (this.timed) Instant.set(x, this);
      this.tell(x);
      const value = (i) => this.legend.children[i].querySelector(".value").textContent;
      const values = this.view.curves.map((one, i) => this.hidden.has(i) ? "" : `${one.label}: ${value(i)}`);
      this.heard.textContent = values.filter((text) => text !== "").join("; ");
    }
    key(event) {
      if (event.ctrlKey || event.altKey || event.metaKey) return;
      const act = {
        "+": () => this.zoom(0.5), "=": () => this.zoom(0.5), "-": () => this.zoom(2), "_": () => this.zoom(2),
        "0": () => this.reset(), "Home": () => this.reset(), "Escape": () => this.reset(),
        "ArrowLeft": () => this.move(-0.2), "ArrowRight": () => this.move(0.2),
        ",": () => this.step(-1), ".": () => this.step(1),
      }[event.key];
      if (!act || !this.uplot) return;
      event.preventDefault();
      act();
    }
    wheel(event) {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const turn = event.deltaY || event.deltaX;
      const left = event.clientX - this.uplot.over.getBoundingClientRect().left;
      this.zoom(turn > 0 ? 1.25 : 0.8, this.uplot.posToVal(left, "x"));
    }

    // Shows the page's instant.
    mark(at) {
      if (!this.uplot || !this.timed) return;
      const { min, max } = this.uplot.scales.x;
      this.line.hidden = at === undefined || !(at >= min && at <= max);
      if (!this.line.hidden) this.line.style.transform = `translateX(${this.uplot.valToPos(at, "x")}px)`;
    }
    // A click chooses the page's instant; a drag zooms.
    choose_by(over) {
      let down;
      over.addEventListener("mousedown", (event) => { down = event.clientX; });
      over.addEventListener("mouseup", (event) => {
        if (event.button === 0 && down !== undefined && Math.abs(event.clientX - down) < 3)
          Instant.set(this.uplot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"), this);
        down = undefined;
      });
    }

    // Shows the values of all curves at the cursor.
    tell(x) {
      this.at = x;
      this.view.curves.forEach((curve, i) => {
        const value = this.legend.children[i]?.querySelector(".value");
        if (!value) return;
        if (x === undefined) { value.textContent = ""; return; }
        const n = nearest(curve, x);
        const wide =
            curve.low && curve.y[n] != null && curve.high[n] != null ? ` ± ${figures(curve.high[n] - curve.y[n])}` : "";
        value.textContent = `${figures(curve.y[n])}${wide} at ${figures(curve.x[n])}`;
      });
    }

    draw(width = this.uplot?.width ?? this.canvas.clientWidth) {
      this.uplot?.destroy();
      const ink = colour("--soft"), grid = colour("--grid"), steps = this.spec.kind === "steps";
      const series = [{}], tables = [], bands = [];
      this.shown = [];
      this.view.curves.forEach((curve, i) => {
        const stroke = colour(`--c${curve.colour % 8}`), show = !this.hidden.has(i);
        this.shown.push(series.length);
        const few = curve.x.length <= 60;
        series.push({
          label: curve.label, stroke, show, width: 1.8, dash: dash_of(curve),
          fill: steps ? stroke + "22" : undefined, paths: steps ? uPlot.paths.stepped({ align: 1 }) : undefined,
          points: { show: this.spec.kind === "points" || (few && !steps), size: 6, stroke, fill: colour("--page") },
        });
        const table = [curve.x, curve.y];
        if (curve.low) {
          const edge = { stroke: "transparent", show, points: { show: false } };
          bands.push({ series: [series.length + 1, series.length], fill: stroke + "2e" });
          series.push(edge, edge);
          table.push(curve.low, curve.high);
        }
        tables.push(table);
      });
      const axis = { stroke: ink, values: labels, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 },
        font: "12px system-ui, sans-serif", labelFont: "13px system-ui, sans-serif" };
      this.uplot = new uPlot({
        width, height: 320, series, bands,
        legend: { show: false },
        cursor: { drag: { x: true, y: false }, points: { size: 7 } },
        scales: {
          x: {
            time: false, distr: this.spec.log ? 3 : 1, range: (u, low, high) => low < high ? [low, high] : this.all,
          },
          y: { range: (u, low, high) => {
            if (low == null) return [0, 1];
            const margin = (high - low) * 0.06 || Math.abs(high) * 0.1 || 1;
            const flat = low > 0.6 * high;
            return [low >= 0 && !flat ? 0 : low - margin, high <= 0 && this.spec.zero ? 0 : high + margin];
          } },
        },
        axes: [{ ...axis, label: this.spec.x }, { ...axis, label: this.view.y, size: 68 }],
        hooks: {
          setScale: [(u, key) => {
            if (key !== "x") return;
            const { min, max } = u.scales.x;
            this.figure.dataset.from = min;
            this.figure.dataset.to = max;
            this.range.textContent = `${this.spec.x}: ${figures(min)} to ${figures(max)}`;
            this.mark(Instant.at);
          }],
          setCursor: [(u) => this.tell(u.cursor.left >= 0 ? u.posToVal(u.cursor.left, "x") : undefined)],
          drawAxes: [(u) => {
            if (!this.spec.zero || !(u.scales.y.min < 0 && u.scales.y.max > 0)) return;
            const y = u.valToPos(0, "y", true);
            u.ctx.save();
            u.ctx.strokeStyle = ink;
            u.ctx.lineWidth = devicePixelRatio;
            u.ctx.beginPath();
            u.ctx.moveTo(u.bbox.left, y);
            u.ctx.lineTo(u.bbox.left + u.bbox.width, y);
            u.ctx.stroke();
            u.ctx.restore();
          }],
        },
      }, uPlot.join(tables), this.canvas);
      if (this.timed) {
        this.uplot.over.append(this.line);
        this.choose_by(this.uplot.over);
        this.mark(Instant.at);
      }
      if (this.uplot.data[0].length === 1) this.reset();   // uPlot picks another range around a single point
      this.key_to_curves();
    }

    key_to_curves() {
      this.legend.replaceChildren(...this.view.curves.map((curve, i) => {
        const one = make("button", { type: "button" });
        const swatch = document.createElementNS("http://www.w3.org/2000/svg", "svg");
        swatch.setAttribute("width", 26);
        swatch.setAttribute("height", 8);
        const line = document.createElementNS("http://www.w3.org/2000/svg", "path");
        line.setAttribute("d", "M0 4H26");
        line.setAttribute("stroke", colour(`--c${curve.colour % 8}`));
        line.setAttribute("stroke-width", 2.4);
        line.setAttribute("stroke-dasharray", dash_of(curve).join(" "));
        swatch.append(line);
        one.append(swatch, make("span", { textContent: curve.label }), make("span", { className: "value" }));
        one.setAttribute("aria-pressed", !this.hidden.has(i));
        one.addEventListener("click", () => {
          if (!this.hidden.delete(i)) this.hidden.add(i);
          const show = !this.hidden.has(i), first = this.shown[i];
          for (let s = first; s < first + (curve.low ? 3 : 1); ++s) this.uplot.setSeries(s, { show });
          one.setAttribute("aria-pressed", show);
        });
        return one;
      }));
    }
  }

  const specs = JSON.parse(document.getElementById("plots").textContent);
  const plots =
      [...document.querySelectorAll("figure[data-plot]")].map((figure) => new Plot(figure, specs[figure.dataset.plot]));
  const redraw = (width) => {
    for (const plot of plots)
      if (plot.uplot) {
        const [from, to] = plot.seen;
        plot.draw(width ?? plot.uplot.width);
        plot.show(from, to);
      }
  };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redraw());
  matchMedia("print").addEventListener("change", (event) => redraw(event.matches ? 660 : undefined));
  addEventListener("afterprint", () => { for (const plot of plots) plot.fit(); });
})();
