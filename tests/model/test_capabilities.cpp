#include <functional>

#include <boost/test/unit_test.hpp>

#include "qddot/model/constrained_system.hpp"
#include "tests/measure.hpp"
#include "tests/problems.hpp"

BOOST_AUTO_TEST_SUITE(capabilities)

using namespace qddot;

namespace {

// The capabilities of a system.
struct Offers {
  bool stiffness = false, split_stiffness = false, discrete_gradient = false, laplacian = false,
       pieces = false, validity = false, kinks = false, damping = false, driving = false,
       switching = false, blocks = false, split = false;
  bool operator==(const Offers&) const = default;
};
Offers offers_of(const System& s) {
  return {s.has_stiffness(),
          s.split_stiffness() != nullptr,
          s.discrete_gradient() != nullptr,
          s.laplacian() != nullptr,
          s.pieces() != nullptr,
          s.validity() != nullptr,
          s.kinks() != nullptr,
          s.damping() != nullptr,
          s.driving() != nullptr,
          s.switching() != nullptr,
          !s.blocks().empty(),
          s.split() != nullptr};
}

// A mass on a spring of V = q^2/2, by V and f alone.
class Plain : public System {
 public:
  Plain() : System(Vec::Ones(1)) {}
  double potential(const At& at) const override { return 0.5 * at.q.squaredNorm(); }
  void force(const At& at, MutableVec f) const override { f = -at.q; }
};

// The same with the capabilities that it is to offer; a place that it reports is at q = 1.
class Offering final : public CapableSystem {
 public:
  explicit Offering(const Offers& offers) : CapableSystem(Vec::Ones(1)), offers_(offers) {
    if (!offers.stiffness) return;
    pattern_.resize(1, 1);
    pattern_.insert(0, 0) = 0;
  }
  double potential(const At& at) const override { return Plain().potential(at); }
  void force(const At& at, MutableVec f) const override { Plain().force(at, f); }
  const SplitStiffness* split_stiffness() const override {
    return offers_.split_stiffness ? this : nullptr;
  }
  const DiscreteGradient* discrete_gradient() const override {
    return offers_.discrete_gradient ? this : nullptr;
  }
  const Laplacian* laplacian() const override { return offers_.laplacian ? this : nullptr; }
  const PiecewiseLinear* pieces() const override { return offers_.pieces ? this : nullptr; }
  const Validity* validity() const override { return offers_.validity ? this : nullptr; }
  const Kinks* kinks() const override { return offers_.kinks ? this : nullptr; }
  const Damping* damping() const override { return offers_.damping ? this : nullptr; }
  bool is_conservative() const override { return !offers_.damping; }
  const Driving* driving() const override { return offers_.driving ? this : nullptr; }
  bool is_autonomous() const override { return !offers_.driving; }
  Work driving_power(const At& at) const override { return {.driven = at.q[0]}; }
  double potential_change(double from, double to, const At& at) const override {
    return (to - from) * at.q[0];
  }
  void force_rate(const At&, MutableVec rate) const override { rate[0] = -1; }
  std::vector<Corner> corners() const override { return {{2, 1}, {3, 3}}; }
  const Switching* switching() const override { return offers_.switching ? this : nullptr; }
  Index phase_count() const override { return 1; }
  std::optional<int> order_of_slack() const override { return 1; }
  void set_phases(const At& at, bool, std::span<Phase> phases) const override {
    phases[0] = at.q[0] < 1 ? Phase::slack : Phase::taut;
  }
  std::optional<Change> first_change(const State& from, const State& to, std::span<const Phase>,
                                     const Changed&) const override {
    if ((from.q[0] < 1) == (to.q[0] < 1)) return {};
    return Change{to.t, 0, to.q[0] < 1 ? Phase::slack : Phase::taut};
  }
  Margin margin(const At& at, int, Phase) const override { return {at.q[0] - 1, at.v[0], 0}; }
  void add_due_changes(const At& at, std::span<const Phase>,
                       std::vector<Change>& due) const override {
    if (at.q[0] == 1) due.push_back({at.t, 0, Phase::slack});
  }
  double energy_of(const At& at, int) const override { return at.q[0]; }
  double strain_of(const At& at, int) const override { return at.q[0] - 1; }
  void friction(const At& at, MutableVec f) const override { f = -at.v; }
  void damping_matrix(const At&, SymmetricMatrix& c) const override { c.coeffs()[0] = 1; }
  bool damping_is_constant() const override { return true; }
  const Split* split() const override { return offers_.split ? &split_ : nullptr; }
  const SymmetricMatrix& stiffness_pattern() const override { return pattern_; }
  void stiffness(const At&, SymmetricMatrix& k) const override { k.coeffs()[0] = -1; }
  void material_stiffness(const At& at, SymmetricMatrix& k) const override { stiffness(at, k); }
  void weighted_stiffness(const At& at, double, SymmetricMatrix& k) const override {
    stiffness(at, k);
  }
  void mean_force(const At& a, const At& b, MutableVec f) const override { f = -(a.q + b.q) / 2; }
  void assemble_laplacian(SymmetricMatrix& l) const override { l.coeffs()[0] = 1; }
  bool bounds_stiffness() const override { return true; }
  bool is_linear_at(const At& at) const override { return at.q[0] < 1; }
  bool is_valid_at(const At& at) const override { return at.q[0] < 1; }
  Index kink_count() const override { return 1; }
  void kink_lengths(const At& at, MutableVec lengths) const override { lengths[0] = at.q[0] - 1; }

