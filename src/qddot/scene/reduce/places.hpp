#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

namespace qddot::reduce {

// Finds points [m] by their place, up to a tolerance. They are ordered along a direction in which
// the nodes of a regular grid have different places. Buckets of equal width make and search that
// order in linear time, unless most points are in few of them.
class Places {
 public:
  // Keeps a reference to the points.
  explicit Places(const std::vector<Eigen::Vector3d>& x);

  // Whether two points are no farther apart than `tolerance`.
  bool any_shared(double tolerance) const;

  // The first point in that order within `tolerance` of a place that `fits`, or -1.
  template <class Fits>
  int find(const Eigen::Vector3d& place, double tolerance, const Fits& fits) const {
    // Points are no farther apart along a unit vector than in space.
    const double low = key(place) - 2 * tolerance, high = low + 4 * tolerance;
    for (std::size_t at = first_from(low); at < order_.size() && order_[at].key <= high; ++at) {
      const int point = order_[at].point;
      if ((x_[static_cast<std::size_t>(point)] - place).norm() <= tolerance && fits(point))
        return point;
    }
    return -1;
  }

 private:
  struct Entry {
    double key;
    int point;
  };

  static double key(const Eigen::Vector3d& x) {
    return x.dot(Eigen::Vector3d(0.52573111211913361, 0.64018438963104533, 0.56025190285797853));
  }
  // The bucket of a key, not below that of any smaller key.
  std::size_t bucket(double key) const {
    const double at = (key - low_) * buckets_a_metre_;
    return at > 0 ? static_cast<std::size_t>(std::min(at, last_bucket_)) : 0;
  }
  // The place in the order of the first key that is not below `low`.
  std::size_t first_from(double low) const {
    const std::size_t own = bucket(low);
    const auto begin = order_.begin() + begin_[own], end = order_.begin() + begin_[own + 1];
    return static_cast<std::size_t>(std::ranges::lower_bound(begin, end, low, {}, &Entry::key) -
                                    order_.begin());
  }

  const std::vector<Eigen::Vector3d>& x_;
  double low_ = 0, buckets_a_metre_ = 0, last_bucket_ = 0;
  std::vector<int> begin_;  // of each bucket in the order, and the end
  std::vector<Entry> order_;
};

}  // namespace qddot::reduce
