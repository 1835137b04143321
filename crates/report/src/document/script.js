"use strict";
// Charts on a screen: values under the pointer, series switched on and off by their legend, zoom, a drawing of its own on a
// narrow screen, and data and pictures to save. Without scripts the charts are static.
const NARROW = 640;
const FINE = 10;
const SPACE = (document.querySelector("svg") || document.body).namespaceURI;
const NAME = (document.title || "figure").toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "");

// A number is encoded as the difference from the one before in multiples of a power of ten; the last difference repeats.
const decode = (code) => {
  if (Array.isArray(code)) return code;
  const power = 10 ** Math.abs(code.s);
  let count = 0;
  return Array.from({ length: code.n }, (_, index) => {
    count += code.v[Math.min(index, code.v.length - 1)];
    return code.s < 0 ? count / power : count * power;
  });
};

const element = (name, attributes, ...children) => {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) key in made ? (made[key] = value) : made.setAttribute(key, value);
  made.append(...children);
  return made;
};
const shape = (name, attributes, text) => {
  const made = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  if (text !== undefined) made.textContent = text;
  return made;
};
const save = (name, type, text) => {
  const address = URL.createObjectURL(new Blob([text], { type }));
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
};
const saveSvg = (svg, name) => {
  const copy = svg.cloneNode(true);
  copy.removeAttribute("class");
  copy.removeAttribute("style");
  save(name, "image/svg+xml", new XMLSerializer().serializeToString(copy));
};

// Ticks at 1, 2 or 5 times a power of ten, about `target` of them.
const ticksOf = ([low, high], target, log) => {
  if (log && high / low > 20) {
    const powers = [];
    for (let power = Math.ceil(Math.log10(low) - 1e-9); 10 ** power <= high * (1 + 1e-9); power++) powers.push(10 ** power);
    const skip = Math.ceil(powers.length / target);
    return powers.filter((_, index) => index % skip === 0);
  }
  const rough = (high - low) / target, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= rough * 0.999);
  const first = Math.ceil(low / step - 1e-9), count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, count) }, (_, index) => (first + index) * step);
};
const shown = (value) => {
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(2).replace(/\.?0+e/, "e") : String(Number(value.toPrecision(6)));
  return text.replace("e+", "e").replace("-", "\u2212");
};

