
#include <fmt/format.h>

#include "qddot/scene/reduce/as_drawn.hpp"
#include "qddot/scene/reduce/part.hpp"

namespace qddot::reduce {
namespace {

std::string instead_of(const char* what, double reduced, double drawn, const char* unit) {
  return fmt::format("{} would be {:.10g} {} instead of {:.10g}", what, reduced, unit, drawn);
}

}  // namespace

DrawnEnergies::DrawnEnergies(const DrawnPart& drawn) {
  const double farthest = largest_coordinate(drawn.x);
  tolerances = tolerances_of(farthest, largest_coordinate(drawn.v));
  DrawnKinetic masses(tolerances);
  for (std::size_t i = 0; i < drawn.x.size(); ++i) masses.add(drawn.mass[i], drawn.velocity_of(i));
  kinetic = masses.sum();
  DrawnPotential all(drawn.gravity, tolerances, farthest);
  for (int e = 0; e < drawn.springs.size(); ++e) {
    const auto [a, b] = drawn.springs.ends(e);
    all.add(drawn.springs.law(e),
            (drawn.x[static_cast<std::size_t>(b)] - drawn.x[static_cast<std::size_t>(a)]).norm());
  }
  for (std::size_t i = 0; i < drawn.x.size(); ++i) {
    all.add(drawn.mass[i], drawn.x[i], drawn.load_of(i));
  }
  potential = all.sum();
}

std::optional<std::string> Part::difference_from(const DrawnPart& drawn,
                                                 const DrawnEnergies& energies) const {
  const Tolerances& tolerances = energies.tolerances;
  if (auto where = places_differ(drawn, tolerances.place, tolerances.speed)) return where;
  if (auto mass = masses_differ(drawn)) return mass;
  const BoundedEnergy &t = energies.kinetic, &v = energies.potential;
  if (const double own = system_->kinetic(initial_.v); differs(t, own)) {
    return instead_of("the kinetic energy at the start", own, t.value, "J");
  }
  if (const double own = system_->potential(initial_.q); differs(v, own)) {
    return instead_of("the potential energy at the start", own, v.value, "J");
  }
  return {};
}

std::optional<std::string> Part::places_differ(const DrawnPart& drawn, double tolerance,
                                               double speed_tolerance) const {
  if (nodes_.size() != drawn.free) {
    return fmt::format("{} of {} nodes would move", nodes_.size(), drawn.free);
  }
  for (std::size_t i = 0; i < drawn.free; ++i) {
    if (nodes_[i] != drawn.nodes[i]) return fmt::format("node {} would not move", drawn.nodes[i]);
    const Motion start = motion(i, initial_.q, initial_.v);
    const double off = (start.x - drawn.x[i]).norm();
    if (off > tolerance) {
      return fmt::format("node {} would start {:.3g} m from its place", drawn.nodes[i], off);
    }
    const double speed_off = (start.v - drawn.velocity_of(i)).norm();
    if (speed_off > speed_tolerance) {
      return fmt::format("node {} would start with a velocity off by {:.3g} m/s", drawn.nodes[i],
                         speed_off);
    }
  }
  return {};
}

// P'M_full P is diagonal: the masses of all images of each original.
std::optional<std::string> Part::masses_differ(const DrawnPart& drawn) const {
  Vec mass = Vec::Zero(initial_.q.size());
  std::vector<bool> moves(static_cast<std::size_t>(mass.size()), false);
  for (std::size_t i = 0; i < drawn.free; ++i) {
    const Unknowns& unknowns = layout_[static_cast<std::size_t>(images_[i].original)];
    for (int a = 0; a < unknowns.count; ++a) {
      mass[unknowns.first + a] += drawn.mass[i];
      moves[static_cast<std::size_t>(unknowns.first + a)] = true;
    }
  }
  for (Index k = 0; k < mass.size(); ++k) {
    if (!moves[static_cast<std::size_t>(k)]) continue;  // the column of a pinned node
    const double own = system_->mass()[k];
    if (std::abs(own - mass[k]) > rounding * mass[k]) {
      return instead_of("a mass", own, mass[k], "kg");
    }
  }
  return {};
}

}  // namespace qddot::reduce
