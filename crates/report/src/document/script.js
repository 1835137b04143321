"use strict";
// Display of values under the pointer, and series switched on and off by their legend. Without scripts the charts are static.
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
for (const source of document.querySelectorAll('.chart > script')) {
  const box = source.parentElement;
  const svg = box.querySelector("svg");
  const chart = JSON.parse(source.textContent);
  const [left, top, width, height] = chart.frame;
  const places = chart.places.map(decode);
  for (const series of chart.series) {
    const values = decode(series.y);
    series.points = places[series.x].map((x, index) => [x, values[index]]);
  }
  const hidden = new Set();
  const fine = 10;

  const unit = (axis, value) => {
    const [low, high] = axis.range;
    const u = axis.log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
    return axis.flip ? 1 - u : u;
  };
  const place = ([x, y]) => [left + width * unit(chart.x, x), top + height * (1 - unit(chart.y, y))];
  const text = (value, axis) => {
    const size = Math.abs(value);
    const digits = size !== 0 && (size < 1e-4 || size >= 1e7) ? value.toExponential(4) : String(Number(value.toPrecision(6)));
    return axis.unit ? digits + " " + axis.unit : digits;
  };

  box.classList.add("live");
  for (const key of svg.querySelectorAll(".key")) {
    key.addEventListener("click", () => {
      const index = key.dataset.series;
      const off = !hidden.has(index);
      off ? hidden.add(index) : hidden.delete(index);
      for (const part of svg.querySelectorAll(`[data-series="${index}"]`)) {
        if (part.classList.contains("key")) part.classList.toggle("off", off);
        else part.style.display = off ? "none" : "";
      }
    });
  }

  const line = document.createElementNS(svg.namespaceURI, "line");
  for (const [name, value] of [["y1", top * fine], ["y2", (top + height) * fine], ["stroke", "#888888"], ["stroke-width", 8], ["visibility", "hidden"]]) {
    line.setAttribute(name, value);
  }
  svg.append(line);
  const readout = document.createElement("div");
  readout.className = "readout";
  readout.hidden = true;
  box.append(readout);

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
  const leave = () => {
    readout.hidden = true;
    line.setAttribute("visibility", "hidden");
  };
  svg.addEventListener("pointerleave", leave);
  svg.addEventListener("pointermove", (event) => {
    const seen = svg.getBoundingClientRect();
    const scale = seen.width / (svg.viewBox.baseVal.width / fine);
    const x = (event.clientX - seen.left) / scale, y = (event.clientY - seen.top) / scale;
    if (x < left || x > left + width || y < top || y > top + height) return leave();
    const rows = [];
    let first = null;
    chart.series.forEach((series, index) => {
      const point = hidden.has(String(index)) ? null : nearest(series.points, x, y);
      if (!point || Math.abs(place(point)[0] - x) > 12) return;
      if (!first || Math.abs(place(point)[0] - x) < Math.abs(place(first)[0] - x)) first = point;
      rows.push(`${series.label}: ${text(point[1], chart.y)}`);
    });
    if (!first) return leave();
    rows.unshift(`${chart.x.label}: ${text(first[0], chart.x)}`);
    readout.replaceChildren(...rows.map((row) => Object.assign(document.createElement("div"), { textContent: row })));
    readout.hidden = false;
    const across = place(first)[0];
    const flip = across * scale + 16 + readout.offsetWidth > seen.width;
    readout.style.left = (flip ? across * scale - 12 - readout.offsetWidth : across * scale + 12) + "px";
    readout.style.top = Math.max(0, Math.min(y * scale - 20, seen.height - readout.offsetHeight)) + "px";
    line.setAttribute("x1", across * fine);
    line.setAttribute("x2", across * fine);
    line.setAttribute("visibility", "visible");
  });
}
