#include "qddot/model/kernels/spring_kernels.hpp"

#include "qddot/model/kernels/level.hpp"

namespace qddot::kernels {

#define QDDOT_DECLARE(level)                    \
  namespace level {                             \
  extern const SpringKernels spring_kernels[3]; \
  }
#define QDDOT_ENTRY(level) level::spring_kernels,

QDDOT_LEVELS(QDDOT_DECLARE)

const SpringKernels& spring_kernels(int dimension) {
  static constexpr const SpringKernels* versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  return versions[level()][dimension - 1];
}

#undef QDDOT_DECLARE
#undef QDDOT_ENTRY

}  // namespace qddot::kernels
