// The controls of scenes that play: the bar with its slider, a panel for each scene, the layers to hide, the keys.
"use strict";
const SceneControls = (() => {
  const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5];
  const { make, buttons } = Elements;

  // The player acts: play, go, zoom, all, redraw, and what a pointer does in a panel.
  return class {
    constructor(figure, scenes) {
      Object.assign(this, { figure, scenes, hidden: new Set(), view: { x: 0, y: 0, scale: 1 } });
      this.from = Math.min(...scenes.map((scene) => scene.from));
      this.to = Math.max(...scenes.map((scene) => scene.to));
    }
    // Returns the panels' grid.
    build() {
      this.figure.querySelector("noscript")?.remove();
      this.bar();
      const grid = make("div", { className: "panels" });
      this.panels = this.scenes.map((scene) => this.panel(scene, grid));
      this.heard = make("p", { className: "heard" });
      this.heard.setAttribute("aria-live", "polite");
      const keys = make("p", { className: "keys" });
      keys.innerHTML =
          "<kbd>Space</kbd> plays, <kbd>←</kbd> <kbd>→</kbd> from image to image, with <kbd>Shift</kbd> by a second, " +
          "<kbd>Home</kbd> <kbd>End</kbd>, <kbd>+</kbd> <kbd>−</kbd> zoom, <kbd>0</kbd> all. Drag to move, " +
          "<kbd>Ctrl</kbd> or <kbd>Shift</kbd> and the wheel, or two fingers, to zoom, point at an object for its figures.";
      this.figure.append(grid, this.layers(), keys, this.heard);
      return grid;
    }

    bar() {
      const bar = make("div", { className: "bar" });
      const button = buttons(bar);
      this.player = button("▶", "Play", () => this.play(!this.playing));
      this.slider = make("input", { type: "range", min: this.from, max: this.to, step: "any" });
      this.slider.setAttribute("aria-label", "Instant");
      this.slider.addEventListener("input", () => this.go(Number(this.slider.value)));
      this.told = make("output", { className: "range" });
      this.speed = make("select");
      this.speed.setAttribute("aria-label", "Speed");
      for (const speed of SPEEDS) this.speed.append(new Option(`${speed} ×`, speed, speed === 1, speed === 1));
      bar.append(this.slider, this.told, this.speed);
      button("+", "Zoom in", () => this.zoom(2));
      button("−", "Zoom out", () => this.zoom(0.5));
      button("All", "Show all", () => this.all());
      this.figure.append(bar);
    }

    panel(scene, grid) {
      const canvas = make("canvas", { tabIndex: 0 });
      canvas.setAttribute("role", "group");
      canvas.setAttribute(
          "aria-label",
          `${scene.label}, seen from above. Space plays, arrow keys go from image to image, plus and minus zoom.`);
      const one = { scene, canvas, drawing: new SceneDrawing(canvas, scene, this.view, this.hidden), near: true };
      const head = make("p", { className: "label" }, make("strong", { textContent: scene.label }), make("span"));
      one.counts = head.lastChild;
      const box = make("div", { className: "panel" }, head, canvas);
      if (scene.note) box.append(make("p", { className: "note", textContent: scene.note }));
      grid.append(box);
      canvas.addEventListener("pointerdown", (event) => this.grab(event, one));
      canvas.addEventListener("pointermove", (event) => this.point(event, one));
      canvas.addEventListener("pointerleave", () => this.leave());
      // The second finger is the scene's, whatever the first one did.
      for (const kind of ["touchstart", "touchmove"])
        canvas.addEventListener(kind, (event) => {
          if (event.touches.length > 1 && event.cancelable) event.preventDefault();
        }, { passive: false });
      canvas.addEventListener("wheel", (event) => this.wheel(event, one), { passive: false });
      // A panel out of sight is not drawn.
      new IntersectionObserver(([entry]) => {
        one.near = entry.isIntersecting;
        if (one.near) this.redraw();
      }, { rootMargin: "200px" }).observe(canvas);
      return one;
    }

    layers() {
      const observing = this.scenes.flatMap((scene) => scene.sensors.filter((sensor) => !sensor.odometry));
      const sensors = new Set(observing.map((sensor) => sensor.name));
      const { sigmas, trail } = this.scenes[0].rules;
      const words = { truth: "true objects", tracks: "tracks", ellipses: `ellipses (${sigmas} sigma)`,
        trails: `trails (${trail} s)`, warnings: "warnings", fields: "fields" };
      const box = make("div", { className: "legend" });
      for (const name of [...Object.keys(words), ...sensors]) {
        const one = make("button", { type: "button", textContent: words[name] ?? `${name}: observations` });
        one.setAttribute("aria-pressed", true);
        one.addEventListener("click", () => {
          if (!this.hidden.delete(name)) this.hidden.add(name);
          one.setAttribute("aria-pressed", !this.hidden.has(name));
          this.redraw();
        });
        const sensor = this.scenes[0].sensors.find((s) => s.name === name);
        if (sensor) one.prepend(make("i", { className: "dot", style: `background: ${sensor.colour}` }));
        box.append(one);
      }
      return box;
    }
  };
})();
