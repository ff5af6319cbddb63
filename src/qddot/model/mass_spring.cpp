#include "qddot/model/mass_spring.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "qddot/model/capabilities.hpp"
#include "qddot/model/compact_links.hpp"
#include "qddot/model/directions.hpp"
#include "qddot/model/driven_network.hpp"
#include "qddot/model/general_springs.hpp"
#include "qddot/model/in_tension.hpp"
#include "qddot/model/kernels/springs_by_node.hpp"
#include "qddot/model/kernels/stiffness_kernel.hpp"
#include "qddot/model/layout.hpp"
#include "qddot/model/machine_epsilon.hpp"
#include "qddot/model/massless_series.hpp"
#include "qddot/model/nodal_loads.hpp"
#include "qddot/model/rods.hpp"
#include "qddot/model/secant_dashpot.hpp"
#include "qddot/model/split_network.hpp"
#include "qddot/model/spring_lists.hpp"
#include "qddot/model/stiffness_blocks.hpp"
#include "qddot/model/switches.hpp"

namespace qddot {
namespace {

using namespace kernels;

// Measured: vectors sum forces faster than a loop over springs from this many nodes on.
constexpr Index fewest_for_vectors = 16;

template <int D>
class MassSpring final : public CapableSystem {
  using Point = Eigen::Matrix<double, D, 1>;
  using Block = Eigen::Matrix<double, D, D>;
  using Moved = typename SpringLists<D>::Moved;
  using Curves = std::vector<Point>;
  using Time = typename DrivenNetwork<D>::Time;

 public:
  MassSpring(Network network, Forces forces)
      : MassSpring(std::move(network), forces,
                   Layout<D>(network.node_mass.size(), network.zero_coordinates)) {}

  double potential(const At& at) const override {
    const VecView& q = at.q;
    const Curves curves = driven_.values(at);
    double v = constant_energy_ - weight_.dot(q) + driven_.load_energy(at);
    if (by_node_) {
      v += by_node_->half_sum_energies(at);
      for_each_anchor([&](const Network::Anchor& anchor) {
        v += spring_energy(anchor.law, between({q, curves}, anchor)) / 2;
      });
      if (beside_) {
        beside_->for_each_general(at.phases, [&](const auto& spring) {
          v += spring_energy(spring.law, beside_->between({q, curves}, spring));
        });
      }
      return v;
    }
    springs_->for_each(at.phases, [&](const auto& spring) {
      v += spring_energy(spring.law, springs_->between({q, curves}, spring));
    });
    return v;
  }

  void force(const At& at, MutableVec f) const override {
    if (by_node_ && has_dashpots_ && !beside_ && at.v.size() > 0) {
      Vec friction(size());
      damped_force(at, f, friction, nullptr);
      return;
    }
    if (by_node_) {
      by_node_->sum_forces(at, f);
      if (beside_) add_general_forces(at, f);
    } else if (driven_.is_driven()) {
      const Curves curves = driven_.values(at);
      sum_spring_by_spring({at.q, curves, at.phases}, f);
      driven_.add_loads(at, f);
    } else {
      sum_spring_by_spring({at.q, none_, at.phases}, f);
    }
    if (is_damped() && at.v.size() > 0) add_friction(at, f);
  }

  std::optional<double> damped_force(const At& at, MutableVec f, MutableVec friction,
                                     BesideForce* beside) const override {
    // Air would come after the work beside.
    if (!by_node_ || beside_ || !has_dashpots_ || (beside && air_damping_ > 0)) return {};
    const double sum = by_node_->sum_damped_forces(at, f, friction, beside);
    if (air_damping_ > 0) {
      add_air(at, f);
      add_air(at, friction);
    }
    return sum;
  }

  double force_beside(const At& at, MutableVec f, BesideForce& beside) const override {
    if (by_node_ && !beside_ && (!is_damped() || at.v.size() == 0)) {
      return by_node_->sum_forces(at, f, beside);
    }
    return System::force_beside(at, f, beside);
  }

