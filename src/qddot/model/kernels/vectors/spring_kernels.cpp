#include "qddot/model/kernels/spring_kernels.hpp"

#include "qddot/model/kernels/vectors/dashpots.hpp"
#include "qddot/model/kernels/vectors/energy.hpp"
#include "qddot/model/kernels/vectors/force.hpp"
#include "qddot/model/kernels/vectors/place.hpp"
#include "qddot/model/kernels/vectors/stiffness.hpp"
#include "qddot/model/kernels/vectors/stiffness_rows.hpp"

namespace qddot::kernels::QDDOT_LEVEL {
namespace {

template <int D, Roots roots>
constexpr SpringKernels kernels() {
  if constexpr (roots == Roots::processor || has_estimates) {
    // A line needs no roots, and only forces use estimated quotients. K divides by a length, and
    // its estimated inverse may be next to the nearest number. Mean forces divide by a sum of two
    // lengths.
    constexpr Roots processor = Roots::processor, none_on_line = D == 1 ? processor : roots,
                    of_lengths = none_on_line == processor ? processor : Roots::estimated_root;
    return {.place = place<D>,
            .force = force<D, none_on_line>,
            .energy = energy<D, of_lengths>,
            .mean_force = mean_force<D, of_lengths>,
            .stiffness = stiffness<D, of_lengths>,
            .stiffness_product = stiffness_product<D, of_lengths>,
            .stiffness_row_sums = stiffness_row_sums<D, of_lengths>,
            .friction = friction<D>,
            .damped_force = damped_force<D, none_on_line>};
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
