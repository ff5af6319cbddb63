#pragma once

#include <memory>

#include "tests/integrators/runs.hpp"

namespace qddot {
inline namespace tests {

// Passes calls on to another split system, and lets a test see or change the results of its halves.
// Calls of the stiff block go to the stiff half.
class SplitRelay final : public System,
                         public SplitStiffness,
                         public DiscreteGradient,
                         public Laplacian,
                         public SplitForces {
 public:
  explicit SplitRelay(const System& system)
      : System(system.mass()),
        stiff(std::make_shared<Relay>(*split_of(system)->stiff)),
        soft(std::make_shared<Relay>(*split_of(system)->soft)),
        whole(system),
        block_(std::make_shared<Relay>(*split_of(system)->stiff_block)),
        split_{stiff, soft, block_, split_of(system)->stiff_unknowns} {
    block_->after_force = [this](const ConstVec& q, MutableVec f) {
      if (stiff->after_force) stiff->after_force(q, f);
    };
    block_->after_stiffness = [this](const Vec& q, SymmetricMatrix& k) {
      if (stiff->after_stiffness) stiff->after_stiffness(q, k);
    };
  }

  double potential(const ConstVec& q) const override { return whole.potential(q); }
  void force(const ConstVec& q, MutableVec f) const override { whole.force(q, f); }
  void stiffness(const ConstVec& q, SymmetricMatrix& k) const override { whole.stiffness(q, k); }
  const SymmetricMatrix& stiffness_pattern() const override { return whole.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return whole.stiffness_is_constant(); }
  bool offers(const std::type_info& type) const override {
    return type == typeid(SplitForces) || whole.offers(type);
  }

  void weighted_stiffness(const ConstVec& q, double compression_weight,
                          SymmetricMatrix& k) const override {
    whole.weighted_stiffness(q, compression_weight, k);
  }
  void material_stiffness(const ConstVec& q, SymmetricMatrix& k) const override {
    whole.material_stiffness(q, k);
  }
  void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) const override {
    whole.discrete_gradient(a, b, f);
  }
  void laplacian(SymmetricMatrix& l) const override { whole.laplacian(l); }
  bool bounds_stiffness() const override { return whole.bounds_stiffness(); }
  const Split& split() const override { return split_; }

  const std::shared_ptr<Relay> stiff, soft;
  Relay whole;

 private:
  const std::shared_ptr<Relay> block_;
  Split split_;
};

// The numbers of evaluations of forces and stiffnesses, of both halves and of the whole.
struct Asked {
  std::int64_t stiff_force = 0, soft_force = 0, whole_force = 0;
  std::int64_t stiff_stiffness = 0, soft_stiffness = 0, whole_stiffness = 0;
};

// Counts from now on what the relay is asked for; `asked` must live as long as it.
inline void count_into(Asked& asked, SplitRelay& relay) {
  const auto count = [](Relay& half, std::int64_t& forces, std::int64_t& stiffnesses) {
    half.after_force = [&forces](const ConstVec&, MutableVec) { ++forces; };
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
    if (method.asks(Need::split_forces) && method.knob == knob) list.push_back(method);
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

}  // namespace tests
}  // namespace qddot
