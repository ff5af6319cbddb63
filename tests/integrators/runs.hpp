#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <boost/test/data/monomorphic.hpp>
#include <boost/test/data/test_case.hpp>

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

inline Run run(Integrator& integrator, State state, double t_end, const Observer& observer = {},
               std::stop_token stop = {}) {
  try {
    Summary summary = integrator.advance(state, t_end, observer, std::move(stop));
    return {std::move(summary), std::move(state)};
  } catch (const std::runtime_error& error) {
    Summary summary;
    summary.t_reached = state.t;
    return {std::move(summary), std::move(state), error.what()};
  }
}

// A run by a new integrator.
inline Run run(const Method& method, const System& system, State state, double t_end,
               const Options& options, const Observer& observer = {}, std::stop_token stop = {}) {
  const auto integrator = make_integrator(method, system, options);
  return run(*integrator, std::move(state), t_end, observer, std::move(stop));
}

inline Run run(const Method& method, const Problem& p, double t_end, const Options& options,
               const Observer& observer = {}, std::stop_token stop = {}) {
  const auto system = make_mass_spring(p.network);
  return run(method, *system, p.initial, t_end, options, observer, std::move(stop));
}

// An observer's times, and the states that it saw at them.
struct Film {
  std::vector<double> times;
  std::vector<State> seen{};
  Observer observer() {
    return {times, [this](const State& state) { seen.push_back(state); }};
  }
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

// The registry's methods for systems without constraints; the suite `rods` has the others.
inline std::vector<Method> unconstrained_methods() {
  std::vector<Method> list = methods();
  std::erase_if(list, [](const Method& method) { return method.asks(Need::constraints); });
  return list;
}
// Those of them that fulfil a condition.
template <class Condition>
std::vector<Method> methods_where(const Condition& condition) {
  std::vector<Method> list = unconstrained_methods();
  std::erase_if(list, [&](const Method& method) { return !condition(method); });
  return list;
}
// Whether the method takes any system.
inline bool is_general(const Method& method) {
  return !method.asks(Need::constant_stiffness) && !method.asks(Need::split_forces);
}
inline std::vector<Method> general_methods() { return methods_where(is_general); }
inline std::vector<Method> methods_of(Family family) {
  return methods_where([&](const Method& m) { return is_general(m) && m.family == family; });
}
inline std::vector<Method> methods_of(Knob knob) {
  return methods_where([&](const Method& m) { return is_general(m) && m.knob == knob; });
}
inline std::vector<Method> methods_of(Family family, Knob knob) {
  return methods_where(
      [&](const Method& m) { return is_general(m) && m.family == family && m.knob == knob; });
}
inline std::vector<Method> methods_with(Trait trait) {
  return methods_where([&](const Method& m) { return m.is(trait); });
}
inline std::vector<Method> methods_with(Option option) {
  return methods_where([&](const Method& m) { return m.listens_to(option); });
}
// The methods that repeat another by the stock way of SUNDIALS.
inline std::vector<Method> stock_methods() {
  return methods_where([](const Method& method) { return !method.stock_of.empty(); });
}
inline std::ostream& operator<<(std::ostream& out, const Method& method) {
  return out << method.name;
}

// Whether the method evaluates K where there is one: because it needs it, or to bound its steps.
inline bool evaluates_stiffness(const Method& method) {
  return method.asks(Need::stiffness) || method.is(Trait::bounds_steps);
}

// Whether torques cancel in each of its steps, where every spring has a rest length.
inline bool keeps_angular_momentum(const Method& method) {
  return method.is(Trait::symplectic) || method.is(Trait::cancels_torques);
}

// The larger of the errors in q and in v.
inline double distance(const State& a, const State& b) {
  return std::max(distance(a.q, b.q), distance(a.v, b.v));
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
// capabilities below. The forces of a system that is split pass by relays of their own; calls of
// the stiff block go by that of the stiff half.
class Relay final : public System,
                    public SplitStiffness,
                    public DiscreteGradient,
                    public Laplacian {
 public:
  explicit Relay(const System& system) : System(system.mass()), system_(system) {
    const Split* parts = system.split();
    if (!parts) return;
    stiff = std::make_shared<Relay>(*parts->stiff);
    soft = std::make_shared<Relay>(*parts->soft);
    const auto block = std::make_shared<Relay>(*parts->stiff_block);
    block->after_force = [this](const ConstVec& q, MutableVec f) {
      if (stiff->after_force) stiff->after_force(q, f);
    };
    block->after_stiffness = [this](const Vec& q, SymmetricMatrix& k) {
      if (stiff->after_stiffness) stiff->after_stiffness(q, k);
    };
    split_ = {stiff, soft, block, parts->stiff_unknowns};
  }

  double potential(const At& at) const override { return system_.potential(at); }
  void force(const At& at, MutableVec f) const override {
    system_.force(at, f);
    if (after_force) after_force(at.q, f);
  }
  void stiffness(const At& at, SymmetricMatrix& k) const override {
    system_.stiffness(at, k);
    if (after_stiffness) after_stiffness(at.q, k);
  }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return system_.stiffness_is_constant(); }
  bool is_conservative() const override { return system_.is_conservative(); }
  bool is_autonomous() const override { return system_.is_autonomous(); }
  const SplitStiffness* split_stiffness() const override {
    return system_.split_stiffness() ? this : nullptr;
  }
  const DiscreteGradient* discrete_gradient() const override {
    return system_.discrete_gradient() ? this : nullptr;
  }
  const Laplacian* laplacian() const override { return system_.laplacian() ? this : nullptr; }
  const Constraints* constraints() const override { return system_.constraints(); }
  const Split* split() const override { return stiff ? &split_ : nullptr; }

  void weighted_stiffness(const At& at, double compression_weight,
                          SymmetricMatrix& k) const override {
    offered(system_.split_stiffness()).weighted_stiffness(at, compression_weight, k);
    if (after_stiffness) after_stiffness(at.q, k);
  }
  void material_stiffness(const At& at, SymmetricMatrix& k) const override {
    offered(system_.split_stiffness()).material_stiffness(at, k);
    if (after_stiffness) after_stiffness(at.q, k);
  }
  void mean_force(const At& a, const At& b, MutableVec f) const override {
    offered(system_.discrete_gradient()).mean_force(a, b, f);
    if (after_force) after_force(b.q, f);
  }
  void assemble_laplacian(SymmetricMatrix& l) const override {
    offered(system_.laplacian()).assemble_laplacian(l);
  }
  bool bounds_stiffness() const override { return offered(system_.laplacian()).bounds_stiffness(); }

  // All relays that evaluations may pass by.
  std::vector<Relay*> all() {
    return stiff ? std::vector{this, stiff.get(), soft.get()} : std::vector{this};
  }

  std::function<void(const ConstVec& q, MutableVec f)> after_force;
  std::function<void(const Vec& q, SymmetricMatrix& k)> after_stiffness;
  std::shared_ptr<Relay> stiff, soft;  // of a system that is split

 private:
  const System& system_;
  Split split_;
};

// The numbers of evaluations of forces and stiffnesses of one relay, from construction on.
struct Asked {
  explicit Asked(Relay& relay) {
    relay.after_force = [this](const ConstVec&, MutableVec) { ++force; };
    relay.after_stiffness = [this](const Vec&, SymmetricMatrix&) { ++stiffness; };
  }
  Asked(const Asked&) = delete;