 private:
  Offers offers_;
  SymmetricMatrix pattern_;
  Split split_{
      std::make_shared<Plain>(), std::make_shared<Plain>(), std::make_shared<Plain>(), {0}};
};

// Nothing, and each capability by itself or with the stiffness that it needs.
constexpr Offers each[] = {{},
                           {.stiffness = true},
                           {.stiffness = true, .split_stiffness = true},
                           {.discrete_gradient = true},
                           {.stiffness = true, .laplacian = true},
                           {.pieces = true},
                           {.validity = true},
                           {.kinks = true},
                           {.stiffness = true, .damping = true},
                           {.driving = true},
                           {.switching = true},
                           {.split = true}};

// Systems that offer these, and networks.
std::vector<std::function<std::unique_ptr<System>()>> kinds() {
  std::vector<std::function<std::unique_ptr<System>()>> all = {
      [] { return std::make_unique<Plain>(); }};
  for (const Offers& offers : each)
    all.push_back([=] { return std::make_unique<Offering>(offers); });
  all.push_back([] { return make_mass_spring(with_split(hammock(1).network)); });
  all.push_back([] {
    Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
    network.anchors = {{0, {0, 0, 0}, {1, 1}, Holds::in_tension}};
    return make_mass_spring(network);
  });
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_system_of_v_and_f_alone_has_none) {
  const Plain plain;
  BOOST_TEST((offers_of(plain) == Offers{}));
  BOOST_TEST(!plain.stiffness_is_constant());
  BOOST_TEST(plain.blocks().empty());
  BOOST_TEST(!plain.split());
  SymmetricMatrix k = plain.stiffness_pattern();
  BOOST_TEST(k.size() == 0);
  BOOST_CHECK_THROW(plain.stiffness(Vec(Vec::Zero(1)), k), std::logic_error);
}

BOOST_AUTO_TEST_CASE(each_is_found_where_an_object_offers_it_and_nowhere_else) {
  for (const Offers& offers : each) BOOST_TEST((offers_of(Offering(offers)) == offers));
}

BOOST_AUTO_TEST_CASE(a_network_offers_what_it_has) {
  const Offers always{
      .stiffness = true, .split_stiffness = true, .discrete_gradient = true, .laplacian = true};
  const auto offers = [](const Network& network) { return offers_of(*make_mass_spring(network)); };
  for (const int dimension : {2, 3}) {
    BOOST_TEST((offers(hammock(dimension).network) == always));
    Offers split = always;
    split.split = true;
    BOOST_TEST((offers(with_split(hammock(dimension).network)) == split));
  }
  Offers on_a_line = always;
  on_a_line.kinks = true;
  BOOST_TEST((offers(hammock(1).network) == on_a_line));

  Network spring{.dimension = 1, .node_mass = Vec::Ones(1)};
  spring.anchors = {{0, {0, 0, 0}, {1, 1}}};
  BOOST_TEST((offers(spring) == on_a_line));
  spring.anchors[0].holds = Holds::in_tension;
  Offers string = on_a_line;
  string.validity = true;
  BOOST_TEST((offers(spring) == string));
  spring.anchors[0].holds = Holds::always;
  spring.anchors[0].direction = 1;
  Offers directed = always;
  directed.pieces = true;
  BOOST_TEST((offers(spring) == directed));
  spring.anchors[0].direction = 0;
  spring.anchors[0].curve = 0;
  spring.curves = {{.harmonics = {{{1, 0, 0}, 3, 0}}}};
  Offers driven = on_a_line;
  driven.driving = true;
  BOOST_TEST((offers(spring) == driven));
}

BOOST_AUTO_TEST_CASE(a_constrained_system_offers_what_the_system_in_it_offers) {
  for (const auto& make : kinds()) {
    const std::shared_ptr<System> inner = make();
    std::vector<bool> is_held(static_cast<std::size_t>(inner->size()));
    BOOST_TEST((offers_of(ConstrainedSystem(inner, is_held)) == offers_of(*inner)));
    is_held[0] = true;
    const auto once = std::make_shared<ConstrainedSystem>(inner, is_held);
    BOOST_TEST((offers_of(*once) == offers_of(*inner)));
    BOOST_TEST((offers_of(ConstrainedSystem(once, is_held)) == offers_of(*inner)));
    Vec f = force_at(*once, Vec::Constant(inner->size(), 0.5));
    BOOST_TEST(f[0] == 0);
  }
}

BOOST_AUTO_TEST_CASE(blocks_offer_together_what_all_of_them_offer_and_exceptions_of_any) {
  for (const auto& one : kinds()) {
    for (const auto& other : kinds()) {
      std::vector<std::unique_ptr<System>> blocks;
      blocks.push_back(one());
      blocks.push_back(other());
      const Offers a = offers_of(*blocks[0]), b = offers_of(*blocks[1]);
      const BlockDiagonalSystem both(std::move(blocks));
      const Offers expected{.stiffness = a.stiffness && b.stiffness,
                            .split_stiffness = a.split_stiffness && b.split_stiffness,
                            .discrete_gradient = a.discrete_gradient && b.discrete_gradient,
                            .laplacian = a.laplacian && b.laplacian,
                            .pieces = a.pieces || b.pieces,
                            .validity = a.validity || b.validity,
                            .kinks = a.kinks || b.kinks,
                            .damping = a.damping || b.damping,
                            .driving = a.driving || b.driving,
                            .switching = a.switching || b.switching,
                            .blocks = true,
                            .split = false};
      BOOST_TEST((offers_of(both) == expected));
      // The offered capabilities work.
      const Vec q = Vec::Constant(both.size(), 0.5);
      BOOST_TEST(force_at(both, q).allFinite());
      if (expected.stiffness) {
        BOOST_TEST(stiffness_at(both, q).coeffs().allFinite());
      } else {
        SymmetricMatrix k = both.stiffness_pattern();
        BOOST_TEST(k.size() == 0);
        BOOST_CHECK_THROW(both.stiffness(q, k), std::logic_error);
      }
      if (expected.split_stiffness) {
        BOOST_TEST(material_stiffness_at(both, q).coeffs().allFinite());
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(exceptions_of_one_block_are_those_of_the_whole) {
  std::vector<std::unique_ptr<System>> blocks;
  for (const Offers& offers : {Offers{}, Offers{.validity = true}, Offers{.kinks = true}})
    blocks.push_back(std::make_unique<Offering>(offers));
  const BlockDiagonalSystem system(std::move(blocks));
  const Vec inside{{5, 0, 3}}, outside{{0, 2, 3}};
  const Validity& validity = *system.validity();
  BOOST_TEST(validity.is_valid_at(inside));
  BOOST_TEST(!validity.is_valid_at(outside));
  const Vec v = Vec::Zero(3);
  BOOST_TEST(!validity.end_of_validity({1, outside, v}, {2, inside, v}));
  BOOST_TEST(validity.end_of_validity({1, inside, v}, {2, outside, v}).value() == 2);
  const Kinks& kinks = *system.kinks();
  BOOST_TEST_REQUIRE(kinks.kink_count() == 1);
  Vec lengths(1);
  kinks.kink_lengths(inside, lengths);
  BOOST_TEST(lengths[0] == 2);
}

BOOST_AUTO_TEST_SUITE_END()
