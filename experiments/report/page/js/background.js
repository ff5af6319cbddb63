// The end of the page: the parts of the model that were left out, the reference, the origin of the
// numbers, and the other pictures.
import { byId, commandLine, definitions, element } from "./element.js";
import { report } from "./report.js";
import { words } from "./words.js";

const part = (title, ...nodes) => element("div", element("h3", title), nodes);

function leftOut({ unknowns_drawn: drawn, unknowns, findings, facts }) {
  const which =
    drawn === unknowns
      ? `All ${words.count(unknowns)} unknowns`
      : `${words.count(unknowns)} of the ${words.count(drawn)} unknowns as drawn`;
  const found = findings.map(({ name, what }) =>
    element("li", element("b", `${words.plain(name)}: `), what),
  );
  return part(
    "What was left out of the model",
    element("p", `${which} are integrated.`),
    found.length > 0 && element("ul", found),
    facts.length > 0 && definitions(facts),
  );
}

byId("background-parts").append(
  element(
    "div.behind",
    report.left_out && leftOut(report.left_out),
    report.reference.length > 0 && part("The reference", definitions(report.reference)),
    report.provenance.length > 0 &&
      part("Where the numbers come from", definitions(report.provenance)),
  ),
  element("h3", "To make this page again"),
  ...report.command.map(commandLine),
  ...report.pictures.map(({ title, alt, src }) =>
    element("figure", element("figcaption", title), element("img", { src, alt, loading: "lazy" })),
  ),
);
byId("background").hidden = false;
