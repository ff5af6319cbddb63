// Dormand, El-Mikkawy and Prince's adaptive explicit Runge-Kutta-Nystrom pair of order 8(6). With a
// table of coefficients a, b, b' and c a step is
//   q_i     = q_n + c_i h v_n + h^2 sum_{j<i} a_ij k_j,   k_i = M^-1 f(q_i),   i = 1 ... 9
//   q_{n+1} = q_n + h v_n + h^2 sum_i b_i k_i
//   v_{n+1} = v_n + h sum_i b'_i k_i
// The last stage is the first of the next step: eight forces a step. The same sums with other
// weights, of order 6, estimate the error, and the next step size follows from it.
//
// If the system has a K, steps are held to h <= 4.20/w_max. Up to there no vibration grows by
// more than a hundredth a step. The error test alone would miss vibrations that grow but are still
// small.
#include "integrators/methods/tables.hpp"
#include "qddot/integrators/base/nystrom.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const NystromPair& dprkn8_pair() {
  static const NystromPair pair = {
      .order = 8,
      .lower_order = 6,
      .stable_hw = 4.20,
      .c = {0, 1. / 20, 1. / 10, 3. / 10, 1. / 2, 7. / 10, 9. / 10, 1, 1},
      .a = {{},
            {1. / 800},
            {1. / 600, 1. / 300},
            {9. / 200, -9. / 100, 9. / 100},
            {-66701. / 197352, 28325. / 32892, -2665. / 5482, 2170. / 24669},
            {227015747. / 304251000, -54897451. / 30425100, 12942349. / 10141700, -9499. / 304251,
             539. / 9250},
            {-1131891597. / 901789000, 41964921. / 12882700, -6663147. / 3220675, 270954. / 644135,
             -108. / 5875, 114. / 1645},
            {13836959. / 3667458, -17731450. / 1833729, 1063919505. / 156478208,
             -33213845. / 39119552, 13335. / 28544, -705. / 14272, 1645. / 57088},
            {223. / 7938, 0, 1175. / 8064, 925. / 6048, 41. / 448, 925. / 14112, 1175. / 72576, 0}},
      .b = {223. / 7938, 0, 1175. / 8064, 925. / 6048, 41. / 448, 925. / 14112, 1175. / 72576, 0,
            0},
      .b_prime = {223. / 7938, 0, 5875. / 36288, 4625. / 21168, 41. / 224, 4625. / 21168,
                  5875. / 36288, 223. / 7938, 0},
      .lower_b = {7987313. / 109941300, 0, 1610737. / 44674560, 10023263. / 33505920,
                  -497221. / 12409600, 10023263. / 78180480, 1610737. / 402071040, 0, 0},
      .lower_b_prime = {7987313. / 109941300, 0, 1610737. / 40207104, 10023263. / 23454144,
                        -497221. / 6204800, 10023263. / 23454144, 1610737. / 40207104,
                        -4251941. / 54970650, 3. / 20}};
  return pair;
}

namespace {

std::unique_ptr<Stepper> make_dprkn8(SystemRun& run) {
  return std::make_unique<Nystrom>(run, dprkn8_pair(), 4);
}

}  // namespace

Method dprkn8() {
  return {
      .name = "dprkn8",
      .summary =
          "adaptive explicit Runge-Kutta-Nystrom of order 8(6), eight forces a step, "
          "held to 1/w_max",
      .source =
          "Dormand, El-Mikkawy and Prince, IMA J. Numerical Analysis 7 (1987) 423-430, "
          "RKN8(6)9FM",
      .order = 8,
      .knob = Knob::rtol,
      .traits = {Trait::interpolates, Trait::bounds_steps},
      .needs = {Need::conservative},
      .nystrom_pair = &dprkn8_pair(),
      .why_not_damped =
          "Nystrom's order conditions are for forces of positions: with velocities its order is 1",
      .make = make_dprkn8};
}

}  // namespace qddot::registered
