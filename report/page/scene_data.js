// A drive seen from above, unpacked from the page's data. report/scene/packed.h explains the columns; view.h has decided what is shown.
"use strict";
const SceneData = (() => {
  const column = (Type, text) => {
    const binary = atob(text), bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
    return new Type(bytes.buffer);
  };

  // Moments of one kind: their times, and the columns of their parts. Moment m has the parts begin[m] to begin[m + 1].
  const moments = (json, types) => {
    const out = { at: column(Float64Array, json.at), count: column(Uint16Array, json.count) };
    out.begin = new Uint32Array(out.at.length + 1);
    out.count.forEach((count, m) => { out.begin[m + 1] = out.begin[m] + count; });
    for (const [name, Type] of Object.entries(types)) out[name] = column(Type, json[name]);
    return out;
  };

  // Returns the last of the times that is at most t, or -1.
  const newest = (times, t) => {
    let low = -1, high = times.length;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle; else high = middle;
    }
    return low;
  };

  // Adds to each part: its moment; the newest earlier part with its id; that of the next moment. -1: none.
  const link = (kind) => {
    const parts = kind.id.length, last = new Map();
    for (const name of ["moment", "before", "next"]) kind[name] = new Int32Array(parts).fill(-1);
    for (let m = 0; m < kind.at.length; ++m)
      for (let p = kind.begin[m]; p < kind.begin[m + 1]; ++p) {
        const q = last.get(kind.id[p]) ?? -1;
        kind.moment[p] = m;
        kind.before[p] = q;
        if (q >= 0 && kind.moment[q] === m - 1) kind.next[q] = p;
        last.set(kind.id[p], p);
      }
    return kind;
  };
  const turn = (angle) => angle - 65534 * Math.round(angle / 65534);

  return class {
    constructor(json) {
      Object.assign(this, { label: json.label, colour: json.colour, from: json.from, to: json.to, unit: json.unit,
        note: json.note, sensors: json.sensors, rules: json.rules });
      const place = { x: Int16Array, y: Int16Array };
      this.truth = link(moments(json.truth, { id: Uint16Array, ...place, heading: Int16Array }));
      this.images = link(moments(json.images, {
        id: Uint16Array, ...place, heading: Int16Array, speed: Int16Array, length: Uint16Array, width: Uint16Array,
        sigma_x: Uint16Array, sigma_y: Uint16Array, correlation: Int8Array, status: Uint8Array,
      }));
      // How the vehicle drove at an image: then speeds are over ground.
      this.own = moments(json.own, { speed: Int16Array, yaw_rate: Float32Array });
      this.moves = this.own.at.length > 0;
      this.lists = json.lists.map((list) => moments(list, place));
      this.warned = moments(json.warnings, { id: Uint16Array, word: Uint16Array });
      this.words = json.warnings.words;
      const [ids, length, width] = ["id", "length", "width"].map((name) => column(Uint16Array, json.truth.sizes[name]));
      this.sizes = new Map([...ids].map((id, i) => [id, [length[i] / 100, width[i] / 100]]));
    }

    // Returns the places that the drive needs: [least x, least y, greatest x, greatest y] in metres.
    extent() {
      const out = [0, 0, 0, 0];
      for (const kind of [this.truth, this.images])
        for (let p = 0; p < kind.x.length; ++p) {
          const x = kind.x[p] * this.unit, y = kind.y[p] * this.unit;
          if (x < out[0]) out[0] = x;
          if (y < out[1]) out[1] = y;
          if (x > out[2]) out[2] = x;
          if (y > out[3]) out[3] = y;
        }
      return out;
    }

    objects(t) {
      const { truth, unit, sizes } = this, m = newest(truth.at, t), out = [];
      if (m < 0) return out;
      const part = (t - truth.at[m]) / (truth.at[m + 1] - truth.at[m]);
      for (let p = truth.begin[m]; p < truth.begin[m + 1]; ++p) {
        const q = truth.next[p] < 0 ? p : truth.next[p], id = truth.id[p], [length, width] = sizes.get(id) ?? [0, 0];
        out.push({
          id, length, width,
          x: (truth.x[p] + part * (truth.x[q] - truth.x[p])) * unit,
          y: (truth.y[p] + part * (truth.y[q] - truth.y[p])) * unit,
          heading: (truth.heading[p] + part * turn(truth.heading[q] - truth.heading[p])) / 32767 * Math.PI,
        });
      }
      return out;
    }

    // Returns the vehicle's motion at the image m: none if the image's speeds are relative to it.
    own_motion(m) {
      const { own } = this, o = newest(own.at, this.images.at[m]);
      return o < 0 ? { speed: 0, yaw_rate: 0 } : { speed: own.speed[o] / 100, yaw_rate: own.yaw_rate[o] };
    }

    // Returns a track's place so many seconds later, in the axes that the vehicle has then (recording/scene/geometry.h).
    moved_on({ x, y, heading, speed, own }, seconds) {
      const turn = own.yaw_rate * seconds, c = Math.cos(turn), s = Math.sin(turn);
      const dx = x + seconds * (speed * Math.cos(heading) - own.speed * Math.cos(turn / 2));
      const dy = y + seconds * (speed * Math.sin(heading) - own.speed * Math.sin(turn / 2));
      return { x: c * dx + s * dy, y: c * dy - s * dx, heading: heading - turn };
    }

    tracks(t) {
      const { images, unit, rules } = this, m = newest(images.at, t), out = [];
      if (m < 0) return out;
      const own = this.own_motion(m);
      for (let p = images.begin[m]; p < images.begin[m + 1]; ++p) {
        const then = { x: images.x[p] * unit, y: images.y[p] * unit, heading: images.heading[p] / 32767 * Math.PI,
          speed: images.speed[p] / 100, own };
        out.push({
          p, id: images.id[p], ...then, ...this.moved_on(then, t - images.at[m]),
          length: images.length[p] / 100, width: images.width[p] / 100, sigma_x: images.sigma_x[p] / 100,
          sigma_y: images.sigma_y[p] / 100, correlation: images.correlation[p] / 127,
          confirmed: (images.status[p] & rules.confirmed) !== 0, coasting: (images.status[p] & rules.coasting) !== 0,
        });
      }
      return out;
    }

    // Calls `draw(x, y)` for the places of a track in its newest images, from the newest on.
    trail(track, t, draw) {
      const { images, unit } = this;
      for (let { p } = track; p >= 0 && t - images.at[images.moment[p]] <= this.rules.trail; p = images.before[p])
        draw(images.x[p] * unit, images.y[p] * unit);
    }

    // Calls `draw(x, y)` for each observation of a sensor's newest list.
    observations(sensor, t, draw) {
      const list = this.lists[sensor], m = newest(list.at, t);
      if (m < 0) return;
      for (let p = list.begin[m]; p < list.begin[m + 1]; ++p) draw(list.x[p] * this.unit, list.y[p] * this.unit);
    }

    // Returns the words of each warning, by the track's id.
    warnings(t) {
      const { warned } = this, m = newest(warned.at, t), out = new Map();
      if (m < 0) return out;
      for (let p = warned.begin[m]; p < warned.begin[m + 1]; ++p) out.set(warned.id[p], this.words[warned.word[p]]);
      return out;
    }

    // Returns the instant of the image before (by < 0) or behind t, within the scene.
    image_beside(t, by) {
      const at = this.images.at.length > 0 ? this.images.at : this.truth.at, near = 1e-6;
      const m = by > 0 ? newest(at, t + near) + 1 : newest(at, t - near);
      return m >= 0 && m < at.length ? at[m] : by > 0 ? this.to : this.from;
    }
  };
})();
