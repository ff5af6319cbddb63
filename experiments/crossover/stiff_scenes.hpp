#pragma once

#include <string>
#include <vector>

#include "qddot/scene/scene.hpp"

namespace qddot::crossover {

// Scenes that are the same but for how much stiffer some springs are than what sets the motion.
struct StiffFamily {
  std::string name;
  std::string summary;
  int nodes;     // along a side or in a row, where none are asked for
  double until;  // [s], likewise: the fall is then about a third of the scene's size
  Scene (*draw)(int nodes, double until, double ratio);
};

// All families:
//   frame  framed_cloth, its frame `ratio` times as stiff as its cloth;
//   hem    hemmed_cloth, its hem `ratio` times as stiff as its cloth;
//   whole  cloth, all of it stiff against its weight: k = ratio m g / L between neighbours, so that
//          its weight stretches it by about 1 / ratio of its size;
//   chain  chain on one pinned end, the springs of its middle third `ratio` times as stiff as the
//          others, of which k_soft = 1000 N m g / L for N springs.
// frame, hem and chain name their stiff springs where ratio > 1. All else is as the generators have
// it.
const std::vector<StiffFamily>& stiff_families();

}  // namespace qddot::crossover
