#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/advice/hard_kinds.hpp"
#include "experiments/advice/hard_scenes.hpp"
#include "qddot/scene/generators.hpp"

namespace qddot::judged_advice {
namespace {

// The time from one greatest distance to the next of a mass on one spring, by the midpoint rule
// after r = middle - half cos(s): the integrand is then smooth and periodic.
double radial_period(double m, double k, double l0, double r, double v) {
  const double energy = 0.5 * m * v * v + 0.5 * k * (r - l0) * (r - l0), spin = r * v;
  const auto rest = [&](double x) {
    return 2 / m * (energy - 0.5 * k * (x - l0) * (x - l0)) - spin * spin / (x * x);
  };
  // r is a turning point; the other lies where the rest changes its sign again.
  const bool is_outer = rest(r * (1 - 1e-6)) > 0;
  double inside = is_outer ? r * (1 - 1e-6) : r * (1 + 1e-6);
  double outside = inside;
  for (int i = 0; i < 10000 && rest(outside) > 0; ++i) {
    inside = outside;
    outside *= is_outer ? 0.99 : 1.01;
  }
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (inside + outside);
    (rest(middle) > 0 ? inside : outside) = middle;
  }
  const double other = 0.5 * (inside + outside), middle = 0.5 * (r + other);
  const double half = 0.5 * std::abs(r - other);
  double sum = 0;
  constexpr int points = 2000;
  for (int i = 0; i < points; ++i) {
    const double s = std::numbers::pi * (i + 0.5) / points;
    sum += half * std::sin(s) / std::sqrt(rest(middle - half * std::cos(s)));
  }
  return 2 * sum * std::numbers::pi / points;
}

}  // namespace

void near_miss(HardCase& c, Draws& draw) {
  const int d = 2 + draw.one_of(2);
  const double v = draw.by_logarithm(1, 30), b = draw.by_logarithm(1e-5, 0.1);
  c.scene = {.dimension = d};
  c.scene.nodes = {{.mass = draw.by_logarithm(0.3, 3), .pinned = draw.happens(0.7)},
                   {.position = {1, b, 0}, .velocity = {-v, 0, 0}, .mass = 1}};
  const double k = draw.by_logarithm(10, 300);
  join(c.scene, 0, 1, k, draw.between(0.2, 1.3));
  if (draw.happens(0.5)) {
    c.scene.nodes.push_back(
        {.position = Eigen::Vector3d(1, 0.6, 0) + draw.in_box(d, 1), .mass = 1});
    join(c.scene, 1, 2, k * draw.between(0.1, 0.5), apart(c.scene, 1, 2));
  }
  if (draw.happens(0.5)) turn(c.scene, draw);
  c.until = draw.by_logarithm(1.3, 40) / v;
}

void slow_orbit(HardCase& c, Draws& draw) {
  const double k = draw.happens(0.5) ? 100 : draw.by_logarithm(10, 1000);
  c.scene = generate(*find_generator("orbit"),
                     {{"stiffness", k},
                      {"radius", draw.between(1.2, 3)},
                      {"speed", draw.happens(0.2) ? 0 : draw.by_logarithm(1e-3, 1)}},
                     "orbit");
  c.until = draw.by_logarithm(0.5, 50) * 10 / std::sqrt(k);
}

void through_the_pin(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const double k = draw.by_logarithm(5, 200), l0 = draw.between(0.3, 1.2);
  const bool is_quartic = draw.happens(0.3);
  const int axis = draw.one_of(d);
  c.scene = {.dimension = d};
  Node mass{.mass = draw.by_logarithm(0.1, 3)};
  mass.position[axis] = draw.between(0.7, 1.6);
  // More than the energy at length zero.
  const double v = std::sqrt(2 * (0.5 * k * l0 * l0) / mass.mass) * draw.between(0.3, 3);
  if (draw.happens(0.7)) mass.velocity[axis] = -v;
  if (draw.happens(0.5)) c.scene.gravity[axis] = -9.81;
  c.scene.nodes = {{.pinned = true}, mass};
  join(c.scene, 0, 1, is_quartic ? 0 : k, l0, is_quartic || draw.happens(0.2) ? 4 * k : 0);
  if (d == 1 && draw.happens(0.3)) {
    c.scene.nodes.push_back({.position = {mass.position[0] + 0.8, 0, 0}, .mass = 0.5});
    join(c.scene, 1, 2, k, 0.7);
  }
  c.until = std::sqrt(mass.mass / k) * draw.by_logarithm(1, 60);
}

