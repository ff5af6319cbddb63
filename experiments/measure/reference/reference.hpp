#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "qddot/measure/motion/error.hpp"
#include "qddot/measure/reference/divergence.hpp"
#include "qddot/measure/reference/no_reference.hpp"

namespace qddot::measure {

// What a push of one rounding does to a motion that stays in a plane, on a line or its own mirror
// image, and was computed there: all nodes pushed to all sides that were drawn.
struct OutOfSymmetry {
  double effect = 0;  // on the end, as a position error
  // From which time on [s] the pushed motion and the symmetric one are `apart`, found or
  // extrapolated, and how fast they part [1/s]; infinite and zero where they do not.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
};

// The motion that errors are measured against, at time `until`, and how far it can be trusted:
// `certified` bounds its error, in the units of Errors (see joined in reference_ways.hpp; the
// program fuzz_references shows how often that holds). No error below that means anything.
struct Reference {
  State end;
  double energy = 0;  // E(0) [J], which the exact motion keeps
  Scales scales;
  Errors certified;
  // What one rounding of the start (a random displacement of up to 2^-52 of the scene's extent)
  // does to the positions at the end, as a position error; and by what factor it has grown. What
  // grows exponentially is chaotic.
  double rounding_effect = 0, perturbation_growth = 0;
  // From which time on [s] that motion and the reference are `apart`, found or, after the end,
  // extrapolated; and how fast they part [1/s]. Infinite and zero for regular motions.
  double horizon = std::numeric_limits<double>::infinity(), lyapunov = 0;
  // What a push does to a motion that symmetry reduced; missing where none did, or where finding
  // out took too long.
  bool is_reduced_by_symmetry = false;
  std::optional<OutOfSymmetry> out_of_symmetry{};
  // Beyond the horizon, what part of the kinetic energy is in each mode (see ModalShares), and by
  // how much that of another motion with nearly the same start differs by chance; empty where it
  // was not measured.
  Vec modal_shares{};
  double modal_shares_floor = 0;
  std::string made_by;  // the two ways, with their options
  double seconds = 0;   // what it took

  // Whether the motion at the end exists in exact symmetry alone: computed there it is known, but
  // any push out of it has parted the nodes long before (in less than 0.8 of the motion's own
  // horizon). Errors against it are those of computing the symmetric motion, which is what all
  // methods do on the same reduced system, so that they still compare.
  bool is_only_symmetric() const {
    return out_of_symmetry && out_of_symmetry->horizon <= end.t &&
           out_of_symmetry->horizon < 0.8 * horizon;
  }
  // Whether the end is so late that nobody knows the positions: their errors mean nothing.
  bool is_beyond_horizon() const { return end.t >= horizon; }
  bool is_chaotic() const { return perturbation_growth > exponential_growth; }
};

// Is told how long [s] a reference is likely to take, where that is long.
using Expect = std::function<void(double seconds)>;

// Makes the reference of a scene without massless nodes, in about `seconds` at most. The two ways:
//   linear motion (constant K):  modal, exact  -  Kahan and Li's order-8 composition;
//   else:  Kahan and Li's composition (symplectic, fixed step)  -  Fehlberg's 7(8) pair of
//          Boost.odeint (adaptive).
// Each is refined until only rounding changes it any more, or time is up. Where `start` is given,
// of which `scene` is the reduction, and its dimension or a mirror was reduced, another run of all
// that was drawn shows what a push does to it, in at most as long again. Throws NoReference if
// either way never reaches the end.
Reference make_reference(const ReducedScene& scene, double until, double seconds,
                         const Scene* start = nullptr, const Expect& expect = {});

// Makes a reference that is good to the position error `needed` and no better than that takes, in
// some `seconds` at most: where springs are so stiff that methods of high order would resolve their
// vibrations for hours. Ways of two kinds are refined by turns, the cheapest next,
//   explicit and symplectic, with steps that resolve every vibration:  Verlet, Kahan-Li;
//   by error control, explicit and implicit:  Fehlberg's 7(8) pair, IDA;
// until one of either kind agree to half of it, or time is up: `certified` is then twice the
// difference of the nearest two. Two of one kind prove nothing: implicit methods may agree on
// having damped what vibrates. Rounding is not measured. Throws NoReference if a kind never reaches
// the end.
Reference agreed_reference(const ReducedScene& scene, double until, double needed, double seconds);

}  // namespace qddot::measure
