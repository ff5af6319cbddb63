#pragma once

namespace qddot {

// The responses of y'' = -2 gamma y' - w^2 y + b after a time t: from y = 0,
//   y(t) = y'(0) s + b g,   y'(t) = y'(0) c + b s.
struct ModeResponse {
  double c, s, g;  // [1], [s], [s^2]
};

// These for gamma [1/s], w^2 [1/s^2] and t >= 0 [s]. A mode may vibrate, creep, or grow (w^2 < 0).
// They are good to some roundings, also near critical damping and for w = 0. With
// d = w^2 - gamma^2 = n^2, s = e^(-gamma t) sin(n t)/n, c = s' and g = (1 - c - 2 gamma s)/w^2. For
// d = -m^2 they are sums of e^(-r t) with the rates r = gamma + m and w^2/(gamma + m), of which no
// digits cancel. For small t all follow from the Taylor series of g, whose coefficients the
// equation gives.
ModeResponse mode_response(double gamma, double square, double t);

}  // namespace qddot
