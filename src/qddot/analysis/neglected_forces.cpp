#include "qddot/analysis/neglected_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "qddot/algebra/effective_mass.hpp"
#include "qddot/analysis/linear_motion.hpp"
#include "qddot/model/capabilities.hpp"
#include "qddot/model/linearized_system.hpp"

namespace qddot {
namespace {

// Displacements are enlarged to this part of the length where forces are compared: the third order
// is then a millionth of the first, far above rounding, and the fifth no longer counts.
constexpr double enlarged = 1e-3;
// The shift for derivatives of K, as a part of the length: of the fifth digit, both ways.
constexpr double shift = 1e-5;

// The factor >= 1 by which a displacement is enlarged.
double enlargement(const Vec& u, double length) {
  const double largest = u.lpNorm<Eigen::Infinity>();
  return largest > 0 ? std::max(1.0, enlarged * length / largest) : 1;
}

SymmetricMatrix stiffness_at(const System& system, const Vec& q) {
  SymmetricMatrix k = system.stiffness_pattern();
  system.stiffness(q, k);
  return k;
}

// The modes of one motion: their frequencies under air and without, the root of P, their amplitudes
// and shapes M^-1/2 U.
struct Modes {
  Vec frequency, root, amplitude;
  Eigen::MatrixXd shapes;
};

Modes modes_of(const SmallMotion& motion, const System& linear) {
  const LinearMotion exact(linear);
  const Vec& mass = motion.system.mass();
  const double gamma = linear.damping() ? linear.damping()->air_damping() / 2 : 0;
  Modes modes;
  modes.shapes = mass.cwiseSqrt().cwiseInverse().asDiagonal() * exact.modes();
  modes.root = exact.squares().cwiseSqrt();
  modes.frequency = (exact.squares().array() - gamma * gamma).max(0).sqrt();
  // The linear motion vibrates about the place where its forces vanish.
  Vec f(motion.middle.size());
  linear.force(motion.middle, f);
  const Vec push = modes.shapes.transpose() * f;
  const Vec y = modes.shapes.transpose() * mass.cwiseProduct(motion.start.q - motion.middle) -
                push.cwiseQuotient(exact.squares());
  const Vec rate = modes.shapes.transpose() * mass.cwiseProduct(motion.start.v) + gamma * y;
  modes.amplitude = (y.array().square() + (rate.array() / modes.frequency.array()).square()).sqrt();
  return modes;
}

// The modes of larger energy, all but what has no more than `negligible`, the root of sum (w A)^2.
std::vector<Index> larger_ones(const Modes& modes, double negligible) {
  const Vec size = modes.root.cwiseProduct(modes.amplitude);
  std::vector<Index> order(static_cast<std::size_t>(size.size()));
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index k) { return size[k]; });
  double left = 0;
  const auto first = std::ranges::find_if(order, [&](Index k) {
    left += size[k] * size[k];
    return left > negligible * negligible;
  });
  order.erase(order.begin(), first);
  return order;
}

// Step 1 for all modes.
Vec second_order(const SmallMotion& motion, const Modes& modes, const std::vector<Index>& larger) {
  const Vec& w = modes.frequency;
  const Eigen::MatrixXd shapes = modes.shapes(Eigen::all, larger);
  Vec answer = Vec::Zero(w.size());
  for (const Index b : larger) {
    const Vec shape = modes.shapes.col(b);
    const double step = shift * motion.length / shape.lpNorm<Eigen::Infinity>();
    const SymmetricMatrix up = stiffness_at(motion.system, motion.middle + step * shape),
                          down = stiffness_at(motion.system, motion.middle - step * shape);
    const SymmetricMatrix change = (up - down) / (2 * step);
    const Eigen::MatrixXd coupling =
        modes.shapes.transpose() * (change.selfadjointView<Eigen::Lower>() * shapes);
    for (std::size_t j = 0; j < larger.size(); ++j) {
      const Index c = larger[j];
      const double product = modes.amplitude[b] * modes.amplitude[c] / 4;
      for (const double n : {w[b] + w[c], std::abs(w[b] - w[c])}) {
        const auto beat = (w.array() - n).abs();
        answer.array() += coupling.col(static_cast<Index>(j)).array().abs() * product *
                          ((2 / beat).min(motion.duration) + 2 / (w.array() + n)) / (2 * w.array());
      }
    }
  }
  // Under air all amplitudes fall. By the second mean value theorem, for a real and an imaginary
  // part, an integral over them is at most so many times longer.
  return motion.system.damping() ? Vec(std::numbers::sqrt2 * answer) : answer;
}

