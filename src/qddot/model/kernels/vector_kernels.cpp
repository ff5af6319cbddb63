#include "qddot/model/kernels/vector_kernels.hpp"

#include "qddot/model/kernels/level.hpp"

namespace qddot::kernels {

#define QDDOT_DECLARE(level)                 \
  namespace level {                          \
  extern const VectorKernels vector_kernels; \
  }
#define QDDOT_ENTRY(level) &level::vector_kernels,

QDDOT_LEVELS(QDDOT_DECLARE)

const VectorKernels& vector_kernels() {
  static constexpr const VectorKernels* versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  return *versions[level()];
}

#undef QDDOT_DECLARE
#undef QDDOT_ENTRY

}  // namespace qddot::kernels
