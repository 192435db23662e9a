// Draws a scene's instant on a canvas. All objects of a kind are one path, so that a thousand take a few milliseconds.
"use strict";
const SceneDrawing = (() => {
  const NEAR = 14;   // px per metre at which all are named, and all observations have their markers
  const SMALLEST = 4;   // px: smaller things are dots
  const DOT = { width: 0, dash: "", opacity: 1, covers: 1 }, GRID = { ...DOT, width: 1, covers: 0 };   // as looks of the data
  const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  // Sensors' colours are those of all pictures; on a dark page they are lighter.
  const lighter = (colour) => {
    const parts = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
    return `rgb(${parts.map((part) => Math.round(part + (255 - part) * 0.4)).join(" ")})`;
  };

  // Adds lines from point to point, each [x, y] in units of r about the place, y down.
  const polygon = (c, x, y, r, points, closed = true) => {
    points.forEach(([u, v], i) => i ? c.lineTo(x + r * u, y + r * v) : c.moveTo(x + r * u, y + r * v));
    if (closed) c.closePath();
  };
  const upright = (points) => points.map(([x, y]) => [x, -y]);

  return class {
    // `view` is {x, y, scale}: the centre in metres, and pixels per metre. `hidden` has the names of hidden layers.
    constructor(canvas, data, view, hidden) {
      Object.assign(this, { canvas, data, view, hidden, c: canvas.getContext("2d"), rules: data.rules });
      const points = this.rules.ellipse_points, angle = (k) => 2 * Math.PI * k / points;
      this.round = [...Array(points).keys()].map((k) => [Math.cos(angle(k)), Math.sin(angle(k))]);
      this.colours();
    }
    colours() {
      this.ink = variable("--ink");
      this.soft = variable("--soft");
      this.grid = variable("--grid");
      this.page = variable("--page");
      this.alarm = variable("--alarm");
      this.own = variable(`--c${this.data.colour % 8}`);
      const dark = matchMedia("(prefers-color-scheme: dark)").matches && !matchMedia("print").matches;
      this.sensors = this.data.sensors.map((sensor) => dark ? lighter(sensor.colour) : sensor.colour);
    }
    fit(width, height) {
      this.width = width;
      this.height = height;
      this.canvas.width = Math.round(width * devicePixelRatio);
      this.canvas.height = Math.round(height * devicePixelRatio);
      this.canvas.style.height = `${height}px`;
    }
    px(x) { return this.width / 2 + (x - this.view.x) * this.view.scale; }
    py(y) { return this.height / 2 - (y - this.view.y) * this.view.scale; }
    to_x(px) { return this.view.x + (px - this.width / 2) / this.view.scale; }
    to_y(py) { return this.view.y - (py - this.height / 2) / this.view.scale; }

    // Draws one path: `lines(c)` adds to it.
    path(lines, { width, dash, opacity, covers }, colour) {
      const { c } = this;
      Object.assign(c, { fillStyle: colour, strokeStyle: colour, lineWidth: width || 1 });
      c.setLineDash(dash.match(/[\d.]+/g) ?? []);
      c.beginPath();
      lines(c);
      if (covers > 0) { c.globalAlpha = covers; c.fill(); }
      if (width > 0) { c.globalAlpha = opacity; c.stroke(); }
      c.globalAlpha = 1;
    }
    // Returns whether a thing of so many metres is seen as more than a dot.
    large(metres) { return metres * this.view.scale >= SMALLEST; }
    box(one) {
      const { c } = this, { scale } = this.view, x = this.px(one.x), y = this.py(one.y);
      if (!this.large(one.length)) { c.rect(x - 1, y - 1, 2, 2); return; }
      const a = Math.cos(one.heading) * scale / 2, b = Math.sin(one.heading) * scale / 2;
      const [al, bl, aw, bw] = [a * one.length, b * one.length, a * one.width, b * one.width];
      c.moveTo(x + al - bw, y - bl - aw);
      c.lineTo(x - al - bw, y + bl - aw);
      c.lineTo(x - al + bw, y + bl + aw);
      c.lineTo(x + al + bw, y - bl + aw);
      c.closePath();
    }
    ellipse(one) {
      const { c } = this, { sigmas } = this.rules;
      if (!this.large(sigmas * Math.max(one.sigma_x, one.sigma_y))) return;
      const rest = Math.sqrt(Math.max(0, 1 - one.correlation ** 2));
      this.round.forEach(([a, b], i) => {
        const x = this.px(one.x + sigmas * one.sigma_x * a);
        const y = this.py(one.y + sigmas * one.sigma_y * (one.correlation * a + rest * b));
        if (i) c.lineTo(x, y); else c.moveTo(x, y);
      });
      c.closePath();
    }
    observations(t) {
      const { rules } = this, lists = this.data.sensors.map((sensor, s) => {
        const places = [];
        if (!this.hidden.has(sensor.name))
          this.data.observations(s, t, (x, y) => places.push([this.px(x), this.py(y)]));
        return places;
      });
      const count = lists.reduce((sum, places) => sum + places.length, 0), many = count > rules.most_large;
      lists.forEach((places, s) => {
        const { lines, closed } = this.data.sensors[s], r = (many ? rules.small : rules.large) / 2;
        if (many && this.view.scale < NEAR)
          this.path((to) => { for (const [x, y] of places) to.rect(x - 1, y - 1, 2, 2); }, DOT, this.sensors[s]);
        else
          this.path((to) => {
            for (const [x, y] of places) for (const line of lines) polygon(to, x, y, r, line, closed);
          }, rules.looks.observation, this.sensors[s]);
      });
      return count;
    }

    draw(t) {
      const { c, data, hidden, rules: { looks } } = this, begin = performance.now();
      c.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
      c.clearRect(0, 0, this.width, this.height);
      this.ground();
      const all = { objects: data.objects(t), tracks: data.tracks(t), warnings: data.warnings(t) };
      const objects = hidden.has("truth") ? [] : all.objects, tracks = hidden.has("tracks") ? [] : all.tracks;
      const coasting = tracks.filter((one) => one.coasting), seen = tracks.filter((one) => !one.coasting);
      const warnings = hidden.has("warnings") ? new Map() : all.warnings;
      const warned = tracks.filter((one) => warnings.has(one.id));
      this.path(() => objects.forEach((one) => this.box(one)), looks.truth, this.soft);
      if (!hidden.has("trails")) this.path(() => this.trails(tracks, t), looks.trail, this.own);
      if (!hidden.has("ellipses")) this.path(() => tracks.forEach((one) => this.ellipse(one)), looks.ellipse, this.own);
      this.path(() => seen.forEach((one) => this.box(one)), looks.track, this.own);
      this.path(() => coasting.forEach((one) => this.box(one)), looks.coasting, this.own);
      this.path(() => tracks.forEach((one) => this.velocity(one)), looks.velocity, this.own);
      const observations = this.observations(t);
      this.path((to) => polygon(to, this.px(0), this.py(0), 1, upright(this.rules.vehicle)), looks.vehicle, this.ink);
      this.path(() => warned.forEach((one) => this.box(one)), looks.warning, this.alarm);
      this.names(tracks, warnings);
      this.seen = { objects, tracks };
      Object.assign(this.canvas.dataset, {
        truth: all.objects.length, tracks: all.tracks.length, observations,
        warnings: all.tracks.filter((one) => all.warnings.has(one.id)).length,
        drawn: Number(this.canvas.dataset.drawn ?? 0) + 1, took: (performance.now() - begin).toFixed(2),
      });
    }

    // Returns the drawn tracks whose places are on the canvas; objects, without any track.
    in_sight() {
      const here = (one) => this.inside(this.px(one.x), this.py(one.y), 0, 0);
      const { tracks, objects } = this.seen ?? { tracks: [], objects: [] }, near = tracks.filter(here);
      return near.length > 0 ? near : objects.filter(here);
    }
    // Returns whether a rectangle, of so many pixels to each side of its centre, is on the canvas.
    inside(x, y, across, up) {
      return x >= across && y >= up && x + across <= this.width && y + up <= this.height;
    }

    // A thousand trails would be too many lines: then they have fewer points.
    trails(tracks, t) {
      const { c } = this, every = Math.max(1, Math.ceil(tracks.length / 250));
      for (const track of tracks) {
        let n = 0;
        this.data.trail(track, t, (x, y) => {
          if (n++ % every === 0) c[n === 1 ? "moveTo" : "lineTo"](this.px(x), this.py(y));
        });
      }
    }
    // Points where the track is after the rules' seconds `ahead`, as the vehicle sees it.
    velocity(one) {
      const { c, rules } = this, after = this.data.moved_on(one, rules.ahead);
      const way = Math.hypot(after.x - one.x, after.y - one.y);
      if (way < rules.least_way || !this.large(way)) return;
      c.moveTo(this.px(one.x), this.py(one.y));
      c.lineTo(this.px(after.x), this.py(after.y));
    }
    text(words, x, y, colour) {
      const { c } = this;
      c.lineWidth = 3;
      c.strokeStyle = this.page;
      c.setLineDash([]);
      c.strokeText(words, x, y);
      c.fillStyle = colour;
      c.fillText(words, x, y);
    }
    // Returns the rectangle about a track's box, in pixels: its centre, and what it has to each side of it.
    around(one) {
      const { scale } = this.view, a = Math.abs(Math.cos(one.heading)), b = Math.abs(Math.sin(one.heading));
      return { x: this.px(one.x), y: this.py(one.y), across: (one.length * a + one.width * b) * scale / 2,
        up: (one.length * b + one.width * a) * scale / 2 };
    }
    // Ids stand above, beside or below their boxes, and cover neither a box nor each other: one without room is left
    // out. A warning is always written.
    names(tracks, warnings) {
      const all = tracks.length <= this.rules.most_named || this.view.scale > NEAR, { c, width, height } = this;
      const taken = tracks.map((one) => this.around(one));
      const free = (r) => this.inside(r.x, r.y, r.across, r.up) && !taken.some((other) =>
        Math.abs(r.x - other.x) < r.across + other.across && Math.abs(r.y - other.y) < r.up + other.up);
      const within = (value, margin, size) => Math.max(margin, Math.min(value, size - margin));
      const name = (box, words, colour, always) => {
        if (!this.inside(box.x, box.y, 0, 0)) return;
        const across = c.measureText(words).width / 2 + 2, up = 7;
        const x = within(box.x, across, width), beside = box.across + across + 2, over = box.up + up + 2;
        const places = [[x, box.y - over], [box.x + beside, box.y], [box.x - beside, box.y], [x, box.y + over]]
            .map(([px, py]) => ({ x: px, y: py, across, up }));
        const place = places.find(free) ?? (always && { ...places[0], y: within(places[0].y, up, height) });
        if (!place) return;
        taken.push(place);
        this.text(words, place.x, place.y + 4, colour);
      };
      c.font = "600 12px system-ui, sans-serif";
      c.textAlign = "center";
      const boxes = tracks.map((one, i) => [one, taken[i]]), warned = ([one]) => warnings.has(one.id);
      for (const [one, box] of boxes.filter(warned)) name(box, `${one.id}: ${warnings.get(one.id)}`, this.alarm, true);
      if (all) for (const [one, box] of boxes) if (!warned([one])) name(box, String(one.id), this.own, false);
    }

    // Grid, its numbers, and the sensors' fields.
    ground() {
      const { c } = this, rough = 90 / this.view.scale, power = 10 ** Math.floor(Math.log10(rough));
      const step = [1, 2, 5, 10].map((n) => n * power).find((n) => n >= rough);
      const marks = (low, high) => {
        const out = [];
        for (let n = Math.ceil(low / step); n * step <= high; ++n) out.push(Number((n * step).toPrecision(12)));
        return out;
      };
      const xs = marks(this.to_x(0), this.to_x(this.width)), ys = marks(this.to_y(this.height), this.to_y(0));
      this.path((to) => {
        for (const x of xs) { to.moveTo(this.px(x), 0); to.lineTo(this.px(x), this.height); }
        for (const y of ys) { to.moveTo(0, this.py(y)); to.lineTo(this.width, this.py(y)); }
      }, GRID, this.grid);
      if (!this.hidden.has("fields"))
        this.data.sensors.forEach((sensor, s) => this.path(
            (to) => polygon(to, this.px(0), this.py(0), this.view.scale, upright(sensor.edge)),
            this.rules.looks.field, this.sensors[s]));
      c.font = "11px system-ui, sans-serif";
      c.textAlign = "center";
      for (const x of xs)
        if (this.px(x) > 30 && this.px(x) < this.width - 20) this.text(`${x}`, this.px(x), this.height - 5, this.soft);
      c.textAlign = "left";
      for (const y of ys)
        if (this.py(y) < this.height - 22 && this.py(y) > 12) this.text(`${y}`, 4, this.py(y) + 4, this.soft);
    }
  };
})();
