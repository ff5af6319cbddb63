// linear_midpoint and its composition linear_midpoint4, with a stiff set and where all springs are
// implicit. What they have in common with every fixed-step method is in the generic suites.
#include <boost/test/unit_test.hpp>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "tests/integrators/scenes.hpp"
#include "tests/integrators/split_relay.hpp"

BOOST_AUTO_TEST_SUITE(linear_midpoint)

using namespace qddot;

namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;

struct Form {
  const char* name;
  int order;
  std::vector<double> gamma;  // the steps that one step is made of, in parts of it
};
const std::vector<Form>& forms() {
  static const double p = 1 / (4 - std::cbrt(4));
  static const std::vector<Form> both = {{"linear_midpoint", 2, {1}},
                                         {"linear_midpoint4", 4, {p, p, 1 - 4 * p, p, p}}};
  return both;
}

// The stiff springs of a system as one over all of its unknowns, or all of them.
const System& implicit_part(const System& system) {
  return split_of(system) ? *split_of(system)->stiff : system;
}

// A step of the method's formula by a dense solve over all unknowns.
State by_formula(const System& system, State s, double h, const Form& form) {
  for (const double g : form.gamma) {
    const double part = g * h;
    const Vec x = s.q + part / 2 * s.v;
    const MatrixXd mass = system.mass().asDiagonal();
    const MatrixXd a =
        mass - part * part / 4 * dense(material_stiffness_at(implicit_part(system), x));
    s.v += part * a.fullPivLu().solve(force_at(system, x));
    s.q = x + part / 2 * s.v;
  }
  return {s.t + h, s.q, s.v};
}

// A step of h on q'' = -(w_f^2 + w_s^2) q in (q, v).
Matrix2d step_matrix(const Form& form, double h, double w_f, double w_s) {
  Matrix2d all = Matrix2d::Identity();
  for (const double g : form.gamma) {
    const double part = g * h;
    const double w2 = (w_f * w_f + w_s * w_s) / (1 + part * part * w_f * w_f / 4);
    const Matrix2d drift{{1, part / 2}, {0, 1}}, kick{{1, 0}, {-part * w2, 1}};
    all = drift * kick * drift * all;
  }
  return all;
}

// Its spectral radius; its determinant is 1.
double growth(const Form& form, double h, double w_f, double w_s) {
  const double t = std::abs(step_matrix(form, h, w_f, w_s).trace() / 2);
  return t > 1 ? t + std::sqrt(t * t - 1) : 1;
}

// A unit mass on a stiff and a soft spring of zero rest length.
Network two_springs(double w_f, double w_s) {
  Network network{.dimension = 1, .node_mass = Vec::Ones(1), .offers_split = true};
  network.anchors = {{0, {0, 0, 0}, {w_s * w_s}}};
  if (w_f > 0) network.anchors.push_back({0, {0, 0, 0}, {w_f * w_f}, Holds::always, true});
  return network;
}

// The growth of sqrt(w^2 q^2 + v^2) in a step, from the last half of `steps` steps.
double observed_growth(const Form& form, double h, double w_f, double w_s, int steps) {
  const auto system = make_mass_spring(two_springs(w_f, w_s));
  const auto amplitude = [&](int count) {
    const Run r = run(method_named(form.name), *system, {0, Vec::Ones(1), Vec::Ones(1)}, count * h,
                      {.step_size = h});
    BOOST_TEST(r.summary.message == "");
    return std::hypot(std::hypot(w_f, w_s) * r.state.q[0], r.state.v[0]);
  };
  return std::pow(amplitude(steps) / amplitude(steps / 2), 2.0 / steps);
}

// Checks that the form grows as the theory predicts, in steps of h at w_s = 1.
void check_growth(const Form& form, double h, double w_f) {
  const double expected = growth(form, h, w_f, 1);
  BOOST_TEST(expected > 1.03);
  // The growing mode is 1e26 times the other one after half of the steps.
  const int steps = 2 * static_cast<int>(std::ceil(30 / std::log(expected)));
  BOOST_TEST(std::abs(observed_growth(form, h, w_f, 1, steps) / expected - 1) < 1e-9);
}

