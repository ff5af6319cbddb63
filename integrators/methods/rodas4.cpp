// RODAS: a stiffly accurate Rosenbrock method of order 4 with an embedded one of order 3. With
// y = (q, v), F(y) = (v, M^-1 f(q)) and the exact Jacobian J = dF/dy at y_n, its six stages are
//   (I/(gamma h) - J) U_i = F(y_n + sum_{j<i} a_ij U_j) + 1/h sum_{j<i} c_ij U_j
//   y_{n+1} = y_n + sum_{j<6} a_6j U_j + U_6
// U_6 estimates the error, and the next step size follows from it. Let g = gamma h, and let (r, s)
// be g times the right-hand side. Then a stage is one n x n solve:
//   (M - g^2 K) U_q = M (r + g s),   U_v = (U_q - r)/g
// A step takes six forces, one factorisation and six solves. The method is L-stable.
#include "integrators/methods/tables.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::registered {

const RosenbrockTable& rodas4_table() {
  static const RosenbrockTable table = {
      .gamma = 0.25,
      .a = {{},
            {1.544},
            {0.9466785280815826, 0.2557011698983284},
            {3.314825187068521, 2.896124015972201, 0.9986419139977817},
            {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
            {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1}},
      .c = {{},
            {-5.6688},
            {-2.430093356833875, -0.2063599157091915},
            {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
            {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
            {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136,
             -6.058818238834054}}};
  return table;
}

namespace {

std::unique_ptr<Stepper> make(SystemRun& run) {
  return std::make_unique<Rosenbrock>(run, rodas4_table(), 3);
}

}  // namespace

Method rodas4() {
  return {.name = "rodas4",
          .summary = "Rosenbrock of order 4(3): one n x n factorisation and six solves a step",
          .source = "Hairer and Wanner, Solving Ordinary Differential Equations II, IV.10",
          .order = 4,
          .knob = Knob::rtol,
          .traits = {Trait::implicit, Trait::interpolates},
          .needs = {Need::conservative, Need::stiffness, Need::rate_in_time},
          .takes = {Option::solver},
          .why_not_damped = "its order needs the derivative of friction by positions",
          .make = make};
}

}  // namespace qddot::registered
