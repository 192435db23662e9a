// Plays scenes side by side, with one clock and one view: follows the page's instant, moves and zooms.
"use strict";
(() => {
  const STEP = 1;   // s
  const counted = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;
  const side = (y) => `${Math.abs(y).toFixed(1)} m ${y < 0 ? "right" : "left"}`;
  const tip = document.querySelector(".tip");   // that of the timing diagrams

  // Where the pointers hold the scene, and how far apart they are.
  const grip = (held) => {
    const [a, b = a] = [...held.values()];
    return { x: (a.clientX + b.clientX) / 2, y: (a.clientY + b.clientY) / 2,
      apart: Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY)) };
  };

  class Player extends SceneControls {
    constructor(figure, scenes) {
      super(figure, scenes);
      this.playing = false;
      this.held = new Map();   // the pointers that are down, by number
      this.at = this.from;
      const grid = this.build();
      figure.addEventListener("keydown", (event) => this.key(event));
      new ResizeObserver(() => this.fit()).observe(grid);
      Instant.on((at) => this.show(at));
      // A middle instant shows more than the first one.
      this.show(Instant.at ?? (this.from + this.to) / 2);
    }

    // All canvases have one size, and one view of the places that all drives need.
    fit() {
      const width = this.panels[0].canvas.clientWidth;
      if (width < 50) return;
      const extents = this.scenes.map((scene) => scene.extent());
      const [x, y] = [0, 1].map((i) => Math.min(...extents.map((e) => e[i])) - 4);
      const [right, left] = [2, 3].map((i) => Math.max(...extents.map((e) => e[i])) + 4);
      this.whole = { x: (x + right) / 2, y: (y + left) / 2, wide: right - x, high: left - y };
      const height = Math.round(width * Math.min(0.75, Math.max(0.3, this.whole.high / this.whole.wide)));
      const first = this.width === undefined, shrunk = width / (this.width ?? width);
      this.width = width;
      this.height = height;
      for (const { drawing } of this.panels) drawing.fit(width, height);
      if (first) this.all(); else this.view.scale *= shrunk;
      this.draw(true);   // a canvas of another size is empty, in sight or not
    }
    get fitting() { return Math.min(this.width / this.whole.wide, this.height / this.whole.high); }
    all() {
      Object.assign(this.view, { x: this.whole.x, y: this.whole.y, scale: this.fitting });
      this.redraw();
    }
    // What is in sight nearest to the middle of all that is: where a zoom keeps something in sight.
    get middle() {
      const places = this.panels.flatMap(({ drawing }) => drawing.in_sight());
      if (places.length === 0) return this.view;
      const [x, y] = ["x", "y"].map((of) => places.reduce((sum, one) => sum + one[of], 0) / places.length);
      const away = (one) => Math.hypot(one.x - x, one.y - y);
      return places.reduce((best, one) => (away(one) < away(best) ? one : best));
    }
    zoom(factor, { x, y } = this.middle) {
      const scale = Math.min(this.fitting * 200, Math.max(this.fitting / 8, this.view.scale * factor));
      const by = this.view.scale / scale;
      Object.assign(this.view, { scale, x: x + (this.view.x - x) * by, y: y + (this.view.y - y) * by });
      this.redraw();
    }

    go(at) { Instant.set(Math.min(this.to, Math.max(this.from, at)), this); }
    show(at) {
      this.at = Math.min(this.to, Math.max(this.from, at));
      this.slider.value = this.at;
      this.told.textContent = `${this.at.toFixed(3)} s of ${this.to.toFixed(3)} s`;
      this.figure.dataset.at = this.at;
      this.panels[0].canvas.closest(".panels").dataset.words = `At ${this.told.textContent}`;
      this.redraw();
    }
    play(on) {
      if (on && this.at >= this.to) this.go(this.from);
      this.playing = on;
      this.player.textContent = on ? "❚❚" : "▶";
      this.player.title = on ? "Pause" : "Play";
      this.player.setAttribute("aria-label", this.player.title);
      this.figure.dataset.playing = on;
      if (!on) { this.tell(); return; }
      let before;
      const step = (now) => {
        if (!this.playing) return;
        const next = this.at + (now - (before ?? now)) / 1000 * Number(this.speed.value);
        before = now;
        this.go(next);
        if (next >= this.to) this.play(false); else requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }
    redraw() {
      if (this.width === undefined) return;
      this.pending ??= requestAnimationFrame(() => { this.pending = undefined; this.draw(); });
    }
    draw(all = false) {
      this.figure.dataset.view = [this.view.x, this.view.y, this.view.scale].join(" ");
      for (const { near, drawing, canvas, counts } of this.panels) {
        if (!near && !all) continue;
        drawing.draw(this.at);
        const { truth, tracks, warnings } = canvas.dataset;
        counts.textContent = ` ${counted(Number(truth), "object")}, ${counted(Number(tracks), "track")}` +
            (warnings > 0 ? `, ${counted(Number(warnings), "warning")}` : "");
      }
    }
    tell() {
      const words = this.panels.map(({ scene, counts }) => `${scene.label}:${counts.textContent}`);
      this.heard.textContent = `${this.at.toFixed(3)} s; ${words.join("; ")}`;
    }

    key(event) {
      if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches("select")) return;
      const by = (sign) => {
        this.go(event.shiftKey ? this.at + sign * STEP : this.scenes[0].image_beside(this.at, sign));
      };
      const act = {
        " ": () => this.play(!this.playing), "ArrowLeft": () => by(-1), "ArrowRight": () => by(1),
        "Home": () => this.go(this.from), "End": () => this.go(this.to), "0": () => this.all(),
        "+": () => this.zoom(2), "=": () => this.zoom(2), "-": () => this.zoom(0.5), "_": () => this.zoom(0.5),
      }[event.key];
      if (!act || (event.key === " " && event.target.matches("button"))) return;   // a button presses itself
      event.preventDefault();
      act();
      if (!this.playing) requestAnimationFrame(() => this.tell());
    }
    wheel(event, { drawing }) {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const factor = (event.deltaY || event.deltaX) > 0 ? 0.8 : 1.25;
      this.zoom(factor, { x: drawing.to_x(event.offsetX), y: drawing.to_y(event.offsetY) });
    }
    // On a touch screen, one finger scrolls the page up and down, and moves the scene sideways. Two fingers move and zoom it.
    grab(event, { canvas, drawing }) {
      const { held } = this, another = held.size > 0;
      if (event.button !== 0 || held.size === 2 || (another && this.grabbed !== canvas)) return;
      this.grabbed = canvas;
      canvas.setPointerCapture(event.pointerId);
      held.set(event.pointerId, event);
      if (another) return;
      const { x, y, scale } = this.view, end = new AbortController();
      const on = (kind, act) =>
          canvas.addEventListener(kind, (of) => { if (held.has(of.pointerId)) act(of); }, { signal: end.signal });
      on("pointermove", (moved) => {
        const from = grip(held);
        held.set(moved.pointerId, moved);
        const to = grip(held), box = canvas.getBoundingClientRect();
        this.view.x -= (to.x - from.x) / this.view.scale;
        this.view.y += (to.y - from.y) / this.view.scale;
        if (held.size === 2)
          this.zoom(to.apart / from.apart, { x: drawing.to_x(to.x - box.left), y: drawing.to_y(to.y - box.top) });
        this.redraw();
      });
      on("pointerup", ({ pointerId }) => {
        held.delete(pointerId);
        if (held.size === 0) end.abort();
      });
      // The page scrolls or grows instead.
      on("pointercancel", () => {
        held.clear();
        end.abort();
        Object.assign(this.view, { x, y, scale });
        this.redraw();
      });
    }
    point(event, { drawing }) {
      tip.hidden = true;
      if (event.buttons !== 0 || !drawing.seen) return;
      const x = drawing.to_x(event.offsetX), y = drawing.to_y(event.offsetY);
      const within = (one) => Math.hypot(one.x - x, one.y - y) < Math.max(one.length / 2, 10 / this.view.scale);
      const lines = [];
      for (const one of drawing.seen.tracks.filter(within).slice(0, 3))
        lines.push(`track ${one.id}${one.coasting ? ", not observed of late" : one.confirmed ? "" : ", tentative"}: ` +
          `${one.x.toFixed(1)} m ahead, ${side(one.y)}, ${one.speed.toFixed(1)} m/s${drawing.data.moves ? " over ground" : ""}, ` +
          `sigma ${one.sigma_x.toFixed(2)} m and ${one.sigma_y.toFixed(2)} m`);
      for (const one of drawing.seen.objects.filter(within).slice(0, 3))
        lines.push(`object ${one.id}: ${one.x.toFixed(1)} m ahead, ${side(one.y)}, ` +
          `${one.length.toFixed(1)} m long, ${one.width.toFixed(1)} m wide`);
      if (lines.length === 0) return;
      tip.textContent = lines.join("\n");
      tip.hidden = false;
      tip.style.left = `${Math.max(4, Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 8))}px`;
      tip.style.top = `${event.clientY + 18}px`;
    }
    leave() { tip.hidden = true; }
  }

  const data = JSON.parse(document.getElementById("scenes").textContent);
  const players = [...document.querySelectorAll("figure.scenes")].map((figure) => {
    const first = Number(figure.dataset.first);
    return new Player(figure, data.slice(first, first + Number(figure.dataset.count)).map((one) => new SceneData(one)));
  });
  const repaint = () => players.forEach((player) => {
    for (const { drawing } of player.panels) drawing.colours();
    if (player.width !== undefined) player.draw(true);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", repaint);
  matchMedia("print").addEventListener("change", repaint);
})();
