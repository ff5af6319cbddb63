#include "qddot/algebra/multifrontal/front_kernels.hpp"

#include "qddot/model/kernels/level.hpp"

namespace qddot::multifrontal {

#define QDDOT_DECLARE(level)               \
  namespace level {                        \
  extern const FrontKernels front_kernels; \
  }
#define QDDOT_ENTRY(level) &level::front_kernels,

QDDOT_LEVELS(QDDOT_DECLARE)

const FrontKernels& front_kernels() {
  static constexpr const FrontKernels* versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  return *versions[kernels::level()];
}

}  // namespace qddot::multifrontal
