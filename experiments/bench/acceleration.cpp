#include "experiments/bench/acceleration.hpp"

#include "qddot/model/capabilities.hpp"

namespace qddot::bench {
namespace {

constexpr int pinned = -1;

// It has the two capabilities of the system that its implicit methods use.
class WithPlainForce final : public System, public SplitStiffness, public DiscreteGradient {
 public:
  WithPlainForce(const System& system, const PlainForce& plain)
      : System(system.mass()),
        system_(system),
        split_stiffness_(capability<SplitStiffness>(system)),
        discrete_gradient_(capability<DiscreteGradient>(system)),
        plain_(plain) {}

  void force(const ConstVec& q, MutableVec f) const override { plain_.force(q.data(), f.data()); }

  double potential(const ConstVec& q) const override { return system_.potential(q); }
  void stiffness(const ConstVec& q, SymmetricMatrix& k) const override { system_.stiffness(q, k); }
  const SymmetricMatrix& stiffness_pattern() const override { return system_.stiffness_pattern(); }
  bool stiffness_is_constant() const override { return system_.stiffness_is_constant(); }
  bool offers(const std::type_info& type) const override {
    return type == typeid(SplitStiffness) ? split_stiffness_ != nullptr
                                          : discrete_gradient_ != nullptr;
  }

  void material_stiffness(const ConstVec& q, SymmetricMatrix& k) const override {
    split_stiffness_->material_stiffness(q, k);
  }
  void weighted_stiffness(const ConstVec& q, double compression_weight,
                          SymmetricMatrix& k) const override {
    split_stiffness_->weighted_stiffness(q, compression_weight, k);
  }
  void discrete_gradient(const ConstVec& a, const ConstVec& b, MutableVec f) const override {
    discrete_gradient_->discrete_gradient(a, b, f);
  }

 private:
  const System& system_;
  const SplitStiffness* split_stiffness_;
  const DiscreteGradient* discrete_gradient_;
  const PlainForce& plain_;
};

}  // namespace

PlainForce::PlainForce(const Scene& scene) : dimension_(scene.dimension), gravity_(scene.gravity) {
  std::vector<int> place(scene.nodes.size(), pinned);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    if (scene.nodes[i].pinned) continue;
    place[i] = static_cast<int>(mass_.size());
    mass_.push_back(scene.nodes[i].mass);
  }
  for (const Spring& spring : scene.springs) {
    const auto [a, b] = spring.nodes;
    if (place[a] != pinned && place[b] != pinned) {
      links_.push_back({place[a], place[b], spring.law});
    } else if (place[a] != pinned) {
      anchors_.push_back({place[a], scene.nodes[b].position, spring.law});
    } else if (place[b] != pinned) {
      anchors_.push_back({place[b], scene.nodes[a].position, spring.law});
    }
  }
}

template <int D>
void PlainForce::sum(const double* q, double* f) const {
  using Vector = Eigen::Matrix<double, D, 1>;
  const auto x = [q](int i) { return Eigen::Map<const Vector>(q + D * i); };
  const auto at = [f](int i) { return Eigen::Map<Vector>(f + D * i); };
  const Vector gravity = gravity_.head<D>();
  for (std::size_t i = 0; i < mass_.size(); ++i) at(static_cast<int>(i)) = mass_[i] * gravity;
  for (const Link& link : links_) {
    const Vector d = x(link.j) - x(link.i);
    const double l = d.norm();
    const Vector pull = l > 0 ? Vector(link.law.tension(l) / l * d) : Vector(Vector::Zero());
    at(link.i) += pull;
    at(link.j) -= pull;
  }
  for (const Anchor& anchor : anchors_) {
    const Vector d = anchor.point.head<D>() - x(anchor.i);
    const double l = d.norm();
    if (l > 0) at(anchor.i) += anchor.law.tension(l) / l * d;
  }
}

void PlainForce::force(const double* q, double* f) const {
  dimension_ == 1 ? sum<1>(q, f) : dimension_ == 2 ? sum<2>(q, f) : sum<3>(q, f);
}

void PlainForce::acceleration(const double* q, double* a) const {
  force(q, a);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    for (int d = 0; d < dimension_; ++d) *a++ /= mass_[i];
  }
}

Acceleration::Acceleration(const Scene& start, const System& system, ForceKind kind)
    : plain_(start),
      system_(system),
      kind_(kind),
      per_mass_(system.mass().cwiseInverse()),
      q_(system.size()),
      f_(system.size()) {}

void Acceleration::operator()(const double* q, double* a) {
  ++evaluations_;
  if (kind_ == ForceKind::plain) {
    plain_.acceleration(q, a);
    return;
  }
  q_ = Vec::Map(q, q_.size());
  system_.force(q_, f_);
  Vec::Map(a, f_.size()) = per_mass_.cwiseProduct(f_);
}

std::unique_ptr<System> with_plain_force(const System& system, const PlainForce& plain) {
  return std::make_unique<WithPlainForce>(system, plain);
}

}  // namespace qddot::bench
