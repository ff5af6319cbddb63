#include <algorithm>
#include <cmath>
#include <numbers>

#include "experiments/advice/hard_kinds.hpp"
#include "experiments/advice/hard_scenes.hpp"

namespace qddot::judged_advice {

void bounce(HardCase& c, Draws& draw) {
  const int d = 1 + draw.one_of(3);
  const std::size_t bodies = draw.happens(0.6) ? 2 : 3 + static_cast<std::size_t>(draw.one_of(2));
  const PairLaw law{draw.happens(0.6) ? PairLaw::Form::lennard_jones : PairLaw::Form::morse,
                    draw.by_logarithm(0.01, 10), draw.between(0.5, 1.5)};
  const double speed = std::sqrt(law.depth) * draw.by_logarithm(0.03, 5);
  c.scene = {.dimension = d};
  double x = 0;
  for (std::size_t i = 0; i < bodies; ++i) {
    Node node{.position = {x, 0, 0}, .mass = draw.by_logarithm(0.3, 3)};
    node.velocity[0] = speed * (i == 0 ? 1 : i == 1 ? -1 : draw.between(-1, 1));
    for (int a = 1; a < d; ++a)
      node.position[a] = draw.between(-1, 1) * law.size * draw.by_logarithm(1e-3, 0.3);
    c.scene.nodes.push_back(node);
    x += law.size * draw.between(1.2, 4);
    for (std::size_t j = 0; j < i; ++j) c.pairs.push_back({j, i, law});
  }
  c.gives_stiffness = draw.happens(0.5);
  c.gives_energy = c.of == AccuracyOf::energy || draw.happens(0.8);
  c.until = 1.5 * law.size / speed * draw.by_logarithm(1, 15);
}

void planet(HardCase& c, Draws& draw) {
  const double eccentricity = 1 - draw.by_logarithm(3e-3, 0.6), a = draw.by_logarithm(0.3, 3);
  const bool is_fixed = draw.happens(0.5), is_far = draw.happens(0.8);
  const double sun = draw.by_logarithm(0.3, 3), own = is_fixed ? 1 : draw.by_logarithm(1e-4, 1);
  const double mu = is_fixed ? sun : sun + own;
  const double r = a * (is_far ? 1 + eccentricity : 1 - eccentricity);
  const double v = std::sqrt(mu * (2 / r - 1 / a));
  c.scene = {.dimension = 2 + draw.one_of(2)};
  c.scene.nodes = {{.position = {r, 0, 0}, .velocity = {0, v, 0}, .mass = own}};
  OwnPair pair{0, {}, {PairLaw::Form::gravity, sun * own, 1}};
  if (!is_fixed) {
    c.scene.nodes.push_back({.velocity = {0, -v * own / sun, 0}, .mass = sun});
    c.scene.nodes[0].velocity *= sun / mu, c.scene.nodes[1].velocity *= sun / mu;
    pair.other = 1;
  }
  c.pairs = {pair};
  if (c.scene.dimension == 3) turn(c.scene, draw);
  c.gives_stiffness = draw.happens(0.5);
  c.until = 2 * std::numbers::pi * std::sqrt(a * a * a / mu) * draw.by_logarithm(0.2, 10);
}

}  // namespace qddot::judged_advice
