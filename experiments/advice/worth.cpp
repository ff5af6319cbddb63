#include "experiments/advice/worth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "qddot/measure/motion/timing.hpp"

namespace qddot::judged_advice {
namespace {

// Total times count from there on [s]: below, what is found costs no one anything.
constexpr double worth_counting = 0.02;
constexpr double always_allowed = 0.5;  // of advise() [s]

constexpr double of_no_case = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double quantile(std::vector<double> values, double p) {
  if (values.empty()) return of_no_case;
  std::ranges::sort(values);
  const auto place = static_cast<std::size_t>(std::ceil(p * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(place, 1, values.size()) - 1];
}

std::vector<Figure> worth_of(const std::vector<CaseResult>& results) {
  std::vector<Figure> figures;
  using Holds = std::function<bool(const CaseResult&)>;
  using Value = std::function<double(const CaseResult&)>;
  const auto values = [&](const Holds& counts, const Value& value) {
    std::vector<double> all;
    for (const CaseResult& result : results) {
      if (counts(result)) all.push_back(value(result));
    }
    return all;
  };
  const auto share = [&](const char* name, const char* meaning, const Holds& counts,
                         const Holds& holds) {
    const auto all = values(counts, [&](const CaseResult& r) { return holds(r) ? 1.0 : 0.0; });
    double sum = 0;
    for (const double x : all) sum += x;
    const double count = static_cast<double>(all.size());
    figures.push_back(
        {name, meaning, all.empty() ? of_no_case : sum / count, static_cast<int>(all.size())});
  };
  const auto spread = [&](const std::string& name, const std::string& meaning, const Holds& counts,
                          const Value& value) {
    const auto all = values(counts, value);
    const int count = static_cast<int>(all.size());
    figures.push_back({name + "_median", meaning + ", median",
                       all.empty() ? of_no_case : measure::median(all), count});
    figures.push_back(
        {name + "_90", meaning + ", of nine in ten at most", quantile(all, 0.9), count});
  };
  const Holds judged = &CaseResult::is_judged, has_error = &CaseResult::has_error;
  const Holds compared = [](const CaseResult& r) { return r.is_judged() && r.has_best(); };
  const Holds large = [](const CaseResult& r) {
    return r.is_judged() && r.has_best() && r.best_seconds >= worth_counting;
  };
  const auto advised = [](const CaseResult& r) { return !r.advised.empty(); };
  share("claimed", "cases that had a run in hindsight, and an answer", &CaseResult::has_best,
        [](const CaseResult& r) { return r.is_claimed; });
  // The error of the reference is counted in favour of the answer.
  share("within_accuracy", "answers with an error of at most the accuracy", judged,
        [](const CaseResult& r) { return r.error - r.certified <= r.accuracy; });
  share("within_bar", "answers with an error of at most the error bar", judged,
        [](const CaseResult& r) { return r.error - r.certified <= r.error_estimate; });
  share("advised_within_accuracy", "advised runs with an error of at most the accuracy",
        &CaseResult::is_advised,
        [](const CaseResult& r) { return r.advised_true_error - r.certified <= r.accuracy; });
  spread("bar_over_error", "error bar over error", has_error,
         [](const CaseResult& r) { return r.error_estimate / r.error; });
  spread("run_over_best", "time of the chosen run over that of the best in hindsight", compared,
         [](const CaseResult& r) { return r.run_seconds / r.best_seconds; });
  spread("total_over_best", "time of everything over that of the best, where that takes 20 ms",
         large, [](const CaseResult& r) { return r.total_seconds / r.best_seconds; });
  share("advice_in_time", "advice within 0.5 s or twice the run that it recommends", advised,
        [](const CaseResult& r) {
          return r.advice_seconds <= std::max(always_allowed, 2 * r.advised_seconds);
        });
  return figures;
}

}  // namespace qddot::judged_advice
