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

double springs(const SameSteps& same) { return static_cast<double>(same.springs); }

// Prints it for people.
void print_same_steps(const std::string& scene, double until, const SameSteps& s) {
  fmt::print("{}, {:g} s, {} steps of {} and of {} ({} unknowns): ", scene, until, s.steps,
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

// Prints ratios for people: a line for each peer, a column for each accuracy.
void print_ratios(const std::vector<Ratio>& ratios, const std::string& heading) {
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

// Ratios are of all points of a scene.
std::vector<Ratio> ratios_of(const Comparison& c, bool smallest) {
  return c.is_complete ? ratios(c.ladders, smallest, accuracies) : std::vector<Ratio>();
}

}  // namespace

void print(const Comparison& c) {
  const std::string& scene = c.drawn.name;
  for (const SameSteps& same : c.same_steps) print_same_steps(scene, c.until, same);
  for (const bool smallest : {true, false}) {
    print_ratios(
        ratios_of(c, smallest),
        fmt::format("{}, {:g} s: time of a peer ({} unknowns) over ours ({} unknowns)", scene,
                    c.until, c.unknowns, smallest ? c.fewest_unknowns : c.unknowns));
  }
}

void add_rows(const Comparison& c, CsvFile& points, CsvFile& all_ratios, CsvFile& same_steps) {
  const std::string& scene = c.drawn.name;
  for (const PeerLadder& ladder : c.ladders) {
    for (const Measured& m : ladder.points) {
      points.row(scene, c.until, ladder.is_ours ? "ours" : "peer", m.solver, m.force,
                 reduced_name(ladder.is_smallest), m.unknowns, knob_name(m.knob), m.value,
                 name(m.outcome), m.is_good() ? m.error : nothing, m.seconds, m.timed, m.steps,
                 m.force_evaluations);
    }
  }
  for (const SameSteps& s : c.same_steps) {
    const auto known = [&](double x) { return s.is_good() ? x : nothing; };
    same_steps.row(scene, c.until, s.solver, s.method, reduced_name(s.is_smallest), s.unknowns,
                   s.springs, s.step_size, s.steps, name(s.peer_outcome), name(s.outcome),
                   known(s.peer_step), known(s.step), known(springs(s) / s.peer_step),
                   known(springs(s) / s.step), known(s.peer_step / s.step), known(s.difference),
                   known(s.distance));
  }
  Measured missing;
  missing.error = missing.seconds = nothing;
  for (const bool smallest : {true, false}) {
    for (const Ratio& r : ratios_of(c, smallest)) {
      const Measured& theirs = r.theirs ? *r.theirs : missing;
      const Measured& ours = r.ours ? *r.ours : missing;
      all_ratios.row(scene, c.until, reduced_name(smallest), r.accuracy, r.peer, r.force,
                     r.is_known() ? r.ratio : nothing, r.is_bound ? 1 : 0, theirs.solver,
                     theirs.seconds, theirs.error, ours.solver, ours.seconds, ours.error);
    }
  }
}

}  // namespace qddot::bench
