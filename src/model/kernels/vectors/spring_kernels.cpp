#include "qddot/model/kernels/spring_kernels.hpp"

#include "qddot/model/kernels/vectors/energy.hpp"
#include "qddot/model/kernels/vectors/force.hpp"
#include "qddot/model/kernels/vectors/place.hpp"
#include "qddot/model/kernels/vectors/stiffness.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

template <int D, Roots roots>
constexpr SpringKernels kernels() {
  if constexpr (roots == Roots::processor || has_estimates) {
    return {.place = place<D>,
            .force = force<D, roots>,
            .energy = energy<D, roots>,
            .mean_force = mean_force<D, roots>,
            .stiffness = stiffness<D, roots>};
  } else {
    return {};
  }
}

}  // namespace

#define QDDOT_ROW(roots) \
  { kernels<1, roots>(), kernels<2, roots>(), kernels<3, roots>() }

extern const SpringKernels spring_kernels[kinds_of_roots][3];
const SpringKernels spring_kernels[kinds_of_roots][3] = {
    QDDOT_ROW(Roots::processor), QDDOT_ROW(Roots::estimated_root), QDDOT_ROW(Roots::estimated)};

#undef QDDOT_ROW

}  // namespace qddot::kernels::QDDOT_LEVEL
