#include "experiments/bench/ratio_table.hpp"

#include <cstdio>
#include <limits>

namespace qddot::bench {
namespace {

const char* reduced_name(bool smallest) { return smallest ? "all" : "pins"; }

std::string ratio_in_words(const Ratio& ratio) {
  if (!ratio.is_known()) return "-";
  const int digits = ratio.ratio < 10 ? 1 : 0;
  return fmt::format("{}{:.{}f}", ratio.is_bound ? "> " : "", ratio.ratio, digits);
}

}  // namespace

std::vector<std::string> point_columns() {
  return {"scene",          "until",    "side",       "solver", "force",
          "reduced",        "unknowns", "knob",       "value",  "outcome",
          "error_position", "time_s",   "timed_runs", "steps",  "force_evaluations"};
}

void point_row(Csv& csv, const std::string& scene, double until, const Sweep& sweep,
               const Measured& p) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  csv.row(scene, until, sweep.is_ours ? "ours" : "peer", p.solver, p.force,
          reduced_name(sweep.is_smallest), p.unknowns, knob_name(p.knob), p.value, name(p.outcome),
          p.is_good() ? p.error : nothing, p.seconds, p.timed, p.steps, p.force_evaluations);
}

std::vector<std::string> ratio_columns() {
  return {"scene",       "until",       "reduced",     "accuracy",   "peer",   "force",  "ratio",
          "is_at_least", "peer_solver", "peer_time_s", "peer_error", "method", "time_s", "error"};
}

void ratio_row(Csv& csv, const std::string& scene, double until, bool smallest, const Ratio& r) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  csv.row(scene, until, reduced_name(smallest), r.accuracy, r.peer, r.force,
          r.is_known() ? r.ratio : nothing, r.is_bound ? 1 : 0, r.theirs ? r.theirs->solver : "",
          r.theirs ? r.theirs->seconds : nothing, r.theirs ? r.theirs->error : nothing,
          r.ours ? r.ours->solver : "", r.ours ? r.ours->seconds : nothing,
          r.ours ? r.ours->error : nothing);
}

std::vector<std::string> same_steps_columns() {
  return {"scene",
          "until",
          "peer",
          "method",
          "reduced",
          "unknowns",
          "springs",
          "step_size",
          "steps",
          "peer_outcome",
          "outcome",
          "peer_step_s",
          "step_s",
          "peer_springs_per_s",
          "springs_per_s",
          "ratio",
          "position_difference",
          "distance"};
}

void same_steps_row(Csv& csv, const std::string& scene, double until, const SameSteps& s) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const auto known = [&](double value) { return s.is_good() ? value : nothing; };
  const auto springs = static_cast<double>(s.springs);
  csv.row(scene, until, s.solver, s.method, reduced_name(s.is_smallest), s.unknowns, s.springs,
          s.step_size, s.steps, name(s.peer_outcome), name(s.outcome), known(s.peer_step),
          known(s.step), known(springs / s.peer_step), known(springs / s.step),
          known(s.peer_step / s.step), known(s.difference), known(s.distance));
}

void print_same_steps(const std::string& scene, double until, const SameSteps& s) {
  fmt::print("{}, {:g} s, {} steps of {} and of {} ({} unknowns): ", scene, until, s.steps,
             s.solver, s.method, s.unknowns);
  if (!s.is_good()) {
    fmt::print("{} and {}\n", name(s.peer_outcome), name(s.outcome));
    return;
  }
  const auto springs = static_cast<double>(s.springs);
  fmt::print(
      "{:.3g} and {:.3g} us a step, {:.3g} and {:.3g} million springs/s, ratio {:.3g}; at the end "
      "they are {:.1e} m apart, {:.1e} of the motion\n",
      1e6 * s.peer_step, 1e6 * s.step, 1e-6 * springs / s.peer_step, 1e-6 * springs / s.step,
      s.peer_step / s.step, s.distance, s.difference);
}

void print_ratios(const std::vector<Ratio>& ratios, const std::vector<double>& accuracies,
                  const std::string& heading) {
  fmt::print("{}\n{:<20} {:<8}", heading, "peer", "f");
  for (const double accuracy : accuracies) fmt::print(" {:>9.0e}", accuracy);
  const auto count = accuracies.size();
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    if (i % count == 0) fmt::print("\n{:<20} {:<8}", ratios[i].peer, ratios[i].force);
    fmt::print(" {:>9}", ratio_in_words(ratios[i]));
  }
  fmt::print("\n\n");
  std::fflush(stdout);  // the next scene takes minutes
}

}  // namespace qddot::bench
