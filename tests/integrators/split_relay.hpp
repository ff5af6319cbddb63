#pragma once

#include <memory>

#include "tests/integrators/runs.hpp"

namespace qddot {

// Speaks for another split system, and lets a test see or change what its halves say; what is asked
// of the core is asked of the stiff half.
class SplitRelay final : public System {
 public:
  explicit SplitRelay(const System& system)
      : System(system.mass()),
        stiff(std::make_shared<Relay>(*system.split()->stiff)),
        soft(std::make_shared<Relay>(*system.split()->soft)),
        whole(system),
        core_(std::make_shared<Relay>(*system.split()->core)),
        split_{stiff, soft, core_, system.split()->core_unknowns} {
    core_->after_force = [this](const Vec& q, Vec& f) {
      if (stiff->after_force) stiff->after_force(q, f);
    };
    core_->after_stiffness = [this](const Vec& q, SymmetricMatrix& k) {
      if (stiff->after_stiffness) stiff->after_stiffness(q, k);
    };
  }

  double potential(const Vec& q) const override { return whole.potential(q); }
  void force(const Vec& q, Vec& f) const override { whole.force(q, f); }
  void stiffness(const Vec& q, SymmetricMatrix& k) const override { whole.stiffness(q, k); }
  void softened_stiffness(const Vec& q, double compression, SymmetricMatrix& k) const override {
    whole.softened_stiffness(q, compression, k);
  }
  void mean_force(const Vec& a, const Vec& b, Vec& f) const override { whole.mean_force(a, b, f); }
  void material_stiffness(const Vec& q, SymmetricMatrix& k) const override {
    whole.material_stiffness(q, k);
  }
  const SymmetricMatrix& stiffness_pattern() const override { return whole.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return whole.stiffness_is_constant(); }
  HasLaplacian has_laplacian() const override { return whole.has_laplacian(); }
  void laplacian(SymmetricMatrix& l) const override { whole.laplacian(l); }
  const Split* split() const override { return &split_; }

  const std::shared_ptr<Relay> stiff, soft;
  Relay whole;

 private:
  const std::shared_ptr<Relay> core_;
  Split split_;
};

// How often the two halves and the whole were asked for forces and stiffnesses.
struct Asked {
  std::int64_t stiff_force = 0, soft_force = 0, whole_force = 0;
  std::int64_t stiff_stiffness = 0, soft_stiffness = 0, whole_stiffness = 0;
};

// Counts from now on what the relay is asked for; `asked` must live as long as it.
inline void count_into(Asked& asked, SplitRelay& relay) {
  const auto count = [](Relay& half, std::int64_t& forces, std::int64_t& stiffnesses) {
    half.after_force = [&forces](const Vec&, Vec&) { ++forces; };
    half.after_stiffness = [&stiffnesses](const Vec&, SymmetricMatrix&) { ++stiffnesses; };
  };
  count(*relay.stiff, asked.stiff_force, asked.stiff_stiffness);
  count(*relay.soft, asked.soft_force, asked.soft_stiffness);
  count(relay.whole, asked.whole_force, asked.whole_stiffness);
}

// The methods that take stiff forces apart, of one knob.
inline std::vector<Method> split_methods_of(Knob knob) {
  std::vector<Method> list;
  for (const Method& method : methods()) {
    if (method.needs_split && method.knob == knob) list.push_back(method);
  }
  return list;
}

// The network with every spring named stiff, or none.
inline Network with_all_named(Network network, bool stiff) {
  for (auto& link : network.links) link.stiff = stiff;
  for (auto& anchor : network.anchors) anchor.stiff = stiff;
  network.offers_split = true;
  return network;
}

}  // namespace qddot