// The mean size |M^-1/2 s| [N/kg^1/2] of the forces of r that are not of second order.
double size_of_others(const SmallMotion& motion, const System& linear) {
  const System& system = motion.system;
  const Vec& p = motion.middle;
  const Vec per_root = system.mass().cwiseSqrt().cwiseInverse();
  Vec at_middle(p.size()), f(p.size());
  system.force(p, at_middle);
  const auto force = [&](const Vec& u) -> Vec {
    system.force(Vec(p + u), f);
    return f - at_middle;
  };
  double sum = 0;
  for (const Vec& seen : motion.seen) {
    const double s = enlargement(seen, motion.length);
    const Vec u = s * seen, half = u / 2;
    const Vec up = force(u), down = force(-u);
    Vec first(p.size());
    linear.multiply_stiffness(p, u, first);
    const Vec odd = (up - down) / 2 - first;
    // The second order is four times that of half of u.
    const Vec even = 4. / 3 * ((up + down) / 2 - 2 * (force(half) + force(-half)));
    sum += per_root.cwiseProduct(odd).norm() / (s * s * s) +
           per_root.cwiseProduct(even).norm() / (s * s * s * s);
  }
  return motion.seen.empty() ? 0 : sum / static_cast<double>(motion.seen.size());
}

}  // namespace

double feedback_rate(const System& system, const Vec& middle, const std::vector<Vec>& displacements,
                     double length) {
  constexpr int iterations = 20;
  constexpr double more = 1.1;
  const Index n = system.size();
  EffectiveMass solver(system);
  const SymmetricMatrix k = stiffness_at(system, middle);
  if (!solver.factorize_positive(0, 1, k)) return std::numeric_limits<double>::infinity();
  double largest = 0;
  Vec x(n), next(n);
  for (const Vec& u : displacements) {
    const double s = enlargement(u, length);
    const SymmetricMatrix change = (stiffness_at(system, middle + s * u) - k) / s;
    const auto times = [&](const Vec& a) -> Vec {
      return change.selfadjointView<Eigen::Lower>() * a;
    };
    // A start with a part in each shape.
    for (Index i = 0; i < n; ++i) x[i] = std::cos(1 + 2.4 * static_cast<double>(i));
    double square = 0;  // x'D M^-1 D x / x'P x, whose largest value is sought
    for (int i = 0; i < iterations; ++i) {
      const double norm = -x.dot(Vec(k.selfadjointView<Eigen::Lower>() * x));
      if (!(norm > 0)) break;
      x /= std::sqrt(norm);
      const Vec pull = times(x).cwiseQuotient(system.mass());
      const Vec force = times(pull);
      square = std::max(square, x.dot(force));
      solver.solve(force, next);
      std::swap(x, next);
    }
    largest = std::max(largest, more * std::sqrt(square));
  }
  return largest;
}

Vec neglected_displacement(const SmallMotion& motion, double feedback, double tolerance) {
  constexpr double small = 0.05, doubt = 2;
  const auto linear = linearized(motion.system, motion.middle);
  const Modes modes = modes_of(motion, *linear);
  const Vec& w = modes.root;
  const double time = motion.duration;
  // (P^-1)_ii^1/2 [m/J^1/2].
  const Vec compliance = (modes.shapes * w.cwiseInverse().asDiagonal()).rowwise().norm();
  const double most = compliance.maxCoeff();
  const double negligible = feedback > 0 ? small * tolerance / (doubt * most * time * feedback) : 0;
  const std::vector<Index> larger = larger_ones(modes, negligible);
  const Vec answer = second_order(motion, modes, larger);
  const double force =
      size_of_others(motion, *linear) + feedback * (w.cwiseProduct(answer).norm() + negligible);
  const double energy_root = doubt * time * force * std::exp(time * feedback / 2);
  return modes.shapes.cwiseAbs() * answer + energy_root * compliance;
}

}  // namespace qddot
