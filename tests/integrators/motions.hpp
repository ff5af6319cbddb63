#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "qddot/analysis/linear_motion.hpp"
#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// A system, a start and the end of the motion from there, exact to 1e-12 (see the suite `order`).
struct KnownMotion {
  std::string name;
  std::shared_ptr<const System> system;
  State start, end;

  KnownMotion(std::string what, const Problem& p, double until = 1)
      : name(std::move(what)),
        system(make_mass_spring(p.network)),
        start(p.initial),
        end(after(start, until)) {}
  // The motion from any start. Where K is not constant it takes 512 steps of order 8 a second:
  // truncation is far below rounding (96 steps leave 2e-12 m/s).
  State after(const State& from, double t) const {
    if (system->stiffness_is_constant()) return LinearMotion(*system).after(from, t);
    const double h = t / std::ceil(512 * t);
    return run(method_named("kahan_li8"), *system, from, from.t + t, {.step_size = h}).state;
  }
};

// Motions of two to three periods of the fastest mode.
inline std::vector<KnownMotion> whole_motions() {
  std::vector<KnownMotion> list = {{"oscillator", Oscillator{}.problem(), 2.4}};
  for (const int dimension : {1, 2, 3}) {
    list.emplace_back("linear hammock", linear_hammock(dimension));
    if (dimension > 1) list.emplace_back("hammock", hammock(dimension));
  }
  return list;
}

inline KnownMotion linear() { return {"linear hammock", linear_hammock(2)}; }
inline KnownMotion nonlinear() { return {"hammock", hammock(3)}; }

// The hammock released from rest. Its springs along the row are `ratio` times stiffer, at their
// drawn length, and named stiff; braces and anchors are soft.
inline Problem railed_hammock(double ratio) {
  Problem p = hammock(2);
  const auto at = [&](int i) { return p.initial.q.segment<2>(2 * i); };
  for (int e = 0; e < 3; ++e) {
    auto& link = p.network.links[static_cast<std::size_t>(e)];
    link.stiff = true;
    link.law = {.stiffness = 60 * ratio, .rest_length = (at(link.i) - at(link.j)).norm()};
  }
  p.initial.v.setZero();
  p.network.offers_split = true;
  return p;
}

// The same with every other spring named stiff, with all of them and with none.
inline std::vector<KnownMotion> split_motions() {
  std::vector<KnownMotion> list;
  for (const int dimension : {1, 2, 3}) {
    for (const Problem& p : {linear_hammock(dimension), hammock(dimension)}) {
      list.emplace_back("split hammock", Problem{with_split(p.network), p.initial});
    }
  }
  list.emplace_back("railed hammock", railed_hammock(20));
  const Problem p = hammock(2);
  list.emplace_back("soft hammock", Problem{with_all_named(p.network, false), p.initial});
  list.emplace_back("stiff hammock", Problem{with_all_named(p.network, true), p.initial});
  return list;
}

// The known motions that the method is made for.
inline std::vector<const KnownMotion*> motions_of(const Method& method) {
  static const std::vector<KnownMotion> whole = whole_motions(), split = split_motions();
  const bool needs_split = method.asks(Need::split_forces);
  std::vector<const KnownMotion*> list;
  for (const KnownMotion& motion : whole) {
    if (!needs_split) list.push_back(&motion);
  }
  for (const KnownMotion& motion : split) {
    if (needs_split || method.solves_stiff_part) list.push_back(&motion);
  }
  return list;
}

}  // namespace tests
}  // namespace qddot
