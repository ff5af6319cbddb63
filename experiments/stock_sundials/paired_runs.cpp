#include "experiments/stock_sundials/paired_runs.hpp"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::stock_sundials {
namespace {

// One method at one tolerance, run again and again.
class Runs {
 public:
  Runs(const Method& method, double rtol, const Subject& subject, double limit)
      : method_(method),
        scene_(subject.model),
        until_(subject.until),
        limit_(limit),
        options_(options_for(method, rtol, scene_)),
        integrator_(make_integrator(method, scene_.system(), options_)) {}

  // The seconds of one run, set-up left out.
  double once() {
    const Deadline deadline(limit_);
    state_ = scene_.initial();
    return seconds_of(
        [&] { summary_ = integrator_->advance(state_, until_, {}, deadline.token()); });
  }
  bool has_reached_end() const { return summary_.outcome == Outcome::reached_end; }

  // The outcome, error and counts of the last run.
  Way way(const Reference& reference) const {
    Way way{.outcome = summary_.outcome, .counts = summary_.counts};
    if (has_reached_end())
      way.error = errors_between(scene_, state_, reference.end, reference.energy, reference.scales)
                      .position;
    return way;
  }

  // The parts of a run that is slowed by clocks.
  std::array<double, 5> shares() {
    options_.timed = true;
    integrator_ = make_integrator(method_, scene_.system(), options_);
    const double all = once();
    const auto& [force, stiffness, factorization, solve] = summary_.seconds;
    std::array shares = {force / all, stiffness / all, factorization / all, solve / all, 1.0};
    for (std::size_t i = 0; i < 4; ++i) shares[4] -= shares[i];
    return shares;
  }

 private:
  const Method& method_;
  const Model& scene_;
  double until_, limit_;
  Options options_;
  std::unique_ptr<Integrator> integrator_;
  State state_;
  Summary summary_;
};

}  // namespace

std::vector<Pair> select_pairs(const std::vector<std::string>& names, const Subject& subject) {
  std::vector<Pair> pairs;
  for (const Method* method : select_methods(names, subject)) {
    const auto stock = std::ranges::find(methods(), method->name, &Method::stock_of);
    if (stock != methods().end()) {
      pairs.push_back({method, &*stock});
    } else if (!names.empty()) {
      std::vector<std::string> allowed;
      for (const Method& m : methods()) {
        if (!m.stock_of.empty()) allowed.push_back(m.stock_of);
      }
      throw InvalidInput(fmt::format("--methods: {} has no stock way beside it; allowed are {}",
                                     method->name, fmt::join(allowed, ", ")));
    }
  }
  return pairs;
}

PairedRuns paired_runs(const Subject& subject, const Pair& pair, double rtol,
                       const Reference& reference, const Effort& effort) {
  Runs structured(*pair.structured, rtol, subject, effort.seconds);
  Runs stock(*pair.stock, rtol, subject, effort.seconds);
  structured.once();
  stock.once();
  std::vector<double> structured_times, stock_times, ratios;
  const auto have_both = [&] { return structured.has_reached_end() && stock.has_reached_end(); };
  for (int i = 0; have_both() && i < effort.repeats; ++i) {
    structured_times.push_back(structured.once());
    stock_times.push_back(stock.once());
    ratios.push_back(stock_times.back() / structured_times.back());
  }
  PairedRuns runs{.scene = subject.drawn.name,
                  .method = pair.structured->name,
                  .rtol = rtol,
                  .structured = structured.way(reference),
                  .stock = stock.way(reference)};
  if (!runs.is_good()) return runs;
  runs.structured.seconds = median(structured_times);
  runs.stock.seconds = median(stock_times);
  runs.ratio = median(ratios);
  runs.structured.shares = structured.shares();
  runs.stock.shares = stock.shares();
  return runs;
}

}  // namespace qddot::stock_sundials
