#pragma once

#include <complex>
#include <vector>

namespace qddot {

// The cosines (z + 1/z)/2 of the roots z of a palindrome p_0 + p_1 z + ... + p_{2d} z^{2d},
// p_i = p_{2d-i}, p_0 not zero. There are d, one for each pair z and 1/z, in no order. A pair on
// the unit circle has a real cosine from -1 to 1.
std::vector<std::complex<double>> cosines_of_roots(const std::vector<double>& palindrome);

}  // namespace qddot
