// Animations: a button, a slider, and interpolation between the recorded times. Without scripts one frame is shown.
for (const source of document.querySelectorAll(".animation > script")) {
  const box = source.parentElement;
  const svg = box.querySelector("svg");
  const data = JSON.parse(source.textContent);
  const time = decode(data.time);
  const tracks = data.tracks.map((track) => {
    if (track.v) return { ...track, v: decode(track.v) };
    return { ...track, x: decode(track.x), y: track.a === "points" ? track.y.map(decode) : decode(track.y) };
  });
  const nodes = tracks.map((track) => svg.querySelector(`[data-m="${track.e}"]`));
  const begin = time[0], end = time[time.length - 1];
  const button = document.createElement("button");
  const slider = document.createElement("input");
  const label = document.createElement("span");
  const bar = document.createElement("div");
  Object.assign(slider, { type: "range", min: begin, max: end, step: "any" });
  slider.setAttribute("aria-label", "time");
  bar.className = "control";
  bar.append(button, slider, label);
  box.append(bar);
  // the numbers once more as text, for narrow screens
  const list = element("dl", { className: "readings" });
  const readings = [...svg.querySelectorAll(".reading")].map((group) => {
    const [name, value] = group.querySelectorAll("text");
    const own = element("dd", {});
    list.append(element("dt", { textContent: name.textContent }), own);
    return [value, own];
  });
  bar.before(list);

  const show = (now) => {
    let low = 0, high = time.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle] <= now) low = middle; else high = middle;
    }
    const fraction = Math.min(1, Math.max(0, (now - time[low]) / (time[high] - time[low])));
    const mix = (values) => values[low] + fraction * (values[high] - values[low]);
    tracks.forEach((track, index) => {
      const node = nodes[index];
      if (track.a === "transform") node.setAttribute("transform", `translate(${mix(track.x)} ${mix(track.y)})`);
      else if (track.a === "points") node.setAttribute("points", track.x.map((x, k) => `${x},${mix(track.y[k]).toFixed(1)}`).join(" "));
      else if (track.a === "text") node.textContent = mix(track.v).toFixed(track.d);
      else node.setAttribute(track.a, mix(track.v));
    });
    for (const [value, own] of readings) own.textContent = value.textContent;
    slider.value = now;
    label.textContent = now.toFixed(2) + " s";
  };

  let now = begin, last = null;
  const step = (stamp) => {
    if (last === null) return;
    now += (stamp - last) / 1000;
    last = stamp;
    if (now >= end) { now = end; stop(); }
    show(now);
    if (last !== null) requestAnimationFrame(step);
  };
  const stop = () => { last = null; button.textContent = "Play"; };
  const play = () => {
    if (now >= end) now = begin;
    button.textContent = "Pause";
    requestAnimationFrame((stamp) => { last = stamp; step(stamp); });
  };
  button.type = "button";
  button.addEventListener("click", () => (last === null ? play() : stop()));
  slider.addEventListener("input", () => { stop(); now = Number(slider.value); show(now); });
  stop();
  now = Number(source.dataset.still);
  show(now);
}
