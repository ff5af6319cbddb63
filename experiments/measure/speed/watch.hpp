#pragma once

#include <limits>
#include <optional>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/motion/modal_shares.hpp"
#include "qddot/measure/motion/momenta.hpp"
#include "qddot/measure/reference/reference.hpp"

namespace qddot::measure {

// What is seen of a run on its way; no number where it was not looked at or means nothing.
struct PathErrors {
  // The largest |E - E(0)| at any of the times, over the motion's largest kinetic energy: at one
  // time alone it may be small by luck, as energy errors oscillate.
  double energy = std::numeric_limits<double>::quiet_NaN();
  // The largest change of what momenta are kept (see Momenta).
  double momentum = std::numeric_limits<double>::quiet_NaN();
  // Beyond the horizon: the total variation between the run's ModalShares and the reference's.
  double modal_shares = std::numeric_limits<double>::quiet_NaN();
};

// Looks at runs on their way, at about a hundred times up to `until`. Borrows all it is given.
class Watch {
 public:
  static constexpr double most_looks = 100;

  Watch(const Scene& start, const ReducedScene& scene, double until, const Reference& reference);

  // One more run of a method that has taken so many `steps`. Steps of a fixed size stay what they
  // are: it is looked at after whole ones. Adaptive ones have to end on the times, which are
  // therefore no more than a quarter of the steps. Stops after so many `seconds`.
  PathErrors see(const Method& method, const Options& options, std::int64_t steps,
                 double seconds) const;

 private:
  const ReducedScene& scene_;
  double until_;
  const Reference& reference_;
  Momenta momenta_;
  std::optional<ModalShares> modes_;
};

}  // namespace qddot::measure
