#include "tests/independent/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "qddot/analysis/damped_step.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/deadline.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"
#include "qddot/scene/reduce/part.hpp"

namespace qddot {
inline namespace tests {
namespace {

using Plain = PlainMotion<long double>;

constexpr long double plain_tolerance = 1e-15L;
constexpr double epsilon = 0x1p-52;
constexpr double longest_run = 20;  // [s], so that nothing hangs

bool has_velocity(const Node& node) { return node.pinned || node.mass > 0; }

struct NamedReductions {
  std::string name;
  Reductions set;
};

std::vector<NamedReductions> sets_of_reductions() {
  std::vector<NamedReductions> sets = {{"all reductions", {}},
                                       {"no reduction", Reductions::only({})}};
  for (std::size_t i = 0; i < reduction_names.size(); ++i) {
    const auto reduction = static_cast<Reduction>(i);
    sets.push_back({fmt::format("{} alone", name(reduction)), Reductions::only({reduction})});
    sets.push_back({fmt::format("all but {}", name(reduction)), Reductions().without(reduction)});
  }
  return sets;
}

// The scene's nodes as they are in that state.
std::vector<Node> nodes_at(const Scene& scene, const PlainState<long double>& state) {
  std::vector<Node> nodes = scene.nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Eigen::Index>(c);
      nodes[i].position[axis] = static_cast<double>(state.x[3 * i + c]);
      nodes[i].velocity[axis] = static_cast<double>(state.v[3 * i + c]);
    }
  }
  return nodes;
}

// Energies of nodes with these positions and velocities, by the independent model.
struct PlainEnergies {
  long double kinetic = 0, potential = 0;  // [J]
  // The factors by which rounding of coordinates enters the potential and a force.
  long double potential_size = 0, force_size = 0;
  std::vector<long double> force{};  // on free nodes, weights and loads included
};

PlainEnergies plain_energies(const PlainModel<long double>& model, const std::vector<Node>& nodes,
                             double t) {
  std::vector<long double> x, v;
  for (const Node& node : nodes) {
    x.insert(x.end(), node.position.begin(), node.position.end());
    v.insert(v.end(), node.velocity.begin(), node.velocity.end());
  }
  PlainEnergies plain;
  model.forces_without_weights(x, plain.force);
  model.add_friction(x, v, plain.force);
  std::vector<long double> driven(x.size(), 0), from_origin = x;
  for (std::size_t c = 0; c < x.size(); ++c) from_origin[c] -= model.origin()[c % 3];
  model.add_driven_loads(t, driven);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Node& node = model.scene().nodes[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const long double weight =
          node.pinned ? 0 : node.mass * model.scene().gravity[static_cast<Eigen::Index>(c)];
      if (node.pinned) plain.force[3 * i + c] = 0;
      plain.force[3 * i + c] += driven[3 * i + c];
      plain.potential_size += std::abs(driven[3 * i + c] * x[3 * i + c]);
      plain.force_size += std::abs(driven[3 * i + c]);
      if (!node.pinned) plain.kinetic += 0.5L * node.mass * v[3 * i + c] * v[3 * i + c];
      const double load = node.acting_load()[static_cast<Eigen::Index>(c)];
      plain.force[3 * i + c] += weight;
      for (const long double own : {weight, static_cast<long double>(load)}) {
        plain.potential_size += std::abs(own * x[3 * i + c]);
        plain.force_size += std::abs(own);
      }
      plain.force_size += model.scene().air_damping * node.mass * std::abs(v[3 * i + c]);
    }
  }
  plain.potential = model.energy(x, std::vector<long double>(v.size(), 0)) +
                    model.energy_of_driven_loads(t, from_origin, false);
  for (const Spring& spring : model.scene().springs) {
    long double l2 = 0, far = spring.law.rest_length;
    for (std::size_t c = 0; c < 3; ++c) {
      const long double a = x[3 * spring.nodes[0] + c], b = x[3 * spring.nodes[1] + c];
      l2 += (a - b) * (a - b);
      far = std::max({far, std::abs(a), std::abs(b)});
    }
    // dV = tau dl and dtau = tau' dl, of lengths that are known to eps of a coordinate.
    const long double s = std::sqrt(l2) - spring.law.rest_length;
    const long double k = spring.law.stiffness, c = spring.law.quartic, rounding = epsilon * far;
    plain.potential_size += std::abs(s) * (k + c * s * s) * far + k * rounding * far;
    plain.force_size += (k + 3 * c * s * s) * far;
    // Directions are known to eps of a coordinate over the length.
    long double fast = 0;
    for (const std::size_t end : spring.nodes) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        fast = std::max(fast, std::abs(v[3 * end + axis]));
    }
    plain.force_size += 2 * spring.law.damping * fast * (1 + (l2 > 0 ? far / std::sqrt(l2) : 0));
  }
  return plain;
}

