#pragma once

#include <sundials/sundials_config.h>

// SUNDIALS' version as one number, 70101 for 7.1.1.
#define QDDOT_SUNDIALS \
  (SUNDIALS_VERSION_MAJOR * 10000 + SUNDIALS_VERSION_MINOR * 100 + SUNDIALS_VERSION_PATCH)
