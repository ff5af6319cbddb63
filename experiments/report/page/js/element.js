// Elements of the page. All words go in as text, never as HTML: names come from files of others.

const SVG = "http://www.w3.org/2000/svg";
const HTML = "http://www.w3.org/1999/xhtml";

const isAttributes = (value) => value && Object.getPrototypeOf(value) === Object.prototype;

/** A new element of a kind such as "p.quiet". Attributes may follow, in which a function listens to
    the event of that name; then come children and nested lists of them, of which null and false are
    none.
 */
export function element(kind, ...children) {
  const [tag, ...classes] = kind.split(".");
  const node = document.createElementNS(["svg", "path"].includes(tag) ? SVG : HTML, tag);
  if (classes.length) node.setAttribute("class", classes.join(" "));
  for (const [name, value] of Object.entries(isAttributes(children[0]) ? children.shift() : {})) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") node.addEventListener(name, value);
    // A part of the data that is an object, in place of a text, must not become a listener.
    else if (!name.startsWith("on")) node.setAttribute(name, value === true ? "" : value);
  }
  const is = (child) => child !== null && child !== undefined && child !== false;
  node.append(...children.flat(Infinity).filter(is));
  return node;
}

/** The element of the template with this id. */
export const byId = (id) => document.getElementById(id);

/** A list of terms and their values. */
export const definitions = (pairs) =>
  element(
    "dl",
    pairs.map(([term, value]) => element("div", element("dt", term), element("dd", String(value)))),
  );

/** A button with words. */
export const button = (text, click, attributes = {}) =>
  element("button", { type: "button", click, ...attributes }, text);

/** The options of a menu, from pairs of a value and its words. */
export const options = (pairs) => pairs.map(([value, text]) => element("option", { value }, text));

/** A line of a shell with a button that copies it. */
export function commandLine(line) {
  const code = element("code", line);
  async function copyLine({ target }) {
    try {
      await navigator.clipboard.writeText(line);
      target.textContent = "Copied";
    } catch {
      // A browser that keeps pages on disk from the clipboard lets the reader copy the selection.
      getSelection().selectAllChildren(code);
      target.textContent = "Selected";
    }
    setTimeout(() => (target.textContent = "Copy"), 1500);
  }
  return element("div.command", code, button("Copy", copyLine, { "aria-label": `Copy: ${line}` }));
}