  void mean_force(const At& start, const At& end, MutableVec f) const override {
    const Curves curves = driven_.values(start);
    const Moved a{start.q, curves}, b{end.q, curves};
    const auto gradient = [&](const auto& spring) {
      const SpringLists<D>& springs = by_node_ ? *beside_ : *springs_;
      return spring_discrete_gradient(spring.law, springs.between(a, spring),
                                      springs.between(b, spring));
    };
    if (by_node_) {
      by_node_->sum_mean_forces(start, end, f);
      if (beside_) beside_->add_general_forces(start.phases, gradient, f);
      return;
    }
    f = weight_;
    driven_.add_loads(start, f);
    springs_->add_forces(start.phases, gradient, f);
  }

  void stiffness(const At& at, SymmetricMatrix& k) const override { weighted_stiffness(at, 1, k); }

  void weighted_stiffness(const At& at, double compression_weight,
                          SymmetricMatrix& k) const override {
    const Curves curves = driven_.values(at);
    const Moved now{at.q, curves, at.phases};
    const auto block = [compression_weight](const auto& law, const Point& d) {
      return spring_stiffness(law, d, compression_weight);
    };
    const ForStiffness& own = for_stiffness();
    if (!by_node_) return own.blocks.assemble(now, k, block);
    own.columns->stiffness(*by_node_, at, compression_weight, k);
    add_left_out(own, now, k, block);
  }

  void material_stiffness(const At& at, SymmetricMatrix& k) const override {
    const Curves curves = driven_.values(at);
    const Moved now{at.q, curves, at.phases};
    const auto block = [](const auto& law, const Point& d) {
      return spring_material_stiffness(law, d);
    };
    const ForStiffness& own = for_stiffness();
    if (!by_node_) return own.blocks.assemble(now, k, block);
    own.columns->material_stiffness(*by_node_, at, k);
    add_left_out(own, now, k, block);
  }

  const SymmetricMatrix& stiffness_pattern() const override {
    return for_stiffness().blocks.pattern();
  }
  bool has_stiffness() const override { return true; }
  bool stiffness_is_constant() const override { return linear_; }
  bool bound_row_sums(const At& at, Vec& sums) const override {
    if (!by_node_) return false;  // so few have their K at once
    sums.resize(size());
    by_node_->sum_stiffness_rows(at, sums);
    const Curves curves = driven_.values(at);
    for (const auto& anchor : network_.anchors) {
      const Point d = between({at.q, curves}, anchor);
      layout_.add(-spring_stiffness(anchor.law, d).cwiseAbs().rowwise().sum(), anchor.i, sums);
    }
    if (beside_) {
      beside_->for_each_general(at.phases, [&](const auto& spring) {
        const Point d = beside_->between({at.q, curves}, spring);
        const Point rows = spring_stiffness(spring.law, d).cwiseAbs().rowwise().sum();
        layout_.add(spring.j < 0 ? rows : Point(2 * rows), spring.i, sums);
        if (spring.j >= 0) layout_.add(2 * rows, spring.j, sums);
      });
    }
    return true;
  }

  bool multiply_stiffness(const At& at, const ConstVec& x, MutableVec y) const override {
    if (!by_node_ || beside_) return false;
    by_node_->multiply_stiffness(at, VecView(x), y);
    return true;
  }

  Index stiffness_entries() const override { return entries_; }

