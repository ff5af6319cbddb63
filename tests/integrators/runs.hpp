#pragma once

#include <functional>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>

#include "qddot/integrators/registry.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

namespace qddot {
inline namespace tests {

struct Run {
  Summary summary;
  State state;
  std::string thrown{};  // what its system or observer threw; then there is no summary
};

// A run by a new integrator.
inline Run run(const Method& method, const System& system, State state, double t_end,
               const Options& options, const Observer& observer = {}, std::stop_token stop = {}) {
  const auto integrator = make_integrator(method, system, options);
  try {
    Summary summary = integrator->advance(state, t_end, observer, std::move(stop));
    return {std::move(summary), std::move(state)};
  } catch (const std::runtime_error& error) {
    Summary summary;
    summary.t_reached = state.t;
    return {std::move(summary), std::move(state), error.what()};
  }
}

// Orders of convergence seen in positions and in velocities.
struct Orders {
  double q, v;
};

// The one of the two that is the method's knob.
inline Options options_of(const Method& method, double step_size, double rtol) {
  return method.knob == Knob::step_size ? Options{.step_size = step_size} : Options{.rtol = rtol};
}

// The method of that name; throws for an unknown one.
inline const Method& method_named(std::string_view name) {
  const Method* found = find_method(name);
  if (!found) throw std::invalid_argument("no method is named " + std::string(name));
  return *found;
}

// The state of the tests' networks after `until` seconds, exact to 1e-12 (see the suite `order`).
inline State by_kahan_li(const System& system, const State& start, double until) {
  return run(method_named("kahan_li8"), system, start, until, {.step_size = 1. / 512}).state;
}

// The methods that take any system; others have tests of their own.
inline std::vector<Method> general_methods() {
  std::vector<Method> list;
  for (const Method& method : methods()) {
    if (!method.asks(Need::constant_stiffness) && !method.asks(Need::split_forces))
      list.push_back(method);
  }
  return list;
}

// Whether the method evaluates K where there is one: because it needs it, or to bound its steps.
inline bool evaluates_stiffness(const Method& method) {
  return method.asks(Need::stiffness) || method.is(Trait::bounds_steps);
}
inline std::vector<Method> methods_of(Family family) {
  std::vector<Method> list = general_methods();
  std::erase_if(list, [&](const Method& method) { return method.family != family; });
  return list;
}
inline std::vector<Method> methods_of(Knob knob) {
  std::vector<Method> list = general_methods();
  std::erase_if(list, [&](const Method& method) { return method.knob != knob; });
  return list;
}

inline std::vector<Method> methods_of(Family family, Knob knob) {
  std::vector<Method> list = methods_of(family);
  std::erase_if(list, [&](const Method& method) { return method.knob != knob; });
  return list;
}

// Whether torques cancel in each of its steps, where every spring has a rest length.
inline bool keeps_angular_momentum(const Method& method) {
  return method.is(Trait::symplectic) || method.is(Trait::cancels_torques);
}

// The larger of the errors in q and in v.
inline double distance(const State& a, const State& b) {
  return std::max(distance(a.q, b.q), distance(a.v, b.v));
}

// The order p of a method that chooses its steps, from `start` to `exact`. If each step is as long
// as its error allows, errors are proportional to steps^-p. p is the slope of the line through 13
// runs, from the given tolerance to a thousandth of it, as errors of single runs cancel by chance.
inline double order_by_tolerance(const Method& method, const System& system, const State& start,
                                 const State& exact, double coarsest_rtol) {
  constexpr int runs = 13;
  Vec steps(runs), error(runs);
  for (int i = 0; i < runs; ++i) {
    const Run r =
        run(method, system, start, exact.t, {.rtol = coarsest_rtol * std::pow(10, -i / 4.0)});
    steps[i] = std::log(static_cast<double>(r.summary.counts.steps));
    error[i] = std::log(distance(r.state, exact));
  }
  return -slope(steps, error);
}

inline bool is_finite(const State& state) {
  return std::isfinite(state.t) && state.q.allFinite() && state.v.allFinite();
}

// Whether the states are equal to the last bit.
inline bool same(const State& a, const State& b) { return a.t == b.t && a.q == b.q && a.v == b.v; }

inline std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.steps << " steps, " << c.rejected << " rejected, " << c.force_evaluations
             << " forces, " << c.stiffness_evaluations << " stiffnesses, " << c.factorizations
             << " factorisations (" << c.indefinite_factorizations << " indefinite), " << c.solves
             << " solves, " << c.newton_iterations << " iterations, orders " << c.order_sum << " ("
             << c.order_reductions << " reductions), " << c.stability_limited_steps << " limited";
}

// Passes calls on to another system, and lets a test see or change the results. It offers the
// capabilities below.
class Relay final : public System,
                    public SplitStiffness,
                    public DiscreteGradient,
                    public Laplacian {
 public:
  explicit Relay(const System& system) : System(system.mass()), system_(system) {}

  double potential(const ConstVec& q) const override { return system_.potential(q); }
  void force(const ConstVec& q, MutableVec f) const override {
    system_.force(q, f);
    if (after_force) after_force(q, f);
  }
  void stiffness(const ConstVec& q, SymmetricMatrix& k) const override {
    system_.stiffness(q, k);
    if (after_stiffness) after_stiffness(q, k);
  }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return system_.stiffness_is_constant(); }
  bool offers(const std::type_info& type) const override {
    if (type == typeid(SplitStiffness)) return capability<SplitStiffness>(system_);
    if (type == typeid(DiscreteGradient)) return capability<DiscreteGradient>(system_);
    return capability<Laplacian>(system_);
  }