// The orders seen in q and v over four halvings of a step of `coarsest` s.
Orders observed_orders(const Method& method, const System& system, const State& start,
                       const State& end, double coarsest) {
  std::vector<double> q, v;
  for (int halving = 0; halving <= 4; ++halving) {
    const Run r = run(method, system, start, end.t, {.step_size = std::ldexp(coarsest, -halving)});
    BOOST_TEST(r.summary.message == "");
    q.push_back(distance(r.state.q, end.q));
    v.push_back(distance(r.state.v, end.v));
  }
  return {observed_order(q), observed_order(v)};
}

// Here the first term of the errors rules and rounding is far.
constexpr double coarsest = 1.0 / 64;

bool is_of_order(int p, const Orders& observed) {
  return std::abs(observed.q - p) <= 0.1 && std::abs(observed.v - p) <= 0.1;
}

void check_orders(const System& system, const State& start, const State& end) {
  for (const Form& form : forms()) {
    const Orders observed = observed_orders(method_named(form.name), system, start, end, coarsest);
    BOOST_TEST_CONTEXT(form.name << " in q " << observed.q << ", in v " << observed.v) {
      BOOST_TEST(is_of_order(form.order, observed));
    }
  }
}

// A unit mass on a spring of 1 m and k N/m that hangs from the origin of a plane, let go from the
// horizontal.
constexpr double gravity = 9.81;
Problem pendulum(double k) {
  Network network{.dimension = 2, .gravity = {0, -gravity, 0}, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {0, 0, 0}, {k, 1}}};
  return {network, {0, Vec{{1, 0}}, Vec::Zero(2)}};
}

