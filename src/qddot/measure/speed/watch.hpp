#pragma once

#include <cstdint>
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

// Measures runs on their way to `until` [s]: the energy at up to 10 000 random times, and the rest
// at up to a thousand of these. Borrows all its arguments.
class Watch {
 public:
  static constexpr std::int64_t most_looks = 10'000;

  Watch(const Scene& start, const Model& scene, double until, const Reference& reference);

  // Runs a method, which took `steps` steps before, once more and measures the run. Fixed steps
  // keep their size: looks are between whole steps, and at each if there are no more than looks.
  // Methods that interpolate are seen as often as they step. The others have to end their steps at
  // the looks, so that there are at most steps/4 of these. Stops after `seconds`.
  PathErrors see(const Method& method, const Options& options, std::int64_t steps,
                 double seconds) const;

 private:
  const Model& scene_;
  double until_;
  const Reference& reference_;
  Momenta momenta_;
  std::optional<ModalShares> modes_;
};

}  // namespace qddot::inline measure
