#include "qddot/measure/stability/linear_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

#include "qddot/algebra/dense_pairs.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/model/mass_spring.hpp"

namespace qddot::inline measure {
namespace {

using Complex = std::complex<double>;
using Eigen::Matrix4d;

// The relative error that rounding may leave in the responses of an oscillator.
constexpr double root_rounding = 1e-11;

// The roots of a 2 x 2 matrix. Near a double root, t +- sqrt(t^2 - d) keeps digits that an
// iteration loses.
std::vector<Complex> pair_of_roots(const Eigen::Matrix2d& a) {
  const double t = (a(0, 0) + a(1, 1)) / 2, d = a.determinant();
  const double discriminant = t * t - d;
  if (discriminant < 0) {
    const double imaginary = std::sqrt(-discriminant);
    return {{t, imaginary}, {t, -imaginary}};
  }
  const double larger = t + std::copysign(std::sqrt(discriminant), t);
  return {larger, larger == 0 ? 0 : d / larger};
}

bool is_close(const Eigen::Matrix2d& y, const Eigen::Matrix2d& expected, double noise) {
  return (y - expected).norm() <= noise * std::max(1.0, y.norm());
}

bool is_without_memory(const Responses& y, double noise) {
  Eigen::Matrix2d power = y[1];
  for (std::size_t n = 2; n < y.size(); ++n) {
    power *= y[1];
    if (!is_close(y[n], power, noise)) return false;
  }
  return true;
}

// The roots of A with `rank` rows, and whether A explains all responses.
struct Realization {
  std::vector<Complex> roots{};
  bool explains = true;
};
Realization realize(const Responses& y, int rank, double noise) {
  Matrix4d now, next;
  now << y[0], y[1], y[1], y[2];
  next << y[1], y[2], y[2], y[3];
  const Eigen::JacobiSVD<Matrix4d, Eigen::NoQRPreconditioner> svd(
      now, Eigen::ComputeFullU | Eigen::ComputeFullV);
  // Rows and columns beyond the rank stay zero.
  Eigen::Vector4d root = Eigen::Vector4d::Zero(), inverse = root;
  root.head(rank) = svd.singularValues().head(rank).cwiseSqrt();
  inverse.head(rank) = root.head(rank).cwiseInverse();
  const Matrix4d observes = svd.matrixU() * root.asDiagonal();
  const Matrix4d a = inverse.asDiagonal() *
                     (svd.matrixU().transpose() * (next * svd.matrixV())).eval() *
                     inverse.asDiagonal();
  Realization result;
  Eigen::Matrix<double, 4, 2> state = (svd.matrixV() * root.asDiagonal()).transpose().leftCols<2>();
  for (std::size_t n = 0; n < y.size(); ++n, state = a * state) {
    result.explains = result.explains && is_close(y[n], observes.topRows<2>() * state, noise);
  }
  const Eigen::VectorXcd roots = general_values(a.topLeftCorner(rank, rank));
  result.roots.assign(roots.begin(), roots.end());
  return result;
}

std::vector<Complex> found_roots(const Responses& y, double noise) {
  if (y.size() > 1 && is_without_memory(y, noise)) return pair_of_roots(y[1]);
  if (y.size() <= steps_observed) return {std::numeric_limits<double>::infinity()};
  const Realization three = realize(y, 3, noise);
  return three.explains ? three.roots : realize(y, 4, noise).roots;
}

// One mass and one spring of rest length zero with w = 1, on a line.
std::unique_ptr<System> oscillator() {
  Network network{.dimension = 1, .node_mass = Vec::Ones(1)};
  network.anchors = {{0, Eigen::Vector3d::Zero(), {.stiffness = 1}}};
  return make_mass_spring(network);
}

Responses respond(const Method& method, const Options& options) {
  const auto system = oscillator();
  const auto integrator = make_integrator(method, *system, options);
  Responses y(steps_observed + 1, Eigen::Matrix2d::Identity());
  for (const int start : {0, 1}) {
    State state{0, Vec::Constant(1, 1 - start), Vec::Constant(1, start)};
    Observer each;
    for (int n = 1; n <= steps_observed; ++n) each.times.push_back(n * options.step_size);
    std::size_t n = 0;
    each.see = [&](const State& seen) { y[++n].col(start) << seen.q[0], seen.v[0]; };
    const Summary summary = integrator->advance(state, each.times.back(), each);
    if (summary.outcome == Outcome::diverged) {
      y.resize(std::min(y.size(), n + 1));
    } else if (summary.outcome != Outcome::reached_end) {
      throw std::runtime_error(fmt::format("{} on an oscillator at h w = {:g}: {}", method.name,
                                           options.step_size, summary.message));
    }
  }
  return y;
}

}  // namespace

double LinearStep::damping_ratio() const {
  const Complex exponent = std::log(roots.front());  // of the modulus, and i times the angle
  return exponent == 0. ? 0 : -exponent.real() / std::abs(exponent);
}

double LinearStep::period_error() const {
  const double angle = std::abs(std::arg(roots.front()));
  return angle == 0 ? std::numeric_limits<double>::infinity() : h_omega / angle - 1;
}

std::vector<Complex> roots_of(const Responses& y, double noise) {
  std::vector<Complex> roots = found_roots(y, noise);
  std::ranges::stable_sort(roots, std::ranges::greater(),
                           [](const Complex& root) { return std::abs(root); });
  return roots;
}

LinearStep linear_step(const Method& method, double h_omega, Options options) {
  if (!has_linear_step(method)) {
    throw std::invalid_argument(method.name + " has no step of its own: it chooses its steps");
  }
  if (method.recurrence_roots) return {h_omega, method.recurrence_roots(h_omega)};
  options.step_size = h_omega;  // w = 1
  return {h_omega, roots_of(respond(method, options), root_rounding)};
}

}  // namespace qddot::inline measure
