#include "experiments/scaling/scaling_tables.hpp"

#include <fmt/format.h>

namespace qddot::scaling {

Columns<PhaseCost> cost_columns() {
  return {{"scene", &PhaseCost::scene},     {"nodes", &PhaseCost::nodes},
          {"springs", &PhaseCost::springs}, {"method", &PhaseCost::method},
          {"phase", &PhaseCost::phase},     {"seconds", &PhaseCost::seconds},
          {"bytes", &PhaseCost::bytes}};
}

Columns<Exponent> exponent_columns() {
  return {{"scene", &Exponent::scene},
          {"method", &Exponent::method},
          {"phase", &Exponent::phase},
          {"exponent", [](const Exponent& e) { return e.fit.exponent; }},
          {"low", [](const Exponent& e) { return e.fit.low; }},
          {"high", [](const Exponent& e) { return e.fit.high; }},
          {"theory", &Exponent::theory},
          {"nodes_from", &Exponent::nodes_from},
          {"nodes_to", &Exponent::nodes_to}};
}

Columns<RooflineRow> roofline_columns() {
  using Row = const RooflineRow&;
  return {{"scene", [](Row r) { return r.size.scene; }},
          {"nodes", [](Row r) { return r.size.nodes; }},
          {"springs", [](Row r) { return r.size.springs; }},
          {"seconds", [](Row r) { return r.size.force.seconds; }},
          {"springs_per_second", [](Row r) { return r.size.springs / r.size.force.seconds; }},
          {"bytes_per_spring", [](Row r) { return r.size.force.bytes / r.size.springs; }},
          {"flops_per_spring", [](Row r) { return r.size.force.flops / r.size.springs; }},
          {"working_set_bytes", [](Row r) { return r.size.force.bytes; }},
          {"triad_bytes_per_second", [](Row r) { return r.size.triad; }},
          {"peak_flops_per_second", &RooflineRow::peak}};
}

void print(const std::vector<Exponent>& exponents) {
  fmt::print("\n{:<8} {:<20} {:<14} {:>8}   {:<14} {:>6}\n", "scene", "method", "phase", "exponent",
             "95 %", "theory");
  for (const Exponent& e : exponents) {
    fmt::print("{:<8} {:<20} {:<14} {:>8.2f}   {:.2f} to {:.2f}   {:>6.2f}\n", e.scene, e.method,
               e.phase, e.fit.exponent, e.fit.low, e.fit.high, e.theory);
  }
}

void print(const std::vector<RooflineRow>& roofline, double peak) {
  fmt::print("\nf: {:.3g} GFlop/s is the peak\n{:<8} {:>9} {:>12} {:>8} {:>8} {:>8}\n", 1e-9 * peak,
             "scene", "nodes", "M springs/s", "GB/s", "triad", "GFlop/s");
  for (const RooflineRow& row : roofline) {
    const ScalingSize& size = row.size;
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

}  // namespace qddot::scaling
