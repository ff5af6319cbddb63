#include "qddot/measure/speed/limit_kernels.hpp"

#include "qddot/model/kernels/level.hpp"

namespace qddot::inline measure {

#define QDDOT_DECLARE(level)               \
  namespace level {                        \
  extern const LimitKernels limit_kernels; \
  }
#define QDDOT_ENTRY(level) &level::limit_kernels,

QDDOT_LEVELS(QDDOT_DECLARE)

const LimitKernels& limit_kernels() {
  static constexpr const LimitKernels* versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  return *versions[kernels::level()];
}

}  // namespace qddot::inline measure
