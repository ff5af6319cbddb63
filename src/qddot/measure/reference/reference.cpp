#include "qddot/measure/reference/reference.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference_rounding.hpp"
#include "qddot/measure/reference/reference_ways.hpp"
#include "qddot/measure/reference/refinement.hpp"

namespace qddot::inline measure {
namespace {

constexpr Index largest_modal_size = 2000;  // a dense eigenproblem of a few seconds

// Throws NoReference if no step resolves the motion, or if `steps` steps of order 8 would take more
// than twice `seconds`, estimated from a few steps. Calls `expect` if the reference is likely to
// take all its time. `allowed`: that of the whole reference [s].
void require_affordable(const Model& scene, double until, double steps, double seconds,
                        double allowed, const Expect& expect) {
  constexpr double tried = 16, refinements = 8;
  State state = scene.initial();
  const double h = until / steps;
  if (!(h > 0)) {
    throw NoReference(
        "no reference: the fastest vibration at the start is too fast for numbers, so that no step "
        "resolves it: ask for larger masses or softer springs");
  }
  const auto integrator =
      make_integrator(resolving_method(scene.system()), scene.system(), {.step_size = h});
  const auto begin = clock_now();
  const Deadline deadline(seconds);
  integrator->advance(state, tried * h, {}, deadline.token());
  const double expected = seconds_since(begin) / tried * steps;
  if (expected > 2 * seconds) {
    throw NoReference(
        fmt::format("no reference: to t = {:g} s it takes {:.2g} steps of order 8 at the least, "
                    "about {}, and {} "
                    "are allowed in all: ask for an earlier end (--until)",
                    until, steps, duration_in_words(expected), duration_in_words(allowed)),
        true);
  }
  if (expect && expected * refinements > seconds) expect(std::max(4 * seconds, 60.0));
}

// A composition, refined as far as possible, and the effect of a rounding of its start.
class Composed {
 public:
  // In about `seconds`, of those that are allowed for the whole reference.
  Composed(const Model& scene, double until, double seconds, double allowed, const Scene* drawn,
           const Expect& expect)
      : scene_(scene), until_(until), longest_rounding_(allowed), drawn_(drawn) {
    // The steps resolve the fastest frequency at the start: h w = 2, 1, 1/2, ...
    const double bound = frequency_bound(scene.system(), scene.initial().q);
    const double coarsest = std::max(16.0, std::ceil(until * bound / 2));
    require_affordable(scene, until, coarsest, seconds, allowed, expect);
    finest_ = refined(
        scene, seconds,
        [&](int level) {
          return composition(scene, scene.initial(), until, until / (coarsest * std::exp2(level)),
                             seconds);
        },
        [&](const Solution& at, double change) { return rounding_of(at).explains(change); });
    rounding_of(finest_);
  }

  const Solution& finest() const { return finest_; }
  const RoundingRun& rounding() const { return *rounding_; }

 private:
  const RoundingRun& rounding_of(const Solution& solution) {
    if (!rounding_ || rounding_->knob() != solution.knob)
      rounding_.emplace(scene_, solution, until_, longest_rounding_, drawn_);
    return *rounding_;
  }

  const Model& scene_;
  double until_, longest_rounding_;
  const Scene* drawn_;
  Solution finest_;
  std::optional<RoundingRun> rounding_;
};

Solution best_fehlberg(const Model& scene, double until, const Composed& composed, double seconds) {
  return refined(
      scene, seconds,
      [&](int level) -> std::optional<Solution> {
        const double tolerance = std::pow(10.0, -9 - level);
        if (tolerance < 5e-16) return {};
        return fehlberg(scene, until, tolerance, composed.finest().scales, seconds);
      },
      [&](const Solution&, double change) { return composed.rounding().explains(change); });
}

}  // namespace

Reference make_reference(const Model& scene, double until, double seconds, const Scene* start,
                         const Expect& expect) {
  const auto begin = clock_now();
  require_constant_energy(scene.system());
  const Composed composed(scene, until, 0.6 * seconds, seconds, start, expect);
  const Solution& finest = composed.finest();
  const Errors& effect = composed.rounding().effect();
  Reference reference;
  if (scene.system().stiffness_is_constant() && LinearMotion::has_modes(scene.system()) &&
      scene.system().size() <= largest_modal_size) {
    Solution modal{.end = scene.initial(), .scales = finest.scales, .made_by = "modal, exact"};
    if (scene.system().driving()) {
      make_integrator(*find_method("exact"), scene.system(), {.step_size = until})
          ->advance(modal.end, until);
    } else {
      modal.end = LinearMotion(scene.system()).after(scene.initial(), until);
      // Damping has taken all energy that the exact motion has lost.
      if (scene.system().damping())
        modal.end.work.dissipated =
            total_energy(scene.system(), scene.initial()) - total_energy(scene.system(), modal.end);
    }
    reference = joined(scene, modal, finest, effect);
  } else {
    reference = joined(scene, finest, best_fehlberg(scene, until, composed, 0.4 * seconds), effect);
  }
  reference.step_size = finest.knob;
  composed.rounding().tell(reference);
  reference.is_reduced_by_symmetry = is_reduced_by_symmetry(scene);
  if (start && reference.is_reduced_by_symmetry)
    reference.out_of_symmetry = out_of_symmetry(*start, scene, finest, until, seconds);
  if (reference.is_beyond_horizon()) measure_shares(reference, scene, finest, until, seconds);
  reference.seconds = seconds_since(begin);
  return reference;
}

}  // namespace qddot::inline measure
