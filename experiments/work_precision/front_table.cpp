#include "experiments/work_precision/front_table.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/chart_words.hpp"

namespace qddot::work_precision {
namespace {

std::string knob_of(const Point& point) { return knob_in_words(*point.method, point.value); }

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
    const std::string sentence = fmt::format(
        "{} at {} is {}, w_max at the start: motion raises that, and a longer run may blow up; "
        "take half of the step there",
        row.fastest->method->name, knob_of(*row.fastest), margin_in_words(row.stability_margin));
    if (std::ranges::find(sentences, sentence) == sentences.end()) sentences.push_back(sentence);
  }
  return sentences;
}

}  // namespace

const std::vector<std::string> front_columns = {"scene",  "accuracy",  "method",
                                                "knob",   "value",     "error_position",
                                                "time_s", "judged_by", "stability_margin"};

void tabulate(Csv& csv, const std::string& scene, const Chart& chart) {
  const char* judge = name(chart.judge);
  for (const FrontRow& row : chart.front) {
    if (const Point* p = row.fastest) {
      csv.row(scene, row.accuracy, p->method->name, knob_name(p->method->knob), p->value,
              p->errors.position, p->time, judge, row.stability_margin);
    } else {
      csv.row(scene, row.accuracy, "", "", "", "", "", judge, "");
    }
  }
}

void print_front(const std::string& scene, const Chart& chart) {
  const Reference& reference = chart.reference;
  fmt::print("{} to t = {:g} s; reference certified to {:.1e} ({})\n", scene, reference.end.t,
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
  for (const FrontRow& row : chart.front) {
    if (const Point* p = row.fastest) {
      const Judged& error = chart.judged_view().points[chart.number(p)];
      has_doubts |= error.is_uncertain;
      fmt::print("{:<9.0e} {:<20} {:<16} {:>8.1e}{}  {:>9}   {}\n", row.accuracy, p->method->name,
                 knob_of(*p), error.error, error.is_uncertain ? '?' : ' ', time_in_words(p->time),
                 rival(row));
    } else {
      fmt::print("{:<9.0e} {}\n", row.accuracy, why_empty(row, reference));
    }
  }
  for (const std::string& warning : small_margins(chart.front)) fmt::print("{}\n", warning);
  if (has_doubts)
    fmt::print("? known only to within {:.1e}, the error bound of the reference itself\n",
               certified(reference));
}

}  // namespace qddot::work_precision
