#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>
#include <utility>

#include "experiments/kit/plain_model.hpp"

namespace qddot {
inline namespace kit {

// Positions [m] and velocities [m/s] of all nodes at the time t [s], and the energies that damping
// has taken and driving has given [J].
template <class Real>
struct PlainState {
  Real t = 0;
  std::vector<Real> x, v;
  PlainWork<Real> work{};
};

// The motion of a scene's drawn nodes by extrapolation (Hairer, Norsett, Wanner, Solving Ordinary
// Differential Equations I, II.14). Verlet's method makes a long step H of n = 1, 2, ... short
// ones. Its error is in even powers of 1/n; Aitken and Neville's scheme removes it up to order 24
// (16 in long double). H is chosen so that the last two orders agree to `tolerance` of the motion's
// size. If the model is damped or driven, Gragg's method makes the short steps, 2n of them: its
// error is in even powers, too, for forces that depend on velocities. A model of other forces has
// the functions of PlainModel that are called here; is_damped() and what that leads to may be
// missing.
template <class Real, class Model = PlainModel<Real>>
class PlainMotion {
 public:
  PlainMotion(const Scene& scene, Real tolerance) : PlainMotion(Model(scene), tolerance) {}
  PlainMotion(Model model, Real tolerance) : model_(std::move(model)), tolerance_(tolerance) {
    now_ = {0, model_.positions(), model_.velocities()};
    for (std::size_t c = 0; c < now_.x.size(); ++c) now_.x[c] -= model_.origin()[c % 3];
    if constexpr (requires { model_.is_driven(); }) {
      if (model_.is_driven()) model_.place_supports(0, now_.x, now_.v);
    }
    stands_ = model_.place_massless(now_.x);
    const Scene& scene = model_.scene();
    // Velocities of massless nodes follow from the others' and are left at zero.
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      if (scene.nodes[i].mass > 0 || scene.nodes[i].pinned) continue;
      for (std::size_t c = 0; c < 3; ++c) now_.v[3 * i + c] = 0;
    }
  }

  const Model& model() const { return model_; }
  PlainState<Real> state() const {
    PlainState<Real> state = now_;
    for (std::size_t c = 0; c < state.x.size(); ++c) state.x[c] += model_.origin()[c % 3];
    return state;
  }
  // Moves where it is now [m] and how fast [m/s], along one coordinate of a node.
  void displace(std::size_t coordinate, Real by, Real faster) {
    now_.x[coordinate] += by;
    now_.v[coordinate] += faster;
  }
  // The number of the shortest steps, taken at kinks of f (springs of length zero). The error of
  // each is of that step's size.
  int forced_steps() const { return forced_; }
  // The number of steps that were tried.
  int tried_steps() const { return tried_; }

  // Steps to `until` [s]; false where a massless node finds no place or `most_steps` are not
  // enough.
  bool advance(Real until, int most_steps = 30000) {
    if (!stands_) return false;
    const Real shortest = until * Real(1e-15);
    if (step_ == 0) step_ = until / 16;
    int forced_in_a_row = 0;
    for (int i = 0; i < most_steps; ++i) {
      const Real left = until - now_.t;
      if (!(left > 0)) return true;
      const bool is_last = step_ >= left;
      const Real h = is_last ? left : step_;
      ++tried_;
      const std::optional<Real> error = extrapolate(h);
      const bool is_forced = h <= shortest;
      if (!error && is_forced) return false;
      const double ratio = error ? static_cast<double>(*error / tolerance_) : 1e30;
      if (ratio <= 1 || is_forced) {
        forced_in_a_row = ratio > 1 ? forced_in_a_row + 1 : 0;
        if (forced_in_a_row > most_forced_in_a_row) return false;
        forced_ += ratio > 1;
        now_.x = x_[0], now_.v = v_[0], now_.work = work_[0];
        now_.t = is_last ? until : now_.t + h;
        if (!model_.place_massless(now_.x)) return false;
      }
      const double factor = 0.9 * std::pow(std::max(ratio, 1e-30), -1.0 / (2 * levels - 1));
      const Real next = std::max(h * Real(std::clamp(factor, 0.1, 4.0)), shortest);
      if (!is_last || ratio > 1) step_ = next;
    }
    return false;
  }

 private:
  // Each level of the scheme magnifies rounding: more than 8 are for quadruple precision.
  static constexpr int levels =
      sizeof(Real) == sizeof(Quadruple) && !std::is_same_v<Real, long double> ? 12 : 8;
  static constexpr Real magnified_rounding = levels == 12 ? Real(1e-31) : Real(1e-17);
  // A kink is crossed in one or two; where a massless node loses its place there is no end of them.
  static constexpr int most_forced_in_a_row = 20;
  using Vector = std::vector<Real>;

  // Leaves the state after h in x_[0], v_[0]. Returns the difference of the last two orders over
  // the largest motion so far; empty if a massless node found no place.
  std::optional<Real> extrapolate(Real h) {
    const std::size_t n = now_.x.size();
    Vector a0(n), a(n), last_x(n), last_v(n);
    model_.acceleration(now_.x, a0);
    for (int j = 0; j < levels; ++j) {
      const int count = j + 1;
      const Real s = h / Real(count);
      Vector x = now_.x, v = now_.v;
      if (is_damped()) {
        const std::optional<PlainWork<Real>> work = gragg_steps(s / 2, 2 * count, x, v);
        if (!work) return {};
        work_[j] = *work;
      } else {
        for (std::size_t c = 0; c < n; ++c) v[c] += s / 2 * a0[c];
        for (int k = 1; k <= count; ++k) {
          for (std::size_t c = 0; c < n; ++c) x[c] += s * v[c];
          if (!model_.place_massless(x)) return {};
          model_.acceleration(x, a);
          const Real part = k < count ? s : s / 2;
          for (std::size_t c = 0; c < n; ++c) v[c] += part * a[c];
        }
      }
      x_[j] = x, v_[j] = v;
      // x_[k] becomes the entry of order 2 (j - k + 1) of row j, from right to left.
      for (int k = j - 1; k >= 0; --k) {
        if (k == 0) last_x = x_[1], last_v = v_[1];
        const Real weight = Real((j + 1) * (j + 1)) / Real((k + 1) * (k + 1)) - 1;
        work_[k] = work_[k + 1] + 1 / weight * (work_[k + 1] + Real(-1) * work_[k]);
        for (std::size_t c = 0; c < n; ++c) {
          x_[k][c] = x_[k + 1][c] + (x_[k + 1][c] - x_[k][c]) / weight;
          v_[k][c] = v_[k + 1][c] + (v_[k + 1][c] - v_[k][c]) / weight;
        }
      }
    }
    Real error_x = 0, error_v = 0, farthest = 0, travelled = travelled_, speed = speed_;
    for (std::size_t c = 0; c < n; ++c) {
      farthest = std::max(farthest, magnitude(now_.x[c]));
      travelled = std::max(travelled, magnitude(x_[0][c] - now_.x[c]));
      speed = std::max({speed, magnitude(v_[0][c]), magnitude(a0[c]) * h});
      take_larger(error_x, magnitude(x_[0][c] - last_x[c]));
      take_larger(error_v, magnitude(v_[0][c] - last_v[c]));
    }
    // A displacement is as large as the motion has ever been in the time of a step.
    travelled = std::max(travelled, speed * h);
    if (travelled == 0) return Real(0);
    // Shorter steps do not reduce the rounding of positions, nor its effect on velocities.
    const Real noise = magnified_rounding * farthest / (travelled * tolerance_);
    Real error = error_x / travelled;
    take_larger(error, error_v / speed);
    error /= std::max(noise, Real(1));
    if (!(error >= 0)) return Real(1e30);  // no number
    if (error <= tolerance_) travelled_ = travelled, speed_ = speed;
    return error;
  }

  bool is_damped() const {
    if constexpr (requires { model_.is_damped(); }) return model_.is_damped() || model_.is_driven();
    return false;
  }

  // Makes `count` steps s of Gragg's method with its last smoothing, from x and v. Returns the work
  // by then; empty if a massless node found no place.
  std::optional<PlainWork<Real>> gragg_steps(Real s, int count, Vector& x, Vector& v) const {
    if constexpr (!requires { model_.is_damped(); })
      return {};
    else {
      const std::size_t n = x.size();
      Vector last_x = x, last_v = v, a(n);
      PlainWork<Real> work = now_.work, last_work = work;
      for (int k = 0; k <= count; ++k) {
        const Real t = now_.t + Real(k) * s;
        if (model_.is_driven()) model_.place_supports(t, x, v);
        const PlainWork<Real> power = model_.acceleration(t, x, v, a);
        const Real part = k == 0 || k == count ? s : 2 * s;
        // y_{k+1} = y_{k-1} + 2 s F(y_k); the first is Euler's, the last (y_n + y_{n-1} + s F)/2.
        for (std::size_t c = 0; c < n; ++c) {
          last_x[c] += part * v[c];
          last_v[c] += part * a[c];
        }
        last_work = last_work + part * power;
        if (k == count) {
          for (std::size_t c = 0; c < n; ++c) {
            x[c] = (x[c] + last_x[c]) / 2;
            v[c] = (v[c] + last_v[c]) / 2;
          }
          work = Real(0.5) * (work + last_work);
          if (model_.is_driven()) model_.place_supports(t, x, v);
        } else {
          std::swap(x, last_x);
          std::swap(v, last_v);
          std::swap(work, last_work);
        }
        if (!model_.place_massless(x)) return {};
      }
      return work;
    }
  }

  // A result that is not a number is kept, not lost.
  static void take_larger(Real& largest, Real value) {
    if (!(value <= largest)) largest = value;
  }
  static Real magnitude(Real x) { return x < 0 ? -x : x; }

  Model model_;
  Real tolerance_, step_ = 0, travelled_ = 0, speed_ = 0;
  PlainState<Real> now_;  // positions from the model's origin
  bool stands_ = false;
  int forced_ = 0, tried_ = 0;
  Vector x_[levels], v_[levels];
  PlainWork<Real> work_[levels] = {};
};

template <template <class> class Model, class Real>
PlainMotion(Model<Real>, Real) -> PlainMotion<Real, Model<Real>>;

}  // namespace kit
}  // namespace qddot
