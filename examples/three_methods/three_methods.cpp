// A cloth as arrays, let go by three methods at one step size, and where its energy goes.
#include <cstdio>
#include <qddot/qddot.hpp>
#include <vector>

namespace {

constexpr int side = 12;          // nodes along an edge
constexpr double spacing = 0.05;  // [m]

std::size_t node(int column, int row) { return static_cast<std::size_t>(column + side * row); }

// A square cloth in the x-z plane, held at two corners: springs along its threads and across.
qddot::SceneArrays cloth() {
  qddot::SceneArrays a;
  a.positions.resize(side * side, 3);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const auto i = static_cast<Eigen::Index>(node(column, row));
      a.positions.row(i) << column * spacing, 0, row * spacing;
      if (column + 1 < side) a.springs.push_back({node(column, row), node(column + 1, row)});
      if (row + 1 < side) a.springs.push_back({node(column, row), node(column, row + 1)});
      if (column + 1 < side && row + 1 < side)
        a.springs.push_back({node(column, row), node(column + 1, row + 1)});
    }
  }
  a.mass = Eigen::VectorXd::Constant(1, 0.01);        // [kg], of every node
  a.stiffness = Eigen::VectorXd::Constant(1, 1000.);  // [N/m], of every spring
  a.pinned = {node(0, 0), node(side - 1, 0)};
  a.gravity = Eigen::Vector3d(0, -9.81, 0);
  return a;
}

}  // namespace

int main() {
  const qddot::Scene scene = qddot::scene_of(cloth());
  const double until = 0.5;  // [s]
  const std::vector<double> times = qddot::samples(0.1, until);
  std::printf("%-22s", "energy [J] at t [s]:");
  for (const double t : times) std::printf(" %12.1f", t);
  std::printf("\n");
  for (const char* name : {"verlet", "semi_implicit_euler", "implicit_midpoint"}) {
    qddot::Simulation run(scene, qddot::method(name), {.step_size = 1e-3});
    std::printf("%-22s", name);
    const auto summary = run.advance(until, {times, [&](const qddot::State& state) {
                                               std::printf(" %12.8f", run.model().energy(state));
                                             }});
    std::printf("\n");
    if (summary.outcome != qddot::Outcome::reached_end) {
      std::printf("%s stopped at t = %g s: %s\n", name, summary.t_reached, summary.message.c_str());
      return 1;
    }
  }
}
