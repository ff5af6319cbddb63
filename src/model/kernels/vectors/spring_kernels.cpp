#include "qddot/model/kernels/spring_kernels.hpp"

#include "qddot/model/kernels/vectors/force.hpp"
#include "qddot/model/kernels/vectors/place.hpp"
#include "qddot/model/kernels/vectors/stiffness.hpp"

namespace qddot::kernels::QDDOT_LEVEL {

extern const SpringKernels spring_kernels[3];
const SpringKernels spring_kernels[3] = {{lanes, place<1>, force<1>, stiffness<1>},
                                         {lanes, place<2>, force<2>, stiffness<2>},
                                         {lanes, place<3>, force<3>, stiffness<3>}};

}  // namespace qddot::kernels::QDDOT_LEVEL
