#include "experiments/kit/catalogue.hpp"

#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/csv.hpp"
#include "qddot/integrators/registry.hpp"
#include "qddot/scene/generators.hpp"

namespace qddot::inline kit {
namespace {

const char* yes(bool holds) { return holds ? "yes" : "no"; }

}  // namespace

std::string method_names() {
  return names_where([](const Method&) { return true; });
}

std::string names_where(const std::function<bool(const Method&)>& has) {
  std::vector<std::string> names;
  for (const Method& method : methods()) {
    if (has(method)) names.push_back(method.name);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

void print_methods(bool as_csv) {
  if (as_csv) {
    Csv csv({"name", "order", "family", "knob", "implicit", "symplectic", "needs_stiffness",
             "accepts_massless", "needs_constant_stiffness", "needs_split", "needs_laplacian",
             "takes_iterations", "summary", "source", "stock_of"});
    for (const Method& m : methods()) {
      csv.row(m.name, m.order, family_name(m.family), knob_name(m.knob), yes(m.is(Trait::implicit)),
              yes(m.is(Trait::symplectic)),
              yes(m.asks(Need::stiffness) || m.is(Trait::bounds_steps)),
              yes(m.is(Trait::accepts_massless)), yes(m.asks(Need::constant_stiffness)),
              yes(m.asks(Need::split_forces)), yes(m.asks(Need::laplacian)),
              yes(m.listens_to(Option::iterations)), m.summary, m.source, m.stock_of);
    }
    fmt::print("{}", csv.text());
    return;
  }
  fmt::print("{:<24} {:>5}  {:<12} {:<9}  {}\n", "name", "order", "family", "knob", "what it is");
  for (const Method& m : methods()) {
    fmt::print("{:<24} {:>5}  {:<12} {:<9}  {}\n", m.name, m.order, family_name(m.family),
               knob_name(m.knob), m.summary);
  }
}

void print_generators(bool as_csv) {
  if (as_csv) {
    Csv csv({"scene", "parameter", "standard", "low", "high", "meaning", "summary"});
    for (const Generator& g : generators()) {
      for (const GeneratorParameter& p : g.parameters) {
        csv.row(g.name, p.name, p.standard, p.low, p.high, p.meaning, g.summary);
      }
    }
    fmt::print("{}", csv.text());
    return;
  }
  for (const Generator& g : generators()) {
    fmt::print("{:<12} {}\n", g.name, g.summary);
    for (const GeneratorParameter& p : g.parameters) {
      fmt::print("  {:<22} {:>8}  {}\n", p.name, p.standard, p.meaning);
    }
  }
}

}  // namespace qddot::inline kit
