#include "qddot/scene/reduce/reduced_scene.hpp"

#include "qddot/scene/reduce/reduced.hpp"

namespace qddot {

ReducedScene::ReducedScene(const Scene& scene, const Reductions& reductions)
    : reduced_(std::make_unique<reduce::Reduced>(scene, reductions)) {}

ReducedScene::ReducedScene(std::shared_ptr<const System> system, State initial, int dimension)
    : reduced_(
          std::make_unique<reduce::Reduced>(std::move(system), std::move(initial), dimension)) {}

ReducedScene::~ReducedScene() = default;
ReducedScene::ReducedScene(ReducedScene&&) noexcept = default;
ReducedScene& ReducedScene::operator=(ReducedScene&&) noexcept = default;

const System& ReducedScene::system() const { return reduced_->system(); }
const State& ReducedScene::initial() const { return reduced_->initial(); }
int ReducedScene::dimension() const { return reduced_->dimension(); }
std::vector<Node> ReducedScene::expand(const State& state) const {
  std::vector<Node> nodes;
  expand(state, nodes);
  return nodes;
}
void ReducedScene::expand(const State& state, std::vector<Node>& nodes) const {
  reduced_->expand(state, true, nodes);
}
std::vector<Node> ReducedScene::expand_beside_falls(const State& state) const {
  std::vector<Node> nodes;
  reduced_->expand(state, false, nodes);
  return nodes;
}
std::vector<double> ReducedScene::largest_by_part(const Vec& x) const {
  return reduced_->largest_by_part(x);
}
double ReducedScene::kinetic(const State& state) const { return reduced_->kinetic(state); }
double ReducedScene::potential(const State& state) const { return reduced_->potential(state); }
double ReducedScene::energy(const State& state) const { return reduced_->energy(state); }
std::vector<std::size_t> ReducedScene::massless_nodes() const { return reduced_->massless_nodes(); }
const std::vector<Finding>& ReducedScene::findings() const { return reduced_->findings(); }
const std::vector<reduce::Part>& ReducedScene::parts() const { return reduced_->parts(); }
std::vector<std::vector<std::size_t>> ReducedScene::nodes_by_part() const {
  return reduced_->nodes_by_part();
}
std::vector<Index> ReducedScene::unknowns_by_part() const { return reduced_->unknowns_by_part(); }

}  // namespace qddot