// Differences of the reduced scene's energies and force at a state to those of all nodes.
void compare_state(const Model& reduced, const PlainModel<long double>& model, const State& state,
                   std::mt19937_64& random, const std::string& where, Comparisons& all) {
  ++all.states;
  const auto nodes = reduced.expand(state);
  const PlainEnergies plain = plain_energies(model, nodes, state.t);
  const auto agree = [&](const char* what, double value, long double expected, long double size) {
    // Sums over some tens of nodes and springs.
    if (std::abs(value - expected) <= 64 * epsilon * size) return;
    all.disagreements.push_back(fmt::format("{}: {} is {:.17g}, of the drawn nodes {:.17g}", where,
                                            what, value, static_cast<double>(expected)));
  };
  agree("the kinetic energy", reduced.kinetic(state), plain.kinetic, plain.kinetic);
  agree("the potential energy", reduced.potential(state), plain.potential, plain.potential_size);

  // If x = P q + c, then f_reduced . w = f . P w for every w; P w is a difference of velocities.
  const Index n = reduced.system().size();
  Vec w(n), f(n);
  std::normal_distribution<double> normal;
  for (double& component : w) component = normal(random);
  reduced.system().force(state, f);
  const auto fast = reduced.expand({state.t, state.q, w});
  const auto still = reduced.expand({state.t, state.q, Vec::Zero(n)});
  // Seen from the frame that falls with a part, its nodes lack the force of that fall.
  std::vector<Eigen::Vector3d> fall(nodes.size(), Eigen::Vector3d::Zero());
  for (const qddot::reduce::Part& part : reduced.parts()) {
    const auto& own = part.fall();
    for (const std::size_t node : part.nodes()) {
      fall[node] = own.gravity - own.air_damping * own.velocity_at(state.t);
    }
  }
  long double power = 0, fastest = w.norm();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const long double own = fast[i].velocity[c] - still[i].velocity[c];
      const long double of_fall = static_cast<long double>(nodes[i].mass) * fall[i][c];
      power += (plain.force[3 * i + static_cast<std::size_t>(c)] - of_fall) * own;
      fastest = std::max(fastest, std::abs(own));
    }
  }
  agree("the power of the force", f.dot(w), power, plain.force_size * fastest);
}

// The end of a run with samples nowhere, or why there is none.
struct End {
  Summary summary;
  std::vector<Node> nodes;
  double dissipated = 0, driven = 0;  // [J]
};

End run(const Model& reduced, const Method& method, double knob, double until) {
  Options options;
  (method.knob == Knob::step_size ? options.step_size : options.rtol) = knob;
  State state = reduced.initial();
  const Deadline deadline(longest_run);
  const Summary summary =
      make_integrator(method, reduced.system(), with_tolerance_scales(options, reduced))
          ->advance(state, until, {}, deadline.token());
  return {summary, reduced.expand(state), reduced.dissipated(state), reduced.driven(state)};
}

// A step that resolves the fastest frequency of all springs, lest a spring turn over in one.
double resolving_step(const Model& reduced, double until) {
  const double w = frequency_bound(reduced.system(), reduced.initial().q);
  // Massless nodes have no frequency; the others' horizon is some vibrations.
  if (!std::isfinite(w)) return until / 1000;
  // Beside dashpots the limit of symmetric4 is the shortest, 0.36 of Verlet's.
  const double limit = damped_step_limit(reduced.system(), reduced.initial().q, 2);
  return until / std::max({32.0, std::ceil(until * w / 0.2), std::ceil(4 * until / limit)});
}

bool can_take(const Method& method, const Model& reduced) {
  return applies_to(method, reduced.system()) &&
         (method.is(Trait::accepts_massless) || !reduced.system().has_massless());
}

