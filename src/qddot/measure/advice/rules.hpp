#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace qddot::inline measure {

// The numbers by which a search decides. The study `advice --hard --rules` asks hard motions again
// with each of them halved and doubled. Its rules.csv says what becomes of the bars, the refusals
// and the work. Errors are relative to the motion.
struct Rules {
  // An estimate of an error counts this many times; one that follows from another estimate counts
  // doubt_of_two() times.
  double doubt = 2;
  // A small part: what is beside it counts alone.
  double small = 0.1;
  // The part of a stability limit, or of a time, that is clearly below it.
  double clearly_below = 0.9;
  // Looks at a motion if only its end counts, as each costs a step; and at a path.
  double looks = 24, looks_at_a_path = 400;
  // Motions that change in the same way are seen at so many places.
  double places = 10;

  // A judge's own error is at most this part of the accuracy.
  double part_of_judge = 0.2;
  // Three runs draw together if the finer two differ by at most this part of what the outer two do;
  // two, if the energy error of the finer one is at most this part of the other.
  double drawn_together = 1.0 / 3;
  // Tolerances begin at the accuracy, or here.
  double largest_tolerance = 1e-2;
  // The order that suits a judge; below this accuracy the highest order does.
  double order_of_judge = 8, small_accuracy = 1e-8;

  // Work is counted in evaluations of f, times unknowns and what a call costs beside them.
  double call = 20;
  // Runs with error control judge a motion if they take no more work than this, about 20 ms.
  double little_work = 5e6;
  // The work of the last attempts before an accuracy is refused.
  double much_work = 1e8;
  // An implicit judge may take this part of the work of Verlet's method.
  double short_cut = 0.3;
  // An implicit step of order p takes about p solves, with a force each. One takes as long as so
  // many forces, and for each entry of the factors a part of the force on an unknown. Operations
  // of a factorisation are faster than that.
  double implicit_force = 3, entry = 0.1, operation = 5e-4;
  // The analysis of factors takes for each entry of K as long as the force on so many unknowns.
  double analysis = 50;

  // The check of a run with fixed steps has an error that is expected to be smaller by this factor.
  double finer = 4;
  // Rounds of choosing, running and learning.
  double rounds = 4;
  // Corrections of a forecast by errors of methods whose orders differ by this say nothing.
  double unrelated_orders = 8;

  // Once an answer is found, runs that may be faster begin for a part of its time, or until they
  // and it have taken a time [s] that nobody notices.
  double unnoticed = 0.02, part_of_answer = 0.5;
  // Displacements of no more roundings of the positions than this are no motion, and closed forms
  // are as accurate as that.
  double rest = 30;

  double doubt_of_two() const { return doubt * doubt; }
};

// Each rule with its name.
inline constexpr std::array<std::pair<std::string_view, double Rules::*>, 25> all_rules = {{
    {"doubt", &Rules::doubt},
    {"small", &Rules::small},
    {"clearly_below", &Rules::clearly_below},
    {"looks", &Rules::looks},
    {"looks_at_a_path", &Rules::looks_at_a_path},
    {"places", &Rules::places},
    {"part_of_judge", &Rules::part_of_judge},
    {"drawn_together", &Rules::drawn_together},
    {"largest_tolerance", &Rules::largest_tolerance},
    {"order_of_judge", &Rules::order_of_judge},
    {"small_accuracy", &Rules::small_accuracy},
    {"call", &Rules::call},
    {"little_work", &Rules::little_work},
    {"much_work", &Rules::much_work},
    {"short_cut", &Rules::short_cut},
    {"implicit_force", &Rules::implicit_force},
    {"entry", &Rules::entry},
    {"operation", &Rules::operation},
    {"analysis", &Rules::analysis},
    {"finer", &Rules::finer},
    {"rounds", &Rules::rounds},
    {"unrelated_orders", &Rules::unrelated_orders},
    {"unnoticed", &Rules::unnoticed},
    {"part_of_answer", &Rules::part_of_answer},
    {"rest", &Rules::rest},
}};

}  // namespace qddot::inline measure
