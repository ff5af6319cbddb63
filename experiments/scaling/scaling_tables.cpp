#include "experiments/scaling/scaling_tables.hpp"

#include <fmt/format.h>

namespace qddot::scaling {
namespace {

void print(const std::vector<Exponent>& exponents) {
  fmt::print("\n{:<8} {:<20} {:<14} {:>8}   {:<14} {:>6}\n", "scene", "method", "phase", "exponent",
             "95 %", "theory");
  for (const Exponent& e : exponents) {
    fmt::print("{:<8} {:<20} {:<14} {:>8.2f}   {:.2f} to {:.2f}   {:>6.2f}\n", e.scene, e.method,
               e.phase, e.fit.exponent, e.fit.low, e.fit.high, e.theory);
  }
}

// f at each size, beside the peak of the machine [operations/s].
void print(const std::vector<ScalingSize>& sizes, double peak) {
  fmt::print("\nf: {:.3g} GFlop/s is the peak\n{:<8} {:>9} {:>12} {:>8} {:>8} {:>8}\n", 1e-9 * peak,
             "scene", "nodes", "M springs/s", "GB/s", "triad", "GFlop/s");
  for (const ScalingSize& size : sizes) {
    const auto& [seconds, bytes, flops] = size.force;
    fmt::print("{:<8} {:>9} {:>12.4g} {:>8.3g} {:>8.3g} {:>8.3g}\n", size.scene, size.nodes,
               1e-6 * size.springs / seconds, 1e-9 * bytes / seconds, 1e-9 * size.triad,
               1e-9 * flops / seconds);
  }
}

void print(const std::vector<LeftOut>& left_out) {
  for (const auto& [scene, method, nodes, why] : left_out) {
    fmt::print("left out: {}{}{} from {:.0f} nodes on: {}\n", scene, method.empty() ? "" : " with ",
               method, nodes, why);
  }
}

}  // namespace

void write_tables(const ScalingResults& results, double peak, CsvFile& costs, CsvFile& exponents,
                  CsvFile& roofline) {
  const auto fits = exponents_of(results.costs);
  for (const auto& [scene, nodes, springs, method, phase, seconds, bytes] : results.costs)
    costs.row(scene, nodes, springs, method, phase, seconds, bytes);
  for (const Exponent& e : fits) {
    exponents.row(e.scene, e.method, e.phase, e.fit.exponent, e.fit.low, e.fit.high, e.theory,
                  e.nodes_from, e.nodes_to);
  }
  for (const ScalingSize& size : results.sizes) {
    const auto& [seconds, bytes, flops] = size.force;
    roofline.row(size.scene, size.nodes, size.springs, seconds, size.springs / seconds,
                 bytes / size.springs, flops / size.springs, bytes, size.triad, peak);
  }
  print(fits);
  print(results.sizes, peak);
  print(results.left_out);
}

}  // namespace qddot::scaling