// The same on a rod: a'' = g cos a, a the angle below the horizontal, by 1e5 steps of Verlet, whose
// error is some 1e-10.
State on_a_rod(double t_end) {
  constexpr int steps = 100000;
  const double h = t_end / steps;
  double angle = 0, rate = 0;
  for (int i = 0; i < steps; ++i) {
    rate += h / 2 * gravity * std::cos(angle);
    angle += h * rate;
    rate += h / 2 * gravity * std::cos(angle);
  }
  const Vec along{{std::cos(angle), -std::sin(angle)}},
      across{{-std::sin(angle), -std::cos(angle)}};
  return {t_end, along, rate * across};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_the_formula_by_a_dense_solve) {
  std::mt19937 random(5);
  for (const int dimension : {1, 2, 3}) {
    for (const double stretch : {0.9, 1.2}) {
      const Problem p = random_network(random, dimension, 5, stretch);
      for (const Network& network : {p.network, with_split(p.network)}) {
        const auto system = make_mass_spring(network);
        for (const Form& form : forms()) {
          const double h = 0.01;
          const Run r = run(method_named(form.name), *system, p.initial, h, {.step_size = h});
          // See the suite `one_step`; five steps round as often.
          BOOST_TEST(distance(r.state, by_formula(*system, p.initial, h, form)) < 5e-13);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(both_have_their_orders_on_linear_networks_with_a_stiff_set) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = linear_hammock(dimension);
    const auto system = make_mass_spring(with_split(p.network));
    check_orders(*system, p.initial, LinearMotion(*system).after(p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(both_have_their_orders_on_nonlinear_networks_with_a_stiff_set) {
  for (const int dimension : {1, 2, 3}) {
    const Problem p = hammock(dimension);
    const auto system = make_mass_spring(with_split(p.network));
    check_orders(*system, p.initial, by_kahan_li(*system, p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(either_set_of_springs_may_be_empty) {
  const Problem p = hammock(2);
  for (const bool stiff : {true, false}) {
    const auto system = make_mass_spring(with_all_named(p.network, stiff));
    check_orders(*system, p.initial, by_kahan_li(*system, p.initial, 1));
  }
}

BOOST_AUTO_TEST_CASE(a_force_wrong_by_a_thousandth_is_noticed_and_a_wrong_matrix_is_not) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  const State end = by_kahan_li(*system, p.initial, 1);
  SplitRelay wrong_force(*system), wrong_matrix(*system);
  wrong_force.whole.after_force = [](const ConstVec&, MutableVec f) { f *= 1.001; };
  wrong_matrix.stiff->after_stiffness = [](const Vec&, SymmetricMatrix& k) { k *= 2; };
  for (const Form& form : forms()) {
    const Method& method = method_named(form.name);
    BOOST_TEST(
        !is_of_order(form.order, observed_orders(method, wrong_force, p.initial, end, coarsest)));
    // The order is that of any reversible method, the error another one. Twice the stiffness turns
    // faster and needs finer steps.
    BOOST_TEST(is_of_order(form.order,
                           observed_orders(method, wrong_matrix, p.initial, end, coarsest / 2)));
  }
}

BOOST_AUTO_TEST_CASE(soft_springs_bound_the_step_and_stiff_ones_do_not) {
  const Form& plain = forms().front();
  for (const double w_f : {0.0, 1.0, 30.0, 1e3, 1e6}) {
    for (double h = 0.01; h < 2; h += 0.01) BOOST_TEST(growth(plain, h, w_f, 1) == 1);
    BOOST_TEST(growth(plain, 2.01, w_f, 1) > 1);
    // The amplitude swings where it is bounded: by (1 - h^2 w_s^2 / 4)^-1/2 = 7 here, in 1e4 steps.
    BOOST_TEST(observed_growth(plain, 1.98, w_f, 1, 20000) < 1.001);
  }
  for (const double w_f : {0.0, 1.0, 5.0}) check_growth(plain, 2.2, w_f);
}

BOOST_AUTO_TEST_CASE(five_steps_at_a_time_grow_in_narrow_bands) {
  const Form& five = forms().back();
  // They turn the vibration by a multiple of pi at h w_s = 1.75 and w_f = 5 w_s.
  check_growth(five, 1.75, 5);
  BOOST_TEST(observed_growth(five, 1.65, 5, 1, 20000) < 1.001);
  BOOST_TEST(growth(five, 1.65, 5, 1) == 1);
  // Bands grow narrower and slower with w_f, and none begins below h w_s = 0.9.
  for (const double w_f : {0.0, 1.0, 3.0, 10.0, 100.0, 1e4}) {
    for (double h = 0.01; h < 0.9; h += 0.001) {
      BOOST_TEST(growth(five, h, w_f, 1) < 1.001, "grows at h = " << h << " with w_f = " << w_f);
    }
  }
}

BOOST_AUTO_TEST_CASE(stiff_springs_become_rods) {
  const double t_end = 0.75;
  const State rod = on_a_rod(t_end);
  const double h = t_end / 64;
  const auto error = [&](const char* method, double k, double size) {
    const Problem p = pendulum(k);
    const Run r = run(method_named(method), *make_mass_spring(p.network), p.initial, t_end,
                      {.step_size = size});
    BOOST_TEST(r.summary.message == "");
    return distance(r.state.q, rod.q);
  };
  // Both are of order 2 then.
  for (const Form& form : forms()) {
    std::vector<double> errors;
    for (int halving = 0; halving <= 4; ++halving) {
      errors.push_back(error(form.name, 1e14, std::ldexp(h, -halving)));
    }
    const double order = observed_order(errors);
    BOOST_TEST(std::abs(order - 2) < 0.1, form.name << " has order " << order);
  }
  // Rods are 3 m g / k longer at the lowest point, and vibrate by as much.
  const double limit = error("linear_midpoint", 1e14, h);
  for (const double k : {1e6, 1e8, 1e10, 1e12}) {
    const double e = error("linear_midpoint", k, h);
    BOOST_TEST(std::abs(e / limit - 1) < 0.2, "k = " << k << ": " << e << ", not " << limit);
  }
  BOOST_TEST(error("linear_midpoint4", 1e14, h) < limit / 2);
  // Negative control: what explicit methods make of it.
  const Problem p = pendulum(1e6);
  const Run r =
      run(method_named("verlet"), *make_mass_spring(p.network), p.initial, t_end, {.step_size = h});
  BOOST_TEST(name(r.summary.outcome) == "diverged");
}

BOOST_AUTO_TEST_CASE(a_frame_ten_thousand_times_stiffer_does_not_bound_the_steps) {
  for (const double frame : {1e7, 1e11}) {
    const ReducedScene scene(generate(*find_generator("framed_cloth"),
                                      {{"nodes", 8}, {"frame_stiffness", frame}}, "framed_cloth"));
    const System& system = scene.system();
    const State& start = scene.initial();
    const double t_end = 0.1;
    const double h = 1 / frequency_bound(*split_of(system)->soft, start.q);
    BOOST_TEST(h * frequency_bound(system, start.q) > 30);
    for (const Form& form : forms()) {
      const Method& method = method_named(form.name);
      const State end = run(method, system, start, t_end, {.step_size = h}).state;
      const State fine = run(method, system, start, t_end, {.step_size = h / 16}).state;
      const double motion = distance(fine.q, start.q);
      BOOST_TEST(motion > 0.01);
      BOOST_TEST(distance(end.q, fine.q) < 0.01 * motion, form.name << " at " << frame);
    }
    const Run explicit_run = run(method_named("verlet"), system, start, t_end, {.step_size = h});
    BOOST_TEST(name(explicit_run.summary.outcome) == "diverged");
  }
}

BOOST_AUTO_TEST_CASE(compression_does_not_make_its_matrix_indefinite) {
  Network network{.dimension = 2, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, {-0.5, 0, 0}, {1e5, 0.6}}, {0, {0.5, 0, 0}, {1e5, 0.6}}};
  const auto system = make_mass_spring(network);
  const State start{0, Vec{{0, 1e-6}}, Vec::Zero(2)};
  // Across the springs K is 2 k (0.6 - 0.5) / 0.5, forty thousand times the mass.
  const double h = 0.02;
  BOOST_TEST(
      !EffectiveMass(*system).factorize_positive(1, h * h / 4, stiffness_at(*system, start.q)));
  for (const Form& form : forms()) {
    BOOST_TEST(
        run(method_named(form.name), *system, start, 0.1, {.step_size = h}).summary.message == "");
  }
}

BOOST_AUTO_TEST_CASE(each_part_of_a_step_takes_one_force_one_matrix_and_one_solve) {
  constexpr std::int64_t steps = 20;
  for (const bool is_split : {false, true}) {
    for (const Form& form : forms()) {
      const std::int64_t parts = std::ssize(form.gamma) * steps;
      const auto counts = [&](Network network) {
        const auto system = make_mass_spring(is_split ? with_split(network) : network);
        return run(method_named(form.name), *system, hammock(2).initial, steps * 0.01,
                   {.step_size = 0.01})
            .summary.counts;
      };
      BOOST_TEST(counts(hammock(2).network) == (Counts{.steps = steps,
                                                       .force_evaluations = parts,
                                                       .stiffness_evaluations = parts,
                                                       .factorizations = parts,
                                                       .solves = parts}));
      // With a constant K, one factorisation for each change of the step size: to p, and there and
      // back.
      const std::int64_t sizes = form.order == 2 ? 1 : 1 + 2 * steps;
      BOOST_TEST(counts(linear_hammock(2).network) == (Counts{.steps = steps,
                                                              .force_evaluations = parts,
                                                              .stiffness_evaluations = sizes,
                                                              .factorizations = sizes,
                                                              .solves = parts}));
    }
  }
}

BOOST_AUTO_TEST_CASE(forces_are_those_of_the_whole_and_the_matrix_that_of_the_stiff_springs) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  for (const Form& form : forms()) {
    SplitRelay relay(*system);
    Asked asked;
    count_into(asked, relay);
    const Counts c =
        run(method_named(form.name), relay, p.initial, 1, {.step_size = 0.01}).summary.counts;
    BOOST_TEST(asked.whole_force == c.force_evaluations);
    BOOST_TEST(asked.stiff_stiffness == c.stiffness_evaluations);
    BOOST_TEST(asked.stiff_force + asked.soft_force == 0);
    BOOST_TEST(asked.soft_stiffness + asked.whole_stiffness == 0);
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_number_in_a_force_or_in_a_matrix_is_named) {
  const Problem p = hammock(2);
  const auto system = make_mass_spring(with_split(p.network));
  for (const Form& form : forms()) {
    for (const bool in_matrix : {false, true}) {
      SplitRelay relay(*system);
      int calls = 0;
      if (in_matrix) {
        relay.stiff->after_stiffness = [&](const Vec&, SymmetricMatrix& k) {
          if (++calls == 40) k.coeffs()[0] = NAN;
        };
      } else {
        relay.whole.after_force = [&](const ConstVec&, MutableVec f) {
          if (++calls == 40) f[0] = NAN;
        };
      }
      const Run r = run(method_named(form.name), relay, p.initial, 1, {.step_size = 0.01});
      BOOST_TEST(name(r.summary.outcome) == "not_finite");
      BOOST_TEST(r.summary.counts.steps == 39 / std::ssize(form.gamma));
      BOOST_TEST(is_finite(r.state));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
