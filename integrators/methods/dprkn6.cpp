// Dormand and Prince's adaptive explicit Runge-Kutta-Nystrom pair of order 6(4). With a table of
// coefficients a, b, b' and c a step is
//   q_i     = q_n + c_i h v_n + h^2 sum_{j<i} a_ij k_j,   k_i = M^-1 f(q_i),   i = 1 ... 6
//   q_{n+1} = q_n + h v_n + h^2 sum_i b_i k_i
//   v_{n+1} = v_n + h sum_i b'_i k_i
// The last stage is the first of the next step: five forces a step. The same sums with other
// weights, of order 4, estimate the error, and the next step size follows from it.
//
// If the system has a K, steps are held to h <= 2.71/w_max. Up to there no vibration grows by
// more than a hundredth a step. The error test alone would miss vibrations that grow but are still
// small.
#include <cmath>

#include "integrators/methods/tables.hpp"
#include "qddot/integrators/base/nystrom.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const NystromPair& dprkn6_pair() {
  static const double r = std::sqrt(8581);
  static const NystromPair pair = {
      .order = 6,
      .lower_order = 4,
      .stable_hw = 2.71,
      .c = {0, (209 - r) / 900, (209 - r) / 450, (209 + r) / 450, 9. / 10, 1},
      .a = {{},
            {(26131 - 209 * r) / 810000},
            {(26131 - 209 * r) / 607500, (26131 - 209 * r) / 303750},
            {(980403512254 + 7781688431 * r) / 11694469921875,
             -(1262884486208 + 15385481287 * r) / 11694469921875,
             (7166233891441 + 78694563299 * r) / 46777879687500},
            {-9 * (329260 + 3181 * r) / 27040000, 27 * (35129 + 3331 * r) / 13520000,
             -27 * (554358343 + 31040327 * r) / 464060480000,
             153 * (8555257 - 67973 * r) / 2745920000},
            {329. / 4212, 0, (84119543 + 366727 * r) / 409622616,
             (84119543 - 366727 * r) / 409622616, 200. / 17901}},
      .b = {329. / 4212, 0, (84119543 + 366727 * r) / 409622616,
            (84119543 - 366727 * r) / 409622616, 200. / 17901, 0},
      .b_prime = {329. / 4212, 0, (389225579 + 96856 * r) / 1024056540,
                  (389225579 - 96856 * r) / 1024056540, 2000. / 17901, 1. / 20},
      .lower_b = {(2701 + 23 * r) / 4563, -(9829 + 131 * r) / 9126, 5 * (1798 + 17 * r) / 9126, 0,
                  0, 0},
      .lower_b_prime = {115. / 2106, 0, (84119543 + 366727 * r) / 256014135,
                        (84119543 - 366727 * r) / 256014135, 6950. / 17901, -1. / 10}};
  return pair;
}

namespace {

std::unique_ptr<Stepper> make_dprkn6(SystemRun& run) {
  return std::make_unique<Nystrom>(run, dprkn6_pair(), 4);
}

}  // namespace

Method dprkn6() {
  return {
      .name = "dprkn6",
      .summary =
          "adaptive explicit Runge-Kutta-Nystrom of order 6(4), five forces a step, "
          "held to 1/w_max",
      .source =
          "Dormand and Prince, Computers & Mathematics with Applications 13 (1987) "
          "937-949, RKN6(4)6FD",
      .order = 6,
      .knob = Knob::rtol,
      .traits = {Trait::interpolates, Trait::bounds_steps},
      .needs = {Need::conservative},
      .nystrom_pair = &dprkn6_pair(),
      .why_not_damped =
          "Nystrom's order conditions are for forces of positions: with velocities its order is 1",
      .make = make_dprkn6};
}

}  // namespace qddot::registered
