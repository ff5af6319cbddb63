#include "experiments/bench/peers.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::bench {
namespace {

std::vector<std::unique_ptr<Peer>> all_peers(const std::string& force_library, LeftOut& left_out) {
  std::vector<std::unique_ptr<Peer>> peers;
  peers.push_back(odeint_dopri5());
  peers.push_back(odeint_mclachlan());
  peers.push_back(arkode_erk4());
  for (const char* method : {"arkode_dirk4_klu", "arkode_dirk5_klu", "cvode_bdf_klu"}) {
    peers.push_back(stock_implicit(method));
  }
  if (has_scipy()) {
    for (const char* method : {"DOP853", "Radau", "BDF"}) {
      peers.push_back(scipy(method, force_library));
    }
  } else {
    left_out.add("SciPy is not there: apt-get install python3-scipy");
  }
  if (const std::string why = why_no_lammps(); why.empty()) {
    peers.push_back(lammps());
  } else {
    left_out.add(why);
  }
  if (auto peer = bullet()) {
    peers.push_back(std::move(peer));
  } else {
    left_out.add("Bullet was not there: apt-get install libbullet-dev, then build again");
  }
  return peers;
}

}  // namespace

std::vector<double> tolerances(int in_a_decade) {
  std::vector<double> values;
  for (int i = 2 * in_a_decade; i <= 13 * in_a_decade; ++i) {
    values.push_back(std::pow(10.0, -static_cast<double>(i) / in_a_decade));
  }
  return values;
}

std::vector<double> step_sizes(const Problem& problem, int in_a_decade, int decades) {
  const double w = frequency_bound(problem.scene.system(), problem.scene.initial().q);
  const double fewest = std::max(1.0, problem.until * w / 16);
  std::vector<double> values;
  for (int i = 0; i <= decades * in_a_decade; ++i) {
    const double steps = std::ceil(fewest * std::pow(10.0, static_cast<double>(i) / in_a_decade));
    values.push_back(problem.until / steps);
  }
  return values;
}

std::vector<std::string> explicit_methods() {
  std::vector<const Method*> list;
  for (const Method& method : methods()) {
    const bool is_ours = method.family == Family::hand_written && !method.is(Trait::implicit);
    const bool asks_for_more = method.asks(Need::stiffness) ||
                               method.asks(Need::constant_stiffness) ||
                               method.asks(Need::split_forces);
    if (is_ours && !asks_for_more && method.order > 1) list.push_back(&method);
  }
  std::ranges::stable_sort(list, std::greater(), &Method::order);
  std::vector<std::string> names;
  for (const Method* method : list) names.push_back(method->name);
  return names;
}

void LeftOut::add(const std::string& sentence) {
  fmt::print("{}\n", sentence);
  sentences_.push_back(sentence);
}

std::vector<std::unique_ptr<Peer>> selected_peers(const std::vector<std::string>& beginnings,
                                                  const std::string& force_library,
                                                  LeftOut& left_out) {
  auto peers = all_peers(force_library, left_out);
  if (beginnings.empty()) return peers;
  std::erase_if(peers, [&](const auto& peer) {
    return std::ranges::none_of(beginnings,
                                [&](const auto& word) { return peer->name().starts_with(word); });
  });
  return peers;
}

std::vector<Peer*> fitting(const std::vector<std::unique_ptr<Peer>>& peers, const Scene& scene,
                           LeftOut& left_out) {
  std::vector<Peer*> all;
  for (const auto& peer : peers) {
    if (const std::string why = peer->misfit(scene); why.empty()) {
      all.push_back(peer.get());
    } else {
      left_out.add(fmt::format("{}: {} is left out: {}", scene.name, peer->name(), why));
    }
  }
  return all;
}

}  // namespace qddot::bench
