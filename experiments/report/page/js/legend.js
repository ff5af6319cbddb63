// The list of methods beside the chart: which are drawn strongly.
import { byId, element } from "./element.js";
import { swatch } from "./marks.js";
import { choose, familiesWithMethods, methods, onChoice, state } from "./report.js";

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

const groups = familiesWithMethods.map(familyGroup);

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
  byId("no-method").hidden = groups.some((group) => !group.hidden);
}

byId("method-list").append(...groups);
byId("method-search").addEventListener("input", search);
for (const [id, chosen] of [
  ["draw-strong", [...state.shown]],
  ["draw-all", [...methods.keys()]],
  ["draw-none", []],
])
  byId(id).addEventListener("click", () => show(chosen));