// Three runs at smaller and smaller options. What a method still changes by is about what is wrong
// with it. Springs that pass length zero closely make that irregular; a wrong model or formula is
// off by what no knob changes.
void compare_runs(const DrawnMotion& motion, const Model& reduced, const Method& method,
                  std::array<double, 3> options, const std::string& where, Comparisons& all) {
  constexpr double irregular = 30;
  std::array<End, 3> ends;
  for (std::size_t i = 0; i < 3; ++i) {
    ++all.runs;
    ends[i] = run(reduced, method, options[i], motion.until());
    const Outcome outcome = ends[i].summary.outcome;
    const double t = ends[i].summary.t_reached;
    if (outcome == Outcome::over_budget) return;
    if (method.is(Trait::implicit) &&
        (outcome == Outcome::newton_failed || outcome == Outcome::indefinite_matrix)) {
      ++all.given_up;  // beside such a spring K changes within any step
      return;
    }
    const std::string run_name = fmt::format("{}, {} at {:.3g}", where, method.name, options[i]);
    if (outcome != Outcome::reached_end && motion.is_known()) {
      all.disagreements.push_back(fmt::format("{}: ends with {} at {:.6g} of {:.6g} s: {}",
                                              run_name, name(outcome), t, motion.until(),
                                              ends[i].summary.message));
      return;
    }
    // When exactly, a run knows no better than where the nodes are.
    const double latest = motion.known_until() + 0.02 * motion.until();
    if (!motion.is_known() && !(t <= latest)) {
      all.disagreements.push_back(
          fmt::format("{}: goes on to {:.6g} s, where a massless node lost its place at {:.6g} s",
                      run_name, t, motion.known_until()));
      return;
    }
  }
  if (!motion.is_known()) return;
  const double error = motion.error(ends[2].nodes);
  const double change = std::max(motion.difference(ends[0].nodes, ends[1].nodes),
                                 motion.difference(ends[1].nodes, ends[2].nodes));
  if (!(error <= irregular * change + motion.floor())) {
    all.disagreements.push_back(fmt::format(
        "{}, {} at {:.3g}: {:.3g} off, where it changed by {:.3g} and rounding by {:.3g}", where,
        method.name, options[2], error, change, motion.floor()));
  }
  const auto apart = [&](double a, double b) { return std::abs(a - b) / motion.energy_size(); };
  const auto compare = [&](const char* what, double End::*energy, double expected) {
    const double off = apart(ends[2].*energy, expected);
    const double moved =
        std::max(apart(ends[0].*energy, ends[1].*energy), apart(ends[1].*energy, ends[2].*energy));
    // The method of order p has work to that order; it may be small by chance where positions are
    // not.
    // The extrapolation controls no error of work.
    constexpr double own = 1e-9;
    if (off <= irregular * std::max(moved, change) + motion.floor() + own) return;
    all.disagreements.push_back(fmt::format(
        "{}, {} at {:.3g}: the {} energy is {:.17g}, of the drawn nodes {:.17g}; {:.3g} "
        "off, where it changed by {:.3g}",
        where, method.name, options[2], what, ends[2].*energy, expected, off, moved));
  };
  compare("dissipated", &End::dissipated, motion.dissipated());
  compare("driven", &End::driven, motion.driven());
}

}  // namespace

DrawnMotion::DrawnMotion(const Scene& scene) : scene_(scene), end_(scene, plain_tolerance) {
  const bool is_known = end_.advance(until());
  // A motion without massless nodes that took too many steps says nothing of where others end.
  const bool has_place = std::ranges::all_of(scene.nodes, has_velocity);
  known_until_ = is_known ? until() : has_place ? 0 : static_cast<double>(end_.state().t);
  if (!is_known) return;
  const std::vector<Node> nodes = nodes_at(scene, end_.state());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    displacement_ = std::max(displacement_, (nodes[i].position - scene.nodes[i].position).norm());
    if (!has_velocity(scene.nodes[i])) continue;
    speed_ = std::max({speed_, nodes[i].velocity.norm(), scene.nodes[i].velocity.norm()});
  }
  displacement_ = std::max(displacement_, speed_ * until());
  if (speed_ == 0) displacement_ = speed_ = 1;
  for (const Node& node : scene.nodes) {
    if (!node.pinned) energy_size_ += 0.5 * node.mass * speed_ * speed_;
  }
  energy_size_ = std::max({energy_size_, dissipated(), std::abs(driven())});

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> part(-1, 1);
  Plain moved(scene, plain_tolerance);
  double far = 0;
  for (const Node& node : scene.nodes) far = std::max(far, node.position.lpNorm<Eigen::Infinity>());
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned) continue;
    for (std::size_t c = 0; c < static_cast<std::size_t>(scene.dimension); ++c)
      moved.displace(3 * i + c, epsilon * far * part(random), epsilon * speed_ * part(random));
  }
  if (!moved.advance(until())) {
    floor_ = 1;
    return;
  }
  const double moved_by = difference(nodes, nodes_at(scene, moved.state()));
  floor_ = 1000 * (moved_by + epsilon * (far / displacement_ + 1));
}