  bool is_conservative() const override { return !is_damped(); }
  const Damping* damping() const override { return is_damped() ? this : nullptr; }
  void friction(const At& at, MutableVec f) const override {
    if (by_node_ && has_dashpots_ && !beside_) {
      by_node_->sum_friction(at, f);
      if (air_damping_ > 0) add_air(at, f);
    } else {
      f.setZero();
      add_friction(at, f);
    }
  }
  std::optional<double> secant_friction(const BackwardRate& rate, const ConstVec& v,
                                        MutableVec f) const override {
    if (!has_dashpots_) return {};
    const SpringLists<D>& springs = lists();
    const VecView q0 = rate.q0, q1 = rate.q1, q2 = rate.q2;
    const Curves curves0 = driven_.values(Time(rate.t0)), curves1 = driven_.values(Time(rate.t1)),
                 curves2 = driven_.values(Time(rate.t2));
    double power = 0;
    f.setZero();
    springs.add_forces(
        rate.phases,
        [&](const auto& spring) {
          const SecantDashpot<D> dashpot = secant_dashpot<D>(
              spring.law, springs.between({q0, curves0}, spring),
              springs.between({q1, curves1}, spring), springs.between({q2, curves2}, spring), rate);
          power += dashpot.power;
          return dashpot.force;
        },
        f);
    if (air_damping_ > 0) {
      f -= air_damping_ * mass().cwiseProduct(v);
      power += 2 * air_damping_ * kinetic(v);
    }
    return power;
  }
  void damping_matrix(const At& at, SymmetricMatrix& c) const override {
    if (has_dashpots_) {
      for_stiffness().dashpots->material_stiffness(at, c);
      c.coeffs() = -c.coeffs();
    } else {
      c.coeffs().setZero();
    }
    add_air(c);
  }
  bool bound_damping(SymmetricMatrix& l) const override {
    l.coeffs().setZero();
    if (has_dashpots_) for_stiffness().dashpots->assemble_laplacian(l);
    add_air(l);
    return true;
  }
  bool damping_is_constant() const override {
    return !has_dashpots_ || (D == 1 && switches_.empty()) || !has_rest_lengths_;
  }
  double air_damping() const override { return air_damping_; }
  bool has_dashpots() const override { return has_dashpots_; }
  std::optional<double> damping_time() const override { return damping_time_; }

  const SplitStiffness* split_stiffness() const override { return this; }
  const DiscreteGradient* discrete_gradient() const override { return this; }
  const Laplacian* laplacian() const override { return this; }
  const PiecewiseLinear* pieces() const override {
    return linear_ && keeps_directions() ? this : nullptr;
  }
  const Validity* validity() const override { return in_tension_.empty() ? nullptr : this; }
  const Kinks* kinks() const override { return kinks_ > 0 ? this : nullptr; }
  const Split* split() const override { return split_ ? &*split_ : nullptr; }

  bool is_linear_at(const At& at) const override {
    const Curves curves = driven_.values(at);
    const signed char* direction = directions_.data();
    bool all = true;
    const SpringLists<D>& springs = lists();
    springs.for_each(nullptr, [&](const auto& spring) {
      const int own = *direction++;
      all = all & (own == 0 || own * springs.between({at.q, curves}, spring)[0] > 0);
    });
    return all;
  }

  bool bounds_stiffness() const override { return !has_quartic_; }
  // A network with rest lengths of zero has the same stiffness at every q.
  void assemble_laplacian(SymmetricMatrix& l) const override {
    const Vec anywhere = Vec::Zero(size());
    const Curves curves = driven_.values(Time(0));
    for_stiffness().blocks.assemble(
        {anywhere, curves, all_taut_.data()}, l,
        [](const auto& law, const Point&) -> Block { return -law.stiffness * Block::Identity(); });
  }

  // A length of zero is a kink only on a line.
  Index kink_count() const override { return kinks_; }
  void kink_lengths(const At& at, MutableVec lengths) const override {
    const Curves curves = driven_.values(at);
    Index i = 0;
    const SpringLists<D>& springs = lists();
    // By their own laws: a cable has no kink, and a broken spring's length may be told.
    springs.for_each(nullptr, [&](const auto& spring) {
      if (turns_over(spring.law)) lengths[i++] = springs.between({at.q, curves}, spring)[0];
    });
  }

