#include <cstdio>
#include <qddot/qddot.hpp>

int main() {
  const qddot::Scene cloth = qddot::load_scene("cloth");  // a generator, or a file of your own
  qddot::Simulation run(cloth, qddot::method("blanes_moan4"), {.step_size = 1e-3});
  const qddot::Summary summary = run.advance(0.1);  // to t = 0.1 s; run.nodes(), run.energy()
  const qddot::Answer sure = qddot::solve(cloth, 0.1, 1e-4);  // an accuracy in place of a method
  std::printf("t = %g s; then %s, off by at most %.0e\n", summary.t_reached,
              sure.method->name.c_str(), sure.error_estimate);
}
