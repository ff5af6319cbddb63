#include "qddot/model/kernels/spring_kernels.hpp"

#include "qddot/model/kernels/level.hpp"

namespace qddot::kernels {

#define QDDOT_DECLARE(level)                                    \
  namespace level {                                             \
  extern const SpringKernels spring_kernels[kinds_of_roots][3]; \
  }
#define QDDOT_ENTRY(level) &level::spring_kernels,

QDDOT_LEVELS(QDDOT_DECLARE)

const SpringKernels* spring_kernels(int dimension, Roots roots) {
  using Version = const SpringKernels[kinds_of_roots][3];
  static constexpr Version* versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  const SpringKernels& found = (*versions[level()])[static_cast<int>(roots)][dimension - 1];
  return found.force ? &found : nullptr;
}

#undef QDDOT_DECLARE
#undef QDDOT_ENTRY

}  // namespace qddot::kernels