  bool is_valid_at(const At& at) const override { return in_tension_.holds_at(placed(at)); }
  std::optional<double> end_of_validity(const State& from, const State& to) const override {
    const auto moving = [&](const State& state) {
      return PlacedMotion<D>{placed(state), driven_.rates(Time(state.t)), state.v};
    };
    return in_tension_.first_slack(mass(), from.t, moving(from), to.t, moving(to),
                                   [&](bool is_end, Vec& f) {
                                     f.resize(size());
                                     const State& state = is_end ? to : from;
                                     force({state.t, state.q}, f);
                                   });
  }

  bool is_autonomous() const override { return !driven_.is_driven(); }
  const Driving* driving() const override { return driven_.is_driven() ? this : nullptr; }
  Work driving_power(const At& at) const override { return driven_.power(at); }
  double potential_change(double from, double to, const At& at) const override {
    return driven_.potential_change(from, to, at);
  }
  void force_rate(const At& at, MutableVec rate) const override { driven_.force_rate(at, rate); }
  std::vector<Corner> corners() const override { return driven_.corners(); }

  const Constraints* constraints() const override { return rods_.empty() ? nullptr : &rods_; }
  const Switching* switching() const override { return switches_.empty() ? nullptr : this; }
  Index phase_count() const override { return switches_.count(); }
  std::optional<int> order_of_slack() const override { return switches_.order_of_slack(); }
  void set_phases(const At& at, bool finds_slack, std::span<Phase> phases) const override {
    switches_.set_phases(moving_nodes(at), finds_slack, phases);
  }
  std::optional<Change> first_change(const State& from, const State& to,
                                     std::span<const Phase> phases,
                                     const Changed& changed) const override {
    return switches_.first_change(from.t, moving_nodes(from), to.t, moving_nodes(to), phases,
                                  changed, mass(), [&](bool is_end, Vec& f) {
                                    const State& state = is_end ? to : from;
                                    At at(state.t, state.q, state.v);
                                    at.phases = phases.data();
                                    f.resize(size());
                                    force(at, f);
                                  });
  }
  Margin margin(const At& at, int number, Phase to) const override {
    return switches_.margin(moving_nodes(at), number, to);
  }
  void add_due_changes(const At& at, std::span<const Phase> phases,
                       std::vector<Change>& due) const override {
    switches_.add_due_changes(at.t, moving_nodes(at), phases, due);
  }
  double energy_of(const At& at, int number) const override {
    return switches_.energy(moving_nodes(at), number);
  }
  double strain_of(const At& at, int number) const override {
    return switches_.strain(moving_nodes(at), number);
  }
  std::optional<Forcing> forcing(double t) const override {
    if (!linear_ || keeps_directions()) return {};
    Vec constant = weight_;
    for (const auto& anchor : network_.anchors) {
      layout_.add(anchor.law.stiffness * anchor.point.template head<D>(), anchor.i, constant);
    }
    return driven_.forcing(t, constant);
  }

 private:
  // All that K is made of.
  struct ForStiffness {
    StiffnessBlocks<D> blocks;
    std::optional<StiffnessKernel<D>> columns;  // beside SpringsByNode
    // C of a dashpot c is -K_m of a spring of stiffness c without a quartic term. All springs are
    // in this system, so that its pattern is that of K. Empty without dashpots.
    std::unique_ptr<const MassSpring> dashpots;
  };

