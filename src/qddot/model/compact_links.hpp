#pragma once

#include <utility>
#include <vector>

#include "qddot/model/mass_spring.hpp"
#include "qddot/model/repeated_values.hpp"

namespace qddot {

// The ends and laws of a network's links in little memory: 12 bytes a link in place of 80, and each
// law once that was seen shortly before.
class CompactLinks {
 public:
  CompactLinks() = default;
  explicit CompactLinks(const std::vector<Network::Link>& links) {
    ends_.reserve(links.size());
    for (const auto& link : links)
      ends_.push_back({link.i, link.j, laws_.number(link.law.plain())});
  }

  // Calls see(i, j, law) for each link.
  template <class See>
  void for_each(const See& see) const {
    for (const auto& [i, j, law] : ends_) see(i, j, laws_[law]);
  }

  // The links again; nothing else of them was kept.
  std::vector<Network::Link> links() const {
    std::vector<Network::Link> links;
    links.reserve(ends_.size());
    for_each([&](int i, int j, const PlainLaw& law) {
      links.push_back({i, j, {law.stiffness, law.rest_length, law.quartic, law.damping}});
    });
    return links;
  }

 private:
  struct Ends {
    int i, j, law;
  };

  std::vector<Ends> ends_;
  RepeatedValues<PlainLaw> laws_;
};

}  // namespace qddot