// A mass comes slowly from afar, with a fast small vibration on it, and passes the pinned end
// closely before the end. Or a stiff pendulum stands nearly upright, and falls late.
void late_event(HardCase& c, Draws& draw) {
  if (draw.happens(0.5)) {
    const double k = draw.by_logarithm(0.1, 10), far = draw.between(2, 6);
    const double ratio = draw.by_logarithm(10, 200), light = draw.by_logarithm(1e-3, 0.1);
    const double l0 = draw.between(0.05, 0.5);
    c.scene = {.dimension = 2 + draw.one_of(2)};
    c.scene.nodes = {{.pinned = true},
                     {.position = {far, 0, 0},
                      .velocity = {0, far * std::sqrt(k) * draw.by_logarithm(1e-3, 0.05), 0},
                      .mass = 1},
                     {.position = {far + 0.3, 0.2, 0}, .velocity = {0, 0, 0}, .mass = light}};
    join(c.scene, 0, 1, k, l0);
    join(c.scene, 1, 2, light * k * ratio * ratio, apart(c.scene, 1, 2) * draw.between(0.9, 1));
    if (draw.happens(0.5)) turn(c.scene, draw);
    const double passes = 0.5 * std::numbers::pi * std::sqrt(1 / k);
    c.until = passes * draw.between(1.02, 1.4);
  } else {
    const double k = draw.by_logarithm(1e2, 1e5), away = draw.by_logarithm(1e-9, 1e-2);
    c.scene = {.dimension = 2};
    c.scene.gravity[1] = -9.81;
    c.scene.nodes = {{.pinned = true},
                     {.position = {std::sin(away), std::cos(away), 0}, .mass = 1}};
    join(c.scene, 0, 1, k, 1 + draw.between(0, 2) * 9.81 / k);
    if (draw.happens(0.5)) {
      c.scene.nodes.push_back({.position = {0, 2, 0}, .mass = 0.1});
      join(c.scene, 1, 2, k / 10, apart(c.scene, 1, 2));
    }
    const double falls = std::log(std::numbers::pi / away) / std::sqrt(9.81);
    c.until = falls * draw.between(0.8, 1.4);
  }
}

void commensurate(HardCase& c, Draws& draw) {
  const double k = draw.by_logarithm(10, 1000), m = draw.by_logarithm(0.1, 3);
  const double l0 = draw.between(0.5, 1.2), r = l0 * draw.between(1.05, 2.5);
  const int times = draw.whole(1, 2000), form = draw.one_of(4);
  c.scene = {.dimension = draw.happens(0.5) ? 2 : 3};
  c.scene.nodes = {{.pinned = true}, {.position = {r, 0, 0}, .mass = m}};
  double period = 2 * std::numbers::pi * std::sqrt(m / k);
  if (form <= 1) {
    const double circular = std::sqrt(k / m * (r - l0) * r);
    const double v = form == 0 ? circular : circular * draw.between(0.3, 0.9);
    c.scene.nodes[1].velocity =
        c.scene.dimension == 2 ? Eigen::Vector3d(0, v, 0) : Eigen::Vector3d(0, 0.8 * v, 0.6 * v);
    join(c.scene, 0, 1, k, l0);
    period = form == 0 ? 2 * std::numbers::pi * r / v : radial_period(m, k, l0, r, v);
  } else if (form == 2) {  // linear, with other frequencies in whole ratios
    c.scene.nodes[1].velocity = draw.in_box(c.scene.dimension, 3);
    join(c.scene, 0, 1, k, 0);
    for (std::size_t i = 2; i < 4; ++i) {
      const double n = 2 + draw.one_of(9);
      c.scene.nodes.push_back({.position = draw.in_box(c.scene.dimension, 1), .mass = m});
      join(c.scene, 0, i, n * n * k, 0);
    }
  } else {  // along a line through rest, where the spring does not turn over
    c.scene.dimension = 1;
    c.scene.nodes[1].position[0] = l0 * draw.between(1.05, 1.9);
    join(c.scene, 0, 1, k, l0);
  }
  c.until = times * period;
}

}  // namespace qddot::judged_advice