function liveChart(box, number) {
  const still = box.querySelector("svg");
  const chart = JSON.parse(box.querySelector("script").textContent);
  const places = chart.places.map(decode);
  const look = (index) => {
    const group = `.series[data-series="${index}"]`;
    const line = [...still.querySelectorAll(`${group} path[stroke]`)].pop();
    const mark = still.querySelector(`${group} [fill]:not([fill=none])`);
    return {
      colour: (line && line.getAttribute("stroke")) || (mark && mark.getAttribute("fill")) || "#222222",
      dash: line && line.parentElement.getAttribute("stroke-dasharray"),
    };
  };
  chart.series.forEach((series, index) => {
    const values = decode(series.y);
    series.points = places[series.x].map((x, k) => [x, values[k]]);
    Object.assign(series, look(index));
  });
  const hidden = new Set();
  const whole = { x: chart.x.range, y: chart.y.range };
  let ranges = { ...whole };
  still.classList.add("still");
  // what is on the screen: the drawing, its frame in pixels, and whether it is the static one
  let view = { svg: still, frame: chart.frame };

  const unit = (axis, range, value) => {
    const [low, high] = range;
    const u = axis.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return axis.flip ? 1 - u : u;
  };
  const place = ([x, y]) => {
    const [left, top, width, height] = view.frame;
    return [left + width * unit(chart.x, ranges.x, x), top + height * (1 - unit(chart.y, ranges.y, y))];
  };
  const valueAt = (px) => {
    const [left, , width] = view.frame;
    let u = (px - left) / width;
    if (chart.x.flip) u = 1 - u;
    const [low, high] = ranges.x;
    return chart.x.log ? low * (high / low) ** u : low + (high - low) * u;
  };
  const caption = (axis) => (axis.unit ? `${axis.label} (${axis.unit})` : axis.label);

  // Draws the chart at the ranges shown, as wide as `width`.
  const draw = (width) => {
    const narrow = width < NARROW, height = narrow ? 330 : 460;
    const svg = shape("svg", { width, height, viewBox: `0 0 ${width * FINE} ${height * FINE}`, "font-family": "Arial, Helvetica, sans-serif", class: "drawn", role: "img" });
    svg.setAttribute("aria-labelledby", still.getAttribute("aria-labelledby"));
    const yTicks = ticksOf(ranges.y, narrow ? 5 : 7, chart.y.log);
    const left = 12 + 6.5 * Math.max(...yTicks.map((tick) => shown(tick).length), 2), top = 34;
    view = { svg, frame: [left, top, width - left - 14, height - top - 44] };
    const [, , wide, tall] = view.frame;
    const at = (value) => Math.round(value * FINE);
    const add = (name, attributes, text) => svg.append(shape(name, attributes, text));
    const words = (x, y, anchor, text, size = 12) => add("text", { x: at(x), y: at(y), "font-size": size * FINE, fill: "#222222", "text-anchor": anchor }, text);
    add("rect", { width: "100%", height: "100%", fill: "#FFFFFF" });
    const xTicks = ticksOf(ranges.x, narrow ? 5 : 9, chart.x.log);
    for (const tick of xTicks) {
      const [x] = place([tick, ranges.y[0]]);
      add("path", { stroke: "#DDDDDD", "stroke-width": 8, d: `M${at(x)} ${at(top)}v${at(tall)}` });
      words(x, top + tall + 16, "middle", shown(tick));
    }
    for (const tick of yTicks) {
      const [, y] = place([ranges.x[0], tick]);
      add("path", { stroke: tick === 0 ? "#666666" : "#DDDDDD", "stroke-width": 8, d: `M${at(left)} ${at(y)}h${at(wide)}` });
      words(left - 5, y + 4, "end", shown(tick));
    }
    words(left + wide / 2, top + tall + 36, "middle", caption(chart.x), 13);
    words(4, 20, "start", caption(chart.y), 13);
    const clip = `clip-${number}`;
    const cut = shape("clipPath", { id: clip });
    cut.append(shape("rect", { x: at(left), y: at(top), width: at(wide), height: at(tall) }));
    svg.append(cut);
    for (const [x, label] of chart.markers) {
      const [px] = place([x, ranges.y[0]]);
      if (px < left || px > left + wide) continue;
      add("path", { stroke: "#666666", "stroke-width": 10, "stroke-dasharray": "30 30", d: `M${at(px)} ${at(top)}v${at(tall)}` });
      if (!narrow) words(px, top - 4, "middle", label, 11);
    }
    chart.series.forEach((series, index) => {
      if (hidden.has(index)) return;
      const points = series.points.map(place);
      if (!series.apart) {
        const d = points.map(([x, y], k) => `${k ? "L" : "M"}${at(x)} ${at(y)}`).join("");
        const dash = series.dash ? { "stroke-dasharray": series.dash } : {};
        add("path", { fill: "none", stroke: series.colour, "stroke-width": 20, "stroke-linejoin": "round", "clip-path": `url(#${clip})`, ...dash, d });
      } else {
        for (const [x, y] of points) {
          if (x >= left - 1 && x <= left + wide + 1 && y >= top - 1 && y <= top + tall + 1) add("circle", { cx: at(x), cy: at(y), r: 36, fill: series.colour });
        }
      }
    });
    add("rect", { x: at(left), y: at(top), width: at(wide), height: at(tall), fill: "none", stroke: "#222222", "stroke-width": 10 });
    return svg;
  };

  const legend = element("div", { className: "legend" });
  const keys = chart.series.map((series, index) => {
    const swatch = element("span", { className: "swatch" });
    if (series.apart) Object.assign(swatch.style, { width: "0.6rem", height: "0.6rem", borderRadius: "50%", background: series.colour });
    else swatch.style.borderTop = `3px ${series.dash ? "dashed" : "solid"} ${series.colour}`;
    const key = element("button", { type: "button" }, swatch, series.label);
    key.addEventListener("click", () => toggle(index));
    legend.append(key);
    return key;
  });
  const readout = element("div", { className: "readout", hidden: true });
  const reset = element("button", { type: "button", textContent: "Whole range" });
  const csv = element("button", { type: "button", textContent: "Data (CSV)" });
  const picture = element("button", { type: "button", textContent: "Picture (SVG)" });
  const tools = element("div", { className: "tools" }, reset, csv, picture);
  const note = element("p", { className: "note", textContent: chart.note });
  const line = shape("line", { stroke: "#888888", "stroke-width": 8, visibility: "hidden" });
  const selection = shape("rect", { fill: "#0B55A4", "fill-opacity": 0.15, visibility: "hidden" });
  box.classList.add("live");
  box.append(readout);
  box.after(legend, note, tools);

  const isWhole = () => ranges.x === whole.x;
  const show = () => {
    const narrow = box.clientWidth > 0 && box.clientWidth < NARROW;
    const isStill = isWhole() && !narrow;
    if (view.svg !== still) view.svg.remove();
    still.style.display = isStill ? "" : "none";
    if (isStill) view = { svg: still, frame: chart.frame };
    else box.prepend(draw(narrow ? box.clientWidth : 860));
    view.svg.append(selection, line);
    legend.hidden = isStill || chart.series.length < 2;
    reset.hidden = isWhole();
    note.hidden = isStill || !chart.note;
    keys.forEach((key, index) => key.setAttribute("aria-pressed", String(!hidden.has(index))));
    for (const part of still.querySelectorAll("[data-series]")) {
      const off = hidden.has(Number(part.dataset.series));
      if (part.classList.contains("key")) part.classList.toggle("off", off);
      else part.style.display = off ? "none" : "";
    }
    listen(view.svg);
  };
  const toggle = (index) => {
    if (!hidden.delete(index)) hidden.add(index);
    show();
  };
  // Shows x between two values, and y over what the series have there.
  const zoom = (low, high) => {
    const [first, last] = whole.x;
    [low, high] = [Math.max(first, Math.min(low, high)), Math.min(last, Math.max(low, high))];
    if (low <= first && high >= last) ranges = { ...whole };
    else if (high - low > 1e-6 * (last - first)) {
      let [least, most] = [Infinity, -Infinity];
      chart.series.forEach((series, index) => {
        if (hidden.has(index)) return;
        series.points.forEach(([x, y], k) => {
          const after = series.points[k + 1], before = series.points[k - 1];
          const isNear = x >= low && x <= high || after && x < low && after[0] >= low || before && x > high && before[0] <= high;
          if (isNear) [least, most] = [Math.min(least, y), Math.max(most, y)];
        });
      });
      if (!(most > least)) [least, most] = whole.y;
      const margin = chart.y.log ? 0 : 0.05 * (most - least);
      ranges = { x: [low, high], y: [least - margin, most + margin] };
    }
    show();
  };
  reset.addEventListener("click", () => zoom(...whole.x));
  csv.addEventListener("click", () => {
    const quoted = (text) => `"${String(text).replace(/"/g, '""')}"`;
    const rows = [["series", caption(chart.x), caption(chart.y)].map(quoted).join(",")];
    for (const series of chart.series) for (const [x, y] of series.points) rows.push([quoted(series.label), x, y].join(","));
    save(`${NAME}-figure-${number}.csv`, "text/csv", rows.join("\n") + "\n");
  });
  picture.addEventListener("click", () => {
    [line, selection].forEach((part) => part.remove());
    saveSvg(view.svg, `${NAME}-figure-${number}.svg`);
    view.svg.append(selection, line);
  });

  // Nearest point of a series: the horizontal distance decides, the vertical one between points at the same abscissa.
  const nearest = (points, x, y) => {
    let best = null, least = Infinity;
    for (const point of points) {
      const [px, py] = place(point);
      const far = (px - x) ** 2 + 1e-3 * (py - y) ** 2;
      if (far < least) { least = far; best = point; }
    }
    return best;
  };
  const text = (value, axis) => {
    const size = Math.abs(value);
    const digits = size !== 0 && (size < 1e-4 || size >= 1e7) ? value.toExponential(4) : String(Number(value.toPrecision(6)));
    return axis.unit ? digits + " " + axis.unit : digits;
  };
  const leave = () => {
    readout.hidden = true;
    line.setAttribute("visibility", "hidden");
  };
  let start = null;
  const pointer = (event) => {
    const seen = view.svg.getBoundingClientRect();
    const scale = seen.width / (view.svg.viewBox.baseVal.width / FINE);
    return { x: (event.clientX - seen.left) / scale, y: (event.clientY - seen.top) / scale, scale, seen };
  };
  const move = (event) => {
    const [left, top, width, height] = view.frame;
    const { x, y, scale, seen } = pointer(event);
    if (start !== null) {
      const to = Math.max(left, Math.min(left + width, x)), from = Math.min(start, to);
      for (const [key, value] of [["x", from], ["y", top], ["width", Math.abs(to - start)], ["height", height]]) selection.setAttribute(key, value * FINE);
      selection.setAttribute("visibility", "visible");
      return;
    }
    if (x < left || x > left + width || y < top || y > top + height) return leave();
    const rows = [];
    let first = null;
    chart.series.forEach((series, index) => {
      const point = hidden.has(index) ? null : nearest(series.points, x, y);
      if (!point || Math.abs(place(point)[0] - x) > 12) return;
      if (!first || Math.abs(place(point)[0] - x) < Math.abs(place(first)[0] - x)) first = point;
      rows.push(`${series.label}: ${text(point[1], chart.y)}`);
    });
    if (!first) return leave();
    rows.unshift(`${chart.x.label}: ${text(first[0], chart.x)}`);
    readout.replaceChildren(...rows.map((row) => element("div", { textContent: row })));
    readout.hidden = false;
    const across = place(first)[0];
    const flip = across * scale + 16 + readout.offsetWidth > seen.width;
    readout.style.left = Math.max(0, flip ? across * scale - 12 - readout.offsetWidth : across * scale + 12) + "px";
    readout.style.top = Math.max(0, Math.min(y * scale - 20, seen.height - readout.offsetHeight)) + "px";
    for (const [key, value] of [["x1", across], ["x2", across], ["y1", top], ["y2", top + height]]) line.setAttribute(key, value * FINE);
    line.setAttribute("visibility", "visible");
  };
  const down = (event) => {
    const [left, top, width, height] = view.frame;
    const { x, y } = pointer(event);
    const isInside = x >= left && x <= left + width && y >= top && y <= top + height;
    if (event.pointerType === "touch" || event.button !== 0 || !isInside) return;
    event.preventDefault();
    leave();
    start = x;
    view.svg.setPointerCapture(event.pointerId);
  };
  const up = (event) => {
    if (start === null) return;
    const { x } = pointer(event), from = start;
    start = null;
    selection.setAttribute("visibility", "hidden");
    if (Math.abs(x - from) > 6) zoom(valueAt(from), valueAt(x));
  };
  const press = (event) => {
    const [low, high] = ranges.x, size = high - low;
    const steps = { "+": [0.25, -0.25], "-": [-0.5, 0.5], ArrowLeft: [-0.25, -0.25], ArrowRight: [0.25, 0.25] }[event.key];
    if (event.key === "0") zoom(...whole.x);
    else if (steps && !(isWhole() && event.key !== "+")) {
      let [from, to] = [low + steps[0] * size, high + steps[1] * size];
      const shift = Math.max(0, whole.x[0] - from) - Math.max(0, to - whole.x[1]);
      if (event.key.startsWith("Arrow")) [from, to] = [from + shift, to + shift];
      zoom(from, to);
    } else return;
    event.preventDefault();
    view.svg.focus();
  };
  const heard = new WeakSet();
  const listen = (svg) => {
    if (heard.has(svg)) return;
    heard.add(svg);
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("pointerleave", leave);
    svg.addEventListener("pointermove", move);
    svg.addEventListener("pointerdown", down);
    svg.addEventListener("pointerup", up);
    svg.addEventListener("dblclick", () => zoom(...whole.x));
    svg.addEventListener("keydown", press);
  };
  // the keys of the static legend are buttons as well: the first part of each has the focus
  const seen = new Set();
  for (const key of still.querySelectorAll(".key")) {
    const index = Number(key.dataset.series);
    key.addEventListener("click", () => toggle(index));
    if (seen.has(index)) continue;
    seen.add(index);
    for (const [name, value] of [["tabindex", "0"], ["role", "button"], ["aria-label", `show or hide ${chart.series[index].label}`]]) key.setAttribute(name, value);
    key.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      event.stopPropagation();
      toggle(index);
    });
  }
  return show;
}

