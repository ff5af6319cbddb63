// The list of methods beside the chart: which are drawn strongly.
"use strict";
{
  const { element, byId, report, swatch } = qddotReport;
  const { methods, families } = report;
  const strong = methods.map((_, method) => method).filter((method) => methods[method].strong);
  const boxes = [];
  const familyBoxes = [];
  const noHit = element("p", { class: "quiet", role: "status", hidden: true }, "No method has it.");

  /** The methods that are drawn strongly. */
  qddotReport.shown = new Set(strong);

  function show(chosen) {
    qddotReport.shown = new Set(chosen);
    update();
    qddotReport.drawChart();
    qddotReport.drawFailures();
  }

  function update() {
    boxes.forEach(({ box, label }, method) => {
      box.checked = qddotReport.shown.has(method);
      label.classList.toggle("off", !box.checked);
    });
    for (const { box, members } of familyBoxes) {
      const on = members.filter((method) => qddotReport.shown.has(method)).length;
      box.checked = on === members.length;
      box.indeterminate = on > 0 && on < members.length;
    }
  }

  function toggle(members, on) {
    const chosen = new Set(qddotReport.shown);
    for (const method of members) on ? chosen.add(method) : chosen.delete(method);
    show(chosen);
  }

  function methodLine(method) {
    const box = element("input", { type: "checkbox", change: () => toggle([method], box.checked) });
    const label = element(
      "label",
      { title: methods[method].line, "data-method": method },
      box,
      swatch(method),
      element("span", {}, methods[method].name),
    );
    boxes[method] = { box, label };
    return label;
  }

  function familyGroup(family, members) {
    const box = element("input", { type: "checkbox", change: () => toggle(members, box.checked) });
    const head = element("label", {}, box, element("span", {}, families[family].title));
    const group = element("fieldset", {}, element("legend", {}, head), ...members.map(methodLine));
    familyBoxes.push({ box, members, group });
    return group;
  }

  function search(words) {
    const wanted = words.trim().toLowerCase();
    boxes.forEach(({ label }, method) => {
      const text = `${methods[method].name} ${methods[method].line ?? ""}`.toLowerCase();
      label.hidden = !text.includes(wanted);
    });
    for (const { group, members } of familyBoxes)
      group.hidden = members.every((method) => boxes[method].label.hidden);
    noHit.hidden = familyBoxes.some(({ group }) => !group.hidden);
  }

  /** Builds the list. */
  qddotReport.drawLegend = () => {
    const button = (words, chosen) =>
      element("button", { type: "button", click: () => show(chosen()) }, words);
    const groups = families
      .map((_, family) => ({
        family,
        members: methods
          .map((_, method) => method)
          .filter((method) => methods[method].family === family),
      }))
      .filter(({ members }) => members.length)
      .map(({ family, members }) => familyGroup(family, members));
    byId("legend").append(
      element("input", {
        type: "search",
        placeholder: "Find a method",
        "aria-label": "Find a method",
        input: (event) => search(event.target.value),
      }),
      element(
        "div",
        { class: "legend-buttons", role: "group", "aria-label": "Draw strongly" },
        button("Strong", () => strong),
        button("All", () => methods.keys()),
        button("None", () => []),
      ),
      element("div", { class: "legend-list" }, noHit, ...groups),
      element(
        "div",
        { class: "legend-key" },
        element("span", {}, "Strong: on the front, or the best of its family."),
        element("span", {}, "Yellow line: the least cost at each accuracy."),
      ),
    );
    update();
  };
}