double DrawnMotion::difference(const std::vector<Node>& a, const std::vector<Node>& b) const {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    double apart = (a[i].position - b[i].position).norm() / displacement_;
    if (has_velocity(scene_.nodes[i]))
      apart = std::max(apart, (a[i].velocity - b[i].velocity).norm() / speed_);
    if (!(apart <= largest)) largest = apart;
  }
  return largest;
}

double DrawnMotion::error(const std::vector<Node>& nodes) const {
  return difference(nodes, nodes_at(scene_, end_.state()));
}

Comparisons& Comparisons::operator+=(const Comparisons& more) {
  states += more.states;
  motions += more.motions;
  runs += more.runs;
  given_up += more.given_up;
  disagreements.insert(disagreements.end(), more.disagreements.begin(), more.disagreements.end());
  return *this;
}

Comparisons compare_states(const Scene& scene, std::uint64_t seed) {
  Comparisons all;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const PlainModel<long double> model(scene);
  for (const auto& [name, set] : sets_of_reductions()) {
    const Model reduced(scene, set);
    State state = reduced.initial();
    compare_state(reduced, model, state, random, name + ", at the start", all);
    double drawn = 0;
    for (const Node& node : scene.nodes) {
      if (!node.pinned) drawn += 0.5 * node.mass * node.velocity.squaredNorm();
    }
    if (!(std::abs(reduced.kinetic(state) - drawn) <= 64 * epsilon * drawn)) {
      all.disagreements.push_back(fmt::format("{}: the kinetic energy at the start is {}, drawn {}",
                                              name, reduced.kinetic(state), drawn));
    }
    // Unknowns of pins stay where they are.
    const bool holds_pins =
        !set.has(Reduction::pins) && std::ranges::any_of(scene.nodes, &Node::pinned);
    for (int near = 0; near < 2 && !holds_pins; ++near) {
      // So near that no spring turns over and none in series goes slack.
      for (double& x : state.q) x += 1e-4 * normal(random);
      for (double& w : state.v) w = normal(random);
      const bool falls = std::ranges::any_of(
          reduced.parts(), [](const qddot::reduce::Part& part) { return part.fall().moves(); });
      if (is_driven(scene) && !falls) state.t += 0.1 * *scene.until;
      const auto* validity = reduced.system().validity();
      if (validity && !validity->is_valid_at(state)) break;
      compare_state(reduced, model, state, random, name + ", near the start", all);
    }
  }
  return all;
}

Comparisons compare_reductions(const DrawnMotion& motion) {
  Comparisons all;
  if (motion.known_until() == 0) return all;
  ++all.motions;
  for (const auto& [name, set] : sets_of_reductions()) {
    const Model reduced(motion.scene(), set);
    if (reduced.system().has_massless()) {
      compare_runs(motion, reduced, *find_method("ida"), {1e-6, 1e-7, 1e-8}, name, all);
    } else if (is_damped(motion.scene())) {
      compare_runs(motion, reduced, *find_method("arkode_erk8"), {1e-7, 1e-8, 1e-9}, name, all);
    } else {
      const double h = resolving_step(reduced, motion.until());
      compare_runs(motion, reduced, *find_method("kahan_li8"), {h, h / 2, h / 4}, name, all);
    }
  }
  return all;
}

Comparisons compare_methods(const DrawnMotion& motion) {
  Comparisons all;
  if (motion.known_until() == 0) return all;
  ++all.motions;
  const Model reduced(motion.scene());
  const double h = resolving_step(reduced, motion.until());
  for (const Method& method : methods()) {
    if (!can_take(method, reduced)) continue;
    // A method of order 1 gains or loses a part of h w^2 T / 2 of the motion.
    const double own = method.order == 1 ? h / 16 : h;
    const bool is_fixed = method.knob == Knob::step_size;
    const std::array<double, 3> options =
        is_fixed ? std::array{own, own / 2, own / 4} : std::array{1e-5, 1e-6, 1e-7};
    compare_runs(motion, reduced, method, options, "all reductions", all);
  }
  return all;
}

}  // namespace tests
}  // namespace qddot
