#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/advice/own_pairs.hpp"
#include "qddot/measure/advice/trial.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::judged_advice {

// A question on a small motion that is hard to answer: of a scene, or of bodies with own forces.
struct HardCase {
  std::uint64_t number = 0;
  std::string kind{};
  Scene scene{};                 // without springs if there are own forces
  std::vector<OwnPair> pairs{};  // the own forces
  // Whether own forces have a K, and a V.
  bool gives_stiffness = true, gives_energy = true;
  double until = 0;     // [s]
  double accuracy = 0;  // relative
  AccuracyOf of = AccuracyOf::positions;

  // The model that is asked, with all reductions of a scene.
  Model model() const;
  // The same with an unknown for each coordinate of each node that is not pinned.
  Model as_drawn() const;
};

// The number of kinds; hard_case() takes them in turn.
std::size_t hard_kinds();

// The case of that number, the same on every machine. Positions, path and energy take turns, and
// the kinds after each three. Scenes have 1 to about 60 unknowns. Accuracies, from 1e-10 to 1e-1,
// and the parameters of a kind are drawn at random, most by their logarithm.
HardCase hard_case(std::uint64_t number);

}  // namespace qddot::judged_advice
