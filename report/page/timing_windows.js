// The windows of a drive's timing diagram, over the whole drive: a few at a time are unpacked when one is shown.
// report/timing/windows/packed.h explains their form.
"use strict";
const TimingWindows = (() => {
  const KEPT = 4;   // chunks

  const inflated = async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return JSON.parse(await new Response(stream).text());
  };
  // Returns the pictures of a chunk.
  const unpacked = ({ lines, order, columns }) => {
    const next = columns.map(([decimals, ...steps]) => {
      let at = 0, value = 0;
      return () => String((value += steps[at++]) / 10 ** decimals);
    });
    let first = 0;
    const parts = lines.map((line) => {
      const texts = line.split("\u0001"), numbers = next.slice(first, first += texts.length - 1);
      return () => texts.reduce((all, text, i) => all + numbers[i - 1]() + text);
    });
    return order.map((window) => window.map((line) => parts[line]()).join("\n"));
  };

  return class {
    // Returns whether the browser can unpack.
    static get possible() { return typeof DecompressionStream !== "undefined"; }

    constructor({ windows, each, chunks }) {
      Object.assign(this, { windows, each, chunks, kept: new Map() });
    }
    get count() { return this.windows.length; }
    get from() { return this.windows[0][0]; }
    get to() { return this.windows.at(-1)[1]; }
    // Returns the window of an instant [ms], or the last one before it.
    at(t) {
      let low = 0, high = this.count - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (this.windows[middle][0] <= t) low = middle; else high = middle - 1;
      }
      return low;
    }
    has(window, t) {
      const [from, to] = this.windows[window];
      return t >= from && t <= to;
    }
    async svg(window) {
      const chunk = Math.floor(window / this.each);
      if (!this.kept.has(chunk)) {
        this.kept.set(chunk, inflated(this.chunks[chunk]).then(unpacked));
        if (this.kept.size > KEPT) this.kept.delete(this.kept.keys().next().value);
      }
      return (await this.kept.get(chunk))[window % this.each];
    }
  };
})();
