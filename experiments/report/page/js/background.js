// What was left out of the model, the reference, where the numbers come from, and the other
// pictures.
"use strict";
{
  const { element, byId, report, words } = qddotReport;

  function list(pairs) {
    return element(
      "dl",
      {},
      ...pairs.flatMap(([label, value]) => [
        element("dt", {}, label),
        element("dd", {}, String(value)),
      ]),
    );
  }

  function part(title, ...nodes) {
    return element("div", {}, element("h3", {}, title), ...nodes);
  }

  function leftOut({ unknowns_drawn: drawn, unknowns, findings, facts }) {
    const count =
      drawn === unknowns
        ? `All ${words.count(unknowns)} unknowns are integrated.`
        : `${words.count(unknowns)} of the ${words.count(drawn)} unknowns as drawn are integrated.`;
    const found = findings.map(({ name, what }) =>
      element("li", {}, element("b", {}, `${words.plain(name)}: `), what),
    );
    return part(
      "What was left out of the model",
      element("p", {}, count),
      found.length ? element("ul", {}, ...found) : null,
      facts.length ? list(facts) : null,
    );
  }

  function picture({ title, alt, src }) {
    return element(
      "figure",
      {},
      element("figcaption", {}, title),
      element("img", { src, alt, loading: "lazy" }),
    );
  }

  /** Writes the section. */
  qddotReport.drawBackground = () => {
    const parts = element("div", { class: "behind" });
    if (report.left_out) parts.append(leftOut(report.left_out));
    if (report.reference.length) parts.append(part("The reference", list(report.reference)));
    if (report.provenance.length)
      parts.append(part("Where the numbers come from", list(report.provenance)));
    const commands = report.command.map(qddotReport.commandLine);
    byId("background-parts").append(
      parts,
      element("h3", {}, "To make this page again"),
      ...commands,
      ...report.pictures.map(picture),
    );
    byId("background").hidden = false;
    byId("footer").append(
      "Made by qddot. This file holds everything that it shows and asks nobody for anything.",
    );
  };
}
