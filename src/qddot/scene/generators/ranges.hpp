#pragma once

namespace qddot {

// The most that a parameter may be: far beyond any scene, far below overflow.
inline constexpr double most = 1e12;
// The least of a quantity that must not be zero.
inline constexpr double least = 1e-12;

}  // namespace qddot
