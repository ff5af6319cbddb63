#pragma once

#include <memory>

#include "qddot/algebra/factors.hpp"

namespace qddot {

// Makes Factors by CHOLMOD (Chen, Davis, Hager, Rajamanickam, ACM TOMS 35:3, 2008): supernodal LL'
// or simplicial LDL', whichever its flop count favours.
std::unique_ptr<Factors> make_cholmod_factors(const SymmetricMatrix& pattern, Vec diagonal);

}  // namespace qddot
