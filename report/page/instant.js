// The instant that scenes, plots over time and timing diagrams of a page show together, in seconds of true time.
"use strict";
const Instant = (() => {
  const listeners = [];
  return {
    at: undefined,
    // Calls `listener(at, by)` after each change.
    on(listener) { listeners.push(listener); },
    // `by` is the part of the page that the reader moved.
    set(at, by) {
      this.at = at;
      for (const listener of listeners) listener(at, by);
    },
  };
})();
