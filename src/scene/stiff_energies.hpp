#pragma once

#include <vector>

#include "qddot/model/system.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot {

// The springs of the scene that are stiff (Scene::stiff_above), by their indices, ascending.
std::vector<std::size_t> stiff_springs(const Scene& scene);

// The oscillatory energy [J] of each of them, with the nodes at `nodes`: that of the two ends'
// vibration along the spring,
//   I = 1/2 mu (n.(v_2 - v_1))^2 + V(l),  mu = m_1 m_2/(m_1 + m_2),
// mu the mass that vibrates where nothing else pulls: with two masses' common velocity left out,
// 1/2 m_1 v_1^2 + 1/2 m_2 v_2^2 is 1/2 mu (v_2 - v_1)^2. Where one end is pinned mu is the other's
// mass. n is the spring's direction; at l = 0 that of the relative velocity, since the ends pass
// through each other along it. In the chain of Hairer, Lubich and Wanner (generators/fpu.cpp)
// mu = 1/2 and v_2i - v_2i-1 = sqrt 2 x'_1,i, so that this is their
//   I_i = 1/2 x'_1,i^2 + w^2/4 (q_2i - q_2i-1)^2 = 1/2 (x'_1,i^2 + w^2 x_1,i^2).
Vec stiff_energies(const Scene& scene, const std::vector<Node>& nodes);

}  // namespace qddot
