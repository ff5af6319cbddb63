// RODAS: a stiffly accurate Rosenbrock method of order 4 with an embedded one of order 3, six
// stages, L-stable.
#include "qddot/integrators/base/rosenbrock.hpp"
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

std::unique_ptr<Integrator> make(const Method& method, const System& system,
                                 const Options& options) {
  return std::make_unique<Rosenbrock>(method, system, options, rodas4_table(), 3);
}

}  // namespace

Method rodas4() {
  return {.name = "rodas4",
          .summary = "Rosenbrock of order 4(3): one n x n factorisation and six solves a step",
          .source = "Hairer and Wanner, Solving Ordinary Differential Equations II, IV.10",
          .order = 4,
          .knob = Knob::rtol,
          .traits = {Trait::implicit, Trait::interpolates},
          .needs = {Need::stiffness},
          .takes = {Option::solver},
          .make = make};
}

}  // namespace qddot::registered
