#pragma once

#include "qddot/scene/model.hpp"
#include "qddot/scene/reduce/pieces.hpp"

namespace qddot::reduce {

// Throws std::logic_error unless each free node has one place and the model starts with the scene's
// energies. The parts were compared with their nodes before, and joints are placed by their series.
void require_drawn_start(const Model& model, const Pieces& pieces, const Scene& scene);

}  // namespace qddot::reduce
