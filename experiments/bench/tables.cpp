#include "experiments/bench/tables.hpp"

#include <cstdio>
#include <limits>

#include <fmt/format.h>

namespace qddot::bench {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

const char* reduced_name(bool smallest) { return smallest ? "all" : "pins"; }

std::string ratio_in_words(const Ratio& ratio) {
  if (!ratio.is_known()) return "-";
  const int digits = ratio.ratio < 10 ? 1 : 0;
  return fmt::format("{}{:.{}f}", ratio.is_bound ? "> " : "", ratio.ratio, digits);
}

// A column of ratios.csv that shows a member of one of the ratio's two runs.
template <class Member>
auto of_run(const Measured* Ratio::*run, Member Measured::*member, Member missing) {
  return [=](const RatioRow& r) { return r.ratio.*run ? r.ratio.*run->*member : missing; };
}

// A column of same_steps.csv that is empty unless both runs reached the end.
template <class Value>
auto if_good(const Value& value) {
  return [=](const SameStepsRow& r) { return r.same.is_good() ? value(r.same) : nothing; };
}

double springs(const SameSteps& same) { return static_cast<double>(same.springs); }

}  // namespace

const Columns<PointRow>& point_columns() {
  using Row = const PointRow&;
  static const Columns<PointRow> all = {
      {"scene", [](Row r) { return r.scene; }},
      {"until", [](Row r) { return r.until; }},
      {"side", [](Row r) { return r.ladder.is_ours ? "ours" : "peer"; }},
      {"solver", [](Row r) { return r.point.solver; }},
      {"force", [](Row r) { return r.point.force; }},
      {"reduced", [](Row r) { return reduced_name(r.ladder.is_smallest); }},
      {"unknowns", [](Row r) { return r.point.unknowns; }},
      {"knob", [](Row r) { return knob_name(r.point.knob); }},
      {"value", [](Row r) { return r.point.value; }},
      {"outcome", [](Row r) { return name(r.point.outcome); }},
      {"error_position", [](Row r) { return r.point.is_good() ? r.point.error : nothing; }},
      {"time_s", [](Row r) { return r.point.seconds; }},
      {"timed_runs", [](Row r) { return r.point.timed; }},
      {"steps", [](Row r) { return r.point.steps; }},
      {"force_evaluations", [](Row r) { return r.point.force_evaluations; }}};
  return all;
}

const Columns<RatioRow>& ratio_columns() {
  using Row = const RatioRow&;
  static const Columns<RatioRow> all = {
      {"scene", [](Row r) { return r.scene; }},
      {"until", [](Row r) { return r.until; }},
      {"reduced", [](Row r) { return reduced_name(r.is_smallest); }},
      {"accuracy", [](Row r) { return r.ratio.accuracy; }},
      {"peer", [](Row r) { return r.ratio.peer; }},
      {"force", [](Row r) { return r.ratio.force; }},
      {"ratio", [](Row r) { return r.ratio.is_known() ? r.ratio.ratio : nothing; }},
      {"is_at_least", [](Row r) { return r.ratio.is_bound ? 1 : 0; }},
      {"peer_solver", of_run<std::string>(&Ratio::theirs, &Measured::solver, {})},
      {"peer_time_s", of_run(&Ratio::theirs, &Measured::seconds, nothing)},
      {"peer_error", of_run(&Ratio::theirs, &Measured::error, nothing)},
      {"method", of_run<std::string>(&Ratio::ours, &Measured::solver, {})},
      {"time_s", of_run(&Ratio::ours, &Measured::seconds, nothing)},
      {"error", of_run(&Ratio::ours, &Measured::error, nothing)}};
  return all;
}

const Columns<SameStepsRow>& same_steps_columns() {
  using Row = const SameStepsRow&;
  using Same = const SameSteps&;
  static const Columns<SameStepsRow> all = {
      {"scene", [](Row r) { return r.scene; }},
      {"until", [](Row r) { return r.until; }},
      {"peer", [](Row r) { return r.same.solver; }},
      {"method", [](Row r) { return r.same.method; }},
      {"reduced", [](Row r) { return reduced_name(r.same.is_smallest); }},
      {"unknowns", [](Row r) { return r.same.unknowns; }},
      {"springs", [](Row r) { return r.same.springs; }},
      {"step_size", [](Row r) { return r.same.step_size; }},
      {"steps", [](Row r) { return r.same.steps; }},
      {"peer_outcome", [](Row r) { return name(r.same.peer_outcome); }},
      {"outcome", [](Row r) { return name(r.same.outcome); }},
      {"peer_step_s", if_good([](Same s) { return s.peer_step; })},
      {"step_s", if_good([](Same s) { return s.step; })},
      {"peer_springs_per_s", if_good([](Same s) { return springs(s) / s.peer_step; })},
      {"springs_per_s", if_good([](Same s) { return springs(s) / s.step; })},
      {"ratio", if_good([](Same s) { return s.peer_step / s.step; })},
      {"position_difference", if_good([](Same s) { return s.difference; })},
      {"distance", if_good([](Same s) { return s.distance; })}};
  return all;
}

void print_same_steps(const SameStepsRow& row) {
  const SameSteps& s = row.same;
  fmt::print("{}, {:g} s, {} steps of {} and of {} ({} unknowns): ", row.scene, row.until, s.steps,
             s.solver, s.method, s.unknowns);
  if (!s.is_good()) {
    fmt::print("{} and {}\n", name(s.peer_outcome), name(s.outcome));
    return;
  }
  fmt::print(
      "{:.3g} and {:.3g} us a step, {:.3g} and {:.3g} million springs/s, ratio {:.3g}; at the end "
      "they are {:.1e} m apart, {:.1e} of the motion\n",
      1e6 * s.peer_step, 1e6 * s.step, 1e-6 * springs(s) / s.peer_step, 1e-6 * springs(s) / s.step,
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
