#pragma once

#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The indices of the scene's stiff springs (Scene::stiff_above), ascending.
std::vector<std::size_t> stiff_springs(const Scene& scene);

// The oscillatory energy [J] of each stiff spring with the nodes at `nodes`: the energy of the two
// ends' vibration along the spring,
//   I = 1/2 mu (n.(v_2 - v_1))^2 + V(l),  mu = m_1 m_2/(m_1 + m_2).
// mu is the mass that vibrates if nothing else pulls: without the masses' common velocity, 1/2 m_1
// v_1^2 + 1/2 m_2 v_2^2 is 1/2 mu (v_2 - v_1)^2. If one end is pinned, mu is the other's mass. The
// vector n is the spring's direction or, at l = 0, that of the relative velocity, along which the
// ends pass through each other. The chain of Hairer, Lubich and Wanner (generators/fpu.cpp) has
// mu = 1/2 and v_2i - v_2i-1 = sqrt 2 x'_1,i, so that this is their
//   I_i = 1/2 x'_1,i^2 + w^2/4 (q_2i - q_2i-1)^2 = 1/2 (x'_1,i^2 + w^2 x_1,i^2).
Vec stiff_energies(const Scene& scene, const std::vector<Node>& nodes);

}  // namespace qddot
