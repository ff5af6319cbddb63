// Elements of the page. All words go in as text, never as HTML: names come from files of others.
"use strict";
{
  const SVG = "http://www.w3.org/2000/svg";

  function fill(node, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
      if (value === null || value === undefined || value === false) continue;
      if (typeof value === "function") node.addEventListener(name, value);
      else node.setAttribute(name, value === true ? "" : value);
    }
    node.append(...children.filter((child) => child !== null && child !== undefined));
    return node;
  }

  /** A new element; an attribute whose value is a function is a listener of the event of that name.
   */
  qddotReport.element = (tag, attributes = {}, ...children) =>
    fill(document.createElement(tag), attributes, children);

  /** The same for SVG's elements. */
  qddotReport.svgElement = (tag, attributes = {}, ...children) =>
    fill(document.createElementNS(SVG, tag), attributes, children);

  /** The element of the template with this id. */
  qddotReport.byId = (id) => document.getElementById(id);

  /** A line of a shell with a button that copies it. */
  qddotReport.commandLine = (words) => {
    const button = qddotReport.element(
      "button",
      { type: "button", "aria-label": `Copy: ${words}` },
      "Copy",
    );
    const code = qddotReport.element("code", {}, words);
    button.addEventListener("click", async () => {
      try {
        await navigator.clipboard.writeText(words);
        button.textContent = "Copied";
      } catch {
        // A browser that keeps pages on disk from the clipboard lets the reader copy the selection.
        getSelection().selectAllChildren(code);
        button.textContent = "Selected";
      }
      setTimeout(() => (button.textContent = "Copy"), 1500);
    });
    return qddotReport.element("div", { class: "command" }, code, button);
  };
}
