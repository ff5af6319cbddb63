#include "qddot/algebra/multifrontal/front_kernels.hpp"

#include "qddot/algebra/multifrontal/vectors/elimination.hpp"
#include "qddot/algebra/multifrontal/vectors/solves.hpp"

namespace qddot::multifrontal::QDDOT_LEVEL {

extern const FrontKernels front_kernels;
const FrontKernels front_kernels = {.tile_strips = tile_strips,
                                    .assemble = assemble,
                                    .add_update = add_update,
                                    .factorize_block = factorize_block,
                                    .divide = divide,
                                    .subtract_from_rest = subtract_from_rest,
                                    .forward = forward,
                                    .backward = backward,
                                    .forwards = forwards,
                                    .backwards = backwards};

}  // namespace qddot::multifrontal::QDDOT_LEVEL