  MassSpring(Network&& network, Forces forces, Layout<D> layout)
      : CapableSystem(masses(network, layout)),
        layout_(std::move(layout)),
        driven_(network, layout_),
        switches_(network, layout_),
        rods_(network, layout_, driven_),
        weight_(weights(network, layout_)),
        constant_energy_(network.constant_energy),
        air_damping_(network.air_damping) {
    note_damping(network);
    note_tension(network);
    directions_ = directions(network, layout_);
    note_laws(network);
    if (network.offers_split) offer_split(network, forces);
    entries_ = D * (D + 1) / 2 * layout_.nodes() +
               D * D *
                   (std::ssize(network.links) + std::ssize(network.image_links) +
                    std::ssize(network.general));
    note_general(network);
    links_ = CompactLinks(network.links);
    if (forces == Forces::by_vectors ||
        (forces == Forces::whichever_is_faster && layout_.nodes() >= fewest_for_vectors)) {
      network.links = {};  // most of the memory of many nodes
      if (!network.general.empty()) {
        beside_.emplace(Network{.general = network.general}, layout_);
      }
      by_node_.emplace(network, links_, layout_, weight_, driven_);
    } else {
      springs_.emplace(network, layout_);
    }
    network_ = {.dimension = D,
                .anchors = std::move(network.anchors),
                .image_links = std::move(network.image_links),
                .general = std::move(network.general),
                .curves = std::move(network.curves)};
  }

  bool is_damped() const { return has_dashpots_ || air_damping_ > 0; }

  // Calls see(spring) for each spring of the network.
  template <class Springs, class See>
  static void for_each_spring(Springs& network, const See& see) {
    for (auto& spring : network.links) see(spring);
    for (auto& spring : network.image_links) see(spring);
    for (auto& spring : network.anchors) see(spring);
    for (auto& spring : network.general) see(spring);
  }

  void note_general(const Network& network) {
    int last = -1;
    for (const auto& spring : network.general) last = std::max(last, spring.number);
    all_taut_.assign(static_cast<std::size_t>(last + 1), Phase::taut);
  }

  void note_damping(const Network& network) {
    bool is_proportional = true;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for_each_spring(network, [&](const auto& spring) {
      const SpringLaw& law = spring.law;
      has_dashpots_ = has_dashpots_ || law.damping > 0;
      if (law.is_plain()) vectors_have_dashpots_ = vectors_have_dashpots_ || law.damping > 0;
      if (law.stiffness == 0 && law.quartic == 0 && law.cubic == 0 && law.damping == 0) return;
      has_rest_lengths_ = has_rest_lengths_ || (law.damping > 0 && law.rest_length > 0);
      is_proportional =
          is_proportional && (law.damping == 0 || (law.stiffness > 0 && law.quartic == 0));
      const double time = law.damping > 0 ? law.damping / law.stiffness : 0;
      least = std::min(least, time);
      most = std::max(most, time);
    });
    constexpr double roundings = 8 * machine_epsilon;
    if (!has_dashpots_) {
      damping_time_ = 0;
    } else if (network.general.empty() && is_proportional && most - least <= roundings * most) {
      damping_time_ = most;
    }
  }

  // See ForStiffness; `network` has the springs of this one.
  std::unique_ptr<const MassSpring> dashpots_of(Network network) const {
    network.node_mass.setOnes(layout_.nodes());  // of no effect on C, as are loads
    network.driven_loads.clear();
    for_each_spring(network, [](auto& spring) {
      spring.law = {.stiffness = spring.law.damping,
                    .rest_length = spring.law.rest_length,
                    .breaks_at = spring.law.breaks_at,
                    .pulls_only = spring.law.pulls_only};
      if constexpr (requires { spring.holds; }) {
        spring.holds = Holds::always;
        spring.direction = 0;
      }
    });
    const Forces forces = by_node_ ? Forces::by_vectors : Forces::spring_by_spring;
    return std::unique_ptr<const MassSpring>(new MassSpring(std::move(network), forces, layout_));
  }

