#include "experiments/stability_map/modal_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <fmt/format.h>

#include "qddot/integrators/registry.hpp"
#include "qddot/measure/motion/tolerance_scales.hpp"

namespace qddot::stability_map {
namespace {

// The largest displacement in the fastest mode, as a part of the scene's extent. It is small enough
// for linear forces (even terms cancel between the two sides) and large enough for rounding. Slow
// modes are smaller: they move across springs, whose stretching is stiffer.
constexpr double displacement = 3e-6;
double displacement_in(const Mode& mode) { return displacement * std::sqrt(mode.part); }
// The noise that rounding and nonlinearity leave in the responses.
constexpr double noise = 1e-6;
// Solves are carried to rounding of this scene's forces.
constexpr double solved = 1e-12;
constexpr double growth_noise = 1e-6;
const double living = std::log(2) / (4 * M_PI * 10), killing = std::log(10) / (2 * M_PI);

// The number of steps between two responses. For slow modes it is large, so that the method forgets
// its start and damping adds up. It is at most an eighth of a period: three strides are less than a
// half.
constexpr double least_stride = 8, most_stride = 16;
int stride_in(double h_omega, bool others_grow) {
  if (others_grow) return 1;  // the others hide this one
  const double eighth = M_PI / 4 / h_omega;
  return eighth < least_stride ? 1 : static_cast<int>(std::min(eighth, most_stride));
}

// The times at which the responses to a start are recorded: after each stride of `steps`, after the
// first `before` steps.
struct Looks {
  int before, strides, steps;
};
// The steps before a multistep method is observed: its first ones are another method's.
constexpr int steps_of_start = 64;
// The first steps leave vibrations in the spurious roots too, which average out over this many
// steps.
constexpr int steps_of_average = 512;
Looks looks_at(const Method& method, int stride) {
  if (!method.recurrence_roots) return {0, steps_observed, stride};
  return {steps_of_start, stride == 1 ? steps_of_average : steps_observed, stride};
}

// Runs the method on the scene at rest; `see` takes the state at each look.
Summary run(const Method& method, const Model& rest, State state, const Options& options,
            const Looks& looks, const std::function<void(const State&)>& see) {
  Observer each{{}, see};
  for (int n = 1; n <= looks.strides; ++n) {
    each.times.push_back((looks.before + n * looks.steps) * options.step_size);
  }
  return make_integrator(method, rest.system(), options)->advance(state, each.times.back(), each);
}

// The mean factor (growth and rotation) of the responses to a displacement in a step. w_n = q - i
// v/w rotates by the root's angle. The sums of two windows, rotated back by about that angle,
// differ by the root's power. Windows with smooth ends suppress parts that rotate by other angles.
std::complex<double> mean_root(const Responses& y) {
  const std::size_t width = (y.size() - 1) / 2;
  const auto w = [&](std::size_t n) { return std::complex<double>(y[n](0, 0), -y[n](1, 0)); };
  std::complex<double> turn = 0;
  for (std::size_t n = 1; n + 1 < y.size(); ++n) turn += w(n + 1) * std::conj(w(n));
  const double angle = std::arg(turn);
  const auto window = [&](std::size_t from) {
    std::complex<double> sum = 0;
    for (std::size_t n = 0; n < width; ++n) {
      const auto at = static_cast<double>(n);
      const double rise = std::sin(M_PI * (at + 0.5) / static_cast<double>(width));
      sum += rise * rise * w(from + n) * std::polar(1.0, -angle * at);
    }
    return sum;
  };
  const auto steps = static_cast<double>(width);
  const auto power = window(1 + width) / window(1) * std::polar(1.0, -angle * steps);
  return std::polar(1.0, angle) * std::pow(power, 1 / steps);
}

}  // namespace

LinearStep modal_step(const Method& method, const Model& rest, const Mode& mode, Options options) {
  options = with_tolerance_scales(options, rest);
  options.solve_tolerance = solved;
  const double h_omega = options.step_size * mode.omega;
  const bool others_grow =
      linear_step(method, h_omega / mode.part).spectral_radius() > 1 + growth_noise;
  const Looks looks = looks_at(method, stride_in(h_omega, others_grow));
  if (others_grow && looks.before > 0) {
    throw std::runtime_error(fmt::format(
        "{} in mode {}: vibrations grow at this step size, and hide the mode within {} steps",
        method.name, mode.rank, looks.before));
  }
  const Vec& q = rest.initial().q;
  const Vec weights = rest.system().mass().cwiseProduct(mode.shape);
  const double size = displacement_in(mode) * options.length / mode.shape.lpNorm<Eigen::Infinity>();
  Responses y(static_cast<std::size_t>(looks.strides) + 1, Eigen::Matrix2d::Identity());
  for (std::size_t n = 1; n < y.size(); ++n) y[n].setZero();
  for (const int start : {0, 1}) {
    for (const double side : {1.0, -1.0}) {
      State state{0, q, Vec::Zero(q.size())};
      if (start == 0) state.q += side * size * mode.shape;
      if (start == 1) state.v += side * size * mode.omega * mode.shape;
      std::size_t n = 0;
      const Summary summary = run(method, rest, state, options, looks, [&](const State& seen) {
        y[++n].col(start) +=
            side / (2 * size) *
            Eigen::Vector2d(weights.dot(seen.q - q), weights.dot(seen.v) / mode.omega);
      });
      if (n == 0 && summary.outcome == Outcome::diverged) {
        return {h_omega, {std::numeric_limits<double>::infinity()}};
      }
      if (summary.outcome == Outcome::diverged) {
        y.resize(std::min(y.size(), n + 1));
      } else if (summary.outcome != Outcome::reached_end) {
        throw std::runtime_error(
            fmt::format("{} in mode {}: {}", method.name, mode.rank, summary.message));
      }
    }
  }
  if (looks.steps == 1 && looks.before == 0) return {h_omega, roots_of(y, noise)};
  if (looks.strides == steps_of_average && y.size() > steps_of_average) {
    const std::complex<double> root = mean_root(y);
    return {h_omega, {root, std::conj(root)}};
  }
  const std::size_t strides = looks.steps == 1 ? 1 : 3;
  if (y.size() < strides + 2) return {h_omega, {std::numeric_limits<double>::infinity()}};
  auto roots = roots_of({Eigen::Matrix2d::Identity(), y[strides + 1] * y[1].inverse()}, noise);
  for (auto& root : roots) root = std::pow(root, 1. / static_cast<double>(strides * looks.steps));
  return {h_omega, roots};
}

std::string modal_verdict(const LinearStep& step) {
  if (step.spectral_radius() > 1 + growth_noise) return "blows up";
  const double zeta = step.damping_ratio();
  if (zeta < living) return "lives";
  return zeta > killing ? "is killed" : "is damped";
}

}  // namespace qddot::stability_map
