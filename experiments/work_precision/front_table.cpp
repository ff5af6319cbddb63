#include "experiments/work_precision/front_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "experiments/kit/accuracy_choice.hpp"
#include "qddot/measure/reference/reference_words.hpp"
#include "qddot/measure/speed/judgement.hpp"

namespace qddot::work_precision {
using kit::time_in_words;
namespace {

// A step that is nearer to its limit is warned of.
constexpr double small_margin = 0.15;

std::string knob_in_words(const Point& point) {
  return kit::knob_in_words(*point.method, point.value);
}

const char* why_empty(const FrontRow& row, const Reference& reference) {
  if (certified(reference) > row.accuracy) return "beyond what the reference certifies";
  return row.may_be_reached ? "no method is known to have reached it" : "no method reached it";
}

std::string error_in_words(double error, const Reference& reference) {
  return fmt::format("{:.1e}{}", error, is_uncertain(error, certified(reference)) ? '?' : ' ');
}

// The other family's best, and how many times slower it is.
std::string rival(const FrontRow& row) {
  const Point* other =
      row.fastest == row.fastest_sundials ? row.fastest_hand_written : row.fastest_sundials;
  if (!other) return "";
  return fmt::format("{} {}, {:.3g} x", other->method->name, time_in_words(other->time),
                     other->time / row.fastest->time);
}

// A sentence for each step that the front names and that stands on the edge.
std::vector<std::string> small_margins(const std::vector<FrontRow>& front) {
  std::vector<std::string> sentences;
  for (const FrontRow& row : front) {
    if (!(row.stability_margin < small_margin)) continue;
    const double percent = 100 * row.stability_margin;
    const std::string sentence = fmt::format(
        "{} at {} is {:.2g} % {} its limit of stability, w_max at the start: motion raises that, "
        "and "
        "a longer run may blow up; take half of the step there",
        row.fastest->method->name, knob_in_words(*row.fastest), std::abs(percent),
        percent < 0 ? "above" : "below");
    if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
  }
  return sentences;
}

}  // namespace

void print_front(const std::string& scene, double until, const std::vector<FrontRow>& front,
                 const Reference& reference) {
  fmt::print("{} to t = {:g} s; reference certified to {:.1e} ({})\n", scene, until,
             reference.certified.position, reference.made_by);
  fmt::print("{}\n\n", what_divides(reference));
  if (reference.is_beyond_horizon()) {
    fmt::print(
        "The motion is chaotic (Lyapunov exponent {:.3g}/s): two runs that start one rounding "
        "apart\ndiffer from t = {:.3g} s on by more than {:g} of the motion.\nPosition errors at "
        "the end mean nothing; below, accuracy is that of the energy.\n\n",
        reference.lyapunov, reference.horizon, apart);
  } else if (reference.is_chaotic()) {
    fmt::print(
        "The motion is chaotic: one rounding of the start grows {:.0e} times and moves the end "
        "by {:.0e};\nerrors below that depend on how a method rounds.\n\n",
        reference.perturbation_growth, reference.rounding_effect);
  }
  const std::string symmetry = symmetry_in_words(reference);
  if (!symmetry.empty()) fmt::print("{}\n\n", symmetry);
  fmt::print("{:<9} {:<20} {:<16} {:>9}  {:>9}   {}\n", "accuracy", "fastest method", "knob",
             "error ", "time", "fastest of the other family");
  bool has_doubts = false;
  for (const FrontRow& row : front) {
    if (const Point* p = row.fastest) {
      const double error = judged_error(*p, reference);
      has_doubts |= is_uncertain(error, certified(reference));
      fmt::print("{:<9.0e} {:<20} {:<16} {:>9}  {:>9}   {}\n", row.accuracy, p->method->name,
                 knob_in_words(*p), error_in_words(error, reference), time_in_words(p->time),
                 rival(row));
    } else {
      fmt::print("{:<9.0e} {}\n", row.accuracy, why_empty(row, reference));
    }
  }
  for (const std::string& warning : small_margins(front)) fmt::print("{}\n", warning);
  if (has_doubts)
    fmt::print("? known only to within {:.1e}, the error bound of the reference itself\n",
               certified(reference));
}

}  // namespace qddot::work_precision
