#pragma once

#include <cstddef>

#include "qddot/model/kernels/spring_kernels.hpp"

namespace qddot::kernels {

// root = sqrt(a) and quotient = t/root by one kind of roots, n numbers of each, n a multiple of 8.
// False where the version in use has no such roots.
bool roots_and_quotients(Roots roots, const double* a, const double* t, double* root,
                         double* quotient, std::ptrdiff_t n);

}  // namespace qddot::kernels
