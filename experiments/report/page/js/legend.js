// The list of methods beside the chart: which are drawn strongly.
import { button, byId, element } from "./element.js";
import { swatch } from "./marks.js";
import { choose, families, methods, onChoice, state } from "./report.js";

const strong = [...state.shown];
const show = (chosen) => choose({ shown: new Set(chosen) });

function toggle(members, on) {
  const others = [...state.shown].filter((method) => !members.includes(method));
  show(on ? [...others, ...members] : others);
}

// A checkbox with words that switches some methods on and off.
function line(members, attributes, ...content) {
  const box = element("input", { type: "checkbox", change: () => toggle(members, box.checked) });
  const label = element("label", attributes, box, content);
  const update = () => {
    const on = members.filter((method) => state.shown.has(method)).length;
    box.checked = on === members.length;
    box.indeterminate = on > 0 && on < members.length;
    label.classList.toggle("off", on === 0);
  };
  onChoice(update);
  update();
  return label;
}

const methodLine = (method) =>
  line(
    [method],
    { title: methods[method].line, "data-method": method },
    swatch(method),
    element("span", methods[method].name),
  );

const familyGroup = ({ title, members }) =>
  element(
    "fieldset",
    element("legend", line(members, {}, element("span", title))),
    members.map(methodLine),
  );

const noHit = element("p.quiet", { role: "status", hidden: true }, "No method has it.");
const groups = families.map(familyGroup);

function search({ target }) {
  const wanted = target.value.trim().toLowerCase();
  for (const group of groups) {
    const labels = [...group.querySelectorAll("[data-method]")];
    for (const label of labels) {
      const { name, line: about } = methods[label.dataset.method];
      label.hidden = !`${name} ${about ?? ""}`.toLowerCase().includes(wanted);
    }
    group.hidden = labels.every((label) => label.hidden);
  }
  noHit.hidden = groups.some((group) => !group.hidden);
}

byId("legend").append(
  element("input", {
    type: "search",
    placeholder: "Find a method",
    "aria-label": "Find a method",
    input: search,
  }),
  element(
    "div.legend-buttons",
    { role: "group", "aria-label": "Draw strongly" },
    button("Strong", () => show(strong)),
    button("All", () => show(methods.keys())),
    button("None", () => show([])),
  ),
  element("div.legend-list", noHit, groups),
  element(
    "div.legend-key",
    element("span", "Strong: on the front, or the best of its family."),
    element("span", "Yellow line: the least cost at each accuracy."),
  ),
);