  void weighted_stiffness(const ConstVec& q, double compression_weight,
                          SymmetricMatrix& k) const override {
    offered<SplitStiffness>(system_).weighted_stiffness(q, compression_weight, k);
    if (after_stiffness) after_stiffness(q, k);
  }
  void material_stiffness(const ConstVec& q, SymmetricMatrix& k) const override {
    offered<SplitStiffness>(system_).material_stiffness(q, k);
    if (after_stiffness) after_stiffness(q, k);
  }
  void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) const override {
    offered<DiscreteGradient>(system_).discrete_gradient(a, b, f);
    if (after_force) after_force(b, f);
  }
  void laplacian(SymmetricMatrix& l) const override { offered<Laplacian>(system_).laplacian(l); }
  bool bounds_stiffness() const override { return offered<Laplacian>(system_).bounds_stiffness(); }

  std::function<void(const ConstVec& q, MutableVec f)> after_force;
  std::function<void(const Vec& q, SymmetricMatrix& k)> after_stiffness;

 private:
  const System& system_;
};

// The hammock with every spring of zero rest length: K is constant, no two nodes or directions
// alike.
inline Problem linear_hammock(int dimension) {
  Problem p = hammock(dimension);
  const auto straighten = [](auto& springs) {
    for (auto& spring : springs) spring.law.rest_length = spring.law.quartic = 0;
  };
  straighten(p.network.links);
  straighten(p.network.anchors);
  return p;
}

// n masses in 1D between two pins at 0 and n + 1, on n + 1 equal springs of zero rest length. Mode
// j = 1 ... n has the frequency 2 sqrt(k/m) sin(j pi / (2 (n + 1))) and the shape sin(i j pi / (n +
// 1)), i = 1 ... n.
inline Network linear_chain(int n, double mass, double stiffness) {
  Network network{.dimension = 1, .node_mass = Vec::Constant(n, mass)};
  for (int i = 0; i + 1 < n; ++i) network.links.push_back({i, i + 1, {stiffness}});
  network.anchors = {{0, {0, 0, 0}, {stiffness}}, {n - 1, {n + 1.0, 0, 0}, {stiffness}}};
  return network;
}

}  // namespace tests
}  // namespace qddot