  [[gnu::always_inline]] void sum_spring_by_spring(const Moved& now, MutableVec& f) const {
    f = weight_;
    springs_->add_forces(
        now.phases,
        [&](const auto& spring) {
          return spring_force(spring.law, springs_->between(now, spring));
        },
        f);
  }
  void add_general_forces(const At& at, MutableVec& f) const {
    const Curves curves = driven_.values(at);
    beside_->add_general_forces(
        at.phases,
        [&](const auto& spring) {
          return spring_force(spring.law, beside_->between({at.q, curves}, spring));
        },
        f);
  }
  // Beside vectors, dashpots that they sum are added by them.
  void add_friction(const At& at, MutableVec f) const {
    if (has_dashpots_) {
      const Curves curves = driven_.values(at), rates = driven_.rates(at);
      const SpringLists<D>& springs = by_node_ ? *beside_ : *springs_;
      const auto friction = [&](const auto& spring) {
        return dashpot_force(spring.law, springs.between({at.q, curves}, spring),
                             springs.apart({at.v, rates}, spring));
      };
      if (by_node_) {
        if (vectors_have_dashpots_) {
          Vec plain(size());
          by_node_->sum_friction(at, plain);
          f += plain;
        }
        springs.add_general_forces(at.phases, friction, f);
      } else {
        springs.add_forces(at.phases, friction, f);
      }
    }
    if (air_damping_ > 0) add_air(at, f);
  }
  void add_air(const At& at, MutableVec f) const { f -= air_damping_ * mass().cwiseProduct(at.v); }
  void add_air(SymmetricMatrix& c) const {
    for (Index i = 0; i < size() && air_damping_ > 0; ++i) {
      // The diagonal entry is the first of its column.
      c.valuePtr()[c.outerIndexPtr()[i]] += air_damping_ * mass()[i];
    }
  }

  void note_laws(const Network& network) {
    linear_ = network.uses_constant_stiffness;
    const auto note = [&](const auto& springs) {
      for (const auto& spring : springs) {
        linear_ = linear_ && (spring.law.is_linear() || keeps_directions());
        if (spring.law.quartic > 0 || spring.law.cubic != 0) has_quartic_ = true;
        kinks_ += turns_over(spring.law);
      }
    };
    note(network.links);
    note(network.image_links);
    note(network.anchors);
    note(network.general);
    linear_ = linear_ && switches_.empty() && rods_.empty();
  }

  void offer_split(const Network& network, Forces forces) {
    const Network stiff = half_of_split(network, true);
    const std::vector<int> nodes = pulled_nodes(stiff);
    split_ = {std::make_shared<MassSpring>(stiff, forces),
              std::make_shared<MassSpring>(half_of_split(network, false), forces),
              std::make_shared<MassSpring>(network_among(nodes, stiff), forces),
              {}};
    for (const int i : nodes) {
      for (int a = 0; a < layout_.count(i); ++a) {
        split_->stiff_unknowns.push_back(layout_.first(i) + a);
      }
    }
  }

  // Calls see(anchor) for each spring to a fixed point, in the lists' order.
  template <class See>
  void for_each_anchor(const See& see) const {
    for (const bool full : {true, false}) {
      for (const Network::Anchor& anchor : network_.anchors) {
        if (layout_.is_full(anchor.i) == full) see(anchor);
      }
    }
  }

  // The lists, and all that K is made of, are made when somebody first asks for them: explicit runs
  // of many nodes never do. Any thread may ask.
  const SpringLists<D>& lists() const {
    std::call_once(lists_made_, [&] {
      if (!springs_) springs_.emplace(whole_network(), layout_);
    });
    return *springs_;
  }
  const ForStiffness& for_stiffness() const {
    std::call_once(for_stiffness_made_, [&] {
      // The lists come first: one whole network is held at a time.
      const SpringLists<D>& springs = lists();
      const Network whole = whole_network();
      ForStiffness& own =
          for_stiffness_.emplace(ForStiffness{{whole, layout_, springs}, std::nullopt, nullptr});
      if (by_node_) own.columns.emplace(whole, layout_, *by_node_, own.blocks.pattern());
      if (has_dashpots_) own.dashpots = dashpots_of(whole);
      // The lists hold the same springs.
      links_ = {};
      network_.image_links = {};
    });
    return *for_stiffness_;
  }
  Network whole_network() const {
    Network whole = network_;
    whole.links = links_.links();
    return whole;
  }

