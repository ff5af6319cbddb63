#pragma once

#include "qddot/integrators/base/kick_drift.hpp"

namespace qddot::registered {

// Kahan and Li's composition of order 8, their s17odr8a.
const Splitting& kahan_li8_splitting();

}  // namespace qddot::registered