// A picture as wide as a narrow screen: letters as large as on a wide one where they have room; those that would cover others
// are left out, except where a picture has many, which then goes on to the right. The readings of a moving view stand below it.
const LETTERS = 9, CROWD = 0.4, FEW = 2, OVER = 9;
function fitted(box) {
  const svg = box.querySelector("svg"), texts = [...svg.querySelectorAll("text")].filter((text) => !text.closest(".reading"));
  const plain = texts.map((text) => text.getAttribute("font-size"));
  const restore = () => texts.forEach((text, index) => {
    if (plain[index] !== null) text.setAttribute("font-size", plain[index]);
    text.style.display = "";
  });
  box.restoreLetters = restore;
  const covers = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1 && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 0.25 * Math.min(a.height, b.height);
  return () => {
    box.classList.remove("fitted");
    restore();
    if (box.clientWidth === 0 || box.clientWidth >= NARROW) return;
    box.classList.add("fitted");
    texts.forEach((text, index) => {
      const { a, b } = text.getScreenCTM();
      text.setAttribute("font-size", Math.max(Number(plain[index]), LETTERS / Math.hypot(a, b)));
    });
    const room = svg.getBoundingClientRect(), kept = [];
    let left = 0;
    for (const text of texts) {
      const own = text.getBoundingClientRect();
      const isOutside = own.left < room.left - 1 || own.right > room.right + 1 || own.top < room.top - OVER || own.bottom > room.bottom + OVER;
      if (isOutside || kept.some((other) => covers(own, other))) { text.style.display = "none"; left++; } else kept.push(own);
    }
    const most = Math.max(FEW, CROWD * texts.length);
    if (left > most && !box.classList.contains("animation")) { box.classList.remove("fitted"); restore(); }
  };
}

