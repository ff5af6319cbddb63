#pragma once

#include <type_traits>
#include <vector>

#include "qddot/model/layout.hpp"
#include "qddot/model/mass_spring.hpp"
#include "qddot/model/spring.hpp"

namespace qddot {

// The springs of a network in lists, and the sum over them that gives the force. Most springs join
// nodes whose coordinates are all unknowns; they store the first unknowns of their ends. The few
// others use the layout.
template <int D>
class SpringLists {
 public:
  using Point = Eigen::Matrix<double, D, 1>;

  // i, j: first unknowns; j may be i for an image link.
  struct Link {
    int i, j;
    PlainLaw law;
  };
  struct Image {
    int i, j;
    Point mirror;
    PlainLaw law;
  };
  struct Anchor {
    int i;
    Point point;
    PlainLaw law;
    int curve;
  };
  // i, j: nodes.
  struct EdgeLink {
    int i, j;
    Point mirror;
    PlainLaw law;
  };
  struct EdgeAnchor {
    int i;
    Point point;
    PlainLaw law;
    int curve;
  };
  // A spring that is not plain, between nodes, or to a point where j < 0. `number`: of its phase.
  struct General {
    int i, j;
    Point point;
    SpringLaw law;
    int curve, number;
  };
  // Positions, and how far moving points are displaced: by one vector for each curve of the
  // network. Or velocities of both. `phases`: see At.
  struct Moved {
    VecView q;
    const std::vector<Point>& curves;
    const Phase* phases = nullptr;

    Point of(int curve) const { return curve < 0 ? Point(Point::Zero()) : curves[curve]; }
  };

  // Keeps a reference to the layout, which must outlive it.
  SpringLists(const Network& network, const Layout<D>& layout) : layout_(layout) {
    links_.reserve(network.links.size());
    for (const auto& link : network.links) {
      take({link.i, link.j, Point::Ones(), link.law.plain()}, true);
    }
    for (const auto& link : network.image_links) {
      take({link.i, link.j, Eigen::Map<const Point>(link.mirror.data()), link.law.plain()}, false);
    }
    for (const auto& anchor : network.anchors) {
      const Point point = Eigen::Map<const Point>(anchor.point.data());
      if (layout_.is_full(anchor.i)) {
        anchors_.push_back({layout_.first(anchor.i), point, anchor.law.plain(), anchor.curve});
      } else {
        edge_anchors_.push_back({anchor.i, point, anchor.law.plain(), anchor.curve});
      }
    }
    for (const auto& spring : network.general) {
      const Point point = spring.point.head<D>();
      general_.push_back({spring.i, spring.j, point, spring.law, spring.curve, spring.number});
      continued_.push_back(general_.back());
      continued_.back().law.pulls_only = false;
    }
  }

  const std::vector<Link>& links() const { return links_; }
  const std::vector<Image>& images() const { return images_; }
  const std::vector<EdgeLink>& edge_links() const { return edge_links_; }

  const std::vector<General>& general() const { return general_; }

  // Calls see(spring) for each spring that is in the network in these phases, list by list.
  template <class See>
  [[gnu::always_inline]] void for_each(const Phase* phases, const See& see) const {
    for (const Link& link : links_) see(link);
    for (const Image& image : images_) see(image);
    for (const Anchor& anchor : anchors_) see(anchor);
    for (const EdgeLink& link : edge_links_) see(link);
    for (const EdgeAnchor& anchor : edge_anchors_) see(anchor);
    if (!general_.empty()) for_each_general(phases, see);
  }
  // The same for those alone that are not plain.
  template <class See>
  void for_each_general(const Phase* phases, const See& see) const {
    for (std::size_t e = 0; e < general_.size(); ++e) {
      const Phase phase = phases ? phases[general_[e].number] : Phase::by_length;
      if (phase == Phase::by_length) see(general_[e]);
      if (phase == Phase::taut) see(continued_[e]);
    }
  }
  // The same as if all of them pulled at any length.
  template <class See>
  void for_each_taut(const See& see) const {
    for (const General& spring : continued_) see(spring);
  }

