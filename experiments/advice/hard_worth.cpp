#include "experiments/advice/hard_worth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "experiments/advice/true_motion.hpp"

namespace qddot::judged_advice {
namespace {

// The figures of the results that `which` names.
void add_figures(std::vector<Figure>& figures, const std::string& which,
                 const std::vector<const HardResult*>& results) {
  using Holds = std::function<bool(const HardResult&)>;
  const auto share = [&](const char* name, const char* meaning, const Holds& counts,
                         const Holds& holds) {
    int all = 0, held = 0;
    for (const HardResult* result : results) {
      if (!counts(*result)) continue;
      ++all;
      held += holds(*result) ? 1 : 0;
    }
    figures.push_back(
        {name, meaning,
         all > 0 ? static_cast<double>(held) / all : std::numeric_limits<double>::quiet_NaN(), all,
         which});
  };
  using R = HardResult;
  share("within_accuracy", "answers with an error of at most the accuracy", &R::is_judged,
        [](const R& r) { return r.is_within(r.accuracy); });
  share("within_bar", "answers with an error of at most the error bar", &R::is_judged,
        [](const R& r) { return r.is_within(r.error_estimate); });
  share("refused", "well-posed cases without an answer", &R::is_well_posed,
        [](const R& r) { return !r.is_claimed; });
  share(
      "refused_within_bar", "refusals that name an error bar, with an error of at most that",
      [](const R& r) {
        return r.is_well_posed() && !r.is_claimed && std::isfinite(r.error_estimate);
      },
      [](const R& r) { return r.is_within(r.error_estimate); });
  share("claimed_beyond_rounding",
        "cases that rounding makes impossible three times over, and a false answer",
        &R::is_beyond_rounding,
        [](const R& r) { return r.is_claimed && !(r.error <= r.accuracy); });
  share(
      "advised_within_accuracy", "advised runs with an error of at most the accuracy",
      [](const R& r) { return r.is_well_posed() && !r.advised.empty(); },
      [](const R& r) { return r.advised_error - r.conditioning <= r.accuracy; });
  share(
      "told_slack",
      "motions that end where a massless joint goes slack, and a refusal that says so",
      [](const R& r) { return r.left_out == goes_slack; },
      [](const R& r) { return !r.is_claimed && r.why.find("massless") != std::string::npos; });
  std::vector<double> widths, seconds;
  for (const HardResult* result : results) {
    seconds.push_back(result->seconds);
    if (result->is_judged() && result->error > 10 * result->conditioning)
      widths.push_back(result->error_estimate / result->error);
  }
  const auto spread = [&](const char* name, const char* meaning,
                          const std::vector<double>& values) {
    for (const double part : {0.5, 0.9}) {
      figures.push_back({fmt::format("{}_{:g}", name, 100 * part), meaning, quantile(values, part),
                         static_cast<int>(values.size()), which});
    }
  };
  spread("bar_over_error", "error bar over error, of that percentage at most", widths);
  spread("seconds", "time of an answer [s], of that percentage at most", seconds);
}

}  // namespace

std::vector<Figure> worth_of(const std::vector<HardResult>& results) {
  std::vector<Figure> figures;
  std::vector<std::string> kinds;
  const auto add = [&](const std::string& which, const std::function<bool(const HardResult&)>& is) {
    std::vector<const HardResult*> few;
    for (const HardResult& result : results) {
      if (is(result)) few.push_back(&result);
    }
    if (!few.empty()) add_figures(figures, which, few);
  };
  add("all", [](const HardResult&) { return true; });
  for (const char* of : {"positions", "path", "energy"})
    add(of, [&](const HardResult& r) { return r.of == of; });
  for (const HardResult& result : results) {
    if (std::ranges::find(kinds, result.kind) == kinds.end()) kinds.push_back(result.kind);
  }
  for (const std::string& kind : kinds)
    add(kind, [&](const HardResult& r) { return r.kind == kind; });
  return figures;
}

std::string in_columns(const std::vector<Figure>& figures) {
  std::string heads = fmt::format("{:<16}", ""), lines, of;
  for (const Figure& figure : figures) {
    if (figure.of == figures.front().of) heads += fmt::format(" {:>12.12}", figure.name);
    if (figure.of != of) lines += fmt::format("\n{:<16}", figure.of);
    of = figure.of;
    lines += fmt::format(" {:>7.3g}{:<5}", figure.value, fmt::format("/{}", figure.cases));
  }
  return heads + lines + "\n";
}

std::vector<std::string> lines_of(const std::vector<HardResult>& results, bool of_all) {
  std::vector<std::string> lines;
  for (const HardResult& r : results) {
    const char* what = !r.has_truth()                                    ? ""
                       : r.is_judged() && !r.is_within(r.accuracy)       ? "FALSE"
                       : r.is_judged() && !r.is_within(r.error_estimate) ? "bar"
                       : r.is_well_posed() && !r.is_claimed              ? "refused"
                       : r.is_beyond_rounding() && r.is_claimed && !(r.error <= r.accuracy)
                           ? "beyond"
                           : "";
    if (!*what && !of_all) continue;
    lines.push_back(
        fmt::format("{:<8.0f} {:<15} {:<9} {:<8} A {:.1e}  bar {:.1e}  error {:.1e}  rounding "
                    "{:.1e}  {} {:.4g}{}{}",
                    r.number, r.kind, r.of, what, r.accuracy, r.error_estimate, r.error,
                    r.conditioning, r.method, r.value, r.why.empty() ? "" : "  ", r.why));
  }
  return lines;
}

}  // namespace qddot::judged_advice
