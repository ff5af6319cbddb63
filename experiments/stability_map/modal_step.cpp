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

using namespace measure;
namespace {

// The largest displacement as a part of the scene's extent, in the fastest mode: small enough for
// forces to be linear (what is even in it cancels between the two sides), large enough for
// rounding. Slow modes go across springs, whose stretching is the stiffer against them.
constexpr double displacement = 3e-6;
double displacement_in(const Mode& mode) { return displacement * std::sqrt(mode.part); }
// What both leave of the responses.
constexpr double noise = 1e-6;
// No more than rounding of this scene's forces.
constexpr double solved = 1e-12;
constexpr double growth_noise = 1e-6;
const double living = std::log(2) / (4 * M_PI * 10), killing = std::log(10) / (2 * M_PI);

// Steps between one response and the next. In slow modes so many that what a method remembers of
// its start is gone after them and that damping adds up, but no more than an eighth of a period:
// three of them are less than a half.
constexpr double least_stride = 8, most_stride = 16;
int stride_in(double h_omega, bool others_grow) {
  if (others_grow) return 1;  // for they drown this one
  const double eighth = M_PI / 4 / h_omega;
  return eighth < least_stride ? 1 : static_cast<int>(std::min(eighth, most_stride));
}

// A multistep method is looked at after so many steps: its first are another method's, and what
// grows shows only when it has grown.
constexpr int steps_of_start = 64;
int steps_before(const Method& method) { return method.recurrence_roots ? steps_of_start : 0; }

// One run from the scene at rest; `see` takes the state after each stride. How it ended.
Summary run(const Method& method, const ReducedScene& rest, State state, const Options& options,
            int stride, const std::function<void(const State&)>& see) {
  Observer each{{}, see};
  for (int n = 1; n <= steps_observed; ++n) {
    each.times.push_back((steps_before(method) + n * stride) * options.step_size);
  }
  return make_integrator(method, rest.system(), options)->advance(state, each.times.back(), each);
}

}  // namespace

LinearStep modal_step(const Method& method, const ReducedScene& rest, const Mode& mode,
                      Options options) {
  options = with_tolerance_scales(options, rest);
  options.solve_tolerance = solved;
  const double h_omega = options.step_size * mode.omega;
  const bool others_grow =
      linear_step(method, h_omega / mode.part).spectral_radius() > 1 + growth_noise;
  const int stride = stride_in(h_omega, others_grow);
  const Vec& q = rest.initial().q;
  const Vec weights = rest.system().mass().cwiseProduct(mode.shape);
  const double size = displacement_in(mode) * options.length / mode.shape.lpNorm<Eigen::Infinity>();
  Responses y(steps_observed + 1, Eigen::Matrix2d::Identity());
  for (std::size_t n = 1; n < y.size(); ++n) y[n].setZero();
  for (const int start : {0, 1}) {
    for (const double side : {1.0, -1.0}) {
      State state{0, q, Vec::Zero(q.size())};
      if (start == 0) state.q += side * size * mode.shape;
      if (start == 1) state.v += side * size * mode.omega * mode.shape;
      std::size_t n = 0;
      const Summary summary = run(method, rest, state, options, stride, [&](const State& seen) {
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
  if (stride == 1 && steps_before(method) == 0) return {h_omega, roots_of(y, noise)};
  const std::size_t strides = stride == 1 ? 1 : 3;
  if (y.size() < strides + 2) return {h_omega, {std::numeric_limits<double>::infinity()}};
  auto roots = roots_of({Eigen::Matrix2d::Identity(), y[strides + 1] * y[1].inverse()}, noise);
  for (auto& root : roots) root = std::pow(root, 1. / static_cast<double>(strides * stride));
  return {h_omega, roots};
}

std::string modal_verdict(const LinearStep& step) {
  if (step.spectral_radius() > 1 + growth_noise) return "blows up";
  const double zeta = step.damping_ratio();
  if (zeta < living) return "lives";
  return zeta > killing ? "is killed" : "is damped";
}

}  // namespace qddot::stability_map
