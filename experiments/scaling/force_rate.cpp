#include "experiments/scaling/force_rate.hpp"

#include "qddot/measure/motion/timing.hpp"

namespace qddot::scaling {
namespace {

// A spring's k and l0 are read at each of its ends (see SpringsByNode). An unknown's q and weight
// are read, its f is written, and its position goes to memory and back.
constexpr double bytes_of_spring = 2 * 2 * sizeof(double);
constexpr double bytes_of_unknown = 5 * sizeof(double);
// Operations at each end. d = x_j - x_i: 3; l^2 = d.d: 5; l: 1; s = l - l0: 1; tau = k s: 1; tau/l:
// 1; f_i += (tau/l) d: 6.
constexpr double flops_of_spring = 2 * 18;

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

}  // namespace qddot::scaling