  std::int64_t force = 0, stiffness = 0;
};

// The network with every spring named stiff, or none.
inline Network with_all_named(Network network, bool stiff) {
  for_springs(network, [=](auto& spring) { spring.stiff = stiff; });
  network.offers_split = true;
  return network;
}

// The hammock with every spring of zero rest length: K is constant, no two nodes or directions
// alike.
inline Problem linear_hammock(int dimension) {
  const Problem p = hammock(dimension);
  return {without_rest_lengths(p.network), p.initial};
}

// A hammock that the method applies to.
inline Problem problem_for(const Method& method, int dimension = 2) {
  Problem p =
      method.asks(Need::constant_stiffness) ? linear_hammock(dimension) : hammock(dimension);
  if (method.asks(Need::split_forces)) p.network = with_split(p.network);
  return p;
}

// A mass of 2 kg that hangs at rest from a pin by two springs with a massless node between. Both
// pull by 30 N; two in series are one of 120 N/m and 1.7 m.
inline Problem two_in_series(int dimension) {
  const Vec down = dimension == 1   ? Vec{{1}}
                   : dimension == 2 ? Vec{{0.6, 0.8}}
                                    : Vec{{1 / 3., 2 / 3., 2 / 3.}};
  Problem p{{.dimension = dimension, .gravity = 9.81 * in_space(down)}, {}};
  p.network.node_mass = Vec{{0, 2}};
  p.network.anchors = {{0, {0, 0, 0}, {200, 0.8}}};
  p.network.links = {{0, 1, {300, 0.9}}};
  p.initial = {0, Vec(2 * dimension), Vec::Zero(2 * dimension)};
  p.initial.q << 0.95 * down, 1.95 * down;
  return p;
}

// n masses in 2D at rest along x between pins at 0 and n + 1, on springs of this law; each is
// beside(i) m off the row.
inline Problem row_between_pins(int n, double mass, const SpringLaw& law,
                                const std::function<double(int)>& beside) {
  Problem p{row_of_masses(2, n, mass, law), {0, Vec(2 * n), Vec::Zero(2 * n)}};
  for (int i = 0; i < n; ++i) p.initial.q.segment<2>(2 * i) << i + 1, beside(i);
  return p;
}

}  // namespace tests
}  // namespace qddot
