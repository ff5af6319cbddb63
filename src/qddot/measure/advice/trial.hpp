#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "qddot/integrators/method.hpp"
#include "qddot/measure/advice/rules.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/pushed_start.hpp"

namespace qddot::inline measure {

// The error that an accuracy bounds: of the positions at the end, of the positions at any time, or
// of the energy at any time over the largest kinetic energy.
enum class AccuracyOf { positions, path, energy };

// The smallest accuracy that can be asked for; smaller errors, and tolerances, are below rounding.
constexpr double least_accuracy = 1e-14;

// A whole run of a method, seen at the times of its stage.
struct Trial {
  const Method* method = nullptr;
  double value = 0;  // of its knob: h [s] or rtol
  Summary summary{};
  double seconds = 0;  // wall time of the run
  // States at the times that the run reached, the end last.
  std::vector<State> path{};
  // The largest |E - E(0)| and the largest E - E(0) [J], at all steps if the energy is asked for,
  // and at the times of the stage.
  double energy_gap = 0, energy_gain = 0;
  bool is_pushed = false;  // began one rounding away, so it may check a run but be no answer
  bool only_end = false;   // was not seen on the way

  bool reached_end() const { return summary.outcome == Outcome::reached_end; }
};

// The numbers of the springs that broke, ascending.
std::vector<Index> broken_springs(const Trial& trial);

// The limits of a run. A limit of forces ends it after the same work on every machine.
struct Limits {
  double seconds = std::numeric_limits<double>::infinity();
  std::int64_t forces = 0;  // evaluations of f; 0: no limit
  // No looks on the way, as they end steps of some methods. Only positions do without them.
  bool only_end = false;
};

// The motion that trials compute: a model up to a time, seen at random times. No motion can be in
// step with these looks (see random_times.hpp).
class Stage {
 public:
  // Borrows the model and, if given, the scene that it is the reduction of.
  Stage(const Model& model, double until, AccuracyOf of, const Scene* drawn, const Rules& rules);

  // Looks also within the steps of a run, at random times in each of some of them: short steps are
  // where a motion is fast, and where errors on the way may be largest.
  void look_within_steps(const Method& method, double value, const Limits& limits);

  // Measures energies from where massless nodes are in balance. Those that start beside it go there
  // at once, and the exact motion keeps the energy that is left. The method accepts such nodes.
  void begin_in_balance(const Method& method);

  // Runs the method from the start to the end. If that takes a short time, it is done twice, as in
  // time_again().
  Trial run(const Method& method, double value, const Limits& limits) const;
  // The same from a start that is pushed.
  Trial run_pushed(const Method& method, double value, const Limits& limits,
                   const Push& push) const;
  // Repeats a trial that reached the end in a short time, without looks; its time becomes the
  // lesser one.
  void time_again(Trial& trial) const;

  // Takes the scales of errors from the trial, which reached the end. Errors need this first.
  void measure_by(const Trial& trial);

  // The distance of two trials that reached the end, infinite if other springs broke; relative to
  // the motion: at the end, or the largest at any look if the path is asked for.
  double distance(const Trial& one, const Trial& other) const;
  // The distance at each look.
  std::vector<double> distances(const Trial& one, const Trial& other) const;
  // The smallest displacement [m] that errors of a part are measured by.
  double least_scale() const;
  // The largest of small displacements of the unknowns [m], n, as a distance.
  double relative(const Vec& displacements) const;
  // One rounding of the start, as a distance.
  double rounding() const;
  // That of a motion computed mode by mode, with `bound_of_w` no less than the largest frequency
  // [rad/s].
  double rounding_of_modes(double bound_of_w) const;
  // Whether nothing moves by more than the rounding of its positions.
  bool rests() const { return rests_; }

  // Whether the forces are those of springs that were drawn, and not of a caller's own system.
  bool has_springs() const { return drawn_ && !drawn_->springs.empty(); }
  // Whether a dimension or a mirror was reduced of springs that were drawn. Without springs nothing
  // leads out of either.
  bool is_reduced_by_symmetry() const;
  // Runs the method on the scene as it was drawn, with all nodes pushed in all dimensions, and
  // gives the distances from the trial. Empty if the run fails or there is no scene of springs.
  std::vector<double> distances_as_drawn(const Trial& trial, const Method& method, double value,
                                         const Limits& limits, const Push& push = {}) const;

  // The largest relative error of the energy on the way, if the energy is asked for.
  double energy_error(const Trial& trial) const;

  // The relative error of the energy if each position along the trial is rounded at random, and of
  // the energy's own rounding: the largest at its looks.
  double energy_rounding(const Trial& trial) const;

  const Model& model() const { return model_; }
  double until() const { return until_; }
  AccuracyOf of() const { return of_; }
  const std::vector<double>& times() const { return times_; }
  const Scales& scales() const { return scales_; }
  const Rules& rules() const { return rules_; }

 private:
  // The largest kinetic energy, or 1 J if nothing moves.
  double energy_scale() const;
  // Makes the integrator of a run.
  std::unique_ptr<Integrator> integrator(const Model& model, const Method& method, double value,
                                         const Limits& limits) const;
  using See = std::function<void(const State&)>;
  // `see_step`, if set, takes the place of a look at the energy after each step.
  Trial run_by(Integrator& integrator, const Model& model, const State& start, const Method& method,
               double value, const Limits& limits, const See& see_step = {}) const;
  bool is_short(const Trial& trial) const;
  void time_again(Trial& trial, Integrator& integrator) const;

  const Model& model_;
  double until_;
  AccuracyOf of_;
  const Scene* drawn_;
  Rules rules_;
  std::vector<double> times_;
  Scales scales_;
  bool rests_ = false;
  double energy_lost_at_start_ = 0;  // [J], at most zero
  mutable Alarm alarm_;              // for the limits of all runs
};

}  // namespace qddot::inline measure
