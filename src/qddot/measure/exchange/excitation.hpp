#pragma once

#include <functional>
#include <string>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/exchange/energy_exchange.hpp"
#include "qddot/scene/model.hpp"
#include "qddot/scene/scene.hpp"

namespace qddot::inline measure {

// A scene whose stiff springs (Scene::stiff_above) start with energy, which they then exchange.
struct Excitation {
  Scene start;
  Model scene;
  double until = 0, every = 0;  // [s]; `every`: mean time between looks
  double omega = 0;             // the highest frequency of the stiff springs alone [rad/s]
  double window = 0;            // [s], of running means: 40 periods, at most until/4
  double energy = 0, sum = 0;   // H, and the oscillatory energy of all stiff springs, at t = 0 [J]
};

// The times [s] of the looks at a run with steps of h [s]: ends of random steps, about one in each
// `every`, so that no vibration is in step with them.
std::vector<double> looks(const Excitation& excitation, double h);

// Measures the start of a scene. Throws InvalidInput, in a sentence that starts with `source`, if
// no stiff spring moves or none has energy.
Excitation excitation_of(Scene start, Model scene, double until, const std::string& source);

// A run of one method: the energies of the stiff springs, and the largest relative errors of their
// sum and of the energy H.
struct ExchangeRun {
  EnergyCourse course{};
  Summary summary{};
  double sum_deviation = 0, energy_error = 0;
};

// Runs the method for `seconds` at most and looks at the start and at `times` [s]. A run of
// constant steps must reach these in whole steps. `value`: of the knob, h [s] or rtol.
ExchangeRun exchange_run(const Excitation& excitation, const Method& method, double value,
                         const std::vector<double>& times, double seconds = 60);

// The reference of an exchange. It is a run of Kahan and Li's composition of order 8 at h w = 0.1,
// certified by Dormand and Prince's Nystrom pair 12(10) at rtol = 1e-12.
struct CertifiedCourse {
  static constexpr double h_omega = 0.1;

  double h = 0;
  ExchangeRun run{};
  double certified = 0;  // the largest |I_j - I_j'| of both, over the sum at the start
};

// Returns a run by its name: a stored one, or else the one that `run` makes.
using Recall =
    std::function<ExchangeRun(const std::string& name, const std::function<ExchangeRun()>& run)>;
// Makes the reference from two runs. Throws NoReference if one does not reach the end.
CertifiedCourse certified_course(const Excitation& excitation, const Recall& recall = {});

}  // namespace qddot::inline measure
