#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include <fmt/format.h>

#include "experiments/advice/drawn_case.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/measure/advice/search.hpp"
#include "qddot/measure/motion/timing.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "qddot/measure/speed/measurement.hpp"
int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::measure;
  const bool verbose = argc > 2 && std::string(argv[2]) == "v";
  std::ifstream in(argv[1]);
  std::string l;
  std::map<int, std::vector<std::string>> best;
  while (std::getline(in, l)) {
    std::vector<std::string> f;
    std::stringstream s(l);
    std::string x;
    while (std::getline(s, x, ',')) f.push_back(x);
    if (!f.empty() && f[0] == "B" && f.size() > 14) best[std::stoi(f[1])] = f;
  }
  for (auto& [seed, f] : best) {
    if (argc > 3 && seed != std::atoi(argv[3])) continue;
    const auto c = advice_study::drawn_case(seed);
    const ReducedScene model(c.scene);
    const double A = c.accuracy, bt0 = std::stod(f[7]);
    double bt = bt0;
    if (f[5] != "reached_end" || model.system().size() == 0) continue;
    const auto begin = std::chrono::steady_clock::now();
    Search search(model, c.until, AccuracyOf::positions, 100);
    const Trial* t = nullptr;
    double ts = 0;
    if (search.survey()) {
      ts = seconds_since(begin);
      t = search.find(A);
      t = search.race(t, A, std::max(0.01, 0.2 * (t ? t->seconds : 0)));
    }
    const double total = seconds_since(begin);
    double te = -1, cert = 0, mt = 0;
    if (t) {
      try {
        const Reference r = make_reference(model, c.until, 3);
        te = errors_between(model, t->path.back(), r.end, r.energy, r.scales).position;
        cert = r.certified.position;
        mt = measure_point(*t->method, t->value, model, c.until, r, {.repeats = 3}).time_min;
        bt = measure_point(*find_method(f[3]), std::stod(f[4]), model, c.until, r, {.repeats = 3})
                 .time_min;
      } catch (const std::exception&) {
      }
    }
    fmt::print(
        "{} {} n={} A={:.1e} best {} {:.3g}s steps {} | {} {:.3g}s e={:.2e} true={:.2e} bar={:.2e} "
        "cert={:.0e} | choice {:.2f} total {:.2f} survey {:.2f} runs {}\n",
        seed, c.kind, model.system().size(), A, f[3], bt, f[9], t ? t->method->name : "NONE",
        t ? t->seconds : 0, t ? search.error(*t) : 0, te, t ? *search.bound(*t) : 0, cert, mt / bt,
        total / bt, ts / bt, search.trials().size());
    if (verbose) {
      double sum = 0;
      for (const Trial& x : search.trials()) sum += x.seconds;
      fmt::print("   total {:.4g} in runs {:.4g} survey beside its run {:.4g}\n", total, sum,
                 ts - search.trials().front().seconds);
      if (search.trials().size() && search.trials().front().reached_end() && search.forecast()) {
        const auto& own = search.forecast()->own();
        fmt::print("   w {:.4g} -> {:.4g}; own/w", search.w_start(), search.forecast()->w_motion());
        for (int p = 2; p <= 10; p += 2) fmt::print(" {:.3g}", own.at(p) / search.w_start());
        fmt::print(" speed*T {:.3g}\n", own.speed * c.until);
      }
      for (const Trial& x : search.trials()) {
        fmt::print("   {} {:.4g} N={:.0f} {} {:.3g}s", x.method->name, x.value, c.until / x.value,
                   name(x.summary.outcome), x.seconds);
        if (x.reached_end())
          fmt::print(" expected {:.2e} error {:.2e}",
                     (search.forecast() ? search.forecast()->error(*x.method, x.value) : 0.),
                     search.error(x)),
              fmt::print(" surprise {} {:.2f}", x.method->order,
                         std::log10(search.error(x) / std::max(x.expected, 1e-16)));
        fmt::print("\n");
      }
    }
    std::fflush(stdout);
  }
}
