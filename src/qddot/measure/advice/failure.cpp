#include "qddot/measure/advice/failure.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "qddot/measure/motion/timing.hpp"

namespace qddot::inline measure {
namespace {

// Whether the motion itself is known to the accuracy, but not that it keeps its symmetry.
bool is_by_symmetry(const Conditioning& found, double accuracy) {
  return found.leaves_by > found.effect && found.effect <= accuracy;
}

// The last look [s] until which one rounding changes the motion by less than the accuracy.
double known_until(const Search& search, double accuracy) {
  double until = 0;
  for (const auto* differences : {&search.check().conditioning()->differences,
                                  &search.check().conditioning()->differences_left}) {
    std::size_t i = 0;
    while (i < differences->size() && (*differences)[i] <= accuracy) ++i;
    const double own = i == 0 ? 0 : search.runs().stage().times()[i - 1];
    if (differences->empty()) continue;
    until = until == 0 ? own : std::min(until, own);
  }
  return until;
}

std::string rounding_in_words(const Failure& failure, const Search& search, double accuracy) {
  const Conditioning& found = *search.check().conditioning();
  const double until = search.runs().stage().until(), known = known_until(search, accuracy);
  const std::string instead =
      known > 0 ? fmt::format("; up to t = {:.3g} s it can be reached", known) : "";
  if (search.runs().stage().of() == AccuracyOf::energy) {
    return fmt::format("rounding of the positions changes the energy by {:.1e} of the kinetic one",
                       found.effect);
  }
  if (is_by_symmetry(found, accuracy)) {
    return fmt::format(
        "rounding moves the drawn nodes out of their line, plane or mirror symmetry, by {:.1e} of "
        "the motion{}",
        found.leaves_by, instead);
  }
  if (failure.horizon <= until && failure.lyapunov > 0) {
    return fmt::format(
        "the motion is chaotic: from t = {:.3g} s on nobody knows its positions (errors grow by a "
        "factor of e in {}){}; ask for an earlier end, or for --accuracy-of energy",
        failure.horizon, duration_in_words(1 / failure.lyapunov), instead);
  }
  if (failure.lyapunov > 0) {
    return fmt::format(
        "the motion is chaotic: rounding has grown beyond the accuracy by t = {:g} s{}", until,
        instead);
  }
  return fmt::format("one rounding of the start changes the motion by {:.1e} of it{}", found.effect,
                     instead);
}

}  // namespace

std::optional<Divergence> parting(const Search& search) {
  const auto& conditioning = search.check().conditioning();
  if (!conditioning) return {};
  const std::vector<double>& seen = conditioning->leaves_by > conditioning->effect
                                        ? conditioning->differences_left
                                        : conditioning->differences;
  if (seen.empty()) return {};
  std::vector<double> times{0}, differences{search.runs().stage().rounding()};
  const auto& looks = search.runs().stage().times();
  times.insert(times.end(), looks.begin(), looks.end());
  differences.insert(differences.end(), seen.begin(), seen.end());
  return divergence(times, differences);
}

Failure why_not(const Search& search, double accuracy, const std::string& stopped_by) {
  Failure failure;
  const Trial* best = search.check().best();
  const std::string reached = best ? fmt::format("the smallest known error bound is {:.1e}",
                                                 search.check().bound(*best)->error)
                                   : "no error is known";
  const Trial* last = search.runs().all().empty() ? nullptr : &search.runs().all().back();
  const bool none_reached = std::ranges::none_of(search.runs().all(), &Trial::reached_end);
  const auto& conditioning = search.check().conditioning();
  // Steps that do not resolve a motion may find a cable slack that is taut: the finest tolerance
  // decides.
  const Trial* finest = nullptr;
  for (const Trial& trial : search.runs().all()) {
    if (trial.method->knob == Knob::rtol && (!finest || trial.value <= finest->value))
      finest = &trial;
  }
  // A share this large leaves little room for a run's own error.
  failure.is_rounding =
      conditioning && search.runs().rules().doubt * conditioning->share > accuracy;
  if (const auto parted = parting(search); parted && failure.is_rounding) {
    failure.horizon = parted->horizon;
    failure.lyapunov = parted->lyapunov;
  }
  if (!stopped_by.empty()) {
    failure.why = fmt::format("{}; {}", stopped_by, reached);
  } else if (finest && finest->summary.outcome == Outcome::went_slack) {
    failure.why = finest->summary.message;
  } else if (failure.is_rounding) {
    failure.why = rounding_in_words(failure, search, accuracy);
    if (best && !(failure.horizon <= search.runs().stage().until())) failure.why += "; " + reached;
  } else if (last && none_reached) {
    failure.why = fmt::format("no run reached the end; {} at {:g}: {}", last->method->name,
                              last->value, last->summary.message);
  } else {
    failure.why = fmt::format("no method is known to reach this accuracy; {}", reached);
  }
  return failure;
}

}  // namespace qddot::inline measure
