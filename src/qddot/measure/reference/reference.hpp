#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "qddot/measure/motion/error.hpp"
#include "qddot/measure/reference/divergence.hpp"

namespace qddot::inline measure {

// The high-accuracy methods did not reach the end.
class NoReference : public std::runtime_error {
 public:
  explicit NoReference(const std::string& why, bool needs_time = false)
      : std::runtime_error(why), needs_time_(needs_time) {}

  // Whether more time might make one.
  bool needs_time() const { return needs_time_; }

 private:
  bool needs_time_;
};

// The effect of a push by one rounding on a motion that was computed in a plane, on a line or with
// mirror symmetry. The push moves all drawn nodes in all drawn dimensions.
struct OutOfSymmetry {
  double effect = 0;  // on the end, as a position error
  // The time [s], found or extrapolated, from which the pushed and the symmetric motion are
  // `apart`, and the rate [1/s] of their parting. Infinite and zero if they do not part.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
};

// The motion that errors are measured against, at its end, with a bound of its own error.
// `certified` is that bound, in the units of Errors (see joined in reference_ways.hpp); smaller
// errors mean nothing. The program fuzz_references shows how often the bound holds.
struct Reference {
  State end;
  double energy = 0;  // E(0) [J], which the exact motion keeps with what damping takes
  Scales scales;
  Errors certified;
  // The effect of one rounding of the start on the positions at the end, as a position error. Then
  // the factor by which it has grown. The rounding is a random displacement by about 2^-52 of the
  // extent, also of pins if the drawn scene is given and no symmetry reduces it. A motion is
  // chaotic if the effect grows exponentially.
  double rounding_effect = 0, perturbation_growth = 0;
  // The time [s] from which the displaced motion and the reference are `apart`, extrapolated if it
  // is after the end. Then the rate [1/s] at which they part. For regular motions they are infinite
  // and zero.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
  // The effect of a push on a motion that was reduced by symmetry. Empty if it was not, or if
  // finding the effect took too long.
  bool is_reduced_by_symmetry = false;
  std::optional<OutOfSymmetry> out_of_symmetry{};
  // The share of the kinetic energy in each mode (see ModalShares), if the end is beyond the
  // horizon; empty if not measured. The floor is the difference by chance to another motion with
  // nearly the same start.
  Vec modal_shares{};
  double modal_shares_floor = 0;
  std::string made_by;  // the two methods, with their options
  // The steps [s] of the method of fixed steps in it; 0 if it has none.
  double step_size = 0;
  double seconds = 0;  // time to make it [s]

  // Whether the motion at the end exists in exact symmetry alone: any push out of symmetry has
  // moved the nodes apart before the end, in less than 0.8 of the motion's own horizon. The
  // symmetric motion itself is known. All methods compute it on the same reduced system, so that
  // their errors still compare.
  bool is_only_symmetric() const {
    return out_of_symmetry && out_of_symmetry->horizon <= end.t &&
           out_of_symmetry->horizon < 0.8 * horizon;
  }
  // Whether the end is beyond the horizon: the positions are unknown and their errors mean nothing.
  bool is_beyond_horizon() const { return end.t >= horizon; }
  bool is_chaotic() const { return perturbation_growth > exponential_growth; }
};

// Called with the time [s] that a reference is likely to take, if that is long.
using Expect = std::function<void(double seconds)>;

// Makes the reference of a scene without massless nodes, in about `seconds` at most, by two
// methods:
//   linear motion (constant K):  modal, exact  -  Kahan and Li's order-8 composition;
//   else:  Kahan and Li's composition (symplectic, fixed step)  -  Fehlberg's 7(8) pair of
//          Boost.odeint (adaptive);
//   with dashpots, Prince and Dormand's order 8 (fixed step) is in the composition's place.
// Each is refined until only rounding changes the result, or until time is up. `start` is the scene
// that `scene` is the reduction of. If it is given, and its dimension or a mirror was reduced, the
// effect of a push is measured: a run of all drawn nodes, in up to `seconds` more. Throws
// NoReference if either method never reaches the end.
Reference make_reference(const Model& scene, double until, double seconds,
                         const Scene* start = nullptr, const Expect& expect = {});

// Makes a reference with a position error of at most `needed`, and no better than necessary, in
// about `seconds` at most. It is for springs so stiff that methods of high order would take hours
// to resolve their vibrations. Methods of two kinds are refined by turns, the cheapest next:
//   explicit and symplectic, with steps that resolve every vibration:  Verlet, Kahan-Li;
//   by error control, explicit and implicit:  Fehlberg's 7(8) pair, IDA;
// They end when one of each kind agree to needed/2, or when time is up; `certified` is twice the
// difference of the nearest two. Agreement within one kind proves nothing: implicit methods may
// agree in damping the same vibrations. Rounding is not measured. Throws NoReference if no method
// of a kind reaches the end.
Reference agreed_reference(const Model& scene, double until, double needed, double seconds);

// A sentence that names the scales of errors against the reference, with their values.
std::string what_divides(const Reference& reference);

// A sentence on symmetry: whether the motion exists in exact symmetry alone and what a push does to
// it, or that this took too long to find out. Empty otherwise.
std::string symmetry_in_words(const Reference& reference);

}  // namespace qddot::inline measure
