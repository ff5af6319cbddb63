#pragma once

#include <limits>
#include <optional>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/modal_shares.hpp"
#include "qddot/measure/motion/momenta.hpp"
#include "qddot/measure/reference/reference.hpp"

namespace qddot::inline measure {

// Errors at times during a run; NaN if not measured or without meaning.
struct PathErrors {
  // The largest |E - E(0)| at any of the times, over the motion's largest kinetic energy. Energy
  // errors oscillate, so the error at one time may be small by chance.
  double energy = std::numeric_limits<double>::quiet_NaN();
  // The largest relative change of the conserved momenta (see Momenta).
  double momentum = std::numeric_limits<double>::quiet_NaN();
  // Beyond the horizon: the total variation between the run's ModalShares and the reference's.
  double modal_shares = std::numeric_limits<double>::quiet_NaN();
};

// Measures runs at about a hundred times up to `until` [s]. Borrows all its arguments.
class Watch {
 public:
  static constexpr double most_looks = 100;

  Watch(const Scene& start, const ReducedScene& scene, double until, const Reference& reference);

  // Runs a method, which took `steps` steps before, once more and measures the run. Fixed steps
  // keep their size: looks are between whole steps. Adaptive steps have to end at the looks, so
  // that there are at most steps/4 of these. Stops after `seconds`.
  PathErrors see(const Method& method, const Options& options, std::int64_t steps,
                 double seconds) const;

 private:
  const ReducedScene& scene_;
  double until_;
  const Reference& reference_;
  Momenta momenta_;
  std::optional<ModalShares> modes_;
};

}  // namespace qddot::inline measure
