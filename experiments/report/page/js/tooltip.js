// The words beside the pointer: a run's name, error, cost and counts.
import { chosenQuantity, visit } from "./choice.js";
import { byId, definitions, element } from "./element.js";
import { named } from "./marks.js";
import { countsOf, knobOf, methods, points } from "./report.js";
import { words } from "./words.js";

const MOST_COUNTS = 5;
const box = byId("tooltip");

function content(point) {
  const { axis, column } = chosenQuantity();
  const { line } = methods[points.method[point]];
  return [
    element("p", element("b", named(points.method[point])), ` at ${knobOf(point)}`),
    line ? element("p.quiet", line) : "",
    points.cause[point] ? element("p.bad", points.cause[point]) : "",
    definitions([
      [axis, words.number(points[column]?.[point])],
      ["time of a run", words.seconds(points.time_s[point])],
      ...countsOf(point).slice(0, MOST_COUNTS),
    ]),
  ];
}

// Shows the run beside a place of the window in px.
function show(point, x, y) {
  box.replaceChildren(...content(point));
  box.dataset.point = point;
  box.hidden = false;
  const { width, height } = box.getBoundingClientRect();
  const left = x + 16 + width > innerWidth ? x - 16 - width : x + 16;
  const top = y + 16 + height > innerHeight ? y - 16 - height : y + 16;
  box.style.transform = `translate(${Math.max(8, Math.min(left, innerWidth - width - 8))}px, ${Math.max(8, top)}px)`;
}

const hide = () => (box.hidden = true);
addEventListener("scroll", hide, { passive: true });

/** Lets the marks of one of Plotly's drawings show their run on hover and choose it on a click. */
export function listenToMarks(drawing) {
  const withRun = (act) => (event) => {
    const point = event.points?.map((mark) => mark.customdata).find(Number.isInteger);
    if (point !== undefined) act(point, event.event);
  };
  drawing.on(
    "plotly_hover",
    withRun((point, { clientX, clientY }) => show(point, clientX, clientY)),
  );
  drawing.on("plotly_unhover", hide);
  drawing.on(
    "plotly_click",
    withRun((point) => visit({ run: point })),
  );
}