// On a narrow screen the parts after the first two are folded, and of long tables the first rows are shown, so that a reader
// reaches the end.
const OPEN = 2, LONG = 12;
const parts = [...document.querySelectorAll("main details")];
const open = (address) => {
  const target = address.length > 1 && document.getElementById(address.slice(1));
  if (target && target.querySelector("details")) target.querySelector("details").open = true;
};
const isNarrow = () => document.documentElement.clientWidth < NARROW;
if (isNarrow()) parts.slice(OPEN).forEach((part) => { part.open = false; });
document.querySelector("nav").addEventListener("click", (event) => event.target.closest("a") && open(event.target.closest("a").hash));
addEventListener("hashchange", () => open(location.hash));
open(location.hash);
for (const table of document.querySelectorAll("section + section .stacked")) {
  const count = table.tBodies[0].rows.length;
  if (count <= LONG) continue;
  const rest = element("button", { type: "button", className: "rest" });
  const cut = (isCut) => {
    table.classList.toggle("cut", isCut);
    rest.textContent = isCut ? `All ${count} rows` : "Fewer rows";
  };
  rest.addEventListener("click", () => cut(!table.classList.contains("cut")));
  cut(true);
  table.after(rest);
}

const charts = [];
const add = (box, show) => charts.push({ box, show });
const showAll = () => charts.forEach(({ show }) => show());
document.querySelectorAll("figure").forEach((figure, index) => {
  const box = figure.querySelector(".picture");
  if (box.classList.contains("chart")) return add(box, liveChart(box, index + 1));
  if (!box.classList.contains("animation")) {
    const picture = element("button", { type: "button", textContent: "Picture (SVG)" });
    picture.addEventListener("click", () => {
      box.restoreLetters();
      saveSvg(box.querySelector("svg"), `${NAME}-figure-${index + 1}.svg`);
      showAll();
    });
    box.after(element("div", { className: "tools" }, picture));
  }
  add(box, fitted(box));
});
showAll();
// figures have no size while their part is folded
for (const part of parts) part.addEventListener("toggle", () => part.open && charts.forEach(({ box, show }) => part.contains(box) && show()));
let folded = [];
addEventListener("beforeprint", () => {
  folded = parts.filter((part) => !part.open);
  folded.forEach((part) => { part.open = true; });
  document.querySelectorAll(".fitted").forEach((box) => box.restoreLetters());
});
addEventListener("afterprint", () => {
  folded.forEach((part) => { part.open = false; });
  showAll();
});
let waiting = 0;
addEventListener("resize", () => {
  clearTimeout(waiting);
  waiting = setTimeout(showAll, 150);
});