  // d from a spring's end i to its end j: diag(mirror) x_j - x_i or point - x_i.
  Point between(const Moved& at, const Link& link) const {
    return at.q.template segment<D>(link.j) - at.q.template segment<D>(link.i);
  }
  Point between(const Moved& at, const Image& image) const {
    return image.mirror.cwiseProduct(at.q.template segment<D>(image.j)) -
           at.q.template segment<D>(image.i);
  }
  Point between(const Moved& at, const Anchor& anchor) const {
    if (anchor.curve < 0) return anchor.point - at.q.template segment<D>(anchor.i);
    return anchor.point + at.of(anchor.curve) - at.q.template segment<D>(anchor.i);
  }
  Point between(const Moved& at, const EdgeLink& link) const {
    return link.mirror.cwiseProduct(layout_.at(at.q, link.j)) - layout_.at(at.q, link.i);
  }
  Point between(const Moved& at, const EdgeAnchor& anchor) const {
    return anchor.point + at.of(anchor.curve) - layout_.at(at.q, anchor.i);
  }

  Point between(const Moved& at, const General& spring) const {
    const Point far =
        spring.j < 0 ? Point(spring.point + at.of(spring.curve)) : layout_.at(at.q, spring.j);
    return far - layout_.at(at.q, spring.i);
  }

  // The rate of change of d at these velocities.
  template <class Spring>
  Point apart(const Moved& v, const Spring& spring) const {
    if constexpr (std::is_same_v<Spring, Anchor>) {
      if (spring.curve < 0) return -v.q.template segment<D>(spring.i);
      return v.of(spring.curve) - v.q.template segment<D>(spring.i);
    }
    if constexpr (std::is_same_v<Spring, EdgeAnchor>) {
      return v.of(spring.curve) - layout_.at(v.q, spring.i);
    }
    if constexpr (std::is_same_v<Spring, General>) {
      const Point far = spring.j < 0 ? v.of(spring.curve) : layout_.at(v.q, spring.j);
      return far - layout_.at(v.q, spring.i);
    }
    return between(v, spring);
  }

  // Adds each spring's force on_i(spring) to its end i in f, and the opposite force to its end j.
  template <class OnI>
  [[gnu::always_inline]] void add_forces(const Phase* phases, const OnI& on_i, MutableVec f) const {
    for_each(
        phases, [&](const auto& spring)
                    __attribute__((always_inline)) { add_force(spring, on_i(spring), f); });
  }
  template <class OnI>
  void add_general_forces(const Phase* phases, const OnI& on_i, MutableVec f) const {
    for_each_general(phases, [&](const General& spring) { add_force(spring, on_i(spring), f); });
  }

 private:
  void take(const EdgeLink& link, bool is_plain) {
    if (!layout_.is_full(link.i) || !layout_.is_full(link.j)) {
      edge_links_.push_back(link);
    } else if (is_plain) {
      links_.push_back({layout_.first(link.i), layout_.first(link.j), link.law});
    } else {
      images_.push_back({layout_.first(link.i), layout_.first(link.j), link.mirror, link.law});
    }
  }

  static void add_force(const Link& link, const Point& force, MutableVec f) {
    f.segment<D>(link.i) += force;
    f.segment<D>(link.j) -= force;
  }
  static void add_force(const Image& image, const Point& force, MutableVec f) {
    f.segment<D>(image.i) += force;
    f.segment<D>(image.j) -= image.mirror.cwiseProduct(force);
  }
  static void add_force(const Anchor& anchor, const Point& force, MutableVec f) {
    f.segment<D>(anchor.i) += force;
  }
  void add_force(const EdgeLink& link, const Point& force, MutableVec f) const {
    layout_.add(force, link.i, f);
    layout_.add(-link.mirror.cwiseProduct(force), link.j, f);
  }
  void add_force(const EdgeAnchor& anchor, const Point& force, MutableVec f) const {
    layout_.add(force, anchor.i, f);
  }

  void add_force(const General& spring, const Point& force, MutableVec f) const {
    layout_.add(force, spring.i, f);
    if (spring.j >= 0) layout_.add(-force, spring.j, f);
  }

  const Layout<D>& layout_;
  std::vector<Link> links_;
  std::vector<Image> images_;
  std::vector<Anchor> anchors_;
  std::vector<EdgeLink> edge_links_;  // with an end that has fewer unknowns
  std::vector<EdgeAnchor> edge_anchors_;
  // The springs that are not plain, and the same with laws that are continued below rest lengths.
  std::vector<General> general_, continued_;
};

}  // namespace qddot
