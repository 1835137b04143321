// Collects what a reader of the page would stumble over. Chromium's narrowest window is 500 pixels wide, so that the page
// may be in a frame of another one, which receives what is found.
const seen = (element) => {
  const box = element.getBoundingClientRect();
  return box.width > 0 && box.height > 0 && getComputedStyle(element).visibility !== "hidden";
};
const found = { failed: window.failed, overlaps: [], beyond: [], faint: [], unlabelled: 0, pictures: 0, zooms: false };
// the page as it opens: how long it is, how many of its parts are folded, and whether it goes on to the right
const page = document.documentElement;
const parts = [...document.querySelectorAll("main details")];
found.height = page.scrollHeight;
found.folded = parts.filter((part) => !part.open).length;
found.parts = parts.length;
const last = [...document.querySelectorAll("nav a")].pop();
last.click();
found.opens = parts[parts.length - 1].open;
parts.forEach((part) => { part.open = true; });
document.querySelectorAll(".cut + .rest").forEach((button) => button.click());
// parts that were folded are drawn when they have opened
setTimeout(() => {
  const said = (element) => element.textContent.trim().slice(0, 40);
  const cover = (texts, where) => {
    const boxes = texts.filter(seen).map((text) => [text, text.getBoundingClientRect()]);
    boxes.forEach(([one, a], i) => {
      for (const [other, b] of boxes.slice(i + 1)) {
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        // lines of letters have room above and below: a third of their height is theirs
        if (across > 1 && down > 0.34 * Math.min(a.height, b.height)) found.overlaps.push(`${where}: ${said(one)} / ${said(other)}`);
      }
    });
  };
  for (const svg of document.querySelectorAll(".picture > svg")) {
    if (!seen(svg)) continue;
    found.pictures += 1;
    const label = document.getElementById(svg.getAttribute("aria-labelledby"));
    if (!label || !said(label)) found.unlabelled += 1;
    cover([...svg.querySelectorAll("text")], label ? said(label) : "figure");
  }
  cover([...document.querySelectorAll("nav a")], "contents");
  for (const table of document.querySelectorAll("table")) cover([...table.querySelectorAll("th, td")], "table");
  const width = document.documentElement.clientWidth;
  for (const element of document.querySelectorAll("h1, h2, p, table, figcaption, .tools, .legend, nav")) {
    if (seen(element) && element.getBoundingClientRect().right > width + 1) found.beyond.push(said(element));
  }
  // on a narrow screen no picture is wider than its place
  found.sideways = [...document.querySelectorAll(".picture")].filter((box) => seen(box) && box.scrollWidth > box.clientWidth + 1).map((box) => said(box.parentElement.querySelector("figcaption")));
  // letters of pictures are neither huge nor too small to read
  found.letters = [...document.querySelectorAll(".picture svg text")].filter(seen).filter((text) => { const { a, b } = text.getScreenCTM(); const size = Math.hypot(a, b) * Number(text.getAttribute("font-size")); return size < window.letters || size > 20; }).map(said);
  const light = (text) => {
    const [r, g, b] = text.match(/[\d.]+/g).map((part) => { const c = part / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const ground = (element) => {
    for (let at = element; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (!/, 0\)$/.test(colour) && colour !== "transparent") return light(colour);
    }
    return 1;
  };
  for (const element of document.querySelectorAll("p, a, th, td, caption, figcaption, button, footer, .unit")) {
    if (!seen(element) || !said(element)) continue;
    const [one, other] = [light(getComputedStyle(element).color), ground(element)];
    const contrast = (Math.max(one, other) + 0.05) / (Math.min(one, other) + 0.05);
    if (contrast < 4.5) found.faint.push(`${said(element)}: ${contrast.toFixed(1)}`);
  }
  // the key of a series has the colour of its line
  const keys = [...document.querySelectorAll(".swatch")];
  const filter = (element) => getComputedStyle(element).filter;
  found.keys = keys.every((key) => filter(key) === filter(document.querySelector(".picture > svg")));
  found.dark = matchMedia("(prefers-color-scheme: dark)").matches;
  const chart = document.querySelector(".chart.live");
  if (chart) {
    const press = (key) => [...chart.querySelectorAll("svg")].filter(seen)[0].dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
    const labels = () => [...[...chart.querySelectorAll("svg")].filter(seen)[0].querySelectorAll("text")].map(said).join();
    const before = labels();
    press("+");
    const after = labels();
    press("0");
    found.zooms = after !== before && labels() === before;
  }
  found.scrolls = page.scrollWidth > page.clientWidth;
  const text = "FOUND" + JSON.stringify(found) + "FOUND";
  if (parent === window) document.body.append(text);
  else parent.postMessage(text, "*");
}, 300);
