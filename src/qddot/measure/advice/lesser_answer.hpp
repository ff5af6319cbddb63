#pragma once

#include <memory>
#include <optional>
#include <string>

#include "qddot/measure/advice/solve.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::inline measure {

// The part of an accuracy for what is left out.
inline constexpr double part_of_change = 0.5;

// An answer whose run had a simpler model than the scene, which changes the motion by less than the
// accuracy leaves.
struct LesserAnswer {
  Reduction by;                        // rods or linear
  Scene scene;                         // that was run, with the rods
  std::shared_ptr<const Model> model;  // of the run; answer.end is in its unknowns
  Answer answer;                       // error_estimate has the change
  double change = 0;                   // a bound of it, relative to the motion
  std::size_t rods = 0;                // how many springs are rods
  bool has_vibration = false;          // whether springs start with one, which damping ends

  // "left out: 39 stiff springs are rods here; that changes positions by at most 1.5e-05 ...".
  std::string in_words() const;
};

// Computes the motion of a scene as solve() does, by the first of solve_linear() and
// solve_with_rods() that may leave something out. Nothing if none may; errors as theirs. `start`:
// the scene as its motion starts.
std::optional<LesserAnswer> solve_with_less(const Scene& start, const Reductions& reductions,
                                            double until, const Wanted& wanted);

}  // namespace qddot::inline measure