  // d of an anchor.
  Point between(const Moved& at, const Network::Anchor& anchor) const {
    return anchor.point.template head<D>() + at.of(anchor.curve) - layout_.at(at.q, anchor.i);
  }
  MovingNodes<D> moving_nodes(const At& at) const {
    return {at.q, at.v, driven_.values(at), driven_.rates(at)};
  }
  Placed<D> placed(const At& at) const { return {layout_, at.q, driven_.values(at)}; }

  bool keeps_directions() const { return !directions_.empty(); }
  bool turns_over(const PlainLaw& law) const {
    return D == 1 && law.rest_length > 0 && !keeps_directions();
  }
  // A cable is slack at length zero.
  bool turns_over(const SpringLaw& law) const {
    return turns_over(law.plain()) && !law.goes_slack();
  }

  void note_tension(const Network& network) {
    for (const auto& link : network.links) {
      if (link.holds == Holds::in_tension)
        in_tension_.add({link.i, link.j, Point::Ones(), link.law});
    }
    const auto point = [](const Eigen::Vector3d& x) { return Point(x.head<D>()); };
    for (const auto& link : network.image_links) {
      if (link.holds == Holds::in_tension) {
        in_tension_.add({link.i, link.j, point(link.mirror), link.law});
      }
    }
    for (const auto& anchor : network.anchors) {
      if (anchor.holds == Holds::in_tension) {
        in_tension_.add({anchor.i, -1, point(anchor.point), anchor.law, false, anchor.curve});
      }
    }
    for (const MasslessSeries& series : massless_series(network)) {
      const Point place = series.j < 0 ? point(series.point) : Point(Point::Ones());
      in_tension_.add({series.i, series.j, place, series.law, true, series.curve});
    }
  }

  // Adds the springs that the kernel of K leaves out.
  template <class BlockOf>
  static void add_left_out(const ForStiffness& own, const Moved& q, SymmetricMatrix& k,
                           const BlockOf& block) {
    for (const int e : own.columns->links_left_out()) own.blocks.add_link_block(q, k, block, e);
    own.blocks.add_image_blocks(q, k, block);
    own.blocks.add_general(q, k, block);
  }

  Layout<D> layout_;
  DrivenNetwork<D> driven_;
  Switches<D> switches_;
  Rods<D> rods_;
  InTension<D> in_tension_;              // springs that hold in tension only, once more
  Vec weight_;                           // M g + load [N]
  Curves none_;                          // of a network that is not driven
  std::vector<signed char> directions_;  // of all springs in the lists' order; empty where none
  double constant_energy_, air_damping_;
  bool has_dashpots_ = false, vectors_have_dashpots_ = false;
  bool has_rest_lengths_ = false;  // of springs with dashpots
  std::optional<double> damping_time_;
  bool linear_ = false;
  Index kinks_ = 0;
  bool has_quartic_ = false;
  std::optional<SpringsByNode<D>> by_node_;
  std::optional<SpringLists<D>> beside_;  // springs that by_node_ lacks: those that are not plain
  std::vector<Phase> all_taut_;           // of these, by their numbers
  std::optional<Split> split_;
  Index entries_ = 0;  // of K, or more where springs join the same nodes
  // The springs that lists and K are made of; links and image links only until then.
  mutable CompactLinks links_;
  mutable Network network_;  // without the links
  mutable std::once_flag lists_made_, for_stiffness_made_;
  mutable std::optional<SpringLists<D>> springs_;  // from the start without by_node_
  mutable std::optional<ForStiffness> for_stiffness_;
};

}  // namespace

std::unique_ptr<System> make_mass_spring(Network network, Forces forces) {
  set_apart_general(network);
  if (network.dimension == 1) return std::make_unique<MassSpring<1>>(std::move(network), forces);
  if (network.dimension == 2) return std::make_unique<MassSpring<2>>(std::move(network), forces);
  if (network.dimension == 3) return std::make_unique<MassSpring<3>>(std::move(network), forces);
  throw std::invalid_argument("a network has 1, 2 or 3 dimensions");
}

}  // namespace qddot
