#pragma once

#include "qddot/integrators/base/rosenbrock.hpp"
#include "qddot/integrators/base/symmetric_multistep.hpp"

// Tables of coefficients that more than one file uses, each defined in the file of its method.
namespace qddot::registered {

const NystromPair& dprkn6_pair();
const NystromPair& dprkn8_pair();
const NystromPair& dprkn12_pair();

const SymmetricFormula& symmetric4_formula();
const SymmetricFormula& symmetric6_formula();
const SymmetricFormula& symmetric8_formula();
const SymmetricFormula& symmetric10_formula();

const RosenbrockTable& rodas4_table();

}  // namespace qddot::registered
