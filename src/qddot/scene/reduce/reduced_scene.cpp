#include "qddot/scene/reduce/reduced_scene.hpp"

#include "qddot/scene/reduce/as_given.hpp"
#include "qddot/scene/reduce/reduced.hpp"

namespace qddot {

ReducedScene::ReducedScene(const Scene& scene, const Reductions& reductions)
    : way_back_(std::make_unique<reduce::Reduced>(scene, reductions)) {}

ReducedScene::ReducedScene(std::shared_ptr<const System> system, State initial, int dimension)
    : way_back_(
          std::make_unique<reduce::AsGiven>(std::move(system), std::move(initial), dimension)) {}

ReducedScene::~ReducedScene() = default;
ReducedScene::ReducedScene(ReducedScene&&) noexcept = default;
ReducedScene& ReducedScene::operator=(ReducedScene&&) noexcept = default;

const System& ReducedScene::system() const { return way_back_->system(); }
const State& ReducedScene::initial() const { return way_back_->initial(); }
int ReducedScene::dimension() const { return way_back_->dimension(); }
std::vector<Node> ReducedScene::expand(const State& state) const {
  std::vector<Node> nodes;
  expand(state, nodes);
  return nodes;
}
void ReducedScene::expand(const State& state, std::vector<Node>& nodes) const {
  way_back_->expand(state, true, nodes);
}
std::vector<Node> ReducedScene::expand_beside_falls(const State& state) const {
  std::vector<Node> nodes;
  way_back_->expand(state, false, nodes);
  return nodes;
}
double ReducedScene::kinetic(const State& state) const { return way_back_->kinetic(state); }
double ReducedScene::potential(const State& state) const { return way_back_->potential(state); }
double ReducedScene::energy(const State& state) const { return way_back_->energy(state); }
std::vector<std::size_t> ReducedScene::massless_nodes() const {
  return way_back_->massless_nodes();
}
const std::vector<Finding>& ReducedScene::findings() const { return way_back_->findings(); }
const std::vector<reduce::Part>& ReducedScene::parts() const { return way_back_->parts(); }
std::vector<std::vector<std::size_t>> ReducedScene::nodes_by_part() const {
  return way_back_->nodes_by_part();
}
std::vector<Index> ReducedScene::unknowns_by_part() const { return way_back_->unknowns_by_part(); }

}  // namespace qddot
