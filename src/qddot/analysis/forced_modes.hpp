#pragma once

#include <cmath>
#include <vector>

#include "qddot/model/capabilities.hpp"

namespace qddot {

// The response of modes to forces of time, in one duration h. A mode y'' = -w^2 y - 2 gamma y' +
// u(s) starts from rest. The force u is a solution of a linear equation of its own, which is
// appended:
//   u = sin(W s + theta):  (u, c)' = (W c, -W u);   u = s^k/k!:  u_k' = u_{k-1}
// So y(h) and y'(h) are in the exponential of a small matrix, for each mode and each W, by scaling
// and squaring (see ExponentialMotion). A resonance W = w is no special case.
class ForcedModes {
 public:
  // `squares`: w^2 [rad^2/s^2] of the modes, also negative; `gamma` [1/s]: of all, or empty.
  ForcedModes(const Vec& squares, const Vec& gamma, const Forcing& forcing, double duration);

  // Whether it is that of this forcing and duration, whatever the amplitudes.
  bool is_for(const Forcing& forcing, double duration) const;

  // Adds to y and y' of the modes what the forces do in the duration after t, beyond those at t.
  // `project(f)` gives the part of each mode in M^-1/2 f.
  template <class Project>
  void add(const Forcing& forcing, double t, const Project& project, Vec& y, Vec& rate) const {
    for (std::size_t k = 0; k < forcing.harmonics.size(); ++k) {
      const auto& [frequency, phase, amplitude] = forcing.harmonics[k];
      const Vec push = project(amplitude);
      const double sine = std::sin(frequency * t + phase), cosine = std::cos(frequency * t + phase);
      const Response& of = harmonics_[k];
      y += push.cwiseProduct(sine * (of.y[0] - steady_.y[0]) + cosine * of.y[1]);
      rate += push.cwiseProduct(sine * (of.rate[0] - steady_.rate[0]) + cosine * of.rate[1]);
    }
    for (std::size_t k = 1; k < forcing.derivatives.size(); ++k) {
      const Vec push = project(forcing.derivatives[k]);
      y += push.cwiseProduct(polynomial_.y[k]);
      rate += push.cwiseProduct(polynomial_.rate[k]);
    }
  }

 private:
  // y and y' of all modes, for a force of each kind: sine and cosine, or 1, s, s^2/2, ...
  struct Response {
    std::vector<Vec> y, rate;
  };
  Response response(const Vec& squares, const Vec& gamma, const Eigen::MatrixXd& of_force) const;

  double duration_;
  std::vector<double> frequencies_;
  std::size_t terms_;
  std::vector<Response> harmonics_;
  Response polynomial_, steady_;  // the latter: of a force of 1
};

}  // namespace qddot
