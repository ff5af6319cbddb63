#include <algorithm>

#include "experiments/local_global/iterated_steps.hpp"
#include "qddot/algebra/effective_mass.hpp"
#include "qddot/integrators/base/compression.hpp"
#include "qddot/integrators/base/fixed_step.hpp"

namespace qddot::local_global {
namespace {

constexpr int most_halvings = 30;

template <bool is_clamped>
class Newton final : public FixedStep {
 public:
  using FixedStep::FixedStep;

 private:
  Outcome step(const State& now, double h, State& next) override {
    const auto move_to = [&](const Vec& v) {
      next.v = v;
      next.q = now.q + h * v;
    };
    const auto energy = [&] {
      return system().kinetic(next.v - now.v) + system().potential(next.q);
    };
    move_to(now.v);
    compression_.start();
    double g = energy();
    for (int i = 0; i < options().iterations; ++i) {
      force(next.q, f_);
      r_ = system().mass().cwiseProduct(next.v - now.v) - h * f_;
      if (!factorize(next.q, h * h)) return Outcome::indefinite_matrix;
      matrix_.solve(r_, p_);
      ++counts().solves;
      ++counts().newton_iterations;
      v_ = next.v;
      const double slope = r_.dot(p_);
      double alpha = 1, lower = g;
      for (int halvings = 0; halvings < most_halvings; ++halvings, alpha /= 2) {
        move_to(v_ - alpha * p_);
        lower = energy();
        if (lower <= g - 1e-4 * alpha * slope) break;
        move_to(v_);
      }
      g = std::min(g, lower);
    }
    return Outcome::reached_end;
  }

  bool factorize(const Vec& q, double s) {
    const auto works = [&](double kept) {
      weighted_stiffness(q, kept, k_);
      ++counts().factorizations;
      return matrix_.factorize_positive(1, s, k_);
    };
    if (is_clamped) return works(0);
    compression_.harden();
    return compression_.find(works);
  }

  Vec f_{system().size()}, r_{system().size()}, p_{system().size()}, v_{system().size()};
  SymmetricMatrix k_{system().stiffness_pattern()};
  EffectiveMass matrix_{system()};
  Compression compression_;
};

template <bool is_clamped>
Method newton(const char* name, const char* summary) {
  return {.name = name,
          .summary = summary,
          .source = "Nocedal and Wright, Numerical Optimization, chapter 3",
          .traits = {Trait::implicit, Trait::accepts_massless},
          .needs = {Need::stiffness},
          .takes = {Option::iterations},
          .make = create<Newton<is_clamped>>};
}

}  // namespace

const Method& newton_exact() {
  static const Method method =
      newton<false>("newton_exact", "backward Euler by Newton with K as it is");
  return method;
}

const Method& newton_clamped() {
  static const Method method =
      newton<true>("newton_clamped", "backward Euler by Newton with compressed springs' K clamped");
  return method;
}

}  // namespace qddot::local_global
