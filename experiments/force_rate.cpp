#include "experiments/force_rate.hpp"

#include "experiments/timing.hpp"

namespace qddot {
namespace {

// Of a spring two indices and k, l0, c; of an unknown its q and weight are read, its f is written.
constexpr double bytes_of_spring = 2 * sizeof(int) + 3 * sizeof(double);
constexpr double bytes_of_unknown = 3 * sizeof(double);
// d = x_j - x_i: 3; l^2 = d.d: 5; l: 1; s = l - l0: 1; tau = s (k + c s^2): 4; tau/l: 1;
// (tau/l) d: 3; added to f_i and f_j: 6.
constexpr double flops_of_spring = 24;

}  // namespace

ForceRate force_rate(const ReducedScene& scene, double springs, double seconds) {
  const System& system = scene.system();
  const Vec& q = scene.initial().q;
  Vec f(system.size());
  return {
      .seconds = least_seconds(seconds, [&] { system.force(q, f); }),
      .bytes = bytes_of_spring * springs + bytes_of_unknown * static_cast<double>(system.size()),
      .flops = flops_of_spring * springs};
}

}  // namespace qddot
